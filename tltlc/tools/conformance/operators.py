"""Cases with each temporal operator, with both values of ``judge``, and with and without a limit."""

from __future__ import annotations

from functools import partial
from typing import Final

from tltlc.logic import formula as f
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import JudgeMode
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase, automaton
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.traces import lively_trace, random_trace

_A, _B, _C = f.atom("a"), f.atom("b"), f.atom("c")

_VALUES: Final = (-1.0, -0.75, -0.5, -0.1, -0.0, 0.0, 0.1, 0.5, 0.75, 1.0)
"""Only a few values, so that values are equal, or 0, at many steps."""

_Shape = tuple[str, Formula, "JudgeMode | None", "int | None", bool]

_SHAPES: Final[tuple[_Shape, ...]] = (
    ("next_strong", f.and_(f.next_(f.next_(_A)), f.always(f.or_(_B, _C))), None, None, False),
    ("next_weak", f.or_(f.weak_next(f.and_(_A, f.weak_next(_B))), f.eventually(_C)), "goal", 9, False),
    ("eventually", f.and_(f.eventually(_A), f.eventually(f.and_(_B, _C))), None, 20, False),
    ("always", f.always(f.or_(_A, _B)), None, 12, False),
    ("until", f.and_(f.until(_A, _B), f.eventually(_C)), None, 15, False),
    ("weak_until", f.weak_until(_A, f.and_(_B, _C)), "limit", None, False),
    ("release", f.release(_A, f.or_(_B, _C)), "goal", None, False),
    ("strong_release", f.strong_release(_A, f.or_(_B, _C)), "limit", 10, False),
    ("then", f.then(_A, f.then(_B, f.then(_C, _A))), None, 40, False),
    ("implies_iff", f.always(f.implies(_A, f.eventually(f.iff(_B, _C)))), "limit", 8, False),
    ("reach_at_limit", f.eventually(f.and_(_A, _B)), "limit", 12, False),
    ("again", f.always(f.eventually(_A)), "goal", None, False),
    ("infinite_reach", f.and_(f.then(_A, _B), f.always(f.or_(_C, _A))), None, 25, True),
    ("infinite_again", f.and_(f.always(f.eventually(_A)), f.eventually(f.always(f.or_(_B, _C)))), None, 14, True),
    ("infinite_stay", f.or_(f.eventually(f.always(_A)), f.until(_B, _C)), "goal", None, True),
    ("infinite_always", f.always(f.or_(_A, f.next_(_B))), "limit", None, True),
)


def _case(number: int, shape: _Shape) -> ConformanceCase:
    name, formula, judge, limit, infinite = shape
    fspa = automaton(name, formula, limit=limit, judge=judge, infinite=infinite)
    draw = Draw(1000 + number)
    pools = dict.fromkeys("abc", _VALUES)
    # With mostly positive values a trace rarely violates a rule early; with zeros no atom holds.
    lucky = dict.fromkeys("abc", (-0.5, 0.25, 0.5, 1.0, 1.0))
    zeros = dict.fromkeys("abc", (0.0, -0.0))
    traces = (
        lively_trace(fspa, draw, 24, pools),
        lively_trace(fspa, draw, 30, lucky),
        random_trace(fspa, draw, 14, zeros),
    )
    return ConformanceCase(fspa, f"The formula {fspa.formula}.", traces)


CASES: Final[CaseBuilders] = {shape[0]: partial(_case, number, shape) for number, shape in enumerate(_SHAPES)}
