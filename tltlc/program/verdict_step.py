"""The program of a step that finds only the next state and its verdict.

It takes the same transitions as the program of :mod:`tltlc.program.build`, and refuses the same samples, but it
computes no robustness, progress or limiting atom. Of atoms and registers it computes only whether they are above 0,
where nothing else is needed (:mod:`tltlc.program.truth_forms`). Registers that are whole numbers are integers
(:mod:`tltlc.program.counts`). What no guard needs is not computed, unless it may break a rule of the sample.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from tltlc.automaton.memory import Computation, schedule
from tltlc.core.record import record
from tltlc.monitor.tables import tables
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import Program, only_in
from tltlc.program.compact_states import AtomVariables
from tltlc.program.counts import CountCandidate, Counts
from tltlc.program.shapes import TransitionCase, transition_cases
from tltlc.program.tree import ProgramExpression, Statement, Type
from tltlc.program.truth_forms import TruthForms
from tltlc.program.used_names import names_in, variables_read


@record
class KeptRegister:
    """A register that a step reads: its number, its variables before and after a sample, their type, and the start."""

    index: int
    before: str
    now: str
    type: Type
    initial: float


@record
class VerdictStep:
    """A step that finds only the next state and its verdict.

    - ``values`` and ``updates`` have, for each atom and register, the statements that declare and compute its
      variable; none if it is not needed.
    - ``every_step`` has what every step computes, in order. ``only_in`` has, for each atom, the number of the only case
      that computes it; it is None if every step does, and -1 if none does.
    - ``exclusive`` has, for each group of at least two exclusive atoms, its index, and for each of its atoms the test
      whether it holds.
    - ``kept`` has the registers that a step reads, and ``bools`` the bool signals, with the types of their variables:
      numbers are 0 or 1.
    - ``cases`` has the statements that find the next state.
    """

    values: tuple[tuple[Statement, ...], ...]
    updates: tuple[tuple[Statement, ...], ...]
    every_step: tuple[Computation, ...]
    only_in: tuple[int | None, ...]
    exclusive: tuple[tuple[int, Mapping[int, ProgramExpression]], ...]
    kept: tuple[KeptRegister, ...]
    bools: Mapping[str, Type]
    cases: tuple[TransitionCase, ...]

    def computed_in(self, case: int) -> list[int]:
        """Return the indices of the atoms that are computed only in this case."""
        return [index for index, only in enumerate(self.only_in) if only == case]

    @property
    def variables_used(self) -> frozenset[str]:
        """The names of the variables that the statements in ``values`` and ``updates`` read."""
        return variables_read(statement for value in (*self.values, *self.updates) for statement in value)


def verdict_step(program: Program) -> VerdictStep:
    """Return the step that finds only state and verdict, given the program of the whole step."""
    fspa, twins = program.fspa, dict(zip(program.before, program.registers, strict=True))
    computations = dict(_computations(program))
    forms = TruthForms(program, computations)
    booleans = frozenset(program.atoms) - forms.numbers
    atoms = AtomVariables(program.atoms, frozenset(range(len(program.atoms))), booleans)
    cases = transition_cases(tables(fspa), atoms, program.tables, compact=bool(fspa.registers))
    exclusive = tuple(
        (number, {atom: forms.holds(program.atoms[atom]) for atom in group}) for number, group in program.exclusive
    )
    eager = names_in(test for _, tests in exclusive for test in tests.values())
    eager |= computations.keys() - program.unchecked
    needed = _needed(forms.statements, eager | variables_read(s for case in cases for s in case.statements), twins)
    computed = {name: statements for name, statements in forms.statements.items() if name in needed}
    candidates = [register for register in _candidates(program) if {register.now, register.before} <= forms.numbers]
    counts = Counts(computed, candidates)
    computed = {name: counts.statements(statements) for name, statements in computed.items()}
    read = variables_read(statement for statements in computed.values() for statement in statements)
    unread = [name not in eager | read for name in program.atoms]
    only = only_in(program.atoms, unread, [case.statements for case in cases])
    types: dict[str, Type] = {name: "int" if name in counts.names else "real" for name in forms.numbers}
    types |= dict.fromkeys(forms.bool_numbers, "real")
    order = schedule(fspa)
    signals = zip(fspa.signals, program.signals, strict=True)
    registers = enumerate(zip(fspa.registers, program.before, program.registers, strict=True))
    return VerdictStep(
        values=tuple(computed.get(name, ()) for name in program.atoms),
        updates=tuple(computed.get(name, ()) for name in program.registers),
        every_step=tuple(
            step
            for step in order
            if (program.registers[step.index] in needed if step.kind == "register" else only[step.index] is None)
        ),
        only_in=only,
        exclusive=exclusive,
        kept=tuple(
            KeptRegister(index, before, now, types.get(before, "bool"), register.initial)
            for index, (register, before, now) in registers
            if before in read
        ),
        bools={name: types.get(name, "bool") for signal, name in signals if signal.type == "bool" and name in read},
        cases=cases,
    )


def _computations(program: Program) -> Iterator[tuple[str, tuple[Statement, ...]]]:
    """Yield the variables of atoms and registers, in order, with the statements that declare and compute them."""
    for step in schedule(program.fspa):
        is_atom = step.kind == "atom"
        name = (program.atoms if is_atom else program.registers)[step.index]
        statements = (program.values if is_atom else program.updates)[step.index]
        if statements:
            yield name, with_declaration(name, statements, changes=False)


def _needed(
    statements: Mapping[str, Sequence[Statement]], needed: Collection[str], twins: Mapping[str, str]
) -> frozenset[str]:
    """Return the variables of atoms and registers that must be computed for those in ``needed``.

    ``twins`` maps the variables of registers before a sample to those after it.
    """
    found: dict[str, None] = {}
    open_ = [name for name in needed if name in statements]
    while open_:
        name = open_.pop()
        if name in found:
            continue
        found[name] = None
        read = (twins.get(variable, variable) for variable in variables_read(statements[name]))
        open_ += [variable for variable in read if variable in statements]
    return frozenset(found)


def _candidates(program: Program) -> Iterator[CountCandidate]:
    for register, before, now in zip(program.fspa.registers, program.before, program.registers, strict=True):
        ranges = [program.ranges[name] for name in (before, now) if name in program.ranges]
        if register.initial.is_integer() and len(ranges) == 2:
            magnitude = max(abs(end) for range_ in ranges for end in (range_.low, range_.high))
            yield CountCandidate(before, now, magnitude)
