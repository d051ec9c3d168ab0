"""Ctrl-C while Python and the command line are loading, at every audit event of Python."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT
from tests.waiting import HANG_S

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a process that can be continued twice")

# At each audit event, a forked copy of the process interrupts itself and runs to its end.
INTERRUPTING = """
import os, signal, sys

def copies(event, arguments):
    if state["copy"] or event not in ("import", "exec", "open", "os.listdir", "signal.signal"):
        return
    state["copy"] = True
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        os.dup2(writing, 1)
        os.dup2(writing, 2)
        os.kill(os.getpid(), signal.SIGINT)
        return
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        output = pipe.read()
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    what = str(arguments[0]).replace("\\n", " ")
    ends.append((status, event, what, output.decode(errors="replace")))
    state["copy"] = False

def tell():
    state["copy"] = True
    with open(os.environ["ENDS"], "w") as file:
        file.write(repr(ends))

state, ends = {"copy": False}, []
import atexit
main = os.getpid()
atexit.register(lambda: os.getpid() == main and tell())
sys.addaudithook(copies)
"""

SCRIPT = "import re, sys; from tltlc.interfaces.cli.main import main; sys.exit(main())"
"""The code of the installed command `tltlc`."""


@pytest.mark.parametrize("how", [("-c", SCRIPT), ("-m", "tltlc")], ids=["tltlc", "python -m tltlc"])
def test_an_interrupt_at_the_start_shows_no_traceback_of_tltlc(how: tuple[str, str], tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(INTERRUPTING, encoding="utf-8")
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)]),
        "ENDS": str(tmp_path / "ends"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    completed = subprocess.run(
        [sys.executable, *how, "--version"],
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        timeout=HANG_S,
        check=True,
        text=True,
    )
    assert completed.stdout.startswith("tltlc ")
    ends: list[tuple[int, str, str, str]] = eval((tmp_path / "ends").read_text())
    ours = [index for index, (*_, output) in enumerate(ends) if f'File "{ROOT}' in output]
    assert [ends[index] for index in ours] == []
    # From the first event at which our code can handle the interrupt until the version is printed, it is handled.
    handled = [index for index, (status, *_, output) in enumerate(ends) if (status, output) == (130, "")]
    assert len(handled) > 50
    first = handled[0]
    # A signal that comes during an import is sent again a little later, which may be after the version was printed. The
    # parser of the command line answers it with a blank line.
    rest = {
        (status, output.replace("\n\n", "\n") if status == 130 else output) for status, _, _, output in ends[first:]
    }
    assert {output for _, output in rest if output not in completed.stdout} == set()
    assert {(status, bool(output)) for status, output in rest} == {(130, False), (130, True), (0, True)}
    # Before that, only the modules of the entry point are loaded.
    before = [what for _, event, what, _ in ends[:first] if event == "import" and what.startswith("tltlc")]
    assert set(before) <= {
        "tltlc",
        "tltlc.interfaces",
        "tltlc.interfaces.cli",
        "tltlc.interfaces.cli.main",
        "tltlc.__main__",
    }
