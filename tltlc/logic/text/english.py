"""Print a formula as one English sentence in the imperative: the task of the player or agent."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from tltlc.core.names import SpokenName
from tltlc.logic import formula as build
from tltlc.logic.bounded_operators import Bounded, bounded_operator
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.logic.rewrite import simplify
from tltlc.logic.text.clause_parts import (
    avoided_sequence,
    has_rules,
    implication,
    instructed,
    is_about_end,
    is_condition,
    listed_parts,
    rules_of,
    without_negation,
)
from tltlc.logic.text.counts import NUMBERS, CountPrinter
from tltlc.logic.text.notation import WORDS, write
from tltlc.logic.text.phrases import (
    bracketed_phrase,
    has_time,
    has_verb,
    imperative,
    is_literal,
    is_state,
    object_phrase,
    phrase,
    says_when,
)
from tltlc.logic.text.sequences import next_goal

_PLAIN, _LIST, _SEQUENCE, _CLAUSE, _SCOPED = range(5)
"""Ranks of English clauses, which decide where a clause needs brackets to be read correctly.

- ``_PLAIN``: nowhere.
- ``_LIST``: inside another clause.
- ``_SEQUENCE``: in a longer list, because both have commas.
- ``_CLAUSE``: beside any other clause.
- ``_SCOPED``: even as the last part of another clause.
"""

_DEEPEST: Final = 7
"""Clauses nested deeper than this are printed as formulas in words: such a sentence is unreadable."""

_RankedClause = tuple[str, int]
"""The text of a clause, and its rank."""


class _SentenceContext(NamedTuple):
    """The settings that the functions below pass on while they turn one formula into a sentence.

    ``depth`` is how many more levels of clauses may nest. ``endless`` says whether the sentence is
    about traces that never end. ``counts`` prints the counts of steps.
    """

    depth: int
    endless: bool
    counts: CountPrinter = NUMBERS

    def deeper(self) -> _SentenceContext:
        return self._replace(depth=self.depth - 1)


def english_text(formula: Formula, *, endless: bool = False, counts: CountPrinter = NUMBERS) -> str:
    """Return the formula as one sentence, from a capital letter to a full stop.

    Atoms appear by name. ``F(near(s1) & X F near(exit)) & G alive`` reads "Reach near(s1), then
    near(exit), and keep alive throughout." "Reach" means now or later, "then" strictly later,
    "throughout" from now to the end. Formulas with the same sentence are equivalent. A formula with
    a constant is simplified first, unless its only constants are in ``X true`` and ``N false``.

    ``endless`` says that the sentence is about traces that never end. The formula must then be a
    constant, or contain no constant. ``counts`` prints the counts of steps.
    """
    formula = formula if endless else without_constants(formula)
    if formula is TRUE:
        return "Nothing remains to be done."
    if formula is FALSE:
        return "The spec is violated."
    text, _ = _clause(formula, "now", _SentenceContext(_DEEPEST, endless, counts))
    return f"{text[0].upper()}{text[1:]}."


def clause_text(formula: Formula, *, endless: bool = False, counts: CountPrinter = NUMBERS) -> str:
    """Return a formula as an English clause: ``keep alive throughout`` for ``G alive``.

    The formula must not be the constant true or false.
    ``endless`` says that the clause is about traces that never end.
    """
    return _clause(formula, "now", _SentenceContext(_DEEPEST, endless, counts))[0]


def invariant_text(invariant: Formula, *, endless: bool = False, counts: CountPrinter = NUMBERS) -> str:
    """Return the text of a formula ``G p`` for a list of permanent conditions: ``keep alive`` for ``G alive``."""
    (body,) = invariant.args
    if is_condition(body) and not has_verb(body, "reach"):
        return imperative(instructed(body), "keep", "avoid")
    return clause_text(invariant, endless=endless, counts=counts)


def recurring_text(recurring: Formula) -> str:
    """Return the text of a formula ``G F p`` for a list of recurring goals: ``reach a`` for ``G F a``."""
    (body,) = recurring.args
    reach = without_negation(body)
    if reach.op != "F":
        return clause_text(recurring, endless=True)
    (goal,) = reach.args
    return f"reach {object_phrase(goal)}" if is_state(goal) else _last_clause(body, _SentenceContext(_DEEPEST, True))


def goal_texts(reach: Formula, *, endless: bool = False, counts: CountPrinter = NUMBERS) -> tuple[tuple[str, str], ...]:
    """Return the goals of a formula ``F p`` in order, each as a pair (link, text).

    ``F(a & X F b)`` gives ``("", "a")`` and ``("then", "b")``. The link joins a goal to the
    previous one: ``then`` or ``then or at the same time``, and empty for the first goal.
    """
    return tuple(_linked_goals(reach.args[0], _SentenceContext(_DEEPEST, endless, counts)))


def without_constants(formula: Formula) -> Formula:
    """Return an equivalent formula in which constants occur only in ``X true`` and ``N false``.

    The whole formula may also become a constant.
    """
    has_constants = any((TRUE in node.args or FALSE in node.args) and not is_about_end(node) for node in formula.walk())
    return simplify(formula) if has_constants else formula


def _clause(node: Formula, when: str, context: _SentenceContext) -> _RankedClause:
    """Return a clause that tells the player to make ``node`` hold ``when``, a moment such as ``now``."""
    if is_state(node):
        if says_when(node):
            # Behind "the gems when checkpoint last began", "at that step" would be the step of the checkpoint.
            return imperative(node, f"have {when}", f"avoid {when}"), _rank_of_state(node)
        text = imperative(node, "have", "avoid")
        return text if has_time(node) else f"{text} {when}", _rank_of_state(node)
    if context.depth == 0:
        return f"satisfy {write(node, WORDS, counts=context.counts)}", _SCOPED
    operator = bounded_operator(node)
    if operator is not None:
        return _bounded_clause(operator, context)
    match node.op:
        case "not":
            return _clause(without_negation(node), when, context)
        case "and":
            parts = listed_parts(node, states_first=when != "now")
            return _join_clauses([clause for part in parts for clause in _clauses(part, when, context.deeper())])
        case "or":
            parts = listed_parts(node, states_first=when != "now")
            return "either " + " or ".join(_inner_clause(part, context, when) for part in parts), _CLAUSE
        case "implies" if is_state(node.args[0]):
            return f"if {phrase(node.args[0])} {when}, {_last_clause(node.args[1], context, when)}", _CLAUSE
        case "implies":
            return _clause(build.or_(build.not_(node.args[0]), node.args[1]), when, context)
        case "iff":
            left, right = (_inner_clause(part, context, when) for part in node.args)
            return f"do both or neither of these: {left}, {right}", _SCOPED
        case "X" | "N":
            return _next_clause(node, when, context)
        case "F":
            return _reach_clause(node, when, context)
        case "G":
            return _throughout_clause(node.args[0], context)
        case _:
            return _until_clause(node, context)


def _clauses(node: Formula, when: str, context: _SentenceContext) -> list[_RankedClause]:
    """Return the clauses of a part of an ``and``: several for ``G (a & !b)``."""
    if node.op == "G" and has_rules(node.args[0]) and context.depth > 0:
        return [_throughout_clause(rule, context) for rule in rules_of(node.args[0])]
    return [_clause(node, when, context)]


def _join_clauses(clauses: Sequence[_RankedClause]) -> _RankedClause:
    """Join clauses to one clause: ``reach a, and keep b throughout``."""
    texts = [text for text, _ in clauses]
    if len(texts) == 1:
        return clauses[0]
    sequences = sum(rank == _SEQUENCE for _, rank in clauses)
    is_nested = any(rank >= _CLAUSE for _, rank in clauses) or sequences > 1 or (sequences and len(texts) > 2)
    separator = "; " if is_nested else ", "
    return f"{separator.join(texts[:-1])}{separator}and {texts[-1]}", _SCOPED


def _reach_clause(node: Formula, when: str, context: _SentenceContext) -> _RankedClause:
    """Return the clause of a formula ``F p``, which names a goal or a sequence of goals: ``reach a, then b``."""
    (body,) = node.args
    if without_negation(body).op == "G":
        return f"from some step on {_inner_clause(body, context)}", _LIST
    if is_state(body) and when != "now":
        return f"reach {object_phrase(body)} {when} or later", _rank_of_state(body)
    rank = _SEQUENCE if next_goal(body) is not None else _rank_of_state(body)
    return f"reach {_goals(body, context)}", rank


def _goals(body: Formula, context: _SentenceContext) -> str:
    """Return the text of the goals of ``F body`` in order: ``a, then b, then c``."""
    return "".join(f", {link} {goal}" if link else goal for link, goal in _linked_goals(body, context))


def _linked_goals(body: Formula, context: _SentenceContext) -> Iterator[tuple[str, str]]:
    """Yield a pair (link, text) for each goal of ``F body``, in order.

    The link, such as ``then``, joins the goal to the previous one; the first link is empty.
    """
    link = time = ""
    while (following := next_goal(body)) is not None:
        state = build.and_(*(part for part in body.args if is_state(part)))
        yield link, f"{bracketed_phrase(state) if time else phrase(state)}{time}"
        steps = following.steps
        time = "" if steps is None else f" within {context.counts.time(steps)} after {bracketed_phrase(state)}"
        link, body = following.link, following.body
    yield link, f"{bracketed_phrase(body)}{time}" if time and is_state(body) else f"{_goal(body, context)}{time}"


def _goal(body: Formula, context: _SentenceContext) -> str:
    """Return the text of the last goal in a sequence of goals.

    ``body`` is the formula that must hold when the goal is reached. The text is a condition, or a
    condition and what must hold from that step on, or ``either … or …``, or ``a step …``.
    """
    if is_state(body):
        return phrase(body)
    if context.depth > 1 and body.op == "or":
        options = (
            phrase(part) if is_literal(part) else f"({_goals(part, context.deeper())})" for part in listed_parts(body)
        )
        return "either " + " or ".join(options)
    if body.op == "and":
        states = [part for part in body.args if is_state(part)]
        temporal = [part for part in body.args if not is_state(part)]
        if states:
            goal, rest = bracketed_phrase(build.and_(*states)), build.and_(*temporal)
            if is_about_end(rest):
                return f"{goal} at a {_step_noun(rest, context)}"
            return f"{goal} and from that step on {_inner_clause(rest, context)}"
    return f"a {_step_noun(body, context)}"


def _throughout_clause(body: Formula, context: _SentenceContext) -> _RankedClause:
    """Return the clause of ``G body``, such as ``keep a throughout`` or ``whenever a, reach b``."""
    while without_negation(body).op == "G":
        (body,) = without_negation(body).args
    if has_rules(body):
        return _join_clauses([_throughout_clause(part, context) for part in rules_of(body)])
    if body.op == "implies" and is_state(body):
        return f"whenever {phrase(body.args[0])}, {_last_clause(body.args[1], context)}", _CLAUSE
    if has_verb(body, "reach"):
        return f"at every step, {imperative(body, 'keep', 'avoid')}", _CLAUSE
    if is_condition(body):
        return imperative(instructed(body), "keep", "avoid") + " throughout", _rank_of_state(body)
    sequence = avoided_sequence(body)
    if sequence is not None:
        return f"avoid the sequence ({_goals(sequence, context)}) throughout", _LIST
    if context.endless and without_negation(body).op == "F":
        (goal,) = without_negation(body).args
        if is_state(goal):
            return f"reach {object_phrase(goal)} again and again", _rank_of_state(goal)
        return f"again and again, {_last_clause(body, context)}", _CLAUSE
    left, right = implication(without_negation(body))
    if left is not None and right is not None:
        return f"whenever {phrase(left)}, {_last_clause(right, context)}", _CLAUSE
    return f"at every step, {_last_clause(body, context)}", _CLAUSE


def _until_clause(node: Formula, context: _SentenceContext) -> _RankedClause:
    """Return the clause of a formula with the outermost operator ``U``, ``W``, ``R`` or ``M``."""
    left, right = node.args
    if node.op in ("U", "M"):
        goal, held = (right, left) if node.op == "U" else (left, right)
        target = f"reach {bracketed_phrase(goal)}" if is_state(goal) else f"reach a {_step_noun(goal, context)}"
        until = "until then" if node.op == "U" else "up to and including that step"
        if is_state(held):
            return f"{target}, {imperative(held, 'keeping', 'avoiding')} {until}", _CLAUSE
        return f"{target}, and at every step {until} {_inner_clause(held, context)}", _CLAUSE
    stop, held = (right, left) if node.op == "W" else (left, right)
    until = "until the first" if node.op == "W" else "up to and including the first"
    keep = imperative(held, "keep", "avoid") if is_state(held) else f"at every step, {_inner_clause(held, context)},"
    return f"{keep} {until} {_step_noun(stop, context)}, or throughout if there is none", _CLAUSE


def _next_clause(node: Formula, when: str, context: _SentenceContext) -> _RankedClause:
    """Return the clause of a formula that begins with one or more ``X``, or one or more ``N``."""
    ops = ("X", "N") if context.endless else (node.op,)
    count, body = 0, node
    while (following := without_negation(body)).op in ops:
        body, count = following.args[0], count + 1
    if body is (TRUE if node.op == "X" else FALSE):
        return _end_clause(node.op, count, when, context), _LIST
    operator = bounded_operator(without_negation(body)) if count == 1 else None
    if operator is not None and is_state(operator.body) and (context.endless or node.op + operator.op in ("XF", "NG")):
        return _bounded_clause(operator, context, begins_next=True)
    moment = "at the next step" if count == 1 else f"after {context.counts.time(count)}"
    if "X" not in ops:
        moment += ", if there is one" if count == 1 else ", if the play goes on for that long"
    if is_state(body):
        return f"{imperative(body, 'have', 'avoid')} {moment}", _rank_of_state(body) if "X" in ops else _LIST
    if "X" not in ops and count == 1 and without_negation(body).op == "G":
        return _later_clause(without_negation(body).args[0], context)
    return f"{moment}, {_last_clause(body, context)}", _CLAUSE


def _later_clause(body: Formula, context: _SentenceContext) -> _RankedClause:
    """Return the clause of ``N G body``: ``keep a from the next step on``."""
    if is_condition(body) and not has_verb(body, "reach"):
        return f"{imperative(instructed(body), 'keep', 'avoid')} from the next step on", _LIST
    text, rank = _throughout_clause(body, context)
    return f"from the next step on, {f'({text})' if rank == _SCOPED else text}", _CLAUSE


def _end_clause(op: str, count: int, when: str, context: _SentenceContext) -> str:
    """Return the clause of ``X true`` or ``N false`` with ``count`` operators, about a step ``when``."""
    if count == 1:
        moment = "at this step" if when == "now" else when
        return f"the play must {'not end' if op == 'X' else 'end'} {moment}"
    if op == "X":
        return f"the play must go on for at least {context.counts.number(count)} more steps"
    return f"the play must end at most {context.counts.steps(count - 1)} later"


def _bounded_clause(operator: Bounded, context: _SentenceContext, begins_next: bool = False) -> _RankedClause:
    """Return the clause of a bounded operator, ``F[0,n] p`` or ``G[0,n] p``, at the next step if it ``begins_next``."""
    steps, body = operator.steps, operator.body
    time = "the next " * begins_next + context.counts.time(steps + (begins_next or operator.op == "G"))
    if operator.op == "F":
        if is_state(body):
            goal = f"({phrase(body)})" if isinstance(body.name, SpokenName) else bracketed_phrase(body)
            return f"reach {goal} within {time}", _PLAIN
        return f"reach within {time} a {_step_noun(body, context)}", _CLAUSE
    if is_state(body):
        kept = f"keep {bracketed_phrase(body)}" if body.op in ("or", "implies", "iff") else None
        return f"{kept or imperative(body, 'keep', 'avoid')} for {time}", _rank_of_state(body)
    return f"at each of {context.counts.steps(steps + 1)} from here on, {_last_clause(body, context)}", _CLAUSE


def _step_noun(node: Formula, context: _SentenceContext) -> str:
    """Return a phrase for a step at which ``node`` holds, for example ``step with near(exit)``."""
    if is_about_end(node):
        return f"step that is {'not ' if node.op == 'X' else ''}the last"
    return (
        f"step with {bracketed_phrase(node)}"
        if is_state(node)
        else f"step that begins this: {_inner_clause(node, context)}"
    )


def _inner_clause(node: Formula, context: _SentenceContext, when: str = "at that step") -> str:
    """Return the clause of ``node`` for use inside another clause: in brackets, unless its rank is ``_PLAIN``."""
    text, rank = _clause(node, when, context.deeper())
    return text if rank == _PLAIN else f"({text})"


def _last_clause(node: Formula, context: _SentenceContext, when: str = "at that step") -> str:
    """Return the clause of ``node`` for use at the end of another clause: in brackets if its rank is ``_SCOPED``."""
    text, rank = _clause(node, when, context.deeper())
    return f"({text})" if rank == _SCOPED else text


def _rank_of_state(state: Formula) -> int:
    """Return the rank of a clause about ``state``, a formula without temporal operators."""
    return _PLAIN if is_literal(state) else _LIST
