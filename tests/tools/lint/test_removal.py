"""Fixes remove a declaration with its documentation, and no other comment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from tests.tools.lint.helpers import apply_fixes, codes
from tltlc.core.source import SourceFile, Span
from tltlc.grammar.module import Comment
from tltlc.grammar.parser import parse
from tltlc.tools.lint.removal import removal_span

SPEC = "spec s = F a\n"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        # Documentation is removed with its declaration, and does not become documentation of the next one.
        ("/// Old.\n// A remark.\nlet r = a\n/// New.\n", "/// New.\n"),
        ("/// Old.\n\n// A remark.\n\n/// Older.\nlet r = a\n", ""),
        ("// A remark.\n/// Old.\nlet r = a\n", "// A remark.\n"),
        ("// Of b.\nsignal b: bool  // of b\n// Of a.\n", "// Of b.\n// Of a.\n"),
    ],
)
def test_documentation_is_removed_with_its_declaration(before: str, after: str) -> None:
    assert apply_fixes(f"signal a: bool\n{before}{SPEC}").source.text == f"signal a: bool\n{after}{SPEC}"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("entity x,  // of x\n    y  // of y\nsignal a(e: entity): bool\nspec s = F a(y)\n", "TLT0421"),
        ("entity x,  // of x\n    y  // of y\nsignal a(e: entity): bool\nspec s = F a(x)\n", "TLT0421"),
        ("import core (less,  // of less\n    more)\nsignal x in [0, 9]\nspec s = F more(x, 1, 1)\n", "TLT0422"),
    ],
)
def test_an_item_whose_removal_would_drop_a_comment_is_kept(text: str, code: str) -> None:
    assert codes(text) == [code]
    assert apply_fixes(text).source.text == text


class _Comments(Sequence[Comment]):
    """The comments of a text; counts how often one of them is accessed."""

    def __init__(self, text: str) -> None:
        self._comments = parse(SourceFile("example.tltl", text))[0].comments
        self.accesses = 0

    def __len__(self) -> int:
        return len(self._comments)

    def __getitem__(self, index: Any) -> Any:
        self.accesses += 1
        return self._comments[index]


def test_only_a_few_of_many_comments_are_accessed() -> None:
    text = "".join(f"// Of a{number}.\nsignal a{number}: bool\n" for number in range(500))
    comments = _Comments(text)
    start = text.index("signal a300")
    span = removal_span(SourceFile("example.tltl", text), Span(start, text.index("\n", start)), comments)
    assert text[span.start : span.end] == "signal a300: bool\n"
    assert comments.accesses < 20
