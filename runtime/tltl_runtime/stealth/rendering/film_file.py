"""Frames to a GIF or an MP4, as they come."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

Picture = NDArray[np.uint8]


class NoEncoderError(RuntimeError):
    """There is nothing on this machine that writes an MP4."""


def write_gif(path: Path, frames: Iterable[Picture], seconds: float) -> None:
    """A GIF that shows each frame for ``seconds`` (counted in hundredths) and begins anew at its end.

    Each frame has a palette of its own, so that what appears late has its colours, too.  By octrees: the other methods
    lose colours of few pixels, such as those of a switch.
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
    """An MP4 (H.264) that shows each frame for ``seconds``; width and height are even.

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
