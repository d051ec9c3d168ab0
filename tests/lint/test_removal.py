"""What fixes do with comments and documentation."""

from __future__ import annotations

import pytest

from tests.lint.helpers import codes, mended

SPEC = "spec s = F a\n"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        # What documents it, goes with it, and does not come to document what follows.
        ("/// Old.\n// A remark.\nlet r = a\n/// New.\n", "/// New.\n"),
        ("/// Old.\n\n// A remark.\n\n/// Older.\nlet r = a\n", ""),
        ("// A remark.\n/// Old.\nlet r = a\n", "// A remark.\n"),
        ("// Of b.\nsignal b: bool  // of b\n// Of a.\n", "// Of b.\n// Of a.\n"),
    ],
)
def test_documentation(before: str, after: str) -> None:
    assert mended(f"signal a: bool\n{before}{SPEC}").source.text == f"signal a: bool\n{after}{SPEC}"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("entity x,  // of x\n    y  // of y\nsignal a(e: entity): bool\nspec s = F a(y)\n", "TLT0421"),
        ("entity x,  // of x\n    y  // of y\nsignal a(e: entity): bool\nspec s = F a(x)\n", "TLT0421"),
        ("import core (less,  // of less\n    more)\nsignal x in [0, 9]\nspec s = F more(x, 1, 1)\n", "TLT0422"),
    ],
)
def test_an_item_stays_where_a_comment_would_go_with_it(text: str, code: str) -> None:
    assert codes(text) == [code]
    assert mended(text).source.text == text
