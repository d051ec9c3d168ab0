"""The automaton as a PNG picture."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.drawing.layout import draw

TARGET = Target("png", "a picture of pixels", (".png",))


def emit(fspa: Fspa, options: Options) -> Files:
    """Return ``NAME.png``, or what :func:`tltlc.backends.drawing.layout.draw` returns for a graph that is too large."""
    return draw(fspa, options, "png")
