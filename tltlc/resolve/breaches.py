"""Keep guards small: one atom in place of each rule about single samples, in specs that remember anyway.

A guard is stored as all of its prime implicants. The guard "no rule is broken" is the conjunction of all
rules ``G p`` of a spec. So ten rules ``G(a -> b | c)`` have 3^10 of them, but ten literals have one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import prod
from typing import Final

from tltlc.core.record import replace
from tltlc.logic.formula import Formula, always, and_, not_
from tltlc.resolve.context import Context
from tltlc.resolve.spec import Conjunct
from tltlc.resolve.timers import Timers

MOST_PRODUCTS: Final = 10
"""Rules stay as they are if their conjunction is a disjunction of at most about this many products."""


def with_breaches(parts: Sequence[Conjunct], context: Context) -> list[Conjunct]:
    """Return the conjuncts of a spec, with ``G !breach`` in place of ``G p`` if there are many such rules.

    ``breach`` is an atom that holds where p does not; its robustness is that of ``!p``. Here p has no
    temporal operators, and is more than a conjunction of literals.
    """
    rules = dict.fromkeys(rule for part in parts for rule in _rules(part.formula))
    if prod(map(_products, rules)) <= MOST_PRODUCTS:
        return list(parts)
    return [
        replace(part, formula=_with_breaches(part.formula, Timers(context, part.source, part.span))) for part in parts
    ]


def _with_breaches(formula: Formula, timers: Timers) -> Formula:
    return and_(
        *(
            always(and_(*(_unbroken(rule, timers) for rule in _operands(part.args[0])))) if _is_rule(part) else part
            for part in _operands(formula)
        )
    )


def _unbroken(rule: Formula, timers: Timers) -> Formula:
    return not_(timers.broken(rule)) if _products(rule) > 1 and timers.fits(rule) else rule


def _rules(formula: Formula) -> Iterator[Formula]:
    """Yield each p of the conjuncts ``G p`` of a formula; each operand of a conjunction p alone."""
    for part in _operands(formula):
        if _is_rule(part):
            yield from _operands(part.args[0])


def _is_rule(formula: Formula) -> bool:
    return formula.op == "G" and not any(part.is_temporal for part in formula.args[0].walk())


def _operands(formula: Formula) -> tuple[Formula, ...]:
    return formula.args if formula.op == "and" else (formula,)


def _products(rule: Formula) -> int:
    """Return how many products the disjunctive form of a formula without temporal operators has, as it is written."""
    counts: dict[Formula, tuple[int, int]] = {}  # for each subformula, and for its negation
    for node in rule.bottom_up():
        true, false = zip(*(counts[part] for part in node.args), strict=True) if node.args else ((), ())
        if node.op == "not":
            counts[node] = (false[0], true[0])
        elif node.op == "and":
            counts[node] = (prod(true), sum(false))
        elif node.op == "or":
            counts[node] = (sum(true), prod(false))
        elif node.op == "implies":
            counts[node] = (false[0] + true[1], true[0] * false[1])
        elif node.op == "iff":
            counts[node] = (prod(true) + prod(false), true[0] * false[1] + false[0] * true[1])
        else:
            counts[node] = (int(node.op != "false"), int(node.op != "true"))
    return counts[rule][0]
