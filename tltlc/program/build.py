"""Build the program of a monitor from an automaton."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor.reward import ends_on_entry
from tltlc.monitor.tables import tables
from tltlc.program import reward_step, states
from tltlc.program.arithmetic import ExpressionTranslator
from tltlc.program.bounds import Range, proven, within
from tltlc.program.names import VariableNames
from tltlc.program.tree import FAILING, Function, Statement
from tltlc.program.used_names import called, read
from tltlc.resolve.spec import Signal

TEMPORARY = "t"
"""The prefix of variables for parts of a predicate: ``t_1``, or ``t2_1`` if another name begins with ``t_``."""

_OWN = (
    *(states.TARGET, states.ROBUSTNESS, states.PROGRESS, states.LIMITING, states.NEAREST, states.OTHER),
    *(reward_step.STEPS, reward_step.STEPS_REAL, reward_step.BEST, reward_step.BEFORE, reward_step.REWARD),
    *(reward_step.DONE, reward_step.ENDS, reward_step.VIOLATED, reward_step.SATISFIED, "state"),
)


@record
class Program:
    """The program of a monitor: names of variables and statements, in the order of the automaton.

    - ``signals``, ``params`` and ``atoms`` are names of variables; ``atoms`` hold the values of the
      atoms.
    - ``values`` are statements that declare and compute the value of each atom. It may lie outside
      [-1, 1] or not exist, unless the atom is ``sure``.
    - ``only_in`` is, per atom, the only state in which it must be computed; -1 if no state needs
      it, None if every step computes it.
    - ``read_in`` gives the same for each signal: the state whose atoms read it, -1 or None.
    - ``remarks`` describe each atom for comments. The meaning of a predicate appears only once.
    - ``exclusive`` are the groups of at least two exclusive atoms, each with its index in the
      automaton.
    - ``states`` are, per state, statements that assign the variables of
      :mod:`tltlc.program.states`.
    - ``judged`` assigns those of :mod:`tltlc.program.reward_step`.
    - ``ends`` says, per state, whether entering it ends an episode.
    """

    fspa: Fspa
    signals: tuple[str, ...]
    params: tuple[str, ...]
    atoms: tuple[str, ...]
    values: tuple[tuple[Statement, ...], ...]
    sure: tuple[bool, ...]
    only_in: tuple[int | None, ...]
    read_in: tuple[int | None, ...]
    remarks: tuple[str, ...]
    exclusive: tuple[tuple[int, tuple[int, ...]], ...]
    states: tuple[tuple[Statement, ...], ...]
    judged: tuple[Statement, ...]
    ends: tuple[bool, ...]

    def computed_in(self, state: int | None) -> list[int]:
        """Return the indices of the atoms that only this state computes; for None, those that every step computes."""
        return [index for index, only in enumerate(self.only_in) if only == state]

    def bools_read_in(self, state: int | None) -> list[str]:
        """Return the variables of the bool signals that only this state reads; for None, those read at every step."""
        signals = zip(self.fspa.signals, self.signals, self.read_in, strict=True)
        return [name for signal, name, only in signals if signal.type == "bool" and only == state]

    @property
    def reads_sample(self) -> bool:
        """Whether a step reads any signal. Numbers are always checked; a bool may be read by no atom."""
        signals = zip(self.fspa.signals, self.read_in, strict=True)
        return any(signal.type != "bool" or only != -1 for signal, only in signals)

    @property
    def used(self) -> frozenset[str]:
        """The variables that the values of the atoms are computed from."""
        return read(statement for value in self.values for statement in value)

    @property
    def functions(self) -> frozenset[Function]:
        """The functions that the values of the atoms call."""
        return called(statement for value in self.values for statement in value)


def program(fspa: Fspa, reserved: Iterable[str]) -> Program:
    """Return the program of an automaton's monitor; no variable has a ``reserved`` name (of a
    language or a template).
    """
    names = VariableNames([*reserved, *_OWN])
    # Deeply nested predicates need a higher recursion limit.
    with recursion_room():
        return _program(fspa, names)


def _program(fspa: Fspa, names: VariableNames) -> Program:
    signals = {signal.name: names.give(signal.name) for signal in fspa.signals}
    params = {param.name: names.give(param.name, "param") for param in fspa.params}
    atoms = tuple(names.give(atom.name, "atom") for atom in fspa.atoms)
    arithmetic = ExpressionTranslator(signals, params, _prefix([*signals.values(), *params.values(), *atoms]))
    ranges = {name: _range(signal) for name, signal in zip(signals.values(), fspa.signals, strict=True)}
    ranges |= {name: within(param.low, param.high) for name, param in zip(params.values(), fspa.params, strict=True)}
    values = [
        proven(name, arithmetic.assigned(name, atom.expression), ranges)
        for name, atom in zip(atoms, fspa.atoms, strict=True)
    ]
    # A function that fails in a condition does not show in the range of the result, so calls are checked separately.
    sure = tuple(
        range_ is not None and range_.low >= -1.0 and range_.high <= 1.0 and not called(statements) & FAILING
        for statements, range_ in values
    )
    looked_up = tables(fspa)
    moves = tuple(states.of_state(looked_up, state.id, atoms) for state in fspa.states)
    exclusive = tuple((number, group) for number, group in enumerate(fspa.exclusive) if len(group) > 1)
    compared = {atom for _, group in exclusive for atom in group}
    only_in = _only_in(atoms, [is_sure and index not in compared for index, is_sure in enumerate(sure)], moves)
    written = tuple(() if only == -1 else statements for only, (statements, _) in zip(only_in, values, strict=True))
    return Program(
        fspa=fspa,
        signals=tuple(signals.values()),
        params=tuple(params.values()),
        atoms=atoms,
        values=written,
        sure=sure,
        only_in=only_in,
        read_in=_read_in(tuple(signals.values()), only_in, written),
        remarks=_remarks(fspa, only_in),
        exclusive=exclusive,
        states=moves,
        judged=reward_step.statements(fspa),
        ends=tuple(ends_on_entry(fspa, state.id) for state in fspa.states),
    )


def _only_in(
    atoms: Sequence[str], unseen: Sequence[bool], moves: Sequence[tuple[Statement, ...]]
) -> tuple[int | None, ...]:
    """Return, per atom, the only state that reads it; -1 if none does, None if every step must compute it.

    An atom that is not ``unseen``, because computing it can give an error or a notice, is computed
    at every step.
    """
    used = [read(statements) for statements in moves]
    only_in: list[int | None] = []
    for name, is_unseen in zip(atoms, unseen, strict=True):
        readers = [state for state, names in enumerate(used) if name in names]
        only_in.append((readers or [-1])[0] if is_unseen and len(readers) < 2 else None)
    return tuple(only_in)


def _read_in(
    signals: Sequence[str], only_in: Sequence[int | None], values: Sequence[Sequence[Statement]]
) -> tuple[int | None, ...]:
    """Return, per signal, the only place whose atoms read it: a state, None for every step, or -1 if no atom does.

    A signal read in several places gives None.
    """
    places: dict[str, set[int | None]] = {name: set() for name in signals}
    for only, statements in zip(only_in, values, strict=True):
        for name in read(statements) & places.keys():
            places[name].add(only)
    return tuple((*readers, -1)[0] if len(readers) < 2 else None for readers in places.values())


def _remarks(fspa: Fspa, only_in: Sequence[int | None]) -> tuple[str, ...]:
    """Return the atoms' names. The first atom of each predicate, in order of computation, includes
    its documentation.
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
    return Range(0.0, 1.0) if signal.type == "bool" else within(signal.low, signal.high)


def _prefix(names: Sequence[str]) -> str:
    """Return a prefix that no name begins with."""
    number, prefix = 1, f"{TEMPORARY}_"
    while any(name.startswith(prefix) for name in names):
        number += 1
        prefix = f"{TEMPORARY}{number}_"
    return prefix
