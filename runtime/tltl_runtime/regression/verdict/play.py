"""Play the cases of a suite, until the verdict is settled or to record a baseline."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from functools import partial
from shlex import join
from typing import Final

from tltl_runtime.evaluation.evaluate import OnLost, Pool, log_lost, results, set_up
from tltl_runtime.evaluation.player import EpisodeRequest, LostEpisode, Setup
from tltl_runtime.evaluation.versions import versions
from tltl_runtime.game.game import SHOWN_EPISODES
from tltl_runtime.game.level import Level
from tltl_runtime.game.level_name import Variant, is_scene, level_option, split_scene
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.compatibility import differences
from tltl_runtime.policies.file import MAX_BYTES, from_bytes
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode, explain_episode, summaries_of
from tltl_runtime.regression.suite.named_files import policy_file
from tltl_runtime.regression.suite.suite import Case
from tltl_runtime.regression.verdict.baseline import Identity, Reference
from tltl_runtime.regression.verdict.verdict import Judgement, judge
from tltl_runtime.spec.task import read_spec
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.lost_episodes import LostEpisodes
from tltlc.api import Diagnostic, TltlError, fileio, record, replace

OnEpisode = Callable[[Case, int, ExplainedEpisode], None]
"""A callback after each episode. It gets the case, the number of episodes so far, and the last episode."""

_PLAYER: Final = "policy"
_ADDED: Final = 2
"""The most episodes that are recorded only because they show more of the level."""


@record
class PreparedCase:
    """A case that is set up to be played.

    ``setup`` describes the evaluation that plays its episodes, and ``played`` identifies everything
    on which these depend. ``changes`` are the descriptions of the variant's overlays (files that
    change a level). ``outdated`` is a message if the spec of the level has changed since the policy
    was trained, and the old spec judges the policy. Otherwise it is None.
    """

    case: Case
    setup: Setup
    played: Identity
    level: Level
    changes: tuple[str, ...] = ()
    outdated: str | None = None


@record
class CaseEpisode:
    """A played episode of a case: facts that explain its result, and the bytes of its recording."""

    explained: ExplainedEpisode
    recording: bytes


@record
class JudgedCase:
    """A case with its verdict and its played episodes, in order.

    ``reference`` has the episodes of the baseline with which it was compared. ``lost`` are the episodes
    that were lost with their games; the verdict is without them. None if there are none.
    """

    prepared: PreparedCase
    reference: Reference
    judgement: Judgement
    episodes: tuple[CaseEpisode, ...]
    lost: LostEpisodes | None = None


def prepare_case(case: Case, seed: int, variant: Variant | None = None) -> PreparedCase:
    """Set up a case to be played with the suite's ``seed``.

    ``variant`` is the variant of the level to play, by default that of the case.

    Raises:
        TltlError: policy, level, variant or spec cannot be loaded or do not fit together.
    """
    path = policy_file(case.policy)
    data = fileio.read_bytes(path, str(path), MAX_BYTES)
    policy = from_bytes(data, str(path))
    setup = set_up(policy, case.level, variant or case.variant, case.spec, seed, "all")
    game = game_of(setup.level)
    level, changes = game.level_files.load_with_changes(setup.level, setup.variant)
    sha256 = hashlib.sha256(data).hexdigest()
    played = Identity(
        level=level.name,
        variant=level.variant,
        spec=setup.fspa.name,
        policy=sha256,
        seed=seed,
        level_hash=game.level_hash(level),
        spec_hash=spec_hash(setup.fspa),
        files=level.files,
        versions=versions(),
        place=case.place,
    )
    return PreparedCase(case, setup, played, level, changes, _outdated_message(case, setup, level))


def play_episodes(
    prepared: PreparedCase, pool: Pool, on_lost: OnLost = log_lost, indices: Sequence[int] | None = None
) -> Generator[CaseEpisode]:
    """Play the episodes of a case with these indices, by default all, and yield them in order.

    Closing the iterator ends the workers. In place of an episode that is lost with its game, ``on_lost``
    is called.

    Raises:
        TltlError: TLT0905, the level was edited since the setup, or before the last episode ended;
            errors from playing.
    """
    requests = [EpisodeRequest(index) for index in (range(prepared.case.episodes) if indices is None else indices)]
    lost: list[LostEpisode] = []

    def add_lost(episode: LostEpisode) -> None:
        lost.append(episode)
        on_lost(episode)

    command = partial(_replay_command, prepared)
    with closing(results(prepared.setup, requests, pool, replay_command=command, on_lost=add_lost)) as playing:
        for count, result in enumerate(playing):
            # Before `results` raises an error, it yields all finished episodes. Skip those that come after
            # a missing one: counting them would favour fast episodes.
            if result.request != requests[count + len(lost)]:
                continue
            episode = prepared.level.game.episode_from_bytes(result.recording, _PLAYER)
            # Each worker loads the level itself, so check the level of the recording.
            _check_unedited(prepared, episode.level)
            yield CaseEpisode(explain_episode(result.summary, episode), result.recording)
    check_unedited(prepared)


def _replay_command(prepared: PreparedCase, request: EpisodeRequest) -> str:
    """Return the shell command ``tltlc evaluate …`` that plays only the requested episode of a case."""
    level = prepared.setup.level
    if is_scene(level) and split_scene(level)[1] is None:
        level = f"{level}:{prepared.level.name}"
    place = [level_option(level), f"{level}:{prepared.setup.variant.text}"]
    spec = [] if prepared.case.spec is None else ["--spec", prepared.case.spec]
    episode = ["--seed", str(prepared.setup.seed), "--first", str(request.index), "--episodes", "1"]
    return join(["tltlc", "evaluate", str(prepared.case.policy), *place, *spec, *episode])


def check_unedited(prepared: PreparedCase) -> None:
    """Check that the level of a case was not edited since the case was set up.

    A worker that loaded the level before an edit does not notice the edit.

    Raises:
        TltlError: TLT0905, the level was edited; or the errors of the edited level.
    """
    _check_unedited(prepared, game_of(prepared.setup.level).load_level(prepared.setup.level, prepared.setup.variant))


def judge_case(
    prepared: PreparedCase,
    reference: Reference,
    error: float,
    pool: Pool,
    on_episode: Callable[[int, ExplainedEpisode], None],
) -> JudgedCase:
    """Play a case until its verdict is settled, and return it with the verdict.

    ``reference`` has the episodes of the baseline to compare with. ``error`` is the allowed
    probability of a wrong verdict on this case. After each episode, ``on_episode`` is called with
    the number of episodes so far and the last episode.

    Episodes that are lost with their games do not count, and neither do those of the baseline with
    the same seeds. Too few episodes may then be left for a verdict.

    Raises:
        TltlError: the errors of :func:`play_episodes` and :func:`check_unedited`.
        WireError: too many episodes were lost.
    """
    played: list[CaseEpisode] = []
    lost: list[LostEpisode] = []
    with closing(play_episodes(prepared, pool, lost.append)) as playing:
        for episode in playing:
            played.append(episode)
            on_episode(len(played), episode.explained)
            if judged := _judged(prepared, reference, played, lost, error):
                return judged
    # If the last episodes were lost, those that were played may settle the verdict only now.
    if judged := _judged(prepared, reference, played, lost, error):
        return judged
    raise WireError([lost[0].fault])


def _judged(
    prepared: PreparedCase,
    reference: Reference,
    played: Sequence[CaseEpisode],
    lost: Sequence[LostEpisode],
    error: float,
) -> JudgedCase | None:
    """Return the case with its verdict; None if more episodes have to be played."""
    reference = _without(reference, lost)
    now, before = [episode.explained.summary for episode in played], summaries_of(reference.episodes)
    judgement = judge(now, before, prepared.case.episodes - len(lost), prepared.case.thresholds, error)
    if judgement is None:
        return None
    check_unedited(prepared)
    lost_episodes = LostEpisodes(len(lost), lost[0].fault) if lost else None
    return JudgedCase(_as_played(prepared, played[:SHOWN_EPISODES]), reference, judgement, tuple(played), lost_episodes)


def _without(reference: Reference, lost: Sequence[LostEpisode]) -> Reference:
    """Return a reference without the episodes that have the seeds of the ``lost`` ones."""
    if not lost:
        return reference
    indices = {episode.request.index for episode in lost}
    left = tuple(episode for episode in reference.episodes if episode.summary.index not in indices)
    return replace(reference, episodes=left)


def _as_played(prepared: PreparedCase, episodes: Sequence[CaseEpisode]) -> PreparedCase:
    """Return the case, with what the episodes show of its level added to the level, for reports.

    Some games know only from play where things are: see
    :meth:`~tltl_runtime.game.game.Game.played_level`.
    """
    game = prepared.level.game
    recorded = (game.episode_from_bytes(episode.recording, _PLAYER) for episode in episodes)
    return replace(prepared, level=game.played_level(prepared.level, recorded))


def telling_episodes(level: Level, episodes: Sequence[CaseEpisode], chosen: Sequence[int]) -> list[int]:
    """Return the indices of episodes that show of ``level`` what the ``chosen`` ones alone do not show.

    Examples are that the map changes from episode to episode, or that an entity moves. Only the first
    episodes are looked at, and at most ``_ADDED`` are returned.
    """
    played = {
        episode.explained.summary.index: level.game.episode_from_bytes(episode.recording, _PLAYER)
        for place, episode in enumerate(episodes)
        if place < SHOWN_EPISODES or episode.explained.summary.index in chosen
    }
    known, added = [played[index] for index in chosen], []
    for index, episode in played.items():
        if level.game.played_level(level, [*known, episode]) != level.game.played_level(level, known):
            known.append(episode)
            added.append(index)
    return added[:_ADDED]


def _check_unedited(prepared: PreparedCase, level: Level) -> None:
    before, now = prepared.level.files, level.files
    if before != now:
        # Names can repeat: overlays of the same name may come from several folders.
        names = dict.fromkeys(f"`{file[0]}`" for file in (*before, *now) if (file in before) != (file in now))
        title = f"{', '.join(names)} changed while `{prepared.case.name}` was played"
        raise TltlError([Diagnostic("TLT0905", title, help="run the same command again")])


def _outdated_message(case: Case, setup: Setup, level: Level) -> str | None:
    """Return a message if the level's spec has changed since the policy of a case was trained.

    The old spec, which the policy stores, judges such a case. None if the spec has not changed, if
    the case names the spec that judges, or if the level has no spec or one of another name.

    Raises:
        TltlError: the level's spec cannot be read.
    """
    if case.spec is not None or level.spec is None or level.spec.name not in ("", setup.fspa.name):
        return None
    now = read_spec(level.spec.text)[0]
    if now.name != setup.fspa.name or spec_hash(now) == spec_hash(setup.fspa):
        return None
    changes = f"the spec `{now.name}` has changed since the policy was trained ({differences(setup.fspa, now)})"
    help_ = "train the policy again, or name the new spec as the case's `spec`"
    return f"{changes}, and the policy's old spec still judges: {help_}"
