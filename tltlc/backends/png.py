"""The automaton as a PNG picture."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.drawing.layout import draw

TARGET = Target("png", "a picture of pixels", (".png",))


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the picture ``NAME.png``, or ``NAME.dot`` if the picture cannot be drawn in time.

    NAME is the name of the automaton.

    Raises:
        TltlError: TLT0730 pygraphviz is not installed, TLT0712 the layout itself failed.
    """
    return draw(fspa, options, "png")
