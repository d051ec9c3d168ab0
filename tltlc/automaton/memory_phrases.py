"""Say in words what atoms remember: ``times(seen) > 3`` is "seen more than 3 times".

The words are chosen by the kind of the register that an atom reads, not by the name of the atom. An
atom without words of its own, such as ``once seen``, keeps its name.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple, cast

from tltlc.automaton.fspa import Fspa
from tltlc.core.names import ComparisonName
from tltlc.expression.tree import (
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    Op,
    ParamValue,
    SignalValue,
    When,
    nodes,
)
from tltlc.logic.formula import Formula, and_, atom, eventually, not_, or_, rebuild
from tltlc.logic.text.phrases import is_state, object_phrase
from tltlc.resolve.spec import Atom, Register, RegisterKind

_COMPARED: Final = {
    ">": "more than",
    "<": "less than",
    ">=": "at least",
    "<=": "at most",
    "==": "exactly",
    "!=": "not exactly",
}
_TIMES: Final = {"1": "once", "2": "twice"}
_TIMERS: Final[Mapping[RegisterKind, Mapping[str, tuple[str, str]]]] = {
    "waiting": {"late": ("{2} later than {0} after {1}", "{2} within {0} after {1}")},
    "due": {"due": ("{1} is due after {0}", "{1} is not due after {0}")},
    "breach": {"breach": ("not {2} for {0} after {1}", "{2} for {0} after {1}")},
    "samples": {
        "passed": ("{0} have passed", "less than {0} have passed"),
        "lasted": ("{0} are over", "less than {0} have passed"),
        "over": ("more than {0} have passed", "at most {0} have passed"),
    },
    "elapsed": {
        "lasted": ("{0} are over", "less than {0} have passed"),
        "over": ("more than {0} have passed", "at most {0} have passed"),
    },
    "time_since": {
        "lately": ("{1} in the last {0}", "no {1} in the last {0}"),
        "passed": ("{0} have passed since {1}", "less than {0} have passed since {1}"),
    },
    "age": {"recent": ("{1} in the {0} before", "no {1} in the {0} before")},
    "time_holding": {"held": ("{1} for {0}", "{1} for less than {0}")},
    "run": {"held": ("{1} for {0}", "{1} for less than {0}")},
}
"""What is said of the timers that :mod:`tltlc.resolve.timers` makes: where they hold, and where they do not.

The keys are the kind of the register that a timer reads, and the base of its name. The numbers stand
for the arguments of the atom.
"""
_ALWAYS: Final[Mapping[str, tuple[str, str]]] = {
    "late": ("no {1} for more than {0}", "{1} again within {0}"),
    "due": ("{0} is due", "{0} is not due"),
}
"""The same for an answer that is due at all times, which has no event before it."""
_FOLLOWED: Final = ("passed", "lasted", "over", "recent", "lately")
"""The base names of the timers that say until when something must happen or last, without words of their own then."""
_FOLLOWING: Final = ("samples", "elapsed", "time_since", "age")
"""The kinds of the registers that these timers read."""


class Phrase(NamedTuple):
    """What is said where an atom holds, and where it does not; None if that is said with `not`."""

    holds: str
    fails: str | None = None


def spoken(formula: Formula, fspa: Fspa) -> Formula:
    """Return the formula for people, with phrases in place of the names of atoms.

    No automaton has atoms with such names, so the result is only good for printing.
    """
    if not fspa.registers:
        return formula
    phrases, before, passed = _phrases(fspa), _previous_atoms(fspa), _passed(fspa)
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        done[node] = (
            _turning(node, before, done)
            or _in_time(node, passed, done)
            or _literal(node, phrases)
            or rebuild(node, tuple(done[argument] for argument in node.args))
        )
    return done[formula]


def _literal(node: Formula, phrases: Mapping[str, Phrase]) -> Formula | None:
    if node.op == "atom" and node.name in phrases:
        return atom(phrases[node.name].holds)
    if node.op == "not" and node.args[0].op == "atom":
        fails = phrases[node.args[0].name].fails if node.args[0].name in phrases else None
        return None if fails is None else atom(fails)
    return None


def _turning(node: Formula, before: Mapping[str, str], done: Mapping[Formula, Formula]) -> Formula | None:
    """Return ``seen & !previously seen & x`` as "seen begins" and x, and the reverse as "seen ends"; else None."""
    if node.op != "and":
        return None
    parts = list(node.args)
    found: list[Formula] = []
    for name, operand in before.items():
        for word, pair in (
            ("begins", (atom(operand), not_(atom(name)))),
            ("ends", (not_(atom(operand)), atom(name))),
        ):
            if all(part in parts for part in pair):
                parts = [part for part in parts if part not in pair]
                found.append(atom(f"{operand} {word}"))
    if not found:
        return None
    rest = [done[part] for part in parts]
    return found[0] if len(found) + len(rest) == 1 else rebuild(node, (*found, *rest))


def _in_time(node: Formula, passed: Mapping[str, str], done: Mapping[Formula, Formula]) -> Formula | None:
    """Return ``!passed(5 s, a) U b`` as ``F`` of "b within 5 s after a", and ``lasted(5 s) R b`` as one atom.

    So are ``recent(5 s, a) U (recent(5 s, a) & b)`` and ``lasted(5 s) R (lasted(5 s) | b)``. Return None
    for any other formula. ``passed`` has the times of the atoms of these kinds.
    """
    if node.op not in ("U", "R"):
        return None
    timer, goal = node.args
    if node.op == "U":
        if (timer.args[0] if timer.op == "not" else timer).name not in passed:
            return None
        parts = tuple(part for part in (goal.args if goal.op == "and" else (goal,)) if part is not timer)
        present = [part for part in parts if is_state(part)]
        if not present:
            return None
        text = object_phrase(and_(*(done[part] for part in present)))
        said = atom(f"{text} within {passed[(timer.args[0] if timer.op == 'not' else timer).name]}")
        return eventually(and_(said, *(done[part] for part in parts if part not in present)))
    kept = [part for part in (goal.args if goal.op == "or" else (goal,)) if part is not timer]
    if timer.name not in passed or not all(map(is_state, kept)):
        return None
    return atom(f"{object_phrase(or_(*(done[part] for part in kept)))} for {passed[timer.name]}")


def _passed(fspa: Fspa) -> dict[str, str]:
    """Return the time of each atom that says that a time has passed, such as "5 s after a"."""
    kinds = {register.name: register.kind for register in fspa.registers}
    return {
        each.name: " after ".join(each.arguments)
        for each in fspa.atoms
        if each.base in _FOLLOWED and each.arguments
        if any(kinds.get(name) in _FOLLOWING for name in _read(each.expression))
    }


# --- phrases ----------------------------------------------------------------------------------------


def _phrases(fspa: Fspa) -> dict[str, Phrase]:
    registers = {register.name: register for register in fspa.registers}
    phrases: dict[str, Phrase] = {}
    for each in fspa.atoms:
        read = [registers[name] for name in _read(each.expression) if name in registers]
        phrase = _phrase(each, read[0], fspa.clock_s) if len(read) == 1 else None
        if phrase is not None:
            phrases[each.name] = phrase
    return phrases


def _read(expression: Expression) -> set[str]:
    return {node.name for node in nodes(expression) if isinstance(node, (SignalValue, ParamValue))}


def _phrase(each: Atom, register: Register, clock_s: float | None) -> Phrase | None:
    """Return the phrase of an atom that reads one register, and nothing else; None if it has none."""
    timer = _TIMERS.get(register.kind, {}).get(each.base)
    if register.kind == "breach" and len(each.arguments) == 2:
        return Phrase(
            "not {1} in the first {0}".format(*each.arguments), "{1} for the first {0}".format(*each.arguments)
        )
    if timer is not None and each.arguments:
        missing = register.kind in ("waiting", "due") and len(each.arguments) < 2 + (each.base == "late")
        return Phrase(*(text.format(*each.arguments) for text in (_ALWAYS[each.base] if missing else timer)))
    operand = _operand(register)
    if operand is None or len(_read(each.expression)) > 1:
        return None
    name, holds = operand
    if isinstance(each.base, ComparisonName):
        if each.base.left != register.name or not holds:
            return None
        sentence = _count if register.kind == "times" else _time
        return Phrase(
            sentence(register, name, each.base.operator, each.base.right),
            sentence(register, name, each.base.opposite_operator, each.base.right),
        )
    border = _border(each.expression)
    if register.kind != "time_since" or border is None:
        return None
    # `once within n steps` has its border at n + 1/2 steps, `historically for n steps` at n - 1/2.
    steps = border - 0.5 if holds else border + 0.5
    time = f"{steps:g} steps" if clock_s is None else f"{round(steps * clock_s, 6):g} s"
    if register.unit == "s":
        time = f"{border:g} s"
    return Phrase(f"{name} in the last {time}" if holds else f"{name} for the last {time}")


def _count(_: Register, name: str, operator: str, number: str) -> str:
    return f"{name} {_COMPARED[operator]} {_TIMES.get(number, f'{number} times')}"


def _time(register: Register, name: str, operator: str, number: str) -> str:
    length = f"{_COMPARED[operator]} {number} s"
    return f"{length} after {name}" if register.kind == "time_since" else f"{name} for {length}"


def _operand(register: Register) -> tuple[str, bool] | None:
    """Return the atom that a count or time is about, and whether it is about the atom, not its negation.

    Return None for other registers, and for a count or time of a larger formula.
    """
    if register.kind not in ("times", "time_since", "time_holding"):
        return None
    update = register.update.args[0] if isinstance(register.update, Op) else register.update
    if not isinstance(update, When):
        return None
    condition = update.cases[0][0]
    if register.kind != "time_since":
        # The second part is about the sample before.
        (first, _) = condition.args
        condition = first if isinstance(first, Condition) else condition
    holds = condition.op != "not"
    inner = condition if holds else condition.args[0]
    if isinstance(inner, Condition) and inner.op == ">" and isinstance(inner.args[0], AtomValue):
        return inner.args[0].name, holds
    return None


def _border(expression: Expression) -> float | None:
    """Return the number of steps or seconds by which the margin of a window is divided; None for other expressions."""
    if isinstance(expression, When):
        # The margin of a window in seconds is negated, so that its border belongs to it.
        (margin, _) = expression.cases[0][0].args
        expression = cast("Expression", margin)
    is_scaled = isinstance(expression, Op) and expression.op == "/" and isinstance(expression.args[1], Const)
    return expression.args[1].value if is_scaled else None  # type: ignore[union-attr]


def _previous_atoms(fspa: Fspa) -> dict[str, str]:
    """Map the names of atoms ``previously p`` to p, where p is an atom."""
    updates = {register.name: register.update for register in fspa.registers}
    names: dict[str, str] = {}
    for register in fspa.registers:
        if register.kind == "previously" and isinstance(register.update, Before):
            kept = updates[register.update.name]
            if isinstance(kept, AtomValue):
                names[register.name] = kept.name
    return {
        each.name: names[read.name]
        for each in fspa.atoms
        if isinstance(read := each.expression, SignalValue) and read.name in names
    }
