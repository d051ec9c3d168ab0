"""A vector environment whose environments are stepped by worker processes."""

from __future__ import annotations

import logging
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, Literal, NoReturn

import gymnasium
import numpy as np
from gymnasium.error import ClosedEnvironmentError, ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import DTypeLike, NDArray

from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.support.child_processes import worker_context
from tltl_runtime.vector.actions import check_batch
from tltl_runtime.vector.arguments import check_arguments, split_mask
from tltl_runtime.vector.cores import cores
from tltl_runtime.vector.errors import Loss, Playing, WorkerError, report
from tltl_runtime.vector.shared_memory import Rows, read, write_batch
from tltl_runtime.vector.worker import EnvFunction
from tltl_runtime.vector.workers import Workers, split_evenly

if TYPE_CHECKING:
    from tltl_runtime.vector.ray_workers import RayWorkers

TLTL_INFO: Final[Mapping[str, DTypeLike]] = {
    "verdict": "U9",
    "state": np.int64,
    "progress": np.float64,
    "success": np.bool_,
}
"""The keys of a TltlEnv's ``info`` that every step returns, with their NumPy types.

Other keys are returned only at a reset and at the end of an episode.
"""

TIMEOUT_S: Final = 60.0
"""The seconds for which a worker may be silent, unless ``timeout`` is given."""

_ALL: Final = slice(None)
_SEEDS: Final = 2**31

_log = logging.getLogger(__name__)


class WorkerVectorEnv(VectorEnv[Any, Any, NDArray[Any]]):
    """A vector environment whose environments are stepped by worker processes.

    Each of ``functions`` makes an environment; all environments must have equal spaces. Each worker
    steps its share of the environments one after the other. Observations, actions and the results of
    steps are in shared memory. The same seeds and actions give the same episodes, bit for bit, for any
    number of workers, and also if a single process steps the environments without workers.

    ``workers`` is the number of processes, by default the number of cores, but never more than there
    are environments. With ``workers="ray"`` the workers are actors of a Ray cluster (see
    :func:`~tltl_runtime.vector.cluster.cluster`), one on each free core; processes that torchrun
    started together share these cores.

    ``autoreset`` is a mode of Gymnasium: ``SAME_STEP`` (the step that ends an episode returns the
    first observation of the next; ``final_obs`` and ``final_info`` describe the end) or ``NEXT_STEP``.
    ``info`` maps keys of the environments' info dicts to NumPy types. At every step, ``infos`` has an
    array for each of these keys. All other entries are returned only at a reset and at the end of an
    episode. By default, the keys are ``verdict``, ``state``, ``progress`` and ``success`` if the
    environments are wrapped in a :class:`~tltl_runtime.spec.wrapper.TltlEnv`; otherwise there are none.
    The end of an episode also has ``episode``: the sum of rewards ``r`` and the length ``l``.

    A worker is lost if its process ends, if an environment raises, or if it is silent for ``timeout``
    seconds. A report then says what happened to the worker. For each of its environments, the report
    gives the name (one of ``names``), the seed, the episode and the step. With ``on_death="stop"``, a
    :class:`WorkerError` with this report is raised, and this vector environment is closed. With
    ``"replace"``, a new worker takes over, the report goes to this module's logger, and the
    environments of the lost worker begin episodes with new seeds. Their step is ``truncated`` with
    reward 0, ``final_obs`` is their last observation, and ``infos["lost"]`` is True for them.

    If an environment has a method ``prepare``, its worker calls this method again and again while it
    waits for a command, until the method returns False. So the environment can prepare the next reset
    in small steps.

    While the environments are made, ``on_made`` is called from time to time with the number of those
    that are made; not on a Ray cluster.

    Functions that cannot be imported, such as lambdas, are pickled by value. A process starts by
    importing the main module, so a script needs ``if __name__ == "__main__"`` around its own work.

    Raises:
        ValueError: a space has no fixed size, or another argument is invalid.
        TypeError: an argument is of another type.
        WorkerError: an environment cannot be made, or its spaces differ from those of the first.
        TltlError: TLT0730, Ray is not installed; TLT0852, there is no cluster, or no worker starts.
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
        timeout: float = TIMEOUT_S,
        on_made: Callable[[int], None] | None = None,
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
        self._unproven: set[int] = set()
        """Workers that were replaced and have not taken a step since."""
        context = worker_context(["tltl_runtime.vector.worker", *_modules(example)])
        self._rows = Rows(context, self.num_envs, self.single_observation_space, self.single_action_space, info)
        self._workers: Workers | RayWorkers
        if workers == "ray":
            from tltl_runtime.vector.ray_workers import RayWorkers

            self._workers = RayWorkers(functions, self._rows, info, autoreset, timeout)
        else:
            shares = list(split_evenly(self.num_envs, min(workers or cores(), self.num_envs)))
            self._workers = Workers(context, functions, shares, self._rows, autoreset, timeout)
        self._finalizer = weakref.finalize(self, self._workers.close)
        for loss in self._workers.start(range(len(self._workers.shares)), on_made):
            self._stop(loss)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode in each environment, or in those that ``options["reset_mask"]`` chooses.

        If ``seed`` is a number, the i-th environment gets the seed ``seed + i``; if it is a sequence,
        the i-th seed. Without a seed, or if its seed in the sequence is None, an environment continues
        with its random generator. If no seed is given, environments that have not had one yet get
        seeds that are drawn from ``self.np_random``.

        The mask has one bool per environment. The other environments continue their episodes. The
        mask is not passed on to the environments; all other options are.

        Raises:
            ValueError: the mask or the number of seeds is invalid.
            ResetNeeded: the first reset does not choose all environments.
            WorkerError: a worker was lost, and ``on_death`` is ``stop``.
        """
        self._check_open()
        if self._workers.is_waiting:
            self._workers.answers()
        chosen, options = split_mask(options, self.num_envs)
        if self._observations is None and not chosen.all():
            raise ResetNeeded("there are no episodes to continue: reset all environments first")
        seeds = self._seeds_of(seed)
        for index in np.flatnonzero(chosen):
            if seeds[index] is not None:
                self._seeds[index] = seeds[index]
        arguments = [(seeds[share], options, chosen[share].tolist()) for share in self._workers.shares]
        infos: dict[str, Any] = {}
        for answer in self._workers.ask("reset", arguments):
            if isinstance(answer, Loss):
                resets = self._replace(answer)
                answer = [(row, info if chosen[row] else {**info, "lost": True}) for row, info in resets]
            for row, info in answer:
                infos = self._add_info(infos, info, row)
        return self._read_observations(), self._add_columns(infos)

    def step(
        self, actions: Any
    ) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Take a step in each environment.

        Raises:
            ValueError: ``actions`` does not have one action of the space for each environment; no
                step is taken.
            ResetNeeded: there was no reset.
            WorkerError: a worker was lost, and ``on_death`` is ``stop``.
        """
        self._check_ready()
        if self._observations is None:
            raise ResetNeeded("there is no episode to continue: reset first")
        check_batch(self.single_action_space, actions, self.num_envs)
        write_batch(self._rows.action, actions)
        infos: dict[str, Any] = {}
        for worker, answer in enumerate(self._workers.ask("step", [()] * len(self._workers.shares))):
            if isinstance(answer, Loss):
                answer = self._continue(answer)
            else:
                self._unproven.discard(worker)
            for row, info in answer:
                infos = self._add_info(infos, info, row)
        rows = self._rows
        ends = rows.reward.copy(), rows.terminated.copy(), rows.truncated.copy()
        return self._read_observations(), *ends, self._add_columns(infos)

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Return the attribute ``name`` of each environment; if it is callable, call it and return the results."""
        return self._ask_all("call", [(name, args, kwargs)] * len(self._workers.shares))

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """Return the attribute ``name`` of each environment; call it without arguments if it is callable."""
        return self.call(name)

    def set_attr(self, name: str, values: Any) -> None:
        """Set the attribute ``name`` of each environment.

        If ``values`` is a list or tuple, it has a value for each environment. Otherwise, all
        environments get this value.

        Raises:
            ValueError: the list or tuple has another length.
        """
        env_values = list(values) if isinstance(values, (list, tuple)) else [values] * self.num_envs
        if len(env_values) != self.num_envs:
            raise ValueError(f"the number of values must be {self.num_envs}, not {len(env_values)}")
        self._ask_all("set_attr", [(name, env_values[share]) for share in self._workers.shares])

    def render(self) -> tuple[Any, ...] | None:
        """Return what each environment renders, in the order of the environments."""
        return self.call("render")

    def close_extras(self, **_: Any) -> None:
        """End the workers."""
        self._finalizer()

    @property
    def worker_pids(self) -> tuple[int | None, ...]:
        """The process ids of the workers; None for workers of a Ray cluster."""
        return tuple(self._workers.pid(worker) for worker in range(len(self._workers.shares)))

    def _ask_all(self, command: str, arguments: Sequence[tuple[Any, ...]]) -> tuple[Any, ...]:
        """Send a command to all workers; return the results of all environments, in order.

        ``arguments`` has the arguments for each worker. A lost worker is not replaced here, whatever
        ``on_death`` says: this vector environment is closed, and WorkerError is raised.
        """
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
            raise ResetNeeded("the last command to the workers was interrupted: reset first")

    def _seeds_of(self, seed: int | Sequence[int | None] | None) -> list[int | None]:
        if isinstance(seed, (int, np.integer)):
            super().reset(seed=int(seed))
            return [int(seed) + index for index in range(self.num_envs)]
        if seed is not None:
            if len(seed) != self.num_envs:
                raise ValueError(f"the number of seeds must be {self.num_envs}, not {len(seed)}")
            return [None if env_seed is None else int(env_seed) for env_seed in seed]
        return [self._new_seed() if current is None else None for current in self._seeds]

    def _new_seed(self) -> int:
        return int(self.np_random.integers(_SEEDS))

    def _read_observations(self) -> Any:
        self._observations = read(self._rows.observation, _ALL)
        return self._observations

    def _add_columns(self, infos: dict[str, Any]) -> dict[str, Any]:
        """Add to ``infos`` the arrays that workers write to shared memory, and return it.

        As in Gymnasium, each key also gets a mask with a leading underscore, here True for all.
        """
        for key, column in self._rows.info.items():
            infos[key] = column.copy()
            infos[f"_{key}"] = np.ones(self.num_envs, dtype=np.bool_)
        return infos

    # --- lost workers -----------------------------------------------------------------------------

    def _continue(self, loss: Loss) -> list[tuple[int, dict[str, Any]]]:
        """Replace a worker that was lost during a step; end the episodes of its environments as truncated.

        Return pairs of the index and the info of these environments. The info describes the end of
        the old episode and the start of the new one.
        """
        share = self._workers.shares[loss.worker]
        resets = self._replace(loss)
        self._rows.truncated[share] = True
        infos = []
        for row, info in resets:
            last = read(self._observations, row)
            infos.append((row, {"final_obs": last, "final_info": {"lost": True}, "lost": True, **info}))
        return infos

    def _replace(self, loss: Loss) -> list[tuple[int, dict[str, Any]]]:
        """Replace a lost worker, and begin episodes in its environments with new seeds.

        Return pairs of the index and the info of these environments.

        Raises:
            WorkerError: workers are not replaced; or the lost worker had itself replaced another and
                had not taken a step; or the new worker is lost before its episodes begin.
        """
        if not self._replaces or loss.worker in self._unproven:
            self._stop(loss)
        share = self._workers.shares[loss.worker]
        playing = self._playing(share)
        for row in range(share.start, share.stop):
            self._seeds[row] = self._new_seed()
        seeds = self._seeds[share]
        _log.warning("%s\nanother worker begins with seeds %s", report(loss, playing), seeds)
        self._unproven.add(loss.worker)
        self._rows.busy[share] = False
        for failure in self._workers.start([loss.worker]):
            self._stop(failure)
        self._workers.send(loss.worker, "reset", (seeds, None, [True] * len(seeds)))
        (answer,) = self._workers.answers()
        if isinstance(answer, Loss):
            self._stop(answer)
        infos: list[tuple[int, dict[str, Any]]] = answer
        return infos

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


def _modules(env: gymnasium.Env[Any, Any]) -> Iterator[str]:
    """Yield the names of the modules of an environment and its wrappers, except ``__main__``."""
    while True:
        if type(env).__module__ != "__main__":
            yield type(env).__module__
        if not isinstance(env, gymnasium.Wrapper):
            return
        env = env.env


def _has_spec(env: gymnasium.Env[Any, Any]) -> bool:
    while isinstance(env, gymnasium.Wrapper):
        if isinstance(env, TltlEnv):
            return True
        env = env.env
    return False
