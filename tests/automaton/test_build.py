"""The automaton agrees with the oracle, and with brute force on every claim of its section in ``docs/semantics.md``."""

from __future__ import annotations

import os
import subprocess
import sys
from itertools import islice
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.automaton.letters import holds, letters, minimal_size, named, run, table, traces
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc import compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.logic import oracle
from tltlc.logic.formula import Formula

SMALL = formulas(atoms=("a", "b"), max_leaves=6)
WIDE = formulas(atoms=("a", "b", "c"), max_leaves=8)
GROUPS = st.sampled_from([(), (("a", "b"),), (("a", "b", "c"),), (("a", "b"), ("b", "c"))])


def compiled(formula: Formula | str, *exclusive: tuple[str, ...]) -> Fspa:
    if isinstance(formula, str):
        formula = read_formula(formula)
    return build(spec_from_formula(formula, exclusive=exclusive))


def labels(fspa: Fspa) -> list[str]:
    return [str(state.label) for state in fspa.states]


# --- the language ---------------------------------------------------------------------------------


@given(SMALL)
@times(100)
def test_accepts_the_traces_on_which_the_formula_holds(formula: Formula) -> None:
    fspa = compiled(formula)
    for trace in traces(fspa, 4):
        assert fspa.states[run(fspa, trace)].accepting == oracle.holds(formula, named(fspa, trace)), trace


@given(WIDE, GROUPS)
@times(60)
def test_accepts_the_right_traces_if_atoms_are_exclusive(formula: Formula, groups: tuple[tuple[str, ...], ...]) -> None:
    fspa = compiled(formula, *groups)
    for trace in islice(traces(fspa, 3), 600):
        assert fspa.states[run(fspa, trace)].accepting == oracle.holds(formula, named(fspa, trace)), trace


@given(WIDE, GROUPS)
@times(60)
def test_automata_are_complete_deterministic_and_minimal(formula: Formula, groups: tuple[tuple[str, ...], ...]) -> None:
    """No automaton of this language is smaller, whether or not it accepts the empty trace (size convention)."""
    fspa = compiled(formula, *groups)
    table(fspa)  # asserts that exactly one guard is true of each letter
    accepting = {state.id for state in fspa.states if state.accepting}
    assert len(fspa.states) == minimal_size(fspa, accepting)
    with_initial_split = _initial_split(fspa)
    for empty_accepted in (False, True):
        marked = accepting | ({len(fspa.states)} if empty_accepted else set())
        assert len(fspa.states) <= _minimal_from(with_initial_split, marked)


def _initial_split(fspa: Fspa) -> dict[int, list[int]]:
    """Return the transition table with a new initial state, the last one, that has the moves of state 0."""
    moves = {state: list(row.values()) for state, row in table(fspa).items()}
    return moves | {len(fspa.states): moves[0]}


def _minimal_from(moves: dict[int, list[int]], accepting: set[int]) -> int:
    initial = len(moves) - 1
    reached, queue = {initial}, [initial]
    for state in queue:
        for target in moves[state]:
            if target not in reached:
                reached.add(target)
                queue.append(target)
    block = {state: int(state in accepting) for state in reached}
    while True:
        signature = {state: (block[state], *(block[target] for target in moves[state])) for state in reached}
        numbers = {key: number for number, key in enumerate(dict.fromkeys(signature.values()))}
        if len(numbers) == len(set(block.values())):
            return len(numbers)
        block = {state: numbers[key] for state, key in signature.items()}


@pytest.mark.parametrize(("text", "empty"), [("F a & F b", False), ("G a", True), ("X true", False), ("a", False)])
def test_the_initial_state_rejects_the_empty_trace_unless_that_costs_a_state(text: str, empty: bool) -> None:
    assert compiled(text).states[0].accepting is empty


@pytest.mark.parametrize("clock", ["60 Hz", "varies"])
@pytest.mark.parametrize(
    ("clauses", "verdict"),
    [
        ("keep within 9 s of a, b", "holding"),
        ("keep eventually within 9 s b", "holding"),
        ("keep within 9 s of a, b  keep eventually c", "holding"),
        ("keep within 9 s of a, b  reach c", "pending"),
        # The last sample must have c: the obligation is the same before and after it.
        ("keep within 9 s of a, b  require F(c & !X true)", "pending"),
        ("keep within 9 s of a, b  require c", "pending"),
    ],
)
def test_no_answer_is_due_in_the_initial_state(clauses: str, verdict: str, clock: str) -> None:
    (fspa,) = compile_text(f"clock {clock} signal a: bool signal b: bool signal c: bool spec s {{ {clauses} }}")
    assert "due" in [register.kind for register in fspa.registers]
    assert fspa.states[0].verdict == verdict


@pytest.mark.parametrize(
    "text",
    [
        "F(a & X F(b & X F a)) | F(b & X F a) & G(a | N G b)",
        "F(a & F b & X F(a & b)) & !F(b & X F a)",
        "G(a | N G(b | N G a)) & (F b | G a)",
        "G(a | G b | N G(a | b)) <-> F(b & X F a)",
        "(a U (b U F a)) & (G a | (b R G(a | b))) | F(a M (b & F a))",
    ],
)
def test_accepts_the_right_traces_for_nested_formulas_that_imply_each_other(text: str) -> None:
    fspa = compiled(text)
    for trace in traces(fspa, 5):
        assert fspa.states[run(fspa, trace)].accepting == oracle.holds(read_formula(text), named(fspa, trace)), trace


# --- distances, verdicts, order -------------------------------------------------------------------


@given(WIDE, GROUPS)
@times(60)
def test_distances_and_verdicts_match_reachability(formula: Formula, groups: tuple[tuple[str, ...], ...]) -> None:
    fspa = compiled(formula, *groups)
    moves = table(fspa)
    for state in fspa.states:
        layers, seen = [{state.id}], {state.id}
        while layers[-1]:
            layers.append({target for source in layers[-1] for target in moves[source].values()} - seen)
            seen |= layers[-1]
        depths = [depth for depth, layer in enumerate(layers) if any(fspa.states[q].accepting for q in layer)]
        assert state.distance == (min(depths) if depths else None)
        if not depths:
            expected = "violated"
        elif all(fspa.states[reached].accepting for reached in seen):
            expected = "satisfied"
        else:
            expected = "holding" if state.accepting else "pending"
        assert state.verdict == expected
    assert fspa.spec_size == max((state.distance or 0 for state in fspa.states), default=0)


@given(WIDE)
@times(40)
def test_states_are_numbered_breadth_first_and_edges_sorted(formula: Formula) -> None:
    fspa = compiled(formula)
    pairs = [(edge.source, edge.target) for edge in fspa.edges]
    assert pairs == sorted(set(pairs))
    depth = {0: 0}
    for source, target in sorted(pairs, key=lambda pair: pair[0]):
        depth.setdefault(target, depth[source] + 1)
    assert [depth[state.id] for state in fspa.states] == sorted(depth.values())


@given(WIDE)
@settings(max_examples=50)
def test_equal_input_gives_equal_output(formula: Formula) -> None:
    assert compiled(formula) == compiled(formula)


def test_output_does_not_depend_on_the_hash_seed() -> None:
    program = """
from tests.reference_formulas import corpus
from tltlc import compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
small = [entry.formula for entry in corpus() if entry.states is not None and entry.states <= 12]
print([build(spec_from_formula(formula)) for formula in small])
"""
    root = Path(__file__).parents[2]
    outputs = set()
    for seed in ("0", "1"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        result = subprocess.run(
            [sys.executable, "-c", program], env=environment, cwd=root, capture_output=True, check=True
        )
        outputs.add(result.stdout)
    assert len(outputs) == 1


# --- guards ---------------------------------------------------------------------------------------


@given(WIDE, GROUPS)
@times(40)
def test_guards_have_all_primes_and_a_formula_that_means_the_same(
    formula: Formula, groups: tuple[tuple[str, ...], ...]
) -> None:
    fspa = compiled(formula, *groups)
    possible = letters(fspa)
    for edge in fspa.edges:
        taken = {letter for letter in possible if holds(edge, letter)}
        assert set(edge.guard.primes) == _primes_by_brute_force(fspa, taken)
        guard = edge.guard.formula
        assert isinstance(guard, Formula)
        assert read_formula(str(guard)) is guard
        names = [atom.name for atom in fspa.atoms]
        for letter in possible:
            true = {name for name, value in zip(names, letter, strict=True) if value}
            assert oracle.holds(guard, [true]) == (letter in taken)


def _primes_by_brute_force(fspa: Fspa, taken: set[tuple[bool, ...]]) -> set[tuple[tuple[int, bool], ...]]:
    """Return all maximal cubes that lie in ``taken`` or the impossible letters and contain a possible letter."""
    count = len(fspa.atoms)
    possible = set(letters(fspa))
    implicants = []
    for code in range(3**count):
        cube = tuple((atom, bool(code // 3**atom % 3 - 1)) for atom in range(count) if code // 3**atom % 3)
        inside = {letter for letter in possible if all(letter[atom] == polarity for atom, polarity in cube)}
        # A cube lies in the guard or the impossible letters if and only if its possible letters are in the guard.
        if inside <= taken:
            implicants.append((cube, bool(inside)))
    prime = [(cube, meets) for cube, meets in implicants if not any(set(other) < set(cube) for other, _ in implicants)]
    return {cube for cube, meets in prime if meets}


# --- labels ---------------------------------------------------------------------------------------


@given(SMALL, st.sampled_from([(), (("a", "b"),)]))
@times(60)
def test_a_state_accepts_the_traces_on_which_its_label_holds(
    formula: Formula, groups: tuple[tuple[str, ...], ...]
) -> None:
    fspa = compiled(formula, *groups)
    for state in fspa.states:
        label = read_formula(str(state.label))
        for rest in traces(fspa, 3):
            after = fspa.states[run(fspa, rest, state.id)]
            assert after.accepting == oracle.holds(label, named(fspa, rest)), (state, rest)


def test_labels_of_cover_and_hide_are_those_of_the_paper() -> None:
    """Fig. 3 of Gutiérrez-Sánchez et al., IEEE Trans. Games 2024."""
    fspa = compiled("F(a & X F(b & X F c)) & G p")
    assert sorted(labels(fspa), key=len, reverse=True) == [
        "F(a & X F(b & X F c)) & G p",
        "F(b & X F c) & G p",
        "F c & G p",
        "false",
        "G p",
    ]
    assert fspa.spec_size == 3


@pytest.mark.parametrize(
    ("text", "states"),
    [
        ("F(s1 & X F(s2 & X F e)) & G p", 5),
        ("F(s1 & X F(s2 & X F e))", 4),
        ("F(s1 & X F(s2 & X F(s3 & X F((r & er) | (l & el))))) & G p", 6),
        ("F(s1 & X F(s2 & X F(s3 & X F((r -> er) & (l -> el))))) & G p", 6),
    ],
)
def test_automata_of_the_papers_specifications_have_its_sizes(text: str, states: int) -> None:
    assert len(compiled(text).states) == states


def test_labels_keep_the_operators_of_the_source() -> None:
    assert labels(compiled("F(a & X F((r -> er) & (l -> el)))")) == [
        "F(a & X F((r -> er) & (l -> el)))",
        "F((r -> er) & (l -> el))",
        "true",
    ]


def test_labels_are_shortened_where_the_automaton_proves_it() -> None:
    assert labels(compiled("F(a & F(b & F c))")) == ["F(a & F(b & F c))", "true", "F(b & F c)", "F c"]


@pytest.mark.parametrize("steps", [3, 10, 30, 60])
def test_labels_of_a_long_sequence_show_only_the_remaining_goals(steps: int) -> None:
    """In each state earlier goals are still open too, but the remaining goals imply them."""
    sequence = [f"F a{steps}"]
    for number in range(steps - 1, 0, -1):
        sequence.append(f"F(a{number} & X {sequence[-1]})")
    fspa = compiled(f"{sequence[-1]} & G p")
    assert set(labels(fspa)) == {*(f"{rest} & G p" for rest in sequence), "G p", "false"}


def test_labels_of_a_hundred_equal_goals_show_the_remaining_goals() -> None:
    sequence = ["F a"]
    for _ in range(99):
        sequence.append(f"F(a & X {sequence[-1]})")
    assert set(labels(compiled(sequence[-1]))) == {*sequence, "true"}


@pytest.mark.parametrize(
    ("text", "label", "accepting", "sentence"),
    [
        ("X true", "true", False, "The play must not end at this step."),
        ("N false", "false", True, "The play must end at this step."),
    ],
)
def test_the_english_label_says_whether_the_trace_must_go_on(
    text: str, label: str, accepting: bool, sentence: str
) -> None:
    fspa = compiled(text)
    state = next(state for state in fspa.states[1:] if state.accepting == accepting)
    assert (str(state.label), label_text(fspa, state.id)) == (label, sentence)


def test_a_repeated_atom_in_a_group_changes_nothing() -> None:
    assert compiled("F a & F b", ("a", "b", "a", "b")).edges == compiled("F a & F b", ("a", "b")).edges
    assert compiled("F a", ("a", "a")).edges == compiled("F a").edges


def test_exclusive_goals_cannot_be_reached_in_the_same_step() -> None:
    assert compiled("F a & F b").spec_size == 1
    assert compiled("F a & F b", ("a", "b")).spec_size == 2
