"""Figures of a recorded episode that only the stealth game has."""

from __future__ import annotations

from tltl_runtime.game.recording_summary import GameFigures
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.support.number_text import share


def figures(episode: Episode) -> GameFigures:
    """Return the health at the end, and at how many moments an enemy saw the player."""
    health, seen = episode.snapshots[-1].health, seen_steps(episode)
    text = f"{share(health)}, in sight of an enemy for {seen} steps"
    return GameFigures({"health": health, "seen_steps": seen}, (("health", text),))


def seen_steps(episode: Episode) -> int:
    """Return the number of moments, including the reset, at which an enemy saw the player."""
    return sum(any(shot.sees) for shot in episode.snapshots)


def was_chased(episode: Episode) -> bool:
    """Return whether an enemy chased the player at any moment."""
    return any("chase" in shot.modes for shot in episode.snapshots)


def opened_barriers(episode: Episode) -> tuple[str, ...]:
    """Return the names of the barriers that were open at an episode's end, in the level's order."""
    barriers = zip(episode.level.barriers, episode.snapshots[-1].open, strict=True)
    return tuple(barrier.name for barrier, is_open in barriers if is_open)
