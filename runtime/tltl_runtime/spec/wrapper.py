"""Add a spec to any Gymnasium environment: its automaton's state, its reward and its verdict."""

from __future__ import annotations

import copy
import warnings
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from math import isclose
from pathlib import Path
from typing import Any, Final, SupportsFloat

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.utils import RecordConstructorArgs

from tltl_runtime.spec.automaton_observation import AutomatonObservation
from tltl_runtime.spec.task import load_task
from tltlc.api import (
    Diagnostic,
    Fspa,
    Monitor,
    MonitorError,
    RewardOptions,
    Step,
    TltlError,
    label_text,
    monitors,
    record,
)

SignalsFunction = Callable[[gymnasium.Env[Any, Any]], Mapping[str, SupportsFloat]]
Observation = dict[str, Any]

_MOST_LISTED: Final = 12
"""A message names at most this many of the signals that a function returned."""


@record
class SpecState:
    """How far a spec has come in an episode, and the values of the signals there."""

    monitor: Monitor
    taken: Step | None
    sample: Mapping[str, SupportsFloat]


class TltlEnv(gymnasium.Wrapper[Observation, Any, Any, Any], RecordConstructorArgs):
    """A wrapper of an environment whose episodes a spec rewards and ends.

    ``spec`` is as in :func:`tltl_runtime.spec.task.load_task`. ``signals`` is a function that gets the
    wrapped environment after each step and returns the spec's signals by name, as numbers in SI
    units or bools. By default it is the environment's own method ``tltl_signals()``. ``signals`` is
    also called after a reset, where the automaton takes no step, so that a missing signal is
    noticed at once. ``params`` are values of the spec's params, in SI units. They take precedence
    over those that the environment's method ``tltl_params()`` returns, if it has this method.

    Observation: a Dict space gains two keys, both float32. ``automaton`` is the state as a one-hot
    vector, shape (states,). If the spec has registers, their shares follow the states, see
    :class:`~tltl_runtime.spec.automaton_observation.AutomatonObservation`. ``progress`` is the best
    progress so far, shape (1,), in [0, 1]. An observation of any other space becomes the key
    ``observation`` beside these two.

    Reward: the reward of the spec, in the mode that ``reward`` names. The environment's own reward is
    ``info["env_reward"]``.

    End: the episode is ``terminated`` by success, by violation and by the environment, and
    ``truncated`` at the spec's limit and by the environment. If the environment ends an episode before
    the spec does, the episode is a success iff two things hold: the trace so far is accepted, and the
    spec is not judged at a limit that is still ahead. In the mode ``progress``, a failed episode then
    costs the penalties of all remaining steps up to the spec's limit, as a violation does. So by
    default the rewards of every failed episode sum to its best progress minus 1, if the spec has a
    limit.

    ``info`` gains these keys, which replace entries of the environment with the same names:

    - ``verdict``, ``state``, ``label``, ``label_english``, ``progress``, ``failed_clause``,
      ``failed_atom`` and ``failed_step``: as in :class:`~tltlc.monitor.Step`, but ``failed_step`` is 0
      while the trace has not failed;
    - ``unmet``: the state whose label says what was not met. After a violation it is the state before
      the step, otherwise the current state;
    - ``success``: whether the episode has ended in success;
    - ``limiting``: the name of the atom that most hinders the automaton from getting nearer to
      acceptance. None after a reset, if the state changed, and if no edge leads nearer;
    - ``atoms``: the values of the atoms by name, empty after a reset;
    - ``env_reward``: the environment's own reward, 0 after a reset.

    ``sample`` is the last result of ``signals``. ``taken`` is the monitor's
    :class:`~tltlc.monitor.Step` for that sample; None after a reset. ``task`` is the spec with its
    params and reward options. A recorder of episodes needs only these three attributes.

    Raises:
        TltlError: the errors of :func:`load_task`; TLT0617, the environment has a ``tltl_clock_s``
            (seconds per step) that differs from the spec's clock, or none although this clock varies.
        TypeError: an argument is of another type, or there are no ``signals``.
        ValueError: the observation space already has a key ``automaton`` or ``progress``.
    """

    def __init__(
        self,
        env: gymnasium.Env[Any, Any],
        spec: str | Path | Fspa,
        signals: SignalsFunction | None = None,
        *,
        reward: RewardOptions | None = None,
        params: Mapping[str, float] | None = None,
    ) -> None:
        # No deep copy: `signals` may be a method of an object that cannot be copied, such as a running game.
        RecordConstructorArgs.__init__(
            self, _disable_deepcopy=True, spec=spec, signals=signals, reward=reward, params=params
        )
        gymnasium.Wrapper.__init__(self, env)
        self._signals: SignalsFunction = _own_signals if signals is None else signals
        if signals is None and not env.has_wrapper_attr("tltl_signals"):
            raise TypeError(
                "the environment has no method tltl_signals(): give `signals`, a function of the environment"
            )
        if not callable(self._signals):
            raise TypeError(
                f"`signals` must be a function of the environment, such as `lambda env: {{…}}`, not {signals!r:.60}"
            )
        offered = env.get_wrapper_attr("tltl_params")() if env.has_wrapper_attr("tltl_params") else {}
        self.task = load_task(spec, {} if params is None else params, reward, offered=offered)
        _check_clock(self.task.fspa, env)
        # The steps of an environment take equal times.
        self._dt = float(env.get_wrapper_attr("tltl_clock_s")) if self.task.fspa.clock_varies else None
        self._automaton = AutomatonObservation(self.task.fspa)
        self.observation_space = _with_automaton(env.observation_space, self._automaton.size)
        self._flat = not isinstance(env.observation_space, spaces.Dict)
        self._monitor = self.task.monitor()
        self.sample: Mapping[str, SupportsFloat] = {}
        self.taken: Step | None = None
        self._names = tuple(atom.name for atom in self.task.fspa.atoms)
        self._inputs = self.task.fspa.signals

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode in the automaton's initial state.

        Raises:
            MonitorError: TLT0611, a signal of the spec is missing; TLT0612, a signal has no usable
                value.
            TypeError: ``signals`` did not return a mapping.
        """
        observation, info = self.env.reset(seed=seed, options=options)
        self._monitor.reset()
        self.taken = None
        sample = self._sample("after the reset")
        for signal in self._inputs:
            monitors.finite_signal_value(signal, sample[signal.name], "after the reset")
        start = self.task.fspa.states[0]
        info = {
            **info,
            "verdict": start.verdict,
            "state": 0,
            "unmet": 0,
            "label": str(start.label),
            "label_english": label_text(self.task.fspa, 0),
            "failed_clause": None,
            "failed_atom": None,
            "failed_step": 0,
            "progress": 0.0,
            "success": False,
            "limiting": None,
            "atoms": {},
            "env_reward": 0.0,
        }
        return self._with_automaton_keys(observation), info

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Take a step in the environment, then one in the automaton.

        Raises:
            MonitorError: the errors of :meth:`tltlc.monitor.Monitor.step`.
            TypeError: ``signals`` did not return a mapping.
        """
        observation, env_reward, terminated, truncated, info = self.env.step(action)
        sample = self._sample(f"step {self._monitor.steps + 1}")
        before = self._monitor.state
        self.taken = step = self._monitor.step(sample, self._dt, last=terminated or truncated)
        for notice in self._monitor.notices:
            warnings.warn(f"{notice.code}: {notice.title}", stacklevel=2)
        self._monitor.notices.clear()
        settled = step.done and (self._monitor.success or step.verdict == "violated")
        terminated = terminated or settled
        truncated = truncated or (step.done and not terminated)
        info = {**info, **self._step_info(step, before), "env_reward": env_reward}
        return self._with_automaton_keys(observation), step.reward, terminated, truncated, info

    def spec_state(self) -> SpecState:
        """Return how far the spec has come in this episode, for :meth:`restore_spec_state`."""
        return SpecState(copy.copy(self._monitor), self.taken, dict(self.sample))

    def restore_spec_state(self, state: SpecState) -> None:
        """Go back to ``state``, after the wrapped environment has gone back to the same moment.

        The signals are read again, so ``sample`` shows whether the environment is in that moment.

        Raises:
            MonitorError: TLT0611, a signal of the spec is missing.
            TypeError: ``signals`` did not return a mapping.
        """
        self._monitor = copy.copy(state.monitor)
        self.taken = state.taken
        self._sample(f"step {self._monitor.steps}")

    def _sample(self, when: str) -> Mapping[str, SupportsFloat]:
        """Call ``signals``, store its result in ``sample``, and return it; names of enum values become numbers.

        ``when`` is for messages: it says when that was, for example ``step 3``.

        Raises:
            MonitorError: TLT0611, a signal of the spec is missing; TLT0612, it has a text that is no
                value of an enum.
            TypeError: the result is not a mapping.
        """
        sample = self._signals(self.env)
        if not isinstance(sample, Mapping):
            raise TypeError(f"{when}: `signals` must return a mapping from names to numbers, not {sample!r:.80}")
        missing = [signal.name for signal in self._inputs if signal.name not in sample]
        if missing:
            raise MonitorError([_missing_signals(missing, [str(name) for name in sample], when)])
        if named := [signal for signal in self._inputs if isinstance(sample[signal.name], str)]:
            numbers = {signal.name: monitors.finite_signal_value(signal, sample[signal.name], when) for signal in named}
            sample = {**sample, **numbers}
        self.sample = sample
        return sample

    def _step_info(self, step: Step, before: int) -> dict[str, Any]:
        """Return the entries of ``info`` for a step from the state ``before``."""
        return {
            "verdict": step.verdict,
            "state": step.state,
            "unmet": before if step.verdict == "violated" else step.state,
            "label": step.label,
            "label_english": step.label_english,
            "failed_clause": step.failed_clause,
            "failed_atom": step.failed_atom,
            # Vector environments of Gymnasium put numbers into arrays of numbers, which have no None.
            "failed_step": step.failed_step or 0,
            "progress": step.progress,
            "success": self._monitor.success,
            "limiting": step.limiting,
            "atoms": dict(zip(self._names, self._monitor.values, strict=True)),
        }

    def _with_automaton_keys(self, observation: Any) -> Observation:
        added = {
            "automaton": self._automaton.of(self._monitor.state, self._monitor.registers),
            "progress": np.array([self._monitor.progress], dtype=np.float32),
        }
        return {"observation": observation, **added} if self._flat else {**observation, **added}


def _own_signals(env: gymnasium.Env[Any, Any]) -> Mapping[str, SupportsFloat]:
    signals: Mapping[str, SupportsFloat] = env.get_wrapper_attr("tltl_signals")()
    return signals


def _with_automaton(space: spaces.Space[Any], size: int) -> spaces.Dict:
    """Return an observation space with two more keys, ``automaton`` and ``progress``.

    Their shapes are (size,) and (1,). If the space is not a Dict, it becomes the key
    ``observation`` of the result.

    Raises:
        ValueError: the space already has one of the two keys.
    """
    inner = dict(space.spaces) if isinstance(space, spaces.Dict) else {"observation": space}
    conflicts = {"automaton", "progress"} & inner.keys()
    if conflicts:
        raise ValueError(f"the environment's observation already has the key {min(conflicts)!r}")
    inner["automaton"] = spaces.Box(0.0, 1.0, (size,), np.float32)
    inner["progress"] = spaces.Box(0.0, 1.0, (1,), np.float32)
    return spaces.Dict(inner)


def _check_clock(fspa: Fspa, env: gymnasium.Env[Any, Any]) -> None:
    """Check that the spec's clock, if it has one, equals the environment's ``tltl_clock_s``, if it has one.

    A clock that varies needs ``tltl_clock_s``, and fits any.

    Raises:
        TltlError: TLT0617, the two differ, or the second is missing.
    """
    if fspa.clock_varies and not env.has_wrapper_attr("tltl_clock_s"):
        title = f"the clock of `{fspa.name}` varies, and the environment does not say how long its steps are"
        advice = "give the environment an attribute `tltl_clock_s`, the seconds of a step"
        raise TltlError([Diagnostic("TLT0617", title, help=advice)])
    if fspa.clock_s is None or not env.has_wrapper_attr("tltl_clock_s"):
        return
    clock_s = env.get_wrapper_attr("tltl_clock_s")
    if not isclose(fspa.clock_s, clock_s, rel_tol=1e-9):
        # With fewer digits, the two numbers could look equal, and the clock in the help could differ from the step.
        own, step = monitors.number_text(fspa.clock_s), monitors.number_text(clock_s)
        title = f"`{fspa.name}` is sampled every {own} s, but a step of the environment takes {step} s"
        raise TltlError([Diagnostic("TLT0617", title, help=f"write `clock {step} s` in the specification")])


def _missing_signals(missing: list[str], returned: list[str], when: str) -> Diagnostic:
    """Return TLT0611 for ``missing`` signals; its title lists the signals that were ``returned``."""
    names = ", ".join(f"`{name}`" for name in missing)
    listed = ", ".join(f"`{name}`" for name in returned[:_MOST_LISTED]) + (
        ", …" if len(returned) > _MOST_LISTED else ""
    )
    close = get_close_matches(missing[0], returned, n=1)
    advice = "supply every signal that the atoms use"
    if close:
        advice = f"is `{close[0]}` what the spec calls `{missing[0]}`?"
    return Diagnostic("TLT0611", f"{when}: no value for {names}; `signals` gave {listed or 'none'}", help=advice)
