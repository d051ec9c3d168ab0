"""What the check of predicates says in a program."""

from __future__ import annotations

from tests.resolve.helpers import codes, resolved


def test_a_wrong_range_is_an_error_with_a_witness() -> None:
    _, (found,) = resolved("signal x in [0, 1] predicate p in [0, 1] = 2 * x spec s = F p")
    assert (found.code, found.severity) == ("TLT0306", "error")
    assert "x = 1" in found.labels[0].message
    assert found.labels[0].source.slice(found.labels[0].span) == "in [0, 1]"


def test_a_range_that_only_fails_below_zero_is_a_warning() -> None:
    text = "predicate p(e: entity) in [-1, 1] = clamp(1 - sqrt(d(e) / 3 m), -1, 1) entity a spec s = F p(a)"
    _, (found,) = resolved("signal d(e: entity): length " + text)
    assert (found.code, found.severity) == ("TLT0401", "warning")
    assert found.help == "declare its range, e.g. `in [0 m, inf]`"
    assert codes("signal d(e: entity): length in [0 m, inf] " + text) == []


def test_a_jump_is_a_warning() -> None:
    _, (found,) = resolved("signal x in [0, 1] predicate p in [0, 1] = when x < 0.5: 0 otherwise: 1 spec s = F p")
    assert (found.code, found.severity) == ("TLT0402", "warning")


def test_one_check_for_all_entities() -> None:
    text = (
        "signal d(e: entity) in [0, 1] predicate p(e: entity) in [0, 1] = 2 * d(e) entity a, b spec s = F p(a) & F p(b)"
    )
    assert codes(text) == ["TLT0306"]


def test_the_values_of_arguments_count() -> None:
    declared = "signal x in [0, 4] predicate p(most: number = 4) in [0, 1] = x / most "
    assert codes(declared + "spec s = F p") == []
    assert codes(declared + "spec s = F p(8)") == []
    assert codes(declared + "spec s = F p(2)") == ["TLT0306"]


def test_numbers_passed_on_are_checked_where_they_are_known() -> None:
    declared = "signal x in [0, 4] predicate p(most: number) in [0, 1] = x / most "
    assert codes(declared + "let q(m: number) = F p(m) spec s = F p(8)") == []
    assert codes(declared + "predicate r(m: number) in [0, 1] = p(2 * m) spec s = F p(8)") == []
    assert codes(declared + "let q(m: number) = F p(m) spec s = q(8) & q(4)") == []
    assert codes(declared + "let q(m: number) = F p(m) spec s = q(8) & q(2)") == ["TLT0306"]
    assert codes(declared + "predicate r(m: number) in [0, 1] = p(2 * m) spec s = F r(4)") == []
    assert codes(declared + "predicate r(m: number) in [0, 1] = p(2 * m) spec s = F r(1)") == ["TLT0306", "TLT0306"]
    assert codes(declared + "let q(m: number) = F p(2) & m > 1 spec s = F p(8)") == ["TLT0306"]
    assert codes(declared + "param b in [1, 8] = 4 let q(m: number) = F p(b) & m > 1 spec s = F p(b)") == ["TLT0306"]


def test_the_whole_range_of_a_param_counts() -> None:
    assert codes("signal x in [0, 4] param m in [4, 8] = 5 predicate p in [0, 1] = x / m spec s = F p") == []
    assert codes("signal x in [0, 4] param m in [2, 8] = 5 predicate p in [0, 1] = x / m spec s = F p") == ["TLT0306"]
