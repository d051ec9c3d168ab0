"""TLT0425: clauses that stand twice."""

from __future__ import annotations

import pytest

from tests.lint.helpers import SIGNALS, mended, of


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("avoid a", "keep not a"), ["keep not a"]),
        (("reach a", "require F a"), ["F a"]),
        (("require F a and G b", "reach c", "reach a"), ["reach a"]),
        (("reach a", "reach b", "reach a", "reach b", "reach a"), ["reach a", "reach b", "reach a"]),
        (("require F a and F a",), ["F a"]),
        # What comes to the same in another form is implied.
        (("reach a and b", "reach b and a"), []),
        (("reach a", "keep a"), []),
    ],
)
def test_clauses_that_stand_twice(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0425", *clauses) == expected


def test_the_first_of_them_stays() -> None:
    before = SIGNALS + "spec s {\n    limit 9 steps\n"
    twice = before + "    reach a then b then c\n    avoid b // once\n    keep not b // twice\n}\n"
    assert mended(twice).source.text == before + "    reach a then b then c\n    avoid b // once\n}\n"
