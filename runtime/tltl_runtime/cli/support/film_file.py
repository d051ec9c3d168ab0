"""Write frames to a GIF or an MP4 as they are produced."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain
from pathlib import Path

import numpy as np
from PIL import Image

from tltl_runtime.game.films import Picture


class NoEncoderError(RuntimeError):
    """Raised if no encoder for MP4 is available on this machine."""


def write_gif(path: Path, frames: Iterable[Picture], seconds: float) -> None:
    """Write a looping GIF that shows each frame for ``seconds``, rounded to hundredths, at least 0.02.

    Each frame has its own palette, so that colours that first appear late are kept. An octree
    computes the palette: Pillow's other methods lose the colours of small things, such as a switch.
    """
    pictures = (
        Image.fromarray(frame).quantize(256, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE) for frame in frames
    )
    next(pictures).save(
        path,
        "GIF",
        save_all=True,
        append_images=pictures,
        duration=max(20, round(100 * seconds) * 10),
        loop=0,
        optimize=False,
    )


def write_mp4(path: Path, frames: Iterable[Picture], seconds: float) -> None:
    """Write an MP4 (H.264) that shows each frame for ``seconds``; width and height must be even.

    Raises:
        NoEncoderError: imageio-ffmpeg is not installed, or finds no encoder.
    """
    try:
        from imageio_ffmpeg import get_ffmpeg_exe, write_frames

        get_ffmpeg_exe()
    except (ModuleNotFoundError, RuntimeError):
        raise NoEncoderError from None
    remaining = iter(frames)
    first = next(remaining)
    height, width, _ = first.shape
    writer = write_frames(
        str(path),
        (width, height),
        fps=1 / seconds,
        codec="libx264",
        quality=7,
        macro_block_size=2,
        ffmpeg_log_level="error",
    )
    writer.send(None)
    try:
        for frame in chain((first,), remaining):
            writer.send(np.ascontiguousarray(frame))
    finally:
        writer.close()
