"""The account of an episode: what verdicts count, what explanations tell, what pictures draw of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltl_runtime.evaluation.play import Played
from tltl_runtime.regression.explain.path_points import Way, way_of
from tltl_runtime.regression.explain.stages import target_of
from tltl_runtime.stealth.level import Point
from tltl_runtime.stealth.recordings.cause import Kind, cause
from tltl_runtime.stealth.recordings.episode import End, Episode
from tltlc.core.record import record
from tltlc.monitor.guards import bounding_literal, robustness
from tltlc.monitor.tables import tables

_SEEN_S: Final = 3.0
"""Seconds before the end in which who saw the player counts."""


@record
class Arrival:
    """A state of the automaton that was entered: at which decision, and where the player's feet were."""

    state: int
    step: int
    place: Point


@record
class Nearest:
    """How near an episode came to leaving the state in which it failed, towards acceptance.

    ``atom`` is the one that was the limit at the best moment: it had to hold, or not to where ``wanted`` is false.
    ``robustness`` is the guard's then, in [-1, 1], ``place`` where that was.  Where the atom had to hold and speaks of
    one distance, ``target`` is to what and ``distance`` the least, in metres, at which it did not hold.  All of this is
    of the last time that the episode was in that state.
    """

    atom: str
    robustness: float
    place: Point
    target: str | None = None
    distance: float | None = None
    wanted: bool = True


@record
class Account:
    """How episode ``index`` of a case went.

    ``progress``, ``reward``, ``steps`` and ``unmet`` are as in
    :class:`~tltl_runtime.evaluation.play.Played`; ``arrivals`` begin with the first sample.  ``cause``, ``by`` and
    ``place`` say how the episode ended, ``seen_by`` who saw the player in the seconds before, ``broke`` which atoms
    broke the spec; ``arrived`` that these alone were missing then of what leads on.  ``shut`` are the barriers that
    stopped bodies at the end.
    """

    index: int
    seed: int
    success: bool
    end: End
    progress: float
    reward: float
    steps: int
    unmet: int
    cause: Kind
    by: tuple[str, ...]
    place: Point
    seen_by: tuple[str, ...]
    arrivals: tuple[Arrival, ...]
    nearest: Nearest | None
    way: Way
    broke: tuple[str, ...] = ()
    arrived: bool = False
    shut: tuple[str, ...] = ()


def account(played: Played, episode: Episode) -> Account:
    """The account of an episode that was played and recorded."""
    found = cause(episode)
    return Account(
        index=played.index,
        seed=played.seed,
        success=played.success,
        end=played.end,
        progress=played.progress,
        reward=played.reward,
        steps=played.steps,
        unmet=played.unmet,
        cause=found.kind,
        by=found.by,
        place=_rounded(found.place),
        seen_by=() if played.success else _seen_by(episode, found.time),
        arrivals=_arrivals(episode),
        nearest=None if played.success else _nearest(episode, played.unmet),
        way=way_of(episode),
        broke=found.broke,
        arrived=_has_arrived(episode, played.unmet, found.broke),
        shut=_shut(episode),
    )


def _arrivals(episode: Episode) -> tuple[Arrival, ...]:
    states = episode.states.tolist()
    entered = [step for step in range(len(states)) if step == 0 or states[step] != states[step - 1]]
    return tuple(Arrival(states[step], step, _place(episode, step)) for step in entered)


def _seen_by(episode: Episode, time: float) -> tuple[str, ...]:
    """The enemies that saw the player shortly before, in the level's order."""
    recent = [shot for shot in episode.snapshots if time - _SEEN_S <= shot.time <= time]
    return tuple(
        enemy.name for row, enemy in enumerate(episode.level.enemies) if any(shot.sees[row] for shot in recent)
    )


def _has_arrived(episode: Episode, state: int, broke: Sequence[str]) -> bool:
    """Whether the last sample, at which these atoms broke the spec, lacked nothing else of what leads on from there."""
    fspa, values = episode.fspa, episode.atoms[-1].tolist()
    primes = [prime for edge in tables(fspa).improving[state] for prime in edge.guard.primes]
    missing = [{fspa.atoms[atom].name for atom, wanted in prime if (values[atom] > 0.0) != wanted} for prime in primes]
    return any(names and names <= {*broke} for names in missing)


def _shut(episode: Episode) -> tuple[str, ...]:
    barriers = zip(episode.level.barriers, episode.snapshots[-1].open, strict=True)
    return tuple(barrier.name for barrier, is_open in barriers if barrier.kind == "solid" and not is_open)


def _nearest(episode: Episode, state: int) -> Nearest | None:
    """None where no edge that leaves the state leads nearer to acceptance."""
    fspa = episode.fspa
    guards = [edge.guard for edge in tables(fspa).improving[state]]
    steps = _last_stay(episode, state)
    if not guards or not steps:
        return None
    atoms: Sequence[list[float]] = episode.atoms.tolist()
    best, step = max((max(robustness(guard, atoms[step]) for guard in guards), -step) for step in steps)
    row = -step
    atom, wanted = bounding_literal(guards, atoms[row])
    target, distance = _distance(episode, atom, steps) if wanted else (None, None)
    return Nearest(fspa.atoms[atom].name, round(best, 4), _place(episode, row + 1), target, distance, wanted)


def _last_stay(episode: Episode, state: int) -> list[int]:
    """The decisions of the last time that an episode was in a state."""
    there = (episode.states[:-1] == state).tolist()
    end = max((step + 1 for step, is_there in enumerate(there) if is_there), default=0)
    began = max((step + 1 for step in range(end) if not there[step]), default=0)
    return list(range(began, end))


def _distance(episode: Episode, atom: int, rows: Sequence[int]) -> tuple[str | None, float | None]:
    """What an atom measures the distance to, and the least after those of the decisions that did not make it true; None
    where it measures none.
    """
    target = target_of(episode.fspa, atom)
    if target is None:
        return None, None
    column = [signal.name for signal in episode.fspa.signals].index(f"distance({target})")
    away = [float(episode.signals[row + 1, column]) for row in rows if episode.atoms[row, atom] <= 0.0]
    return target, round(min(away), 2)


def _place(episode: Episode, step: int) -> Point:
    return _rounded(episode.snapshots[step].player.position)


def _rounded(point: Point) -> Point:
    x, y, z = point
    return round(x, 2), round(y, 2), round(z, 2)
