"""Random expressions, automata and samples for property tests."""

from __future__ import annotations

from typing import Literal

from hypothesis import strategies as st

from tests.logic.strategies import formulas
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.build import build_infinite
from tltlc.core.record import replace
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When

SIGNALS, PARAMS = ("x", "y(a, b)"), ("p", 'q"')

# There are few values, so that ties, zeros and boundaries are frequent.
values = st.sampled_from([-1.0, -0.75, -0.5, -0.1, -0.0, 0.0, 0.1, 0.5, 0.75, 1.0])
numbers = st.sampled_from([0.0, -0.0, 1.0, -1.0, 2.0, 3.0, 0.5, 0.1, -2.5, 1e3, 1e200]) | st.floats(
    allow_nan=False, allow_infinity=False, width=64
)
_leaves = (
    st.builds(Const, numbers)
    | st.builds(SignalValue, st.sampled_from(SIGNALS))
    | st.builds(ParamValue, st.sampled_from(PARAMS))
)


def _operands(inner: st.SearchStrategy[Expression], low: int, high: int) -> st.SearchStrategy[tuple[Expression, ...]]:
    return st.lists(inner, min_size=low, max_size=high).map(tuple)


_connectives: st.SearchStrategy[Literal["and", "or", "not"]] = st.sampled_from(["and", "or", "not"])


@st.composite
def _conditions(draw: st.DrawFn, inner: st.SearchStrategy[Expression], depth: int = 2) -> Condition:
    if depth and draw(st.integers(0, 2)) == 0:
        op = draw(_connectives)
        count = 1 if op == "not" else draw(st.integers(2, 3))
        return Condition(op, tuple(draw(_conditions(inner, depth - 1)) for _ in range(count)))
    return Condition(draw(st.sampled_from(["<", "<=", ">", ">="])), (draw(inner), draw(inner)))


def _operations(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    cases = st.lists(st.tuples(_conditions(inner), inner), min_size=1, max_size=3).map(tuple)
    exponents = st.sampled_from([Const(2.0), Const(3.0), Const(0.5), Const(-1.0)])
    return st.one_of(
        st.builds(Op, st.sampled_from(["+", "-", "*", "/", "^"]), st.tuples(inner, inner)),
        st.builds(lambda base, exponent: Op("^", (base, exponent)), inner, exponents),
        st.builds(Op, st.sampled_from(["neg", "abs", "sqrt", "exp", "tanh"]), st.tuples(inner)),
        st.builds(Op, st.sampled_from(["min", "max"]), _operands(inner, 2, 4)),
        st.builds(Op, st.just("clamp"), st.tuples(inner, inner, inner)),
        st.builds(When, cases, inner),
    )


_expressions: st.SearchStrategy[Expression] = st.recursive(_leaves, _operations, max_leaves=12)


@st.composite
def expressions(draw: st.DrawFn) -> Expression:
    """Expressions over SIGNALS and PARAMS, with every operator."""
    return draw(_expressions)


@st.composite
def automata(draw: st.DrawFn, max_leaves: int = 8) -> Fspa:
    """Automata over the atoms a, b, c, over finite or infinite traces, with either judge.

    They may have exclusive atoms and a limit.
    """
    exclusive = draw(st.sampled_from([(), (("a", "b"),), (("a", "b", "c"),)]))
    if draw(st.integers(0, 3)):
        fspa = build(spec_from_formula(draw(formulas(max_leaves=max_leaves)), exclusive=exclusive))
    else:
        spec = spec_from_formula(draw(formulas(max_leaves=5)), exclusive=exclusive)
        fspa = build_infinite(replace(spec, semantics="infinite"))
    limit = draw(st.none() | st.integers(1, 8))
    return replace(fspa, limit_steps=limit, judge=draw(st.sampled_from(["goal", "limit"])))


@st.composite
def atom_traces(draw: st.DrawFn, fspa: Fspa, max_size: int = 8) -> list[tuple[float, ...]]:
    """Traces of values of the automaton's atoms that respect its exclusive atoms."""
    sample = st.tuples(*[values for _ in fspa.atoms]).map(lambda drawn: _allowed(fspa, drawn))
    return draw(st.lists(sample, min_size=1, max_size=max_size))


def _allowed(fspa: Fspa, drawn: tuple[float, ...]) -> tuple[float, ...]:
    """Return the values, with all true atoms of each exclusive group but the first one made false."""
    result = list(drawn)
    for group in fspa.exclusive:
        for atom in [atom for atom in group if result[atom] > 0.0][1:]:
            result[atom] = -result[atom]
    return tuple(result)
