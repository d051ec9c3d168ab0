"""What comparisons of one signal have to do with each other, by TLT0430 and TLT0431."""

from __future__ import annotations

from hypothesis import assume, given
from hypothesis import strategies as st

from tests.tools.lint.helpers import RANGES, of

ENDS = st.integers(1, 9)


@given(ENDS, ENDS, st.sampled_from("<>"), st.sampled_from("<>"), st.sampled_from(["and", "or"]))
def test_relations_are_those_of_numbers(one: int, two: int, first: str, second: str, op: str) -> None:
    """A comparison of both ends with all values in steps of a half decides what the rule proves."""
    values = [step / 2 for step in range(21)]
    truths = {(x < one if first == "<" else x > one, x < two if second == "<" else x > two) for x in values}
    met = [any(truth) if op == "or" else all(truth) for truth in truths]
    assume(f"x {first} {one}" != f"x {second} {two}")
    clause = f"x {first} {one} {op} x {second} {two}"
    assert bool(of("TLT0430", "reach a", f"keep {clause}", before=RANGES)) == all(met)
    assert bool(of("TLT0431", "reach a", f"reach {clause}", before=RANGES)) == (not any(met))
