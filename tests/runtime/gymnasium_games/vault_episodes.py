"""Recorded episodes of the game of :mod:`tests.runtime.gymnasium_games.vault`."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

from tests.runtime.gymnasium_games import vault
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode


def played(game: Path, seed: int = 0, actions: Sequence[int] | None = None, scene: str = "plain") -> SceneEpisode:
    """Play actions, by default those that fetch the key and go to the exit, until the episode ends; record it."""
    with closing(GAME.recorder(GAME.make_env(f"{game}:{scene}"), "tester")) as env:
        env.reset(seed=seed)
        inner = env.unwrapped
        for action in vault.way(inner.player, inner.key) if actions is None else actions:  # type: ignore[attr-defined]
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                break
        return env.episode
