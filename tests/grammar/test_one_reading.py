"""An edit is offered only for a clause with a single reading, and it has that reading.

The expected edits in the table are written by hand.  For random clauses, the tests compute all readings over traces,
without the compiler: a word can belong to the operand next to it or to everything on one side of it.  An edit is
allowed only if all readings are equal.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import cache
from itertools import product

import pytest

import tltlc
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
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.parser import parse
from tltlc.resolve.resolution import resolve
from tltlc.tools.lint.fixes import fixes_of_errors
from tltlc.tools.lint.scopes import apply_edits

HEAD = """entity k, d
signal a: bool
signal b: bool
signal c: bool
signal p(e): bool
signal q(e): bool
"""

ALL, ANY = "all x in (k, d): p(x)", "any x in (k, d): p(x)"

TIMES = (
    *(f"a {word} 3 steps" for word in ("for", "within", "after", "until")),
    *(f"{word} 3 steps" for word in ("a", "for", "after", "until", "within", "every", "from", "over", "under", "at")),
    *(f"{word} 3 steps" for word in ("not", "never", "always", "eventually", "next", "minimum", "max", "wait", "hold")),
    *(f"{words} 3 steps" for words in ("at least", "at most", "more than", "limit not", "limit no", "limit at least")),
    *(f"{words} 3 steps" for words in ("no limit", "not limit", "guard delay", "a limit", "limit a", "limit over")),
    "3 steps",
    "a = 3 steps",
    "3 steps a",
    "a = 50 %",
    "a 3 m",
)
"""Lines with a time that are not a limit, or not clearly one."""
LIMITS = ("limit of 30 steps", "limit: 30", "timeout 30 turns", "30 steps limit", "max time 30 steps")

ROWS: list[tuple[str, str | None]] = [
    # After an operator.
    ("require always a before b", None),
    ("require always a after b", None),
    ("require always a followed by b", None),
    ("require always a without b", None),
    ("require always a unless b", None),
    ("require always a if b", None),
    ("require always a while b", None),
    ("require always a but b", None),
    ("require always a within 5 steps", None),
    ("require always a for 5 steps", None),
    ("require always a implies b within 5 steps", None),
    ("require eventually a before b", None),
    ("require eventually a without b", None),
    ("require eventually a unless b", None),
    ("require eventually a for 5 steps", None),
    ("require a before always b", None),
    ("require never a before b", None),
    ("require not a before b", None),
    ("require not a within 5 steps", None),
    ("reach eventually a before b", None),
    ("reach always a without b", None),
    ("reach a without always b", None),
    ("reach always a within 5 steps", None),
    ("reach not a before b", None),
    ("reach not a while b", None),
    ("reach not a within 5 steps", None),
    ("keep always a before b", None),
    ("keep eventually a if b", None),
    ("keep a if always b", None),
    ("keep never a before b", None),
    ("keep not a followed by b", None),
    ("keep always a for 5 steps", None),
    ("avoid always a while b", None),
    ("avoid not a while b", None),
    ("avoid not a unless b", None),
    ("avoid not a within 5 steps", None),
    ("keep not a before b", "require not a weak_until b"),
    ("keep not a after b", "keep b implies always not a"),
    ("keep not a while b", "keep b implies not a"),
    ("keep not a unless b", "keep not a or b"),
    ("keep not a for 5 steps", "require always for 5 steps not a"),
    ("keep (eventually a) if b", "keep b implies eventually a"),
    ("reach (eventually a) before b", None),
    ("require (a then b) before c", None),
    # Each word between two atoms.
    ("reach a before b", None),
    ("reach a after b", "reach b then a"),
    ("reach a followed by b", "reach a then b"),
    ("reach a without b", "reach a avoid b"),
    ("reach a unless b", "reach a or b"),
    ("reach a while b", "reach a and b"),
    ("reach a if b", "reach a and b"),
    ("reach a within 5 steps", "require eventually within 5 steps a"),
    ("reach a for 2 steps", "reach (always for 2 steps a) and next after 1 step a"),
    ("keep a before b", "require a weak_until b"),
    ("keep a after b", "keep b implies always a"),
    ("keep a followed by b", "keep a implies next eventually b"),
    ("keep a without b", "keep a avoid b"),
    ("keep a unless b", "keep a or b"),
    ("keep a while b", "keep b implies a"),
    ("keep a if b", "keep b implies a"),
    ("keep a for 5 steps", "require always for 5 steps a"),
    ("keep a within 5 steps", None),
    ("avoid a before b", "require (not a) weak_until b"),
    ("avoid a after b", "require always (b implies always not a)"),
    ("avoid a followed by b", "avoid a then b"),
    ("avoid a without b", "avoid a and not b"),
    ("avoid a unless b", "avoid a and not b"),
    ("avoid a while b", "avoid a and b"),
    ("avoid a if b", "avoid a and b"),
    ("avoid a within 5 steps", "require not eventually within 5 steps a"),
    ("avoid a for 5 steps", "require always for 5 steps not a"),
    ("require a before b", None),
    ("require a after b", "require b then a"),
    ("require a without b", "require a and not b"),
    ("require a unless b", "require a weak_until b"),
    ("require a if b", "require b implies a"),
    ("require a while b", None),
    ("require a whenever b", None),
    ("require while b, a", None),
    ("require a within 5 steps", "require eventually within 5 steps a"),
    # Between several operands.
    ("reach c and a before b", None),
    ("reach a before b and c", None),
    ("keep a and b before c", None),
    ("keep a and b while c", None),
    ("keep a while b or c", None),
    ("keep a or b while c", "keep c implies (a or b)"),
    ("reach a or b while c", None),
    ("reach a and b while c", "reach a and b and c"),
    ("reach a or b without c", None),
    ("reach a and b without c", None),
    ("reach a then b without c", None),
    ("keep a and b without c", "keep a and b avoid c"),
    ("reach a after b then c", None),
    ("reach a unless b then c", None),
    ("reach a before b then c", None),
    ("keep a if b then c", None),
    ("keep a unless b or c", "keep a or (b or c)"),
    ("keep a and b unless c", None),
    # A clause that begins with an operator.
    ("not a", "avoid a"),
    ("not a or b", None),
    ("not a and b", None),
    ("not a until b", None),
    ("not a implies b", None),
    ("always a", "keep a"),
    ("always a and eventually b", None),
    ("always a or b", None),
    ("always (a or b)", "keep a or b"),
    ("eventually a", "reach a"),
    ("eventually a and always b", None),
    ("eventually a or always b", None),
    ("eventually a implies eventually b", None),
    ("never a", "avoid a"),
    ("never a or b", None),
    ("never a until b", None),
    ("never a implies b", None),
    ("never a then b", None),
    ("never a and always b", None),
    ("forbid a and b", "avoid a and b"),
    ("forbid a until b", None),
    ("stay a until b", None),
    ("maintain a implies b", "keep a implies b"),
    ("must a", None),
    ("must always a", "require always a"),
    ("if b then a", "keep b implies a"),
    ("if b then not a", "keep b implies not a"),
    ("if always b, a", None),
    # A keyword, or a synonym of it, inside a formula.
    ("require never a", "require always not a"),
    ("require never a until b", None),
    ("require never a or b", None),
    ("require never a and always b", None),
    ("keep a implies never b", None),
    ("keep a or never b", None),
    ("reach a and never b", None),
    ("keep no a", "keep not a"),
    ("keep no a or b", None),
    ("reach a then avoid b", None),
    ("reach a then keep b", None),
    ("reach a then never b", None),
    ("reach a then b then avoid c", None),
    ("reach a then reach b", "reach a then b"),
    ("avoid a then keep b", None),
    ("avoid a then reach b", None),
    ("keep a then reach b", None),
    ("keep a until reach b", None),
    ("reach a implies reach b", None),
    ("reach (a or keep b)", None),
    ("require always a implies reach b", None),
    ("reach a then b or keep c", None),
    ("keep a or reach b", "require (always a) or (eventually b)"),
    ("keep a and reach b", "keep a reach b"),
    ("keep a or b and reach c", None),
    ("keep a implies reach b", "keep a implies eventually b"),
    # Words of logics and languages.
    ("keep a nor b", "keep not (a or b)"),
    ("keep a nand b", "keep not (a and b)"),
    ("keep a xnor b", "keep a iff b"),
    ("keep a xor b", "keep not (a iff b)"),
    ("keep not a nor b", None),
    ("keep a nor b or c", None),
    ("keep a NOR b", None),
    ("keep a NAND b", None),
    ("keep a XOR b", None),
    ("keep a else b", None),
    ("keep a entails b", None),
    ("unreach a", None),
    # A condition at the start, with more operators after it.
    ("if a then avoid b until c", None),
    ("if a then avoid b weak_until c", None),
    ("if a, avoid b until c", None),
    ("whenever a, avoid b release c", None),
    ("when a then keep b until c", None),
    ("if a then reach b or c", None),
    ("if a then b until c", None),
    ("if a then b implies c", None),
    ("keep if a then b until c", None),
    ("require if a then b iff c", None),
    ("if a until b then c", "keep (a until b) implies c"),
    ("if a then (b until c)", "keep a implies (b until c)"),
    ("if a then avoid (b until c)", None),
    ("if a then avoid b", None),
    ("if a then keep b", None),
    ("while a, avoid b", None),
    ("while a, keep b", None),
    ("while a, reach b", None),
    ("whenever a: avoid b", None),
    ("if a then reach b", "keep a implies eventually b"),
    ("if a then b or c", "keep a implies (b or c)"),
    # A time on a separate line.
    *((f"{line}\nreach b", None) for line in TIMES),
    *((f"{line} reach b", None) for line in TIMES),
    *((f"{line}\nreach b", "reach b") for line in LIMITS),
    ("timeout 30 steps reach b", None),
    ("limit of 30 steps reach b", "reach b"),
    ("keep a implies avoid b until c", None),
    ("require a implies avoid b until c", None),
    ("require always (a implies avoid b until c)", None),
    ("require avoid a until b", None),
    ("reach a or avoid b until c", None),
    ("keep a implies reach b or c", None),
    ("keep a implies avoid b or c", None),
    # Lines without a keyword, or with a mark before it.
    ("a", None),
    ("p(k)", None),
    ("avoid\na\nb", None),
    ("always a implies eventually b", None),
    ("eventually p(k) and p(d)", None),
    ("always for 3 steps a", "require always for 3 steps a"),
    *((f"{sign} {clause} a", None) for sign in "!~¬?" for clause in ("reach", "keep", "avoid")),
    *((f"{mark} {clause} a", f"{clause} a") for mark in ("-", "*", "1.") for clause in ("reach", "keep", "avoid")),
    ("not reach a", None),
    ("always keep a", None),
    # Filler words, and text in quotes.
    ("keep both a and b", "keep a and b"),
    ("keep either a or b", "keep a or b"),
    ("reach first a then b", "reach a then b"),
    ("keep the a", "keep a"),
    ("avoid being a", "avoid a"),
    ("avoid both a and b", None),
    ("reach both a and b", None),
    ("keep both a and b or c", None),
    ("keep not either a or b", None),
    ("keep not both a and b", None),
    ("keep c and either a or b", None),
    ("keep c or both a and b", None),
    ("keep always either a or b", None),
    ("keep next to a", None),
    *((f"reach {quoted} and c", "reach (a or b) and c") for quoted in ('"a or b"', "'a or b'", "“a or b”")),
    ('reach not "a until b"', "reach not (a until b)"),
    ('reach "a or b"', "reach a or b"),
    ("keep a is false", "keep not a"),
    ("keep a is not true and b", "keep not a and b"),
    ("keep a and b is true", "keep a and b"),
    ("keep a or b is false", None),
    ("keep a and b is not true", None),
    ("require always a is false", None),
    ("keep all x in (k, d): p(x) is false", None),
    # Operators between two formulas.
    ("keep a not b", "keep a and not b"),
    ("keep a always b", None),
    ("keep a eventually b", None),
    ("reach a next b", None),
    ("reach a eventually b", None),
    ("keep a => b", "keep a implies b"),
    ("reach a => b", None),
    # Commas.
    ("reach a, b, then c", "reach a then b then c"),
    ("reach a and b, c", "reach (a and b) then c"),
    *((f"reach a, b{joint} c", None) for joint in (" or", ", or", " and", ", and", " until", " implies")),
    *((f"{clause} a, b{joint} c", None) for clause in ("keep", "require") for joint in (" or", ", or", " until")),
    *((f"avoid a, b{joint} c", None) for joint in (" and", ", and", " until")),
    ("keep a, b, and c", "keep a and b and c"),
    ("avoid a, b, or c", "avoid a or b or c"),
    ("keep a or b, c", None),
    ("keep a implies b, c", None),
    ("keep not a, b", None),
    ("keep a, not b", "keep a and not b"),
    ("require always a, b", None),
    ("require a, always b", "require a and always b"),
    ("avoid a, reach b", "avoid a reach b"),
    ("avoid a, keep b", "avoid a keep b"),
    ("keep a, reach b", "keep a reach b"),
    ("keep a or b, reach c", None),
    ("keep always a, reach b", None),
    ("reach a, keep b", None),
    ("reach a, reach b", None),
    ("avoid a, b, reach c", None),
    # In brackets.
    ("require eventually (a while b)", None),
    ("require eventually (a if b)", None),
    ("require eventually (if b then a)", None),
    ("require eventually (a before b)", None),
    ("require eventually (a within 5 steps)", None),
    ("require not (a while b)", None),
    ("require not (a before b)", None),
    ("require not (a for 5 steps)", None),
    ("require not (a within 5 steps)", "require not eventually within 5 steps a"),
    ("require always not (a while b)", None),
    ("require always (a before b)", None),
    ("require always (a after b)", None),
    ("require always (a followed by b)", None),
    ("require always (a unless b)", None),
    ("require always (a for 5 steps)", None),
    ("require always (a after 5 steps)", None),
    ("require always (a while b)", "require always (b implies a)"),
    ("require always (if b, a)", "require always (b implies a)"),
    ("require (a if b) and c", "require (b implies a) and c"),
    ("require (a while b) and c", None),
    ("require (a before b) and c", None),
    ("require (a before b) implies c", None),
    ("require c until (a before b)", None),
    ("keep not (a if b)", None),
    ("keep (a while b)", "keep b implies a"),
    ("keep (a while b) implies c", None),
    ("keep (a before b)", None),
    ("reach (a while b)", None),
    ("reach (a without b)", "reach a and not b"),
    ("avoid (a xor b)", "avoid not (a iff b)"),
    ("avoid (a unless b)", None),
    # After quantifiers.
    (f"reach {ALL} before b", None),
    (f"reach {ALL} without b", None),
    (f"reach {ALL} within 5 steps", None),
    (f"reach {ALL} while b", f"reach ({ALL}) and b"),
    (f"keep {ALL} while b", f"keep b implies ({ALL})"),
    (f"keep {ANY} if b", f"keep b implies ({ANY})"),
    (f"keep {ALL} while q(x)", None),
    (f"keep {ALL} before b", None),
    (f"keep {ALL} for 5 steps", f"require always for 5 steps ({ALL})"),
    ("keep all x in (k, d): (p(x) while q(x))", "keep all x in (k, d): (q(x) implies p(x))"),
    ("keep all x in (k, d): (p(x) before b)", None),
    (f"require {ALL} after b", None),
    (f"require {ANY} unless b", None),
    (f"require {ALL} within 5 steps", None),
    ("require all x in (k, d): (p(x) before b)", None),
]


def errors(source: SourceFile) -> tuple[Diagnostic, ...]:
    module, diagnostics = parse(source)
    return tuple(
        diagnostic for diagnostic in (*diagnostics, *resolve(module).diagnostics) if diagnostic.severity == "error"
    )


@cache
def edited_specs(clause: str) -> list[str]:
    """Return the valid specs that the offered edits of a clause lead to, applied repeatedly until no error is left."""
    queue, valid = [f"{HEAD}spec s {{ {clause}\n}}\n"], []
    while queue:
        source = SourceFile("a.tltl", queue.pop())
        diagnostics = errors(source)
        if not diagnostics:
            valid.append(source.text)
        offers = fixes_of_errors(diagnostics, source, lambda text: (parse(text)[1], errors(text)))
        queue += (apply_edits(source, offer.fix.edits).text for offer in offers)
    return valid


@pytest.mark.parametrize(("clause", "meant"), ROWS, ids=[clause for clause, _ in ROWS])
def test_an_edit_gives_the_intended_clause(clause: str, meant: str | None) -> None:
    texts = edited_specs(clause)
    assert bool(texts) == (meant is not None), texts
    for text in texts:
        (expected,) = tltlc.compile_text(f"{HEAD}spec s {{ {meant} }}")
        (actual,) = tltlc.compile_text(text)
        assert actual.formula == expected.formula, text


# --- readings -------------------------------------------------------------------------------------

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
