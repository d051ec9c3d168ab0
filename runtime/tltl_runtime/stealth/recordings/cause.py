"""Why an episode ended as it did, by the episode alone: who took the player's health, what broke, what remained."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from math import hypot, isfinite
from typing import Final, Literal

from tltl_runtime.stealth.expert.goals import next_goals
from tltl_runtime.stealth.expert.routes import routes_of, shut_of
from tltl_runtime.stealth.level import Level, Point
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.snapshot import Snapshot, places, touches
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.core.record import record
from tltlc.expression.tree import Signal, nodes
from tltlc.resolve.spec import Atom

Kind = Literal["success", "killed", "violated", "limit", "no way", "stopped"]

_RECENT: Final = 3.0
"""Seconds before a death whose blows count for it."""


@record
class Cause:
    """Why an episode ended: the ``kind`` of end, ``by`` what, when and where, and ``text`` that says it.

    ``by`` names the enemies and lasers that killed, who took most first; the atoms that broke the spec; or the entities
    that no way leads to.  ``time`` is in seconds since the reset, ``place`` that of the player's feet then.
    ``broke`` names the atoms that broke the spec, whatever the ``kind``; nothing where it was not violated.
    """

    kind: Kind
    by: tuple[str, ...]
    time: float
    place: Point
    text: str
    broke: tuple[str, ...] = ()


def cause(episode: Episode) -> Cause:
    """Why the episode ended as it did."""
    if not episode.success:
        died = next((row for row, shot in enumerate(episode.snapshots) if shot.health <= 0.0), None)
        if died is not None:
            return _killed(episode, died)
        if episode.end == "violation":
            return _violated(episode)
        if episode.end == "limit":
            return _limit(episode)
    last = episode.snapshots[-1]
    kind: Kind = "success" if episode.success else "stopped"
    rest = "" if episode.success else f", remaining: {_remaining(episode)}"
    return Cause(kind, (), last.time, last.player.position, f"{kind} after {last.time:.2f} s{rest}")


def _killed(episode: Episode, died: int) -> Cause:
    shots = episode.snapshots[: died + 1]
    took: Counter[str] = Counter()
    for before, after in pairwise(shots):
        if after.health < before.health and after.time >= shots[-1].time - _RECENT:
            took.update(_blows(episode.level, before, after))
    lasers = {barrier.name for barrier in episode.level.barriers}
    by = tuple(name for name, _ in took.most_common())
    names = [f"the laser `{name}`" if name in lasers else f"`{name}`" for name in by]
    how = "burnt" if by and lasers.issuperset(by) else "killed"
    broke = tuple(name for name, _ in _broken(episode)) if episode.end == "violation" else ()
    return _here("killed", by, shots[-1], f"{how} by {' and '.join(names)}" if by else how, broke=broke)


def _violated(episode: Episode) -> Cause:
    """By the atoms for which the last transition was taken."""
    broken = _broken(episode)
    by = tuple(name for name, _ in broken)
    words = [f"{name} {'holds' if holds else 'does not hold'}" for name, holds in broken]
    return _here("violated", by, episode.snapshots[-1], "violated", ", ".join(words), by)


def _broken(episode: Episode) -> list[tuple[str, bool]]:
    """The atoms of a violation, and whether each held: a prime implicant, which held, of the guard that was taken.

    Where several did, one that reads the health of a player who died.
    """
    fspa, taken = episode.fspa, (int(episode.states[-2]), int(episode.states[-1]))
    holds = [value > 0.0 for value in episode.atoms[-1].tolist()]
    primes = [prime for edge in fspa.edges if (edge.source, edge.target) == taken for prime in edge.guard.primes]
    held = [prime for prime in primes if all(holds[atom] == wanted for atom, wanted in prime)]
    if episode.snapshots[-1].health <= 0.0:
        held.sort(key=lambda prime: not any(_reads_health(fspa.atoms[atom]) for atom, _ in prime))
    return [(fspa.atoms[atom].name, wanted) for atom, wanted in (held[0] if held else ())]


def _reads_health(atom: Atom) -> bool:
    return any(isinstance(node, Signal) and node.name == "health" for node in nodes(atom.expression))


def _limit(episode: Episode) -> Cause:
    """Time was up; where the expert played, perhaps since it finds no way to what is next."""
    last, steps = episode.snapshots[-1], len(episode.actions)
    remaining = f"limit after {steps} steps, remaining: {_remaining(episode)}"
    if "expert" in episode.player:
        far = _out_of_reach(episode)
        if far is None:
            return Cause("no way", (), last.time, last.player.position, f"nowhere to go for the expert; {remaining}")
        if far:
            names = " or ".join(f"`{name}`" for name in far)
            return Cause("no way", far, last.time, last.player.position, f"finds no way to {names}; {remaining}")
    return Cause("limit", (), last.time, last.player.position, remaining)


def _here(
    kind: Kind, by: tuple[str, ...], shot: Snapshot, what: str, why: str = "", broke: tuple[str, ...] = ()
) -> Cause:
    place = shot.player.position
    text = f"{what} at {shot.time:.2f} s at ({place[0]:.1f}, {place[1]:.1f})"
    return Cause(kind, by, shot.time, place, f"{text}: {why}" if why else text, broke)


def _remaining(episode: Episode) -> str:
    return episode.fspa.states[int(episode.states[-1])].label.english.rstrip(".")


def _blows(level: Level, before: Snapshot, after: Snapshot) -> dict[str, float]:
    """The health a second that each enemy and laser takes in a decision: as the game has it, by what there is to see.

    Enemies strike before they move, and lasers burn before switches open them.
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


def _out_of_reach(episode: Episode) -> tuple[str, ...] | None:
    """The next entities, where no way leads to any of them from the player; None where the spec names no next one."""
    last = episode.snapshots[-1]
    sample = {signal.name: value for signal, value in zip(episode.fspa.signals, episode.signals[-1], strict=True)}
    there = places(episode.level, last)
    goals = next_goals(episode.fspa, int(episode.states[-1]), sample, episode.params, there)
    if not goals:
        return None
    routes = routes_of(episode.level, shut_of(last))
    here = routes.surfaces.nearest(last.player.position)
    if any(isfinite(routes.field(there[goal]).seconds.flat[here]) for goal in goals):
        return ()
    return goals
