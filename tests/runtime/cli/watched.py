"""Run ``tltlc play`` and ``record`` with real keys.

The command logs what the game does into a file, which the test reads.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tests.docs.blocks import ROOT
from tests.runtime.stealth.xvfb import keys
from tests.waiting import HANG_S, until

Line = dict[str, Any]


class Watched:
    """A running command whose window is open and receives keys.

    Each line of the log has one of these keys:

    - ``began``: an episode has begun.
    - ``heard``: a key was pressed.
    - ``looked``: the action of the keys that are pressed, with ``view``, whether the view changes.
    - ``stepped``: the action of a step, with ``x`` and ``y``, the displacement since the start of
      the episode, in metres.
    """

    def __init__(self, display: dict[str, str], folder: Path, *arguments: str) -> None:
        self._display, self._place = display, folder.with_name(f"{folder.name}.told")
        self._place.touch()
        path = os.pathsep.join([str(ROOT), str(ROOT / "runtime")])
        self.process = subprocess.Popen(
            [sys.executable, "-m", __name__, str(self._place), *arguments],
            env={**display, "PYTHONPATH": path},
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.until(self._is_visible, "shows its window")
        self.until(self._hears, "hears keys")

    def log_lines(self) -> list[Line]:
        """Return all lines of the log so far."""
        # Text after the last newline is an incomplete line.
        whole, _, _ = self._place.read_text(encoding="utf-8").rpartition("\n")
        return [json.loads(line) for line in whole.splitlines()]

    def episode(self) -> list[Line]:
        """Return the lines of the log since the last episode began."""
        lines = self.log_lines()
        return lines[max(place for place, line in enumerate(lines) if "began" in line) :]

    def steps(self) -> list[Line]:
        """Return the lines of the episode's steps so far."""
        return [line for line in self.episode() if "stepped" in line]

    def until(self, event: Callable[[], Any], description: str) -> None:
        """Wait until ``event()`` is true; fail if the command ends before.

        ``description`` completes the message "a game that …".
        """

        def happened() -> bool:
            assert self.process.poll() is None, self.process.communicate()
            return bool(event())

        until(happened, f"a game that {description}", 0.05)

    def begin_again(self) -> None:
        """Press the key that restarts, and wait until the new episode begins."""
        before = sum("began" in line for line in self.log_lines())
        keys(self._display, "key", "r")
        self.until(lambda: sum("began" in line for line in self.log_lines()) > before, "begins again")

    def until_it_looked(self, times: int = 1, wanted: Callable[[Line], bool] = lambda _: True) -> None:
        """Wait until the game has read the keys this many times from now.

        Only lines of the log count for which ``wanted`` is true.
        """
        before = len(self.log_lines())

        def looks() -> list[Line]:
            return [line for line in self.log_lines()[before:] if "looked" in line and wanted(line)]

        self.until(lambda: len(looks()) >= times, "looks at the keys")

    def _is_visible(self) -> bool:
        # Match only windows of applications: the root window has no class. The search fails (BadWindow) if a window
        # closes during it, as the first window of SDL does; then the window of the game is not there yet.
        search = ["xdotool", "search", "--onlyvisible", "--class", "."]
        return not subprocess.run(search, env=self._display, timeout=HANG_S, capture_output=True).returncode

    def _hears(self) -> bool:
        # This key does nothing in the game.
        keys(self._display, "key", "F5")
        return any("heard" in line for line in self.log_lines())


def log_what_happens(place: Path) -> None:
    """Patch the game in this process so that it logs what happens into the file ``place``."""
    import pygame

    from tltl_runtime.stealth.episode_recorder import RecordEpisode
    from tltl_runtime.stealth.window.keys import KeyReader, Keys

    file = place.open("a", encoding="utf-8")

    def log(**fields: Any) -> None:
        file.write(f"{json.dumps(fields)}\n")
        file.flush()

    reset, step, look, events = RecordEpisode.reset, RecordEpisode.step, KeyReader.keys, pygame.event.get
    start = [0.0, 0.0]

    def place_of(env: RecordEpisode) -> Sequence[float]:
        position: Sequence[float] = env.unwrapped.game.snapshot().player.position  # type: ignore[attr-defined]
        return position

    def logged_reset(env: RecordEpisode, **options: Any) -> Any:
        result = reset(env, **options)
        start[:] = place_of(env)[:2]
        log(began=True)
        return result

    def logged_step(env: RecordEpisode, action: Any) -> Any:
        result = step(env, action)
        x, y = (now - then for now, then in zip(place_of(env), start, strict=False))
        log(stepped=[int(part) for part in action], x=x, y=y)
        return result

    def logged_look(reader: KeyReader) -> Keys:
        keys_now = look(reader)
        log(looked=list(keys_now.action), view=keys_now.view)
        return keys_now

    def logged_events(*arguments: Any) -> Any:
        new_events = events(*arguments)
        if any(event.type == pygame.KEYDOWN for event in new_events):
            log(heard=True)
        return new_events

    RecordEpisode.reset, RecordEpisode.step = logged_reset, logged_step  # type: ignore[method-assign]
    KeyReader.keys = logged_look  # type: ignore[method-assign]
    pygame.event.get = logged_events


if __name__ == "__main__":
    from tltlc.interfaces.cli.main import main

    log_what_happens(Path(sys.argv[1]))
    # Run as the command itself, which handles signals.
    sys.argv = ["tltlc", *sys.argv[2:]]
    main()
