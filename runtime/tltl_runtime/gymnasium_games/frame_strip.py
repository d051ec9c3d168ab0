"""Put a frame of a game and a line of text into a picture of a given size."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

_STRIP: Final = 28
"""The height of the strip with the text, in pixels."""


def with_strip(frame: NDArray[np.uint8], text: str, size: tuple[int, int]) -> NDArray[np.uint8]:
    """Return a picture [height, width, 3] of ``size`` (width, height): a frame, and below it a strip with a text.

    The frame [H, W, 3] is scaled to fit, in its own proportions. A text that is too long is cut.
    """
    width, height = size
    picture = Image.new("RGB", size, (24, 28, 36))
    image = Image.fromarray(np.ascontiguousarray(frame[..., :3]).astype(np.uint8))
    scale = min(width / image.width, (height - _STRIP) / image.height)
    fitted = image.resize((max(1, round(image.width * scale)), max(1, round(image.height * scale))))
    picture.paste(fitted, ((width - fitted.width) // 2, (height - _STRIP - fitted.height) // 2))
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(14)
    while len(text) > 1 and draw.textlength(text, font=font) > width - 12:
        text = f"{text[:-2]}…"
    draw.text((6, height - _STRIP + 5), text, fill=(235, 238, 245), font=font)
    return np.asarray(picture)
