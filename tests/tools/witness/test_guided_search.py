"""Traces of specs with many timers: the search takes its inputs from the guards on the way."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.tools.witness.cover import cover
from tltlc.tools.witness.guard_inputs import distances_to
from tltlc.tools.witness.memory_search import MemorySearch
from tltlc.tools.witness.traces import Witness, accepting_trace, rejecting_trace
from tltlc.tools.witness.transitions import Moves

NAMES = """
clock 60 Hz
entity g1, g2, g3
entity guards = g1, g2, g3
signal damage: bool
signal invulnerable: bool
signal alarm: bool
signal answers(g: entity): bool
signal door_open: bool
signal key_taken: bool
signal on_plate: bool
signal falls(p: entity): bool
signal dash: bool
signal jump: bool
signal attack: bool
signal at_exit: bool
signal coins: int in [0, 99]
signal health: int in [0, 100]
signal phase: int in [1, 3]
signal mode: (idle, alert, chase)
"""
COMBO = "reach begins jump then within 0.5 s (begins attack) then within 0.5 s (begins dash)"
GOALS = f"reach time_holding(on_plate) >= 3 s  {COMBO}  require eventually within 30 s at_exit"
GUARDS = "keep all g in guards: within 5 s of begins alarm, answers(g)"
TOWER = f"""
    keep once within 1 s begins damage implies invulnerable
    {GUARDS}
    keep times(alarm) <= 3
    keep door_open implies previously once key_taken
    avoid any p in guards: (begins falls(p)) then within 10 s (begins falls(p))
    keep begins dash implies next always for 2 s not begins dash
    keep health >= previous(health) - 30
    keep phase == 3 implies once phase == 2
    keep begins mode is chase implies previously mode is alert
    keep time_holding(mode is chase) <= 10 s
    keep ends mode is chase implies always for 3 s mode is alert
    keep coins >= previous(coins)
    {GOALS}
"""


def spec_of(clauses: str) -> Fspa:
    (fspa,) = compile_text(f"{NAMES}spec s {{ {clauses} }}")
    return fspa


def check(fspa: Fspa, witness: Witness | None, verdict: str) -> None:
    """Assert that a monitor ends with a verdict after the samples of a trace."""
    assert witness is not None
    monitor = Monitor(fspa)
    assert [monitor.step(sample).verdict for sample in witness.samples][-1] == verdict


@pytest.mark.parametrize("clauses", [TOWER, GOALS, f"{GUARDS}  {GOALS}"])
def test_traces_of_many_timers_take_few_steps(clauses: str, monkeypatch: pytest.MonkeyPatch) -> None:
    fspa, steps = spec_of(clauses), 0
    take = MemorySearch.step

    def counted(*arguments):  # type: ignore[no-untyped-def]
        nonlocal steps
        steps += 1
        return take(*arguments)

    monkeypatch.setattr(MemorySearch, "step", counted)
    moves = Moves(fspa)
    accepting = accepting_trace(moves)
    assert accepting is not None
    check(fspa, accepting, "satisfied" if clauses == GOALS else "holding")
    # Three seconds on the plate and a few steps more.
    assert 180 < len(accepting.moves) < 190
    check(fspa, rejecting_trace(moves), "violated")
    # A step of a spec with more atoms and registers takes longer.
    assert steps * (len(fspa.atoms) + len(fspa.registers)) < 1_000_000


def test_nothing_is_searched_for_a_verdict_that_no_state_has() -> None:
    moves = Moves(spec_of("reach time_holding(on_plate) >= 3 s"))
    assert moves.shortest_path(0, lambda edge: False) is None
    assert "traces" not in vars(moves) or not moves.traces._first


@pytest.mark.parametrize(
    ("clauses", "source", "target"),
    [
        (GUARDS, "violated", "violated"),
        (f"{GUARDS}  {GOALS}", "violated", "violated"),
        ("keep times(alarm) <= 3  require eventually within 30 s at_exit", "holding", "violated"),
    ],
)
def test_a_cover_goes_on_from_where_traces_lead(clauses: str, source: str, target: str) -> None:
    fspa = spec_of(clauses)
    untaken = {edge.edge for edge in cover(Moves(fspa)).untaken}
    verdicts = [(fspa.states[edge.source].verdict, fspa.states[edge.target].verdict) for edge in fspa.edges]
    edges = {index for index, pair in enumerate(verdicts) if pair == (source, target)}
    assert edges
    assert not edges & untaken


def test_a_cover_of_a_sequence_with_times_takes_every_edge() -> None:
    fspa = spec_of(COMBO)
    covering = cover(Moves(fspa))
    assert covering.untaken == ()
    taken = {move.edge for trace in covering.traces for move in trace.moves}
    assert taken == set(range(len(fspa.edges)))


def test_distances_are_the_least_numbers_of_edges() -> None:
    fspa = spec_of("reach jump then attack then dash")
    goal = {index for index, edge in enumerate(fspa.edges) if fspa.states[edge.target].accepting}
    distance = distances_to(fspa, goal)
    assert {state: number + 1 for state, number in distance.items() if not fspa.states[state].accepting} == {
        state.id: state.distance for state in fspa.states if state.distance
    }
