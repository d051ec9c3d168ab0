"""A spec around other environments: spaces, rewards, ends of episodes, errors, and vector environments."""

from __future__ import annotations

import pickle
import threading
import warnings
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.fixtures import cover_and_hide
from tltl_runtime import TltlEnv
from tltlc import TltlError
from tltlc.core.record import replace
from tltlc.monitor import MonitorError, RewardOptions

FAR = {"distance(s1)": 20.0, "distance(s2)": 20.0, "distance(exit)": 20.0, "health": 1.0}
SWING_UP = """
signal position in [-1.2, 0.6]
signal velocity in [-0.07, 0.07]
spec swing_up { limit 200 steps reach position < -0.9 then position >= 0.5 keep abs(velocity) < 0.065 }
"""
BALANCE = "signal angle: angle in [-24 deg, 24 deg]\nspec balance { limit 500 steps keep abs(angle) < 12 deg }\n"
UPRIGHT = "signal cosine in [-1, 1]\nspec upright { limit 100 steps reach cosine > 0.9 }\n"
Row = Mapping[str, float]


class Playback(gymnasium.Env[Any, int]):
    """An environment that plays back a trace, one sample per step.

    ``ends`` is the step at which the episode ends, and how: ``terminated`` or ``truncated``.
    """

    action_space = spaces.Discrete(2)

    def __init__(self, rows: Sequence[Row], ends: tuple[int, str] | None = None, space: Any = None) -> None:
        self.rows, self.ends = rows, ends
        self.observation_space = space or spaces.Box(-np.inf, np.inf, (1,), np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self.row, self.taken = self.rows[0], 0
        return self._observed(), {"host": "reset"}

    def step(self, _: int) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        self.row = self.rows[min(self.taken, len(self.rows) - 1)]
        self.taken += 1
        end = self.ends[1] if self.ends and self.ends[0] == self.taken else None
        return self._observed(), 100.0, end == "terminated", end == "truncated", {"host": "step"}

    def _observed(self) -> Any:
        space = self.observation_space
        return {name: space[name].sample() for name in space} if isinstance(space, spaces.Dict) else space.sample()


def current(env: gymnasium.Env[Any, Any]) -> Row:
    row: Row = env.unwrapped.row  # type: ignore[attr-defined]
    return row


def mountain_car(env: gymnasium.Env[Any, Any]) -> dict[str, float]:
    position, velocity = env.unwrapped.state  # type: ignore[attr-defined]
    return {"position": position, "velocity": velocity}


def cart_pole(env: gymnasium.Env[Any, Any]) -> dict[str, float]:
    return {"angle": env.unwrapped.state[2]}  # type: ignore[attr-defined]


def pendulum(env: gymnasium.Env[Any, Any]) -> dict[str, float]:
    return {"cosine": np.cos(env.unwrapped.state[0])}  # type: ignore[attr-defined]


def make_mountain_car() -> TltlEnv:
    return TltlEnv(gymnasium.make("MountainCar-v0"), SWING_UP, mountain_car)


def playback_env(rows: Sequence[Row], spec: Any, ends: tuple[int, str] | None = None, **options: Any) -> TltlEnv:
    return TltlEnv(Playback(rows, ends), spec, current, **options)


def episode(env: TltlEnv, most: int = 1000) -> list[tuple[float, bool, bool, dict[str, Any]]]:
    """Return the reward, terminated, truncated and info of each step of an episode."""
    env.reset(seed=0)
    steps: list[tuple[float, bool, bool, dict[str, Any]]] = []
    while len(steps) < most and not (steps and (steps[-1][1] or steps[-1][2])):
        _, reward, terminated, truncated, info = env.step(0)
        steps.append((reward, terminated, truncated, info))
    return steps


def total(steps: list[tuple[float, bool, bool, dict[str, Any]]]) -> float:
    return sum(step[0] for step in steps)


@pytest.mark.parametrize(
    ("name", "spec", "signals"),
    [
        ("CartPole-v1", BALANCE, cart_pole),
        ("Pendulum-v1", UPRIGHT, pendulum),
        ("MountainCar-v0", SWING_UP, mountain_car),
    ],
    ids=["cart_pole", "pendulum", "mountain_car"],
)
def test_the_checker_of_gymnasium_finds_no_fault(name: str, spec: str, signals: Any) -> None:
    env = TltlEnv(gymnasium.make(name), spec, signals)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # Warnings about the environments themselves, and about wrappers in general.
        warnings.filterwarnings("ignore", ".*(different from the unwrapped version|infinity|symmetric and normalized)")
        # Rendering needs pygame, and the wrapper does not change it.
        check_env(env, skip_render_check=True)
    assert env.spec is not None
    copy = gymnasium.make(env.spec)
    assert copy.observation_space == env.observation_space


def test_an_episode_has_the_progress_and_rewards_of_the_paper() -> None:
    changes: list[dict[str, float]] = [
        {},
        {"distance(s1)": 10.5},
        {"distance(s1)": 15.0},
        {"distance(s1)": 0.5},
        {"distance(s2)": 0.5},
        {"distance(exit)": 10.5},
        {"distance(exit)": 0.0},
    ]
    steps = episode(playback_env([{**FAR, **change} for change in changes], cover_and_hide()))
    infos = [info for *_, info in steps]
    assert [info["state"] for info in infos] == [0, 0, 0, 1, 3, 3, 4]
    assert [info["progress"] for info in infos] == pytest.approx([0, 0.25 / 3, 0.25 / 3, 1 / 3, 2 / 3, 0.75, 1])
    assert [terminated for _, terminated, _, _ in steps] == [False] * 6 + [True]
    assert not any(truncated for _, _, truncated, _ in steps)
    assert total(steps) == pytest.approx(1 - 7 / 400)
    assert infos[5]["atoms"]["near(exit)"] == pytest.approx(-0.75)
    assert (infos[0]["limiting"], infos[3]["limiting"]) == ("near(s1)", None)
    assert infos[-1] == {
        "host": "step",
        "verdict": "holding",
        "state": 4,
        "unmet": 4,
        "label": "G alive",
        "label_english": "Keep alive throughout.",
        "failed_clause": None,
        "failed_atom": None,
        "failed_step": 0,
        "progress": 1.0,
        "success": True,
        "limiting": None,
        "atoms": {"near(s1)": -1.0, "near(s2)": -1.0, "near(exit)": 1.0, "alive": 1.0},
        "env_reward": 100.0,
    }


def test_the_level_size_changes_equation_2() -> None:
    """With b = 1 and B = 10, a distance of 5 gives -56/81."""
    near = [{**FAR, "distance(s1)": 5.0}]
    (step, *_) = episode(playback_env(near, cover_and_hide(), params={"level_size": 10.0}), most=1)
    assert step[3]["atoms"]["near(s1)"] == pytest.approx(-56 / 81)

    class Sized(Playback):
        def tltl_params(self) -> dict[str, float]:
            return {"level_size": 10.0, "other": 3.0}

    sized = episode(TltlEnv(Sized(near), cover_and_hide(), current), most=1)
    assert sized[0][3]["atoms"] == step[3]["atoms"]
    overridden = episode(TltlEnv(Sized(near), cover_and_hide(), current, params={"level_size": 20.0}), most=1)
    assert overridden[0][3]["atoms"] == episode(playback_env(near, cover_and_hide()), most=1)[0][3]["atoms"]


def test_a_reset_returns_the_initial_state_and_no_atoms() -> None:
    env = playback_env([FAR], cover_and_hide())
    env.reset()
    env.step(0)
    observation, info = env.reset()
    assert observation["automaton"].tolist() == [1, 0, 0, 0, 0]
    assert observation["progress"].tolist() == [0]
    assert info["host"] == "reset"
    assert (info["verdict"], info["state"], info["success"], info["atoms"]) == ("pending", 0, False, {})
    assert info["label"] == str(cover_and_hide().formula)


def test_a_violation_terminates_and_costs_the_unspent_steps() -> None:
    steps = episode(playback_env([{**FAR, "distance(s1)": 0.0}, {**FAR, "health": 0.0}], cover_and_hide()))
    assert steps[-1][1:3] == (True, False)
    assert (steps[-1][3]["verdict"], steps[-1][3]["success"]) == ("violated", False)
    assert (steps[-1][3]["unmet"], steps[-1][3]["state"]) == (steps[-2][3]["state"], 2)
    assert total(steps) == pytest.approx(1 / 3 - 1)


def test_an_episode_is_truncated_at_the_limit_of_its_spec() -> None:
    steps = episode(playback_env([FAR], replace(cover_and_hide(), limit_steps=9)))
    assert (len(steps), steps[-1][1:3], steps[-1][3]["success"]) == (9, (False, True), False)
    assert total(steps) == pytest.approx(-1)


def test_over_infinite_traces_goals_are_judged_at_entry_or_at_the_limit() -> None:
    signals = "signal a: bool\nsignal p: bool\n"
    rows = [{"a": 0.0, "p": 1.0}, {"a": 1.0, "p": 1.0}, {"a": 0.0, "p": 1.0}]
    steps_of_reach = episode(
        playback_env(rows, f"{signals}spec s {{ semantics infinite limit 8 steps reach a keep p }}")
    )
    assert (len(steps_of_reach), steps_of_reach[-1][1:3], steps_of_reach[-1][3]["success"]) == (2, (True, False), True)
    assert total(steps_of_reach) == pytest.approx(1 - 2 / 8)
    recurring = f"{signals}spec s {{ semantics infinite limit 8 steps require G F a keep p }}"
    steps = episode(playback_env(rows, recurring))
    assert (len(steps), steps[-1][3]["verdict"], steps[-1][3]["success"]) == (8, "holding", True)
    assert total(steps) == pytest.approx(0)
    steps = episode(playback_env([*rows, {"a": 0.0, "p": 0.0}], recurring))
    assert (len(steps), steps[-1][1:3], steps[-1][3]["success"]) == (4, (True, False), False)
    assert total(steps) == pytest.approx(3 / 8 - 1)
    late_spec = f"{signals}spec s {{ semantics infinite limit 8 steps reach a require G F !a }}"
    steps = episode(playback_env(rows[:1], late_spec))
    assert (len(steps), steps[-1][3]["verdict"], steps[-1][3]["success"]) == (8, "pending", False)


SAMPLES = st.sampled_from(
    [FAR, *({**FAR, name: 0.5} for name in list(FAR)[:3]), {**FAR, "distance(s1)": 7.0}, {**FAR, "health": 0.0}]
)


@settings(deadline=None)
@given(
    st.lists(SAMPLES, min_size=1, max_size=9),
    st.none() | st.tuples(st.integers(1, 9), st.sampled_from(["terminated", "truncated"])),
    st.sampled_from(["goal", "limit"]),
)
def test_every_failed_episode_totals_progress_minus_one(rows: list[Row], ends: Any, judge: str) -> None:
    steps = episode(playback_env(rows, replace(cover_and_hide(), limit_steps=8, judge=judge), ends))
    progress = steps[-1][3]["progress"]
    assert 0 <= progress <= 1
    if steps[-1][3]["success"]:
        assert progress == 1.0
        assert total(steps) == pytest.approx(1 - len(steps) / 8)
    else:
        assert total(steps) == pytest.approx(progress - 1)
    assert not any(info["success"] for *_, info in steps[:-1])


@pytest.mark.parametrize("how", ["terminated", "truncated"])
def test_the_end_of_the_environment_judges_a_spec_without_a_limit(how: str) -> None:
    survive = "signal seen: bool\nspec hide = G !seen\n"
    steps = episode(playback_env([{"seen": 0.0}], survive, (3, how)))
    assert (len(steps), steps[-1][3]["success"], total(steps)) == (3, True, 1.0)
    assert steps[-1][1:3] == (True, how == "truncated")
    limited = episode(
        playback_env([{"seen": 0.0}], survive.replace("= G !seen", "{ limit 4 steps keep !seen }"), (3, how))
    )
    assert (limited[-1][3]["success"], limited[-1][3]["progress"]) == (False, 0.75)
    assert limited[-1][1:3] == (how == "terminated", how == "truncated")


def test_the_sparse_reward_is_given_where_the_environment_ends_the_episode() -> None:
    options = RewardOptions(mode="sparse")
    spec = "signal x in [-1, 1]\npredicate p in [-1, 1] = x\nspec s = F p\n"
    steps = episode(playback_env([{"x": -0.5}, {"x": -0.25}], spec, (2, "terminated"), reward=options))
    assert [reward for reward, *_ in steps] == [0.0, -0.25]


def test_with_the_termination_of_the_paper_a_reached_goal_can_be_lost() -> None:
    spec = "signal a: bool\nsignal p: bool\nspec s { limit 10 steps reach a keep p }\n"
    rows = [{"a": 1.0, "p": 1.0}, {"a": 0.0, "p": 0.0}]
    steps = episode(playback_env(rows, spec, reward=RewardOptions(termination="paper")))
    assert [(terminated, info["success"]) for _, terminated, _, info in steps] == [(False, False)] * 2 + [(True, False)]


def test_the_observation_space_gains_the_keys_of_the_automaton() -> None:
    inner = spaces.Dict({"map": spaces.Box(0, 1, (2, 2)), "kind": spaces.Discrete(3)})
    env = TltlEnv(Playback([FAR], space=inner), cover_and_hide(), current)
    assert set(env.observation_space) == {"map", "kind", "automaton", "progress"}
    observation, _ = env.reset()
    assert env.observation_space.contains(observation)
    discrete = TltlEnv(Playback([FAR], space=spaces.Discrete(3)), cover_and_hide(), current)
    assert discrete.observation_space["observation"] == spaces.Discrete(3)
    with pytest.raises(ValueError, match="already has the key 'automaton'"):
        TltlEnv(env, cover_and_hide(), current)


def test_changing_an_observation_changes_no_later_one() -> None:
    env = playback_env([FAR], cover_and_hide())
    observation, _ = env.reset()
    observation["automaton"][:] = 7
    assert env.reset()[0]["automaton"].max() == 1


def test_a_missing_signal_is_reported_at_the_reset() -> None:
    row = {("distance(exid)" if name == "distance(exit)" else name): value for name, value in FAR.items()}
    with pytest.raises(MonitorError) as error:
        playback_env([row], cover_and_hide()).reset()
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0611"
    signals = "`distance(s1)`, `distance(s2)`, `distance(exid)`, `health`"
    assert diagnostic.title == f"after the reset: no value for `distance(exit)`; `signals` gave {signals}"
    assert diagnostic.help == "is `distance(exid)` what the spec calls `distance(exit)`?"


def test_a_signal_that_goes_missing_does_not_change_the_automaton() -> None:
    env = playback_env([FAR, {}], cover_and_hide())
    env.reset()
    env.step(0)
    with pytest.raises(MonitorError, match=r"TLT0611: step 2: no value for `distance.*; `signals` gave none"):
        env.step(0)
    assert env.unwrapped.taken == 2  # type: ignore[attr-defined]
    env.unwrapped.rows = [FAR]  # type: ignore[attr-defined]
    assert env.step(0)[4]["state"] == 0


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "1", None, [1.0], 10**400])
def test_a_signal_must_be_a_finite_number(value: Any) -> None:
    with pytest.raises(MonitorError, match="TLT0612: after the reset: the signal `health` is "):
        playback_env([{**FAR, "health": value}], cover_and_hide()).reset()
    if isinstance(value, float):
        env = playback_env([FAR, {**FAR, "health": value}], cover_and_hide())
        env.reset()
        env.step(0)
        with pytest.raises(MonitorError, match="TLT0612: step 2"):
            env.step(0)


def test_signals_must_be_a_mapping() -> None:
    with pytest.raises(TypeError, match=r"after the reset: `signals` must return a mapping .* not \[1\.0\]"):
        playback_env([[1.0]], cover_and_hide()).reset()  # type: ignore[list-item]


def test_a_clamped_signal_causes_one_warning() -> None:
    env = playback_env([{**FAR, "health": 2.0}], cover_and_hide())
    env.reset()
    with pytest.warns(UserWarning, match="TLT0615: step 1: the signal `health` is 2"):
        env.step(0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env.step(0)


def test_signals_may_be_a_method_of_a_running_game() -> None:
    class Game:
        def __init__(self) -> None:
            self.running = threading.Lock()

        def signals(self, env: gymnasium.Env[Any, Any]) -> Row:
            return current(env)

    env = TltlEnv(Playback([FAR]), cover_and_hide(), Game().signals)
    assert env.reset()[1]["verdict"] == "pending"


def test_the_clock_must_match_the_environment() -> None:
    class Clocked(Playback):
        tltl_clock_s = 0.15

    with pytest.raises(TltlError) as error:
        TltlEnv(Clocked([FAR]), cover_and_hide(), current)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0617"
    assert diagnostic.title == "`cover_and_hide` is sampled every 0.05 s, but a step of the environment takes 0.15 s"
    assert diagnostic.help == "write `clock 0.15 s` in the specification"
    for clock in (0.15, None):
        TltlEnv(Clocked([FAR]), replace(cover_and_hide(), clock_s=clock), current)


def test_a_clock_that_varies_takes_the_steps_of_the_environment() -> None:
    class Clocked(Playback):
        tltl_clock_s = 0.5

    spec = "clock varies\nsignal health: ratio\nspec hurry { require always for 1 s health > 0.5 }"
    with pytest.raises(TltlError) as error:
        TltlEnv(Playback([FAR]), spec, current)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0617"
    assert diagnostic.help == "give the environment an attribute `tltl_clock_s`, the seconds of a step"
    hurt = {**FAR, "health": 0.0}
    env = TltlEnv(Clocked([FAR, FAR, FAR, hurt]), spec, current)
    verdicts = [info["verdict"] for _, _, _, info in episode(env)]
    assert verdicts == ["holding", "holding", "satisfied"]


def test_the_clock_in_the_help_matches_the_environment() -> None:
    class Clocked(Playback):
        tltl_clock_s = 1 / 30

    text = "clock {} s\nsignal door: bool\nspec leave {{ reach door }}"
    with pytest.raises(TltlError) as error:
        TltlEnv(Clocked([FAR]), text.format("0.0333333"), current)
    (diagnostic,) = error.value.diagnostics
    assert "every 0.0333333 s, but a step of the environment takes 0.03333333333333333 s" in diagnostic.title
    assert diagnostic.help == "write `clock 0.03333333333333333 s` in the specification"
    TltlEnv(Clocked([FAR]), text.format("0.03333333333333333"), current)


@pytest.mark.parametrize("vector", [SyncVectorEnv, partial(AsyncVectorEnv, context="spawn")], ids=["here", "workers"])
def test_vector_environments_give_the_same_steps(vector: Any) -> None:
    makers = [make_mountain_car] * 2
    envs = vector(makers, autoreset_mode=AutoresetMode.SAME_STEP)
    single_envs = [make_mountain_car() for _ in makers]
    try:
        observations, _ = envs.reset(seed=[1, 2])
        single_observations = [env.reset(seed=seed)[0] for env, seed in zip(single_envs, (1, 2), strict=True)]
        for _ in range(60):
            actions = [2 if observation["observation"][1] >= 0 else 0 for observation in single_observations]
            observations, rewards, _, _, infos = envs.step(np.array(actions))
            single_steps = [env.step(action) for env, action in zip(single_envs, actions, strict=True)]
            single_observations = [step[0] for step in single_steps]
            for index, (observation, reward, *_, info) in enumerate(single_steps):
                for key, value in observation.items():
                    assert np.array_equal(observations[key][index], value)
                assert rewards[index] == reward
                assert infos["verdict"][index] == info["verdict"]
                assert infos["atoms"]["position < -0.9"][index] == info["atoms"]["position < -0.9"]
    finally:
        envs.close()


def test_the_constructors_arguments_are_pickled_with_the_env_spec() -> None:
    spec = make_mountain_car().spec
    copy = gymnasium.make(pickle.loads(pickle.dumps(spec)))
    assert isinstance(copy, TltlEnv)
    assert copy.task == make_mountain_car().task


def test_a_signal_must_be_one_number() -> None:
    with pytest.raises(MonitorError, match="TLT0612: after the reset: the signal `health` is an array, not a number"):
        playback_env([{**FAR, "health": np.ones(1)}], cover_and_hide()).reset()  # type: ignore[dict-item]
    playback_env([{**FAR, "health": np.float32(1)}], cover_and_hide()).reset()


def test_signals_are_a_function_or_a_method_of_the_environment() -> None:
    with pytest.raises(TypeError, match=r"`signals` must be a function of the environment, .*health"):
        TltlEnv(Playback([FAR]), cover_and_hide(), {"health": 1.0})  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="give `signals`, a function of the environment"):
        TltlEnv(Playback([FAR]), cover_and_hide())

    class Own(Playback):
        def tltl_signals(self) -> Row:
            return current(self)

    assert TltlEnv(Own([FAR]), cover_and_hide()).reset()[1]["state"] == 0


def test_the_reward_of_the_environment_is_in_the_info() -> None:
    env = TltlEnv(gymnasium.make("CartPole-v1"), BALANCE, lambda env: {"angle": env.unwrapped.state[2]})  # type: ignore[attr-defined]
    assert env.reset(seed=1)[1]["env_reward"] == 0.0
    assert env.step(0)[4]["env_reward"] == 1.0


ALARM = "signal mode: (idle, alert)\nspec alarm { limit 9 steps  reach mode is alert }\n"


def test_an_environment_may_supply_the_names_of_values_of_an_enum(tmp_path: Path) -> None:
    (tmp_path / "alarm.tltl").write_text(ALARM)
    rows: Any = [{"mode": "idle"}, {"mode": "alert"}]
    env = TltlEnv(Playback(rows), str(tmp_path / "alarm.tltl"), current)
    env.reset()
    assert env.sample == {"mode": 0.0}
    assert [env.step(0)[4]["verdict"] for _ in rows] == ["pending", "satisfied"]
    wrong: Any = [{"mode": "alrt"}]
    with pytest.raises(MonitorError, match="no value `alrt`"):
        TltlEnv(Playback(wrong), str(tmp_path / "alarm.tltl"), current).reset()
