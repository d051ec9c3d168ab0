"""What agents observe of an automaton: its state, and its registers, in environments and in batches."""

from __future__ import annotations

import random
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from gymnasium.vector import SyncVectorEnv

from tests.fixtures import cover_and_hide
from tests.runtime.batch.test_registers import COUNT, MEMORY, columns, draw_samples
from tests.runtime.gymnasium_games import vault
from tests.runtime.gymnasium_games.vault_episodes import played
from tests.runtime.test_wrapper import FAR, playback_env
from tltl_runtime import TltlEnv
from tltl_runtime.game.recording_check import check
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_episode_file import scene_episode_bytes, scene_episode_from_bytes
from tltl_runtime.spec.automaton_observation import AutomatonObservation, automaton_entries, observed_registers
from tltl_runtime.spec.batch import BatchMonitor
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.recordings.file import from_bytes, to_bytes
from tltl_runtime.stealth.recordings.replay_check import check_replay
from tltl_runtime.vector import WorkerVectorEnv
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.monitor import Monitor
from tltlc.tools.conformance.corpus import CASES

COUNTING = """
clock 10 Hz
signal x in [0, 4]
signal y: number
predicate calm in [-1, 1] = clamp(9 - highest(y), -1, 1)
spec counting { limit 100 steps keep times(x > 2) <= 3 reach time_holding(x > 1) >= 0.3 s keep calm }
"""
WAITING = """
clock 10 Hz
signal alarm: bool
signal hidden: bool
spec waiting { limit 900 steps keep alarm implies eventually within 8 s hidden }
"""
REMEMBERING = vault.SPEC.replace(
    "reach has_key then at_exit", "reach at_exit keep at_exit implies once has_key"
).replace("avoid caught", "avoid caught keep times(caught) <= 2")

WANDERING = """
clock 0.15 s
signal position.x: length in [-100 m, 100 m]
spec wandering { limit 60 steps keep lowest(position.x) > -90 m keep times(position.x > 0 m) <= 40 }
"""


def fspa_of(text: str) -> Fspa:
    return load_task(text).fspa


def shares(env: TltlEnv, observation: dict[str, Any]) -> dict[str, float]:
    """Return the numbers of the key ``automaton`` behind the states, by the names of the registers."""
    entries, states = automaton_entries(env.task.fspa), len(env.task.fspa.states)
    numbers = observation["automaton"].tolist()
    assert len(numbers) == len(entries)
    return dict(zip(entries[states:], numbers[states:], strict=True))


def test_without_registers_the_automaton_is_its_state_alone() -> None:
    fspa = cover_and_hide()
    assert automaton_entries(fspa) == ("state 0", "state 1", "state 2", "state 3", "state 4")
    env = playback_env([FAR], fspa)
    assert env.observation_space["automaton"].shape == (5,)  # type: ignore[index]
    assert env.reset()[0]["automaton"].tolist() == [1, 0, 0, 0, 0]
    monitor = BatchMonitor(fspa, 3)
    assert torch.equal(monitor.observation(), monitor.one_hot())


def test_registers_follow_the_states_in_order_each_as_its_share_of_its_range() -> None:
    rows = [{"x": x, "y": 1.0} for x in (3.0, 3.0, 0.0, 3.0, 1.5)]
    env = playback_env(rows, COUNTING)
    fspa = env.task.fspa
    names = [register.name for register in fspa.registers if register.high is not None]
    assert list(automaton_entries(fspa)) == [f"state {state.id}" for state in fspa.states] + names
    high = {register.name: register.high for register in fspa.registers}
    holding, times = "time_holding(x > 1)", "times(x > 2)"
    assert (high[holding], high[times]) == (6.0, 7.0)
    observation, info = env.reset()
    seen = [(shares(env, observation)[holding], shares(env, observation)[times])]
    for _ in rows:
        observation, *_, info = env.step(0)
        assert env.observation_space.contains(observation)
        assert observation["automaton"].argmax() == info["state"]
        seen.append((shares(env, observation)[holding], shares(env, observation)[times]))
    expected = [(0, 0), (0, 1), (1, 1), (0, 1), (0, 2), (1, 2)]
    assert seen == [(np.float32(held / 6), np.float32(count / 7)) for held, count in expected]
    assert shares(env, env.reset()[0])[times] == 0.0


def test_a_register_without_a_finite_range_is_not_observed() -> None:
    fspa = fspa_of(COUNTING)
    unbounded = [register.name for register in fspa.registers if None in (register.low, register.high)]
    assert "highest(y)" in unbounded
    assert not set(unbounded) & set(automaton_entries(fspa))
    constant, huge = (replace(fspa.registers[0], low=low, high=high) for low, high in ((2.0, 2.0), (-1e308, 1e308)))
    assert observed_registers(replace(fspa, registers=(constant, huge))) == ()


def test_a_value_out_of_its_range_is_cut_to_it() -> None:
    fspa = fspa_of(COUNTING)
    observed = observed_registers(fspa)
    observation = AutomatonObservation(fspa)
    for value, share in ((-1e9, 0.0), (1e9, 1.0)):
        row = observation.of(0, [value] * len(fspa.registers))
        assert row[len(fspa.states) :].tolist() == [share] * len(observed)


def test_a_timer_grows_to_half_its_range_at_the_deadline() -> None:
    rows = [{"alarm": float(step == 2), "hidden": float(step == 70)} for step in range(90)]
    env = playback_env(rows, WAITING)
    (name,) = (register.name for register in env.task.fspa.registers if register.kind == "waiting")
    env.reset()
    waited = [shares(env, env.step(0)[0])[name] for _ in rows]
    assert waited[:2] == [0.0, 0.0] and waited[70:] == [0.0] * 20
    assert waited[2:70] == [np.float32(step / 161) for step in range(1, 69)]
    (late,) = (register.high for register in env.task.fspa.registers if register.name == name)
    assert late == 161  # the deadline is 80 steps


@pytest.mark.parametrize("name", [name for name in MEMORY if name != "no_memory"])
def test_a_batch_observes_what_single_environments_observe(name: str) -> None:
    fspa = CASES[name]().fspa
    rng = random.Random(name)
    batch, monitors = BatchMonitor(fspa, COUNT), [Monitor(fspa) for _ in range(COUNT)]
    single = AutomatonObservation(fspa)
    for number in range(60):
        if number:
            samples = draw_samples(fspa, rng)
            batch.step(columns(samples))
            for monitor, sample in zip(monitors, samples, strict=True):
                monitor.step(sample)
        expected = np.stack([single.of(monitor.state, monitor.registers) for monitor in monitors])
        assert batch.observation().numpy().tobytes() == expected.tobytes()
        rows = batch.observation(torch.float64)
        assert rows.dtype == torch.float64 and rows.min() >= 0.0 and rows.max() <= 1.0


def test_resetting_single_environments_of_a_batch_resets_their_shares() -> None:
    fspa = fspa_of(COUNTING)
    batch = BatchMonitor(fspa, 2, dtype=torch.float32)
    start = batch.observation()
    batch.step({"x": [3.0, 3.0], "y": [1.0, 1.0]})
    moved = batch.observation()
    assert not torch.equal(moved[0], start[0])
    batch.reset(torch.tensor([True, False]))
    assert torch.equal(batch.observation(), torch.stack([start[0], moved[1]]))


def test_an_unchecked_batch_observes_without_waiting_for_the_device() -> None:
    """Tensors on the device "meta" have no values, so reading one raises an error."""
    fspa = fspa_of(COUNTING)
    batch = BatchMonitor(fspa, 4096, device="meta", checked=False)
    batch.step(torch.empty(4096, 2, device="meta"))
    assert batch.observation().shape == (4096, len(automaton_entries(fspa)))


def test_workers_pass_on_the_registers() -> None:
    actions = np.random.default_rng(4).integers(0, 2, (30, 2, 5))
    functions = [partial(make_env, "cover_and_hide", "v2", WANDERING)] * 2
    rows = []
    for env in (SyncVectorEnv(functions), WorkerVectorEnv(functions, workers=2)):
        observations = [env.reset(seed=3)[0], *(env.step(action)[0] for action in actions)]
        rows.append(np.stack([observation["automaton"] for observation in observations]))
        env.close()
    assert np.array_equal(*rows)
    assert rows[0].shape[2] > len(fspa_of(WANDERING).states)
    assert len(np.unique(rows[0][:, :, -1])) > 1


def test_going_back_to_a_moment_gives_the_same_observation() -> None:
    env = playback_env([{"x": 3.0, "y": 1.0}] * 3, COUNTING)
    env.reset()
    env.step(0)
    moment = env.spec_state()
    first = env.step(0)[0]["automaton"]
    env.restore_spec_state(moment)
    assert env.step(0)[0]["automaton"].tolist() == first.tolist()


def test_a_recorded_episode_of_a_spec_with_registers_is_judged_alike_when_it_is_replayed(tmp_path: Path) -> None:
    game = vault.write(tmp_path, vault__tltl=REMEMBERING)
    episode = scene_episode_from_bytes(scene_episode_bytes(played(game)), "it")
    kinds = {register.kind for register in episode.fspa.registers}
    assert {"once", "times"} <= kinds
    assert check(episode) == ()
    assert GAME.check_replay(GAME.located(episode, str(game), None)) == ()
    other = replace(episode, atoms=episode.atoms * 0.5)
    (diagnostic, *_) = check(other)
    assert diagnostic.code == "TLT0823"


def test_a_recorded_episode_of_a_level_is_judged_alike_when_it_is_replayed() -> None:
    env = RecordEpisode(make_env("cover_and_hide", "v2", WANDERING))
    env.reset(seed=3)
    for action in np.random.default_rng(4).integers(0, 2, (30, 5)):
        env.step(action)
    episode = from_bytes(to_bytes(env.episode), "it")
    env.close()
    assert len(episode.fspa.registers) > 1
    assert check(episode) == check_replay(episode) == ()
