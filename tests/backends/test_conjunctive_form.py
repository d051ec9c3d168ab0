from __future__ import annotations

from itertools import product

from hypothesis import example, given
from hypothesis import strategies as st

from tltlc.program.conjunctive_form import shorter_clauses

terms = st.lists(st.lists(st.sampled_from("abcde"), min_size=1, unique=True), min_size=1, max_size=8)
values = st.lists(st.floats(-1, 1), min_size=5, max_size=5)


@given(terms, values)
@example(["ac", "ad", "bc", "bd"], [0.5, -0.5, 0.25, -0.25, 0.0])
def test_clauses_keep_the_value(terms: list[list[str]], values: list[float]) -> None:
    value = dict(zip("abcde", values, strict=True))
    clauses = shorter_clauses(terms)
    if clauses is not None:
        assert sum(map(len, clauses)) < sum(map(len, terms))
        greatest = max(min(value[literal] for literal in term) for term in terms)
        assert min(max(value[literal] for literal in clause) for clause in clauses) == greatest


def test_literals_follow_the_order_of_the_terms() -> None:
    assert shorter_clauses(["ac", "ad", "bc", "bd"]) == [["a", "b"], ["c", "d"]]
    assert shorter_clauses(["db", "da", "cb", "ca"]) == [["d", "c"], ["b", "a"]]
    assert shorter_clauses(["ab", "abc", "ad"]) == [["a"], ["b", "d"]]


def test_short_terms_are_not_converted() -> None:
    assert shorter_clauses(["ab", "cd"]) is None
    assert shorter_clauses(["abc"]) is None


def test_the_number_of_candidate_clauses_is_limited() -> None:
    def groups(count: int) -> list[tuple[int, ...]]:
        return [tuple(range(3 * group, 3 * group + 3)) for group in range(count)]

    assert shorter_clauses([*product(*groups(5))]) == [[*group] for group in groups(5)]
    # There are 32 sets with one literal of each term.
    assert shorter_clauses([(2 * number, 2 * number + 1) for number in range(5)]) is None
