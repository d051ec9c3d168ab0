"""``tltlc lint`` on the command line."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.calls import calls
from tests.interfaces.cli.conftest import ROOT, Outcome
from tltlc.core.source import SourceFile
from tltlc.pipeline import compile_source
from tltlc.tools.lint.run import lint

Command = Callable[..., Outcome]

UNUSED = "signal a: bool\nsignal b: bool\nspec s = F a\n"
NOTED = "signal a: bool\nspec s { judge at goal reach a }\n"


@pytest.mark.parametrize("folder", ["examples", "stdlib_predicates"])
def test_the_shipped_files_have_no_findings(folder: str, tltlc: Command) -> None:
    outcome = tltlc("lint", ROOT / folder)
    assert (outcome.status, outcome.out) == (0, "")
    assert outcome.err.endswith("files: nothing to report\n")


def test_errors_and_warnings_exit_with_1_and_notes_with_0(tltlc: Command, inside: Path) -> None:
    texts = {"clean": "signal a: bool\nspec s = F a\n", "warned": UNUSED, "noted": NOTED, "broken": "spec s = F a\n"}
    for name, text in texts.items():
        Path(f"{name}.tltl").write_text(text)
    statuses = {name: tltlc("lint", f"{name}.tltl").status for name in texts}
    assert statuses == {"clean": 0, "warned": 1, "noted": 0, "broken": 1}
    assert tltlc("lint", "none.tltl").status == 3
    assert tltlc("lint", "--nonsense").status == 2


def test_files_and_folders_are_linted(tltlc: Command, inside: Path) -> None:
    Path("levels/deep").mkdir(parents=True)
    Path("levels/.hidden").mkdir()
    for place in ("levels/one", "levels/deep/two", "levels/.hidden/three"):
        Path(f"{place}.tltl").write_text(UNUSED)
    outcome = tltlc("lint")
    assert outcome.err.count("warning[TLT0421]") == 2
    assert "levels/one.tltl:2:8" in outcome.err and "hidden" not in outcome.err
    assert tltlc("lint", "levels/deep", "hide.tltl").err.count("warning[") == 1


def test_a_finding_in_a_shared_import_is_reported_once(tltlc: Command, inside: Path) -> None:
    Path("jumpy.tltl").write_text("signal x in [0, 9]\npredicate p in [-1, 1] = when x < 5: x / 9 - 1 otherwise: 1\n")
    for name in ("one", "two"):
        Path(f"{name}.tltl").write_text("import jumpy\nspec s = F p\n")
    assert tltlc("lint", "one.tltl", "two.tltl").err.count("TLT0402") == 1


def test_a_read_only_file_is_not_fixed(tltlc: Command, inside: Path) -> None:
    path = Path("unused.tltl")
    path.write_text(UNUSED)
    path.chmod(0o444)
    outcome = tltlc("lint", "--fix", "unused.tltl")
    path.chmod(0o644)
    assert outcome.status == 3
    assert "error[TLT0005]: cannot write `unused.tltl`: it is read-only" in outcome.err
    assert path.read_text() == UNUSED


def test_standard_input_is_linted_but_not_fixed(process) -> None:  # type: ignore[no-untyped-def]
    outcome = process("lint", "-", stdin=UNUSED.encode())
    assert outcome.status == 1 and "<stdin>:2:8" in outcome.err
    assert process("lint", "-", "--fix", stdin=UNUSED.encode()).status == 2


def test_fixes_are_written_and_listed(tltlc: Command, inside: Path) -> None:
    Path("s.tltl").write_text("signal a: bool\nsignal b: bool\nlet c = F b\nspec s { judge at goal reach a }\n")
    before = Path("hide.tltl").stat().st_mtime_ns
    outcome = tltlc("lint", "--fix", "s.tltl", "hide.tltl")
    assert outcome.status == 0
    assert Path("s.tltl").read_text() == "signal a: bool\nspec s { judge at goal reach a }\n"
    assert "fixed s.tltl:3: nothing uses the let `c`\nfixed s.tltl:2: nothing uses the signal `b`\n" in outcome.err
    assert "note[TLT0419]" in outcome.err
    assert Path("hide.tltl").stat().st_mtime_ns == before
    again = tltlc("lint", "--fix", "s.tltl")
    assert "fixed" not in again.err


def test_a_link_out_of_the_folder_is_not_changed(tltlc: Command, inside: Path) -> None:
    text = "signal a: bool\nsignal  u: bool\nspec s { limit 5 steps reach a }\n"
    (inside / "out").mkdir()
    (inside / "in").mkdir()
    (inside / "out" / "o.tltl").write_text(text)
    (inside / "in" / "link.tltl").symlink_to("../out/o.tltl")
    for command in (("lint", "--fix", "in"), ("fmt", "in")):
        outcome = tltlc(*command)
        assert "in/link.tltl was not changed: it is a link to a file outside the folder" in outcome.err
        assert (inside / "out" / "o.tltl").read_text() == text
    tltlc("lint", "--fix", "in/link.tltl")
    assert "u: bool" not in (inside / "out" / "o.tltl").read_text()


def test_names_that_other_files_use_are_kept(tltlc: Command, inside: Path) -> None:
    Path("deep").mkdir()
    level = "entity exit\nsignal at(e): bool\nlet out = F at(exit)\nlet later = F out\nsignal b: bool\n"
    Path("vault.tltl").write_text(level + "signal a: bool\nspec s = F a\n")
    # The name is used through a file in between, with an alias, and from another folder.
    Path("between.tltl").write_text("import vault as first\nlet both = first.later & first.a\n")
    Path("deep/last.tltl").write_text('import "../between.tltl"\nspec t = both & X both\n')
    outcome = tltlc("lint", "--fix", "vault.tltl")
    assert "fixed vault.tltl:5: nothing uses the signal `b`\n" in outcome.err
    assert Path("vault.tltl").read_text() == level.replace("signal b: bool\n", "") + "signal a: bool\nspec s = F a\n"
    assert tltlc("check", "deep/last.tltl").status == 0
    Path("between.tltl").unlink()
    assert tltlc("lint", "vault.tltl").err.count("TLT0421") == 1
    tltlc("lint", "--fix", "vault.tltl")
    assert Path("vault.tltl").read_text() == "signal a: bool\nspec s = F a\n"


def test_uses_in_files_of_the_same_run_count(tltlc: Command, inside: Path) -> None:
    for folder in ("here/.git", "there/.git"):
        Path(folder).mkdir(parents=True)
    text = "entity exit\nsignal a: bool\nspec s = F a\n"
    Path("here/level.tltl").write_text(text)
    user = 'import "../here/level.tltl"\nsignal at(e): bool\nspec t = F at(exit)\n'
    Path("there/user.tltl").write_text(user)
    assert tltlc("lint", "--fix", "here/level.tltl", "there/user.tltl").status == 0
    assert (Path("here/level.tltl").read_text(), Path("there/user.tltl").read_text()) == (text, user)


def test_findings_are_printed_in_each_format(tltlc: Command, inside: Path) -> None:
    Path("s.tltl").write_text(UNUSED)
    assert [
        diagnostic["code"] for diagnostic in json.loads(tltlc("lint", "--format", "json", "s.tltl").out)["diagnostics"]
    ] == ["TLT0421"]
    assert json.loads(tltlc("lint", "--format", "sarif", "s.tltl").out)["runs"][0]["results"][0]["level"] == "warning"
    assert tltlc("lint", "--format", "github", "s.tltl").out.startswith("::warning file=s.tltl,line=2")
    fixed = tltlc("lint", "--format", "json", "--fix", "s.tltl")
    assert (fixed.status, json.loads(fixed.out)["diagnostics"]) == (0, [])


def test_in_text_the_unused_declarations_of_a_file_are_one_finding(tltlc: Command, inside: Path) -> None:
    unused = "".join(f"signal b{number}: bool\n" for number in range(25))
    for name in ("one", "two"):
        Path(f"{name}.tltl").write_text(f"signal a: bool\n{unused}entity pair = e, f\nspec s = F a\n")
    outcome = tltlc("lint")
    names = ", ".join(f"`b{number}`" for number in range(20))
    assert outcome.err.count(f"warning[TLT0421]: nothing uses 25 declarations: {names} and 5 more\n") == 2
    # The group has no fix: its members may be in use.
    assert outcome.err.count("nothing uses the group `pair`") == 2
    assert outcome.err.count("a column of a recording needs no declaration") == 2
    machine = tltlc("lint", "--format", "json", "one.tltl").out
    assert len([found for found in json.loads(machine)["diagnostics"] if found["code"] == "TLT0421"]) == 26
    tltlc("lint", "--fix", "one.tltl")
    assert "signal b" not in Path("one.tltl").read_text()


def test_the_project_sets_the_levels(tltlc: Command, inside: Path) -> None:
    Path("s.tltl").write_text(UNUSED)
    for level, expected in (("allow", 0), ("note", 0), ("warning", 1), ("error", 1)):
        Path("tltl.toml").write_text(f'[lint]\n{level} = ["TLT0421"]\n')
        outcome = tltlc("lint", "s.tltl")
        assert outcome.status == expected
        assert (f"{level}[TLT0421]" in outcome.err) == (level != "allow")
    Path("tltl.toml").write_text('[lint]\nallow = ["TLT0421"]\n')
    assert tltlc("lint", "--fix", "s.tltl").status == 0
    assert Path("s.tltl").read_text() == UNUSED


def test_params_and_libraries_are_options(tltlc: Command, inside: Path) -> None:
    Path("libraries").mkdir()
    Path("libraries/mine.tltl").write_text("signal a: bool\nparam n: number in [1, 9] = 2\n")
    Path("s.tltl").write_text("import mine\nsignal x in [0, 20]\nspec s = F a & F x > n\n")
    assert tltlc("lint", "s.tltl").status == 1
    assert tltlc("lint", "s.tltl", "--library", "libraries", "--param", "n=3").status == 0


def test_an_artefact_cannot_be_linted(tltlc: Command, inside: Path) -> None:
    tltlc("compile", "hide.tltl", "-t", "json")
    outcome = tltlc("lint", "hide.fspa.json")
    assert outcome.status == 2 and "TLT0722" in outcome.err


@pytest.mark.parametrize(
    "text",
    [
        *(
            (ROOT / "examples" / f"{name}.tltl").read_text("utf-8")
            for name in ("cover_and_hide", "navigation", "branching")
        ),
        "entity a, b, c, d, e, f\nsignal at(x): bool\nspec s { " + " ".join(f"reach at({x})" for x in "abcdef") + " }",
        "signal a: bool signal b: bool spec s = G (a -> F[0,200] b)",
    ],
    ids=["cover_and_hide", "navigation", "branching", "many goals", "many states"],
)
def test_linting_costs_less_than_four_times_compiling(text: str) -> None:
    source = SourceFile("example.tltl", text)
    lint(source)  # Warm up: read the libraries.
    assert calls(lambda: lint(source)) < 4 * calls(lambda: compile_source(source))


def test_a_comment_in_a_list_of_entities_applies_to_its_line(inside: Path, tltlc: Callable[..., Outcome]) -> None:
    Path("list.tltl").write_text(
        "signal p: bool\nentity e,\n  // tltlc: allow TLT0421\n  f,\n  g,\n  h // tltlc: allow TLT0421\nspec a = F p\n"
    )
    outcome = tltlc("lint", "list.tltl")
    assert "list.tltl:2:8" in outcome.err
    assert "nothing uses 2 declarations: `e`, `g`\n" in outcome.err
