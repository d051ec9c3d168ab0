"""Retrain a policy on a changed level, to find out whether the level is feasible.

A level is feasible if a player can meet the spec there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from itertools import count
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.policies.file import read_policy
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode, summaries_of
from tltl_runtime.regression.report.retraining_result import (
    BestFailedEpisode,
    FinishedRetraining,
    RetrainingResult,
    outcome_of,
    sentence,
)
from tltl_runtime.regression.suite.named_files import policy_file
from tltl_runtime.regression.suite.result_cache import cache_text, inputs_hash, read_cache
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Case, Suite
from tltl_runtime.regression.suite_run import WRITABLE, FinishedCase, case_folder
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.regression.verdict.play import PreparedCase, play_episodes
from tltl_runtime.support.record_json import to_json
from tltl_runtime.training.files.checkpoint import read_checkpoint
from tltl_runtime.training.files.metrics import METRICS
from tltl_runtime.training.files.record import recorded_end
from tltl_runtime.training.files.run_file import (
    CHECKPOINT,
    CURVE,
    POLICY,
    RECORD,
    RUN,
    WAYS,
    TrainingRun,
    identity,
    read_level_hash,
    read_run,
)
from tltl_runtime.training.files.settings import read_settings
from tltl_runtime.training.files.training_lock import lock_training
from tltl_runtime.training.run.initial_policy import initial_policy_of, weights_hash
from tltlc.api import Diagnostic, Fspa, TltlError, fileio, label_text, replace

FOLDER: Final = "retrained"
"""The name of a folder in the folder of a run. It contains a folder for the training of each case."""
EPISODE: Final = "met.episode.npz"
"""The name of a file in a training's folder: the recording of an episode that the retrained policy won."""

_RESULT: Final = "retrained.json"
_VERSION: Final = 1


def configure_retraining(suite: Suite, prepared: PreparedCase, folder: Path, minutes: float, pool: Pool) -> TrainingRun:
    """Configure the retraining of a case's policy on the level of the case; do not start it.

    The training's folder is inside ``folder``, the folder of a run of the suite. The training stops
    after ``minutes`` at the latest. ``pool`` says which processes play.

    Raises:
        TltlError: TLT0942, the policy of a case lies in the folder of the training.
    """
    place, path = _training_folder(suite, prepared.case, folder), policy_file(prepared.case.policy)
    setup, card = prepared.setup, prepared.setup.policy.card
    settings = read_settings(level=setup.level)
    rollout = replace(
        settings.rollout, pool="ray" if pool == "ray" else "processes", workers=0 if pool == "ray" else pool
    )
    return TrainingRun(
        folder=place,
        fspa=setup.fspa,
        params=setup.params,
        level=setup.level,
        variant=setup.variant,
        sensors=card.sensors,
        settings=replace(settings, network=card.network, rollout=rollout, stop=replace(settings.stop, minutes=minutes)),
        seed=suite.seed,
        initial=initial_policy_of(path, setup.policy),
    )


def is_stored(run: TrainingRun) -> bool:
    """Whether ``run.folder`` already contains the training that ``run`` configures, finished or not.

    The stored training must have the same level, spec, initial policy, seed and settings. The
    result is False, too, if its files are damaged or missing.

    Raises:
        TltlError: the level does not load.
    """
    expected = identity(run)
    try:
        # The folder may name the level differently. Compare the hash of its content instead.
        stored = replace(read_run(run.folder), level=run.level, variant=run.variant)
        if {**identity(stored), "level": read_level_hash(run.folder)} != expected:
            return False
        checkpoint = read_checkpoint(run.folder / CHECKPOINT, expected)
    except TltlError:
        # The training is damaged or has another version.
        return False
    # A training that was stopped during its search has no checkpoint yet; the search goes on with the ways found.
    is_finished = (run.folder / RECORD).exists()
    return not is_finished or (checkpoint is not None and (run.folder / POLICY).exists())


def check_policy_folders(suite: Suite, cases: Sequence[Case], folder: Path) -> None:
    """Check that no policy of the suite lies in the folder of the training for one of ``cases``.

    The training would overwrite it. ``folder`` is the folder of the run of the suite.

    Raises:
        TltlError: TLT0942, the policy of a case lies in such a folder.
    """
    for case in cases:
        _training_folder(suite, case, folder)


def _training_folder(suite: Suite, case: Case, folder: Path) -> Path:
    """Return the folder of the training for a case. ``folder`` is the folder of the run of the suite.

    Raises:
        TltlError: TLT0942, the policy of a case of the suite lies in that folder.
    """
    place = case_folder(suite, case.name, folder / FOLDER)
    for suite_case in suite.played_cases:
        if policy_file(suite_case.policy).resolve().parent == place.resolve():
            whose = "its training" if suite_case.name == case.name else f"the training for `{case.name}`"
            title = f"the policy of the case `{suite_case.name}` is stored in `{place}`, where {whose} will write"
            help_ = "move it next to the suite, and name its new place there as `policy`"
            raise TltlError([Diagnostic("TLT0942", title, help=help_)])
    return place


def make_room(suite: Suite, folder: Path) -> Path | None:
    """Clear ``folder`` for another training.

    - If the training there is finished, rename the folder, and return its new path.
    - Else remove the files of the training, leave all other files, and return None.

    Raises:
        TltlError: TLT0005, a file cannot be removed, or the folder cannot be moved; TLT0865,
            another process trains there.
    """
    names = (RUN, CHECKPOINT, WAYS, POLICY, CURVE, METRICS, EPISODE, _RESULT)
    with lock_training(folder):
        if not (folder / RECORD).exists():
            for path in (*(folder / name for name in names), *folder.glob("events.out.tfevents.*")):
                fileio.remove_file(path, WRITABLE)
            return None
    # Windows refuses to move the folder before the lock file is closed.
    new_folder = _free_folder(suite, folder)
    try:
        folder.rename(new_folder)
    except OSError as error:
        title = f"cannot move `{folder}` to `{new_folder}`: {fileio.reason(error)}"
        raise TltlError([Diagnostic("TLT0005", title, help=WRITABLE)]) from None
    return new_folder


def _free_folder(suite: Suite, folder: Path) -> Path:
    """Return the first free path in the series ``FOLDER-2``, ``FOLDER-3``, …, where FOLDER is ``folder``.

    A path is free if it does not exist and is not the folder of the training for a case of the suite.
    """
    reserved = {case_folder(suite, case.name, folder.parent) for case in suite.cases}
    candidates = (folder.with_name(f"{folder.name}-{number}") for number in count(2))
    return next(path for path in candidates if path not in reserved and not path.exists())


def retraining_result(
    suite: Suite,
    finished: FinishedCase,
    run: TrainingRun,
    pool: Pool,
    on_episode: Callable[[int, ExplainedEpisode], None],
) -> RetrainingResult:
    """Return the result of the finished training in ``run.folder``, and cache it there.

    ``finished`` is the case whose policy was retrained. Unless the result is cached, the retrained
    policy plays fresh episodes, until it is certain whether its pass rate reaches the threshold of the
    case. After each episode, ``on_episode`` is called with the number of episodes so far and the last
    episode.

    Raises:
        TltlError: the policy's file cannot be read; errors from playing; TLT0005, a file cannot be
            written.
    """
    assert finished.prepared is not None
    policy, training = read_policy(run.folder / POLICY), training_summary(run)
    error = suite.error / len(suite.cases)
    # Use another seed: the original policy has already played the episodes of the suite's seed.
    setup = replace(finished.prepared.setup, policy=policy, seed=(suite.seed + 1) % 2**31)
    prepared = replace(finished.prepared, setup=setup, case=replace(finished.prepared.case, policy=run.folder))
    inputs = _inputs(prepared, weights_hash(policy), training, error, finished.report.episodes)
    if cached := _cached_result(run.folder, inputs):
        return cached
    played, recording, interval = _play_until_certain(prepared, error, pool, on_episode)
    thresholds = prepared.case.thresholds
    met = sum(episode.summary.success for episode in (*played, *finished.report.episodes))
    outcome = outcome_of(training, interval[0], thresholds, met)
    overall, best = figures_of(summaries_of(played)), _best(played, setup.fspa)
    place = f"{FOLDER}/{run.folder.name}"
    result = RetrainingResult(
        outcome=outcome,
        text=sentence(outcome, training, overall, interval, thresholds, best),
        trained=training,
        figures=overall,
        rate_interval=interval,
        best=best,
        policy=f"{place}/{POLICY}",
        episode=f"{place}/{EPISODE}" if recording else None,
    )
    files: dict[str, str | bytes] = {EPISODE: recording} if recording else {}
    fileio.write_files(run.folder, {**files, _RESULT: cache_text(inputs, result)}, WRITABLE, over_inputs=True)
    return result


def training_summary(run: TrainingRun) -> FinishedRetraining:
    """Summarize the finished training in ``run.folder``.

    Raises:
        TltlError: the checkpoint cannot be read; TLT0863, the end of the training is not recorded.
    """
    state = read_checkpoint(run.folder / CHECKPOINT, identity(run))
    assert state is not None
    end = recorded_end(run.folder) or state.reason(run.settings.stop)
    if end is None:
        title = f"`{run.folder / RECORD}` does not say how the training ended"
        raise TltlError([Diagnostic("TLT0863", title, help="remove it: the training then continues to its end")])
    # These are the lengths of successes of the search and of the agent. Either may have the shortest.
    lengths = [int(length) for process in state.processes for length in process.get("way_lengths", ())]
    return FinishedRetraining(
        end=end,
        steps=state.steps,
        seconds=round(state.seconds, 1),
        searched=state.searched.steps if state.searched else 0,
        complete=state.searched is None or state.searched.complete,
        shortest=min(lengths, default=None),
    )


def _play_until_certain(
    prepared: PreparedCase, error: float, pool: Pool, on_episode: Callable[[int, ExplainedEpisode], None]
) -> tuple[list[ExplainedEpisode], bytes, tuple[float, float]]:
    """Play episodes until it is certain whether the pass rate reaches the case's threshold.

    Stop, at the latest, when all episodes of the case are played. Return the episodes, the recording
    of the first episode that met the spec (empty if none did), and the confidence interval of the pass
    rate. ``error`` is the allowed probability that a certain statement is wrong.
    """
    threshold = prepared.case.thresholds.pass_rate
    played, recording, interval = list[ExplainedEpisode](), b"", (0.0, 1.0)
    with closing(play_episodes(prepared, pool)) as playing:
        for episode in playing:
            played.append(episode.explained)
            on_episode(len(played), episode.explained)
            recording = recording or (episode.recording if episode.explained.summary.success else b"")
            passed = sum(explained.summary.success for explained in played)
            interval = rate_interval(passed, len(played) - passed, error)
            if len(played) >= LEAST_EPISODES and (interval[0] >= threshold or interval[1] < threshold):
                break
    return played, recording, interval


def _best(played: Sequence[ExplainedEpisode], fspa: Fspa) -> BestFailedEpisode | None:
    failed = [episode for episode in played if not episode.summary.success]
    if not failed:
        return None
    farthest = max(failed, key=lambda episode: episode.summary.progress)
    return BestFailedEpisode(farthest.summary.progress, label_text(fspa, farthest.summary.unmet))


def _inputs(
    prepared: PreparedCase,
    weights: str,
    training: FinishedRetraining,
    error: float,
    judged_episodes: Sequence[ExplainedEpisode],
) -> str:
    """Return the hash of everything that the result of a retraining depends on, for the cache.

    ``weights`` is the hash of the retrained policy's weights. ``judged_episodes`` are the episodes
    by which the case was judged.
    """
    case = prepared.case
    parts = [
        _VERSION,
        case.episodes,
        to_json(case.thresholds),
        error,
        to_json(prepared.played),
        weights,
        to_json(training),
    ]
    return inputs_hash([*parts, sum(episode.summary.success for episode in judged_episodes)])


def _cached_result(folder: Path, inputs: str) -> RetrainingResult | None:
    """Return the result that is cached in the folder of a training; None if it is missing or out of date.

    It is out of date if the hash of what it depends on is not ``inputs``, or if the recording that it
    names is missing.
    """
    result = read_cache(RetrainingResult, folder / _RESULT, inputs)
    return result if result and (result.episode is None or (folder / EPISODE).is_file()) else None
