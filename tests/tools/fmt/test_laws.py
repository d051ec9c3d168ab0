"""Formatting keeps the tree and the comments, and formatting again changes nothing."""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.golden.cases import sources
from tests.tools.fmt import random_texts
from tests.tools.fmt.laws import check
from tltlc.core.source import SourceFile
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.parser import parse
from tltlc.tools.fmt import STYLES

ROOT = Path(__file__).parents[3]
EVERYTHING = (ROOT / "tests" / "grammar" / "everything.tltl").read_text(encoding="utf-8")


@cache
def texts_without_errors() -> dict[str, str]:
    """The ``.tltl`` files of the repository that have no syntax errors."""
    files = sources()
    for path in sorted(ROOT.rglob("*.tltl")):
        inside = path.relative_to(ROOT)
        if not any(part.startswith(".") for part in inside.parts):
            with suppress(OSError):
                files[str(inside)] = path.read_bytes()
    texts: dict[str, str] = {}
    for name, data in files.items():
        with suppress(UnicodeDecodeError):
            text = data.decode("utf-8-sig")
            if not parse(SourceFile("a", text))[1]:
                texts[name] = text
    return texts


@pytest.mark.parametrize("style", STYLES)
def test_the_laws_hold_for_all_files_of_the_repository(style: str) -> None:
    assert len(texts_without_errors()) > 100
    for name, text in texts_without_errors().items():
        try:
            check(text, style)
        except AssertionError as error:
            raise AssertionError(name) from error


@times(100)
@given(st.randoms(use_true_random=False), st.sampled_from([*STYLES]))
def test_the_laws_hold_for_random_modules(random: Random, style: str) -> None:
    check(random_texts.module(random), style)


@times(100)
@given(st.randoms(use_true_random=False), st.sampled_from([*STYLES]))
def test_the_laws_hold_for_random_modules_with_allow_comments(random: Random, style: str) -> None:
    check(random_texts.module(random, random_texts.GAPS_WITH_ALLOW), style)


@times(60)
@given(st.randoms(use_true_random=False), st.sampled_from([*STYLES]))
def test_the_laws_hold_with_comments_between_any_two_words(random: Random, style: str) -> None:
    # A number must stay next to its unit.
    words = [token for token in tokenize(EVERYTHING).tokens if token.text]
    text = "".join((" " if word.type == "UNIT" else random.choice(random_texts.GAPS)) + word.text for word in words)
    check(text, style)


@pytest.mark.parametrize("style", [*STYLES])
@pytest.mark.parametrize(
    "items",
    ["a // remark\nis rather_long, b", "12x x // remark\n= 1, b", "b, x = 4 + // remark\n3, a is // remark\nlong"],
)
def test_a_comment_in_an_item_that_stays_whole_comes_before_it(items: str, style: str) -> None:
    check(f'test "t" for s {{ step {items} expect pending }}', style)
