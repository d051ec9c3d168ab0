"""The timers and registers of a spec, as a picture shows them: a clock on each state in which a timer runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.automaton.fspa import Fspa, Text
from tltlc.automaton.memory_phrases import Speaker
from tltlc.automaton.remembered_formulas import counted, names_read, waited_for
from tltlc.core.names import ComparisonName
from tltlc.core.record import record, replace
from tltlc.logic.formula import FALSE, TRUE, Formula, and_, atom, not_, or_
from tltlc.logic.text.phrases import is_state, object_phrase
from tltlc.resolve.registers import COUNTS, SATURATING
from tltlc.resolve.spec import Atom, Register, RegisterKind

CLOCK: Final = "◷"
"""The mark of a timer. The fonts of Graphviz have it, unlike the stopwatch U+23F1."""

_KINDS: Final[dict[RegisterKind, str]] = {
    "once": "so far",
    "historically": "so far",
    "since": "so far",
    "times": "count",
    "time_since": "time since",
    "time_holding": "time without a break",
    "times_since": "count since an event",
    "times_within": "count in the last seconds",
    "total_time": "time in all",
    "total_time_since": "time in all since an event",
    "previous": "value before",
    "initial": "first value",
    "highest": "greatest value",
    "lowest": "least value",
    "highest_since": "greatest value since an event",
    "lowest_since": "least value since an event",
    "value_at": "value at an event",
    "samples": "count of samples",
    "elapsed": "time since the first sample",
    "run": "time without a break, before this sample",
    "age": "time since, before this sample",
    "waiting": "longest wait",
}
"""The kinds of registers that the legend shows, in words. The others only serve these."""


@record
class Timer:
    """A timer that runs in a state: its deadline, such as ``5 s``, and from which event it counts.

    ``subject`` is what must happen until the deadline, or hold up to it, and ``event`` the event in
    words. Each is empty if it is not known; without an event, the timer counts from the start.
    """

    deadline: str
    subject: str = ""
    event: str = ""

    def __str__(self) -> str:
        if not self.subject:
            return f"{CLOCK} {self.deadline} since {self.event or 'the start'}"
        return f"{CLOCK} {self.deadline}: {self.subject}{f' after {self.event}' if self.event else ''}"


@record
class MemoryRow:
    """A row of the legend: a register, its kind in words, and its maximum and first value with their unit.

    ``maximum`` is empty for a register that does not stop.
    """

    name: str
    kind: str
    maximum: str
    initial: str


def timers_of(fspa: Fspa, speaker: Speaker) -> dict[str, Timer]:
    """Map the name of each atom that reads a timer to the timer. ``speaker`` is that of the automaton."""
    registers = {register.name: register for register in fspa.registers}
    timers: dict[str, Timer] = {}
    for item in fspa.atoms:
        read = [name for name in names_read(item) if name in registers]
        timer = _timer(item, registers[read[0]], registers, speaker) if len(read) == 1 else None
        if timer is not None:
            timers[item.name] = timer
    return timers


def with_goal(timer: Timer, name: str, label: Formula | Text, speaker: Speaker) -> Timer:
    """Return the timer of the atom ``name``, with the goal that must come, or the state that must last, in a label.

    The label has the form ``!passed U goal`` or ``lasted R state``, and on a clock that varies
    ``recent U (recent & goal)`` or ``lasted R (lasted | state)``.
    """
    if timer.subject or isinstance(label, Text):
        return timer
    for node in label.walk():
        if node.op == "U" and node.args[0] in (atom(name), not_(atom(name))):
            goal = and_(*(part for part in _parts(node.args[1], "and") if part is not node.args[0] and is_state(part)))
        elif node.op == "R" and node.args[0] is atom(name):
            goal = or_(*(part for part in _parts(node.args[1], "or") if part is not node.args[0]))
        else:
            continue
        return replace(timer, subject=_say(goal, speaker)) if is_state(goal) and goal not in (TRUE, FALSE) else timer
    return timer


def _parts(formula: Formula, op: str) -> tuple[Formula, ...]:
    return formula.args if formula.op == op else (formula,)


def _timer(item: Atom, register: Register, registers: Mapping[str, Register], speaker: Speaker) -> Timer | None:
    if isinstance(item.base, ComparisonName):
        event = (
            counted(register, registers) if item.base.left == register.name and register.kind not in COUNTS else None
        )
        return None if event is None else _since(f"{item.base.right} s", register, _say(event, speaker))
    if item.timer is None or not item.arguments or register.kind == "due":
        return None
    time, *others = speaker.arguments(item, register)
    if register.kind in ("waiting", "breach") and others:
        start, subject = others if len(others) == 2 else ("", others[-1])
        return Timer(time, subject if start or register.kind == "breach" else f"{subject} again", start)
    if register.kind in ("samples", "elapsed"):
        return Timer(time)
    if register.kind in ("time_since", "age", "time_holding", "run") and others:
        return _since(time, register, others[0])
    return None


def _since(time: str, register: Register, event: str) -> Timer:
    if register.kind in ("total_time", "total_time_since"):
        return Timer(time, f"{event} in all")
    return (
        Timer(time, f"{event} without a break")
        if register.kind in ("time_holding", "run")
        else Timer(time, event=event)
    )


def memory_rows(fspa: Fspa) -> tuple[MemoryRow, ...]:
    """Return the rows of the legend, without registers that only serve others, such as last values."""
    speaker = Speaker(fspa)
    registers = {register.name: register for register in fspa.registers}
    return tuple(
        MemoryRow(
            _name(register, registers, speaker),
            _KINDS[register.kind],
            _maximum(register, fspa),
            _value(register, register.initial, fspa),
        )
        for register in fspa.registers
        if register.kind in _KINDS
    )


def _name(register: Register, registers: Mapping[str, Register], speaker: Speaker) -> str:
    """Return what a register is about, in words if it is a time."""
    answer = waited_for(register) if register.kind == "waiting" else None
    if answer is not None:
        goal = _say(answer.goal, speaker)
        return goal if answer.request is TRUE else f"{goal} after {_say(answer.request, speaker)}"
    event = None if register.kind in COUNTS else counted(register, registers)
    return register.name if event is None else _say(event, speaker)


def _say(formula: Formula, speaker: Speaker) -> str:
    return object_phrase(speaker.spoken(formula))


def _maximum(register: Register, fspa: Fspa) -> str:
    is_bounded = register.kind in SATURATING and register.high is not None
    return _value(register, register.high, fspa) if is_bounded and register.high is not None else ""


def _value(register: Register, value: float, fspa: Fspa) -> str:
    """Return a value of a register with its unit: in seconds if there is a clock."""
    if register.kind in ("once", "historically", "since"):
        return "true" if value > 0 else "false"
    if register.kind in ("elapsed", "waiting") and value < 0:
        return "none"
    if register.unit == "steps" and fspa.clock_s is not None and register.kind != "samples":
        seconds = value * fspa.clock_s
        return f"{seconds:.3g} s" if seconds < 100 else f"{seconds:.0f} s"
    return f"{value:g} {register.unit}".strip()
