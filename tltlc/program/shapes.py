"""Write the code of equal states once, and what differs between these states in tables.

States that count, as for ``for 10 s``, have edges with the same guards, which only lead to other
states. Such states have the same *shape*, and the statements for a shape serve all its states: they
read the next state and its progress from tables. Begin with `cases_and_tables`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Sequence
from itertools import accumulate
from typing import Final

from tltlc.automaton.text import label_text
from tltlc.core.record import record
from tltlc.monitor.tables import MonitorTables
from tltlc.program.compact_states import AtomVariables, CompactStateCode
from tltlc.program.label_texts import LabelTexts, split_labels
from tltlc.program.states import StateCode, edge_shape, shape_edges, state_edges
from tltlc.program.tree import Statement
from tltlc.resolve.spec import JudgeMode

_LEAST_STATES: Final = 64
"""The fewest states for which there are tables: the code of fewer states is easier to read without them."""
_MOST_CODE: Final = 0.5
"""The most edges that all shapes together may have for there to be tables, as a share of all edges.

With few states per shape, tables would save little.
"""


@record
class Case:
    """The statements that compute the transition from one state, or from all states of one shape.

    ``comment`` is the text of a comment on them. They assign the variables of
    :mod:`tltlc.program.states`. With tables, they read the variable ``FIRST_EDGE``.
    """

    comment: str
    statements: tuple[Statement, ...]


@record
class TransitionCase:
    """The statements that find the next state of each of the states, or shapes of states, with these ``numbers``."""

    numbers: tuple[int, ...]
    statements: tuple[Statement, ...]


@record
class StateTables:
    """The tables of an automaton whose states share code.

    - ``state_shapes`` has the number of each state's shape.
    - ``first_edges`` has, for each state, the index in ``edge_targets`` of the target of its first
      edge. The targets of its other edges follow.
    - ``edge_targets`` has the targets of all edges: numbers of states.
    - ``state_levels`` has, for each state, the index of its progress in ``level_progress``, which has
      each value once, in ascending order. The progress of a state is in [0, 1].
    - ``state_kinds`` has the number of each state's kind. States of a kind have the same verdict,
      the same acceptance, and either all of them or none end an episode when they are entered.
    - ``kind_states`` has, for each kind, the number of its first state.
    - ``labels`` has the labels of all states, and ``labels_english`` has them in words.
    """

    state_shapes: tuple[int, ...]
    first_edges: tuple[int, ...]
    edge_targets: tuple[int, ...]
    state_levels: tuple[int, ...]
    level_progress: tuple[float, ...]
    state_kinds: tuple[int, ...]
    kind_states: tuple[int, ...]
    labels: LabelTexts
    labels_english: LabelTexts

    def step_tables(self, judge: JudgeMode) -> dict[str, tuple[float, ...]]:
        """Return the tables that a step reads, by name, if the spec is judged as ``judge`` says.

        All are tables of integers, except ``level_progress``.
        """
        names = ["state_kinds", "state_shapes", "first_edges", "edge_targets"]
        names += ["state_levels", "level_progress"] if judge == "goal" else []
        return {name: getattr(self, name) for name in names}

    def all_tables(self, judge: JudgeMode) -> dict[str, tuple[float, ...]]:
        """Return the tables that a step reads, and those of integers from which labels are made, by name."""
        labels = {"state_texts": self.labels.state_texts, "label_numbers": self.labels.numbers}
        english = {"english_states": self.labels_english.state_texts, "english_numbers": self.labels_english.numbers}
        return {**self.step_tables(judge), **labels, **english}


@record
class StateCases:
    """The cases of the states, or of the shapes of states if there are ``tables``.

    ``failures`` is :attr:`~tltlc.program.states.StateCode.failures`, in the order of the numbers.
    """

    cases: tuple[Case, ...]
    tables: StateTables | None
    failures: tuple[tuple[int | None, int | None], ...]


def cases_and_tables(monitor: MonitorTables, atoms: Sequence[str] | AtomVariables) -> StateCases:
    """Return a case for each state, or a case for each shape of states and their tables.

    There are tables if the automaton has at least 64 states, and its shapes have at most half as many
    edges as its states: then tables are smaller. ``atoms`` are the names of the variables with the
    values of the atoms, or these variables with what is known about them, for more compact statements.
    """
    states = monitor.fspa.states
    if len(states) >= _LEAST_STATES:
        edges = [shape_edges(monitor, state.id) for state in states]
        shapes, examples = _numbered([tuple(edge_shape(monitor, edge) for edge in leaving) for leaving in edges])
        if sum(len(edges[example]) for example in examples) <= _MOST_CODE * len(monitor.fspa.edges):
            counts = Counter(shapes)
            shape_code = _state_code(monitor, atoms, reads_tables=True)
            cases = tuple(
                Case(
                    _shape_comment(str(states[example].label), counts[shape]),
                    shape_code.statements(edges[example]),
                )
                for shape, example in enumerate(examples)
            )
            levels = sorted(set(monitor.base_progress))
            level_of = {progress: level for level, progress in enumerate(levels)}
            kinds, kind_states = _numbered(
                [(state.verdict, state.accepting, monitor.ends_on_entry[state.id]) for state in states]
            )
            state_tables = StateTables(
                state_shapes=shapes,
                first_edges=(0, *accumulate(map(len, edges[:-1]))),
                edge_targets=tuple(edge.target for leaving in edges for edge in leaving),
                state_levels=tuple(level_of[progress] for progress in monitor.base_progress),
                level_progress=tuple(levels),
                state_kinds=kinds,
                kind_states=kind_states,
                labels=split_labels([str(state.label) for state in states]),
                labels_english=split_labels([label_text(monitor.fspa, state.id) for state in states]),
            )
            return StateCases(cases, state_tables, tuple(shape_code.failures))
    code = _state_code(monitor, atoms, reads_tables=False)
    cases = tuple(Case(str(state.label), code.statements(state_edges(monitor, state.id))) for state in states)
    return StateCases(cases, None, tuple(code.failures))


def transition_cases(
    monitor: MonitorTables, atoms: AtomVariables, state_tables: StateTables | None, *, compact: bool
) -> tuple[TransitionCase, ...]:
    """Return the cases that find the next state of each state or, with ``state_tables``, of each shape.

    If ``compact``, guards are tested with fewer literals.
    """
    reads_tables = state_tables is not None
    code: StateCode
    if compact:
        code = CompactStateCode(monitor, atoms, reads_tables=reads_tables)
    else:
        code = StateCode(monitor, atoms.names, atoms.booleans, reads_tables=reads_tables)
    if state_tables is None:
        edges = [state_edges(monitor, state.id) for state in monitor.fspa.states]
    else:
        examples = {shape: state for state, shape in reversed([*enumerate(state_tables.state_shapes)])}
        edges = [shape_edges(monitor, examples[shape]) for shape in range(len(examples))]
    numbers: dict[tuple[Statement, ...], list[int]] = {}
    for number, leaving in enumerate(edges):
        numbers.setdefault(code.transition(leaving), []).append(number)
    return tuple(TransitionCase(tuple(group), statements) for statements, group in numbers.items())


def _state_code(monitor: MonitorTables, atoms: Sequence[str] | AtomVariables, *, reads_tables: bool) -> StateCode:
    if isinstance(atoms, AtomVariables):
        return CompactStateCode(monitor, atoms, reads_tables=reads_tables)
    return StateCode(monitor, atoms, reads_tables=reads_tables)


def _shape_comment(label: str, count: int) -> str:
    return label if count == 1 else f"{count} states, such as {label}"


def _numbered(keys: Sequence[Hashable]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the number of each key, counted from 0 in the order of first keys, and the index of each first key."""
    firsts: dict[Hashable, int] = {}
    for index, key in enumerate(keys):
        firsts.setdefault(key, index)
    numbers = {key: number for number, key in enumerate(firsts)}
    return tuple(numbers[key] for key in keys), tuple(firsts.values())
