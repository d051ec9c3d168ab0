"""What an automaton measured at one step of a trace, in words."""

from __future__ import annotations

from collections.abc import Mapping

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import schedule
from tltlc.automaton.memory_phrases import Speaker
from tltlc.automaton.value_phrases import VALUES, value_words
from tltlc.core.record import EMPTY, record
from tltlc.expression.tree import AtomValue, SignalValue, nodes
from tltlc.monitor.failure_words import atom_words
from tltlc.program.flags import Flags
from tltlc.tools.judge.measures import measure, short_number
from tltlc.tools.judge.step_values import StepValue, enum_of, register_value, signal_value


@record
class MeasuredStep:
    """What was measured at a step.

    ``number`` counts from 1. ``values`` has the value of each atom of the automaton, in [-1, 1], and ``known`` maps
    the signals and registers to their values.
    """

    number: int = 0
    values: tuple[float, ...] = ()
    known: Mapping[str, float] = EMPTY

    def words(self, fspa: Fspa, atom: int) -> tuple[StepValue, ...]:
        """Return the value of an atom in words, or for a comparison the values that it compares."""
        value = self.values[atom]
        if fspa.atoms[atom].timer is not None:
            return (StepValue(atom_words(fspa, atom)),)
        measured = measure(fspa, atom, self.known)
        if measured is not None and measured.number is not None:
            return (StepValue(measured.quantity, measured.number),)
        speaker, name = Speaker(fspa), fspa.atoms[atom].name
        if speaker.is_about_past(name):
            fact = speaker.fact(name, holds=value > 0.0, is_first=self.number == 1)
            return (StepValue(atom_words(fspa, atom), _truth(value)) if fact is None else StepValue(fact),)
        if AtomValue(name) in Flags(fspa, schedule(fspa)):
            return (StepValue(atom_words(fspa, atom), _truth(value)),)
        registers = {register.name: register for register in fspa.registers}
        read = fspa.atoms[atom].expression
        words = {
            name: value_words(register, speaker.event_text(register))
            if register.kind in VALUES
            else speaker.quantity_text(name)
            for name, register in registers.items()
        }
        values = {signal.name: signal_value(signal, self.known[signal.name]) for signal in fspa.signals}
        values |= {
            name: register_value(register, self.known[name], fspa.clock_s) for name, register in registers.items()
        }
        names_in_atom = {node.name for node in nodes(read) if isinstance(node, SignalValue)}
        names = sorted(names_in_atom, key=lambda name: (name in registers, name))
        reads = tuple(StepValue(words.get(name, name), values[name]) for name in names)
        if measured is not None or enum_of(fspa, atom) is not None:
            return reads
        return (StepValue(atom_words(fspa, atom), short_number(value), reads),)


def _truth(value: float) -> str:
    return "true" if value > 0.0 else "false"
