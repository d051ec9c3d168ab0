"""Continue the training of policies on changed levels, to find out whether these levels are feasible."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from itertools import count
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.policies.file import read_policy
from tltl_runtime.regression.explain.account import Account, summaries_of
from tltl_runtime.regression.retrain.retrained import (
    BestFailedEpisode,
    FinishedRetraining,
    Retrained,
    outcome_of,
    sentence,
)
from tltl_runtime.regression.suite.named_files import policy_file
from tltl_runtime.regression.suite.result_cache import inputs_hash, kept_text, read_kept
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Case, Suite
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.regression.verdict.play import Ready, episodes
from tltl_runtime.regression.verdict.suite_run import WRITABLE, Done, case_folder
from tltl_runtime.support.record_json import to_json
from tltl_runtime.training.run.checkpoint import read_checkpoint
from tltl_runtime.training.run.folder import lock_training
from tltl_runtime.training.run.initial_policy import initial_policy_of, weights_hash
from tltl_runtime.training.run.metrics import METRICS
from tltl_runtime.training.run.record import recorded_end
from tltl_runtime.training.run.run_file import (
    CHECKPOINT,
    CURVE,
    POLICY,
    RECORD,
    RUN,
    TrainingRun,
    identity,
    read_level_hash,
    read_run,
)
from tltl_runtime.training.run.settings import read_settings
from tltlc.api import Diagnostic, Fspa, TltlError, fileio, label_text, replace

FOLDER: Final = "retrained"
"""The name of the folder, in the folder of a run, that contains the training of each case."""
EPISODE: Final = "met.episode.npz"
"""The file, in the folder of a training, with an episode of the retrained policy that met the spec."""

_RESULT: Final = "retrained.json"
_VERSION: Final = 1


def retraining(suite: Suite, ready: Ready, folder: Path, minutes: float, pool: Pool) -> TrainingRun:
    """Configure the retraining of a case's policy on its level, below the ``folder`` of a run.

    It stops after ``minutes`` at the latest.

    Raises:
        TltlError: TLT0942, the policy of a case lies in the folder of the training.
    """
    place, path = _place(suite, ready.case, folder), policy_file(ready.case.policy)
    setup, card, settings = ready.setup, ready.setup.policy.card, read_settings()
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


def is_kept(run: TrainingRun) -> bool:
    """Whether the folder contains this training, finished or not: same level, spec, policy, seed and settings.

    Raises:
        TltlError: the level does not load, which is no fault of the folder.
    """
    wanted = identity(run)
    try:
        # The folder may name the level differently.  Compare the hash of its content instead.
        stored = replace(read_run(run.folder), level=run.level, variant=run.variant)
        if {**identity(stored), "level": read_level_hash(run.folder)} != wanted:
            return False
        checkpoint = read_checkpoint(run.folder / CHECKPOINT, wanted)
    except TltlError:
        # The training is damaged or has another version.
        return False
    # A training that was stopped during its search has no checkpoint yet; the search starts again.
    is_finished = (run.folder / RECORD).exists()
    return not is_finished or (checkpoint is not None and (run.folder / POLICY).exists())


def check_places(suite: Suite, cases: Sequence[Case], folder: Path) -> None:
    """Raise TltlError, TLT0942, if a policy lies in the folder of the training for one of the cases."""
    for case in cases:
        _place(suite, case, folder)


def _place(suite: Suite, case: Case, folder: Path) -> Path:
    """The folder of the training for a case; raises TltlError, TLT0942, if the policy of a case lies there."""
    place = case_folder(suite, case.name, folder / FOLDER)
    for other in suite.cases:
        if policy_file(other.policy).resolve().parent == place.resolve():
            whose = "its training" if other.name == case.name else f"the training for `{case.name}`"
            title = f"the policy of the case `{other.name}` lies in `{place}`, where {whose} goes"
            help_ = "move it beside the suite, and name that place there as `policy`"
            raise TltlError([Diagnostic("TLT0942", title, help=help_)])
    return place


def make_room(suite: Suite, folder: Path) -> Path | None:
    """Make room for another training in a folder.

    A finished training is moved to a new folder beside it, whose path is returned.  The files of an
    unfinished training are removed, and None is returned.  Other files in the folder remain.

    Raises:
        TltlError: TLT0005, a file cannot be removed, or the folder cannot be moved; TLT0865, another
            process trains there.
    """
    names = (RUN, CHECKPOINT, POLICY, CURVE, METRICS, EPISODE, _RESULT)
    with lock_training(folder):
        if not (folder / RECORD).exists():
            for path in (*(folder / name for name in names), *folder.glob("events.out.tfevents.*")):
                fileio.remove_file(path, WRITABLE)
            return None
    # Windows refuses to move the folder before the lock file is closed.
    new_folder = _free_beside(suite, folder)
    try:
        folder.rename(new_folder)
    except OSError as error:
        title = f"cannot move `{folder}` to `{new_folder}`: {fileio.reason(error)}"
        raise TltlError([Diagnostic("TLT0005", title, help=WRITABLE)]) from None
    return new_folder


def _free_beside(suite: Suite, folder: Path) -> Path:
    """The first of ``FOLDER-2``, ``FOLDER-3`` and so on that does not exist and is not reserved for another case."""
    taken = {case_folder(suite, case.name, folder.parent) for case in suite.cases}
    candidates = (folder.with_name(f"{folder.name}-{number}") for number in count(2))
    return next(path for path in candidates if path not in taken and not path.exists())


def retrained(
    suite: Suite, done: Done, run: TrainingRun, pool: Pool, on_episode: Callable[[int, Account], None]
) -> Retrained:
    """Return the result of the finished training in ``run.folder``.

    The retrained policy plays fresh episodes, unless the result is cached.  It stops as soon as it is
    certain whether the pass rate reaches the case's threshold.  After each episode, ``on_episode``
    gets the number of episodes so far and the last account.

    Raises:
        TltlError: the policy's file cannot be read; errors from playing; TLT0005, a file cannot be
            written.
    """
    assert done.ready is not None
    policy, trained = read_policy(run.folder / POLICY), trained_of(run)
    error = suite.error / len(suite.cases)
    # Use another seed: the original policy has already played the episodes of the suite's seed.
    setup = replace(done.ready.setup, policy=policy, seed=(suite.seed + 1) % 2**31)
    ready = replace(done.ready, setup=setup, case=replace(done.ready.case, policy=run.folder))
    inputs = _inputs(ready, weights_hash(policy), trained, error, done.report.accounts)
    if cached := _kept(run.folder, inputs):
        return cached
    accounts, recording, interval = _played(ready, error, pool, on_episode)
    thresholds = ready.case.thresholds
    met = sum(account.summary.success for account in (*accounts, *done.report.accounts))
    outcome = outcome_of(trained, interval[0], thresholds, met)
    overall, best = figures_of(summaries_of(accounts)), _best(accounts, setup.fspa)
    place = f"{FOLDER}/{run.folder.name}"
    result = Retrained(
        outcome=outcome,
        text=sentence(outcome, trained, overall, interval, thresholds, best),
        trained=trained,
        figures=overall,
        rate_interval=interval,
        best=best,
        policy=f"{place}/{POLICY}",
        episode=f"{place}/{EPISODE}" if recording else None,
    )
    files: dict[str, str | bytes] = {EPISODE: recording} if recording else {}
    fileio.write_files(run.folder, {**files, _RESULT: kept_text(inputs, result)}, WRITABLE, over_inputs=True)
    return result


def trained_of(run: TrainingRun) -> FinishedRetraining:
    """Summarize the finished training in ``run.folder``.

    Raises:
        TltlError: the checkpoint cannot be read; TLT0863, the end of the training is not recorded.
    """
    state = read_checkpoint(run.folder / CHECKPOINT, identity(run))
    assert state is not None
    end = recorded_end(run.folder) or state.reason(run.settings.stop)
    if end is None:
        title = f"`{run.folder / RECORD}` does not say how the training ended"
        raise TltlError([Diagnostic("TLT0863", title, help="remove it: the training then goes on to its end")])
    # Successes of the agent count, too: they may be shorter than the search's, or the only ones.
    lengths = [int(length) for process in state.processes for length in process.get("way_lengths", ())]
    return FinishedRetraining(
        end=end,
        steps=state.steps,
        seconds=round(state.seconds, 1),
        searched=state.searched.steps if state.searched else 0,
        complete=state.searched is None or state.searched.complete,
        shortest=min(lengths, default=None),
    )


def _played(
    ready: Ready, error: float, pool: Pool, on_episode: Callable[[int, Account], None]
) -> tuple[list[Account], bytes, tuple[float, float]]:
    """Play episodes until it is certain whether the pass rate reaches the case's threshold.

    Return their accounts, the recording of the first that met the spec (or empty bytes), and the
    confidence interval of the pass rate.
    """
    wanted, accounts, recording, interval = ready.case.thresholds.pass_rate, list[Account](), b"", (0.0, 1.0)
    with closing(episodes(ready, pool)) as playing:
        for episode in playing:
            accounts.append(episode.account)
            on_episode(len(accounts), episode.account)
            recording = recording or (episode.recording if episode.account.summary.success else b"")
            passed = sum(account.summary.success for account in accounts)
            interval = rate_interval(passed, len(accounts) - passed, error)
            if len(accounts) >= LEAST_EPISODES and (interval[0] >= wanted or interval[1] < wanted):
                break
    return accounts, recording, interval


def _best(accounts: Sequence[Account], fspa: Fspa) -> BestFailedEpisode | None:
    failed = [account for account in accounts if not account.summary.success]
    if not failed:
        return None
    farthest = max(failed, key=lambda account: account.summary.progress)
    return BestFailedEpisode(farthest.summary.progress, label_text(fspa, farthest.summary.unmet))


def _inputs(ready: Ready, weights: str, trained: FinishedRetraining, error: float, own: Sequence[Account]) -> str:
    """The hash of everything that the outcome depends on; ``own`` are the episodes by which the case was judged."""
    case = ready.case
    parts = [_VERSION, case.episodes, to_json(case.thresholds), error, to_json(ready.played), weights, to_json(trained)]
    return inputs_hash([*parts, sum(account.summary.success for account in own)])


def _kept(folder: Path, inputs: str) -> Retrained | None:
    """The cached result, if nothing has changed since and its episode's file exists; else None."""
    result = read_kept(Retrained, folder / _RESULT, inputs)
    return result if result and (result.episode is None or (folder / EPISODE).is_file()) else None
