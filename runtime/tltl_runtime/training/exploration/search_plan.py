"""How a training searches a game: what its cells are, and how it returns to them.

This is measured at the start of the training, in its own scene: a search needs a game that plays the
same again, because a demonstration is a seed and actions.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from contextlib import suppress
from copy import deepcopy
from typing import Any, Final, Literal

import gymnasium
import numpy as np

from tltl_runtime.game.game import Game
from tltl_runtime.game.geometry import Point
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.support.same_values import copied, is_same, other_name
from tltl_runtime.training.exploration.cells import CellGrid, position_grid, signal_grid
from tltl_runtime.training.exploration.snapshots import has_snapshots, release_of, restore, save
from tltl_runtime.wire.errors import WireError
from tltlc.api import record

ObstacleKind = Literal["plays", "restore", "one at a time", "earlier", "lost"]
"""Why there is no search.

``plays``: equal seeds and actions give different plays. ``restore``: a restored snapshot is not what
was saved. ``one at a time``: the game plays for one environment at a time. ``earlier``: the training
was begun without a search, and goes on so. ``lost``: the game, in another process, is lost each time
it is measured.
"""

THE_END: Final = "the end"
THE_OBSERVATION: Final = "the observation"

_SEED: Final = 1
MEASURED_STEPS: Final = 200
"""The steps of a play, as in ``tltlc check --game``."""
_REPEAT_PROBABILITY: Final = 0.7
"""The probability that an action is that of the step before, so that the player gets around."""
_MEASUREMENTS: Final = 3
"""How often tltlc measures a game at most, and how often it tries its first reset: it starts a lost game again."""
_RESTORES: Final = 4
"""How many snapshots are restored, each in another episode."""
_BEFORE_SNAPSHOT: Final = 20
_AFTER_SNAPSHOT: Final = 50


@record
class SearchObstacle:
    """Why there is no search.

    ``name`` is the signal that differs, or ``THE_OBSERVATION`` or ``THE_END``; ``first`` and
    ``second`` are its values. ``step`` is the step of the play, or the steps after the restored
    snapshot. ``problem`` is the exception of ``tltl_snapshot`` or ``tltl_restore``, or how the game was
    lost; empty if there is none.
    """

    kind: ObstacleKind
    name: str = ""
    first: Any = None
    second: Any = None
    step: int = 0
    problem: str = ""


@record
class SearchPlan:
    """How a training searches.

    ``cells`` says where cells come from: ``info`` of the environment (``own``), the positions of the
    player, or signals. ``grid`` makes them; None if they are ``own``. With
    ``snapshots``, the search returns to cells by snapshots of the game; otherwise it replays actions.
    ``obstacle`` says why there is no search; None if there is one.
    """

    cells: Literal["own", "positions", "signals"]
    grid: CellGrid | None = None
    snapshots: bool = False
    obstacle: SearchObstacle | None = None


@record
class _Moment:
    """What is seen after a reset or a step. ``step`` counts the steps of the play."""

    step: int
    observation: Any
    sample: dict[str, Any]
    ended: bool
    position: Point | None


def obstacle_text(obstacle: SearchObstacle) -> str:
    """Say in a clause why a game is not searched."""
    if obstacle.kind == "one at a time":
        return "the game is running already, and plays for one environment at a time"
    if obstacle.kind == "earlier":
        return "it was begun so"
    if obstacle.problem:
        return obstacle.problem
    steps = f"{obstacle.step} step{'s' * (obstacle.step != 1)}"
    if obstacle.kind == "plays":
        return f"equal seeds and actions give different plays: {_difference_text(obstacle)} after {steps}"
    after = f", {steps} later" if obstacle.step else ""
    return f"`tltl_restore` does not give back what `tltl_snapshot` saved: {_difference_text(obstacle)}{after}"


def first_info(env: TltlEnv, seed: int) -> dict[str, Any]:
    """Begin an episode, and return its info; if the game is lost, try it again with the next seeds.

    Raises:
        TltlError: the game raises an exception, or is lost each time (WireError).
    """
    for attempt in range(_MEASUREMENTS - 1):
        with suppress(WireError):
            return env.reset(seed=seed + attempt)[1]
    return env.reset(seed=seed + _MEASUREMENTS - 1)[1]


def search_plan(env: TltlEnv, game: Game[Any, Any], *, has_cells: bool) -> SearchPlan:
    """Play an environment of a training with random actions, and return how to search it.

    ``has_cells`` says whether the environment's info has a ``cell``.

    Raises:
        TltlError: the game raises an exception.
    """
    if not game.plays_at_once(env):
        return SearchPlan("own" if has_cells else "signals", obstacle=SearchObstacle("one at a time"))
    if has_cells and game.promises_replays:
        return SearchPlan("own")
    problem = ""
    for _ in range(_MEASUREMENTS):
        try:
            return _measured(env, game, has_cells=has_cells)
        except WireError as error:
            problem = error.diagnostics[0].title
    return SearchPlan("own" if has_cells else "signals", obstacle=SearchObstacle("lost", problem=problem))


def _measured(env: TltlEnv, game: Game[Any, Any], *, has_cells: bool) -> SearchPlan:
    """Return how to search a game, after plays and restores that show what it can do.

    Raises:
        TltlError: the game raises an exception, or is lost (WireError).
    """
    actions = _actions(env)
    with warnings.catch_warnings():
        # Warnings about values of signals are for the training itself.
        warnings.simplefilter("ignore")
        first = _play(env, game, actions)
        obstacle = None if game.promises_replays else _difference("plays", first, _play(env, game, actions))
        snapshots = not has_cells and has_snapshots(env)
        if snapshots and obstacle is None:
            obstacle = _restore_obstacle(env, game)
    if has_cells:
        return SearchPlan("own", obstacle=obstacle)
    if any(moment.position for moment in first):
        grid = position_grid(game.level_bounds(env), [moment.position for moment in first if moment.position])
        return SearchPlan("positions", grid, snapshots, obstacle)
    grid = signal_grid(env.task.fspa.signals, [moment.sample for moment in first])
    return SearchPlan("signals", grid, snapshots, obstacle)


def _actions(env: gymnasium.Env[Any, Any], seed: int = _SEED, count: int = MEASURED_STEPS) -> list[Any]:
    space, random = deepcopy(env.action_space), np.random.default_rng(seed)
    space.seed(seed)
    actions = [space.sample()]
    while len(actions) < count:
        actions.append(actions[-1] if random.random() < _REPEAT_PROBABILITY else space.sample())
    return actions


def _play(env: TltlEnv, game: Game[Any, Any], actions: Sequence[Any], seed: int = _SEED) -> list[_Moment]:
    """Begin an episode and take actions; begin the next one, with the next seed, when an episode ends."""
    observation, _ = env.reset(seed=seed)
    moments = [_moment(env, game, 0, observation)]
    for step, action in enumerate(actions, 1):
        observation, _, terminated, truncated, _ = env.step(action)
        moments.append(_moment(env, game, step, observation, ended=terminated or truncated))
        if terminated or truncated:
            seed += 1
            observation, _ = env.reset(seed=seed)
            moments.append(_moment(env, game, step, observation))
    return moments


def _go_on(env: TltlEnv, game: Game[Any, Any], actions: Sequence[Any]) -> list[_Moment]:
    """Take actions until they or the episode end."""
    moments: list[_Moment] = []
    for step, action in enumerate(actions, 1):
        observation, _, terminated, truncated, _ = env.step(action)
        moments.append(_moment(env, game, step, observation, ended=terminated or truncated))
        if moments[-1].ended:
            break
    return moments


def _moment(env: TltlEnv, game: Game[Any, Any], step: int, observation: Any, *, ended: bool = False) -> _Moment:
    position = game.player_position(env)
    return _Moment(step, copied(observation), copied(dict(env.sample)), bool(ended), position)


def _difference(kind: ObstacleKind, first: Sequence[_Moment], second: Sequence[_Moment]) -> SearchObstacle | None:
    """Return the first difference between two plays; None if there is none."""
    for one, other in zip(first, second, strict=False):
        if one.ended != other.ended:
            return SearchObstacle(kind, THE_END, one.ended, other.ended, one.step)
        name = other_name(one.sample, other.sample)
        if name is not None:
            return SearchObstacle(kind, name, one.sample.get(name), other.sample.get(name), one.step)
        if not is_same(one.observation, other.observation):
            return SearchObstacle(kind, THE_OBSERVATION, step=one.step)
    return None


def _restore_obstacle(env: TltlEnv, game: Game[Any, Any]) -> SearchObstacle | None:
    """Restore snapshots; return the first difference from what was saved, None if there is none.

    Raises:
        WireError: the game is lost.
    """
    for seed in range(_SEED + 1, _SEED + 1 + _RESTORES):
        actions = _actions(env, seed, _BEFORE_SNAPSHOT + _AFTER_SNAPSHOT)
        observation, info = env.reset(seed=seed)
        for action in actions[:_BEFORE_SNAPSHOT]:
            observation, _, terminated, truncated, info = env.step(action)
            if terminated or truncated:
                observation, info = env.reset(seed=seed)
        later = actions[_BEFORE_SNAPSHOT:]
        try:
            moment = save(env, observation, info)
        except WireError:
            raise
        except Exception as error:  # The code of the game may raise anything.
            return SearchObstacle("restore", problem=f"`tltl_snapshot` raises {type(error).__name__}: {error}")
        expected = _go_on(env, game, later)
        try:
            name = restore(env, moment)
        except WireError:
            raise
        except Exception as error:
            return SearchObstacle("restore", problem=f"`tltl_restore` raises {type(error).__name__}: {error}")
        if name is not None:
            return SearchObstacle("restore", name, moment.spec.sample.get(name), env.sample.get(name))
        if obstacle := _difference("restore", expected, _go_on(env, game, later)):
            return obstacle
        if release := release_of(env):
            release(moment.data)
    return None


def _difference_text(obstacle: SearchObstacle) -> str:
    if obstacle.name == THE_END:
        return "one of the episodes ends"
    if obstacle.name == THE_OBSERVATION:
        return "the observation differs"
    first, second = _value_text(obstacle.first), _value_text(obstacle.second)
    tense = "was" if obstacle.kind == "restore" else "is"
    return f"`{obstacle.name}` {tense} {first}, and then {second}"


def _value_text(value: object) -> str:
    if value is None:
        return "missing"
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    return f"{value!r:.40}" if isinstance(value, str) else f"{float(value):g}"  # type: ignore[arg-type]
