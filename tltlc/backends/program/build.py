"""From an automaton to the program of its monitor."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.automaton.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.backends.code.names import Names
from tltlc.backends.program import judge, states
from tltlc.backends.program.arithmetic import Arithmetic
from tltlc.backends.program.tree import Statement
from tltlc.monitor.tables import tables
from tltlc.record import record

TEMPORARY = "t"
"""What variables begin with that stand for parts of a predicate: ``t_1``, or ``t2_1`` where a name begins so."""

_OWN = (
    *(states.TARGET, states.ROBUSTNESS, states.PROGRESS, states.LIMITING, states.NEAREST, states.OTHER),
    *(judge.STEPS, judge.STEPS_REAL, judge.BEST, judge.REWARD, judge.DONE, judge.ENDS),
    *(judge.VIOLATED, judge.SATISFIED, "state"),
)


@record
class Program:
    """The variables of signals, params and values of atoms, in the order of the automaton, and statements.

    ``values`` give each atom its value, which is declared and may be outside [-1, 1]; ``states`` assign what
    :mod:`tltlc.backends.program.states` names, ``judged`` what :mod:`tltlc.backends.program.judge` does.
    """

    fspa: Fspa
    signals: tuple[str, ...]
    params: tuple[str, ...]
    atoms: tuple[str, ...]
    values: tuple[tuple[Statement, ...], ...]
    states: tuple[tuple[Statement, ...], ...]
    judged: tuple[Statement, ...]


def program(fspa: Fspa, reserved: Iterable[str]) -> Program:
    """The program, in which no variable has a name that is ``reserved``: words of a language, names of a template."""
    names = Names([*reserved, *_OWN])
    # Room for predicates that nest deeply.
    with recursion_room():
        return _program(fspa, names)


def _program(fspa: Fspa, names: Names) -> Program:
    signals = {signal.name: names.give(signal.name) for signal in fspa.signals}
    params = {param.name: names.give(param.name, "param") for param in fspa.params}
    atoms = tuple(names.give(atom.name, "atom") for atom in fspa.atoms)
    arithmetic = Arithmetic(signals, params, _prefix([*signals.values(), *params.values(), *atoms]))
    looked_up = tables(fspa)
    return Program(
        fspa=fspa,
        signals=tuple(signals.values()),
        params=tuple(params.values()),
        atoms=atoms,
        values=tuple(
            tuple(arithmetic.assigned(name, atom.expression)) for name, atom in zip(atoms, fspa.atoms, strict=True)
        ),
        states=tuple(states.of_state(looked_up, state.id, atoms) for state in fspa.states),
        judged=judge.judged(fspa),
    )


def _prefix(names: Sequence[str]) -> str:
    """What no name begins with."""
    number, prefix = 1, f"{TEMPORARY}_"
    while any(name.startswith(prefix) for name in names):
        number += 1
        prefix = f"{TEMPORARY}{number}_"
    return prefix
