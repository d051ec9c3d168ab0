"""Check the traces that the recorder of a client has written."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.waiting import HANG_S


def check_traces(folder: Path, tmp_path: Path, number: int) -> None:
    """Check two traces, of which the first is accepted, that a client recorded."""
    assert (folder / f"trace-{number:04d}.csv").read_text(encoding="utf-8").splitlines() == [
        'time,"near(a, b)",seen',
        "0,0,false",
        "0.016666666666666666,0.3333333333333333,false",
        "0.03333333333333333,0.6666666666666666,false",
        "0.05,1,true",
    ]
    spec = tmp_path / "see.tltl"
    spec.write_text(
        "clock 60 Hz\nsignal near(a, b): number in [0, 1]\nsignal seen: bool\nspec see = F seen\n", encoding="utf-8"
    )
    traces = [str(folder / f"trace-{number + index:04d}.csv") for index in range(2)]
    words = [sys.executable, "-m", "tltlc", "monitor", str(spec), *traces]
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert "1 of 2 accepted" in result.stdout, result.stderr


def cells(row: str) -> list[float | str]:
    """Return the cells of a row, with numbers as floats."""
    return [cell if cell in ("true", "false") else float(cell) for cell in row.split(",")]
