"""Print a formula as one English sentence in the imperative: the task of the player or agent."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from tltlc.logic import formula as build
from tltlc.logic.bounded import Bounded, bounded, with_bounds
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.logic.implication import complement
from tltlc.logic.rewrite import simplify
from tltlc.logic.text.notation import ASCII, write
from tltlc.logic.text.phrases import bracketed, imperative, is_literal, is_state, object_phrase, phrase

_PLAIN, _LIST, _CLAUSE, _SCOPED = 0, 1, 2, 3
"""Where a clause may be misread: nowhere; in a list, because it has inner commas; beside any other
clause; even in last place.
"""

_DEEPEST: Final = 5
"""Clauses nested deeper than this are printed as formulas, because such a sentence is unreadable."""

_Clause = tuple[str, int]


class _How(NamedTuple):
    """How many levels of clauses are still allowed, and whether every step has a next one."""

    depth: int
    endless: bool

    def deeper(self) -> _How:
        return _How(self.depth - 1, self.endless)


def english_text(formula: Formula, *, endless: bool = False) -> str:
    """Return the formula as one sentence, from a capital letter to a full stop.

    Atoms appear by name. ``F(near(s1) & X F near(exit)) & G alive`` reads "Reach near(s1), then
    near(exit), and keep alive throughout." "Reach" means now or later, "then" strictly later,
    "throughout" from now to the end. Formulas with equal sentences are equal on all traces. A
    formula with a constant that is not about the end of the trace (``true U a``) is simplified
    first.

    ``endless``: the sentence is about traces that never end, and the formula has no constants.
    """
    formula = formula if endless else without_constants(formula)
    if formula is TRUE:
        return "Nothing remains to be done."
    if formula is FALSE:
        return "The spec is violated."
    text, _ = _clause(formula, "now", _How(_DEEPEST, endless))
    return f"{text[0].upper()}{text[1:]}."


def clause_text(formula: Formula, *, endless: bool = False) -> str:
    """Return a non-constant formula as a clause of such a sentence: ``keep alive throughout``."""
    return _clause(formula, "now", _How(_DEEPEST, endless))[0]


def invariant_text(invariant: Formula, *, endless: bool = False) -> str:
    """Return a ``G`` as a clause for a list of what must hold throughout: ``keep alive`` for ``G alive``."""
    (body,) = invariant.args
    return imperative(body, "keep", "avoid") if _is_condition(body) else clause_text(invariant, endless=endless)


def recurring_text(recurring: Formula) -> str:
    """Return a ``G F`` as a clause for a list of what recurs: ``reach near(exit)`` for ``G F near(exit)``."""
    (body,) = recurring.args
    reach = _without_negation(body)
    if reach.op != "F":
        return clause_text(recurring, endless=True)
    (goal,) = reach.args
    return f"reach {object_phrase(goal)}" if is_state(goal) else _last(body, _How(_DEEPEST, True))


def goal_texts(reach: Formula, *, endless: bool = False) -> tuple[tuple[str, str], ...]:
    """Return the goals of an ``F``, each with its link to the previous goal.

    The link is ``then`` or ``then or at the same time``, and empty for the first goal.
    """
    return tuple(_linked_goals(reach.args[0], _How(_DEEPEST, endless)))


def without_constants(formula: Formula) -> Formula:
    """Return an equal formula with constants only in ``X true`` and ``N false``, or alone."""
    has_constants = any(
        (TRUE in node.args or FALSE in node.args) and not _is_about_end(node) for node in formula.walk()
    )
    return simplify(formula) if has_constants else formula


def _clause(node: Formula, when: str, how: _How) -> _Clause:
    """Return the instruction that makes ``node`` hold at the moment ``when``."""
    if is_state(node):
        return f"{imperative(node, 'have', 'avoid')} {when}", _of_state(node)
    if how.depth == 0:
        return f"satisfy {write(node, ASCII)}", _SCOPED
    if node.op in ("and", "or"):
        operator = bounded(node)
        if operator is not None:
            return _bounded(operator, how)
    match node.op:
        case "not":
            return _clause(_without_negation(node), when, how)
        case "and":
            return _together([_clause(part, when, how.deeper()) for part in _parts(node)])
        case "or":
            return "either " + " or ".join(_inner(part, how, when) for part in _parts(node)), _CLAUSE
        case "implies" if is_state(node.args[0]):
            return f"if {phrase(node.args[0])} {when}, {_last(node.args[1], how, when)}", _CLAUSE
        case "implies":
            return _clause(build.or_(build.not_(node.args[0]), node.args[1]), when, how)
        case "iff":
            left, right = (_inner(part, how, when) for part in node.args)
            return f"do both or neither of these: {left}, {right}", _SCOPED
        case "X" | "N":
            return _next(node, how)
        case "F":
            return _reach(node, when, how)
        case "G":
            return _throughout(node.args[0], how)
        case _:
            return _until(node, how)


def _parts(node: Formula) -> list[Formula]:
    """Return the operands, with the non-temporal ones joined at the place of the first of them."""
    make = build.and_ if node.op == "and" else build.or_
    operands = with_bounds(node)
    states = [part for part in operands if is_state(part)]
    parts: list[Formula] = []
    for part in operands:
        if not is_state(part):
            parts.append(part)
        elif part is states[0]:
            parts.append(make(*states))
    return list(dict.fromkeys(parts))


def _together(clauses: Sequence[_Clause]) -> _Clause:
    """Join the clauses into one list."""
    texts = [text for text, _ in clauses]
    if len(texts) == 1:
        return clauses[0]
    separator = "; " if any(rank >= _CLAUSE for _, rank in clauses) else ", "
    return f"{separator.join(texts[:-1])}{separator}and {texts[-1]}", _SCOPED


def _reach(node: Formula, when: str, how: _How) -> _Clause:
    """Return the clause of ``F``: a goal, or a sequence of goals."""
    (body,) = node.args
    if _without_negation(body).op == "G":
        return f"from some step on {_inner(body, how)}", _LIST
    if is_state(body) and when != "now":
        return f"reach {object_phrase(body)} {when} or later", _of_state(body)
    return f"reach {_goals(body, how)}", _PLAIN if is_literal(body) else _LIST


def _goals(body: Formula, how: _How) -> str:
    """Return the goals of ``F body``, one after another."""
    return "".join(f", {link} {goal}" if link else goal for link, goal in _linked_goals(body, how))


def _linked_goals(body: Formula, how: _How) -> Iterator[tuple[str, str]]:
    """Yield the goals of ``F body`` in order, each with the word that links it to the previous one."""
    link = ""
    while True:
        following, rest = _next_goal(body)
        if rest is None:
            yield link, _goal(body, how)
            return
        yield link, phrase(build.and_(*(part for part in body.args if is_state(part))))
        link, (body,) = following, rest.args


def _next_goal(body: Formula) -> tuple[str, Formula | None]:
    """Return the link and the ``F`` of the next goal in ``p & X F q`` or ``p & F q``.

    The ``F`` is None if no goal follows.
    """
    if body.op != "and":
        return "", None
    temporal = [part for part in body.args if not is_state(part)]
    if len(temporal) != 1 or len(body.args) == 1:
        return "", None
    (rest,) = temporal
    if rest.op == "X" and rest.args[0].op == "F":
        return "then", rest.args[0]
    return ("then or at the same time", rest) if rest.op == "F" else ("", None)


def _goal(body: Formula, how: _How) -> str:
    """Return the last goal of a sequence.

    It is a choice, or a state together with what must hold from that step on.
    """
    if is_state(body):
        return phrase(body)
    if how.depth > 1 and body.op == "or":
        options = (phrase(part) if is_literal(part) else f"({_goals(part, how.deeper())})" for part in _parts(body))
        return "either " + " or ".join(options)
    if body.op == "and":
        states = [part for part in body.args if is_state(part)]
        temporal = [part for part in body.args if not is_state(part)]
        if states:
            goal, rest = bracketed(build.and_(*states)), build.and_(*temporal)
            if _is_about_end(rest):
                return f"{goal} at a {_step(rest, how)}"
            return f"{goal} and from that step on {_inner(rest, how)}"
    return f"a {_step(body, how)}"


def _throughout(body: Formula, how: _How) -> _Clause:
    """Return the clause of ``G``: what to keep, what to avoid, or what to do whenever something holds."""
    if _has_parts(body):
        return _together([_throughout(part, how) for part in _parts_throughout(body)])
    if body.op == "implies" and is_state(body):
        return f"whenever {phrase(body.args[0])}, {_last(body.args[1], how)}", _CLAUSE
    if _is_condition(body):
        return imperative(body, "keep", "avoid") + " throughout", _of_state(body)
    if how.endless and _without_negation(body).op == "F":
        (goal,) = _without_negation(body).args
        if is_state(goal):
            return f"reach {object_phrase(goal)} again and again", _of_state(goal)
        return f"again and again, {_last(body, how)}", _CLAUSE
    left, right = _implication(body)
    if left is not None and right is not None:
        return f"whenever {phrase(left)}, {_last(right, how)}", _CLAUSE
    return f"at every step, {_last(body, how)}", _CLAUSE


def _has_parts(body: Formula) -> bool:
    """Whether the parts of what must hold throughout are listed one by one."""
    return body.op == "and" and not all(part.op == "atom" for part in body.args)


def _is_condition(body: Formula) -> bool:
    """Whether what must hold throughout is to be kept or avoided as a whole."""
    return is_state(body) and body.op != "implies" and not _has_parts(body)


def _parts_throughout(body: Formula) -> list[Formula]:
    """Return the operands of an ``and`` that must hold throughout.

    The atoms are joined at the place of the first of them.
    """
    atoms = [part for part in body.args if part.op == "atom"]
    joined = build.and_(*atoms)
    parts = [joined if part.op == "atom" else part for part in body.args]
    return list(dict.fromkeys(parts))


def _implication(body: Formula) -> tuple[Formula | None, Formula | None]:
    """Return ``body`` as a non-temporal condition and its consequence.

    Both are None if ``body`` does not have this form.
    """
    if body.op == "implies" and is_state(body.args[0]):
        return body.args[0], body.args[1]
    if body.op == "or":
        negated = [_negated(part) for part in body.args if is_state(part)]
        if negated:
            return build.and_(*negated), build.or_(*(part for part in body.args if not is_state(part)))
    return None, None


def _until(node: Formula, how: _How) -> _Clause:
    """Return the clause of ``U W R M``."""
    left, right = node.args
    if node.op in ("U", "M"):
        goal, held = (right, left) if node.op == "U" else (left, right)
        target = f"reach {bracketed(goal)}" if is_state(goal) else f"reach a {_step(goal, how)}"
        until = "until then" if node.op == "U" else "up to and including that step"
        if is_state(held):
            return f"{target}, {imperative(held, 'keeping', 'avoiding')} {until}", _CLAUSE
        return f"{target}, and at every step {until} {_inner(held, how)}", _CLAUSE
    stop, held = (right, left) if node.op == "W" else (left, right)
    until = "until the first" if node.op == "W" else "up to and including the first"
    keep = imperative(held, "keep", "avoid") if is_state(held) else f"at every step, {_inner(held, how)},"
    return f"{keep} {until} {_step(stop, how)}, or throughout if there is none", _CLAUSE


def _next(node: Formula, how: _How) -> _Clause:
    """Return the clause of ``X`` and ``N``, single or several in a row."""
    ops = ("X", "N") if how.endless else (node.op,)
    count, body = 0, node
    while body.op in ops:
        body, count = body.args[0], count + 1
    if node.op == "X" and body is TRUE:
        return f"go on for {count} more step{'s' * (count > 1)}", _PLAIN
    if node.op == "N" and body is FALSE:
        return "be at the last step" if count == 1 else f"be at one of the last {count} steps", _PLAIN
    moment = "at the next step" if count == 1 else f"after {count} steps"
    if "X" not in ops:
        moment += ", if there is one" if count == 1 else ", if there are that many"
    if is_state(body):
        return f"{imperative(body, 'have', 'avoid')} {moment}", _of_state(body) if "X" in ops else _LIST
    return f"{moment}, {_last(body, how)}", _CLAUSE


def _bounded(operator: Bounded, how: _How) -> _Clause:
    """Return the clause of a bounded operator.

    These are the expansions ``p | X(p | X p)`` and ``p & N(p & N p)``.
    """
    steps, body = operator.steps, operator.body
    if operator.op == "F":
        within = f"within {steps} step{'s' * (steps > 1)}"
        if is_state(body):
            return f"reach {object_phrase(body)} {within}", _of_state(body)
        return f"reach {within} a {_step(body, how)}", _CLAUSE
    if is_state(body):
        return f"{imperative(body, 'keep', 'avoid')} for {steps + 1} steps", _of_state(body)
    return f"at each of {steps + 1} steps from here on, {_last(body, how)}", _CLAUSE


def _step(node: Formula, how: _How) -> str:
    """Return a noun for a moment at which ``node`` holds."""
    if _is_about_end(node):
        return f"step that is {'not ' if node.op == 'X' else ''}the last"
    return f"step with {bracketed(node)}" if is_state(node) else f"step from which on to {_inner(node, how)}"


def _inner(node: Formula, how: _How, when: str = "at that step") -> str:
    """Return the clause as part of another one, in brackets unless it is plain."""
    text, rank = _clause(node, when, how.deeper())
    return text if rank == _PLAIN else f"({text})"


def _last(node: Formula, how: _How, when: str = "at that step") -> str:
    """Return the clause as the last part of another one, in brackets if it is a list."""
    text, rank = _clause(node, when, how.deeper())
    return f"({text})" if rank == _SCOPED else text


def _of_state(state: Formula) -> int:
    """Return the rank of a clause about a state, which may contain an `and` or an `or`."""
    return _PLAIN if is_literal(state) else _LIST


def _without_negation(node: Formula) -> Formula:
    """Return a temporal formula without its leading ``not``."""
    negations = 0
    while node.op == "not":
        node, negations = node.args[0], negations + 1
    return _negated(node) if negations % 2 else node


def _negated(node: Formula) -> Formula:
    """Return the negation, pushed through the outermost operator."""
    if node.op == "iff":
        return build.iff(node.args[0], complement(node.args[1]))
    return complement(node, depth=1)


def _is_about_end(node: Formula) -> bool:
    """Whether the formula is ``X true`` or ``N false``."""
    return (node.op, *node.args) in (("X", TRUE), ("N", FALSE))
