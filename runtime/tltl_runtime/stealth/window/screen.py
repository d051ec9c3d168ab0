"""The rendering of an environment: pictures, or a window that opens when the first picture is drawn."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Final

from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.rendering.camera import VIEWS, View, check_size
from tltl_runtime.stealth.world.player import DECISION
from tltlc.api import TltlError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from tltl_runtime.game.window import Window
    from tltl_runtime.stealth.rendering.render import Renderer
    from tltl_runtime.stealth.snapshot import Snapshot

MODES: Final = ("human", "rgb_array")


class Screen:
    """Renders pictures of a level. In the ``mode`` ``human``, it shows them in a window.

    ``size`` is the width and height in pixels. Raises ValueError for an unknown mode or view, and
    for a size that :func:`~tltl_runtime.stealth.rendering.camera.check_size` rejects.
    """

    def __init__(self, level: StealthLevel, mode: str | None, view: View, size: tuple[int, int]) -> None:
        if mode is not None and mode not in MODES:
            raise ValueError(f"there is no render mode {mode!r}: there are {', '.join(MODES)}")
        if view not in VIEWS:
            raise ValueError(f"there is no view {view!r}: there are {', '.join(VIEWS)}")
        self.level, self.mode, self.view = level, mode, view
        self.size = check_size(size)
        self._renderer: Renderer | None = None
        self._window: Window | None = None
        self._cannot_open = False

    def render(self, snapshot: Snapshot) -> NDArray[np.uint8] | None:
        """Draw a snapshot. The mode decides what happens with the picture:

        - ``rgb_array``: return the picture, (height, width, 3).
        - ``human``: show it in the window for the length of a time step, and return None. If no
          window can be opened, warn once and show nothing.
        - None: return None.

        Raises:
            TltlError: TLT0730, pygame is not installed.
        """
        if self.mode is None or self._cannot_open:
            return None
        if self.mode == "human" and self._window is None:
            self._open()
            if self._cannot_open:
                return None
        if self._renderer is None:
            from tltl_runtime.stealth.rendering.render import Renderer

            self._renderer = Renderer(self.level, *self.size)
        frame = self._renderer.frame(snapshot, self.view)
        if self._window is None:
            return frame
        self._window.show(frame)
        self._window.wait(DECISION)
        return None

    def _open(self) -> None:
        from tltl_runtime.game.window import NO_WINDOW, Window

        try:
            self._window = Window(f"{self.level.name} {self.level.variant}", self.size)
        except TltlError as error:
            (diagnostic,) = error.diagnostics
            if diagnostic.code != NO_WINDOW:
                raise
            warnings.warn(f"{diagnostic.code}: {diagnostic.title}", stacklevel=4)
            self._cannot_open = True

    def close(self) -> None:
        """Close the window and release the renderer; a later ``render`` creates them again."""
        if self._renderer is not None:
            self._renderer.close()
        if self._window is not None:
            self._window.close()
        self._renderer = self._window = None
