"""The monitor: runs an automaton on samples, step by step."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from copy import copy
from typing import Any, Final, NamedTuple, SupportsFloat

from tltlc.automaton.fspa import Fspa, State, Verdict
from tltlc.automaton.text import label_text
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.arguments import automaton_argument, reward_options_argument
from tltlc.monitor.exclusive import check_exclusive
from tltlc.monitor.failure import Failure, breaks, cause_of
from tltlc.monitor.guards import bounding_atom, holds, robustness
from tltlc.monitor.progress_and_reward import RewardOptions, RewardStep, reward_step
from tltlc.monitor.samples import STEP_LENGTH, Samples, SampleValues
from tltlc.monitor.tables import tables

_NOT_FAILED: Final[dict[str, Any]] = dict.fromkeys(("failed_clause", "failed_atom", "failed_step"))


class Step(NamedTuple):
    """The result of one sample.

    - ``state``: the number of the automaton's state after the sample. ``label`` (what remains to be
      satisfied), ``verdict`` and ``accepting`` are those of this state.
    - ``done``: whether the episode has ended, at this step or before.
    - ``progress``: the best progress so far, in [0, 1].
    - ``reward``: the reward of this step; 0 after the end of the episode.
    - ``robustness``: the robustness of the edge taken, in [-1, 1].
    - ``limiting``: the name of the atom that kept the automaton from a state nearer to a goal. This
      atom determines the robustness of the most robust edge to such a state. None if the state
      changed, or if no edge leads nearer to a goal.
    - ``label_english``: ``label`` in words.
    - ``failed_step``: the number, from 1, of the first step after which no continuation of the trace can
      meet the spec; None if there is one. The next two fields are about that step.
    - ``failed_clause``: the clause that it broke, as the source has it: ``avoid on_lava``. None if only
      several clauses together cannot be met any more.
    - ``failed_atom``: the name of the atom that decides it: the one that had to hold but did not, or else
      the one that must not hold but did.
    """

    state: int
    label: str
    verdict: Verdict
    accepting: bool
    done: bool
    progress: float
    reward: float
    robustness: float
    limiting: str | None
    label_english: str
    failed_clause: str | None
    failed_atom: str | None
    failed_step: int | None


class Monitor:
    """Runs an automaton over one trace after another.

    ``fspa`` is the automaton (finite state predicate automaton). ``params`` maps names of params to
    values that replace the default ones, in SI units. ``reward`` says how steps are rewarded and
    when episodes end. If the monitor is ``sparse``, samples have only the events that happened: a missing bool
    counts as false, and is no error. ``notices`` collects warnings about clamped values, one for each signal or
    atom. After :meth:`step`, ``values`` has the values of the atoms at this sample, in the order of
    ``fspa.atoms``, ``registers`` has the values of its registers after the sample, and ``success`` is
    true if the episode has ended in success. ``failure`` says at which step the trace failed, and why; it
    is None while the trace can still meet the spec.

    Raises:
        MonitorError: TLT0307 a value of ``params`` is outside its range, TLT0308 there is no such
            param, or its value is not a finite number.
        TypeError: ``fspa`` is not an automaton, or ``reward`` is not RewardOptions.
    """

    def __init__(
        self,
        fspa: Fspa,
        params: Mapping[str, float] | None = None,
        reward: RewardOptions | None = None,
        *,
        sparse: bool = False,
    ) -> None:
        self.fspa = automaton_argument(fspa)
        self.notices: list[Diagnostic] = []
        self._samples = Samples(fspa, params, self.notices, sparse=sparse)
        self._tables = tables(fspa)
        self._options = reward_options_argument(reward)
        self._labels: dict[int, tuple[str, str]] = {}
        self._names = tuple(atom.name for atom in fspa.atoms)
        self.reset()

    def another(self) -> Monitor:
        """Return a new monitor of the same automaton, params and reward, before its first sample.

        Use it where there is a monitor for each member of a group, such as the guards of a level. All
        monitors share the tables and the compiled expressions of the first, so that a further one takes
        little memory and time. Nothing else is shared: ``notices`` are its own.
        """
        new = copy(self)
        new.notices = []
        new._samples = self._samples.another(new.notices)
        new.reset()
        return new

    def reset(self) -> None:
        """Start a new trace: go back to the initial state, with no progress. ``notices`` stay."""
        self.state = 0
        self.steps = 0
        self.progress = 0.0
        self.done = False
        self.success = False
        self.failure: Failure | None = None
        self.values: tuple[float, ...] = ()
        self.registers = self._samples.initial
        self._memory: Any = None

    def step(
        self, signals: Mapping[str, SupportsFloat | str], dt: SupportsFloat | None = None, *, last: bool = False
    ) -> Step:
        """Take one sample, and return the result.

        ``signals`` maps the names of signals to bools, to numbers in SI units, or for an enum to the
        name of a value. Names that no atom uses are ignored. With ``clock varies``, ``dt`` is the time
        since the sample before, in seconds, at least 0; at the first sample it counts for nothing. With
        a fixed clock there is no ``dt``. If ``last``, the episode ends with this sample, whatever the
        spec says.

        Raises:
            MonitorError: TLT0611 missing signals, TLT0612 unusable signals, TLT0613 an atom without
                a value, TLT0614 exclusive atoms that hold at once, TLT0619 ``dt`` is missing, wrong, or
                there although the clock is fixed. The state stays unchanged.
        """
        sample = signals if dt is None else {**signals, STEP_LENGTH: dt}
        return self._take(self._samples.values(sample, self.registers, self.steps + 1), last)

    def step_atoms(self, values: Sequence[float], dt: SupportsFloat | None = None, *, last: bool = False) -> Step:
        """Take one sample, given as the values of the atoms in order, and return the result.

        Each value is in [-1, 1]. Atoms that follow from others have no value: ``times(seen) > 3``
        follows from ``seen`` (:func:`tltlc.automaton.memory.given_atoms`). ``dt`` and ``last`` are those
        of :meth:`step`.

        Raises:
            MonitorError: TLT0614 exclusive atoms that hold at once, TLT0619 ``dt`` is missing, wrong, or
                there although the clock is fixed. The state stays unchanged.
            ValueError: a value is not in [-1, 1], or the number of values is not the number of
                atoms that do not follow from others. The state stays unchanged.
        """
        count = len(self._samples.given)
        if len(values) != count or not all(-1.0 <= value <= 1.0 for value in values):
            needed = "one value in [-1, 1] is" if count == 1 else f"{count} values in [-1, 1] are"
            raise ValueError(f"{needed} needed, not {tuple(values)}")
        length = self._samples.step_length(dt, self.steps + 1)
        return self._take(self._samples.from_atoms(values, self.registers, length, self.steps + 1), last)

    def step_test(self, numbers: Mapping[str, float], holds: Collection[str], dt: SupportsFloat | None = None) -> Step:
        """Take one sample as a ``step`` of a test gives it, and return the result.

        ``numbers`` maps the names of some signals to numbers in SI units. Atoms that depend on no other
        number are computed, and so are those that follow from other atoms. Of the rest, those named in
        ``holds`` hold, with the value 1, and the others do not, with the value -1. ``dt`` is that of
        :meth:`step`.

        Raises:
            MonitorError: TLT0613 an atom without a value, TLT0614 exclusive atoms that hold at once, TLT0619
                as for :meth:`step`. The state stays unchanged.
        """
        length = self._samples.step_length(dt, self.steps + 1)
        return self._take(self._samples.of_test(numbers, holds, self.registers, length, self.steps + 1), last=False)

    def _take(self, sample: SampleValues, last: bool) -> Step:
        values = sample.atoms
        check_exclusive(self.fspa, values, self.steps + 1)
        source = self.state
        edge_taken = next(edge for edge in self._tables.edges[source] if holds(edge.guard, values))
        target = self.fspa.states[edge_taken.target]
        outcome = reward_step(
            self._tables, source, target.id, values, self.progress, self.steps + 1, self._options, last
        )
        reward = 0.0 if self.done else self._reward(source, target.id, values, outcome)
        improving = self._tables.improving[source] if source == target.id else ()
        labels = self._labels.get(target.id)
        if labels is None:
            labels = self._labels[target.id] = self._label(target)
        if self.failure is None and target.verdict == "violated":
            cause = cause_of(edge_taken, values) if breaks(self.fspa, edge_taken) else None
            self.failure = Failure(self.steps + 1, source, cause)

        self.state, self.steps, self.values = target.id, self.steps + 1, values
        self.registers = sample.registers
        self.progress = outcome.progress
        if not self.done:
            self.done, self.success = outcome.done, outcome.success
        return Step(
            state=target.id,
            label=labels[0],
            verdict=target.verdict,
            accepting=target.accepting,
            done=self.done,
            progress=self.progress,
            reward=reward,
            # Adding 0 replaces -0 by 0, so that all monitors print the same number.
            robustness=robustness(edge_taken.guard, values) + 0.0,
            limiting=self._names[bounding_atom([edge.guard for edge in improving], values)] if improving else None,
            label_english=labels[1],
            **self._failed(),
        )

    def _label(self, state: State) -> tuple[str, str]:
        """Return the label of a state as a formula and in words, also if what atoms remember nests deep."""
        from tltlc.automaton.finite.blowup import recursion_room

        with recursion_room():
            return str(state.label), label_text(self.fspa, state.id)

    def _failed(self) -> dict[str, Any]:
        """Return the fields of a step about the failure."""
        if self.failure is None:
            return _NOT_FAILED
        cause = self.failure.cause
        clause = None if cause is None or cause.clause is None else self.fspa.clauses[cause.clause]
        atom = None if cause is None or cause.atom is None else self._names[cause.atom]
        return {"failed_clause": clause, "failed_atom": atom, "failed_step": self.failure.step}

    def _reward(self, source: int, target: int, values: Sequence[float], outcome: RewardStep) -> float:
        if self._options.mode == "progress":
            return outcome.reward
        from tltlc.monitor.reward_modes import Transition, mode_function

        transition = Transition(source, target, values, outcome.done, outcome.success)
        reward, self._memory = mode_function(self._options.mode)(self._tables, transition, self._options, self._memory)
        return reward
