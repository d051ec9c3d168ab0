"""Explain why an episode ended, from the recording alone."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from math import hypot, isfinite
from typing import Final

from tltl_runtime.game.episode import Cause, EndKind
from tltl_runtime.game.violation import broken_atoms
from tltl_runtime.spec.goals import next_goals
from tltl_runtime.stealth.expert.routes import routes_of, shut_barriers
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.snapshot import Snapshot, places, touches
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.api import Atom, expressions, label_text

_RECENT: Final = 3.0
"""Damage is a cause of death if the player took it at most this many seconds before the death."""


def cause(episode: Episode) -> Cause:
    """Return why an episode ended, for example which enemy killed the player.

    Only the recording is used.
    """
    if not episode.success:
        death = next((row for row, shot in enumerate(episode.snapshots) if shot.health <= 0.0), None)
        if death is not None:
            return _death_cause(episode, death)
        if episode.end == "violation":
            return _violation_cause(episode)
        if episode.end == "limit":
            return _limit_cause(episode)
    last = episode.snapshots[-1]
    kind: EndKind = "success" if episode.success else "stopped"
    rest = "" if episode.success else f", remaining: {_remaining_text(episode)}"
    return Cause(kind, (), last.time, last.player.position, f"{kind} after {last.time:.2f} s{rest}")


def _death_cause(episode: Episode, death: int) -> Cause:
    shots = episode.snapshots[: death + 1]
    damage: Counter[str] = Counter()
    for before, after in pairwise(shots):
        if after.health < before.health and after.time >= shots[-1].time - _RECENT:
            damage.update(_damage_rates(episode.level, before, after))
    lasers = {barrier.name for barrier in episode.level.barriers}
    by = tuple(name for name, _ in damage.most_common())
    names = [f"the laser `{name}`" if name in lasers else f"`{name}`" for name in by]
    how = "burnt" if by and lasers.issuperset(by) else "killed"
    broke = tuple(name for name, _ in _broken_atoms(episode)) if episode.end == "violation" else ()
    return _cause_at("killed", by, shots[-1], f"{how} by {' and '.join(names)}" if by else how, broke=broke)


def _violation_cause(episode: Episode) -> Cause:
    """Return the cause of a violation: the atoms that caused the last transition, with their truth values."""
    broken = _broken_atoms(episode)
    by = tuple(name for name, _ in broken)
    words = [f"{name} {'holds' if holds else 'does not hold'}" for name, holds in broken]
    return _cause_at("violated", by, episode.snapshots[-1], "violated", ", ".join(words), by)


def _broken_atoms(episode: Episode) -> list[tuple[str, bool]]:
    """Return the atoms that caused a violation, with their truth values.

    If the player died, prefer atoms that read the signal ``health``.
    """
    is_dead = episode.snapshots[-1].health <= 0.0
    return broken_atoms(episode, _reads_health if is_dead else lambda atom: False)


def _reads_health(atom: Atom) -> bool:
    return any(
        isinstance(node, expressions.SignalValue) and node.name == "health"
        for node in expressions.nodes(atom.expression)
    )


def _limit_cause(episode: Episode) -> Cause:
    """Return the cause of an episode that reached its limit.

    If the player is the scripted expert and had no route to its next goal, the cause says so.
    """
    last, steps = episode.snapshots[-1], len(episode.actions)
    remaining = f"limit after {steps} steps, remaining: {_remaining_text(episode)}"
    if "expert" in episode.player:
        unreachable = _unreachable_goals(episode)
        if unreachable is None:
            return Cause("no way", (), last.time, last.player.position, f"the expert has nowhere to go; {remaining}")
        if unreachable:
            names = " or ".join(f"`{name}`" for name in unreachable)
            return Cause(
                "no way",
                unreachable,
                last.time,
                last.player.position,
                f"the expert finds no way to {names}; {remaining}",
            )
    return Cause("limit", (), last.time, last.player.position, remaining)


def _cause_at(
    kind: EndKind, by: tuple[str, ...], shot: Snapshot, event: str, detail: str = "", broke: tuple[str, ...] = ()
) -> Cause:
    place = shot.player.position
    text = f"{event} at {shot.time:.2f} s at ({place[0]:.1f}, {place[1]:.1f})"
    return Cause(kind, by, shot.time, place, f"{text}: {detail}" if detail else text, broke)


def _remaining_text(episode: Episode) -> str:
    return label_text(episode.fspa, int(episode.states[-1])).rstrip(".")


def _damage_rates(level: StealthLevel, before: Snapshot, after: Snapshot) -> dict[str, float]:
    """Return the damage that each enemy and laser did between two snapshots, in health per second, by name.

    The function repeats the game's computation with the data in the snapshots. In the game, enemies
    attack before they move, and lasers burn before switches open them.
    """
    feet, kind = after.player.position, PlayerKind()
    height = kind.crouched_height if after.player.crouching else kind.height
    guards = zip(level.enemies, before.enemies, before.modes, after.modes, after.sees, strict=True)
    blows = {
        enemy.name: enemy.kind.attack_damage
        for enemy, (x, y, _), was, now, sees in guards
        if sees and was == now == "chase" and hypot(feet[0] - x, feet[1] - y) <= enemy.kind.attack_range
    }
    burns = {
        barrier.name: barrier.damage
        for barrier, is_open in zip(level.barriers, before.open, strict=True)
        if barrier.kind == "laser" and not is_open and touches(feet, kind.radius, height, barrier.box)
    }
    return blows | burns


def _unreachable_goals(episode: Episode) -> tuple[str, ...] | None:
    """Return the names of the entities that the player should reach next, if no route leads to any of them.

    Return an empty tuple if a route leads to any of them, and None if there are no such entities.
    """
    last = episode.snapshots[-1]
    sample = {signal.name: value for signal, value in zip(episode.fspa.signals, episode.signals[-1], strict=True)}
    positions = places(episode.level, last)
    goals = next_goals(episode.fspa, int(episode.states[-1]), sample, episode.params, positions)
    if not goals:
        return None
    routes = routes_of(episode.level, shut_barriers(last))
    start = routes.surfaces.nearest(last.player.position)
    if any(isfinite(routes.field(positions[goal]).seconds.flat[start]) for goal in goals):
        return ()
    return goals
