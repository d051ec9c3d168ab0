"""``tltlc regress --changed``: the cases that depend on the named files."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests import pipes
from tests.interfaces.cli.conftest import tltlc  # noqa: F401
from tests.runtime.cli.regressions import NAMES, ONE, Run, _recorded, verdicts  # noqa: F401
from tests.runtime.regression.game import edit
from tests.runtime.regression.recorded_game import _game  # noqa: F401


def test_a_suite_after_changed_is_rejected(tltlc: Run, game: Path) -> None:  # noqa: F811
    refused = tltlc("regress", "--changed", "guard", "game.toml")
    assert refused.status == 2
    assert "`game.toml` counts as a file of --changed: put the suite before --changed" in refused.err


def test_changed_runs_only_the_cases_that_depend_on_the_files(tltlc: Run, game: Path) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", *ONE, "--changed", "soon.safetensors", "README.md", "--json", "report.json")
    assert verdicts(result.out) == ["hopeless fail"]
    lines = result.err.splitlines()
    assert lines[:2] == [
        "no case depends on README.md",
        "left out, because they depend on none of the named files: room:v0, room:v1",
    ]
    report = json.loads(Path("report.json").read_text(encoding="utf-8"))
    assert (report["left_out"], report["complete"], len(report["cases"])) == (NAMES[:2], True, 1)
    all_cases = tltlc("regress", "game.toml", *ONE, "--changed", "soon", "--changed", "guard_alert.toml", "easy")
    assert verdicts(all_cases.out) == ["hopeless fail", "room:v0 pass", "room:v1 pass"]
    assert "left out" not in all_cases.err


@pytest.mark.parametrize("words", [[], ["README.md", "src/game.py"]])
def test_changed_may_select_no_case(tltlc: Run, game: Path, words: list[str]) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", "--junit", "report.xml", *ONE, "--changed", *words)
    assert (result.status, result.out) == (0, "there was no case to judge\n")
    # The page is replaced; the page of an earlier run could be mistaken for the page of this run.
    why = "it depends on none of the files that --changed names" if words else "--changed names no file"
    assert Path("regression/game/report.html").read_text(encoding="utf-8").count(why) == 2 * len(NAMES)
    assert f"left out, because they depend on none of the named files: {', '.join(NAMES)}" in result.err
    assert ("no case depends on README.md, src/game.py" in result.err) == bool(words)
    (tests,) = ET.parse("report.xml").getroot()
    assert tests.get("tests") == "0"


def test_a_similar_file_is_suggested_for_a_name_after_changed(tltlc: Run, game: Path) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", *ONE, "--changed", "gaurd", "assets/hopeles.toml")
    assert (result.status, result.out) == (0, "there was no case to judge\n")
    lines = result.err.splitlines()
    assert lines[:2] == [
        "no case depends on gaurd, assets/hopeles.toml",
        "warning: there is no file `gaurd`: did you mean `guard`?",
    ]
    assert "warning" not in lines[2]
    # No warning for an existing file, or for a file that was renamed to a file that is named, too.
    Path("gaurd.toml").touch()
    assert "warning" not in tltlc("regress", "game.toml", *ONE, "--changed", "gaurd.toml").err
    assert "warning" not in tltlc("regress", "game.toml", *ONE, "--changed", "rooms.toml", "room.toml").err
    github = tltlc("regress", "game.toml", "--github", *ONE, "--changed", "rooms.toml")
    assert github.out.startswith(
        "::warning title=--changed::there is no file `rooms.toml`: did you mean `room.toml`?\n"
    )


def test_changed_files_that_are_not_named_give_a_warning(tltlc: Run, game: Path) -> None:  # noqa: F811
    edit("room.toml", "8.0, 8.0", "8.0, 8.5")
    result = tltlc("regress", "game.toml", *ONE, "--changed", "soon")
    warning = "warning: `room.toml` has changed since the baseline, but --changed does not name it; left out: "
    assert f"{warning}room:v0, room:v1" in result.err.splitlines()
    result = tltlc("regress", "game.toml", *ONE, "--changed", "README.md")
    assert f"{warning}room:v0, room:v1, hopeless" in result.err.splitlines() and result.status == 0
    # One case is enough.
    text = Path("game.toml").read_text(encoding="utf-8")
    Path("game.toml").write_text("[[case]]".join(text.split("[[case]]")[:2]), encoding="utf-8")
    assert "warning" not in tltlc("regress", "game.toml", *ONE, "--changed", "room").err
    # Without a baseline, changes are unknown.
    Path("game.baseline.json").unlink()
    assert "warning" not in tltlc("regress", "game.toml", *ONE, "--changed", "README.md").err


def test_a_pipe_after_changed_is_not_read(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pipes.put_beside(Path("pipe.toml"))
    pipes.forbid(monkeypatch)
    monkeypatch.setattr("tltl_runtime.cli.support.regression_run.run", lambda _: 0)
    assert tltlc("regress", "--changed", "pipe.toml").status == 0
