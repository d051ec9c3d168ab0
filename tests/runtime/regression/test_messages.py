"""Messages about unreadable suites and baselines: the cases in ``tests/golden/suite``.

``UPDATE_GOLDEN=1`` in the environment rewrites the expected texts; review the changes.
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
def test_the_message_is_as_expected(
    case: Case,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    tltlc: Callable[..., Outcome],  # noqa: F811
) -> None:
    case.unpack(tmp_path / "case")
    monkeypatch.chdir(tmp_path / "case")
    before = sorted(Path().rglob("*"))
    result = tltlc(*case.arguments)
    case.check(result.err)
    assert (result.out, result.status) == ("", 2 if case.name.startswith(("TLT0720", "TLT0800")) else 1)
    assert case.name[:7] in result.err
    messages = re.split(r"^(?=error\[)", result.err, flags=re.MULTILINE)[1:]
    assert all("  help: " in message for message in messages)
    assert sorted(Path().rglob("*")) == before, "nothing was played, nothing is left"
