"""Relations between two comparisons of one signal, as TLT0430 and TLT0431 use them."""

from __future__ import annotations

from hypothesis import assume, given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.tools.lint.helpers import RANGES, labelled_texts_in_block

ENDS = st.integers(1, 9)


@times(40)
@given(ENDS, ENDS, st.sampled_from("<>"), st.sampled_from("<>"), st.sampled_from(["and", "or"]))
def test_a_relation_is_reported_if_and_only_if_it_holds_for_all_numbers(
    one: int, two: int, first: str, second: str, op: str
) -> None:
    """The values at all multiples of one half decide what the rules must report."""
    values = [step / 2 for step in range(21)]
    truths = {(x < one if first == "<" else x > one, x < two if second == "<" else x > two) for x in values}
    results = [any(truth) if op == "or" else all(truth) for truth in truths]
    assume(f"x {first} {one}" != f"x {second} {two}")
    clause = f"x {first} {one} {op} x {second} {two}"
    assert bool(labelled_texts_in_block("TLT0430", "reach a", f"keep {clause}", before=RANGES)) == all(results)
    assert bool(labelled_texts_in_block("TLT0431", "reach a", f"reach {clause}", before=RANGES)) == (not any(results))
