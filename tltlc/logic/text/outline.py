"""What a formula asks for, sorted: goals in order, what holds throughout, what comes again and again."""

from __future__ import annotations

from tltlc.core.record import record
from tltlc.logic.bounded import bounded, with_bounds
from tltlc.logic.formula import FALSE, TRUE, Formula, always
from tltlc.logic.text.english import clause_text, goal_texts, without_constants
from tltlc.logic.text.phrases import is_state


@record
class Goal:
    """One of a row of goals; ``together`` says that it may be reached with the one before, at the same step."""

    text: str
    together: bool = False


@record
class Outline:
    """The conjuncts of a formula as English clauses, in order.

    ``goals`` are rows, each to be reached in order, and the rows beside each other; ``recurring`` is what infinite
    traces do again and again, ``others`` what is none of these.
    """

    goals: tuple[tuple[Goal, ...], ...] = ()
    throughout: tuple[str, ...] = ()
    recurring: tuple[str, ...] = ()
    others: tuple[str, ...] = ()


def outline(formula: Formula, *, endless: bool = False) -> Outline:
    """The outline of a formula; ``endless``: it is about traces that never end, and is constant or has no constants."""
    formula = formula if endless else without_constants(formula)
    goals: list[tuple[Goal, ...]] = []
    throughout: list[str] = []
    recurring: list[str] = []
    others: list[str] = []
    for part in _conjuncts(formula):
        if part in (TRUE, FALSE):
            others += ["what nothing can satisfy"] if part is FALSE else []
        elif part.op == "F" and _core(part.args[0]).op != "G":
            linked = goal_texts(part, endless=endless)
            goals.append(tuple(Goal(text, link not in ("", "then")) for link, text in linked))
        elif part.op == "G" and endless and _core(part.args[0]).op == "F":
            clause = clause_text(part, endless=endless)
            recurring.append(clause.removesuffix(" again and again").removeprefix("again and again, "))
        elif part.op == "G":
            clause = clause_text(part, endless=endless)
            throughout.append(clause.removesuffix(" throughout") if is_state(part.args[0]) else clause)
        else:
            others.append(clause_text(part, endless=endless))
    return Outline(tuple(goals), tuple(throughout), tuple(recurring), tuple(others))


def _conjuncts(formula: Formula) -> list[Formula]:
    """The operands of the outermost ``and``, also of one under ``G``; bounds stay whole."""
    found: list[Formula] = []
    stack = [formula]
    while stack:
        node = stack.pop()
        if node.op == "and" and bounded(node) is None and not is_state(node):
            stack += reversed(with_bounds(node))
        elif node.op == "G" and node.args[0].op == "and" and bounded(node.args[0]) is None:
            stack += [always(part) for part in reversed(with_bounds(node.args[0]))]
        else:
            found.append(node)
    return list(dict.fromkeys(found))


def _core(node: Formula) -> Formula:
    """The formula without brackets of double negations."""
    while node.op == "not" and node.args[0].op == "not":
        node = node.args[0].args[0]
    return node
