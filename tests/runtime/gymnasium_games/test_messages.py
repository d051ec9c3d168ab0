"""The output of `tltlc check --game` equals the expected text of each case in ``tests/golden/game``."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.golden.cases import Case, cases
from tltlc.interfaces.cli.main import main


@pytest.mark.parametrize("case", cases("game"), ids=lambda case: case.name)
def test_a_message_equals_its_golden_text(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    case.unpack(tmp_path / "case")
    monkeypatch.chdir(tmp_path / "case")
    with pytest.raises(SystemExit) as exit_:
        main(list(case.arguments))
    printed = re.sub(r"[\d,]+ steps a second", "N steps a second", capfd.readouterr().err)
    # The advice on a slow game depends on how busy the machine is.
    printed = re.sub(r"    1,000,000 steps of a training take .*\n", "", printed)
    case.check(printed)
    assert case.name[:7] in printed
    assert "Traceback" not in printed
    assert ("error[" in printed) == (exit_.value.code in (1, 2))
    messages = re.split(r"^(?=(?:error|warning|note)\[)", printed, flags=re.MULTILINE)[1:]
    assert all("  help: " in message for message in messages)
