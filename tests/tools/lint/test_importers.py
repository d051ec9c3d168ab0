"""Find the names of a file that other files use."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.time_limit import run_with_time_limit
from tests.tools.lint.helpers import codes
from tltlc.core.source import SourceFile
from tltlc.tools.lint.fixing import fix
from tltlc.tools.lint.importers import used_elsewhere, words

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
    assert words("x.tltl", text).imports == {"game"}


@pytest.mark.parametrize(
    "text",
    ["// import game", '"import game"', 'test "import" for game', "reimport game", "import // game", '"\nx game'],
)
def test_texts_without_an_import_have_none(text: str) -> None:
    assert "game" not in words("x.tltl", text).imports


@given(st.lists(NAMES, max_size=6), NAMES)
def test_every_suffix_of_a_name_counts_as_used(names: list[str], asked: str) -> None:
    used = used_elsewhere("game.tltl", [words("x.tltl", f"import game\n{' '.join(names)}")])
    suffixes = {".".join(name.split(".")[first:]) for name in names for first in range(name.count(".") + 1)}
    assert (asked in used) == (asked in suffixes)


def test_names_count_along_a_chain_of_imports() -> None:
    files = [
        words("b.tltl", "import a\nlet x = near"),
        words("c.tltl", "import b\nlet y = b.far"),
        words("d.tltl", "e"),
    ]
    used = used_elsewhere("a.tltl", files)
    assert [name in used for name in ("near", "far", "b.far", "e")] == [True, True, True, False]


def test_the_suffixes_of_a_long_name_are_not_stored() -> None:
    text = "import game\n" + ".".join("a" * 3_000)
    file_words = words("x.tltl", text)
    used = used_elsewhere("game.tltl", [file_words])
    assert sum(map(len, file_words.names)) <= len(text)
    assert ".".join("a" * 2_000) in used
    assert 3 not in used


def test_comments_that_mention_imports_take_linear_time() -> None:
    text = '"// import\\n" * 2_000_000'
    assert run_with_time_limit(
        f"from tltlc.tools.lint.importers import words; print(words('x.tltl', {text}))"
    ).startswith("Words")


def test_a_name_used_by_a_neighbouring_file_is_kept(tmp_path: Path) -> None:
    text = "signal game.seen: bool\nsignal game.heard: bool\nsignal near: bool\nspec calm = F near\n"
    used = used_elsewhere("calm.tltl", [words("x.tltl", "import calm as c\nspec x = F c.game.seen")])
    fixed = fix(SourceFile("calm.tltl", text), None, {}, used)
    assert fixed.source.text == text.replace("signal game.heard: bool\n", "")
    assert "TLT0421" in codes(text)
