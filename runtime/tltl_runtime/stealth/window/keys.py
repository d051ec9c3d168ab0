"""The keys of the stealth game, read from its window."""

from __future__ import annotations

from typing import Final

from tltl_runtime.game.window import Window
from tltlc.api import record

_EAST: Final = ("d", "right")
_WEST: Final = ("a", "left")
_NORTH: Final = ("w", "up")
_SOUTH: Final = ("s", "down")
_JUMP: Final = ("space",)
_CROUCH: Final = ("c", "left ctrl", "right ctrl")
_SPRINT: Final = ("left shift", "right shift")
_STOP: Final = ("escape", "q")
_RESTART: Final = "r"
_VIEW: Final = "v"
_ALL: Final = (*_EAST, *_WEST, *_NORTH, *_SOUTH, *_JUMP, *_CROUCH, *_SPRINT, *_STOP, _RESTART, _VIEW)


@record
class Keys:
    """The player's input: an action of the game, and commands to the window.

    The commands are to restart, to stop, and to change the view.
    """

    action: tuple[int, int, int, int, int]
    restart: bool = False
    stop: bool = False
    view: bool = False


class KeyReader:
    """Reads the player's input from the keyboard of ``window``.

    With ``sticky_crouch``, one key press starts crouching, and the next one ends it.

    Keys: arrows or WASD walk (up is north, away from the camera), space jumps, C or control
    crouches, shift sprints, R restarts, V changes the view; Escape, Q or the window's close button
    stop.
    """

    def __init__(self, window: Window, *, sticky_crouch: bool = False) -> None:
        self._window = window
        self._sticky, self._keeps_crouching = sticky_crouch, False

    def keys(self) -> Keys:
        """Return the current input. A key that was tapped since the last call counts as held."""
        pressed = self._window.read(_ALL)
        taps = sum(key in _CROUCH for key in pressed.tapped)
        self._keeps_crouching ^= self._sticky and taps % 2 == 1

        def held(keys: tuple[str, ...]) -> bool:
            return not pressed.held.isdisjoint(keys)

        action = (
            (held(_EAST) - held(_WEST)) % 3,
            (held(_NORTH) - held(_SOUTH)) % 3,
            int(held(_JUMP)),
            int(self._keeps_crouching if self._sticky else held(_CROUCH)),
            int(held(_SPRINT)),
        )
        stop = pressed.closed or any(key in _STOP for key in pressed.tapped)
        return Keys(action, _RESTART in pressed.tapped, stop, _VIEW in pressed.tapped)
