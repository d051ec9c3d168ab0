"""Record episodes of scenes while they are played."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium.utils import RecordConstructorArgs

from tltl_runtime.evaluation.versions import versions
from tltl_runtime.game.geometry import Point
from tltl_runtime.game.outline import LevelOutline
from tltl_runtime.game.recorder import EpisodeRecorder, judging_wrapper, recorded_end, recorded_step_s
from tltl_runtime.gymnasium_games.entity_positions import (
    PLAYER,
    EntityPositions,
    PositionsError,
    entity_positions,
)
from tltl_runtime.gymnasium_games.game_errors import RAISES
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.policies.spaces.action_layout import action_layout
from tltl_runtime.policies.spaces.values import flat_action
from tltlc.api import Diagnostic, Step, TltlError, replace


class SceneRecorder(EpisodeRecorder[SceneEpisode], RecordConstructorArgs):
    """A wrapper that records the current episode and changes no observation, reward or info.

    ``env`` is an environment of a scene, or wrappers around one. ``player`` is the player's name in the
    recording.

    Raises:
        TltlError: TLT0844, the actions of this action space cannot be recorded.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], player: str = "unknown") -> None:
        RecordConstructorArgs.__init__(self, player=player)
        gymnasium.Wrapper.__init__(self, env)
        self._judge = judging_wrapper(env)
        self._player = player
        self._layout = action_layout(env.action_space)
        self._names = tuple(signal.name for signal in self._judge.task.fspa.signals)
        self._has_cause = env.has_wrapper_attr("tltl_cause")
        self._rows: _Rows | None = None
        self._over = False

    @property
    def episode(self) -> SceneEpisode:
        """A copy of the episode so far; raises RuntimeError before the first reset."""
        if self._rows is None:
            raise RuntimeError("there is no episode before the first reset")
        rows, task, count = self._rows, self._judge.task, len(self._rows.steps)
        last = rows.steps[-1] if rows.steps else None
        return SceneEpisode(
            level=replace(self.env.get_wrapper_attr("level"), outline=rows.outline),
            fspa=task.fspa,
            params=dict(task.params),
            player=self._player,
            seed=rows.seed,
            layout=self._layout,
            actions=np.array(rows.actions, dtype=np.float64).reshape(count, self._layout.width),
            times=np.arange(count + 1, dtype=np.float64) * recorded_step_s(self.env),
            positions=np.array(rows.player, dtype=np.float64) if rows.player else None,
            signals=np.array(rows.signals, dtype=np.float64).reshape(count + 1, len(self._names)),
            atoms=np.array(rows.atoms, dtype=np.float64).reshape(count, len(task.fspa.atoms)),
            states=np.array([0, *(step.state for step in rows.steps)], dtype=np.int32),
            progress=np.array([0.0, *(step.progress for step in rows.steps)], dtype=np.float64),
            rewards=np.array([step.reward for step in rows.steps], dtype=np.float64),
            verdict=last.verdict if last else task.fspa.states[0].verdict,
            success=rows.success,
            end=recorded_end(last, rows.success),
            killer=rows.killer,
            reward=task.reward,
            versions=versions(),
            entities=self._entities(rows),
        )

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin a new episode and discard the previous one.

        Without a seed, draw one from the environment's random generator.
        """
        if seed is None:
            seed = int(self.np_random.integers(1 << 31))
        observation, info = self.env.reset(seed=seed, options=options)
        self._rows, self._over = _Rows(seed, self.env.get_wrapper_attr("scene_outline")()), False
        self._add_moment(self._rows)
        return observation, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Take a step in the environment; record it unless the episode was already over.

        Raises:
            RuntimeError: there was no reset before.
        """
        if self._rows is None:
            raise RuntimeError("there is no episode before the first reset")
        flat = flat_action(self._layout, action)
        observation, reward, terminated, truncated, info = self.env.step(action)
        if not self._over:
            step = self._judge.taken
            assert step is not None
            self._rows.add(flat.tolist(), tuple(info["atoms"].values()), step, info["success"])
            self._add_moment(self._rows)
            self._over = terminated or truncated
            if self._over and self._has_cause:
                self._rows.killer = self.env.get_wrapper_attr("scene_cause")()
        return observation, reward, terminated, truncated, info

    def _add_moment(self, rows: _Rows) -> None:
        sample = self._judge.sample
        rows.signals.append([float(sample[name]) for name in self._names])
        places = self.env.get_wrapper_attr("scene_positions")()
        if places is not None:
            # If the player is gone, keep its last position.
            rows.player.append(places[PLAYER] if PLAYER in places else rows.player[-1])
            rows.entities.append(places)

    def _entities(self, rows: _Rows) -> EntityPositions | None:
        """Return where the entities were; None if the game gives no positions.

        Raises TltlError, TLT0781, if there were too many entities in the episode.
        """
        if not rows.entities:
            return None
        try:
            return entity_positions(rows.entities)
        except PositionsError as error:
            title = f"the game's `tltl_positions` {error}"
            raise TltlError([Diagnostic(RAISES, title, help=error.help)]) from None


class _Rows:
    """The data of an episode that is still being played, with a row for each step.

    ``signals``, ``player`` and ``entities`` have one more row: the first is for the moment of the reset.
    ``player`` and ``entities`` are empty if the game gives no positions. ``outline`` is the outline of
    the scene in this episode; None if the game gives none.
    """

    def __init__(self, seed: int, outline: LevelOutline | None) -> None:
        self.seed = seed
        self.outline = outline
        self.signals: list[list[float]] = []
        self.player: list[Point] = []
        self.entities: list[dict[str, Point]] = []
        self.actions: list[list[float]] = []
        self.atoms: list[tuple[float, ...]] = []
        self.steps: list[Step] = []
        self.success = False
        self.killer = ""

    def add(self, action: list[float], atoms: tuple[float, ...], step: Step, success: bool) -> None:
        self.actions.append(action)
        self.atoms.append(atoms)
        self.steps.append(step)
        self.success = success
