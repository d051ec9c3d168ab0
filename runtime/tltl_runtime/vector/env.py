"""A vector environment whose environments are stepped by worker processes."""

from __future__ import annotations

import logging
import multiprocessing
import weakref
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, Literal, NoReturn

import gymnasium
import numpy as np
from gymnasium.error import ClosedEnvironmentError, ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import DTypeLike, NDArray

from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.vector.actions import check_batch
from tltl_runtime.vector.arguments import check_arguments, split_mask
from tltl_runtime.vector.cores import cores
from tltl_runtime.vector.errors import Loss, Playing, WorkerError, report
from tltl_runtime.vector.memory import Rows, read, write_batch
from tltl_runtime.vector.worker import EnvFunction
from tltl_runtime.vector.workers import Workers, shared_out

if TYPE_CHECKING:
    from tltl_runtime.vector.ray_workers import RayWorkers

TLTL_INFO: Final[Mapping[str, DTypeLike]] = {
    "verdict": "U9",
    "state": np.int64,
    "progress": np.float64,
    "success": np.bool_,
}
"""What ``info`` has of a TltlEnv at each step; the rest of it comes with the end of an episode."""

_ALL: Final = slice(None)
_SEEDS: Final = 2**31

_log = logging.getLogger(__name__)


class WorkerVectorEnv(VectorEnv[Any, Any, NDArray[Any]]):
    """The environments that ``functions`` make, of equal spaces, in ``workers`` processes.

    A worker steps its share one after the other; observations, actions and numbers are in memory that all share.
    ``workers`` is by default as many as there are cores, and never more than environments.  Same seeds and actions
    give the same episodes, bit for bit, for any number of workers and in this process.  With ``workers="ray"`` they are
    actors of a Ray cluster, one on each of its free cores (:func:`~tltl_runtime.vector.cluster.cluster` says which),
    which processes of torchrun share.

    ``autoreset`` is ``SAME_STEP`` (the observation is the new episode's, ``final_obs`` and ``final_info`` are the
    old one's) or ``NEXT_STEP``, as Gymnasium defines them.  ``infos`` has the keys ``info`` at every step, an array
    each; by default those of a :class:`~tltl_runtime.spec.wrapper.TltlEnv`: ``verdict``, ``state``, ``progress``,
    ``success``.  All else that an environment says comes with a reset and with the end of an episode, which has
    ``episode``, too: the sum of its rewards ``r`` and its length ``l``.

    A worker that ends, raises or is silent for ``timeout`` seconds is reported: what happened, and name (``names``,
    one for each environment), seed, episode and step of all that it was playing.  With ``on_death="stop"`` this is
    a :class:`WorkerError`, and this environment is closed.  With ``"replace"`` another worker takes its place,
    the report goes to this module's logger, and its environments begin episodes of new seeds: their step is
    ``truncated``, of reward 0, its ``final_obs`` the last observation, and ``infos["lost"]`` is True there.

    Where an environment has a method ``prepare``, its worker calls it while it is asked for nothing else, as long as
    that returns True: so it does a little of what can be done before the next reset.

    Functions that are not importable, such as lambdas, are pickled by value.  A process starts by importing the main
    module, so a script's own work stands under ``if __name__ == "__main__"``.

    Raises:
        ValueError: spaces of no fixed size, or other arguments that do not fit.
        TypeError: arguments of another type.
        WorkerError: an environment cannot be made, or has other spaces than the first.
        TltlError: TLT0730 and TLT0852, there is no Ray or no cluster.
    """

    def __init__(
        self,
        functions: Sequence[EnvFunction],
        workers: int | Literal["ray"] | None = None,
        *,
        names: Sequence[str] | None = None,
        autoreset: AutoresetMode | str = AutoresetMode.SAME_STEP,
        info: Mapping[str, DTypeLike] | None = None,
        on_death: Literal["stop", "replace"] = "stop",
        timeout: float = 60.0,
    ) -> None:
        autoreset = AutoresetMode(autoreset)
        check_arguments(functions, workers, names, autoreset, on_death)
        self.num_envs = len(functions)
        example = functions[0]()
        self.metadata = {**example.metadata, "autoreset_mode": autoreset}
        self.render_mode = example.render_mode
        self.single_observation_space = example.observation_space
        self.single_action_space = example.action_space
        self.observation_space = batch_space(example.observation_space, self.num_envs)
        self.action_space = batch_space(example.action_space, self.num_envs)
        info = (TLTL_INFO if _has_spec(example) else {}) if info is None else info
        name = example.spec.id if example.spec else type(example.unwrapped).__name__
        example.close()

        self._names = tuple(names or [name] * self.num_envs)
        self._replaces = on_death == "replace"
        self._seeds: list[int | None] = [None] * self.num_envs
        self._observations: Any = None
        self._untried: set[int] = set()
        """Workers that were replaced and have not taken a step since."""
        context = multiprocessing.get_context("spawn")
        self._rows = Rows(context, self.num_envs, self.single_observation_space, self.single_action_space, info)
        self._workers: Workers | RayWorkers
        if workers == "ray":
            from tltl_runtime.vector.ray_workers import RayWorkers

            self._workers = RayWorkers(functions, self._rows, info, autoreset, timeout)
        else:
            shares = list(shared_out(self.num_envs, min(workers or cores(), self.num_envs)))
            self._workers = Workers(context, functions, shares, self._rows, autoreset, timeout)
        self._finalizer = weakref.finalize(self, self._workers.close)
        for loss in self._workers.start(range(len(self._workers.shares))):
            self._stop(loss)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode in each environment: with ``seed + i`` in the i-th, with the seeds of a sequence, or, as
        without a seed, where its generator stands.  The first reset without a seed draws one for each.

        ``options["reset_mask"]``, a bool for each, leaves the others where they are; it is not passed on.
        """
        self._check_open()
        if self._workers.is_waiting:
            self._workers.answers()
        chosen, options = split_mask(options, self.num_envs)
        if self._observations is None and not chosen.all():
            raise ResetNeeded("there are no episodes that could go on: reset all environments first")
        seeds = self._seeds_of(seed)
        for index in np.flatnonzero(chosen):
            if seeds[index] is not None:
                self._seeds[index] = seeds[index]
        arguments = [(seeds[share], options, chosen[share].tolist()) for share in self._workers.shares]
        infos: dict[str, Any] = {}
        for answer in self._workers.ask("reset", arguments):
            if isinstance(answer, Loss):
                began = self._replace(answer)
                answer = [(row, info if chosen[row] else {**info, "lost": True}) for row, info in began]
            for row, info in answer:
                infos = self._add_info(infos, info, row)
        return self._observed(), self._with_numbers(infos)

    def step(
        self, actions: Any
    ) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Take a step in each environment.

        Raises:
            ValueError: there is not one action of the space for each; no step is taken.
            ResetNeeded: there was no reset.
            WorkerError: a worker was lost, and ``on_death`` is ``stop``.
        """
        self._check_ready()
        if self._observations is None:
            raise ResetNeeded("there is no episode to go on with: reset first")
        check_batch(self.single_action_space, actions, self.num_envs)
        write_batch(self._rows.action, actions)
        infos: dict[str, Any] = {}
        for worker, answer in enumerate(self._workers.ask("step", [()] * len(self._workers.shares))):
            if isinstance(answer, Loss):
                answer = self._continue(answer)
            else:
                self._untried.discard(worker)
            for row, info in answer:
                infos = self._add_info(infos, info, row)
        rows = self._rows
        ends = rows.reward.copy(), rows.terminated.copy(), rows.truncated.copy()
        return self._observed(), *ends, self._with_numbers(infos)

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """An attribute of each environment, or what it gives when it is called."""
        return self._asked("call", [(name, args, kwargs)] * len(self._workers.shares))

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """An attribute of each environment."""
        return self.call(name)

    def set_attr(self, name: str, values: Any) -> None:
        """Set an attribute of each environment: a list or a tuple has a value for each, all else is one for all."""
        each = list(values) if isinstance(values, (list, tuple)) else [values] * self.num_envs
        if len(each) != self.num_envs:
            raise ValueError(f"{self.num_envs} values are needed, not {len(each)}")
        self._asked("set_attr", [(name, each[share]) for share in self._workers.shares])

    def render(self) -> tuple[Any, ...] | None:
        """What each environment renders."""
        return self.call("render")

    def close_extras(self, **_: Any) -> None:
        """End the workers."""
        self._finalizer()

    @property
    def worker_pids(self) -> tuple[int | None, ...]:
        """The process ids of the workers; None for those of a Ray cluster."""
        return tuple(self._workers.pid(worker) for worker in range(len(self._workers.shares)))

    def _asked(self, command: str, arguments: Sequence[tuple[Any, ...]]) -> tuple[Any, ...]:
        """What the environments give, in order; a worker that is lost meanwhile is not replaced."""
        self._check_ready()
        answers = self._workers.ask(command, arguments)
        for answer in answers:
            if isinstance(answer, Loss):
                self._stop(answer)
        return tuple(value for answer in answers for value in answer)

    def _check_open(self) -> None:
        if self.closed:
            raise ClosedEnvironmentError("this vector environment is closed")

    def _check_ready(self) -> None:
        self._check_open()
        if self._workers.is_waiting:
            raise ResetNeeded("what was last asked of the workers was interrupted: reset first")

    def _seeds_of(self, seed: int | Sequence[int | None] | None) -> list[int | None]:
        if isinstance(seed, (int, np.integer)):
            super().reset(seed=int(seed))
            return [int(seed) + index for index in range(self.num_envs)]
        if seed is not None:
            if len(seed) != self.num_envs:
                raise ValueError(f"{self.num_envs} seeds are needed, not {len(seed)}")
            return [None if each is None else int(each) for each in seed]
        return [self._new_seed() if known is None else None for known in self._seeds]

    def _new_seed(self) -> int:
        return int(self.np_random.integers(_SEEDS))

    def _observed(self) -> Any:
        self._observations = read(self._rows.observation, _ALL)
        return self._observations

    def _with_numbers(self, infos: dict[str, Any]) -> dict[str, Any]:
        """``infos`` with what stands in the rows, for all environments."""
        for key, column in self._rows.info.items():
            infos[key] = column.copy()
            infos[f"_{key}"] = np.ones(self.num_envs, dtype=np.bool_)
        return infos

    # Losses

    def _continue(self, loss: Loss) -> list[tuple[int, dict[str, Any]]]:
        """Replace a worker in the middle of a step: what there is to say of its environments, by row."""
        share = self._workers.shares[loss.worker]
        began = self._replace(loss)
        self._rows.truncated[share] = True
        said = []
        for row, info in began:
            last = read(self._observations, row)
            said.append((row, {"final_obs": last, "final_info": {"lost": True}, "lost": True, **info}))
        return said

    def _replace(self, loss: Loss) -> list[tuple[int, dict[str, Any]]]:
        """Put another worker in the place of the lost one, and begin episodes there; their infos, by row."""
        if not self._replaces or loss.worker in self._untried:
            self._stop(loss)
        share = self._workers.shares[loss.worker]
        playing = self._playing(share)
        for row in range(share.start, share.stop):
            self._seeds[row] = self._new_seed()
        seeds = self._seeds[share]
        _log.warning("%s\nanother begins with seeds %s", report(loss, playing), seeds)
        self._untried.add(loss.worker)
        self._rows.busy[share] = False
        for failure in self._workers.start([loss.worker]):
            self._stop(failure)
        self._workers.tell(loss.worker, "reset", (seeds, None, [True] * len(seeds)))
        (answer,) = self._workers.answers()
        if isinstance(answer, Loss):
            self._stop(answer)
        began: list[tuple[int, dict[str, Any]]] = answer
        return began

    def _stop(self, loss: Loss) -> NoReturn:
        playing = self._playing(self._workers.shares[loss.worker])
        self.close()
        raise WorkerError(loss, playing)

    def _playing(self, share: slice) -> tuple[Playing, ...]:
        rows = self._rows
        return tuple(
            Playing(
                env=row,
                name=self._names[row],
                seed=self._seeds[row],
                episode=int(rows.episode[row]),
                step=int(rows.step[row]),
                busy=bool(rows.busy[row]),
            )
            for row in range(share.start, share.stop)
        )


def _has_spec(env: gymnasium.Env[Any, Any]) -> bool:
    while isinstance(env, gymnasium.Wrapper):
        if isinstance(env, TltlEnv):
            return True
        env = env.env
    return False
