"""A screen for tests that need one, and real key presses on it."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

from tests.waiting import HANG_S

MISSING = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
MISSING += [name for name in ("pygame",) if find_spec(name) is None]


@contextmanager
def screen() -> Iterator[dict[str, str]]:
    """Start an X server, and stop it when the block ends.

    Yield the environment variables with which a process uses it.
    """
    reading, writing = os.pipe()
    # With -noreset: otherwise the server starts anew when its last client leaves, and a client that connects meanwhile
    # fails.
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1400x700x24", "-nolisten", "tcp", "-noreset"],
        pass_fds=(writing,),
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    try:
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
        yield {**os.environ, "DISPLAY": f":{number}", "SDL_VIDEODRIVER": "x11", "OMP_NUM_THREADS": "1"}
    finally:
        server.terminate()
        server.wait(HANG_S)


def keys(environment: dict[str, str], *commands: str) -> None:
    """Press keys with commands of xdotool, such as ``key Escape`` or ``keydown d``."""
    subprocess.run(["xdotool", *commands], env=environment, check=True, timeout=HANG_S, capture_output=True)
