"""Verdicts as workflow commands of GitHub Actions."""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import unquote

import pytest

from tests.runtime.regression.handmade import PLAYED, ROOM, reference
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.github import workflow_commands
from tltl_runtime.regression.suite.suite import Suite, read_suite
from tltlc.core.record import replace

COMMAND = re.compile(r"::(error|warning) file=([^,:]*),title=([^,:]*)::([^\r\n]*)")
SUITE = '[[case]]\nlevel = "levels/room.toml"\npolicy = "navigation"\nname = "the room: 100%, v0"\n'
NAME = "the room: 100%, v0"


@pytest.fixture(name="suite")
def _suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Suite:
    (tmp_path / "game" / "levels" / "assets").mkdir(parents=True)
    (tmp_path / "game" / "levels" / "room.toml").write_text(ROOM, encoding="utf-8")
    (tmp_path / "game" / "levels" / "assets" / "guard.toml").write_text("", encoding="utf-8")
    (tmp_path / "game" / "game.toml").write_text(SUITE, encoding="utf-8")
    monkeypatch.chdir(tmp_path / "game")
    return read_suite(Path("game.toml"))


def annotated(suite: Suite, report: CaseReport, root: str = "..") -> tuple[str, ...]:
    sentence, line = workflow_commands(suite, [report], Path(root))
    assert sentence.startswith("::notice title=game::The level ")
    match = COMMAND.fullmatch(line)
    assert match, line
    return tuple(map(unquote, match.groups()))


def test_each_fail_and_review_is_a_command(suite: Suite) -> None:
    report = CaseReport(NAME, "room", "v0", "fail", ("dies: 100% of\n  them", "more"))
    assert annotated(suite, report) == (
        "error",
        "game/levels/room.toml",
        "the room: 100%, v0: fail",
        "dies: 100% of\n  them\nmore",
    )
    _, line = workflow_commands(suite, [report], Path(".."))
    assert "title=the room%3A 100%25%2C v0%3A fail::dies: 100%25 of%0A  them%0Amore" in line
    assert annotated(suite, replace(report, verdict="review"))[0] == "warning"
    assert list(workflow_commands(suite, [replace(report, verdict="pass")], Path())) == []


def test_a_command_names_the_changed_file(suite: Suite) -> None:
    before = reference().played
    report = CaseReport(NAME, "room", "v0", "fail", ("why",), played=PLAYED, reference=before)
    assert annotated(suite, report)[1] == "game/game.toml", "nothing has changed"
    changed = replace(PLAYED, files=(("room.toml", "d" * 64), ("assets/guard.toml", "0" * 64)))
    assert annotated(suite, replace(report, played=changed))[1] == "game/levels/assets/guard.toml"
    both_changed = replace(PLAYED, files=(("room.toml", "0" * 64), ("assets/guard.toml", "0" * 64)))
    assert annotated(suite, replace(report, played=both_changed))[1] == "game/levels/assets/guard.toml"


def test_an_unreadable_file_is_not_named(suite: Suite) -> None:
    name = f"assets/{'a' * 300}.toml"
    level = Path("levels/room.toml")
    level.write_text(ROOM.replace('kind = "guard"', f'kind = "{"a" * 300}"'), encoding="utf-8")
    changed = replace(PLAYED, files=((name, "0" * 64),))
    report = CaseReport(NAME, "room", "v0", "fail", ("why",), played=changed, reference=reference().played)
    assert annotated(suite, report)[1] == "game/game.toml"


def test_paths_are_relative_to_the_checkout(suite: Suite) -> None:
    report = CaseReport(NAME, "room", "v0", "fail", ("why",))
    assert annotated(suite, report, ".")[1] == "levels/room.toml"
    # A path outside the checkout stays as it is.
    assert annotated(suite, report, "levels/assets")[1] == "levels/room.toml"


def test_a_level_that_does_not_load_has_a_line_number(suite: Suite) -> None:
    report = CaseReport(NAME, "room", "v0", "fail", ("why",), fault_at=("levels/assets/guard.toml", 6))
    _, line = workflow_commands(suite, [report], Path(".."))
    assert line.startswith("::error file=game/levels/assets/guard.toml,line=6,title=")


def test_failures_come_first_and_a_new_failure_in_a_pass_is_a_notice(suite: Suite) -> None:
    new = (Finding("dies in 1 of 43 episodes; before: in 0 of 200", (3,)),)
    passed = CaseReport(NAME, "room", "v0", "pass", ("met",), new_failures=new)
    failed = replace(passed, verdict="fail")
    sentence, first, second = workflow_commands(suite, [passed, failed], Path(".."), not_judged=3)
    assert sentence == (
        "::notice title=game::1 of 2 cases cannot be played; 1 plays as before, with a new failure; 3 were not judged"
    )
    assert first.startswith("::error ") and second.startswith("::notice file=game/levels/room.toml,")
    assert second.endswith(
        "v0%3A pass%2C with a new failure::new failure: dies in 1 of 43 episodes; before: in 0 of 200"
    )
