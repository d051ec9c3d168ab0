"""Build the program of a monitor from an automaton."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor.tables import ends_on_entry, tables
from tltlc.program import reward_step, states
from tltlc.program.arithmetic import ExpressionTranslator
from tltlc.program.bounds import ValueRange, prove_ranges, range_between
from tltlc.program.names import VariableNames
from tltlc.program.shapes import Case, StateTables, cases_and_tables
from tltlc.program.tree import FAILING, NumericFunction, Statement
from tltlc.program.used_names import functions_called, variables_read
from tltlc.resolve.spec import Signal

TEMPORARY = "t"
"""The prefix of temporary variables: ``t_1``, ``t_2``, …, or ``t2_1``, … if another name begins with ``t_``."""

_OWN = (
    *(states.TARGET, states.ROBUSTNESS, states.PROGRESS, states.LIMITING, states.NEAREST, states.OTHER),
    states.FIRST_EDGE,
    *(reward_step.STEPS, reward_step.STEPS_REAL, reward_step.BEST, reward_step.BEFORE, reward_step.REWARD),
    *(reward_step.DONE, reward_step.ENDS, reward_step.VIOLATED, reward_step.SATISFIED, "state"),
)


@record
class Program:
    """The program of a monitor: names of variables, and statements.

    Signals, parameters, atoms and states have the order that they have in the automaton.

    - ``signals``, ``params`` and ``atoms`` are the names of the variables with their values.
    - ``values`` has, for each atom, the statements that assign its value; none if no case needs it.
    - ``always_in_range`` says, for each atom, whether it is proved that its value exists and lies in
      [-1, 1].
    - ``only_in`` has, for each atom, the number of the only case that needs the atom: the atom is
      computed only there. It is -1 if no case needs the atom, and None if every step computes it.
    - ``read_in`` has, for each signal, the number of the only case whose atoms read it. It is -1 if
      no atom reads the signal, and None if every step reads it.
    - ``atom_comments`` has, for each atom, the text of a comment: the name of the atom. The first atom of
      a predicate also has the documentation of the predicate.
    - ``exclusive`` has a pair for each group of at least two exclusive atoms, of which at most one
      is true at a time: the index of the group in the automaton, and the indices of its atoms.
    - ``cases`` has the statements that compute a transition: a case for each state or, if ``tables``
      is not None, for each shape of states (:mod:`tltlc.program.shapes`).
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
    atom_comments: tuple[str, ...]
    exclusive: tuple[tuple[int, tuple[int, ...]], ...]
    cases: tuple[Case, ...]
    tables: StateTables | None
    reward_statements: tuple[Statement, ...]
    ends: tuple[bool, ...]

    def computed_in(self, case: int | None) -> list[int]:
        """Return the indices of the atoms that are computed only in this case.

        If ``case`` is None, return the indices of the atoms that every step computes.
        """
        return [index for index, only in enumerate(self.only_in) if only == case]

    def bools_read_in(self, case: int | None) -> list[str]:
        """Return the variables of the bool signals that are read only in this case.

        If ``case`` is None, return the variables of the bool signals that every step reads.
        """
        signals = zip(self.fspa.signals, self.signals, self.read_in, strict=True)
        return [name for signal, name, only in signals if signal.type == "bool" and only == case]

    @property
    def reads_sample(self) -> bool:
        """Whether a step reads any signal.

        A step reads every number, to check it, but a bool signal only if an atom needs it.
        """
        signals = zip(self.fspa.signals, self.read_in, strict=True)
        return any(signal.type != "bool" or only != -1 for signal, only in signals)

    @property
    def variables_used(self) -> frozenset[str]:
        """The names of the variables that the statements in ``values`` read."""
        return variables_read(statement for value in self.values for statement in value)

    @property
    def functions(self) -> frozenset[NumericFunction]:
        """The functions that the statements in ``values`` call."""
        return functions_called(statement for value in self.values for statement in value)


def program(fspa: Fspa, reserved: Iterable[str]) -> Program:
    """Return the program of an automaton's monitor.

    ``reserved`` are the names that no variable may have: keywords of the language in which the
    program will be printed, and names in the template of its file.
    """
    names = VariableNames([*reserved, *_OWN])
    # Expressions of deeply nested predicates need a higher recursion limit.
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
    # A function in the condition of a `when` may fail even if the result is always in range. So an atom that calls such
    # a function does not count as always in range.
    in_range = tuple(
        range_ is not None and range_.low >= -1.0 and range_.high <= 1.0 and not functions_called(statements) & FAILING
        for statements, range_ in values
    )
    cases, state_tables = cases_and_tables(tables(fspa), atoms)
    exclusive = tuple((number, group) for number, group in enumerate(fspa.exclusive) if len(group) > 1)
    compared = {atom for _, group in exclusive for atom in group}
    only_in = _only_in(
        atoms, [is_in_range and index not in compared for index, is_in_range in enumerate(in_range)], cases
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
        atom_comments=_atom_comments(fspa, only_in, len(cases)),
        exclusive=exclusive,
        cases=cases,
        tables=state_tables,
        reward_statements=reward_step.statements(fspa),
        ends=tuple(ends_on_entry(fspa, state) for state in fspa.states),
    )


def _only_in(atoms: Sequence[str], silent: Sequence[bool], cases: Sequence[Case]) -> tuple[int | None, ...]:
    """Return for each atom the number of the only case that needs it.

    The number is -1 if no case needs the atom, and None if every step computes it. ``silent``
    says, for each atom, that its computation never gives an error or a notice. Every step computes
    the atoms that are not silent, so that all monitors give the same errors and notices. ``atoms``
    are the variables of the atoms.
    """
    used = [variables_read(case.statements) for case in cases]
    only_in: list[int | None] = []
    for name, is_silent in zip(atoms, silent, strict=True):
        readers = [number for number, names in enumerate(used) if name in names]
        only_in.append((readers or [-1])[0] if is_silent and len(readers) < 2 else None)
    return tuple(only_in)


def _read_in(
    signals: Sequence[str], only_in: Sequence[int | None], values: Sequence[Sequence[Statement]]
) -> tuple[int | None, ...]:
    """Return for each signal the number of the only case that reads it.

    The number is -1 if no atom reads the signal. It is None if every step or several cases read
    it. ``only_in`` has the number of the only case that needs each atom, and ``values`` has the
    statements of each atom.
    """
    places: dict[str, set[int | None]] = {name: set() for name in signals}
    for only, statements in zip(only_in, values, strict=True):
        for name in variables_read(statements) & places.keys():
            places[name].add(only)
    return tuple((*readers, -1)[0] if len(readers) < 2 else None for readers in places.values())


def _atom_comments(fspa: Fspa, only_in: Sequence[int | None], case_count: int) -> tuple[str, ...]:
    """Return the text of the comment of each atom: its name, and perhaps documentation.

    The documentation of a predicate is in the comment of only one of its atoms: the first in the
    generated code. In this code, the atoms that every step computes come before those of single
    cases (``only_in``).
    """
    atom_comments = [atom.name for atom in fspa.atoms]
    explained = {""}
    eager = [index for index, only in enumerate(only_in) if only is None]
    lazy = [index for case in range(case_count) for index, only in enumerate(only_in) if only == case]
    for index in (*eager, *lazy):
        doc = fspa.atoms[index].doc
        if doc not in explained:
            atom_comments[index] += f": {doc}"
            explained.add(doc)
    return tuple(atom_comments)


def _range(signal: Signal) -> ValueRange:
    return ValueRange(0.0, 1.0) if signal.type == "bool" else range_between(signal.low, signal.high)


def _prefix(names: Sequence[str]) -> str:
    """Return a prefix for temporary variables with which none of the ``names`` begins: ``t_``, ``t2_``, …."""
    number, prefix = 1, f"{TEMPORARY}_"
    while any(name.startswith(prefix) for name in names):
        number += 1
        prefix = f"{TEMPORARY}{number}_"
    return prefix
