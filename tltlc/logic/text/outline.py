"""Sort the requirements of a formula: goals in order, permanent conditions, recurring goals."""

from __future__ import annotations

from tltlc.core.record import record
from tltlc.logic.bounded_operators import bounded_operator, operands_with_bounds
from tltlc.logic.formula import FALSE, TRUE, Formula, always
from tltlc.logic.text.counts import NUMBERS, CountPrinter
from tltlc.logic.text.english import clause_text, goal_texts, invariant_text, recurring_text, without_constants
from tltlc.logic.text.phrases import is_state


@record
class Goal:
    """One goal in a sequence, as English text.

    ``together`` says whether the goal may be reached at the same step as the previous one.
    """

    text: str
    together: bool = False


@record
class Outline:
    """The conjuncts of a formula as English clauses, in order.

    - ``goals`` are sequences. The goals of one sequence must be reached in order; the sequences are
      independent.
    - ``throughout`` are the conditions that must hold at every step.
    - ``recurring`` are the goals that an infinite trace must reach again and again.
    - ``others`` are the remaining conjuncts.
    """

    goals: tuple[tuple[Goal, ...], ...] = ()
    throughout: tuple[str, ...] = ()
    recurring: tuple[str, ...] = ()
    others: tuple[str, ...] = ()


def outline(formula: Formula, *, endless: bool = False, counts: CountPrinter = NUMBERS) -> Outline:
    """Return the conjuncts of a formula as English clauses, sorted into kinds of requirements.

    ``endless`` says that the formula is about traces that never end. The formula must then be a
    constant, or contain no constant. ``counts`` prints the counts of steps.
    """
    formula = formula if endless else without_constants(formula)
    goals: list[tuple[Goal, ...]] = []
    throughout: list[str] = []
    recurring: list[str] = []
    others: list[str] = []
    for part in _conjuncts(formula):
        if part in (TRUE, FALSE):
            others += ["satisfy a condition that no trace can satisfy"] if part is FALSE else []
        elif part.op == "F" and _core(part.args[0]).op != "G":
            linked = goal_texts(part, endless=endless, counts=counts)
            goals.append(tuple(Goal(text, link not in ("", "then")) for link, text in linked))
        elif part.op == "G" and endless and _core(part.args[0]).op == "F":
            recurring.append(recurring_text(part))
        elif part.op == "G":
            throughout.append(invariant_text(part, endless=endless, counts=counts))
        else:
            others.append(clause_text(part, endless=endless, counts=counts))
    return Outline(tuple(goals), tuple(throughout), tuple(recurring), tuple(others))


def _conjuncts(formula: Formula) -> list[Formula]:
    """Return the distinct operands of the outermost ``and``, with ``G (a & b)`` split into ``G a`` and ``G b``.

    ``G G a`` is ``G a``. An ``and`` without temporal operators is not split, nor is the expansion of a bounded operator
    such as ``G[0,2] p``.
    """
    conjuncts: list[Formula] = []
    stack = [formula]
    while stack:
        node = stack.pop()
        if node.op == "and" and bounded_operator(node) is None and not is_state(node):
            stack += reversed(operands_with_bounds(node))
        elif node.op == "G" and node.args[0].op == "G":
            stack.append(node.args[0])
        elif node.op == "G" and node.args[0].op == "and" and bounded_operator(node.args[0]) is None:
            stack += [always(part) for part in reversed(operands_with_bounds(node.args[0]))]
        else:
            conjuncts.append(node)
    return list(dict.fromkeys(conjuncts))


def _core(node: Formula) -> Formula:
    """Return the formula without leading double negations: ``a`` for ``!!a``."""
    while node.op == "not" and node.args[0].op == "not":
        node = node.args[0].args[0]
    return node
