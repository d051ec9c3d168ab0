"""Messages about traces in CSV and JSON lines begin with the line or the step, as `docs/traces.md` says."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.waiting import HANG_S

Run = Callable[..., Outcome]

SPEC = "signal seen: bool\nsignal d: length in [0 m, 9 m]\nspec hide = G !seen and F d < 1 m\n"
GOOD = b'{"seen": false, "d": 2}\n'
TRACES = {
    GOOD + b"{bad": "line 2",
    b'\n{"seen": 3, "d": 1}': "line 2",
    b'{"seen": false, "d": "x"}': "line 1",
    b'{"seen": false, "d": 1, "d": 2}': "line 1",
    b'{"seen": false, "d": ' + b"[" * 40 + b"]" * 40 + b"}": "line 1",
    GOOD + b'{"seen": false, "d": 1\xff}': "line 2",
    GOOD + b'\n{"seen": false}': "step 2",
    b'{"seen": null, "d": 1}': "step 1",
    GOOD + b'{"seen": false, "d": NaN}': "step 2",
    b"seen\n1\n": "line 1",
    b"seen,d\n1\n": "line 2",
    b"seen,d\n\n1,nan\n": "step 1",
}


@pytest.mark.parametrize("trace", TRACES, ids=lambda trace: trace.decode(errors="replace")[:30])
def test_a_message_begins_with_the_line_or_the_step(
    trace: bytes,
    tmp_path: Path,
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("hide.tltl").write_text(SPEC, encoding="utf-8")
    Path("trace").write_bytes(trace)
    assert tltlc("compile", "hide.tltl", "-t", "python").status == 0
    result = subprocess.run(
        [sys.executable, "hide_monitor.py", "trace"], capture_output=True, text=True, timeout=HANG_S, check=False
    )
    assert result.returncode == 1
    assert result.stderr.splitlines()[-1].startswith(f"error: {TRACES[trace]}: ")
    checked = tltlc("monitor", "hide.tltl", "trace")
    kind, number = TRACES[trace].split()
    named = f"{kind} {number}" if kind == "step" or "the trace has no column" not in checked.err else "trace:1:"
    assert (checked.status, named in checked.err) == (1, True)
