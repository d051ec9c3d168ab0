"""Say what counts at the edges of goals, times and events: at the same step, at the first step, where play ends."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory_phrases import Speaker
from tltlc.automaton.remembered_formulas import counted, counted_since, names_read
from tltlc.automaton.text import times_of
from tltlc.automaton.value_phrases import value_words
from tltlc.core.names import ComparisonName, split_name
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import SignalValue, nodes
from tltlc.logic import formula as f
from tltlc.logic.bounded_operators import Bounded, bounded_operator
from tltlc.logic.formula import Formula
from tltlc.logic.text.phrases import bracketed_phrase, is_state
from tltlc.logic.text.sequences import next_goal
from tltlc.monitor.failure_words import atom_words
from tltlc.resolve.spec import Atom, Register


def boundaries(fspa: Fspa) -> tuple[str, ...]:
    """Return a sentence for each place where a reader may count one step more or less than the spec.

    They speak of finite traces, so that there are none over infinite ones, nor if another tool made the automaton.
    """
    if fspa.semantics == "infinite" or not isinstance(fspa.formula, Formula):
        return ()
    edges = (*_goals(fspa), *_events(fspa), *_ends(fspa), *_times(fspa), *_memory(fspa), *_sums(fspa))
    return tuple(dict.fromkeys(edges))


def _goals(fspa: Fspa) -> Iterator[str]:
    """Yield what is to know of goals behind `then`: they may have begun before."""
    assert isinstance(fspa.formula, Formula)
    speaker, goals = Speaker(fspa), dict[str, None]()
    for node in fspa.formula.walk():
        following = next_goal(node)
        if following is not None and following.link == "then":
            body = following.body
            states = (part for part in (body.args if body.op == "and" else (body,)) if is_state(part))
            goal = f.and_(*states)
            if goal is not f.TRUE and not any(speaker.is_about_past(name) for name in goal.atoms()):
                goals[bracketed_phrase(speaker.spoken(goal))] = None
    if goals:
        first, *others = goals
        yield f"then {first}{', and so on' if others else ''}: any later step with it counts, also if it began before"


def _events(fspa: Fspa) -> Iterator[str]:
    """Yield what is to know of beginnings: the first step may be one."""
    speaker, texts = Speaker(fspa), dict[str, None]()
    atoms = [f.atom(item.name) for item in fspa.atoms]
    guards = [edge.guard.primes for edge in fspa.edges]
    broken = [clause.primes for edge in fspa.edges for clause in edge.broken]
    for prime in dict.fromkeys(prime for primes in (*guards, *broken) for prime in primes):
        literals = [atoms[index] if holds else f.not_(atoms[index]) for index, holds in prime]
        texts.update(dict.fromkeys(speaker.turns(literals)[0]))
    begun = [text for text in texts if text.endswith(" begins")]
    if begun:
        names = ", ".join(begun)
        yield f"{names}: at the first of its steps in a row; also at the first step of play, if it holds there"


def _ends(fspa: Fspa) -> Iterator[str]:
    """Yield what is to know of `until`: what it keeps may have ended at the step that ends it."""
    assert isinstance(fspa.formula, Formula)
    speaker = Speaker(fspa)
    for node, is_positive in _signed(fspa.formula):
        if node.op in ("U", "W") and is_positive and all(map(is_state, node.args)):
            kept, end = (bracketed_phrase(speaker.spoken(part)) for part in node.args)
            if speaker.timers.isdisjoint(node.atoms()):
                yield f"until {end}: at that step itself, {kept} is not asked for"


def _times(fspa: Fspa) -> Iterator[str]:
    """Yield what is to know of `within` and `for`: which steps count, and what the end of play does."""
    assert isinstance(fspa.formula, Formula)
    counts, waits, lasting, later = times_of(fspa), dict[str, None](), dict[str, None](), dict[str, None]()
    for operator, is_next in _bounded_operators(fspa.formula):
        time = counts.time(operator.steps + (is_next or operator.op == "G"))
        (waits if operator.op == "F" else later if is_next else lasting)[time] = None
        if operator.op == "F" and any(part.op == "G" for part in operator.body.walk()):
            yield "what must hold from then on may also hold and end again before that step"
    for item in fspa.atoms:
        is_timer = item.timer is not None and item.base in ("late", "breach") and len(item.arguments) > 1
        # The first argument is the time: "5 s", or "the next 5 s" if it begins at the next step.
        if is_timer and item.arguments[0][0].isdigit():
            (waits if item.base == "late" else lasting)[item.arguments[0]] = None
    for time in waits:
        yield f"within {time}: up to and including the step {time} later"
    if waits:
        yield "where play ends before that, what has not come counts as missed"
    for time in lasting:
        yield f"for {time}: from that step on, but no longer at the step {time} later"
    for time in later:
        yield f"for the next {time}: up to and including the step {time} later"
    if lasting or later:
        yield "where play ends during such a time, nothing more is asked for"


def _bounded_operators(formula: Formula) -> Iterator[tuple[Bounded, bool]]:
    """Yield the bounded operators of a formula, each with whether it begins at the next step.

    Inside a negation, F is yielded for G, and G for F.
    """
    for node, is_positive in _signed(formula):
        is_next = node.op in ("X", "N")
        operator = bounded_operator(node.args[0] if is_next else node)
        if operator is not None:
            yield operator if is_positive else operator._replace(op="G" if operator.op == "F" else "F"), is_next


def _signed(formula: Formula) -> Iterator[tuple[Formula, bool]]:
    """Yield the parts of a formula, each with whether it stands inside an even number of negations.

    Of a bounded operator, or a `next` before one, the parts are those of its operand.
    """
    pending, seen = [(formula, True)], set[tuple[Formula, bool]]()
    while pending:
        node, is_positive = item = pending.pop()
        if item in seen:
            continue
        seen.add(item)
        yield item
        operator = bounded_operator(node.args[0] if node.op in ("X", "N") else node)
        if operator is not None:
            pending.append((operator.body, is_positive))
        else:
            denied = {"not": (0,), "implies": (0,)}.get(node.op, ())
            pending += [(part, is_positive != (index in denied)) for index, part in enumerate(node.args)]


def _memory(fspa: Fspa) -> Iterator[str]:
    """Yield what is to know of times and values of the trace so far."""
    speaker, registers = Speaker(fspa), {register.name: register for register in fspa.registers}
    for index, item in enumerate(fspa.atoms):
        read = [registers[name] for name in names_read(item) if name in registers]
        if len(read) == 1 and read[0].kind == "time_holding":
            steps = _first_step(fspa, item, read[0])
            held = counted(read[0], registers)
            if steps is not None and held is not None:
                number, holds = steps
                words = atom_words(fspa, index, holds=holds)
                yield f"{words}: from the {_ordinal(number)} step in a row with {speaker.object_text(held)} on"
    windows = [split_name(register.name)[1][-1] for register in fspa.registers if register.kind == "times_within"]
    recent = [window[0] for item in fspa.atoms if (window := speaker.window(item)) is not None and window[1]]
    for time in dict.fromkeys((*windows, *recent)):
        yield f"in the last {time}: at this step, or at one up to and including the step {time} before"
    for register in fspa.registers:
        event = counted_since(register)
        if register.kind in ("times_since", "total_time_since") and event is not None:
            operand = counted(register, registers)
            words = "what" if operand is None else speaker.object_text(operand)
            yield f"{words} since {speaker.noun_text(event)}: at that very step, it counts, too"
        if register.kind == "value_at" and event is not None:
            words = value_words(register, speaker.event_text(register))
            yield f"{words}: at {speaker.noun_text(event)} itself, the one of that step"
        elif register.kind in ("total_time", "total_time_since"):
            yield "times in all: the first step of play counts for nothing, since no time has passed there"


def _sums(fspa: Fspa) -> Iterator[str]:
    """Yield what is to know of sums of numbers with fractions: their last digits are rounded."""
    fractions = {signal.name for signal in fspa.signals if signal.type not in ("int", "bool")}
    registers = {register.name: register for register in fspa.registers}
    for item in fspa.atoms:
        name, read = item.base, names_read(item)
        if isinstance(name, ComparisonName) and any(sign in f"{name.left} {name.right}" for sign in (" + ", " - ")):
            for register in filter(None, map(registers.get, tuple(read))):
                read.update(node.name for node in nodes(register.update) if isinstance(node, SignalValue))
            if read & fractions:
                yield "sums of numbers with fractions are rounded: an exact limit may be missed by the last digit"


def _first_step(fspa: Fspa, item: Atom, register: Register) -> tuple[int, bool] | None:
    """Return at which step in a row, from 1, an atom that compares a time changes, and its truth from then on.

    None if the number of steps is not known, or if the atom never changes.
    """
    if register.unit != "steps" or register.high is None:
        return None
    if not isinstance(item.base, ComparisonName) or item.base.operator == "==":
        return None
    params = {param.name: param.value for param in fspa.params}

    def holds(steps: int) -> bool:
        return evaluate(item.expression, {register.name: float(steps)}, params) > 0.0

    low, high = 0, int(register.high)
    if holds(low) == holds(high):
        return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle) == holds(low) else (low, middle)
    return high + 1, holds(high)


def _ordinal(number: int) -> str:
    endings = {1: "st", 2: "nd", 3: "rd"}
    return f"{number:,}{'th' if number % 100 in (11, 12, 13) else endings.get(number % 10, 'th')}"
