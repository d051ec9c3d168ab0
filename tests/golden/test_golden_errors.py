"""Every error message, as the user sees it, equals the expected text of its case in ``error/``.

With the environment variable ``UPDATE_GOLDEN=1``, the test rewrites the expected texts; review the changes.
"""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.golden.cases import Case, cases
from tltlc.diagnostics.code_pages import codes, page, title
from tltlc.interfaces.cli.main import main

ROOT = Path(__file__).parents[2]
CASES = cases("error")
LEVELS = cases("level")
"""Messages of the runtime; `tests/runtime/stealth/levels/test_file.py` compares them."""
EPISODES = sorted((Path(__file__).parent / "episode").iterdir())
"""Messages about recordings; `tests/runtime/stealth/recordings/test_file.py` compares them."""
POLICIES = sorted((Path(__file__).parent / "policy").iterdir())
TRAININGS = sorted((Path(__file__).parent / "training").iterdir())
"""Messages about policies and trainings; `tests/runtime/policies` and `tests/runtime/training` compare them."""
SUITES = cases("suite")
"""Messages about suites and baselines; `tests/runtime/regression/test_messages.py` compares them."""
GAMES = cases("game")
"""Messages about games; `tests/runtime/gymnasium_games/test_messages.py` compares them."""
CODE = re.compile(r"TLT[0-9]{4}")
NEEDS_ANOTHER_INSTALLATION = {
    *("TLT0007", "TLT0009", "TLT0619", "TLT0624", "TLT0712", "TLT0730", "TLT0731", "TLT0764", "TLT0768"),
    *("TLT0770", "TLT0771", "TLT0775", "TLT0776", "TLT0777"),
    *("TLT0790", "TLT0791", "TLT0792", "TLT0793"),
    *("TLT0830", "TLT0850", "TLT0851", "TLT0852", "TLT0854"),
    *("TLT0870", "TLT0871", "TLT0873", "TLT0904", "TLT0905", "TLT0930", "TLT0931", "TLT0941", "TLT0942"),
}
"""Codes that no file can cause, at least not quickly; other tests check their messages."""


def _case(case: Case) -> object:
    """Return a case as a parameter of a test; a case with `--level` needs the extra `rl`."""
    needs_levels = "--level" in case.arguments
    lacking = needs_levels and not all(map(find_spec, ("gymnasium", "numpy")))
    return pytest.param(case, id=case.name, marks=pytest.mark.skipif(lacking, reason="needs the extra `rl`"))


@pytest.mark.parametrize("case", [_case(case) for case in CASES])
def test_a_message_equals_its_golden_text(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "case"
    case.unpack(folder)
    monkeypatch.chdir(folder)
    with pytest.raises(SystemExit) as exit_:
        main(list(case.arguments))
    printed = capsys.readouterr().err.replace(str(tmp_path), "TMP")
    case.check(printed)
    assert CODE.match(case.name)[0] in printed  # type: ignore[index]
    assert exit_.value.code in (0, 1, 2, 3, 4)
    assert "Traceback" not in printed
    # Every message suggests a fix, as a help or after the caret.
    messages = re.split(r"^(?=(?:error|warning|note)\[)", printed, flags=re.MULTILINE)[1:]
    assert all(re.search(r"  help: |\^ .*(did you mean|write|divide)", message) for message in messages)
    # No message contains the name of a terminal of the grammar.
    assert not re.search(r"\b(LPAR|RPAR|LSQB|LBRACE|NAME_|COLON|AT_MOST|WEAK_NEXT)\b|\$END|__", printed)


def test_every_code_has_a_golden_message() -> None:
    all_cases = (*CASES, *LEVELS, *EPISODES, *POLICIES, *TRAININGS, *SUITES, *GAMES)
    assert {case.name[:7] for case in all_cases} == set(codes()) - NEEDS_ANOTHER_INSTALLATION


def test_every_code_in_the_source_has_a_page_and_every_page_is_used() -> None:
    sources = [path for folder in ("tltlc", "runtime") for path in (ROOT / folder).rglob("*.py")]
    used = {code for path in sources for code in CODE.findall(path.read_text(encoding="utf-8"))}
    assert used == set(codes())


@pytest.mark.parametrize("code", codes())
def test_a_page_has_its_sections(code: str) -> None:
    text = page(code)
    assert text.startswith(f"# {code}: {title(code)}\n")
    assert "\n## Example\n" in text
    assert "\n## How to fix it\n" in text
    assert code >= "TLT0500" or "\n```tltl\n" in text
