"""``tltlc check`` shows what the linter finds."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from tests.interfaces.cli.conftest import Outcome

Command = Callable[..., Outcome]

SPECS = """signal a: bool
signal b: bool
spec repeated { reach a then a }
spec noted { keep a implies a until b }
spec plain { reach b }
"""


def test_warnings_and_notes_are_shown(tltlc: Command, inside: Path) -> None:
    Path("game.tltl").write_text(SPECS)
    outcome = tltlc("check", "game.tltl")
    assert outcome.status == 0
    assert "warning[TLT0445]" in outcome.err and "note[TLT0448]" in outcome.err
    assert "nothing to report" not in outcome.err
    assert outcome.err.count("help:") == 2


def test_of_a_named_spec_its_own_warnings_are_shown(tltlc: Command, inside: Path) -> None:
    Path("game.tltl").write_text(SPECS)
    assert tltlc("check", "game.tltl:plain").err == "game.tltl: 1 spec, nothing to report\n"
    assert "warning[TLT0445]" in tltlc("check", "game.tltl:repeated").err


def test_warnings_are_in_json_with_their_places(tltlc: Command, inside: Path) -> None:
    Path("game.tltl").write_text(SPECS)
    diagnostics = json.loads(tltlc("check", "--format", "json", "game.tltl").out)["diagnostics"]
    found = [(diagnostic["code"], diagnostic["severity"]) for diagnostic in diagnostics]
    assert found == [("TLT0445", "warning"), ("TLT0448", "note")]


def test_levels_of_the_project_apply(tltlc: Command, inside: Path) -> None:
    Path("game.tltl").write_text(SPECS)
    Path("tltl.toml").write_text('[lint]\nerror = ["TLT0445"]\n')
    outcome = tltlc("check", "game.tltl")
    assert outcome.status == 1 and "error[TLT0445]" in outcome.err
    Path("tltl.toml").write_text('[lint]\nallow = ["TLT0445", "TLT0448"]\n')
    assert tltlc("check", "game.tltl").err == "game.tltl: 3 specs, nothing to report\n"


def test_what_is_unused_is_left_to_lint(tltlc: Command, inside: Path) -> None:
    Path("game.tltl").write_text("signal a: bool\nsignal b: bool\nspec s { reach a }  // tltlc: allow TLT0445\n")
    assert "nothing to report" in tltlc("check", "game.tltl").err
    assert "TLT0421" in (linted := tltlc("lint", "game.tltl").err) and "TLT0427" in linted


def test_advice_about_training_is_left_to_lint_unless_the_project_asks_for_it(tltlc: Command, inside: Path) -> None:
    Path("game.tltl").write_text("signal a: bool\nspec s { judge at limit\n    avoid a }\n")
    assert "nothing to report" in tltlc("check", "game.tltl").err
    assert "note[TLT0419]" in tltlc("lint", "game.tltl").err
    Path("tltl.toml").write_text('[lint]\nwarning = ["TLT0419"]\n')
    assert "warning[TLT0419]" in tltlc("check", "game.tltl").err


def test_a_warning_of_the_compiler_is_left_out_where_the_linter_says_more(tltlc: Command, inside: Path) -> None:
    clauses = ("keep eventually a", "keep eventually not a")
    text = f"signal a: bool\nspec s {{\n    {clauses[0]}\n    {clauses[1]}\n}}\n"
    Path("game.tltl").write_text(text)
    checked = tltlc("check", "game.tltl").err
    assert checked.count("warning[TLT0424]") == 2 and "TLT0410" not in checked
    assert "warning[TLT0410]" in tltlc("compile", "game.tltl", "-o", "out").err
    Path("game.tltl").write_text(text.replace("spec s {", "spec s {  // tltlc: allow TLT0424"))
    assert "warning[TLT0410]" in tltlc("check", "game.tltl").err


def test_an_artefact_has_no_text_to_lint(tltlc: Command, inside: Path) -> None:
    Path("game.tltl").write_text(SPECS)
    tltlc("compile", "game.tltl:repeated", "-o", "out")
    assert "nothing to report" in tltlc("check", "out/repeated.fspa.json").err


def test_an_error_of_the_linter_is_a_warning_because_the_file_compiles(tltlc: Command, inside: Path) -> None:
    text = "signal x in [0, 1]\npredicate wide in [-1, 1] = 0 - x\nspec s = F wide\n"
    Path("game.tltl").write_text(text)
    assert "error[TLT0416]" in tltlc("lint", "game.tltl").err
    outcome = tltlc("check", "game.tltl")
    assert outcome.status == 0 and "warning[TLT0416]" in outcome.err
