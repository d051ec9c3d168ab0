"""From an automaton to the program of its monitor."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor.tables import tables
from tltlc.program import judge, states
from tltlc.program.arithmetic import Arithmetic
from tltlc.program.bounds import Range, proven, within
from tltlc.program.names import Names
from tltlc.program.tree import FAILING, Function, Statement
from tltlc.program.uses import called, read
from tltlc.resolve.spec import Signal

TEMPORARY = "t"
"""What variables begin with that stand for parts of a predicate: ``t_1``, or ``t2_1`` where a name begins so."""

_OWN = (
    *(states.TARGET, states.ROBUSTNESS, states.PROGRESS, states.LIMITING, states.NEAREST, states.OTHER),
    *(judge.STEPS, judge.STEPS_REAL, judge.BEST, judge.BEFORE, judge.REWARD, judge.DONE, judge.ENDS),
    *(judge.VIOLATED, judge.SATISFIED, "state"),
)


@record
class Program:
    """The variables of signals, params and values of atoms, in the order of the automaton, and statements.

    ``values`` give each atom its value, which is declared, and may be outside [-1, 1] or no number unless the atom is
    ``sure``.  ``only_in`` is the one state in which an atom need be computed, -1 where no state does, and None where
    it is computed at each step; ``read_in`` says the same of the signals that atoms are computed from.  ``remarks`` say
    what each atom is, and of a predicate only once what it means.
    ``exclusive`` are the groups of atoms that can hold at once, with their numbers in the automaton.  ``states`` assign
    what :mod:`tltlc.program.states` names, ``judged`` what :mod:`tltlc.program.judge` does.  Where a
    state ``ends``, an episode is over on entry.
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
        """The numbers of the atoms that are computed in a state alone, or at each step."""
        return [place for place, only in enumerate(self.only_in) if only == state]

    def bools_read_in(self, state: int | None) -> list[str]:
        """The variables of the bool signals that atoms are computed from in a state alone, or at each step."""
        signals = zip(self.fspa.signals, self.signals, self.read_in, strict=True)
        return [name for signal, name, only in signals if signal.type == "bool" and only == state]

    @property
    def reads_sample(self) -> bool:
        """Whether any signal is looked at: numbers are checked, bools may be read by no atom."""
        signals = zip(self.fspa.signals, self.read_in, strict=True)
        return any(signal.type != "bool" or only != -1 for signal, only in signals)

    @property
    def used(self) -> frozenset[str]:
        """The variables that the values of atoms are computed from."""
        return read(statement for value in self.values for statement in value)

    @property
    def functions(self) -> frozenset[Function]:
        """The functions that the values of atoms are computed by."""
        return called(statement for value in self.values for statement in value)


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
    ranges = {name: _range(signal) for name, signal in zip(signals.values(), fspa.signals, strict=True)}
    ranges |= {name: within(param.low, param.high) for name, param in zip(params.values(), fspa.params, strict=True)}
    values = [
        proven(name, arithmetic.assigned(name, atom.expression), ranges)
        for name, atom in zip(atoms, fspa.atoms, strict=True)
    ]
    # What may have no value counts in tests, too.
    sure = tuple(
        range_ is not None and range_.low >= -1.0 and range_.high <= 1.0 and not called(statements) & FAILING
        for statements, range_ in values
    )
    looked_up = tables(fspa)
    moves = tuple(states.of_state(looked_up, state.id, atoms) for state in fspa.states)
    exclusive = tuple((number, group) for number, group in enumerate(fspa.exclusive) if len(group) > 1)
    compared = {atom for _, group in exclusive for atom in group}
    only_in = _only_in(atoms, [is_sure and place not in compared for place, is_sure in enumerate(sure)], moves)
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
        judged=judge.judged(fspa),
        ends=tuple(
            state.verdict in ("satisfied", "violated") or (fspa.judge == "goal" and state.accepting)
            for state in fspa.states
        ),
    )


def _only_in(
    atoms: Sequence[str], unseen: Sequence[bool], moves: Sequence[tuple[Statement, ...]]
) -> tuple[int | None, ...]:
    """What one state alone reads is computed there, if that is ``unseen``: if there are no errors and no notices."""
    used = [read(statements) for statements in moves]
    found: list[int | None] = []
    for name, is_unseen in zip(atoms, unseen, strict=True):
        reading = [state for state, names in enumerate(used) if name in names]
        found.append((reading or [-1])[0] if is_unseen and len(reading) < 2 else None)
    return tuple(found)


def _read_in(
    signals: Sequence[str], only_in: Sequence[int | None], values: Sequence[Sequence[Statement]]
) -> tuple[int | None, ...]:
    """For each signal the one place where the atoms are computed that read it: a state, or at each step."""
    places: dict[str, set[int | None]] = {name: set() for name in signals}
    for only, statements in zip(only_in, values, strict=True):
        for name in read(statements) & places.keys():
            places[name].add(only)
    return tuple((*found, -1)[0] if len(found) < 2 else None for found in places.values())


def _remarks(fspa: Fspa, only_in: Sequence[int | None]) -> tuple[str, ...]:
    """The atoms' names, and behind the first of each predicate, as they are computed, what it means."""
    remarks = [atom.name for atom in fspa.atoms]
    explained = {""}
    eager = [place for place, only in enumerate(only_in) if only is None]
    lazy = [place for state in fspa.states for place, only in enumerate(only_in) if only == state.id]
    for place in (*eager, *lazy):
        doc = fspa.atoms[place].doc
        if doc not in explained:
            remarks[place] += f": {doc}"
            explained.add(doc)
    return tuple(remarks)


def _range(signal: Signal) -> Range:
    return Range(0.0, 1.0) if signal.type == "bool" else within(signal.low, signal.high)


def _prefix(names: Sequence[str]) -> str:
    """What no name begins with."""
    number, prefix = 1, f"{TEMPORARY}_"
    while any(name.startswith(prefix) for name in names):
        number += 1
        prefix = f"{TEMPORARY}{number}_"
    return prefix
