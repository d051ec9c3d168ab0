"""Every error message as its reader sees it: ``error/CODE[_variant]/`` holds the files and the expected text.

``cmd`` holds the arguments after ``tltlc`` (by default ``check input.tltl``), ``expected.txt`` what then stands
on standard error.  ``UPDATE_GOLDEN=1`` in the environment writes the expected texts anew: read what changed.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
from importlib.util import find_spec
from pathlib import Path

import pytest

from tltlc.diagnostics.codes import codes, page, title
from tltlc.interfaces.cli.main import main

ROOT = Path(__file__).parents[2]
CASES = sorted(path for path in (Path(__file__).parent / "error").iterdir() if path.is_dir())
LEVELS = sorted(path for path in (Path(__file__).parent / "level").iterdir() if path.is_dir())
"""Messages of the runtime, which `tests/runtime/stealth/levels/test_file.py` compares."""
EPISODES = sorted((Path(__file__).parent / "episode").iterdir())
"""Messages on recordings, which `tests/runtime/stealth/episodes/test_file.py` compares."""
POLICIES = sorted((Path(__file__).parent / "policy").iterdir())
TRAININGS = sorted((Path(__file__).parent / "training").iterdir())
"""Messages on policies and trainings, which tests in `tests/runtime/policies` and `tests/runtime/training` compare."""
SUITES = sorted((Path(__file__).parent / "suite").iterdir())
"""Messages on suites and baselines, which `tests/runtime/regression/test_messages.py` compares."""
CODE = re.compile(r"TLT[0-9]{4}")
NEEDS_ANOTHER_INSTALLATION = {
    *("TLT0007", "TLT0009", "TLT0624", "TLT0712", "TLT0730", "TLT0764", "TLT0768"),
    *("TLT0770", "TLT0771", "TLT0775", "TLT0776", "TLT0777"),
    *("TLT0830", "TLT0850", "TLT0851", "TLT0852", "TLT0854"),
    *("TLT0870", "TLT0871", "TLT0873", "TLT0904", "TLT0905", "TLT0930", "TLT0931", "TLT0941", "TLT0942"),
}
"""Codes that no file causes, or none that takes a short time; other tests show their messages."""


def _case(case: Path) -> object:
    """A case; one that asks for a level needs the extra `rl`."""
    command = case / "cmd"
    needs_levels = command.exists() and "--level" in command.read_text()
    lacking = needs_levels and not all(map(find_spec, ("gymnasium", "numpy")))
    return pytest.param(case, id=case.name, marks=pytest.mark.skipif(lacking, reason="needs the extra `rl`"))


@pytest.mark.parametrize("case", [_case(case) for case in CASES])
def test_message(
    case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    # A command may write: it works on a copy.
    folder = tmp_path / "case"
    shutil.copytree(case, folder)
    (folder / "expected.txt").unlink(missing_ok=True)
    monkeypatch.chdir(folder)
    command = folder / "cmd"
    arguments = shlex.split(command.read_text() if command.exists() else "check input.tltl")
    with pytest.raises(SystemExit) as exit_:
        main(arguments)
    found = capsys.readouterr().err.replace(str(tmp_path), "TMP")
    expected = case / "expected.txt"
    if os.environ.get("UPDATE_GOLDEN") == "1":
        expected.write_text(found, encoding="utf-8")
    assert found == expected.read_text(encoding="utf-8")
    assert CODE.match(case.name)[0] in found  # type: ignore[index]
    assert exit_.value.code in (0, 1, 2, 3, 4)
    assert "Traceback" not in found
    # Every message says a way out: as a help, or behind the caret.
    messages = re.split(r"^(?=(?:error|warning|note)\[)", found, flags=re.MULTILINE)[1:]
    assert all(re.search(r"  help: |\^ .*(did you mean|write|divide)", message) for message in messages)
    # The names of the grammar's terminals are no words of the language.
    assert not re.search(r"\b(LPAR|RPAR|LSQB|LBRACE|NAME_|COLON|AT_MOST|WEAK_NEXT)\b|\$END|__", found)


def test_every_code_has_a_golden_message() -> None:
    cases = (*CASES, *LEVELS, *EPISODES, *POLICIES, *TRAININGS, *SUITES)
    assert {case.name[:7] for case in cases} == set(codes()) - NEEDS_ANOTHER_INSTALLATION


def test_every_code_in_the_source_has_a_page_and_every_page_is_used() -> None:
    sources = [path for folder in ("tltlc", "runtime") for path in (ROOT / folder).rglob("*.py")]
    used = {code for path in sources for code in CODE.findall(path.read_text(encoding="utf-8"))}
    assert used == set(codes())


@pytest.mark.parametrize("code", codes())
def test_page(code: str) -> None:
    text = page(code)
    assert text.startswith(f"# {code}: {title(code)}\n")
    assert "\n## Example\n" in text
    assert "\n## How to mend it\n" in text
    assert code >= "TLT0500" or "\n```tltl\n" in text
