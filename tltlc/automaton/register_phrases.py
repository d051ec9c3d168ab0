"""Say in words what registers remember: ``times(seen)`` is "how often seen has begun"."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory_phrases import Speaker
from tltlc.automaton.remembered_formulas import (
    counted,
    counted_since,
    goal_in_time,
    past_operands,
    remembered,
    waited_for,
)
from tltlc.automaton.value_phrases import VALUES, is_of_window, value_words, window_text
from tltlc.core.names import split_name
from tltlc.expression.tree import Before
from tltlc.logic.formula import TRUE, Formula
from tltlc.resolve.spec import Register, RegisterKind

_TEXTS: Final[Mapping[RegisterKind, str]] = {
    "once": "whether {0} has held",
    "historically": "whether {0} has always held",
    "since": "whether {0} has held since {1}",
    "previously": "whether {0} held at the step before",
    "times": "how often {0} has begun",
    "times_since": "how often {0} has begun since {1}",
    "times_within": "how often {0} has begun {1}",
    "time_since": "the time since {0}",
    "time_holding": "how long {0} has held",
    "total_time": "how long {0} has held in all",
    "total_time_since": "how long {0} has held since {1}",
    "run": "how long {0} had held at the step before",
    "age": "the time since {0} at an earlier step",
    "waiting": "how long {1} has been due after {0}",
    "due": "whether {1} is due after {0}",
    "samples": "how many steps there have been",
    "elapsed": "the time since the first step",
}
"""What is said of a register, by its kind; the numbers stand for the formulas that it is about."""
_AT_START: Final[Mapping[RegisterKind, str]] = {
    "previously": "not before the first step",
    "previous": "at the first step, the one of that step",
    "times": "steps in a row count once",
    "times_since": "before the first of these, since the first step; steps in a row count once",
    "times_within": "steps in a row count once",
    "time_since": "over every limit before the first",
    "time_holding": "0 s at the first step of it",
    "total_time_since": "before the first of these, since the first step",
    "highest_since": "before the first of these, since the first step",
    "lowest_since": "before the first of these, since the first step",
    "value_at": "before that, the one of the first step",
}
"""What a reader may expect to be otherwise, mostly at the first step or before the first event."""
_ALWAYS: Final[Mapping[RegisterKind, str]] = {
    "waiting": "how long {1} has been due",
    "due": "whether {1} is due",
}
"""The same for an answer that is due at all times, which has no event before it."""


def register_phrases(fspa: Fspa) -> dict[str, str]:
    """Return what each register of an automaton remembers, by its name.

    A register without words of its own keeps its name.
    """
    speaker, registers = Speaker(fspa), {register.name: register for register in fspa.registers}
    return {name: _phrase(register, registers, speaker) or name for name, register in registers.items()}


def start_phrase(register: Register) -> str:
    """Return what a register is where a reader may expect something else; "" if nothing needs to be said."""
    arguments = split_name(register.name)[1]
    if register.kind == "previous" and arguments[1:]:
        return "before that is reached, the one of the first step"
    if register.kind == "value_at" and arguments[-1].startswith("ends "):
        return "at the first step without it; before that, the one of the first step of all"
    return _AT_START.get(register.kind, "")


def _phrase(register: Register, registers: Mapping[str, Register], speaker: Speaker) -> str | None:
    if register.kind in VALUES:
        return value_words(register, speaker.event_text(register))
    text = _TEXTS.get(register.kind)
    answer = waited_for(register)
    if answer is not None and answer.request is TRUE:
        text = _ALWAYS[register.kind]
    goal = goal_in_time(register, registers, speaker.timers)
    if goal is not None:
        words = [f"{speaker.object_text(goal)} in time"]
    else:
        formulas = _operands(register, registers)
        if formulas is None or any(not speaker.timers.isdisjoint(formula.atoms()) for formula in formulas):
            return None
        name = speaker.noun_text if register.kind in ("time_since", "age") else speaker.object_text
        words = [name(formula) for formula in formulas]
        if (event := counted_since(register)) is not None:
            words.append(speaker.noun_text(event))
        if register.kind == "times_within":
            words.append(window_text(register))
        elif is_of_window(register):
            text = f"how long {{0}} has held {window_text(register)}"
    return None if text is None else text.format(*words)


def _operands(register: Register, registers: Mapping[str, Register]) -> tuple[Formula, ...] | None:
    """Return the formulas that a register is about; None if they cannot be read back."""
    if register.kind in ("samples", "elapsed"):
        return ()
    if register.kind in ("waiting", "due"):
        answer = waited_for(register)
        return None if answer is None else (answer.request, answer.goal)
    if register.kind == "previously":
        operand = remembered(register.update.name, registers) if isinstance(register.update, Before) else None
    elif register.kind in ("once", "historically", "since"):
        return past_operands(register)
    else:
        operand = counted(register, registers)
    return None if operand is None else (operand,)
