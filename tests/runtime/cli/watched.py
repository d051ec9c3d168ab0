"""``tltlc play`` and ``record``, played with real keys, by a test that sees in a file what the game has done so far."""

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
    """A running command whose window is open and hears keys.

    Each line that it tells has one of these keys: ``began``; ``looked``, the action that the held keys ask for;
    ``stepped``, the action of a step, with the way ``x``, ``y`` since the episode began, in metres.
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
        self.until(self._is_seen, "shows its window")
        self.until(self._hears, "hears keys")

    def told(self) -> list[Line]:
        """All that it has told so far."""
        # What stands behind the last end of a line is not whole yet.
        whole, _, _ = self._place.read_text(encoding="utf-8").rpartition("\n")
        return [json.loads(line) for line in whole.splitlines()]

    def episode(self) -> list[Line]:
        """What it has told since the episode began."""
        told = self.told()
        return told[max(place for place, line in enumerate(told) if "began" in line) :]

    def steps(self) -> list[Line]:
        """The steps of the episode so far."""
        return [line for line in self.episode() if "stepped" in line]

    def until(self, event: Callable[[], Any], what: str) -> None:
        """Wait for an event while the command goes on."""

        def happened() -> bool:
            assert self.process.poll() is None, self.process.communicate()
            return bool(event())

        until(happened, f"a game that {what}", 0.05)

    def begin_again(self) -> None:
        """Press the key that begins another episode, and wait for that."""
        before = sum("began" in line for line in self.told())
        keys(self._display, "key", "r")
        self.until(lambda: sum("began" in line for line in self.told()) > before, "begins again")

    def until_it_looked(self, times: int = 1, wanted: Callable[[Line], bool] = lambda _: True) -> None:
        """Wait until it has looked at the keys so often from now on, and found what is wanted."""
        before = len(self.told())

        def looks() -> list[Line]:
            return [line for line in self.told()[before:] if "looked" in line and wanted(line)]

        self.until(lambda: len(looks()) >= times, "looks at the keys")

    def _is_seen(self) -> bool:
        # Only windows of applications have a class. A search fails where a window closes during it (BadWindow), as the
        # first window of SDL does: then there is nothing to see yet.
        search = ["xdotool", "search", "--onlyvisible", "--class", "."]
        return not subprocess.run(search, env=self._display, timeout=HANG_S, capture_output=True).returncode

    def _hears(self) -> bool:
        # A key that means nothing to the game.
        keys(self._display, "key", "F5")
        return any("heard" in line for line in self.told())


def tell_what_happens(place: Path) -> None:
    """Have the game of this process write each thing that it does into a file."""
    import pygame

    from tltl_runtime.stealth.recording import RecordEpisode
    from tltl_runtime.stealth.window.window import Keys, Window

    file = place.open("a", encoding="utf-8")

    def tell(**what: Any) -> None:
        file.write(f"{json.dumps(what)}\n")
        file.flush()

    reset, step, look, events = RecordEpisode.reset, RecordEpisode.step, Window.keys, pygame.event.get
    start = [0.0, 0.0]

    def place_of(env: RecordEpisode) -> Sequence[float]:
        position: Sequence[float] = env.unwrapped.game.snapshot().player.position  # type: ignore[attr-defined]
        return position

    def told_reset(env: RecordEpisode, **options: Any) -> Any:
        found = reset(env, **options)
        start[:] = place_of(env)[:2]
        tell(began=True)
        return found

    def told_step(env: RecordEpisode, action: Any) -> Any:
        found = step(env, action)
        x, y = (now - then for now, then in zip(place_of(env), start, strict=False))
        tell(stepped=[int(part) for part in action], x=x, y=y)
        return found

    def told_look(window: Window) -> Keys:
        found = look(window)
        tell(looked=list(found.action), view=found.view)
        return found

    def told_events(*arguments: Any) -> Any:
        found = events(*arguments)
        if any(event.type == pygame.KEYDOWN for event in found):
            tell(heard=True)
        return found

    RecordEpisode.reset, RecordEpisode.step = told_reset, told_step  # type: ignore[method-assign]
    Window.keys = told_look  # type: ignore[method-assign]
    pygame.event.get = told_events


if __name__ == "__main__":
    from tltlc.interfaces.cli.main import main

    tell_what_happens(Path(sys.argv[1]))
    # As a process of its own, which handles signals.
    sys.argv = ["tltlc", *sys.argv[2:]]
    main()
