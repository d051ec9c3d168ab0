"""Say why an episode of a scene ended."""

from __future__ import annotations

from tltl_runtime.game.episode import Cause, EndKind
from tltl_runtime.game.geometry import Point
from tltl_runtime.game.moments import duration_text, moment_text
from tltl_runtime.game.violation import broken_atoms
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltlc.api import label_text


def scene_cause(episode: SceneEpisode) -> Cause:
    """Return why an episode ended: the cause that the game names; without one, the atoms that broke the spec.

    If the spec was not broken either, the text says what remained to be done.
    """
    time, moment = float(episode.times[-1]), moment_text(episode.times, len(episode.times) - 1)
    broken = broken_atoms(episode) if episode.end == "violation" else []
    names = tuple(name for name, _ in broken)
    kind = _kind(episode)
    if kind == "killed":
        text = f"ended by {episode.killer} at {moment}"
        return Cause(kind, (episode.killer,), time, _place(episode), text, names)
    if kind == "violated":
        words = ", ".join(f"{name} {'holds' if holds else 'does not hold'}" for name, holds in broken)
        return Cause(kind, names, time, _place(episode), f"violated at {moment}{': ' * bool(words)}{words}", names)
    if kind == "success":
        return Cause(kind, (), time, _place(episode), f"success after {duration_text(episode.times)}")
    remaining = label_text(episode.fspa, int(episode.states[-1])).rstrip(".")
    when = (
        f"limit after {len(episode.actions)} steps"
        if kind == "limit"
        else f"stopped after {duration_text(episode.times)}"
    )
    return Cause(kind, (), time, _place(episode), f"{when}, remaining: {remaining}")


def _kind(episode: SceneEpisode) -> EndKind:
    if episode.success:
        return "success"
    if episode.killer:
        return "killed"
    if episode.end == "violation":
        return "violated"
    return "limit" if episode.end == "limit" else "stopped"


def _place(episode: SceneEpisode) -> Point | None:
    if episode.positions is None:
        return None
    x, y, z = episode.positions[-1].tolist()
    return x, y, z
