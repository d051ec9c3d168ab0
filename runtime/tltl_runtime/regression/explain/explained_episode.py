"""An episode with the facts that explain its result, for verdicts, explanations and pictures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from types import MappingProxyType
from typing import Final

from tltl_runtime.game.episode import EndKind, RecordedEpisode
from tltl_runtime.game.geometry import Point
from tltl_runtime.game.moments import has_clock
from tltl_runtime.regression.explain.path_points import TrajectoryPoints, simplified_trajectory
from tltl_runtime.regression.explain.stages import distance_column, target_of
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltlc.api import monitors, record, replace, traces

_SEEN_WITHIN_S: Final = 3.0
"""An enemy is reported if it saw the player within this many seconds before the end."""


@record
class Arrival:
    """An entry into a state of the automaton, at a step.

    ``step`` 0 is the reset. ``place`` is the position of the player's feet at the step, in metres;
    None if it is not known.
    """

    state: int
    step: int
    place: Point | None = None


@record
class NearestMiss:
    """How near a failed episode came to an edge that leads from its last state towards acceptance.

    If a violation ended the episode, its last state is the state before the violation. Only the last
    stay in this state counts.

    ``robustness``, in [-1, 1], is the greatest robustness of the guards of such edges during this
    stay. ``place`` is where the player was at that moment; None if it is not known. ``atom`` is the
    name of the atom that limited the robustness: it had to be true if ``wanted``, else false.

    If the atom had to be true, and the player makes it true by approaching an entity, ``target`` is
    that entity. ``distance`` is then the least distance to the target, in metres, at which the atom
    was still false. Otherwise, both are None. ``missed`` measures the atom at that moment if it is a
    comparison: its ``gap`` is by how much the episode missed it. Otherwise, it is None. ``reached`` says
    whether the atom was as it had to be at another moment of the stay, when others were not. It is not
    known of episodes in older baselines.
    """

    atom: str
    robustness: float
    place: Point | None = None
    target: str | None = None
    distance: float | None = None
    wanted: bool = True
    missed: traces.Measure | None = None
    reached: bool = False


@record
class ExplainedEpisode:
    """An episode of a case: its ``summary``, and the facts that explain its result.

    - ``cause``, ``by`` and ``place`` say how, by what and where the episode ended, as in
      :class:`~tltl_runtime.game.episode.Cause`.
    - ``seen_by`` are the enemies that saw the player in the last 3 seconds; none for a success.
    - ``arrivals`` are all entries into states of the automaton, in order. The first is the start at
      step 0.
    - ``nearest`` says how near a failed episode came to its next step towards acceptance. It is None
      for a success, and if no edge leads towards acceptance.
    - ``way`` is the simplified trajectory; empty if the positions of the player are not known.
    - ``broke`` are the names of the atoms that broke the spec.
    - ``arrived`` says whether the last step would have led towards acceptance but for the atoms in
      ``broke``.
    - ``shut`` are the barriers that were closed at the end and stop players.
    - ``clauses`` are the clauses of the spec that the episode broke, as in its source text. They are not
      known of episodes in older baselines.
    - ``measured`` measures the comparison that broke the spec; None if no comparison did.
    - ``seconds`` is the time since the reset when the spec broke; None if it did not, or if the game has no
      clock.

    A recorded trace is an episode without a game: it has no places, no enemies and no barriers. Its
    ``by`` are the clauses of the spec that the trace breaks or does not meet.
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
    clauses: tuple[str, ...] = ()
    measured: traces.Measure | None = None
    seconds: float | None = None


def summaries_of(episodes: Iterable[ExplainedEpisode]) -> list[EpisodeSummary]:
    """Return the summaries of the episodes, in order."""
    return [episode.summary for episode in episodes]


def explain_episode(summary: EpisodeSummary, episode: RecordedEpisode) -> ExplainedEpisode:
    """Return a recorded ``episode``, whose summary is ``summary``, with the facts that explain its result."""
    game, positions = episode.level.game, _positions(episode)
    cause = game.cause(episode)
    broken = summary.cause if summary.cause and summary.cause.kind in ("broken", "blocked") else None
    return ExplainedEpisode(
        # Verdicts, reports and the files of baselines do not contain these fields.
        summary=replace(summary, verdict=None, seconds=None, state=None, label=None, cause=None),
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
        clauses=broken.clauses if broken and broken.kind == "broken" else (),
        measured=broken.measure if broken else None,
        seconds=round(float(episode.times[broken.step]), 4) if broken and has_clock(episode.times) else None,
    )


def arrivals_of(episode: RecordedEpisode) -> tuple[Arrival, ...]:
    """Return all entries of a recorded episode into states of the automaton, in order.

    The first is the start, at step 0.
    """
    states, positions = episode.states.tolist(), _positions(episode)
    steps = [step for step in range(len(states)) if step == 0 or states[step] != states[step - 1]]
    return tuple(Arrival(states[step], step, positions[step]) for step in steps)


def _has_arrived(episode: RecordedEpisode, state: int, broke: Sequence[str]) -> bool:
    """Whether the last step would have led towards acceptance but for the atoms in ``broke``.

    ``state`` is the automaton's state before that step.
    """
    fspa, values = episode.fspa, episode.atoms[-1].tolist()
    primes = [prime for edge in monitors.tables(fspa).improving[state] for prime in edge.guard.primes]
    missing = [
        {fspa.atoms[atom].name for atom, must_hold in prime if (values[atom] > 0.0) != must_hold} for prime in primes
    ]
    return any(names and names <= {*broke} for names in missing)


def _nearest_miss(episode: RecordedEpisode, state: int, positions: Sequence[Point | None]) -> NearestMiss | None:
    """Return how near an episode came, in its last stay in ``state``, to an edge towards acceptance.

    None if no such edge leaves the state, or if the episode took no step in the state.
    ``positions`` are those of the player's feet after each step, from the reset on.
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
        missed=_measure(episode, nearest.atom, steps[nearest.row] + 1),
        reached=nearest.reached,
    )


def _measure(episode: RecordedEpisode, atom: int, row: int) -> traces.Measure | None:
    """Measure an atom, given by its index, at a row of the episode's signals; None if it is no comparison."""
    params = tuple(replace(param, value=episode.params.get(param.name, param.value)) for param in episode.fspa.params)
    names = (signal.name for signal in episode.fspa.signals)
    sample = dict(zip(names, episode.signals[row].tolist(), strict=True))
    return traces.measure(replace(episode.fspa, params=params), atom, sample)


def _last_stay(episode: RecordedEpisode, state: int) -> list[int]:
    """Return the steps of an episode in its last stay in ``state``, numbered from 0.

    A stay is a run of successive steps in one state of the automaton.
    """
    in_state = (episode.states[:-1] == state).tolist()
    end = max((step + 1 for step, is_in_state in enumerate(in_state) if is_in_state), default=0)
    began = max((step + 1 for step in range(end) if not in_state[step]), default=0)
    return list(range(began, end))


def _target_and_distance(episode: RecordedEpisode, atom: int, rows: Sequence[int]) -> tuple[str | None, float | None]:
    """Return the entity that the player must approach to make an atom true, and the least distance to it.

    ``atom`` is the index of the atom. The distance, in metres, is the least at those steps in ``rows``
    at which the atom does not hold. Both are None if the atom has no such entity: see
    :func:`~tltl_runtime.regression.explain.stages.target_of`.
    """
    target = target_of(episode.fspa, atom)
    if target is None:
        return None, None
    column = distance_column(episode.fspa, target)
    distances = [float(episode.signals[row + 1, column]) for row in rows if episode.atoms[row, atom] <= 0.0]
    return target, round(min(distances), 2)


def _positions(episode: RecordedEpisode) -> list[Point | None]:
    """Return the position of the player's feet after each step, from the reset on; None if it is not known.

    The positions are in metres, rounded to centimetres.
    """
    if episode.positions is None:
        return [None] * len(episode.states)
    return [_rounded((x, y, z)) for x, y, z in episode.positions.tolist()]


def _rounded(point: Point) -> Point:
    x, y, z = point
    return round(x, 2), round(y, 2), round(z, 2)
