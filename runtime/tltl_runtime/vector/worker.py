"""The code of a worker process, which makes its environments, and resets and steps them on command."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from typing import Any, Final

import gymnasium
from gymnasium.vector import AutoresetMode

from tltl_runtime.support.child_processes import begin_worker, end_worker
from tltl_runtime.vector.shared_memory import Rows, read, write
from tltlc.api import TltlError

Info = dict[str, Any]
EnvFunction = Callable[[], gymnasium.Env[Any, Any]]

DONE: Final = "done"
FAILED: Final = "failed"
CLOSE: Final = "close"


def work(connection: Connection, functions: Any, rows: Rows, first: int, autoreset: AutoresetMode) -> None:
    """Serve the commands from ``connection`` until ``close`` arrives or the other process is gone.

    ``functions`` is a ``CloudpickleWrapper`` of the functions that make the environments. The first
    environment uses row ``first`` of ``rows``, the second the row after it, and so on.

    A command is a pair: the name of a method of :class:`Share`, and its arguments. The answer is a
    pair, too: ``done`` and the result, or ``failed`` and a pair of a traceback and diagnostics. After
    ``failed``, the worker ends. The first answer needs no command: it is sent when all environments
    are made.
    """
    begin_worker()
    try:
        share = Share(functions.fn, rows, first, autoreset)
        connection.send((DONE, None))
        while True:
            while not connection.poll() and share.prepare():
                pass
            command, arguments = connection.recv()
            if command == CLOSE:
                share.close()
                return
            connection.send((DONE, getattr(share, command)(*arguments)))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        end_worker()
    except Exception as error:
        diagnostics = error.diagnostics if isinstance(error, TltlError) else ()
        connection.send((FAILED, (traceback.format_exc(), diagnostics)))
        raise SystemExit(1) from None


class Share:
    """The environments of one worker; its methods are the commands that the worker serves.

    The i-th environment uses the row ``first + i`` of ``rows``: it takes its actions from there and
    writes its observations and results there.

    Raises:
        ValueError: a space of an environment differs from that in ``rows``.
    """

    def __init__(self, functions: Sequence[EnvFunction], rows: Rows, first: int, autoreset: AutoresetMode) -> None:
        self._rows = rows
        self._first = first
        self._same_step = autoreset == AutoresetMode.SAME_STEP
        self._envs: list[gymnasium.Env[Any, Any]] = []
        for row, make in enumerate(functions, first):
            self._envs.append(make())
            rows.made[row] = True
        self._preparing = [env.prepare for env in self._envs if hasattr(env, "prepare")]
        self._is_over = [False] * len(self._envs)
        for row, env in enumerate(self._envs, first):
            for name, space in rows.spaces.items():
                env_space = getattr(env, name)
                if env_space != space:
                    raise ValueError(f"the {name} of env {row} differs from that of env 0: {env_space}, not {space}")

    def reset(
        self, seeds: Sequence[int | None], options: dict[str, Any] | None, chosen: Sequence[bool]
    ) -> list[tuple[int, Info]]:
        """Begin an episode in each chosen environment; return a pair of row and info for each.

        ``seeds`` and ``chosen`` have a value for each environment of this worker.
        """
        infos = []
        for index in range(len(self._envs)):
            if chosen[index]:
                observation, info = self._begin(index, seeds[index], options)
                self._write_row(index, observation, 0.0, False, False, info)
                infos.append((self._first + index, info))
        return infos

    def step(self) -> list[tuple[int, Info]]:
        """Take a step in each environment, with the actions in the rows.

        Return pairs of a row and an info for the environments in which an episode ended or began.
        """
        actions = read(self._rows.action, slice(self._first, self._first + len(self._envs)))
        infos = []
        for index, env in enumerate(self._envs):
            if self._is_over[index]:
                observation, info = self._begin(index)
                self._write_row(index, observation, 0.0, False, False, info)
                infos.append((self._first + index, info))
                continue
            row = self._first + index
            self._rows.step[row] += 1
            self._rows.busy[row] = True
            observation, reward, terminated, truncated, info = env.step(read(actions, index))
            self._rows.busy[row] = False
            self._rows.total[row] += reward
            if terminated or truncated:
                info = {**info, "episode": self._statistics(row)}
                if self._same_step:
                    last, info = {"final_obs": observation, "final_info": info}, {}
                    observation, info = self._begin(index)
                    infos.append((row, {**last, **info}))
                else:
                    self._is_over[index] = True
                    infos.append((row, info))
            self._write_row(index, observation, float(reward), terminated, truncated, info)
        return infos

    def prepare(self) -> bool:
        """Let one environment do a little work ahead of time, by its own method ``prepare``.

        Return whether an environment had work to do.
        """
        return any(prepare() for prepare in self._preparing)

    def call(self, name: str, args: tuple[Any, ...], kwargs: dict[str, Any]) -> list[Any]:
        """Return the attribute ``name`` of each environment; if it is callable, call it and return the results."""
        attributes = [env.get_wrapper_attr(name) for env in self._envs]
        return [attribute(*args, **kwargs) if callable(attribute) else attribute for attribute in attributes]

    def set_attr(self, name: str, values: Sequence[Any]) -> tuple[()]:
        """Set the attribute ``name`` of each environment; ``values`` has their values, in order.

        Return an empty tuple: no environment has a result.
        """
        for env, value in zip(self._envs, values, strict=True):
            env.set_wrapper_attr(name, value)
        return ()

    def close(self) -> None:
        """Close the environments."""
        for env in self._envs:
            env.close()

    def _begin(self, index: int, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        rows, row = self._rows, self._first + index
        rows.episode[row] = 1 if seed is not None else rows.episode[row] + 1
        rows.step[row] = 0
        rows.total[row] = 0.0
        rows.busy[row] = True
        observation, info = self._envs[index].reset(seed=seed, options=options)
        rows.busy[row] = False
        self._is_over[index] = False
        return observation, info

    def _statistics(self, row: int) -> dict[str, Any]:
        """Return the sum of rewards ``r`` and the length ``l`` of the episode in a row.

        The keys are those of Gymnasium's wrapper ``RecordEpisodeStatistics``.
        """
        return {"r": float(self._rows.total[row]), "l": int(self._rows.step[row])}

    def _write_row(
        self, index: int, observation: Any, reward: float, terminated: bool, truncated: bool, info: Info
    ) -> None:
        rows, row = self._rows, self._first + index
        write(rows.observation, row, observation)
        rows.reward[row] = reward
        rows.terminated[row] = terminated
        rows.truncated[row] = truncated
        for key, column in rows.info.items():
            column[row] = info[key]
