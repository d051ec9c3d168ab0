"""N copies of an automaton that run on samples side by side, on a CPU or a GPU."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import torch
from numpy.typing import ArrayLike
from torch import Tensor

from tltl_runtime.spec.automaton_observation import observed_registers
from tltl_runtime.spec.batch.guards import PrimeSets, Transitions
from tltl_runtime.spec.batch.progress_and_reward import VERDICTS, Outcomes
from tltl_runtime.spec.batch.reward_modes import BatchTransition, reward_mode
from tltl_runtime.spec.batch.samples import BatchSamples, BatchSampleValues
from tltlc.api import Fspa, RewardOptions, monitors

_VIOLATED = VERDICTS.index("violated")


class BatchStep:
    """The result of one step: of one sample in each of N environments.

    Every tensor is [N], unless another shape is given, and is never modified.

    - ``state``: int64, the state after the sample.
    - ``done``: bool, the episode has ended, in this step or before.
    - ``success``: bool, the episode has ended in success.
    - ``progress``: the best progress so far, in [0, 1].
    - ``reward``: the reward of this step, 0 after the end of the episode.
    - ``edge``: int64, the index of the edge taken.
    - ``values``: the values of the atoms, [atoms, N], in [-1, 1].

    The properties are computed on first use.
    """

    def __init__(
        self,
        monitor: BatchMonitor,
        edge: Tensor,
        values: Tensor,
        state: Tensor,
        done: Tensor,
        success: Tensor,
        progress: Tensor,
        reward: Tensor,
    ) -> None:
        self._monitor = monitor
        self.edge, self.values, self.state, self.done = edge, values, state, done
        self.success, self.progress, self.reward = success, progress, reward

    @cached_property
    def accepting(self) -> Tensor:
        """Whether the automaton accepts the trace so far, bool [N]."""
        return self._monitor.accepting_states.index_select(0, self.state)

    @cached_property
    def truncated(self) -> Tensor:
        """Whether the episode has ended at the spec's limit without success or violation, bool [N]."""
        return self.done & ~self.success & (self.verdict != _VIOLATED)

    @cached_property
    def verdict(self) -> Tensor:
        """The verdict on the trace so far, int64 [N].

        It is an index into :data:`~tltl_runtime.spec.batch.progress_and_reward.VERDICTS`.
        """
        return self._monitor.state_verdicts.index_select(0, self.state)

    @cached_property
    def robustness(self) -> Tensor:
        """The robustness of the guard of the edge taken, in [-1, 1], shape [N]."""
        return self._monitor.guards.robustness_of(self.edge, self.values) + 0.0

    @cached_property
    def limiting(self) -> Tensor:
        """The index of the atom that most hinders the automaton from getting nearer to acceptance, int64 [N].

        This is the atom of the least robust literal in the most robust prime implicant of the edges
        towards acceptance. The index is -1 if the state changed, or if no edge leads to a state
        nearer to acceptance.
        """
        return self._monitor.outcomes.nearest.bounding_atom(self.edge, self.values)


class BatchMonitor:
    """Runs ``count`` copies (N) of an automaton, one for each environment.

    The environments may be in different states and episodes. After the end of an episode, the
    automaton of its environment continues with reward 0 until it is reset, as in
    :class:`tltlc.monitor.Monitor`.

    ``state`` int64 [N], ``steps`` [N], ``progress`` [N] and ``registers`` [registers, N] are the values
    after the last step. A monitor remembers the trace so far in registers.
    ``clamped`` counts values out of range, by the names of signals and atoms. ``signal_names`` is
    the order of signals in a tensor.

    The results equal those of ``count`` :class:`tltlc.monitor.Monitor` objects. On a CPU in float64
    they are equal to the last bit, except for the sign of zeros, and except for operations that torch
    and the C library round differently (``exp``, ``tanh``, ``sqrt``, powers other than 2 and 3, the
    discounted penalty). Results of these agree within 1e-12. An atom whose value is that close to 0,
    or to a border between cases, may be true in one monitor and false in the other. In float32 all
    results agree within 1e-6. If a number of the spec, such as the end of a range, is too large or
    too small for ``dtype``, atoms are computed in float64.

    To check samples, a step waits for the torch device a few times. With ``checked=False`` a step
    waits only if the reward mode is not computed with tensors
    (:class:`~tltl_runtime.spec.batch.reward_modes.RowByRow`). An unchecked step clamps values out
    of range without counting them. A NaN makes the atoms that use it false, and may appear in
    progress and reward. If atoms that the spec declares ``exclusive`` hold at once, the automaton
    takes an arbitrary edge from its state.

    Raises:
        MonitorError: TLT0307 and TLT0308, a param has an invalid value or does not exist.
        TypeError: ``fspa`` is not an automaton, or ``reward`` is not RewardOptions.
        ValueError: ``count`` is below 1.
    """

    def __init__(
        self,
        fspa: Fspa,
        count: int,
        *,
        reward: RewardOptions | None = None,
        params: Mapping[str, float] | None = None,
        device: torch.device | str = "cpu",
        dtype: torch.dtype = torch.float64,
        checked: bool = True,
    ) -> None:
        self.fspa, options = monitors.automaton_argument(fspa), monitors.reward_options_argument(reward)
        self.count, self.device, self.dtype = count, torch.device(device), dtype
        self._checked = checked
        if count < 1:
            raise ValueError(f"at least one environment is needed, not {count}")
        self._samples = BatchSamples(fspa, count, params, self.device, dtype, checked)
        self.signal_names, self.clamped = self._samples.names, self._samples.clamped
        self._transitions = Transitions(fspa, self.device, checked)
        self._targets = torch.tensor([edge.target for edge in fspa.edges], dtype=torch.int64, device=self.device)
        self.outcomes = Outcomes(fspa, options, self.device, dtype)
        self.guards = PrimeSets([edge.guard.primes for edge in fspa.edges], len(fspa.atoms), self.device, -1.0)
        self.accepting_states = torch.tensor([state.accepting for state in fspa.states], device=self.device)
        self.state_verdicts = torch.tensor(
            [VERDICTS.index(state.verdict) for state in fspa.states], dtype=torch.int64, device=self.device
        )
        # The reward of mode "progress" is that of Algorithm 1, which runs in every mode.
        self._mode = None if options.mode == "progress" else reward_mode(fspa, options, self.device, dtype)
        observed = observed_registers(fspa)
        self._observed = torch.tensor([register.index for register in observed], dtype=torch.int64, device=self.device)
        ranges = torch.tensor([(each.low, each.high - each.low) for each in observed], dtype=dtype, device=self.device)
        self._low, self._span = ranges.reshape(-1, 2, 1).unbind(1)
        self.reset()

    def reset(self, mask: ArrayLike | Tensor | None = None) -> None:
        """Begin a new episode in the environments that ``mask`` chooses.

        ``mask`` is bool [N], or None for all environments.

        Raises:
            ValueError: ``mask`` has another shape or type.
        """
        fresh = self._start()
        if mask is not None:
            chosen = torch.as_tensor(mask, device=self.device)
            if chosen.shape != (self.count,) or chosen.dtype != torch.bool:
                expected = f"torch.bool of the shape {(self.count,)}"
                raise ValueError(f"the mask must be {expected}, not {chosen.dtype} of {tuple(chosen.shape)}")
            fresh = tuple(torch.where(chosen, new, old) for new, old in zip(fresh, self._episode(), strict=True))
        self.state, self.steps, self.progress, self._done, self._success, self._memory, self.registers = fresh

    def step(
        self, signals: Mapping[str, ArrayLike | Tensor] | ArrayLike | Tensor, dt: ArrayLike | Tensor | None = None
    ) -> BatchStep:
        """Take one sample of each environment.

        ``signals`` maps names to arrays [N], or is one array [N, signals] in the order of
        ``signal_names``. Tensors, NumPy arrays and lists are accepted. Numbers are in SI units;
        bools count as 0 and 1. Names that no atom uses are ignored. With ``clock varies``, ``dt`` is the
        time since the sample before in seconds, at least 0: an array [N], or one number for all.

        Raises:
            MonitorError: TLT0611, signals are missing; TLT0612, a signal has no usable value;
                TLT0613, an atom or a register has no value; TLT0614, exclusive atoms hold at once;
                TLT0619, ``dt`` is missing, wrong, or there although the clock is fixed. No automaton
                takes a step then. If not ``checked``, only TLT0611 is raised, and TLT0619 for a ``dt``
                that is missing or too much.
            ValueError: an array has another shape.
        """
        return self._take(self._samples.values(signals, self.registers, dt))

    def step_atoms(self, values: ArrayLike | Tensor, dt: ArrayLike | Tensor | None = None) -> BatchStep:
        """Take one sample of each environment: the ``values`` of the atoms, [N, atoms], in [-1, 1].

        Atoms that follow from others have no value, as in :meth:`tltlc.monitor.Monitor.step_atoms`. ``dt``
        is that of :meth:`step`.

        Raises:
            MonitorError: TLT0614, exclusive atoms hold at once, only if ``checked``; TLT0619, as in
                :meth:`step`. No automaton takes a step then.
            ValueError: the shape is another or, if ``checked``, a value is not in [-1, 1].
        """
        rows = torch.as_tensor(values)
        shape = (self.count, len(monitors.given_atoms(self.fspa)))
        fits = rows.shape == shape
        if not fits or (self._checked and not bool((rows.abs() <= 1.0).all())):
            raise ValueError(f"values in [-1, 1] of shape {shape} are needed")
        given = rows.to(self.device, self.dtype).t().contiguous()
        return self._take(self._samples.from_atoms(given, self.registers, dt))

    def one_hot(self, dtype: torch.dtype = torch.float32) -> Tensor:
        """Return the current states of the automata as one-hot rows, shape [N, states]."""
        rows = torch.zeros((self.count, len(self.fspa.states)), dtype=dtype, device=self.device)
        return rows.scatter_(1, self.state[:, None], 1.0)

    def observation(self, dtype: torch.dtype = torch.float32) -> Tensor:
        """Return what agents observe of the automata, as :class:`~tltl_runtime.spec.wrapper.TltlEnv` does.

        Each of the N rows has the state as a one-hot vector, and then each observed register as its
        share of its range, in [0, 1]. Without registers, this is :meth:`one_hot`.
        """
        one_hot = self.one_hot(dtype)
        if not len(self._observed):
            return one_hot
        shares = (self.registers.index_select(0, self._observed) - self._low) / self._span
        return torch.cat([one_hot, shares.clamp(0.0, 1.0).t().to(dtype)], 1)

    def _take(self, sample: BatchSampleValues) -> BatchStep:
        values = sample.atoms
        edge = self._transitions.edge(self.state, values > 0.0)
        source, state = self.state, self._targets.index_select(0, edge)
        steps = self.steps + 1.0
        progress = torch.maximum(self.progress, self.outcomes.progress(edge, values, steps))
        ends = self.outcomes.done(edge, steps)
        succeeds = ends & self.outcomes.accepting(edge)
        memory = self._memory
        if self._mode is None:
            reward = self.outcomes.reward(edge, progress - self.progress, steps)
        else:
            reward, memory = self._mode.reward(BatchTransition(source, state, values, ends, succeeds), memory)
        reward = reward.masked_fill_(self._done, 0.0)

        success = self._success | (succeeds & ~self._done)
        done = self._done | ends
        self.state, self.steps, self.progress, self._done, self._success, self._memory = (
            state, steps, progress, done, success, memory,
        )  # fmt: skip
        self.registers = sample.registers
        return BatchStep(self, edge, values, state, done, success, progress, reward)

    def _episode(self) -> tuple[Tensor, ...]:
        return (self.state, self.steps, self.progress, self._done, self._success, self._memory, self.registers)

    def _start(self) -> tuple[Tensor, ...]:
        """Return the tensors that describe new episodes, before the first sample of each environment.

        They are state, steps, progress, done, success, the memory of the reward mode, and the registers.
        """
        numbers = torch.zeros(self.count, dtype=self.dtype, device=self.device)
        flags = torch.zeros(self.count, dtype=torch.bool, device=self.device)
        memory = numbers if self._mode is None else self._mode.start(self.count)
        return (numbers.to(torch.int64), numbers, numbers, flags, flags, memory, self._samples.initial)
