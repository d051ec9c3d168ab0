"""Handmade episodes, references, cases and suites for tests."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tltl_runtime.game.episode import EndKind
from tltl_runtime.regression.explain.explained_episode import Arrival, ExplainedEpisode, NearestMiss, summaries_of
from tltl_runtime.regression.explain.path_points import TrajectoryPoints
from tltl_runtime.regression.suite.suite import Case, Suite, Thresholds, baseline_path
from tltl_runtime.regression.verdict.baseline import Identity, Reference
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.stealth.level import Point
from tltlc.core.record import replace

ROOM = """doc = "A room."

[bounds]
at = [5.0, 5.0, -0.5]
size = [10.0, 10.0, 4.5]

[start]
at = [2.0, 2.0, 0.0]

[[exit]]
name = "exit"
at = [8.0, 8.0, 0.0]

[[enemy]]
name = "guard"
kind = "guard"
route = [[5.0, 8.5, 0.0]]
"""
"""The file of a small level, as a user could write it."""


def an_episode(
    index: int = 0,
    success: bool = True,
    *,
    progress: float | None = None,
    reward: float | None = None,
    steps: int = 100,
    states: Sequence[int] = (0,),
    unmet: int | None = None,
    cause: EndKind | None = None,
    by: tuple[str, ...] = (),
    seen_by: tuple[str, ...] = (),
    broke: tuple[str, ...] = (),
    arrived: bool = False,
    place: Point = (5.0, 5.0, 0.0),
    nearest: NearestMiss | None = None,
    way: TrajectoryPoints = ((2.0, 2.0, 0, 0.0), (2.0, 2.0, 0, 1.0)),
) -> ExplainedEpisode:
    """Return an explained episode, by default one that met its spec."""
    return ExplainedEpisode(
        summary=EpisodeSummary(
            index=index,
            seed=1000 + index,
            success=success,
            end="success" if success else "limit",
            progress=(1.0 if success else 0.5) if progress is None else progress,
            reward=(0.7 if success else -0.4) if reward is None else reward,
            steps=steps,
            unmet=states[-1] if unmet is None else unmet,
        ),
        cause=cause or ("success" if success else "limit"),
        by=by,
        place=place,
        seen_by=seen_by,
        arrivals=tuple(Arrival(state, 10 * row, place) for row, state in enumerate(states)),
        nearest=nearest,
        way=way,
        broke=broke,
        arrived=arrived,
    )


def changed(explained: ExplainedEpisode, **fields: object) -> ExplainedEpisode:
    """Return the episode with other values of these ``fields`` in its summary."""
    return replace(explained, summary=replace(explained.summary, **fields))


def summary(
    index: int = 0, success: bool = True, progress: float | None = None, reward: float | None = None
) -> EpisodeSummary:
    """Return the summary of an episode, by default of one that met its spec."""
    return an_episode(index, success, progress=progress, reward=reward).summary


def a_summary(success: bool, progress: float, reward: float) -> EpisodeSummary:
    """Return the summary of an episode of 100 steps."""
    return EpisodeSummary(0, 7, success, "success" if success else "limit", progress, reward, steps=100, unmet=0)


def summaries(passed: int, failed: int = 0) -> list[EpisodeSummary]:
    """Return summaries of episodes; the first ``failed`` episodes do not meet the spec."""
    return summaries_of(some_episodes(passed, failed))


def some_episodes(passed: int, failed: int = 0) -> list[ExplainedEpisode]:
    """Return explained episodes; the first ``failed`` of them do not meet the spec."""
    return [an_episode(index, index >= failed) for index in range(passed + failed)]


PLAYED = Identity(
    level="room",
    variant="v0",
    spec="careful",
    policy="a" * 64,
    seed=7,
    level_hash="b" * 64,
    spec_hash="c" * 64,
    files=(("room.toml", "d" * 64), ("assets/guard.toml", "e" * 64)),
    versions={"tltlc": "0.1"},
)


def reference(explained_episodes: Sequence[ExplainedEpisode] = (), **changed: object) -> Reference:
    return Reference(replace(PLAYED, **changed), tuple(explained_episodes))


def case(name: str, level: str = "navigation", variant: str = "v0", policy: Path = Path("policy")) -> Case:
    return Case(name, level, variant, "v0", None, policy, 25, Thresholds())


def suite(*cases: Case, path: Path = Path("game.toml")) -> Suite:
    return Suite(path, 7, 0.05, cases, baseline_path(path))
