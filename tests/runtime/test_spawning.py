"""Processes that are started while interrupts are withheld."""

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
def test_a_process_started_within_never_hears_of_ctrl_c(withheld: bool) -> None:
    command = [sys.executable, "-c", _CHILD]
    with interrupts_withheld() if withheld else nullcontext():
        child = subprocess.Popen(command, stdin=-1, stdout=-1, stderr=-1, text=True)
    with child:
        assert child.stdout is not None
        child.stdout.readline()
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate("go on\n", timeout=HANG_S)
        assert (out == "done\n") == withheld


def test_whoever_starts_it_hears_of_it_afterwards() -> None:
    within = False
    with pytest.raises(KeyboardInterrupt), interrupts_withheld():
        signal.raise_signal(signal.SIGINT)
        within = True
    assert within
