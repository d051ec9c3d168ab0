"""The edit that a help offers for plain English has the meaning of the sentence, and keeps all of its atoms.

The expected meanings are written by hand for each word, clause and prefix, over traces and without the compiler.
The meaning of an unclear sentence is None; for such a sentence the help must not offer an edit.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import chain, combinations

import pytest

import tltlc
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.grammar.mistakes import english
from tltlc.grammar.parser import parse
from tltlc.monitor.guards import holds
from tltlc.monitor.tables import tables
from tltlc.tools.lint.scopes import after
from tltlc.tools.witness.blocks import values

Letter = frozenset[str]
Trace = tuple[Letter, ...]
Here = Callable[[Trace, int], bool]
"""Whether a formula holds at a sample of a trace."""
Whole = Callable[[Trace], bool]

ATOMS = "abc"
LETTERS = [frozenset(names) for names in chain.from_iterable(combinations(ATOMS, size) for size in range(4))]
LONGEST = 4
STEPS = 2
TIME = f"{STEPS} steps"

CLAUSES = ("reach", "keep", "avoid", "require")
PREFIXES = ("", "c then ", "c and ", "c or ", "c implies ", "not ")
CONDITIONS = ("if", "when", "whenever", "while", "during")
ORDER = ("before", "after", "followed by")
INFIX = (*CONDITIONS, *ORDER, "unless", "without", "but", "xor", "xnor", "nor", "nand")
TIMES = ("within", "in", "before", "by", "for", "after")


def a(trace: Trace, at: int) -> bool:
    return "a" in trace[at]


def b(trace: Trace, at: int) -> bool:
    return "b" in trace[at]


def c(trace: Trace, at: int) -> bool:
    return "c" in trace[at]


def both(one: Here, other: Here) -> Here:
    return lambda trace, at: one(trace, at) and other(trace, at)


def either(one: Here, other: Here) -> Here:
    return lambda trace, at: one(trace, at) or other(trace, at)


def negated(one: Here) -> Here:
    return lambda trace, at: not one(trace, at)


def later(one: Here, first: int, last: int | None = None) -> Here:
    """The formula holds at some sample from ``first`` to ``last`` steps ahead."""
    return lambda trace, at: any(
        one(trace, there) for there in range(at + first, len(trace)) if last is None or there <= at + last
    )


def throughout(one: Here, first: int = 0, last: int | None = None) -> Here:
    """The formula holds at all samples from ``first`` to ``last`` steps ahead, up to the end of the trace."""
    return negated(later(negated(one), first, last))


def stays(one: Here) -> Here:
    """The formula holds at ``STEPS`` samples in a row, and the trace has all of them."""
    return lambda trace, at: at + STEPS <= len(trace) and all(one(trace, at + step) for step in range(STEPS))


def until(one: Here, other: Here) -> Here:
    """``one`` holds at each sample before the first one with ``other``, which need not exist (weak until)."""
    return lambda trace, at: all(
        one(trace, there) for there in range(at, len(trace)) if not later(other, 0, there - at)(trace, at)
    )


def whole(clause: str, formula: Here) -> Whole:
    """The meaning of a clause over a whole trace, by its keyword."""
    meanings = {
        "reach": later(formula, 0),
        "keep": throughout(formula),
        "avoid": throughout(negated(formula)),
        "require": formula,
    }
    return lambda trace: meanings[clause](trace, 0)


def prefixed_by(prefix: str, formula: Here) -> Here:
    joined = {
        "c and ": both(c, formula),
        "c or ": either(c, formula),
        "c implies ": either(negated(c), formula),
        "c then ": both(c, later(formula, 1)),
        "not ": negated(formula),
    }
    return joined[prefix] if prefix else formula


# --- the meanings ---------------------------------------------------------------------------------


def of_infix(clause: str, prefix: str, word: str) -> Whole | None:
    """The meaning of `CLAUSE PREFIX a WORD b`."""
    if prefix == "c implies " or (prefix == "c then " and clause != "reach") or _is_open(clause, prefix, word):
        return None
    first = prefix if prefix != "c then " else ""
    left = prefixed_by(first, a)
    if word == "without" and clause in ("reach", "keep"):
        wanted, never = whole(clause, prefixed_by(prefix, a)), whole("avoid", b)
        return lambda trace: wanted(trace) and never(trace)
    goal = _joined(clause, word, left, is_alone=first in ("", "not "), is_negated=first == "not ")
    if goal is None or isinstance(goal, tuple):
        return whole("require", goal[0]) if goal else None
    return whole(clause, prefixed_by("c then ", goal) if prefix == "c then " else goal)


def _is_open(clause: str, prefix: str, word: str) -> bool:
    """Whether the word can belong to several operands, with different meanings."""
    if clause == "require" and word in CONDITIONS[1:]:
        return True
    if prefix == "not ":
        same = {"keep": (*CONDITIONS, "before", "after", "unless"), "require": CONDITIONS}.get(clause, ())
        return word not in (*same, "but", "xor", "xnor")
    if word in CONDITIONS:
        return prefix == ("c or " if clause in ("reach", "avoid") else "c and ")
    joined = {
        "unless": ("c and ", "c then ", *(() if clause in ("reach", "keep") else ("c or ",))),
        "without": ("c and ", "c or ", "c then ") if clause == "reach" else ("c or ",),
        "but": ("c or ",),
    }
    return prefix in (("c and ", "c or ") if word in ORDER else joined.get(word, ()))


def _joined(clause: str, word: str, left: Here, *, is_alone: bool, is_negated: bool) -> Here | tuple[Here] | None:
    """The meaning of two joined operands in a clause; it is in a tuple if it applies only at the first sample."""
    if word in CONDITIONS:
        return both(left, b) if clause in ("reach", "avoid") else either(left, negated(b))
    if word in ("before", "after", "followed by"):
        return _ordered(clause, word, left, is_negated=is_negated)
    if word == "unless":
        by_clause = {"reach": either(left, b), "keep": either(left, b), "avoid": both(left, negated(b))}
        return by_clause.get(clause, until(left, b))
    if word in ("xor", "xnor", "nor", "nand") and not is_alone:
        return None
    different = both(either(left, b), negated(both(left, b)))
    by_word = {"without": both(left, negated(b)), "but": both(left, b), "xor": different, "xnor": negated(different)}
    return {**by_word, "nor": negated(either(left, b)), "nand": negated(both(left, b))}[word]


def _ordered(clause: str, word: str, left: Here, *, is_negated: bool) -> Here | tuple[Here] | None:
    if word == "before" and clause in ("keep", "avoid"):
        return (until(left if clause == "keep" else negated(left), b),)
    if word == "after" and clause in ("keep", "avoid"):
        wanted = left if clause == "keep" else negated(left)
        return (throughout(either(negated(b), throughout(wanted))),)
    if word == "followed by" and clause == "keep":
        return either(negated(left), later(b, 1))
    if is_negated:
        return None
    one, other = (b, left) if word == "after" else (left, b)
    order = both(one, later(other, 1))
    return later(order, 0) if clause == "require" else order


def of_time(clause: str, prefix: str, word: str) -> Whole | None:
    """The meaning of `CLAUSE PREFIX a WORD TIME`."""
    if prefix == "c then ":
        return _next_goal(word) if clause == "reach" else None
    if clause == "reach" and prefix == "c implies ":
        return None
    has_form = clause in ("reach", "avoid") or (clause == "keep" and word in ("for", "after"))
    if has_form:
        return whole("require", _timed(clause, word, prefixed_by(prefix, a))) if prefix != "c implies " else None
    if prefix == "c implies ":
        return whole(clause, prefixed_by(prefix, _timed("", word, a)))
    return whole(clause, _timed("", word, a)) if clause == "require" and not prefix else None


def _timed(clause: str, word: str, formula: Here) -> Here:
    """The meaning of a time in a clause, at the first sample; without a clause, at the current sample."""
    wanted = negated(formula) if clause == "avoid" else formula
    if word == "for":
        return later(stays(formula), 0) if clause == "reach" else throughout(wanted, 0, STEPS - 1)
    if word == "after":
        if clause in ("keep", "avoid"):
            return throughout(wanted, STEPS)
        return later(wanted, STEPS, None if clause == "reach" else STEPS)
    return throughout(wanted, 0, STEPS) if clause == "avoid" else later(wanted, 0, STEPS)


def _next_goal(word: str) -> Whole:
    """The meaning of a time after `then`: it starts at the step after the previous goal."""
    if word == "for":
        return whole("reach", both(c, later(stays(a), 1)))
    return whole("reach", both(c, later(a, STEPS) if word == "after" else later(a, 1, STEPS)))


def before_clause(clause: str, prefix: str, word: str) -> Whole | None:
    """The meaning of `CLAUSE PREFIX WORD b, a`."""
    allowed = {"reach": ("", "c and ", "c or ", "c then "), "avoid": ("", "c and ", "c or ")}
    if prefix not in allowed.get(clause, ("", "c and ", "c or ", "c implies ")):
        return None
    if clause == "require" and word != "if":
        return None
    condition = both(a, b) if clause in ("reach", "avoid") else either(a, negated(b))
    return whole(clause, prefixed_by(prefix, condition))


def before_time(clause: str, prefix: str, word: str) -> Whole | None:
    """The meaning of `CLAUSE PREFIX WORD TIME a`."""
    if not prefix or prefix == "c then ":
        return of_time(clause, prefix, word)
    if prefix == "c implies " and (clause == "require" or (clause == "keep" and word != "after")):
        return whole(clause, prefixed_by(prefix, _timed("", word, a)))
    return None


CASES = {
    **{f"{k} {p}a {w} b": of_infix(k, p, w) for k in CLAUSES for p in PREFIXES for w in INFIX},
    **{f"{k} {p}a {w} {TIME}": of_time(k, p, w) for k in CLAUSES for p in PREFIXES for w in TIMES},
    **{f"{k} {p}{w} b, a": before_clause(k, p, w) for k in CLAUSES for p in PREFIXES for w in CONDITIONS[:-1]},
    **{f"{k} {p}{w} {TIME} a": before_time(k, p, w) for k in CLAUSES for p in PREFIXES for w in TIMES},
    # Sentences that brackets, a negation or another goal make ambiguous, and some that stay clear.
    "reach (a if b)": None,
    "avoid (a if b)": None,
    "avoid (a unless b)": None,
    "keep (a before b)": None,
    "keep (a after 2 steps)": None,
    "reach (a within 2 steps)": None,
    "reach (a for 2 steps)": None,
    "reach c then (a within 2 steps)": None,
    "reach a within 2 steps then b": None,
    "reach within 2 steps a then b": None,
    "reach a without b then c": None,
    "reach a without b and c": None,
    "reach c then a after 0 steps": None,
    "require a then b before c": None,
    "require a implies b before c": None,
    "require a until b within 2 steps": None,
    "require eventually a within 2 steps": None,
    "keep a while b implies c": None,
    "keep (a implies b within 2 steps)": whole("keep", either(negated(a), later(b, 0, 2))),
    "require not (a within 2 steps)": whole("require", negated(later(a, 0, 2))),
    "require (a before b) and c": whole("require", both(later(both(a, later(b, 1)), 0), c)),
    "require always (a implies b within 2 steps)": whole("keep", either(negated(a), later(b, 0, 2))),
    "reach a then b within 1 step": whole("reach", both(a, later(b, 1, 1))),
    "reach a for 1 step": whole("reach", a),
    "reach if a then b then c": whole("reach", both(both(a, b), later(c, 1))),
    "reach a before b then c": whole("reach", both(a, later(both(b, later(c, 1)), 1))),
    "reach a and b within 2 steps": whole("require", later(both(a, b), 0, 2)),
}
"""The meaning of each sentence, or None if it is unclear."""


# --- the helps ------------------------------------------------------------------------------------


def fixed_text(clause: str) -> str | None:
    """Return the spec with the edit that the help for the clause offers, or None if it offers no edit."""
    text = f"spec s {{ {clause}\n}}\n"
    source = SourceFile("a.tltl", text)
    fixes = [fix for diagnostic in parse(source)[1] for fix in diagnostic.fixes]
    return after(source, fixes[0].edits).text if fixes else None


def compiled(text: str) -> Fspa:
    (fspa,) = tltlc.compile_text(f"signal a: bool\nsignal b: bool\nsignal c: bool\n{text}")
    return fspa


def verdicts(fspa: Fspa) -> Iterator[tuple[Trace, bool]]:
    """Yield every trace of up to ``LONGEST`` samples, and whether the automaton accepts it."""
    edges, values_of = tables(fspa).edges, {letter: values(fspa, letter) for letter in LETTERS}
    following = {
        (state.id, letter): next(edge.target for edge in edges[state.id] if holds(edge.guard, values_of[letter]))
        for state in fspa.states
        for letter in LETTERS
    }
    reached: list[tuple[Trace, int]] = [((), 0)]
    for _ in range(LONGEST):
        reached = [((*trace, letter), following[state, letter]) for trace, state in reached for letter in LETTERS]
        yield from ((trace, fspa.states[state].accepting) for trace, state in reached)


@pytest.mark.parametrize(("clause", "meaning"), CASES.items(), ids=CASES)
def test_an_edit_has_the_meaning_of_the_sentence(clause: str, meaning: Whole | None) -> None:
    text = fixed_text(clause)
    if text is None:
        return
    assert meaning is not None, text
    assert set(re.findall(r"\b[abc]\b", clause)) <= set(re.findall(r"\b[abc]\b", text))
    wrong = [trace for trace, accepted in verdicts(compiled(text)) if accepted != meaning(trace)]
    assert not wrong, f"{text}: {[sorted(letter) for letter in wrong[0]]}"


def test_most_clear_sentences_get_an_edit() -> None:
    clear = [clause for clause, meaning in CASES.items() if meaning]
    helped = [clause for clause in clear if fixed_text(clause)]
    assert len(helped) >= 0.9 * len(clear), sorted(set(clear) - set(helped))


def test_all_words_of_the_compiler_are_tested() -> None:
    assert {word.split()[0] for word in INFIX} == set(english._FORMS)
    assert set(TIMES) == set(english._TIMES)
    assert set(CONDITIONS[:-1]) == set(english._PREFIXES)


@pytest.mark.parametrize("clause", [clause for clause, meaning in CASES.items() if meaning is None])
def test_a_sentence_without_an_edit_gets_a_help(clause: str) -> None:
    diagnostics = parse(SourceFile("a.tltl", f"spec s {{ {clause}\n}}\n"))[1]
    assert diagnostics
    assert all(diagnostic.help for diagnostic in diagnostics)
