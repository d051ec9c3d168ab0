"""Say in words what atoms remember: ``times(seen) > 3`` is "seen more than 3 times".

The words are chosen by the kind of the register that an atom reads, not by the name of the atom. An
atom without words of its own, such as ``once seen``, keeps its name.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

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
from tltlc.logic.formula import Formula, atom, not_, rebuild
from tltlc.resolve.spec import Atom, Register

_COMPARED: Final = {">": "more than", "<": "less than", ">=": "at least", "<=": "at most"}
_TIMES: Final = {"1": "once", "2": "twice"}


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
    phrases, before = _phrases(fspa), _previous_atoms(fspa)
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        done[node] = (
            _turning(node, before, done)
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
            sentence(register, name, ">=" if each.base.operator == "<" else "<=", each.base.right),
        )
    border = _border(each.expression)
    if register.kind != "time_since" or border is None:
        return None
    # `once within n steps` has its border at n + 1/2 steps, `historically for n steps` at n - 1/2.
    steps = border - 0.5 if holds else border + 0.5
    time = f"{steps:g} steps" if clock_s is None else f"{round(steps * clock_s, 6):g} s"
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
    """Return the number of steps by which the margin of a window is divided; None for other expressions."""
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
