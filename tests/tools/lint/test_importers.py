"""The names of a file that other files use."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.time_limit import run_with_time_limit
from tests.tools.lint.helpers import codes
from tltlc.core.source import SourceFile
from tltlc.tools.lint.fix_application import fix
from tltlc.tools.lint.importers import importer_names, names_used_elsewhere

NAMES = st.lists(st.sampled_from(["a", "b", "ab", "ba"]), min_size=1, max_size=5).map(".".join)


@pytest.mark.parametrize(
    "text",
    [
        "import game",
        "import lib.game",
        'import "../game.tltl" as g',
        "import // why\n game",
        'import /// "other"\n\n"game"',
        "let x = a\nimport\n\ngame",
    ],
)
def test_imports_are_found(text: str) -> None:
    assert importer_names("x.tltl", text).imports == {"game"}


@pytest.mark.parametrize(
    "text",
    ["// import game", '"import game"', 'test "import" for game', "reimport game", "import // game", '"\nx game'],
)
def test_a_text_without_an_import_statement_imports_nothing(text: str) -> None:
    assert "game" not in importer_names("x.tltl", text).imports


@times(40)
@given(st.lists(NAMES, max_size=6), NAMES)
def test_every_suffix_of_a_name_counts_as_used(names: list[str], queried: str) -> None:
    used = names_used_elsewhere("game.tltl", [importer_names("x.tltl", f"import game\n{' '.join(names)}")])
    suffixes = {".".join(name.split(".")[first:]) for name in names for first in range(name.count(".") + 1)}
    assert (queried in used) == (queried in suffixes)


def test_names_in_indirect_importers_count_as_used() -> None:
    files = [
        importer_names("b.tltl", "import a\nlet x = near"),
        importer_names("c.tltl", "import b\nlet y = b.far"),
        importer_names("d.tltl", "e"),
    ]
    used = names_used_elsewhere("a.tltl", files)
    assert [name in used for name in ("near", "far", "b.far", "e")] == [True, True, True, False]


def test_the_suffixes_of_a_long_name_are_not_stored() -> None:
    text = "import game\n" + ".".join("a" * 3_000)
    file_names = importer_names("x.tltl", text)
    used = names_used_elsewhere("game.tltl", [file_names])
    assert sum(map(len, file_names.names)) <= len(text)
    assert ".".join("a" * 2_000) in used
    assert 3 not in used


def test_comments_that_mention_imports_take_linear_time() -> None:
    text = '"// import\\n" * 2_000_000'
    assert run_with_time_limit(
        f"from tltlc.tools.lint.importers import importer_names; print(importer_names('x.tltl', {text}))"
    ).startswith("ImporterNames")


def test_a_name_used_by_a_neighbouring_file_is_kept(tmp_path: Path) -> None:
    text = "signal game.seen: bool\nsignal game.heard: bool\nsignal near: bool\nspec calm = F near\n"
    used = names_used_elsewhere("calm.tltl", [importer_names("x.tltl", "import calm as c\nspec x = F c.game.seen")])
    fixed = fix(SourceFile("calm.tltl", text), None, {}, used)
    assert fixed.source.text == text.replace("signal game.heard: bool\n", "")
    assert "TLT0421" in codes(text)
