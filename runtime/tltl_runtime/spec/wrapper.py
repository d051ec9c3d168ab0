"""A spec for anybody's Gymnasium environment: its automaton in the observation, its reward, its verdict."""

from __future__ import annotations

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
from numpy.typing import NDArray

from tltl_runtime.spec.task import load_task
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor import MonitorError, RewardOptions, Step
from tltlc.monitor.samples import number

SignalsFunction = Callable[[gymnasium.Env[Any, Any]], Mapping[str, SupportsFloat]]
Observation = dict[str, Any]

_MOST_LISTED: Final = 12
"""Of the signals that a function gave, as many are named in a message."""


class TltlEnv(gymnasium.Wrapper[Observation, Any, Any, Any], RecordConstructorArgs):
    """An environment whose episodes are rewarded and ended by a spec.

    ``spec`` is whatever :func:`tltl_runtime.spec.task.load_task` takes.  ``signals`` is given the wrapped environment
    after
    each step and returns the spec's signals by name, numbers in SI units or bools; without it, the environment's own
    ``tltl_signals()`` does.  It is called after a reset, too, where the automaton takes no step, so that a signal that
    it lacks is noticed at once.  ``params`` are values of the spec's params, in SI units, before those that the
    environment's ``tltl_params()`` offers, where it has one.

    Observation: ``automaton``, the state as a one-hot vector, and ``progress``, the best so far, shape (1,), in
    [0, 1], both float32, join the keys of a Dict space; what is in any other space becomes ``observation`` beside them.

    Reward: that of its mode; the environment's own is ``info["env_reward"]``.  The episode is ``terminated`` by
    success, by violation and by the environment, ``truncated`` at the spec's limit and by the environment.  Where the
    environment ends it before the spec does, that is a success iff the trace so far is accepted and the spec is not
    one to be outlived up to a limit; where there is a limit, a failure costs the step penalties that it left
    unspent, as a violation does, so that every failed episode totals progress - 1.

    ``info`` gains ``verdict``, ``state``, ``label``, ``progress``, ``success`` (the episode ended here, in success),
    ``limiting``, ``atoms`` (their values by name, none after a reset) and ``env_reward`` (0 after a reset); what the
    environment says under these names is lost.

    ``sample`` is what ``signals`` gave last, and ``taken`` the monitor's :class:`~tltlc.monitor.Step` on it, None after
    a reset: with ``task`` all that a recording of the episode needs.

    Raises:
        TltlError: what :func:`load_task` raises; TLT0617 where the environment has a ``tltl_clock_s``, in seconds a
            step, and the spec's clock is another.
        TypeError: an argument is of another type, or there are no ``signals``.
        ValueError: the observation space has a key ``automaton`` or ``progress``.
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
        # Not copied deeply: `signals` may be a method of something that cannot be, such as a running game.
        RecordConstructorArgs.__init__(
            self, _disable_deepcopy=True, spec=spec, signals=signals, reward=reward, params=params
        )
        gymnasium.Wrapper.__init__(self, env)
        self._signals: SignalsFunction = _own_signals if signals is None else signals
        if signals is None and not env.has_wrapper_attr("tltl_signals"):
            raise TypeError("give `signals`, a function of the environment: it has no method tltl_signals() of its own")
        if not callable(self._signals):
            raise TypeError(f"`signals` is a function of the environment, not {signals!r:.60}: `lambda env: {{…}}`")
        offered = env.get_wrapper_attr("tltl_params")() if env.has_wrapper_attr("tltl_params") else {}
        self.task = load_task(spec, {} if params is None else params, reward, offered=offered)
        _check_clock(self.task.fspa, env)
        self.observation_space = _with_automaton(env.observation_space, len(self.task.fspa.states))
        self._flat = not isinstance(env.observation_space, spaces.Dict)
        self._monitor = self.task.monitor()
        self.sample: Mapping[str, SupportsFloat] = {}
        self.taken: Step | None = None
        self._names = tuple(atom.name for atom in self.task.fspa.atoms)
        self._inputs = self.task.fspa.signals
        self._one_hot: NDArray[np.float32] = np.eye(len(self.task.fspa.states), dtype=np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode in the automaton's initial state.

        Raises:
            MonitorError: TLT0611 and TLT0612, where the signals are not those of the spec.
            TypeError: ``signals`` returned no mapping.
        """
        observation, info = self.env.reset(seed=seed, options=options)
        self._monitor.reset()
        self.taken = None
        sample = self._sample("after the reset")
        for signal in self._inputs:
            number(signal, sample[signal.name], "after the reset")
        start = self.task.fspa.states[0]
        info = {
            **info,
            "verdict": start.verdict,
            "state": 0,
            "unmet": 0,
            "label": start.label.ascii,
            "progress": 0.0,
            "success": False,
            "limiting": None,
            "atoms": {},
            "env_reward": 0.0,
        }
        return self._observed(observation), info

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Take a step in the environment, then one in the automaton.

        Raises:
            MonitorError: what :meth:`tltlc.monitor.Monitor.step` raises.
            TypeError: ``signals`` returned no mapping.
        """
        observation, env_reward, terminated, truncated, info = self.env.step(action)
        sample = self._sample(f"step {self._monitor.steps + 1}")
        before = self._monitor.state
        self.taken = step = self._monitor.step(sample, last=terminated or truncated)
        for notice in self._monitor.notices:
            warnings.warn(f"{notice.code}: {notice.title}", stacklevel=2)
        self._monitor.notices.clear()
        settled = step.done and (self._monitor.success or step.verdict == "violated")
        terminated = terminated or settled
        truncated = truncated or (step.done and not terminated)
        info = {**info, **self._said(step, before), "env_reward": env_reward}
        return self._observed(observation), step.reward, terminated, truncated, info

    def _sample(self, when: str) -> Mapping[str, SupportsFloat]:
        """What ``signals`` gives, with all that the spec needs; ``when`` is for messages."""
        given = self._signals(self.env)
        if not isinstance(given, Mapping):
            raise TypeError(f"{when}: `signals` must return a mapping from names to numbers, not {given!r:.80}")
        missing = [signal.name for signal in self._inputs if signal.name not in given]
        if missing:
            raise MonitorError([_missing(missing, [str(name) for name in given], when)])
        self.sample = given
        return given

    def _said(self, step: Step, before: int) -> dict[str, Any]:
        """What ``info`` has of a step from the state ``before``."""
        return {
            "verdict": step.verdict,
            "state": step.state,
            "unmet": before if step.verdict == "violated" else step.state,
            "label": step.label,
            "progress": step.progress,
            "success": self._monitor.success,
            "limiting": step.limiting,
            "atoms": dict(zip(self._names, self._monitor.values, strict=True)),
        }

    def _observed(self, observation: Any) -> Observation:
        own = {
            "automaton": self._one_hot[self._monitor.state].copy(),
            "progress": np.array([self._monitor.progress], dtype=np.float32),
        }
        return {"observation": observation, **own} if self._flat else {**observation, **own}


def _own_signals(env: gymnasium.Env[Any, Any]) -> Mapping[str, SupportsFloat]:
    signals: Mapping[str, SupportsFloat] = env.get_wrapper_attr("tltl_signals")()
    return signals


def _with_automaton(space: spaces.Space[Any], states: int) -> spaces.Dict:
    """The space with the automaton's keys behind its own."""
    inner = dict(space.spaces) if isinstance(space, spaces.Dict) else {"observation": space}
    taken = {"automaton", "progress"} & inner.keys()
    if taken:
        raise ValueError(f"the environment's observation already has the key {min(taken)!r}")
    inner["automaton"] = spaces.Box(0.0, 1.0, (states,), np.float32)
    inner["progress"] = spaces.Box(0.0, 1.0, (1,), np.float32)
    return spaces.Dict(inner)


def _check_clock(fspa: Fspa, env: gymnasium.Env[Any, Any]) -> None:
    """TLT0617 where the spec counts its seconds in other steps than the environment takes."""
    if fspa.clock_s is None or not env.has_wrapper_attr("tltl_clock_s"):
        return
    clock_s = env.get_wrapper_attr("tltl_clock_s")
    if not isclose(fspa.clock_s, clock_s, rel_tol=1e-9):
        title = f"`{fspa.name}` is sampled every {fspa.clock_s:g} s, and a step of the environment takes {clock_s:g} s"
        raise TltlError([Diagnostic("TLT0617", title, help=f"write `clock {clock_s:g} s` in the specification")])


def _missing(missing: list[str], given: list[str], when: str) -> Diagnostic:
    """TLT0611, with what there is instead."""
    names = ", ".join(f"`{name}`" for name in missing)
    listed = ", ".join(f"`{name}`" for name in given[:_MOST_LISTED]) + (", …" if len(given) > _MOST_LISTED else "")
    close = get_close_matches(missing[0], given, n=1)
    way_out = "supply every signal that the atoms use"
    if close:
        way_out = f"is `{close[0]}` what the spec calls `{missing[0]}`?"
    return Diagnostic("TLT0611", f"{when}: no value for {names}; `signals` gave {listed or 'none'}", help=way_out)
