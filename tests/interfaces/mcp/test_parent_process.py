"""Child processes that end when the standard input ends which their parent holds."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from typing import Any

import pytest

from tests.interfaces.mcp.client import ENVIRONMENT
from tests.waiting import HANG_S

pytestmark = pytest.mark.skipif(os.name != "posix", reason="Windows ends the process at once")

ENDURES = """\
import os, signal, sys
from tltlc.io.parent_process import terminate_with_input
signal.signal(signal.SIGTERM, signal.SIG_IGN)
{start}
terminate_with_input(0.1)
while True:
    signal.pause()
"""
"""A process that ignores SIGTERM."""

STARTS_A_CHILD = "if os.fork() == 0: signal.pause()"


def start(program: str, **options: Any) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-c", program],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, **ENVIRONMENT},
        **options,
    )


def test_a_process_that_does_not_see_sigterm_is_killed() -> None:
    with start(ENDURES.format(start="")) as process:
        assert process.stdin is not None
        process.stdin.close()
        assert process.wait(HANG_S) == -signal.SIGKILL


def test_the_processes_of_a_killed_group_leader_are_killed() -> None:
    with start(ENDURES.format(start=STARTS_A_CHILD), start_new_session=True) as process:
        assert process.stdin is not None and process.stdout is not None
        process.stdin.close()
        assert process.wait(HANG_S) == -signal.SIGKILL
        # The process and its child share this pipe, so it ends only with the last of them.
        assert process.stdout.read() == b""
