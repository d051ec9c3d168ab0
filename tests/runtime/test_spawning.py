"""Processes started while interrupts are blocked."""

from __future__ import annotations

import signal
import subprocess
import sys
from contextlib import nullcontext

import pytest

from tests.waiting import HANG_S
from tltl_runtime.support.child_processes import interrupts_withheld

pytestmark = pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="needs signals that can be withheld")

_CHILD = "import sys; print('on', flush=True); sys.stdin.readline(); print('done')"


@pytest.mark.parametrize("withheld", [True, False])
def test_a_process_started_in_the_block_ignores_ctrl_c(withheld: bool) -> None:
    command = [sys.executable, "-c", _CHILD]
    with interrupts_withheld() if withheld else nullcontext():
        child = subprocess.Popen(command, stdin=-1, stdout=-1, stderr=-1, text=True)
    with child:
        assert child.stdout is not None
        child.stdout.readline()
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate("go on\n", timeout=HANG_S)
        assert (out == "done\n") == withheld


def test_the_parent_gets_the_interrupt_after_the_block() -> None:
    end_reached = False
    with pytest.raises(KeyboardInterrupt), interrupts_withheld():
        signal.raise_signal(signal.SIGINT)
        end_reached = True
    assert end_reached
