"""Formulas without temporal operators as phrases of an English sentence."""

from __future__ import annotations

from typing import Final

from tltlc.core.names import ComparisonName, SpokenName
from tltlc.logic.formula import Formula, atom, rebuild
from tltlc.logic.text.notation import Spelling, write

_PHRASE: Final = Spelling(
    {"not": "not "},
    {"and": " and ", "or": " or ", "implies": " implies ", "iff": " exactly when "},
    {"true": "true", "false": "false"},
    space_before_bracket=True,
    brackets_between_infix=True,
    brackets_around_comparisons=False,
)


def phrase(state: Formula) -> str:
    """Return the formula in words: ``near(exit) and not seen``.

    The negation of ``fuel > 5`` is written ``fuel <= 5``, and ``previous(fuel) > fuel`` is ``fuel < previous(fuel)``.
    """
    return write(with_opposites(state, signals_first=True), _PHRASE)


def with_opposites(formula: Formula, *, signals_first: bool = False) -> Formula:
    """Return the formula for people, with ``fuel <= 5`` in place of ``!(fuel > 5)``.

    With ``signals_first``, a signal that is compared with a value of its own stands before it.
    No automaton has atoms with such names, so the result is only good for printing.
    """
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        done[node] = _comparison(node, signals_first) or rebuild(node, tuple(done[argument] for argument in node.args))
    return done[formula]


def _comparison(node: Formula, signals_first: bool) -> Formula | None:
    """Return a comparison or its negation as a comparison, and the negation of a phrase with brackets; else None.

    "not a at the step before" would say as well that a did not hold there.
    """
    name = (node.args[0] if node.op == "not" else node).name
    if isinstance(name, ComparisonName):
        name = name.signal_first if signals_first else name
        return atom(name.opposite if node.op == "not" else name)
    if node.op != "not":
        return None
    return atom(SpokenName(f"not ({name})")) if isinstance(name, SpokenName) and " " in name else None


def bracketed_phrase(state: Formula) -> str:
    """Return the formula as a phrase, in brackets unless it is a literal."""
    return phrase(state) if is_literal(state) else f"({phrase(state)})"


def object_phrase(state: Formula) -> str:
    """Return the formula as the object of a verb, such as ``a and not b``.

    Literals have no brackets, nor have literals that are all joined by ``and``, or all by ``or``.
    Any other formula is in brackets.
    """
    is_row = state.op in ("and", "or") and all(map(is_literal, state.args))
    return phrase(state) if is_row else bracketed_phrase(state)


def imperative(state: Formula, keep: str, avoid: str) -> str:
    """Return an instruction with one of two verbs: "keep a" for ``a``, and "avoid a" for ``!a``.

    ``keep`` is the verb for formulas without a leading ``not``, ``avoid`` the verb for the others. The negation of
    a comparison of numbers is a comparison: "keep fuel <= 5" for ``!(fuel > 5)``. An atom
    with a :class:`~tltlc.core.names.SpokenName` may have its own verb. "Have" is "have had" if it is about the
    steps so far: "have hidden for 5 s" would ask for the next 5 s.
    """
    if isinstance(state.name, SpokenName) and (state.name.verb or (state.name.is_past and keep == "have")):
        return f"{state.name.verb or 'have had'} {state.name}"
    if state.op != "not":
        return f"{keep} {object_phrase(state)}"
    (avoided,) = state.args
    if isinstance(avoided.name, ComparisonName) and avoided.name.operator in ("<", ">"):
        return f"{keep} {phrase(state)}"
    # "Avoid a and b" would mean to avoid each of them.
    return f"{avoid} {bracketed_phrase(avoided) if avoided.op == 'and' else object_phrase(avoided)}"


def has_time(state: Formula) -> bool:
    """Whether the formula is an atom that says itself when it is about, or the negation of one."""
    return isinstance((state.args[0] if state.op == "not" else state).name, SpokenName)


def says_when(state: Formula) -> bool:
    """Whether a comparison in the formula has a value of another step: "the gems when checkpoint last began"."""
    return any(" when " in part.name for part in state.walk() if part.op == "atom")


def has_verb(state: Formula, verb: str) -> bool:
    """Whether the formula is an atom that asks for something with this verb."""
    return isinstance(state.name, SpokenName) and state.name.verb == verb


def is_state(formula: Formula) -> bool:
    """Whether the formula has no temporal operator."""
    return not any(part.is_temporal for part in formula.walk())


def is_literal(formula: Formula) -> bool:
    """Whether the formula is an atom, a constant, or the negation of an atom or constant."""
    return not formula.args or (formula.op == "not" and not formula.args[0].args)
