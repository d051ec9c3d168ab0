"""An episode with the facts that explain its result, for verdicts, explanations and pictures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from types import MappingProxyType
from typing import Final

from tltl_runtime.game.episode import EndKind, RecordedEpisode
from tltl_runtime.game.geometry import Point
from tltl_runtime.regression.explain.path_points import TrajectoryPoints, simplified_trajectory
from tltl_runtime.regression.explain.stages import distance_column, target_of
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltlc.api import monitors, record, replace

_SEEN_WITHIN_S: Final = 3.0
"""An enemy is reported if it saw the player within this many seconds before the end."""


@record
class Arrival:
    """An entry into a state of the automaton, at a step.

    ``place`` is the position of the player's feet at that step, in metres; None if it is not known.
    """

    state: int
    step: int
    place: Point | None = None


@record
class NearestMiss:
    """How near a failed episode came to an edge that leads from its last state towards acceptance.

    If a violation ended the episode, its last state is the one before the violation. Earlier visits
    to that state do not count.

    ``robustness``, in [-1, 1], is the greatest robustness of the guards of such edges, and
    ``place`` is where the player was then; None if it is not known. ``atom`` is the atom that
    limited the robustness. It had to be true if ``wanted`` is true, else false.

    If the atom had to be true, and approaching an entity makes it true, ``target`` is that entity.
    ``distance``, in metres, is then the least distance from it at which the atom was false.
    Otherwise, both are None.
    """

    atom: str
    robustness: float
    place: Point | None = None
    target: str | None = None
    distance: float | None = None
    wanted: bool = True


@record
class ExplainedEpisode:
    """An episode of a case: its ``summary``, and the facts that explain its result.

    A recorded trace is an episode without a game: it has no places, no enemies and no barriers. ``by``
    are the clauses that it breaks or does not meet.

    - ``cause``, ``by`` and ``place`` say how, by what and where the episode ended, as in
      :class:`~tltl_runtime.game.episode.Cause`.
    - ``seen_by`` are the enemies that saw the player in the last 3 seconds; none for a success.
    - ``arrivals`` are all entries into states, in order. The first is the start at step 0.
    - ``nearest`` is the nearest miss. It is None for a success, and for a failure without one.
    - ``way`` is the simplified trajectory.
    - ``broke`` are the atoms that broke the spec.
    - ``arrived`` says whether only the atoms in ``broke`` kept the last step from leading towards
      acceptance.
    - ``shut`` are the barriers that were closed at the end and stop players.
    """

    json_inlined = MappingProxyType(
        {"summary": ("index", "seed", "success", "end", "progress", "reward", "steps", "unmet")}
    )

    summary: EpisodeSummary
    cause: EndKind
    by: tuple[str, ...]
    place: Point | None
    seen_by: tuple[str, ...]
    arrivals: tuple[Arrival, ...]
    nearest: NearestMiss | None
    way: TrajectoryPoints
    broke: tuple[str, ...] = ()
    arrived: bool = False
    shut: tuple[str, ...] = ()


def summaries_of(episodes: Iterable[ExplainedEpisode]) -> list[EpisodeSummary]:
    """Return the summaries of the episodes, in order."""
    return [episode.summary for episode in episodes]


def explain_episode(summary: EpisodeSummary, episode: RecordedEpisode) -> ExplainedEpisode:
    """Explain the result of a recorded ``episode``, whose summary is ``summary``."""
    game, positions = episode.level.game, _positions(episode)
    cause = game.cause(episode)
    return ExplainedEpisode(
        # Verdicts, reports and the files of baselines do not contain these fields.
        summary=replace(summary, verdict=None, seconds=None, state=None, label=None),
        cause=cause.kind,
        by=cause.by,
        place=None if cause.place is None else _rounded(cause.place),
        seen_by=() if summary.success else game.observers(episode, cause.time - _SEEN_WITHIN_S, cause.time),
        arrivals=arrivals_of(episode),
        nearest=None if summary.success else _nearest_miss(episode, summary.unmet, positions),
        way=simplified_trajectory(episode),
        broke=cause.broke,
        arrived=_has_arrived(episode, summary.unmet, cause.broke),
        shut=game.shut_barriers(episode),
    )


def arrivals_of(episode: RecordedEpisode) -> tuple[Arrival, ...]:
    """Return all entries into states of a recorded episode, in order."""
    states, positions = episode.states.tolist(), _positions(episode)
    steps = [step for step in range(len(states)) if step == 0 or states[step] != states[step - 1]]
    return tuple(Arrival(states[step], step, positions[step]) for step in steps)


def _has_arrived(episode: RecordedEpisode, state: int, broke: Sequence[str]) -> bool:
    """Whether only the atoms in ``broke`` kept the last step from leading towards acceptance.

    ``state`` is the automaton's state before that step.
    """
    fspa, values = episode.fspa, episode.atoms[-1].tolist()
    primes = [prime for edge in monitors.tables(fspa).improving[state] for prime in edge.guard.primes]
    missing = [
        {fspa.atoms[atom].name for atom, must_hold in prime if (values[atom] > 0.0) != must_hold} for prime in primes
    ]
    return any(names and names <= {*broke} for names in missing)


def _nearest_miss(episode: RecordedEpisode, state: int, positions: Sequence[Point | None]) -> NearestMiss | None:
    """Return how near an episode came to a step towards acceptance in its last stay in ``state``.

    None if no edge leads from the state towards acceptance, or if the episode made no step in it.
    ``positions`` are those of the player's feet.
    """
    steps = _last_stay(episode, state)
    nearest = monitors.nearest_edge(episode.fspa, state, episode.atoms[steps].tolist())
    if nearest is None:
        return None
    target, distance = _target_and_distance(episode, nearest.atom, steps) if nearest.wanted else (None, None)
    return NearestMiss(
        atom=episode.fspa.atoms[nearest.atom].name,
        robustness=round(nearest.robustness, 4),
        place=positions[steps[nearest.row] + 1],
        target=target,
        distance=distance,
        wanted=nearest.wanted,
    )


def _last_stay(episode: RecordedEpisode, state: int) -> list[int]:
    """Return the steps of an episode in its last stay in ``state``, numbered from 0.

    A stay is a run of successive steps in one state of the automaton.
    """
    in_state = (episode.states[:-1] == state).tolist()
    end = max((step + 1 for step, is_in_state in enumerate(in_state) if is_in_state), default=0)
    began = max((step + 1 for step in range(end) if not in_state[step]), default=0)
    return list(range(began, end))


def _target_and_distance(episode: RecordedEpisode, atom: int, rows: Sequence[int]) -> tuple[str | None, float | None]:
    """Return the entity that an atom asks the player to approach, and the least distance to it.

    The distance, in metres, is the least over those of the steps ``rows`` at which the atom does
    not hold. Both are None if the atom has no such entity: see
    :func:`~tltl_runtime.regression.explain.stages.target_of`.
    """
    target = target_of(episode.fspa, atom)
    if target is None:
        return None, None
    column = distance_column(episode.fspa, target)
    distances = [float(episode.signals[row + 1, column]) for row in rows if episode.atoms[row, atom] <= 0.0]
    return target, round(min(distances), 2)


def _positions(episode: RecordedEpisode) -> list[Point | None]:
    """Return the positions of the player's feet, in metres, rounded to centimetres; None where they are not known."""
    if episode.positions is None:
        return [None] * len(episode.states)
    return [_rounded((x, y, z)) for x, y, z in episode.positions.tolist()]


def _rounded(point: Point) -> Point:
    x, y, z = point
    return round(x, 2), round(y, 2), round(z, 2)
