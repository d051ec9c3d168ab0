"""The account of an episode: the data that verdicts, explanations and pictures use."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from types import MappingProxyType
from typing import Final

from tltl_runtime.game.episode import Kind, RecordedEpisode
from tltl_runtime.game.geometry import Point
from tltl_runtime.game.registry import registered_game
from tltl_runtime.regression.explain.path_points import Way, way_of
from tltl_runtime.regression.explain.stages import target_of
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltlc.api import monitors, record, replace

_SEEN_S: Final = 3.0
"""Enemies that saw the player in this many seconds before the end are reported."""


@record
class Arrival:
    """The entry into a state of the automaton: the step, and the position of the player's feet."""

    state: int
    step: int
    place: Point


@record
class NearestMiss:
    """The nearest miss: how near an episode came to leaving the state in which it failed, towards acceptance.

    ``robustness``, in [-1, 1], is the guard's greatest robustness, and ``place`` is where the player
    was then.  ``atom`` is the atom that limited it: it had to hold, or had to be false if ``wanted`` is
    False.  If the atom had to hold and depends on a single distance, ``target`` is the entity that the
    distance is measured to, and ``distance``, in metres, is the least distance at which the atom did
    not hold.  Only the last stay in the state counts.
    """

    atom: str
    robustness: float
    place: Point
    target: str | None = None
    distance: float | None = None
    wanted: bool = True


@record
class Account:
    """The account of an episode of a case: its ``summary``, and how it came about.

    ``arrivals`` start with the first sample.
    ``cause``, ``by`` and ``place`` describe the end of the episode.  ``seen_by`` are the enemies that
    saw the player shortly before.  ``broke`` are the atoms that broke the spec; ``arrived`` says that
    without them a transition towards acceptance would have been possible.  ``way`` is the simplified
    trajectory.  ``shut`` are the solid barriers that were closed at the end.
    """

    json_inlined = MappingProxyType(
        {"summary": ("index", "seed", "success", "end", "progress", "reward", "steps", "unmet")}
    )

    summary: EpisodeSummary
    cause: Kind
    by: tuple[str, ...]
    place: Point
    seen_by: tuple[str, ...]
    arrivals: tuple[Arrival, ...]
    nearest: NearestMiss | None
    way: Way
    broke: tuple[str, ...] = ()
    arrived: bool = False
    shut: tuple[str, ...] = ()


def summaries_of(accounts: Iterable[Account]) -> list[EpisodeSummary]:
    """Return the summaries of the episodes, in order."""
    return [account.summary for account in accounts]


def account(summary: EpisodeSummary, episode: RecordedEpisode) -> Account:
    """Return the account of an episode that was played and recorded."""
    game, places = registered_game(), _places(episode)
    ending = game.cause(episode)
    return Account(
        # Verdicts and reports need no more, and files hold no more.
        summary=replace(summary, verdict=None, seconds=None, state=None, label=None),
        cause=ending.kind,
        by=ending.by,
        place=_rounded(ending.place),
        seen_by=() if summary.success else game.seen_by(episode, ending.time - _SEEN_S, ending.time),
        arrivals=_arrivals(episode, places),
        nearest=None if summary.success else _nearest(episode, summary.unmet, places),
        way=way_of(episode),
        broke=ending.broke,
        arrived=_has_arrived(episode, summary.unmet, ending.broke),
        shut=game.shut(episode),
    )


def _arrivals(episode: RecordedEpisode, places: Sequence[Point]) -> tuple[Arrival, ...]:
    states = episode.states.tolist()
    entered = [step for step in range(len(states)) if step == 0 or states[step] != states[step - 1]]
    return tuple(Arrival(states[step], step, places[step]) for step in entered)


def _has_arrived(episode: RecordedEpisode, state: int, broke: Sequence[str]) -> bool:
    """Whether only the atoms in ``broke`` prevented, at the last sample, a transition towards acceptance."""
    fspa, values = episode.fspa, episode.atoms[-1].tolist()
    primes = [prime for edge in monitors.tables(fspa).improving[state] for prime in edge.guard.primes]
    missing = [{fspa.atoms[atom].name for atom, wanted in prime if (values[atom] > 0.0) != wanted} for prime in primes]
    return any(names and names <= {*broke} for names in missing)


def _nearest(episode: RecordedEpisode, state: int, places: Sequence[Point]) -> NearestMiss | None:
    """The nearest miss in a state; None if no edge leads from it towards acceptance, or the state was not visited."""
    fspa = episode.fspa
    guards = [edge.guard for edge in monitors.tables(fspa).improving[state]]
    steps = _last_stay(episode, state)
    if not guards or not steps:
        return None
    atoms: Sequence[list[float]] = episode.atoms.tolist()
    best, step = max((max(monitors.robustness(guard, atoms[step]) for guard in guards), -step) for step in steps)
    row = -step
    atom, wanted = monitors.bounding_literal(guards, atoms[row])
    target, distance = _distance(episode, atom, steps) if wanted else (None, None)
    return NearestMiss(fspa.atoms[atom].name, round(best, 4), places[row + 1], target, distance, wanted)


def _last_stay(episode: RecordedEpisode, state: int) -> list[int]:
    """The steps of the last stay of an episode in a state."""
    in_state = (episode.states[:-1] == state).tolist()
    end = max((step + 1 for step, is_in_state in enumerate(in_state) if is_in_state), default=0)
    began = max((step + 1 for step in range(end) if not in_state[step]), default=0)
    return list(range(began, end))


def _distance(episode: RecordedEpisode, atom: int, rows: Sequence[int]) -> tuple[str | None, float | None]:
    """The target of an atom's distance, and the least distance after the given steps at which the atom did not hold.

    Both are None if the atom does not depend on a single distance.
    """
    target = target_of(episode.fspa, atom)
    if target is None:
        return None, None
    column = [signal.name for signal in episode.fspa.signals].index(f"distance({target})")
    distances = [float(episode.signals[row + 1, column]) for row in rows if episode.atoms[row, atom] <= 0.0]
    return target, round(min(distances), 2)


def _places(episode: RecordedEpisode) -> list[Point]:
    """The positions of the player's feet, rounded to centimetres."""
    return [_rounded((x, y, z)) for x, y, z in episode.positions.tolist()]


def _rounded(point: Point) -> Point:
    x, y, z = point
    return round(x, 2), round(y, 2), round(z, 2)
