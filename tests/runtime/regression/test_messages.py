"""What is said of suites and baselines that cannot be taken: ``suite/CODE[_variant]/`` holds the files and the text.

``UPDATE_GOLDEN=1`` in the environment writes the expected texts anew: read what changed.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.conftest import Outcome, tltlc  # noqa: F401

GOLDEN = Path(__file__).parents[2] / "golden" / "suite"
CASES = sorted(path for path in GOLDEN.iterdir() if path.is_dir())


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_message(
    case: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    tltlc: Callable[..., Outcome],  # noqa: F811
) -> None:
    shutil.copytree(case, tmp_path / "case")
    monkeypatch.chdir(tmp_path / "case")
    Path("expected.txt").unlink(missing_ok=True)
    before = sorted(Path().rglob("*"))
    found = tltlc("regress", "suite.toml")
    expected = case / "expected.txt"
    if os.environ.get("UPDATE_GOLDEN") == "1":
        expected.write_text(found.err, encoding="utf-8")
    assert found.err == expected.read_text(encoding="utf-8")
    assert (found.out, found.status) == ("", 2 if case.name.startswith(("TLT0720", "TLT0800")) else 1)
    assert case.name[:7] in found.err
    messages = re.split(r"^(?=error\[)", found.err, flags=re.MULTILINE)[1:]
    assert all("  help: " in message for message in messages)
    assert sorted(Path().rglob("*")) == before, "nothing was played, nothing is left"
