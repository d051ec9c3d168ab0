from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.interfaces.cli.conftest import EXAMPLE, Outcome
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.project import Project, project_for, read_project


def test_without_a_project_file_the_defaults_apply(inside: Path) -> None:
    assert project_for("hide.tltl") == Project()
    assert project_for("-") == Project()


def test_the_nearest_project_file_upwards_is_used(inside: Path) -> None:
    Path("levels/deep").mkdir(parents=True)
    Path("predicates").mkdir()
    Path("tltl.toml").write_text('libraries = ["predicates"]\r\ntargets = ["dot"]\r\n[style]\r\nnotation = "ascii"\r\n')
    assert project_for("levels/deep/x.tltl") == Project((Path("predicates"),), ("dot",), "ascii")
    project = project_for(str(inside / "levels/deep/x.tltl"))
    assert project.libraries == (inside / "predicates",)
    Path("levels/tltl.toml").write_text("")
    assert project_for("levels/deep/x.tltl") == Project()


def test_the_game_of_a_project_is_relative_to_its_file(inside: Path) -> None:
    Path("specs").mkdir()
    Path("a.game.toml").write_text("")
    Path("tltl.toml").write_text('game = "a.game.toml"\n')
    assert project_for("specs/x.tltl").game == Path("a.game.toml")
    assert project_for(str(inside / "specs/x.tltl")).game == inside / "a.game.toml"


@pytest.mark.parametrize(
    ("value", "title"),
    [
        ('"none.game.toml"', "there is no file `none.game.toml` beside this file"),
        ('"hide.tltl"', 'wrong value for `game`: "hide.tltl"'),
        ('["a.game.toml"]', "wrong value for `game`: a list"),
    ],
)
def test_another_game_is_an_error(inside: Path, value: str, title: str) -> None:
    Path("tltl.toml").write_text(f"game = {value}\n")
    with pytest.raises(TltlError) as error:
        read_project(inside / "tltl.toml")
    (diagnostic,) = error.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == ("TLT0703", title)
    assert diagnostic.labels


def test_settings_of_the_project_apply(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("predicates").mkdir()
    Path("predicates/mine.tltl").write_text("signal health in [0, 1]\npredicate fit in [0, 1] = health\n")
    Path("level").mkdir()
    Path("level/one.tltl").write_text("import mine\nspec one = G fit\n")
    assert tltlc("check", "level/one.tltl").status == 1
    assert tltlc("check", "level/one.tltl", "--library", "predicates").status == 0
    Path("tltl.toml").write_text('libraries = ["predicates"]\ntargets = ["dot"]\n[style]\nnotation = "english"\n')
    assert tltlc("compile", "level/one.tltl").status == 0
    assert not Path("one.fspa.json").exists()
    assert "Keep fit throughout" in Path("one.dot").read_text()
    assert tltlc("compile", "level/one.tltl", "-t", "json").status == 0
    assert Path("one.fspa.json").exists()
    assert "fit" in tltlc("list", "predicates").out


def test_a_library_has_one_name_in_messages(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("lib").mkdir()
    Path("lib/arena.tltl").write_text("signal hp: ratio\npredicate low = hp < 20\n")
    Path("specs").mkdir()
    Path("specs/one.tltl").write_text("import arena\nspec one = F low\n")
    Path("specs/two.tltl").write_text("import arena\nspec two = G low\n")
    Path("tltl.toml").write_text('libraries = ["specs/../lib"]\n')
    diagnostics = json.loads(tltlc("lint", ".", "--format", "json").out)["diagnostics"]
    assert [(diagnostic["code"], diagnostic["labels"][0]["file"]) for diagnostic in diagnostics] == [
        ("TLT0302", "lib/arena.tltl")
    ]


def test_all_errors_of_a_project_file_are_reported(inside: Path) -> None:
    text = 'librarys = []\ntargets = 3\nlibraries = ["no", "nor"]\n[style]\nnotaton = ""\nnotation = ["x"]\n'
    Path("tltl.toml").write_text(text)
    with pytest.raises(TltlError) as failure:
        read_project(inside / "tltl.toml")
    codes_and_keys = [(d.code, d.title.partition("`")[2].partition("`")[0]) for d in failure.value.diagnostics]
    assert codes_and_keys == [
        ("TLT0702", "librarys"),
        ("TLT0702", "notaton"),
        ("TLT0703", "targets"),
        ("TLT0703", "notation"),
        ("TLT0703", "no"),
        ("TLT0703", "nor"),
    ]


def test_an_unknown_target_is_reported(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("tltl.toml").write_text('targets = ["jsno"]')
    assert "did you mean `json`?" in tltlc("compile", "hide.tltl").err


KEYS = st.from_regex(r"\A(libraries|targets|style|\[style\]\n?notation) ?=? ?[\[\"\{0-9a-z\]\},. ]*\Z")


@given(st.text(max_size=60) | KEYS)
def test_any_text_is_read_or_rejected(text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "tltl.toml")
        path.write_bytes(text.encode())
        try:
            read_project(path)
        except TltlError as error:
            assert {diagnostic.code for diagnostic in error.diagnostics} <= {"TLT0003", "TLT0701", "TLT0702", "TLT0703"}


def test_a_deleted_current_folder_is_not_reported_as_a_bug(
    tltlc: Callable[..., Outcome], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert tltlc("check", EXAMPLE).status == 0
    assert tltlc("check", "hide.tltl").status == 3
    (tmp_path / "above.tltl").write_text("signal a: bool\n", encoding="utf-8")
    (tmp_path / "main.tltl").write_text('import "above.tltl"\nspec s = F a\n', encoding="utf-8")
    outcome = tltlc("check", "../main.tltl")
    assert outcome.status == 1
    assert "the current folder has been deleted: start tltlc in another one" in outcome.err


@pytest.mark.parametrize("kind", ["link", "folder", "pipe"])
def test_a_project_file_that_is_no_regular_file_is_reported(
    inside: Path, tltlc: Callable[..., Outcome], kind: str
) -> None:
    if kind == "link":
        Path("tltl.toml").symlink_to("nowhere")
    elif kind == "folder":
        Path("tltl.toml").mkdir()
    else:
        os.mkfifo("tltl.toml")
    outcome = tltlc("check", "hide.tltl")
    assert (outcome.status, "error[TLT0001]" in outcome.err, "tltl.toml" in outcome.err) == (3, True, True)
