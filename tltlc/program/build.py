"""Build the program of a monitor from an automaton."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import Computation, schedule
from tltlc.core.record import record
from tltlc.expression.tree import AtomValue, Before, StepLength, VariableKey
from tltlc.monitor.tables import ends_on_entry, tables
from tltlc.program import reward_step, states
from tltlc.program.arithmetic import ExpressionTranslator
from tltlc.program.bounds import ValueRange, range_between
from tltlc.program.compact_states import WORST, AtomVariables
from tltlc.program.flags import Flags
from tltlc.program.names import VariableNames
from tltlc.program.sample_ranges import RegisterVariables, prove_sample, proved_ranges
from tltlc.program.shapes import Case, StateTables, cases_and_tables
from tltlc.program.tree import (
    FAILING,
    Choice,
    NumericFunction,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
)
from tltlc.program.used_names import functions_called, variables_read
from tltlc.resolve.spec import Register, Signal

TEMPORARY = "t"
"""The prefix of temporary variables: ``t_1``, ``t_2``, …, or ``t2_1``, … if another name begins with ``t_``."""

DT = "dt"
"""The variable with the time since the sample before, in seconds, if the clock varies."""

_OWN = (
    *(states.TARGET, states.ROBUSTNESS, states.PROGRESS, states.LIMITING, states.NEAREST, states.OTHER),
    *(states.FAILURE, states.FAILED_STEP, states.FIRST_EDGE),
    *(reward_step.STEPS, reward_step.STEPS_REAL, reward_step.BEST, reward_step.BEFORE, reward_step.REWARD),
    *(reward_step.DONE, reward_step.ENDS, reward_step.VIOLATED, reward_step.SATISFIED, "state"),
)


@record
class Program:
    """The program of a monitor: names of variables, and statements.

    Signals, parameters, atoms, registers and states have the order that they have in the automaton.

    - ``signals``, ``params`` and ``atoms`` are the names of the variables with their values.
      ``registers`` are those with the values of the registers after the sample, and ``before`` those
      with their values before it. Where an atom or register is only -1 or 1, its variable may be a
      Boolean, which is true for 1. A monitor keeps the values in ``kept``, which are those of the
      registers after the sample, when the step has succeeded. ``booleans`` are the variables of signals,
      and of registers before the sample, that are Booleans: true where the signal or register is 1.
    - ``values`` has, for each atom, the statements that assign its value; none if no case needs it.
    - ``always_in_range`` says, for each atom, whether it is proved that its value exists and lies in
      [-1, 1].
    - ``ranges`` has the intervals in which the values of signals, params, atoms and registers lie, by variable, where
      they are known; those of the registers before a sample, too.
    - ``updates`` has, for each register, the statements that assign its value after the sample.
      ``always_finite`` says whether it is proved that this value exists and is finite.
    - ``every_step`` has what every step computes, in order. If there are registers, each value must be
      checked, and clamped, before the next one is computed.
    - ``only_in`` has, for each atom, the number of the only case that needs the atom: the atom is
      computed only there. It is -1 if no case needs the atom, and None if every step computes it.
    - ``read_in`` has, for each signal, the number of the only case whose atoms read it. It is -1 if
      no atom reads the signal, and None if every step reads it.
    - ``atom_comments`` has, for each atom, the text of a comment: the name of the atom. The first atom of
      a predicate also has the documentation of the predicate. ``register_comments`` has a comment for
      each register.
    - ``exclusive`` has a pair for each group of at least two exclusive atoms, of which at most one
      is true at a time: the index of the group in the automaton, and the indices of its atoms.
    - ``cases`` has the statements that compute a transition: a case for each state or, if ``tables``
      is not None, for each shape of states (:mod:`tltlc.program.shapes`).
    - ``failures`` has what a step can fail at (:attr:`tltlc.program.states.StateCode.failures`): the
      statements of an edge into a trap assign an index into it.
    - ``reward_statements`` compute progress, reward and the end of the episode after a transition.
      They read and assign the variables of :mod:`tltlc.program.reward_step`.
    - ``ends`` says, for each state, whether entering it ends an episode.
    """

    fspa: Fspa
    signals: tuple[str, ...]
    params: tuple[str, ...]
    atoms: tuple[str, ...]
    registers: tuple[str, ...]
    before: tuple[str, ...]
    kept: tuple[ProgramExpression, ...]
    booleans: frozenset[str]
    values: tuple[tuple[Statement, ...], ...]
    always_in_range: tuple[bool, ...]
    ranges: Mapping[str, ValueRange]
    updates: tuple[tuple[Statement, ...], ...]
    always_finite: tuple[bool, ...]
    every_step: tuple[Computation, ...]
    only_in: tuple[int | None, ...]
    read_in: tuple[int | None, ...]
    atom_comments: tuple[str, ...]
    register_comments: tuple[str, ...]
    exclusive: tuple[tuple[int, tuple[int, ...]], ...]
    cases: tuple[Case, ...]
    tables: StateTables | None
    failures: tuple[tuple[int | None, int | None], ...]
    reward_statements: tuple[Statement, ...]
    ends: tuple[bool, ...]

    def computed_in(self, case: int | None) -> list[int]:
        """Return the indices of the atoms that are computed only in this case.

        If ``case`` is None, return the indices of the atoms that every step computes, in order.
        """
        if case is None:
            return [step.index for step in self.every_step if step.kind == "atom"]
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
    def state_rows(self) -> Sequence[int]:
        """The states that have a row in the table of states: all or, if there are ``tables``, one of each kind."""
        return range(len(self.fspa.states)) if self.tables is None else self.tables.kind_states

    @property
    def variables_used(self) -> frozenset[str]:
        """The names of the variables that the statements in ``values`` and ``updates`` read."""
        return variables_read(self._statements())

    @property
    def unchecked(self) -> frozenset[str]:
        """The variables of the atoms and registers that a step need not check: they are always in range, or finite."""
        safe = zip((*self.atoms, *self.registers), (*self.always_in_range, *self.always_finite), strict=True)
        return frozenset(name for name, is_safe in safe if is_safe)

    @property
    def functions(self) -> frozenset[NumericFunction]:
        """The functions that the statements in ``values`` and ``updates`` call."""
        return functions_called(self._statements())

    @property
    def variables_kept(self) -> frozenset[str]:
        """The names of the variables that the statements in ``updates`` read."""
        return variables_read(statement for update in self.updates for statement in update)

    def _statements(self) -> Iterator[Statement]:
        return (statement for value in (*self.values, *self.updates) for statement in value)


def program(fspa: Fspa, reserved: Iterable[str], *, has_bools: bool = False) -> Program:
    """Return the program of an automaton's monitor.

    If ``has_bools``, and there are registers, bool signals are Booleans, not 0 and 1, and so are the registers
    before the sample that are only -1 or 1.

    ``reserved`` are the names that no variable may have: keywords of the language in which the
    program will be printed, and names in the template of its file.
    """
    own = [*_OWN, *([DT] if fspa.clock_varies else []), *((WORST,) if fspa.registers else ())]
    names = VariableNames([*reserved, *own])
    # Expressions of deeply nested predicates need a higher recursion limit.
    with recursion_room():
        return _program(fspa, names, has_bools)


def _program(fspa: Fspa, names: VariableNames, has_bools: bool) -> Program:
    signals = {signal.name: names.new_name(signal.name) for signal in fspa.signals}
    params = {param.name: names.new_name(param.name, "param") for param in fspa.params}
    atoms = tuple(names.new_name(atom.name, "atom") for atom in fspa.atoms)
    registers = tuple(
        RegisterVariables(
            register, names.new_name(register.name, "register"), names.new_name(f"{register.name} before")
        )
        for register in fspa.registers
    )
    now, before = tuple(each.now for each in registers), tuple(each.before for each in registers)
    variables: dict[VariableKey, str] = dict(signals.items())
    for each in registers:
        variables |= {each.register.name: each.now, Before(each.register.name): each.before}
    if registers:
        variables |= {AtomValue(atom.name): name for atom, name in zip(fspa.atoms, atoms, strict=True)}
    if fspa.clock_varies:
        variables[StepLength()] = DT
    order = schedule(fspa)
    flags = Flags(fspa, order) if registers else None
    booleans = _booleans(fspa, flags, has_bools) if flags else frozenset[VariableKey]()
    prefix = _prefix([*variables.values(), *params.values(), *atoms])
    arithmetic = ExpressionTranslator(variables, params, prefix, flags, booleans)
    computations: dict[str, list[Statement]] = {}
    booleans_now: set[str] = set()
    for step in order:
        name = atoms[step.index] if step.kind == "atom" else now[step.index]
        key: VariableKey
        if step.kind == "atom":
            expression, key = fspa.atoms[step.index].expression, AtomValue(fspa.atoms[step.index].name)
        else:
            expression, key = fspa.registers[step.index].update, fspa.registers[step.index].name
        if key in booleans:
            booleans_now.add(name)
            computations[name] = arithmetic.declare_flag(name, expression)
        else:
            computations[name] = arithmetic.assign(name, expression)
    ranges = {name: _range(signal) for name, signal in zip(signals.values(), fspa.signals, strict=True)}
    ranges |= {
        name: range_between(param.low, param.high) for name, param in zip(params.values(), fspa.params, strict=True)
    }
    ranges |= {DT: range_between(0.0, None)} if fspa.clock_varies else {}
    proved = prove_sample(computations, registers, ranges, booleans_now)
    # A function in the condition of a `when` may fail even if the result is always in range. So an atom that calls such
    # a function does not count as always in range.
    fails = {name for name, value in proved.items() if functions_called(value.statements) & FAILING}
    in_range = tuple(name not in fails and proved[name].lies_in(-1.0, 1.0) for name in atoms)
    sharp = [index for index, atom in enumerate(fspa.atoms) if flags and AtomValue(atom.name) in flags]
    guards = AtomVariables(atoms, frozenset(sharp), frozenset(booleans_now)) if registers else atoms
    state_cases = cases_and_tables(tables(fspa), guards)
    cases = state_cases.cases
    exclusive = tuple((number, group) for number, group in enumerate(fspa.exclusive) if len(group) > 1)
    updates = tuple(proved[name].statements for name in now)
    kept = variables_read(statement for update in updates for statement in update)
    eager = {atoms[atom] for _, group in exclusive for atom in group} | kept
    only = only_in(
        atoms,
        [is_in_range and name not in eager for name, is_in_range in zip(atoms, in_range, strict=True)],
        [case.statements for case in cases],
    )
    needed = tuple(() if place == -1 else proved[name].statements for name, place in zip(atoms, only, strict=True))
    every_step = tuple(step for step in order if step.kind == "register" or only[step.index] is None)
    return Program(
        fspa=fspa,
        signals=tuple(signals.values()),
        params=tuple(params.values()),
        atoms=atoms,
        registers=now,
        before=before,
        booleans=frozenset(
            variables[key] for key in booleans if isinstance(key, Before) or (isinstance(key, str) and key in signals)
        ),
        kept=tuple(
            Choice(ProgramVariable(name), Real(1.0), Real(-1.0)) if name in booleans_now else ProgramVariable(name)
            for name in now
        ),
        values=needed,
        always_in_range=in_range,
        ranges=ranges | proved_ranges(proved, atoms, registers),
        updates=updates,
        always_finite=tuple(name not in fails and proved[name].is_finite for name in now),
        every_step=every_step,
        only_in=only,
        read_in=_read_in(tuple(signals.values()), (*only, *(None for _ in now)), (*needed, *updates)),
        atom_comments=_atom_comments(fspa, only, every_step, len(cases)),
        register_comments=tuple(map(_register_comment, fspa.registers)),
        exclusive=exclusive,
        cases=cases,
        tables=state_cases.tables,
        failures=state_cases.failures,
        reward_statements=reward_step.statements(fspa),
        ends=tuple(ends_on_entry(fspa, state) for state in fspa.states),
    )


def _booleans(fspa: Fspa, flags: Flags, has_bools: bool) -> frozenset[VariableKey]:
    """Return the keys of the atoms and registers that have Boolean variables; if ``has_bools``, also of what is read.

    Monitors test exclusive atoms as numbers.
    """
    exclusive = {fspa.atoms[atom].name for group in fspa.exclusive if len(group) > 1 for atom in group}
    keys: list[VariableKey] = [AtomValue(atom.name) for atom in fspa.atoms if atom.name not in exclusive]
    keys += [register.name for register in fspa.registers]
    keys += [Before(register.name) for register in fspa.registers if has_bools]
    bools = [signal.name for signal in fspa.signals if signal.type == "bool" and has_bools]
    return frozenset((*(key for key in keys if key in flags), *bools))


def only_in(
    atoms: Sequence[str], silent: Sequence[bool], cases: Sequence[Iterable[Statement]]
) -> tuple[int | None, ...]:
    """Return for each atom the number of the only case that needs it.

    The number is -1 if no case needs the atom, and None if every step computes it. ``silent``
    says, for each atom, that its computation never gives an error or a notice, and that no register
    reads it. Every step computes the atoms that are not silent, so that all monitors give the same
    errors and notices. ``atoms`` are the variables of the atoms, and ``cases`` the statements of each case.
    """
    used = [variables_read(statements) for statements in cases]
    places: list[int | None] = []
    for name, is_silent in zip(atoms, silent, strict=True):
        readers = [number for number, names in enumerate(used) if name in names]
        places.append((readers or [-1])[0] if is_silent and len(readers) < 2 else None)
    return tuple(places)


def _read_in(
    signals: Sequence[str], only_in: Sequence[int | None], values: Sequence[Sequence[Statement]]
) -> tuple[int | None, ...]:
    """Return for each signal the number of the only case that reads it.

    The number is -1 if no atom and no register reads the signal. It is None if every step or several
    cases read it. ``only_in`` has the number of the only case that needs each atom or register, and
    ``values`` has their statements.
    """
    places: dict[str, set[int | None]] = {name: set() for name in signals}
    for only, statements in zip(only_in, values, strict=True):
        for name in variables_read(statements) & places.keys():
            places[name].add(only)
    return tuple((*readers, -1)[0] if len(readers) < 2 else None for readers in places.values())


def _register_comment(register: Register) -> str:
    unit = f", in {register.unit}" if register.unit else ""
    return f"Memory: {register.name}{unit}"


def _atom_comments(
    fspa: Fspa, only_in: Sequence[int | None], every_step: Sequence[Computation], case_count: int
) -> tuple[str, ...]:
    """Return the text of the comment of each atom: its name, and perhaps documentation.

    The documentation of a predicate is in the comment of only one of its atoms: the first in the
    generated code. In this code, the atoms that every step computes (``every_step``) come before those
    of single cases (``only_in``).
    """
    atom_comments = [atom.name for atom in fspa.atoms]
    explained = {""}
    eager = [step.index for step in every_step if step.kind == "atom"]
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
