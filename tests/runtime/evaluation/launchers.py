"""Players whose game is a program, in a module that worker processes can import."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NoReturn

from tests.waiting import HANG_S
from tltl_runtime.evaluation.player import EpisodeRequest, PlayedEpisode


class Launcher:
    """Starts a program, and plays an episode that does not end.

    The file ``program`` in ``folder`` has the program's id; ``closed`` is there after :meth:`close`.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._program = subprocess.Popen([sys.executable, "-c", f"import time; time.sleep({10 * HANG_S})"])

    def play(self, request: EpisodeRequest) -> PlayedEpisode:
        text = self._folder / "text"
        text.write_text(str(self._program.pid), encoding="utf-8")
        text.rename(self._folder / "program")
        self.stay()

    def stay(self) -> NoReturn:
        """Play on for ever."""
        while True:
            time.sleep(HANG_S)

    def close(self) -> None:
        self._program.kill()
        (self._folder / "closed").touch()


class Deaf(Launcher):
    """Its episode cannot be interrupted."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})


class Stubborn(Launcher):
    """Its episode ends in an ordinary way when it is interrupted."""

    def play(self, request: EpisodeRequest) -> PlayedEpisode:
        try:
            return super().play(request)
        except BaseException:
            return PlayedEpisode(request, None)  # type: ignore[arg-type]


class Mortal(Launcher):
    """Its process is killed in the episode."""

    def stay(self) -> NoReturn:
        os.kill(os.getpid(), signal.SIGKILL)
        super().stay()
