"""The video driver of SDL, the library with which pygame draws."""

from __future__ import annotations

import os
import sys
from typing import Final

_DRIVER: Final = "SDL_VIDEODRIVER"
_SCREENS: Final = ("DISPLAY", "WAYLAND_DISPLAY")


def draw_without_screen() -> None:
    """Let SDL draw into memory alone, if this is a Linux computer without a screen and no driver is chosen.

    SDL would look for a screen, and print ``error: XDG_RUNTIME_DIR is invalid or not set``. Sets the
    environment variable ``SDL_VIDEODRIVER``, so that games in other processes draw in the same way.
    """
    if sys.platform == "linux" and not any(os.environ.get(name) for name in (*_SCREENS, _DRIVER)):
        os.environ[_DRIVER] = "dummy"
