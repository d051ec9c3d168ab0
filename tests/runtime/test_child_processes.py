"""Processes started while interrupts are blocked."""

from __future__ import annotations

import signal
import subprocess
import sys
from contextlib import nullcontext

import pytest

from tests.waiting import HANG_S
from tltlc.io.child_interrupts import block_interrupts

pytestmark = pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="needs signals that can be blocked")

_CHILD = "import sys; print('on', flush=True); sys.stdin.readline(); print('done')"


@pytest.mark.parametrize("blocked", [True, False])
def test_only_a_process_that_is_started_in_the_context_ignores_ctrl_c(blocked: bool) -> None:
    command = [sys.executable, "-c", _CHILD]
    with block_interrupts() if blocked else nullcontext():
        child = subprocess.Popen(command, stdin=-1, stdout=-1, stderr=-1, text=True)
    with child:
        assert child.stdout is not None
        child.stdout.readline()
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate("go on\n", timeout=HANG_S)
        assert (out == "done\n") == blocked


def test_the_parent_gets_the_interrupt_after_the_context() -> None:
    end_reached = False
    with pytest.raises(KeyboardInterrupt), block_interrupts():
        signal.raise_signal(signal.SIGINT)
        end_reached = True
    assert end_reached
