"""A window with a keyboard, made with pygame: it shows pictures of any game and reads the keys.

No other module imports pygame; docs/adr/0010-pictures-and-windows.md explains the choice.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.hud import Hud, Tone
from tltl_runtime.support.quiet_stderr import silence
from tltlc.api import Diagnostic, TltlError, record

NO_WINDOW: Final = "TLT0830"
"""The error code for a window that cannot be opened."""

_MIN_WIDTH: Final = 960
"""The least width of a picture in the window, in pixels; narrower pictures are enlarged."""
_DRIVERS_WITHOUT_SCREEN: Final = {"dummy", "offscreen"}
"""SDL drivers that show nothing: the game would wait for keys that nobody can press."""
_TONES: Final[dict[Tone, tuple[int, int, int]]] = {
    "plain": (235, 239, 245),
    "quiet": (160, 170, 186),
    "good": (88, 214, 141),
    "bad": (255, 99, 99),
    "warn": (255, 201, 71),
    "dark": (16, 20, 30),
}
_PANEL: Final = (16, 20, 30)
_TITLE_STRENGTH: Final = 215
_LINE_HEIGHT: Final = 20
"""The height of a line, in pixels."""
_NAME_HEIGHT: Final = 20
"""The height of names in the picture, in pixels."""
_PANEL_WIDTH: Final = 330
"""The width of the panel beside the picture, in pixels."""
_TRACK: Final = (60, 68, 84)

Names = Sequence[tuple[str, float, float]]
"""Names and their positions, in pixels from the left and from the top."""


Key = str | int
"""A key of the keyboard: its name in pygame, such as ``left`` or ``a``, or its number in pygame."""


@record
class Pressed:
    """What was done with some keys of the keyboard since they were last read.

    ``held`` are the keys that are held; a key that was tapped counts as held, too. ``tapped`` are the
    keys that were pressed, in this order. ``closed`` says whether the window was closed.
    """

    held: frozenset[Key]
    tapped: tuple[Key, ...]
    closed: bool


class Window:
    """A window for pictures of ``size`` (width, height); small pictures are enlarged.

    With ``side``, the window has a panel for a head-up display beside the pictures.

    Raises:
        TltlError: TLT0730, pygame is not installed; TLT0830, no window can be opened.
    """

    def __init__(self, title: str, size: tuple[int, int], side: bool = False) -> None:
        pygame = self._pygame = _import_pygame()
        scale = max(1.0, _MIN_WIDTH / size[0])
        self.size = (round(size[0] * scale), round(size[1] * scale))
        self._side = _PANEL_WIDTH if side else 0
        try:
            # Without a screen, SDL itself prints complaints on standard error.
            with silence():
                pygame.display.init()
                self._surface = pygame.display.set_mode((self._side + self.size[0], self.size[1]))
            pygame.font.init()
        except pygame.error as error:
            pygame.quit()
            raise _no_window_error(str(error)) from None
        if pygame.display.get_driver() in _DRIVERS_WITHOUT_SCREEN:
            pygame.quit()
            raise _no_window_error("there is no screen")
        pygame.display.set_caption(title)
        pygame.event.set_allowed((pygame.QUIT, pygame.KEYDOWN, pygame.KEYUP))
        self._clock = pygame.time.Clock()
        self._fonts: dict[int, Any] = {}

    def close(self) -> None:
        """Close the window; closing twice does nothing."""
        self._pygame.quit()

    def read(self, keys: Collection[Key]) -> Pressed:
        """Return what was done with ``keys`` since the last call. Presses of other keys are discarded.

        Raises:
            ValueError: pygame has no key with this name.
        """
        pygame = self._pygame
        numbers = {key: key if isinstance(key, int) else pygame.key.key_code(key) for key in keys}
        pressed: list[int] = []
        closed = False
        for event in pygame.event.get():
            closed = closed or event.type == pygame.QUIT
            if event.type == pygame.KEYDOWN:
                pressed.append(event.key)
        now = pygame.key.get_pressed()
        held = frozenset(key for key, number in numbers.items() if now[number] or number in pressed)
        tapped = tuple(key for press in pressed for key, number in numbers.items() if number == press)
        return Pressed(held, tapped, closed)

    def show(self, frame: NDArray[np.uint8], hud: Hud | None = None, names: Names = ()) -> None:
        """Show a picture (height, width, 3), with a head-up display.

        ``names`` are written into the picture, each above its position.
        """
        pygame = self._pygame
        picture = pygame.image.frombuffer(np.ascontiguousarray(frame).tobytes(), frame.shape[1::-1], "RGB")
        self._surface.blit(pygame.transform.smoothscale(picture, self.size), (self._side, 0))
        for name, x, y in names:
            self._draw_name(name, x * self.size[0] / frame.shape[1], y * self.size[1] / frame.shape[0])
        if hud is not None:
            self._draw_side(hud)
            if hud.title:
                self._draw_title(hud)
        pygame.display.flip()

    def wait(self, seconds: float) -> None:
        """Wait until ``seconds`` have passed since the last call; keep the window responsive."""
        self._pygame.event.pump()
        self._clock.tick(1 / seconds)

    def _draw_name(self, name: str, x: float, y: float) -> None:
        """Draw a name above a position.

        The text is light with a dark outline, so that it can be read everywhere.
        """
        light, dark = (self._text(name, tone, _NAME_HEIGHT) for tone in ("plain", "dark"))
        left = self._side + round(x) - light.get_width() // 2
        top = round(y) - light.get_height()
        for across, down in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            self._surface.blit(dark, (left + across, top + down))
        self._surface.blit(light, (left, top))

    # The head-up display

    def _draw_side(self, hud: Hud) -> None:
        """Draw the bars and lines of the head-up display to the left of the picture."""
        step = _LINE_HEIGHT
        self._surface.fill(_PANEL, (0, 0, self._side, self.size[1]))
        rows = [self._bar(bar.name, bar.value, bar.tone, step) for bar in hud.bars]
        rows += [self._text(line.text, line.tone, step) for line in hud.lines]
        for index, row in enumerate(rows):
            self._surface.blit(row, (step, step + index * round(step * 1.3)))

    def _draw_title(self, hud: Hud) -> None:
        """Draw the title of a head-up display, and the lines below it, in mid-picture."""
        pygame, step = self._pygame, _LINE_HEIGHT + 4
        rows = [self._text(hud.title, hud.tone, step * 2), *(self._text(line, "plain", step) for line in hud.below)]
        width = max(row.get_width() for row in rows) + 2 * step
        height = sum(row.get_height() for row in rows) + 2 * step
        panel = pygame.Surface((width, height), pygame.SRCALPHA)
        panel.fill((*_PANEL, _TITLE_STRENGTH))
        y = step
        for row in rows:
            panel.blit(row, ((width - row.get_width()) // 2, y))
            y += row.get_height()
        middle = self._side + (self.size[0] - width) // 2, (self.size[1] - height) // 2
        self._surface.blit(panel, (max(0, middle[0]), max(0, middle[1])))

    def _bar(self, name: str, value: float, tone: Tone, height: int) -> Any:
        """Draw a name and a bar that is filled up to ``value``, in [0, 1]."""
        pygame = self._pygame
        row = pygame.Surface((height * 13, height), pygame.SRCALPHA)
        row.blit(self._text(name, "quiet", height), (0, 0))
        track = pygame.Rect(height * 5, height // 4, height * 8, height // 2)
        pygame.draw.rect(row, _TRACK, track, border_radius=height // 4)
        track.width = round(track.width * min(1.0, max(0.0, value)))
        pygame.draw.rect(row, _TONES[tone], track, border_radius=height // 4)
        return row

    def _text(self, text: str, tone: Tone, height: int) -> Any:
        if height not in self._fonts:
            self._fonts[height] = self._pygame.font.Font(None, int(height * 1.1))
        return self._fonts[height].render(text, True, _TONES[tone])


def _import_pygame() -> Any:
    """Import pygame without the greeting that it prints on standard output.

    Raises TltlError, TLT0730, if pygame is not installed.
    """
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    try:
        import pygame
    except ModuleNotFoundError as error:
        title = f"a window needs `{error.name}`, which is not installed"
        raise TltlError(
            [Diagnostic("TLT0730", title, help="in the clone of tltlc: pip install -c constraints.txt '.[game]'")]
        ) from None
    return pygame


def _no_window_error(why: str) -> TltlError:
    title = f"cannot open a window here: {why}"
    help_ = "play on a machine with a screen, or start `Xvfb` and set DISPLAY; pictures of episodes need no window"
    return TltlError([Diagnostic(NO_WINDOW, title, help=help_)])
