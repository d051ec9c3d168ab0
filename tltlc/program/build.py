"""Build the program of a monitor from an automaton."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor.progress_and_reward import ends_on_entry
from tltlc.monitor.tables import tables
from tltlc.program import reward_step, states
from tltlc.program.arithmetic import ExpressionTranslator
from tltlc.program.bounds import Range, prove_ranges, range_between
from tltlc.program.names import VariableNames
from tltlc.program.tree import FAILING, Function, Statement
from tltlc.program.used_names import functions_called, variables_read
from tltlc.resolve.spec import Signal

TEMPORARY = "t"
"""The prefix of temporary variables: ``t_1``, ``t_2``, …, or ``t2_1``, … if another name begins with ``t_``."""

_OWN = (
    *(states.TARGET, states.ROBUSTNESS, states.PROGRESS, states.LIMITING, states.NEAREST, states.OTHER),
    *(reward_step.STEPS, reward_step.STEPS_REAL, reward_step.BEST, reward_step.BEFORE, reward_step.REWARD),
    *(reward_step.DONE, reward_step.ENDS, reward_step.VIOLATED, reward_step.SATISFIED, "state"),
)


@record
class Program:
    """The program of a monitor: names of variables, and statements.

    Signals, params, atoms and states have the order that they have in the automaton.

    - ``signals``, ``params`` and ``atoms`` are the names of the variables for their values.
    - ``values`` are, for each atom, the statements that assign its value.
    - ``always_in_range`` says, for each atom, whether it is proved that its value exists and lies in
      [-1, 1].
    - ``only_in`` is, for each atom, the state that alone needs its value: only this state computes
      the atom. It is -1 if no state needs the value, and None if every step computes it.
    - ``read_in`` is, for each signal, the state whose atoms alone read it. It is -1 if no atom
      reads the signal, and None if every step reads it.
    - ``remarks`` are, for each atom, its name, with the documentation of its predicate where the
      predicate appears first. They become comments.
    - ``exclusive`` are the groups of at least two exclusive atoms, each with its index in the
      automaton.
    - ``states`` are, for each state, the statements that compute a transition from it. They assign
      the variables of :mod:`tltlc.program.states`.
    - ``reward_statements`` compute progress, reward and the end of the episode after a transition.
      They read and assign the variables of :mod:`tltlc.program.reward_step`.
    - ``ends`` says, for each state, whether entering it ends an episode.
    """

    fspa: Fspa
    signals: tuple[str, ...]
    params: tuple[str, ...]
    atoms: tuple[str, ...]
    values: tuple[tuple[Statement, ...], ...]
    always_in_range: tuple[bool, ...]
    only_in: tuple[int | None, ...]
    read_in: tuple[int | None, ...]
    remarks: tuple[str, ...]
    exclusive: tuple[tuple[int, tuple[int, ...]], ...]
    states: tuple[tuple[Statement, ...], ...]
    reward_statements: tuple[Statement, ...]
    ends: tuple[bool, ...]

    def computed_in(self, state: int | None) -> list[int]:
        """Return the indices of the atoms that only this state computes; for None, of those computed at every step."""
        return [index for index, only in enumerate(self.only_in) if only == state]

    def bools_read_in(self, state: int | None) -> list[str]:
        """Return the variables of the bool signals that only this state reads; for None, those read at every step."""
        signals = zip(self.fspa.signals, self.signals, self.read_in, strict=True)
        return [name for signal, name, only in signals if signal.type == "bool" and only == state]

    @property
    def reads_sample(self) -> bool:
        """Whether a step reads any signal. Every step checks numbers; it reads a bool only if an atom needs it."""
        signals = zip(self.fspa.signals, self.read_in, strict=True)
        return any(signal.type != "bool" or only != -1 for signal, only in signals)

    @property
    def variables_used(self) -> frozenset[str]:
        """The variables that the values of the atoms are computed from."""
        return variables_read(statement for value in self.values for statement in value)

    @property
    def functions(self) -> frozenset[Function]:
        """The functions that the values of the atoms call."""
        return functions_called(statement for value in self.values for statement in value)


def program(fspa: Fspa, reserved: Iterable[str]) -> Program:
    """Return the program of an automaton's monitor.

    ``reserved`` are words of a language and names of a template. No variable has such a name.
    """
    names = VariableNames([*reserved, *_OWN])
    # Deeply nested predicates need a higher recursion limit.
    with recursion_room():
        return _program(fspa, names)


def _program(fspa: Fspa, names: VariableNames) -> Program:
    signals = {signal.name: names.new_name(signal.name) for signal in fspa.signals}
    params = {param.name: names.new_name(param.name, "param") for param in fspa.params}
    atoms = tuple(names.new_name(atom.name, "atom") for atom in fspa.atoms)
    arithmetic = ExpressionTranslator(signals, params, _prefix([*signals.values(), *params.values(), *atoms]))
    ranges = {name: _range(signal) for name, signal in zip(signals.values(), fspa.signals, strict=True)}
    ranges |= {
        name: range_between(param.low, param.high) for name, param in zip(params.values(), fspa.params, strict=True)
    }
    values = [
        prove_ranges(name, arithmetic.assign(name, atom.expression), ranges)
        for name, atom in zip(atoms, fspa.atoms, strict=True)
    ]
    # The range of a result does not tell whether a function in a condition may fail, so calls are checked separately.
    in_range = tuple(
        range_ is not None and range_.low >= -1.0 and range_.high <= 1.0 and not functions_called(statements) & FAILING
        for statements, range_ in values
    )
    monitor_tables = tables(fspa)
    transitions = tuple(states.state_statements(monitor_tables, state.id, atoms) for state in fspa.states)
    exclusive = tuple((number, group) for number, group in enumerate(fspa.exclusive) if len(group) > 1)
    compared = {atom for _, group in exclusive for atom in group}
    only_in = _only_in(
        atoms, [is_in_range and index not in compared for index, is_in_range in enumerate(in_range)], transitions
    )
    needed = tuple(() if only == -1 else statements for only, (statements, _) in zip(only_in, values, strict=True))
    return Program(
        fspa=fspa,
        signals=tuple(signals.values()),
        params=tuple(params.values()),
        atoms=atoms,
        values=needed,
        always_in_range=in_range,
        only_in=only_in,
        read_in=_read_in(tuple(signals.values()), only_in, needed),
        remarks=_remarks(fspa, only_in),
        exclusive=exclusive,
        states=transitions,
        reward_statements=reward_step.statements(fspa),
        ends=tuple(ends_on_entry(fspa, state.id) for state in fspa.states),
    )


def _only_in(
    atoms: Sequence[str], silent: Sequence[bool], transitions: Sequence[tuple[Statement, ...]]
) -> tuple[int | None, ...]:
    """Return, for each atom, the only state that reads it; -1 if none does, None if every step must compute it.

    ``silent`` says, for each atom, that computing it gives no error or notice. Every step computes
    the other atoms.
    """
    used = [variables_read(statements) for statements in transitions]
    only_in: list[int | None] = []
    for name, is_silent in zip(atoms, silent, strict=True):
        readers = [state for state, names in enumerate(used) if name in names]
        only_in.append((readers or [-1])[0] if is_silent and len(readers) < 2 else None)
    return tuple(only_in)


def _read_in(
    signals: Sequence[str], only_in: Sequence[int | None], values: Sequence[Sequence[Statement]]
) -> tuple[int | None, ...]:
    """Return, for each signal, the only state whose atoms read it.

    The result is -1 if no atom reads the signal, and None if an atom that every step computes, or
    atoms of several states, read it.
    """
    places: dict[str, set[int | None]] = {name: set() for name in signals}
    for only, statements in zip(only_in, values, strict=True):
        for name in variables_read(statements) & places.keys():
            places[name].add(only)
    return tuple((*readers, -1)[0] if len(readers) < 2 else None for readers in places.values())


def _remarks(fspa: Fspa, only_in: Sequence[int | None]) -> tuple[str, ...]:
    """Return the atoms' names.

    The first atom of each predicate, in order of computation, gets the predicate's documentation
    too.
    """
    remarks = [atom.name for atom in fspa.atoms]
    explained = {""}
    eager = [index for index, only in enumerate(only_in) if only is None]
    lazy = [index for state in fspa.states for index, only in enumerate(only_in) if only == state.id]
    for index in (*eager, *lazy):
        doc = fspa.atoms[index].doc
        if doc not in explained:
            remarks[index] += f": {doc}"
            explained.add(doc)
    return tuple(remarks)


def _range(signal: Signal) -> Range:
    return Range(0.0, 1.0) if signal.type == "bool" else range_between(signal.low, signal.high)


def _prefix(names: Sequence[str]) -> str:
    """Return a prefix that no name begins with."""
    number, prefix = 1, f"{TEMPORARY}_"
    while any(name.startswith(prefix) for name in names):
        number += 1
        prefix = f"{TEMPORARY}{number}_"
    return prefix
