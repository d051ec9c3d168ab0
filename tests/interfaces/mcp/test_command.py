"""``tltlc mcp`` on the command line."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tltlc.interfaces.cli.main import main


def test_a_missing_package_is_reported_with_the_command_that_installs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for module in ("mcp", "mcp.server", "mcp.server.lowlevel"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(SystemExit) as ended:
        main(["mcp"])
    assert ended.value.code == 4
    message = capsys.readouterr().err
    assert "error[TLT0730]: `tltlc mcp` needs `mcp" in message
    assert "'.[mcp]'" in message


def test_the_limits_of_the_command_line_hold_for_each_call() -> None:
    """The server passes them on to its processes."""
    program = (
        "from multiprocessing import Pipe\n"
        "from tltlc.io.limits import ProcessLimit\n"
        "from tltlc.io.resources import permitted\n"
        "from tltlc.interfaces.mcp.worker import answer_all\n"
        "ours, theirs = Pipe()\n"
        "ours.close()\n"
        "answer_all(theirs, ProcessLimit(memory=5, work_s=7))\n"
        "print(permitted())\n"
    )
    completed = subprocess.run([sys.executable, "-c", program], capture_output=True, check=True, text=True)
    assert "memory=5" in completed.stdout and "work_s=7" in completed.stdout
