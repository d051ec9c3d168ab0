"""A specification over infinite traces that needs too much work is an error that labels its parts, in bounded time."""

from __future__ import annotations

from typing import cast

import pytest

from tests.automaton.test_blowup import with_parts
from tests.reference_formulas import read_formula
from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.infinite import blowup
from tltlc.automaton.infinite.blowup import budget_error
from tltlc.automaton.infinite.contradiction import unsatisfiable
from tltlc.automaton.work import OutOfWork
from tltlc.core.record import replace
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.io.limits import WORK
from tltlc.resolve.spec import Bound, Spec

FAIR = "G F a{0} -> G F b{0}"


def fair(count: int) -> Spec:
    return with_parts(*(read_formula(FAIR.format(number)) for number in range(count)))


def diagnostic_of(spec: Spec, reason: Exception | None = None) -> Diagnostic:
    (diagnostic,) = budget_error(spec, reason or OutOfWork()).diagnostics
    return diagnostic


def test_parts_that_are_large_only_together_are_labelled_with_their_own_sizes() -> None:
    spec = with_parts(*map(read_formula, ("F c", "F a & F b", FAIR.format(1), "true")))
    diagnostic = diagnostic_of(spec)
    assert (diagnostic.code, diagnostic.title) == ("TLT0501", "the automaton of `spec` takes too long to build")
    assert [(label.span.start, label.message) for label in diagnostic.labels] == [
        (1, "4 states and 1 pair alone; the parts multiply"),
        (0, "2 states and 1 pair alone; the parts multiply"),
        (2, "1 state and 2 pairs alone; the parts multiply"),
    ]


def test_the_help_suggests_a_larger_budget_only_where_the_work_ran_out() -> None:
    assert [
        ("--state-budget" in (diagnostic_of(fair(2), reason).help or "")) for reason in (OutOfWork(), OutOfSteps())
    ] == [
        True,
        False,
    ]


def test_a_part_that_is_too_large_alone_is_the_only_label() -> None:
    spec = with_parts(read_formula("F c"), read_formula("F((a1 | G b1) & (a2 | G b2) & (a3 | G b3) & (a4 | G b4))"))
    assert diagnostic_of(spec).labels == (Label(spec.source, Span(1, 2), "because of this part"),)


def test_a_large_bound_is_labelled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blowup, "_FOR_A_PART", 20_000)
    spec = with_parts(read_formula("F c"), read_formula(f"G(a -> {'X ' * 12}b)"))
    bound = Bound(12, spec.source, Span(2, 3), "next", "X", words=False)
    spec = replace(spec, parts=(spec.parts[0], replace(spec.parts[1], bounds=(bound,))))
    assert diagnostic_of(spec).labels == (Label(spec.source, Span(2, 3), "because of this bound"),)


def test_no_part_is_blamed_because_it_comes_last(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blowup, "_FOR_ALL_PARTS", blowup._FOR_A_PART + 1_000)
    messages = [label.message for label in diagnostic_of(fair(60)).labels]
    assert messages == ["1 state and 2 pairs alone; the parts multiply"] * 3


def test_a_spec_without_parts_is_labelled_by_its_name() -> None:
    spec = replace(fair(2), parts=())
    assert diagnostic_of(spec).labels == (Label(spec.source, spec.name_span),)


def test_each_reason_has_its_own_title() -> None:
    assert diagnostic_of(fair(2), OutOfSteps()).title == "the automaton of `spec` needs too much memory"
    assert (
        diagnostic_of(fair(2), RecursionError()).title == "the automaton of `spec` needs formulas that nest too deeply"
    )
    primes = diagnostic_of(fair(2), TooManyPrimes("a guard", 10))
    assert (primes.code, primes.title) == ("TLT0502", "a guard of `spec` has more than 10 prime implicants")


def test_an_automaton_with_too_many_edges_shows_no_contradiction(monkeypatch: pytest.MonkeyPatch) -> None:
    spec = with_parts(read_formula("G F a"), read_formula("F G !a"))
    assert unsatisfiable(spec.parts, spec)
    monkeypatch.setitem(cast("dict[str, int]", WORK), "edges", 0)
    assert not unsatisfiable(spec.parts, spec)
