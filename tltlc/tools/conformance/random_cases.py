"""Random cases from fixed seeds, with formulas and predicates that no person would write."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import combinations
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import EMPTY
from tltlc.expression.tree import Expression
from tltlc.logic import formula as f
from tltlc.resolve.spec import JudgeMode
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase, automaton
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.expressions import PARAMS, SIGNALS, predicate
from tltlc.tools.conformance.formulas import formula
from tltlc.tools.conformance.traces import lively_trace, random_trace

_ATOMS: Final = ("a", "b", "c")
_VALUES: Final = (-1.0, -0.75, -0.5, -0.1, -0.0, 0.0, 0.1, 0.5, 0.75, 1.0)
_JUDGES: Final[tuple[JudgeMode, ...]] = ("goal", "limit")
_OPEN: Final = ("pending", "holding")
_STATES: Final = range(2, 10)
"""The accepted numbers of states. Smaller automata test little, and larger ones compile slowly."""


def _formula_case(name: str, seed: int, infinite: bool) -> ConformanceCase:
    """Return a case with a random formula over signals."""
    draw = Draw(seed)
    fspa = _automaton(name, draw, infinite)
    pools = {signal.name: _VALUES for signal in fspa.signals}
    traces = tuple(lively_trace(fspa, draw, 20 + 10 * number, pools) for number in range(2))
    return ConformanceCase(fspa, f"A random formula: {fspa.formula}.", traces)


def _predicates_case(name: str, seed: int) -> ConformanceCase:
    """Return a case with a random formula over random predicates."""
    draw = Draw(seed)
    expressions = {atom: predicate(draw) for atom in _ATOMS}
    fspa = _automaton(name, draw, False, expressions)
    traces = (lively_trace(fspa, draw, 30), random_trace(fspa, draw, 12, rejected=True))
    return ConformanceCase(fspa, f"Random predicates under {fspa.formula}.", traces)


def _automaton(name: str, draw: Draw, infinite: bool, expressions: Mapping[str, Expression] = EMPTY) -> Fspa:
    """Draw random formulas until one has an automaton of a suitable size, and return the automaton."""
    while True:
        goal = formula(draw, _ATOMS, 3 + draw.below(3))
        if expressions:
            # In a formula that requires its goal again and again, each row shows the value of a predicate.
            goal = f.always(f.eventually(goal))
        groups = [
            pair for pair in combinations(dict.fromkeys(goal.atoms()), 2) if not expressions and draw.chance(0.15)
        ]
        limit = 2 + draw.below(20) if draw.chance(0.6) else None
        judge = draw.choice(_JUDGES)
        if infinite and len(set(goal.atoms())) < 2:
            continue
        fspa = automaton(
            name,
            goal,
            expressions,
            SIGNALS,
            PARAMS,
            exclusive=groups,
            limit=limit,
            judge=judge,
            infinite=infinite,
        )
        if len(fspa.states) in _STATES and fspa.states[0].verdict in _OPEN and len(fspa.atoms) > 1:
            return fspa


CASES: Final[CaseBuilders] = {
    **{f"random_{n}": partial(_formula_case, f"random_{n}", 4000 + n, False) for n in range(1, 9)},
    **{f"random_infinite_{n}": partial(_formula_case, f"random_infinite_{n}", 5000 + n, True) for n in range(1, 4)},
    **{f"random_predicates_{n}": partial(_predicates_case, f"random_predicates_{n}", 6000 + n) for n in range(1, 8)},
}
