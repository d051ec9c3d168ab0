"""Put a frame of a game, and a line of text, into a picture of a given size."""

from __future__ import annotations

from typing import Final

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from tltl_runtime.game.films import Picture

_STRIP: Final = 28
"""The height of the strip with the text, in pixels."""
_BACKGROUND: Final = (24, 28, 36)


def fitted(frame: Picture, size: tuple[int, int]) -> Picture:
    """Return a picture (height, width, 3) of ``size`` (width, height) with a frame in its middle.

    The frame is scaled to fit, in its own proportions. A much smaller frame keeps its sharp pixels.
    """
    return np.asarray(_fitted(frame, size))


def with_strip(frame: Picture, text: str, size: tuple[int, int]) -> Picture:
    """Return a picture (height, width, 3) of ``size`` (width, height): a frame, and below it a strip with a text.

    The frame is scaled to fit, in its own proportions. A text that is too long is cut.
    """
    width, height = size
    picture = Image.new("RGB", size, _BACKGROUND)
    picture.paste(_fitted(frame, (width, height - _STRIP)))
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(14)
    while len(text) > 1 and draw.textlength(text, font=font) > width - 12:
        text = f"{text[:-2]}…"
    draw.text((6, height - _STRIP + 5), text, fill=(235, 238, 245), font=font)
    return np.asarray(picture)


def _fitted(frame: Picture, size: tuple[int, int]) -> Image.Image:
    image, (width, height) = Image.fromarray(frame), size
    scale = min(width / image.width, height / image.height)
    within = (max(1, round(image.width * scale)), max(1, round(image.height * scale)))
    scaled = image.resize(within, Image.Resampling.NEAREST if scale >= 2.0 else Image.Resampling.BICUBIC)
    picture = Image.new("RGB", size, _BACKGROUND)
    picture.paste(scaled, ((width - scaled.width) // 2, (height - scaled.height) // 2))
    return picture
