"""Say in words how numbers compare with values of the trace so far: "coins >= the previous coins"."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from tltlc.core.names import ComparisonName, SpokenName, split_name
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Atom, Register

_COMPARED: Final = {
    ">": "more than",
    "<": "less than",
    ">=": "at least",
    "<=": "at most",
    "==": "exactly",
    "!=": "not exactly",
}
_TIMES: Final = {"1": "once", "2": "twice"}
_MIRRORED: Final = {">": "<", "<": ">", ">=": "<=", "<=": ">=", "==": "==", "!=": "!="}
VALUES: Final = {
    "previous": "the previous {0}",
    "initial": "the initial {0}",
    "highest": "the highest {0} so far",
    "lowest": "the lowest {0} so far",
    "highest_since": "the highest {0} since {1}",
    "lowest_since": "the lowest {0} since {1}",
    "value_at": "the {0} when {1}",
}
"""What is said of a register, by its kind; 0 stands for the value that it remembers, and 1 for when."""


class Phrase(NamedTuple):
    """What is said where an atom holds, and where it does not; None if that is said with `not`."""

    holds: str
    fails: str | None = None


def value_phrase(name: str, register: Register, event: str) -> Phrase | None:
    """Return the phrase of a comparison with ``previous(x)``, ``initial(x)``, ``highest(x)``, ``value_at(x, q)``, ….

    ``event`` says when q last held; it is empty for the other functions.
    """
    if not isinstance(name, ComparisonName) or name.operator not in _MIRRORED:
        return None
    words = value_words(register, event)
    if name.left == register.name and not _is_number(name.right):
        left, operator, right = name.right, _MIRRORED[name.operator], words
    elif name.left == register.name:
        left, operator, right = words, name.operator, name.right
    elif name.right == register.name:
        left, operator, right = name.left, name.operator, words
    else:
        return None
    comparison = ComparisonName(left, operator, right)
    return Phrase(comparison, comparison.opposite)


def was_phrase(state: Formula, atoms: Mapping[str, Atom]) -> Phrase | None:
    """Return "mode was alert at the step before" for a test of an enum or its negation; None for other formulas.

    ``atoms`` are the atoms of the automaton, by name.
    """
    test = state.args[0] if state.op == "not" else state
    name = atoms[test.name].base if test.name in atoms else ""
    if not isinstance(name, ComparisonName) or name.operator != "is":
        return None
    was, was_not = (SpokenName(f"{name.left} {verb} {name.right} at the step before") for verb in ("was", "was not"))
    return Phrase(was, was_not) if test is state else Phrase(was_not, was)


def value_words(register: Register, event: str) -> str:
    """Return what a register whose kind is in ``VALUES`` remembers: "the previous coins".

    ``event`` says when it was taken: "dash last began"; it is empty if the kind says so.
    """
    arguments = split_name(register.name)[1]
    if register.kind == "previous" and arguments[1:]:
        return f"the {arguments[0]} {arguments[1]} before"
    if register.kind in ("highest", "lowest") and arguments[1:]:
        return f"the {register.kind} {arguments[0]} in the last {arguments[1]}"
    value = ", ".join(arguments[:-1] if event else arguments)
    return VALUES[register.kind].format(value, event)


def count_text(words: str, operator: str, number: str, when: str = "") -> str:
    """Return a comparison of ``times(p)`` with a number in words.

    ``words`` are p, and ``when`` says from which step on it counts, e.g. "since alarm"; it is empty for all steps.
    """
    return " ".join(filter(None, (_count_text(words, operator, number, "" if when else " so far"), when)))


def window_text(register: Register) -> str:
    """Return when a register of ``times_within(p, T)`` counts: "in the last 5 s"."""
    return f"in the last {split_name(register.name)[1][-1]}"


def is_of_window(register: Register) -> bool:
    """Whether a register is the time of a condition in the last seconds."""
    return split_name(register.name)[0] == "total_time_within"


def _count_text(words: str, operator: str, number: str, so_far: str) -> str:
    if (operator, number) in ((">", "0"), (">=", "1")):
        return f"{words} at least once"
    if (operator, number) in (("<=", "0"), ("<", "1"), ("==", "0")):
        return f"{words} 0 times{so_far}"
    return f"{words} {_COMPARED[operator]} {_TIMES.get(number, f'{number} times')}"


def time_text(words: str, register: Register, operator: str, number: str) -> str:
    """Return a comparison of ``time_since(p)``, ``time_holding(p)`` or ``total_time(p)`` with a number in words.

    ``words`` are p.
    """
    length = f"{_COMPARED[operator]} {number} s"
    if register.kind in ("total_time", "total_time_since"):
        return f"{words} for {length} in all"
    return f"{length} after {words}" if register.kind == "time_since" else f"{words} for {length}"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
