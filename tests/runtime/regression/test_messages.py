"""Messages on suites and baselines that cannot be read: the cases in ``tests/golden/suite``.

``UPDATE_GOLDEN=1`` in the environment writes the expected texts anew: read what changed.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.golden.cases import Case, cases
from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401

CASES = cases("suite")


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_message(
    case: Case,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    tltlc: Callable[..., Outcome],  # noqa: F811
) -> None:
    case.unpack(tmp_path / "case")
    monkeypatch.chdir(tmp_path / "case")
    before = sorted(Path().rglob("*"))
    found = tltlc(*case.arguments)
    case.check(found.err)
    assert (found.out, found.status) == ("", 2 if case.name.startswith(("TLT0720", "TLT0800")) else 1)
    assert case.name[:7] in found.err
    messages = re.split(r"^(?=error\[)", found.err, flags=re.MULTILINE)[1:]
    assert all("  help: " in message for message in messages)
    assert sorted(Path().rglob("*")) == before, "nothing was played, nothing is left"
