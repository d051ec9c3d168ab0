from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, HIDE

TARGETS = ("-t", "json,dot")


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_the_default_targets_are_written(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("compile", EXAMPLE, "-o", "build/deep")
    assert (outcome.status, outcome.out) == (0, "")
    names = ["cover_and_hide.dot", "cover_and_hide.fspa.json", "cover_and_hide_monitor.py"]
    assert sorted(contents(Path("build/deep"))) == names
    for name in names:
        assert f"wrote {Path('build/deep', name)}\n" in outcome.err
    assert len(json.loads(Path("build/deep/cover_and_hide.fspa.json").read_text())["states"]) == 5


def test_the_labels_are_those_of_the_paper(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    tltlc("compile", EXAMPLE, *TARGETS)
    states = json.loads(Path("cover_and_hide.fspa.json").read_text())["states"]
    a, b, c = "near(s1)", "near(s2)", "near(exit)"
    assert {state["label"]["ascii"] for state in states} == {
        f"F({a} & X F({b} & X F {c})) & G alive",
        f"F({b} & X F {c}) & G alive",
        f"F {c} & G alive",
        "G alive",
        "false",
    }


def test_the_output_is_reproducible(process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    for seed in ("1", "2"):
        assert process("compile", EXAMPLE, "-o", seed, PYTHONHASHSEED=seed).status == 0
    assert contents(Path("1")) == contents(Path("2"))


def test_some_of_several_specs_are_compiled(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("two.tltl").write_text(HIDE + "spec leave = F seen\nspec stay = G seen\n")
    assert tltlc("compile", "two.tltl", *TARGETS, "-o", "named", "--spec", "stay", "--spec", "leave").status == 0
    assert sorted(contents(Path("named"))) == ["leave.dot", "leave.fspa.json", "stay.dot", "stay.fspa.json"]
    assert tltlc("compile", "two.tltl:stay", *TARGETS, "-o", "picked").status == 0
    assert sorted(contents(Path("picked"))) == ["stay.dot", "stay.fspa.json"]


@pytest.mark.parametrize(
    "broken",
    [
        HIDE + "spec leave = F nowhere\n",
        HIDE + "spec leave = F (\n",
        HIDE + "signal a: bool\nspec hard = " + " & ".join(f"F (seen & {'X ' * i}a)" for i in range(1, 14)) + "\n",
    ],
    ids=["a name", "syntax", "the state budget"],
)
def test_nothing_is_written_if_one_spec_fails(broken: str, tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("compile", "hide.tltl", *TARGETS, "-o", "out").status == 0
    before = contents(Path("out"))
    Path("hide.tltl").write_text(broken.replace("G !seen", "F seen"))
    assert tltlc("compile", "hide.tltl", *TARGETS, "-o", "out", "--state-budget", "20").status == 1
    assert tltlc("compile", "hide.tltl", *TARGETS, "-o", "other", "--state-budget", "20").status == 1
    assert contents(Path("out")) == before
    assert not Path("other").exists()


def test_nothing_is_written_if_one_file_cannot_be(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("out/hide.dot").mkdir(parents=True)
    Path("out/hide.fspa.json").write_text("older")
    outcome = tltlc("compile", "hide.tltl", *TARGETS, "-o", "out")
    assert outcome.status == 3
    assert "TLT0005" in outcome.err
    assert "hide.dot" in outcome.err
    assert sorted(path.name for path in Path("out").iterdir()) == ["hide.dot", "hide.fspa.json"]
    assert Path("out/hide.fspa.json").read_text() == "older"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder_exits_with_3(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("out").mkdir(mode=0o500)
    assert tltlc("compile", "hide.tltl", *TARGETS, "-o", "out").status == 3


def test_links_and_permissions_of_existing_files_are_kept(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("real.dot").write_text("older")
    Path("real.dot").chmod(0o640)
    Path("hide.dot").symlink_to("real.dot")
    assert tltlc("compile", "hide.tltl", *TARGETS).status == 0
    assert Path("hide.dot").is_symlink()
    assert Path("real.dot").read_text().startswith("digraph")
    assert Path("real.dot").stat().st_mode & 0o777 == 0o640


def test_a_change_to_one_spec_changes_only_its_files(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    from tltlc import backends

    targets = ",".join(target for target in backends.targets() if target not in ("png", "svg", "gdscript3"))
    text = "signal seen: bool\nspec calm = G !seen\nspec found = F seen\n"
    (inside / "two.tltl").write_text(text)
    assert tltlc("compile", "two.tltl", "-o", "out", "-t", targets).status == 0
    before = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in (inside / "out").iterdir()}

    (inside / "two.tltl").write_text("// a comment above\n\n" + text.replace("F seen", "F(seen & X !seen)"))
    outcome = tltlc("compile", "two.tltl", "-o", "out", "-t", targets)
    changed = {
        path.name
        for path, contents_and_time in before.items()
        if (path.read_bytes(), path.stat().st_mtime_ns) != contents_and_time
    }
    assert changed and all(name.startswith(("found", "Found")) for name in changed)
    assert {"found.fspa.json", "found_monitor.py", "found_monitor.h"} <= changed
    written_lines = [line for line in outcome.err.splitlines() if line.startswith("wrote ")]
    assert len(written_lines) == len(changed)
    assert outcome.err.splitlines()[-1] == f"{len(before) - len(changed)} files have not changed"


def test_several_files_are_compiled_together(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    (inside / "seek.tltl").write_text("signal seen: bool\nspec seek = F seen\n")
    outcome = tltlc("compile", "hide.tltl", "seek.tltl", "-o", "out", "-t", "json")
    assert (outcome.status, outcome.err) == (0, "wrote out/hide.fspa.json\nwrote out/seek.fspa.json\n")
    (inside / "seek.tltl").write_text("spec seek = F sen\n")
    (inside / "hide.tltl").write_text("spec hide = G sen\n")
    outcome = tltlc("compile", "hide.tltl", "seek.tltl", "-o", "other")
    assert outcome.status == 1 and outcome.err.count("error[TLT0201]") == 2
    assert not (inside / "other").exists()


def test_two_files_with_specs_of_the_same_name_are_rejected(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    (inside / "again.tltl").write_text("signal seen: bool\nspec hide = F seen\n")
    outcome = tltlc("compile", "hide.tltl", "again.tltl", "-t", "json")
    assert outcome.status == 2
    assert outcome.err == (
        "error[TLT0700]: `hide.tltl` and `again.tltl` both make `hide.fspa.json`\n"
        "  help: rename one of the specs, or compile each file into a folder of its own, with -o\n"
    )
    assert sorted(path.name for path in inside.iterdir()) == ["again.tltl", "hide.tltl"]


@pytest.mark.parametrize(
    ("name", "suggestion"),
    [("C#", "csharp"), ("cpp", "c"), ("js", "javascript"), ("godot", "gdscript"), ("pyton", "python")],
)
def test_other_names_of_a_target_get_a_suggestion(name: str, suggestion: str, tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("compile", "hide.tltl", "-t", name)
    assert (outcome.status, outcome.err) == (
        2,
        f"error[TLT0710]: there is no target `{name}`\n  help: did you mean `{suggestion}`?\n",
    )


def test_two_targets_that_write_the_same_file_are_rejected(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("compile", "hide.tltl", "-t", "gdscript,gdscript3")
    assert outcome.status == 2
    message = "`gdscript` and `gdscript3` both write `hide_monitor.gd`: choose one with -t, and write the other to"
    assert f"{message} another folder with -o" in outcome.err
    assert [path.name for path in inside.iterdir()] == ["hide.tltl"]


def test_two_specs_that_make_the_same_file_are_rejected(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    (inside / "two.tltl").write_text("signal seen: bool\nspec hide_here = G !seen\nspec hideHere = F seen\n")
    outcome = tltlc("compile", "two.tltl", "-t", "csharp")
    assert outcome.status == 2
    assert "the specs `hide_here` and `hideHere` both make `HideHereMonitor.cs`: rename one of them" in outcome.err
    assert not [*inside.glob("*.cs")]
    assert tltlc("compile", "two.tltl", "-t", "python").status == 0


def test_a_device_is_written_to_and_not_replaced(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("null.svg").symlink_to("/dev/null")
    assert tltlc("render", "hide.tltl", "-o", "null.svg").status == 0
    assert Path("/dev/null").is_char_device()


def test_a_file_without_specs_is_reported(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("library.tltl").write_text("signal seen: bool\n")
    outcome = tltlc("compile", "library.tltl")
    assert outcome.status == 0
    assert outcome.err == "library.tltl: it contains no spec\n"


def test_hostile_documentation_is_escaped(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("hide.tltl").write_text('/// """ \\ */ </script> %% {{ }} \' "; import os\n' + HIDE.split("\n", 1)[1])
    Path("hide.tltl").write_text("signal seen: bool\n" + Path("hide.tltl").read_text())
    assert tltlc("compile", "hide.tltl", "-t", "json,dot,python,mermaid,svg").status == 0
    compile(Path("hide_monitor.py").read_text(), "hide_monitor.py", "exec")
