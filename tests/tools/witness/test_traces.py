"""Shortest traces and covers, checked against the formulas on all short traces."""

from __future__ import annotations

import io
from itertools import product
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tltlc
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.unfolded import unfolded
from tltlc.automaton.compare import Letter
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.core.source import SourceFile
from tltlc.logic.formula import Formula
from tltlc.logic.oracle import all_traces, holds
from tltlc.logic.text.printer import ascii_text
from tltlc.monitor import Monitor
from tltlc.monitor.guards import holds as guard_holds
from tltlc.monitor.traces import read_trace
from tltlc.pipeline import compile_source
from tltlc.tools.witness import blocks
from tltlc.tools.witness import text as witness_text
from tltlc.tools.witness.cover import Cover, cover
from tltlc.tools.witness.traces import Witness, accepting_trace, rejecting_trace
from tltlc.tools.witness.transitions import Moves, SampledEdge
from tltlc.tools.witness.wanted_edges import WantedEdges

ROOT = Path(__file__).parents[3]
EXAMPLES = sorted((ROOT / "examples").glob("*.tltl"))
LIBRARIES = sorted((ROOT / "stdlib_predicates").glob("*_tests.tltl"))
SMALL = formulas(atoms=("a", "b"), max_leaves=4)
LONGEST = 4
SIGNALS = "signal a: bool\nsignal b: bool\n"


def finite(formula: Formula) -> Fspa:
    (fspa,) = tltlc.compile_text(f"{SIGNALS}spec s = {ascii_text(formula)}")
    return fspa


@times(60)
@given(SMALL)
def test_an_accepting_trace_is_accepted_and_shortest(formula: Formula) -> None:
    witness = accepting_trace(Moves(finite(formula)))
    accepted = [trace for trace in all_traces(("a", "b"), LONGEST) if holds(formula, trace)]
    if witness is None:
        assert not accepted
        return
    assert holds(formula, witness.letters)
    assert all(len(witness.letters) <= len(trace) for trace in accepted)
    assert accepted or len(witness.letters) > LONGEST


@times(40)
@given(SMALL)
def test_a_rejecting_trace_is_shortest_and_no_suffix_is_accepted(formula: Formula) -> None:
    fspa = finite(formula)
    witness = rejecting_trace(Moves(fspa))
    rejected = [trace for trace in all_traces(("a", "b"), 3) if not holds(formula, trace)]
    if witness is None:
        assert not rejected
        return
    assert not holds(formula, witness.letters)
    lengths = [len(trace) for trace in all_traces(("a", "b"), LONGEST) if run(fspa, trace) == "violated"]
    if "violated" in {state.verdict for state in fspa.states}:
        assert run(fspa, witness.letters) == "violated"
        assert len(witness.letters) <= min(lengths, default=len(witness.letters))
        for suffix in all_traces(("a", "b"), 2):
            assert not holds(formula, (*witness.letters, *suffix))
    else:
        assert all(len(witness.letters) <= len(trace) for trace in rejected)


def run(fspa: Fspa, letters: tuple[Letter, ...]) -> str:
    monitor = Monitor(fspa)
    return [monitor.step_atoms(blocks.letter_values(fspa, letter)).verdict for letter in letters][-1]


@times(40)
@given(SMALL)
def test_an_infinite_witness_is_accepted_or_rejected_by_the_formula(formula: Formula) -> None:
    text = f"{SIGNALS}spec s {{ semantics infinite  require {ascii_text(formula)} }}"
    (fspa,) = tltlc.compile_text(text)
    for search, is_accepted in ((accepting_trace, True), (rejecting_trace, False)):
        witness = search(Moves(fspa))
        if witness is not None:
            assert witness.cycle is not None
            prefix, cycle = witness.letters[: witness.cycle], witness.letters[witness.cycle :]
            assert holds_on_lasso(formula, prefix, cycle) == is_accepted
            continue
        letters = [frozenset(names) for names in ((), ("a",), ("b",), ("a", "b"))]
        for before, after in ((0, 1), (1, 1), (0, 2), (1, 2)):
            for trace in product(letters, repeat=before + after):
                assert holds_on_lasso(formula, trace[:before], trace[before:]) != is_accepted


@times(40)
@given(SMALL)
def test_a_cover_takes_every_edge(formula: Formula) -> None:
    fspa = finite(formula)
    check_cover(fspa, cover(Moves(fspa)))


@times(40)
@given(
    formulas(atoms=("a", "b", "c"), max_leaves=4),
    st.sampled_from(["", "exclusive a, b\n", "exclusive a, b, c\n"]),
    st.sampled_from(["", "judge at limit  limit 3 steps", "semantics infinite"]),
    st.sampled_from(["", "require F[0,2] c", "require G[0,2] (a -> F[0,1] b)"]),
)
def test_covers_and_tests_of_all_kinds_of_specs_are_valid(
    formula: Formula, exclusive: str, setting: str, clause: str
) -> None:
    text = f"{SIGNALS}signal c: bool\n{exclusive}spec s {{ {setting}  require {ascii_text(formula)}  {clause} }}\n"
    source = SourceFile("s.tltl", text)
    (fspa,) = compile_source(source).automata
    moves = Moves(fspa)
    covering = cover(moves)
    assert not covering.untaken
    check_cover(fspa, covering)
    if fspa.atoms:
        traces = [
            *covering.traces,
            *(witness for witness in (accepting_trace(moves), rejecting_trace(moves)) if witness),
        ]
        check_blocks(source, fspa, traces)
        for trace in traces:
            check_csv(fspa, trace)


@pytest.mark.parametrize("path", [*EXAMPLES, *LIBRARIES], ids=lambda path: path.stem)
def test_witnesses_of_the_examples_are_valid(path: Path) -> None:
    source = SourceFile(str(path), path.read_text(encoding="utf-8"))
    for fspa in compile_source(source).automata:
        if fspa.registers:
            continue  # Traces of these are not only letters: `tests/memory/test_tools.py` checks them.
        moves = Moves(fspa)
        covering = cover(moves)
        assert not covering.untaken
        check_cover(fspa, covering)
        witnesses = [accepting_trace(moves), rejecting_trace(moves), *covering.traces]
        traces = [trace for trace in witnesses if trace is not None]
        check_blocks(source, fspa, traces)
        for trace in traces:
            check_csv(fspa, trace)
        assert (witnesses[0] is not None) and (witnesses[1] is not None)


def check_cover(fspa: Fspa, covering: Cover) -> None:
    """Assert that the traces take every edge, are sorted by length, and are no more than the edges."""
    taken = set()
    for trace in covering.traces:
        monitor = Monitor(fspa)
        for letter in trace.letters:
            source = monitor.state
            taken.add((source, monitor.step_atoms(blocks.letter_values(fspa, letter)).state))
    assert taken == {(edge.source, edge.target) for edge in fspa.edges}
    assert [len(trace.moves) for trace in covering.traces] == sorted(len(trace.moves) for trace in covering.traces)
    assert len(covering.traces) <= len(fspa.edges)


def check_blocks(source: SourceFile, fspa: Fspa, traces: list[Witness]) -> None:
    """Assert that the blocks pass when pasted into the file."""
    from tltlc.monitor.spec_tests import run_tests

    texts = [witness_text.as_test(fspa, trace, f"witness {number}") for number, trace in enumerate(traces)]
    compiled = compile_source(SourceFile(source.name, "\n".join([source.text, *texts])))
    results = [
        result for result in run_tests(compiled.program, compiled.automata) if result.test.title.startswith("witness")
    ]
    assert len(results) == len(traces)
    assert [result.failure for result in results] == [None] * len(traces)


def check_csv(fspa: Fspa, trace: Witness) -> None:
    """Assert that the samples produce the letters, and that a monitor judges both alike."""
    text = witness_text.as_csv(fspa, trace)
    by_signals, by_atoms = Monitor(fspa), Monitor(fspa)
    samples = list(read_trace(io.BytesIO(text.encode()), "trace", fspa.signals))
    assert len(samples) == len(trace.letters)
    for sample, letter in zip(samples, trace.letters, strict=True):
        signal_step, atom_step = by_signals.step(sample), by_atoms.step_atoms(blocks.letter_values(fspa, letter))
        assert (signal_step.state, signal_step.verdict) == (atom_step.state, atom_step.verdict)
        assert signal_step.accepting == atom_step.accepting
        assert {atom.name for atom, value in zip(fspa.atoms, by_signals.values, strict=True) if value > 0} == letter
    assert not by_signals.notices


@times(60)
@given(
    formulas(atoms=("a", "b", "c"), max_leaves=6),
    st.sampled_from(["", "exclusive a, b\n"]),
    st.sampled_from(["", "semantics infinite"]),
)
def test_a_cover_equals_that_of_a_breadth_first_search_per_path(formula: Formula, exclusive: str, setting: str) -> None:
    text = f"{SIGNALS}signal c: bool\n{exclusive}spec s {{ {setting}  require {ascii_text(formula)} }}"
    (fspa,) = tltlc.compile_text(text)
    moves = Moves(fspa)
    assert [trace.moves for trace in cover(moves).traces] == searched_cover(moves)


def searched_cover(moves: Moves) -> list[tuple[SampledEdge, ...]]:
    """Return the traces of a cover, computed with one breadth-first search per path."""
    untaken, traces = set(range(len(moves.fspa.edges))), []
    while True:
        trace: list[SampledEdge] = []
        while path := moves.shortest_path(
            moves.fspa.edges[trace[-1].edge].target if trace else 0, untaken.__contains__
        ):
            trace += path
            untaken.difference_update(move.edge for move in path)
        if not trace:
            return sorted(traces, key=len)
        traces.append(tuple(trace))


def edges_leaving(fspa: Fspa) -> list[list[tuple[int, int]]]:
    leaving: list[list[tuple[int, int]]] = [[] for _ in fspa.states]
    for index, edge in enumerate(fspa.edges):
        leaving[edge.source].append((index, edge.target))
    return leaving


ANY_ORDER = "F a & F b & F c & F d & F e & F f & F g"


@pytest.mark.parametrize("spec", ["F[0,60] a", "F[0,240] a", "G(a -> F[0,120] b)", ANY_ORDER, f"{ANY_ORDER} & F h"])
def test_a_cover_visits_few_edges_per_step(spec: str) -> None:
    signals = "".join(f"signal {name}: bool  " for name in "abcdefgh")
    (fspa,) = tltlc.compile_text(f"{signals} spec s = {spec}")
    wanted, state, steps = WantedEdges(edges_leaving(fspa)), 0, 0
    while path := wanted.take(state) or (wanted.take(0) if state else ()):
        steps += len(path)
        state = fspa.edges[path[-1]].target
    # A search from each state would visit the edges of most states again for each trace.
    assert wanted.visited_edges <= 5 * (steps + len(fspa.edges))


@pytest.mark.parametrize("bound", [20, 80])
def test_the_tests_of_a_cover_are_short_and_share_steps_of_the_monitor(bound: int) -> None:
    with unfolded():
        (fspa,) = tltlc.compile_text(f"signal a: bool  spec s = F[0,{bound}] a")
    covering = cover(Moves(fspa))
    writer, steps_so_far = blocks.BlockWriter(fspa), []
    for trace in covering.traces:
        text = witness_text.as_test(fspa, trace, "t", writer)
        assert text == witness_text.as_test(fspa, trace, "t")
        assert len(text.splitlines()) <= 10
        steps_so_far.append(writer.monitor_steps)
    assert sum(len(trace.moves) for trace in covering.traces) > bound**2 / 2
    # The traces of a bound share their beginnings.
    assert steps_so_far[-1] <= 4 * bound


def test_the_new_steps_of_a_cover_take_every_edge_once() -> None:
    (fspa,) = tltlc.compile_text("signal a: bool  signal b: bool  spec s = G(a -> F[0,3] b)")
    covering = cover(Moves(fspa))
    edges = [trace.moves[number - 1].edge for trace in covering.traces for number in trace.new_steps]
    assert sorted(edges) == list(range(len(fspa.edges)))


def test_an_edge_of_exclusive_atoms_is_reported_and_left_out() -> None:
    text = "signal fuel in [0, 100]  spec both { reach fuel > 80  reach fuel < 20 }"
    (fspa,) = tltlc.compile_text(text)
    covering = cover(Moves(fspa))
    untaken = [fspa.edges[edge.edge].guard.text for edge in covering.untaken]
    assert untaken == ["(fuel > 80) & (fuel < 20)"]
    assert [obstacle.text(fspa) for obstacle in covering.untaken[0].obstacles] == ["`fuel > 80` and `fuel < 20`"]
    # By letters alone, the shortest trace would have one step.
    trace = accepting_trace(Moves(fspa))
    assert trace is not None and len(trace.letters) == 2


def test_edges_behind_an_impossible_edge_are_not_taken() -> None:
    (fspa,) = tltlc.compile_text("signal n in [0, 1]  signal a: bool  spec s { reach n > 0.8 and n < 0.2 then a }")
    moves = Moves(fspa)
    assert accepting_trace(moves) is None
    reasons = {(fspa.edges[edge.edge].source, bool(edge.obstacles)) for edge in cover(moves).untaken}
    assert reasons == {(0, True), (1, False), (2, False)}


THRESHOLDS = {"a": "x > 0.75", "b": "x > 0.25", "c": "x < 0.5"}
"""Atoms of one signal. Samples can produce four of the eight letters over them."""
FEASIBLE = {
    frozenset(name for name, holds in zip(THRESHOLDS, (x > 0.75, x > 0.25, x < 0.5), strict=True) if holds)
    for x in (0.0, 0.25, 0.3, 0.5, 0.6, 0.75, 0.8)
}


@times(40)
@given(formulas(atoms=tuple(THRESHOLDS), max_leaves=5))
def test_a_cover_takes_exactly_the_edges_that_samples_take(formula: Formula) -> None:
    text = "".join(f"let {name} = {atom}\n" for name, atom in THRESHOLDS.items())
    (fspa,) = tltlc.compile_text(f"signal x in [0, 1]\n{text}spec s = {ascii_text(formula)}")
    letters = [frozenset(THRESHOLDS[name] for name in letter) for letter in FEASIBLE]
    reached, possible = {0}, set()
    queue = [0]
    for state in queue:
        for letter in letters:
            truth = blocks.letter_values(fspa, letter)
            edge = next(edge for edge in fspa.edges_from(state) if guard_holds(edge.guard, truth))
            possible.add((edge.source, edge.target))
            if edge.target not in reached:
                reached.add(edge.target)
                queue.append(edge.target)
    covering = cover(Moves(fspa))
    edges = {(fspa.edges[move.edge].source, fspa.edges[move.edge].target) for t in covering.traces for move in t.moves}
    assert edges == possible
    assert {(fspa.edges[edge.edge].source, fspa.edges[edge.edge].target) for edge in covering.untaken} == {
        (edge.source, edge.target) for edge in fspa.edges
    } - possible
    for trace in covering.traces if fspa.atoms else ():
        check_csv(fspa, trace)
