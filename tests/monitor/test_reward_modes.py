from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from zipfile import ZipFile

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tltlc
from tests.logic.strategies import formulas
from tests.monitor.strategies import atom_traces, automata, values
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.logic import formula as f
from tltlc.logic.oracle import holds
from tltlc.monitor import Monitor, RewardOptions
from tltlc.monitor.progress_and_reward import MODES

A, B, P = f.atom("a"), f.atom("b"), f.atom("p")
SPARSE, EDGE = RewardOptions(mode="sparse"), RewardOptions(mode="edge")


def last_reward(formula: f.Formula, trace: Sequence[tuple[float, ...]]) -> float:
    """Return the reward of the mode `sparse` for an episode that is as long as the trace."""
    fspa = replace(build(spec_from_formula(formula)), limit_steps=len(trace), judge="limit")
    monitor = Monitor(fspa, reward=SPARSE)
    rewards = [monitor.step_atoms(sample).reward for sample in trace]
    return sum(rewards)


@settings(max_examples=60)
@given(formulas(("a", "b"), max_leaves=5), st.data())
def test_sparse_is_the_signed_distance_to_the_nearest_trace_with_another_result(
    formula: f.Formula, data: st.DataObject
) -> None:
    spec = spec_from_formula(formula)
    names = [atom.name for atom in spec.atoms]
    length = 1 if len(names) > 1 else 3
    fspa = replace(build(spec), limit_steps=length, judge="limit")
    trace = [data.draw(st.tuples(*[values for _ in names])) for _ in range(length)]
    monitor = Monitor(fspa, reward=SPARSE)
    reward, steps = 0.0, 0
    for sample in trace:
        step = monitor.step_atoms(sample)
        reward, steps = reward + step.reward, steps + 1
        if step.done:
            break
    trace = trace[:steps]
    accepted = holds(formula, [{n for n, v in zip(names, sample, strict=True) if v > 0} for sample in trace])
    distances = []
    for letters in product(product([False, True], repeat=len(names)), repeat=steps):
        if (
            holds(formula, [{n for n, true in zip(names, letter, strict=True) if true} for letter in letters])
            != accepted
        ):
            changes = [
                abs(value)
                for sample, letter in zip(trace, letters, strict=True)
                for value, true in zip(sample, letter, strict=True)
                if (value > 0) != true
            ]
            distances.append(max(changes, default=0.0))
    distance = min(distances, default=1.0)
    assert reward == (distance if accepted else -distance)


def test_sparse_on_sequences_is_the_robustness_of_the_formula() -> None:
    trace = [(-0.5, -1.0), (0.25, -0.5), (-0.75, 0.75), (-1.0, 0.5)]
    assert last_reward(f.eventually(A), [(a,) for a, _ in trace]) == 0.25
    assert last_reward(f.then(A, B), trace) == 0.25
    assert last_reward(f.always(A), [(0.5,), (0.25,), (1.0,)]) == 0.25


def test_the_sparse_reward_is_paid_once() -> None:
    fspa = replace(build(spec_from_formula(f.always(P))), limit_steps=3)
    monitor = Monitor(fspa, reward=SPARSE)
    assert [monitor.step_atoms((v,)).reward for v in (0.5, 0.75, 1.0, 1.0)] == [0.0, 0.0, 0.5, 0.0]
    monitor.reset()
    assert [monitor.step_atoms((v,)).reward for v in (0.5, -0.25, 1.0)] == [0.0, -0.25, 0.0]


def test_the_edge_mode_rewards_leaving_a_state_except_into_a_trap() -> None:
    fspa = build(spec_from_formula(f.and_(f.eventually(A), f.always(P))))
    monitor = Monitor(fspa, reward=EDGE)
    assert [monitor.step_atoms(v).reward for v in [(-0.5, 1.0), (0.25, 0.5)]] == [-0.5, 0.25]
    assert Monitor(build(spec_from_formula(f.always(P))), reward=EDGE).step_atoms((-1.0,)).reward == 0.0


@given(st.data(), automata(), st.sampled_from([1.0, 0.9]))
def test_potential_rewards_sum_to_success_minus_the_initial_potential(
    data: st.DataObject, fspa: Fspa, gamma: float
) -> None:
    """The discounted sum over an episode is the discounted reward of success minus the initial potential."""
    fspa = replace(fspa, judge="goal", limit_steps=4)
    monitor = Monitor(fspa, reward=RewardOptions(mode="potential", gamma=gamma))
    trace = data.draw(atom_traces(fspa, max_size=4))
    total, length = 0.0, 0
    for values_ in trace + [trace[-1]] * (4 - len(trace)):
        step = monitor.step_atoms(values_)
        total += gamma**length * step.reward
        if step.done:
            break
        length += 1
    distance = fspa.states[0].distance
    start = 0.0 if distance is None else 1.0 if not fspa.spec_size else 1 - distance / fspa.spec_size
    assert total == pytest.approx(gamma**length * step.accepting - start)


def test_a_monitor_in_a_zip_archive_has_all_modes(tmp_path: Path) -> None:
    """A game may embed the monitor in an archive, from which Python imports it."""
    root = Path(tltlc.__file__).parent
    archive = tmp_path / "game.zip"
    with ZipFile(archive, "w") as file:
        for path in root.rglob("*.py"):
            file.write(path, Path("tltlc", path.relative_to(root)))
    code = f"""import sys
sys.path.insert(0, {str(archive)!r})
from tltlc.monitor import RewardOptions
from tltlc.monitor import progress_and_reward as module
from tltlc.monitor.reward_modes import mode_function
print(module.__file__, *module.MODES, *(mode_function(mode).__name__ for mode in module.MODES[1:]))"""
    command = [sys.executable, "-c", code]
    printed = subprocess.run(command, capture_output=True, encoding="utf-8", check=True, cwd=tmp_path).stdout.split()
    assert printed[0].startswith(str(archive))
    assert printed[1:] == [*MODES, *["reward"] * (len(MODES) - 1)]
