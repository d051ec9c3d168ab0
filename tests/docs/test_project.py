"""The page on projects lists the keys of `tltl.toml`, and its example is read correctly."""

from __future__ import annotations

import re
from pathlib import Path

from tests.docs.blocks import DOCS, blocks
from tltlc.io import project

PAGE = DOCS / "guides" / "project.md"
TEXT = PAGE.read_text(encoding="utf-8")
ROWS = [
    [re.findall(r"`([^`]+)`", cell) for cell in row.strip("|").split("|")]
    for row in TEXT.splitlines()
    if row.startswith("| `")
]


def test_the_example_is_read_as_documented(tmp_path: Path) -> None:
    (text,) = (block.text for block in blocks(PAGE) if block.kind == "toml")
    (tmp_path / "predicates").mkdir()
    (tmp_path / "arena.game.toml").write_text("")
    (tmp_path / "tltl.toml").write_text(text)
    assert project.read_project(tmp_path / "tltl.toml") == project.Project(
        libraries=(tmp_path / "predicates",),
        targets=("json", "csharp"),
        notation="english",
        lint={"TLT0419": "allow", "TLT0424": "error"},
        formatting="letters",
        game=tmp_path / "arena.game.toml",
    )


def test_every_key_is_documented_with_its_values() -> None:
    documented = {key for row in ROWS for key in row[0]}
    tables = {
        "style": project._STYLE_KEYS,
        "lint": project.LINT_LEVELS,
    }
    keys = [f"{key}.{inner}" for key in project._KEYS for inner in tables.get(key, ())]
    assert documented == {*keys, *(key for key in project._KEYS if key not in tables)}
    values = {row[0][0]: tuple(row[1]) for row in ROWS}
    assert values["style.notation"] == project.NOTATIONS
    assert values["style.formatting"] == project.FORMATTINGS


def test_the_documented_defaults_apply(tmp_path: Path) -> None:
    (tmp_path / "tltl.toml").write_text("")
    empty = project.read_project(tmp_path / "tltl.toml")
    without = {row[0][0]: row[2] for row in ROWS}
    assert without["style.notation"] == [empty.notation]
    assert without["style.formatting"] == [empty.formatting]
    assert (empty.libraries, empty.targets, dict(empty.lint)) == ((), (), {})
