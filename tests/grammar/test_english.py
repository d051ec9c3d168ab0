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
from tltlc.grammar.mistakes import english_forms
from tltlc.grammar.parser import parse
from tltlc.monitor.guards import holds
from tltlc.monitor.tables import tables
from tltlc.tools.lint.scopes import apply_edits
from tltlc.tools.witness.blocks import letter_values

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


def both(left: Here, right: Here) -> Here:
    return lambda trace, at: left(trace, at) and right(trace, at)


def either(left: Here, right: Here) -> Here:
    return lambda trace, at: left(trace, at) or right(trace, at)


def negation(formula: Here) -> Here:
    return lambda trace, at: not formula(trace, at)


def at_some_step(formula: Here, first: int, last: int | None = None) -> Here:
    """The formula holds at some sample from ``first`` to ``last`` steps ahead."""
    return lambda trace, at: any(
        formula(trace, there) for there in range(at + first, len(trace)) if last is None or there <= at + last
    )


def at_every_step(formula: Here, first: int = 0, last: int | None = None) -> Here:
    """The formula holds at all samples from ``first`` to ``last`` steps ahead, up to the end of the trace."""
    return negation(at_some_step(negation(formula), first, last))


def holds_for_steps(formula: Here) -> Here:
    """The formula holds at ``STEPS`` samples in a row, and the trace has all of them."""
    return lambda trace, at: at + STEPS <= len(trace) and all(formula(trace, at + step) for step in range(STEPS))


def until(left: Here, right: Here) -> Here:
    """``left`` holds at each sample before the first one with ``right``, which need not exist (weak until)."""
    return lambda trace, at: all(
        left(trace, there) for there in range(at, len(trace)) if not at_some_step(right, 0, there - at)(trace, at)
    )


def clause_meaning(clause: str, formula: Here) -> Whole:
    """The meaning of a clause over a whole trace, by its keyword."""
    meanings = {
        "reach": at_some_step(formula, 0),
        "keep": at_every_step(formula),
        "avoid": at_every_step(negation(formula)),
        "require": formula,
    }
    return lambda trace: meanings[clause](trace, 0)


def with_prefix(prefix: str, formula: Here) -> Here:
    joined = {
        "c and ": both(c, formula),
        "c or ": either(c, formula),
        "c implies ": either(negation(c), formula),
        "c then ": both(c, at_some_step(formula, 1)),
        "not ": negation(formula),
    }
    return joined[prefix] if prefix else formula


# --- the meanings ---------------------------------------------------------------------------------


def infix_meaning(clause: str, prefix: str, word: str) -> Whole | None:
    """The meaning of `CLAUSE PREFIX a WORD b`."""
    if prefix == "c implies " or (prefix == "c then " and clause != "reach") or _is_open(clause, prefix, word):
        return None
    first = prefix if prefix != "c then " else ""
    left = with_prefix(first, a)
    if word == "without" and clause in ("reach", "keep"):
        wanted, never = clause_meaning(clause, with_prefix(prefix, a)), clause_meaning("avoid", b)
        return lambda trace: wanted(trace) and never(trace)
    goal = _joined_meaning(clause, word, left, is_alone=first in ("", "not "), is_negated=first == "not ")
    if goal is None or isinstance(goal, tuple):
        return clause_meaning("require", goal[0]) if goal else None
    return clause_meaning(clause, with_prefix("c then ", goal) if prefix == "c then " else goal)


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


def _joined_meaning(
    clause: str, word: str, left: Here, *, is_alone: bool, is_negated: bool
) -> Here | tuple[Here] | None:
    """The meaning of two joined operands in a clause; it is in a tuple if it applies only at the first sample."""
    if word in CONDITIONS:
        return both(left, b) if clause in ("reach", "avoid") else either(left, negation(b))
    if word in ("before", "after", "followed by"):
        return _order_meaning(clause, word, left, is_negated=is_negated)
    if word == "unless":
        by_clause = {"reach": either(left, b), "keep": either(left, b), "avoid": both(left, negation(b))}
        return by_clause.get(clause, until(left, b))
    if word in ("xor", "xnor", "nor", "nand") and not is_alone:
        return None
    different = both(either(left, b), negation(both(left, b)))
    by_word = {"without": both(left, negation(b)), "but": both(left, b), "xor": different, "xnor": negation(different)}
    return {**by_word, "nor": negation(either(left, b)), "nand": negation(both(left, b))}[word]


def _order_meaning(clause: str, word: str, left: Here, *, is_negated: bool) -> Here | tuple[Here] | None:
    if word == "before" and clause == "keep" and not is_negated:
        return None
    if word == "before" and clause in ("keep", "avoid"):
        return (until(left if clause == "keep" else negation(left), b),)
    if word == "after" and clause in ("keep", "avoid"):
        wanted = left if clause == "keep" else negation(left)
        return (at_every_step(either(negation(b), at_every_step(wanted))),)
    if word == "followed by" and clause == "keep":
        return either(negation(left), at_some_step(b, 1))
    if is_negated or (word == "before" and clause == "reach"):
        return None
    first, second = (b, left) if word == "after" else (left, b)
    order = both(first, at_some_step(second, 1))
    return at_some_step(order, 0) if clause == "require" else order


def time_meaning(clause: str, prefix: str, word: str) -> Whole | None:
    """The meaning of `CLAUSE PREFIX a WORD TIME`."""
    if prefix == "c then ":
        in_order = both(c, at_some_step(a, 1, STEPS))
        if clause in ("avoid", "require") and word in ("within", "in"):
            return clause_meaning("reach" if clause == "require" else clause, in_order)
        # A time behind the second goal may count from any step with c, or from where c begins.
        return _next_goal_meaning(word) if clause == "reach" and word in ("for", "after") else None
    if clause == "avoid" and word == "for":
        # It may be about the first steps, or about steps on end.
        return None
    if clause == "reach" and prefix == "c implies ":
        return None
    if clause == "avoid" and prefix == "c and " and word in ("within", "in"):
        # The time may be that between the two.
        return None
    if clause == "keep" and word == "for" and prefix == "c implies ":
        # The time counts from the step of c on.
        return clause_meaning(clause, with_prefix(prefix, at_every_step(a, 0, STEPS - 1)))
    if clause == "keep" and word == "for":
        # It may be about the first steps, or about some steps on end.
        return None
    has_form = clause in ("reach", "avoid") or (clause == "keep" and word == "after")
    if has_form:
        return (
            clause_meaning("require", _time_in_clause(clause, word, with_prefix(prefix, a)))
            if prefix != "c implies "
            else None
        )
    if prefix == "c implies ":
        return clause_meaning(clause, with_prefix(prefix, _time_in_clause("", word, a)))
    return clause_meaning(clause, _time_in_clause("", word, a)) if clause == "require" and not prefix else None


def _time_in_clause(clause: str, word: str, formula: Here) -> Here:
    """The meaning of a time in a clause, at the first sample; without a clause, at the current sample."""
    wanted = negation(formula) if clause == "avoid" else formula
    if word == "for":
        return at_some_step(holds_for_steps(formula), 0) if clause == "reach" else at_every_step(wanted, 0, STEPS - 1)
    if word == "after":
        if clause in ("keep", "avoid"):
            return at_every_step(wanted, STEPS)
        return at_some_step(wanted, STEPS, None if clause == "reach" else STEPS)
    return at_every_step(wanted, 0, STEPS) if clause == "avoid" else at_some_step(wanted, 0, STEPS)


def _next_goal_meaning(word: str) -> Whole:
    """The meaning of a time after `then`: it starts at the step after the previous goal."""
    if word == "for":
        return clause_meaning("reach", both(c, at_some_step(holds_for_steps(a), 1)))
    return clause_meaning("reach", both(c, at_some_step(a, STEPS) if word == "after" else at_some_step(a, 1, STEPS)))


def prefix_meaning(clause: str, prefix: str, word: str) -> Whole | None:
    """The meaning of `CLAUSE PREFIX WORD b, a`."""
    allowed = {"reach": ("", "c and ", "c or ", "c then "), "avoid": ("", "c and ", "c or ")}
    if prefix not in allowed.get(clause, ("", "c and ", "c or ", "c implies ")):
        return None
    if clause == "require" and word != "if":
        return None
    condition = both(a, b) if clause in ("reach", "avoid") else either(a, negation(b))
    return clause_meaning(clause, with_prefix(prefix, condition))


def prefix_time_meaning(clause: str, prefix: str, word: str) -> Whole | None:
    """The meaning of `CLAUSE PREFIX WORD TIME a`."""
    if prefix == "c then " and clause == "reach":
        return _next_goal_meaning(word)
    if not prefix:
        return time_meaning(clause, prefix, word)
    if prefix == "c implies " and (clause == "require" or (clause == "keep" and word != "after")):
        return clause_meaning(clause, with_prefix(prefix, _time_in_clause("", word, a)))
    return None


CASES = {
    **{f"{k} {p}a {w} b": infix_meaning(k, p, w) for k in CLAUSES for p in PREFIXES for w in INFIX},
    **{f"{k} {p}a {w} {TIME}": time_meaning(k, p, w) for k in CLAUSES for p in PREFIXES for w in TIMES},
    **{f"{k} {p}{w} b, a": prefix_meaning(k, p, w) for k in CLAUSES for p in PREFIXES for w in CONDITIONS[:-1]},
    **{
        f"{k} {p}{w} {TIME} a": prefix_time_meaning(k, p, w)
        for k in CLAUSES
        for p in PREFIXES
        for w in TIMES
        if (p, w) != ("c then ", "within")  # `c then within 2 steps a` is no mistake.
    },
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
    "avoid within 2 steps a and b": None,
    "reach (a then b) within 2 steps": None,
    "reach (not a until b) within 2 steps": None,
    "reach not a until b within 2 steps": None,
    "require a then b before c": None,
    "require a implies b before c": None,
    "require a until b within 2 steps": None,
    "require eventually a within 2 steps": None,
    "keep a while b implies c": None,
    "keep (a implies b within 2 steps)": clause_meaning("keep", either(negation(a), at_some_step(b, 0, 2))),
    "require not (a within 2 steps)": clause_meaning("require", negation(at_some_step(a, 0, 2))),
    "require (a before b) and c": clause_meaning("require", both(at_some_step(both(a, at_some_step(b, 1)), 0), c)),
    "require always (a implies b within 2 steps)": clause_meaning("keep", either(negation(a), at_some_step(b, 0, 2))),
    "reach a then b within 1 step": clause_meaning("reach", both(a, at_some_step(b, 1, 1))),
    "reach a for 1 step": clause_meaning("reach", a),
    "reach if a then b then c": clause_meaning("reach", both(both(a, b), at_some_step(c, 1))),
    "reach a before b then c": clause_meaning("reach", both(a, at_some_step(both(b, at_some_step(c, 1)), 1))),
    "reach a and b within 2 steps": clause_meaning("require", at_some_step(both(a, b), 0, 2)),
}
"""The meaning of each sentence, or None if it is unclear."""


# --- the helps ------------------------------------------------------------------------------------


def fixed_text(clause: str) -> str | None:
    """Return the spec with the edit that the help for the clause offers, or None if it offers no edit."""
    text = f"spec s {{ {clause}\n}}\n"
    source = SourceFile("a.tltl", text)
    fixes = [fix for diagnostic in parse(source)[1] for fix in diagnostic.fixes]
    return apply_edits(source, fixes[0].edits).text if fixes else None


def compile_spec(text: str) -> Fspa:
    (fspa,) = tltlc.compile_text(f"signal a: bool\nsignal b: bool\nsignal c: bool\n{text}")
    return fspa


def verdicts(fspa: Fspa, atoms: str = ATOMS) -> Iterator[tuple[Trace, bool]]:
    """Yield every trace of up to ``LONGEST`` samples of ``atoms``, and whether the automaton accepts it."""
    letters = [letter for letter in LETTERS if letter <= set(atoms)]
    edges, values_of = tables(fspa).edges, {letter: letter_values(fspa, letter) for letter in letters}
    following = {
        (state.id, letter): next(edge.target for edge in edges[state.id] if holds(edge.guard, values_of[letter]))
        for state in fspa.states
        for letter in letters
    }
    reached: list[tuple[Trace, int]] = [((), 0)]
    for _ in range(LONGEST):
        reached = [((*trace, letter), following[state, letter]) for trace, state in reached for letter in letters]
        yield from ((trace, fspa.states[state].accepting) for trace, state in reached)


def atoms_of(text: str) -> str:
    """Return the atoms that a text names; the edit and the meaning depend on no others."""
    return "".join(atom for atom in ATOMS if re.search(rf"\b{atom}\b", text))


@pytest.mark.parametrize(("clause", "meaning"), CASES.items(), ids=CASES)
def test_an_edit_has_the_meaning_of_the_sentence(clause: str, meaning: Whole | None) -> None:
    text = fixed_text(clause)
    if text is None:
        return
    assert meaning is not None, text
    assert set(atoms_of(clause)) <= set(atoms_of(text))
    wrong = [trace for trace, accepted in verdicts(compile_spec(text), atoms_of(text)) if accepted != meaning(trace)]
    assert not wrong, f"{text}: {[sorted(letter) for letter in wrong[0]]}"


def test_most_clear_sentences_get_an_edit() -> None:
    clear = [clause for clause, meaning in CASES.items() if meaning]
    helped = [clause for clause in clear if fixed_text(clause)]
    assert len(helped) >= 0.9 * len(clear), sorted(set(clear) - set(helped))


def test_all_words_of_the_compiler_are_tested() -> None:
    assert {word.split()[0] for word in INFIX} == set(english_forms.FORMS)
    assert set(TIMES) == set(english_forms.TIMES)
    assert set(CONDITIONS[:-1]) == set(english_forms.PREFIXES)


@pytest.mark.parametrize("clause", [clause for clause, meaning in CASES.items() if meaning is None])
def test_a_sentence_without_an_edit_gets_a_help(clause: str) -> None:
    diagnostics = parse(SourceFile("a.tltl", f"spec s {{ {clause}\n}}\n"))[1]
    assert diagnostics
    assert all(diagnostic.help for diagnostic in diagnostics)
