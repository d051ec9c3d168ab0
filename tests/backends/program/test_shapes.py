from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.automaton.letters import letters
from tests.backends.program.interpreter import Scope, failure_names, step
from tests.backends.state_tables import counting, in_order, with_tables
from tests.backends.strategies import automata, infinite_automata
from tests.fuzzing import times
from tests.unfolded import unfolded
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.monitor import Monitor
from tltlc.program.build import Program, program
from tltlc.program.label_texts import LabelTexts, split_labels
from tltlc.program.states import FIRST_EDGE


def labels_of(texts: LabelTexts) -> list[str]:
    numbers = iter(texts.numbers)
    labels = []
    for text in texts.state_texts:
        label, *pieces = texts.texts[text]
        labels.append(label + "".join(f"{next(numbers)}{piece}" for piece in pieces))
    assert next(numbers, None) is None
    return labels


@times(40)
@given(automata() | infinite_automata(), st.data())
def test_steps_that_read_tables_agree_with_the_monitor(fspa: Fspa, data: st.DataObject) -> None:
    limit = data.draw(st.none() | st.integers(1, 5))
    fspa = replace(fspa, limit_steps=limit, judge=data.draw(st.sampled_from(("goal", "limit"))))
    with with_tables():
        compiled = program(fspa, ())
    assert compiled.tables is not None
    monitor = Monitor(fspa)
    state, best, done = 0, 0.0, False
    for number in range(1, 8):
        letter = data.draw(st.sampled_from(letters(fspa)))
        sample = [(1 if holds else -1) * data.draw(st.sampled_from([1.0, 0.5, 0.25])) for holds in letter]
        sample = [0.0 if value == -0.25 else value for value in sample]
        outcome = step(compiled, state, number, best, done, dict(zip(compiled.atoms, sample, strict=True)))
        row = monitor.step_atoms(sample)
        limiting = None if outcome["limiting"] < 0 else fspa.atoms[int(outcome["limiting"])].name
        state, best, done = int(outcome["target"]), float(outcome["best"]), bool(outcome["done"])
        assert (state, best, done) == (row.state, row.progress, row.done)
        assert (outcome["reward"], outcome["robustness"], limiting) == (row.reward, row.robustness, row.limiting)
        if row.failed_step in (None, number):
            assert failure_names(compiled, outcome) == (row.failed_clause, row.failed_atom)


@times(40)
@given(automata() | infinite_automata())
def test_states_of_a_kind_agree_in_all_but_their_labels(fspa: Fspa) -> None:
    with with_tables():
        compiled = program(fspa, ())
    tables = compiled.tables
    assert tables is not None
    assert labels_of(tables.labels) == [str(state.label) for state in fspa.states]
    for state, kind in zip(fspa.states, tables.state_kinds, strict=True):
        example = tables.kind_states[kind]
        other = fspa.states[example]
        assert (state.verdict, state.accepting) == (other.verdict, other.accepting)
        assert compiled.ends[state.id] == compiled.ends[example]


def work_of_a_step(compiled: Program, state: int, atoms: dict[str, float]) -> tuple[int, int]:
    """Return how many cases there are to choose from, and how many entries of tables one step reads."""
    tables = compiled.tables
    assert tables is not None
    scope = Scope({**atoms, FIRST_EDGE: tables.first_edges[state]}, tables)
    scope.run(compiled.cases[tables.state_shapes[state]].statements)
    return len(compiled.cases), scope.look_ups


def test_a_step_from_any_counting_state_does_the_same_work() -> None:
    compiled = program(counting(), ())
    tables = compiled.tables
    assert tables is not None
    assert Counter(tables.state_shapes) == {0: 1, 1: 600, 2: 1}
    work = {
        work_of_a_step(compiled, state, {compiled.atoms[0]: value}) for state in range(602) for value in (1.0, -1.0)
    }
    assert work == {(3, 1)}


def test_an_atom_that_only_one_shape_needs_is_computed_there() -> None:
    rule = "spec quiet { require next always for 10 s quiet }"
    with unfolded():
        (fspa,) = compile_text(f"clock 60 Hz\nsignal quiet: bool\n{rule}\n")
    compiled = program(fspa, ())
    assert compiled.tables is not None
    assert compiled.only_in == (1,)


def test_few_states_have_no_tables() -> None:
    few, many = (program(counting(seconds), ()) for seconds in (1.0, 1.1))
    assert (len(few.fspa.states), few.tables) == (62, None)
    assert few.tables is None
    assert len(few.cases) == 62
    assert len(many.fspa.states) == 68
    assert many.tables is not None


def test_states_that_share_no_code_have_no_tables() -> None:
    compiled = program(in_order(70), ())
    assert compiled.tables is None
    assert len(compiled.cases) == len(compiled.fspa.states) == 71


@pytest.mark.parametrize(
    ("labels", "texts", "numbers"),
    [
        (["G[0,5] a", "G[0,4] a", "false"], (("G[0,", "] a"), ("false",)), (5, 4)),
        (["near(s1)", "near(s2) & b", "near(s3)"], (("near(s", ")"), ("near(s2) & b",)), (1, 3)),
        (["x01", "x02", "x3"], (("x01",), ("x02",), ("x3",)), ()),
        (["1234567890 a", "1234567891 a"], (("1234567890 a",), ("1234567891 a",)), ()),
        (["F[0,9] a & G[3,7] b", "F[1,9] a & G[3,6] b"], (("F[", ",9] a & G[3,", "] b"),), (0, 7, 1, 6)),
        (["7"], (("7",),), ()),
        (["7", "8"], (("", ""),), (7, 8)),
    ],
)
def test_texts_of_labels(labels: list[str], texts: tuple[tuple[str, ...], ...], numbers: tuple[int, ...]) -> None:
    split = split_labels(labels)
    assert (split.texts, split.numbers) == (texts, numbers)
    assert labels_of(split) == labels


@given(st.lists(st.text("ab01239 ٣", max_size=8), max_size=6))
def test_labels_can_be_made_from_their_texts(labels: list[str]) -> None:
    assert labels_of(split_labels(labels)) == labels
