"""An edit of a random clause is offered only if the clause has a single reading.

The tests compute all readings over traces, without the compiler: a word can belong to the operand next to it or to
everything on one side of it.  An edit is allowed only if all readings are equal.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from itertools import product

import pytest

from tests.grammar.edited_clauses import HEAD, edited_specs
from tests.grammar.test_english import (
    LETTERS,
    Here,
    Trace,
    Whole,
    a,
    at_every_step,
    at_some_step,
    atoms_of,
    b,
    both,
    c,
    clause_meaning,
    compile_spec,
    either,
    negation,
    until,
    verdicts,
)

CLAUSES = ("reach", "keep", "avoid", "require")
OPERATORS: dict[str, Callable[[Here], Here]] = {
    "": lambda one: one,
    "not ": negation,
    "never ": lambda one: at_every_step(negation(one)),
    "always ": at_every_step,
    "eventually ": lambda one: at_some_step(one, 0),
}
JOINS: dict[str, Callable[[Here], Here]] = {
    "": lambda one: one,
    "c and ": lambda one: both(c, one),
    "c or ": lambda one: either(c, one),
    "c implies ": lambda one: either(negation(c), one),
}
RIGHT: dict[str, tuple[Here, Callable[[Here], Here]]] = {
    "b": (b, lambda one: one),
    "b and c": (both(b, c), lambda one: both(one, c)),
    "b or c": (either(b, c), lambda one: either(one, c)),
}
"""The right side as one operand, and the rest of it for a word that belongs to `b` alone."""
WORDS = ("if", "while", "before", "after", "followed by", "unless", "without", "but", "xor", "nor", "nand")
AROUND: dict[str, Callable[[Here], Here] | None] = {
    "{}": None,
    "not ({})": negation,
    "always ({})": at_every_step,
    "eventually ({})": lambda one: at_some_step(one, 0),
    "({}) and c": lambda one: both(one, c),
    "({}) implies c": lambda one: either(negation(one), c),
}


def word_meaning(word: str, left: Here, right: Here, clause: str) -> Here:
    """The meaning of a word between two operands, as a formula in this kind of clause."""
    joined = {
        "but": both(left, right),
        "without": both(left, negation(right)),
        "xor": either(both(left, negation(right)), both(negation(left), right)),
        "nor": negation(either(left, right)),
        "nand": negation(both(left, right)),
    }
    if word in joined:
        return joined[word]
    if word in ("if", "while"):
        return both(left, right) if clause in ("reach", "avoid") else either(left, negation(right))
    if word == "unless":
        of_step = {"reach": either(left, right), "keep": either(left, right), "avoid": both(left, negation(right))}
        return of_step.get(clause, until(left, right))
    first, then = (right, left) if word == "after" else (left, right)
    return at_some_step(both(first, at_some_step(then, 1)), 0)


def clause_with_word(word: str, left: Here, right: Here, clause: str) -> Whole:
    """The meaning of a clause whose two sides are joined by a word."""
    if word == "without" and clause in ("reach", "keep"):
        goal, never = clause_meaning(clause, left), clause_meaning("avoid", right)
        return lambda trace: goal(trace) and never(trace)
    wanted = negation(left) if clause == "avoid" else left
    if word == "before" and clause in ("keep", "avoid"):
        return clause_meaning("require", until(wanted, right))
    if word == "after" and clause in ("keep", "avoid"):
        return clause_meaning("keep", either(negation(right), at_every_step(wanted)))
    if word == "followed by" and clause == "keep":
        return clause_meaning("keep", either(negation(left), at_some_step(right, 1)))
    return clause_meaning(clause, word_meaning(word, left, right, clause))


Parts = tuple[str, str, str, str, str, str]
"""The parts of a clause: its keyword, what is around it, a joined atom, an operator, a word, and its right side."""

TRACES: list[Trace] = [trace for length in (1, 2, 3, 4) for trace in product(LETTERS, repeat=length)]
SAMPLE_TRACES: list[Trace] = TRACES[::7]


def reading(clause: str, around: str, join: str, operator: str, word: str, right: str) -> Whole | None:
    """The single meaning of a clause, or None if it has several meanings or no clear one."""
    outer = AROUND[around]
    if clause == "require" and word == "while" and around != "always ({})":
        return None
    if word == "before" and clause not in ("keep", "avoid"):
        # Either `b` must come later, or it must only not come first.
        return None
    kind = clause
    if outer is not None:
        if word in ("if", "while"):
            rule = clause == "keep" and around == "({}) and c"
            rule = rule or (clause in ("keep", "require") and around == "always ({})")
            if not rule and not (clause == "require" and around == "({}) and c" and word == "if"):
                return None
        elif word in ("before", "after", "followed by", "unless") and (
            clause != "require" or around not in ("({}) and c",)
        ):
            return None
        kind = "keep" if word in ("if", "while") else "require"
    if operator in ("always ", "eventually ", "never "):
        return None
    tail, whole_right = RIGHT[right][1], RIGHT[right][0]
    lefts: list[tuple[Here, Callable[[Here], Here] | None]] = [(JOINS[join](OPERATORS[operator](a)), None)]
    if join:
        lefts.append((OPERATORS[operator](a), JOINS[join]))
    if operator == "not " and word != "but":
        lefts.append((a, lambda one: JOINS[join](negation(one))))
    meanings: list[Whole] = []
    for (left, before), (other, behind) in product(lefts, [(whole_right, None), (b, tail)][: 1 if right == "b" else 2]):
        if outer is None and before is None and behind is None:
            meanings.append(clause_with_word(word, left, other, clause))
            continue
        if outer is None and not join and right == "b":
            meanings.append(_negated_clause(word, left, other, clause))
            continue
        inner = "avoid" if before is not None and operator == "not " and left is a else kind
        meaning = word_meaning(word, left, other, inner)
        meaning = before(meaning) if before else meaning
        meaning = behind(meaning) if behind else meaning
        meanings.append(clause_meaning(clause, outer(meaning) if outer else meaning))
    if any(one(trace) != meanings[0](trace) for one in meanings[1:] for trace in SAMPLE_TRACES):
        return None
    return meanings[0]


def _negated_clause(word: str, left: Here, right: Here, clause: str) -> Whole:
    """The meaning of `not a WORD b` where `not` applies to all of it, if ``left`` is ``a`` alone."""
    if left is not a:
        return clause_with_word(word, left, right, clause)
    opposite = {"keep": "avoid", "avoid": "keep"}
    if clause in opposite:
        return clause_with_word(word, left, right, opposite[clause])
    return clause_meaning(clause, negation(word_meaning(word, left, right, "avoid")))


def test_the_random_clauses_include_clear_and_unclear_ones() -> None:
    # The random clauses must contain both kinds, or the test of their edits would prove nothing.
    results = [(bool(edited_specs(text(parts))), reading(*parts) is not None) for parts in random_parts(400)]
    assert sum(fixed and clear for fixed, clear in results) > 40
    assert sum(not clear for _, clear in results) > 100


def random_parts(number: int) -> list[Parts]:
    """Return the parts of random clauses: ``number`` of any kind, and ``number`` of a kind that is often clear."""
    all_parts = list(product(CLAUSES, AROUND, JOINS, OPERATORS, WORDS, RIGHT))
    clear_parts = list(
        product(CLAUSES, list(AROUND)[::4], list(JOINS)[:3], list(OPERATORS)[:2], WORDS, list(RIGHT)[:2])
    )
    random_ = random.Random(7)
    return [*random_.sample(all_parts, number), *random_.sample(clear_parts, number)]


def text(parts: Parts) -> str:
    """Return the text of a clause."""
    clause, around, join, operator, word, right = parts
    return f"{clause} {around.format(f'{join}{operator}a {word} {right}')}"


@pytest.mark.parametrize("parts", random_parts(400), ids=text)
def test_an_edit_of_a_random_clause_has_its_single_reading(parts: Parts) -> None:
    edited_texts = edited_specs(text(parts))
    meaning = reading(*parts) if edited_texts else None
    for edited in edited_texts:
        assert meaning is not None, edited
        body = edited.removeprefix(HEAD)
        atoms = atoms_of(f"{text(parts)} {body}")
        wrong = [trace for trace, accepted in verdicts(compile_spec(body), atoms) if accepted != meaning(trace)]
        assert not wrong, f"{edited}: {[sorted(letter) for letter in wrong[0]]}"
