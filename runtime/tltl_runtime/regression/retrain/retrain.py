"""Policies are trained on levels that changed, each from where it was, to see whether these are feasible after all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from itertools import count
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.policies.file import read_policy
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.retrain.retrained import Best, Retrained, Trained, outcome_of, sentence
from tltl_runtime.regression.suite.named_files import policy_file
from tltl_runtime.regression.suite.result_cache import inputs_hash, kept_text, read_kept
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Case, Suite
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.regression.verdict.play import Ready, episodes
from tltl_runtime.regression.verdict.run import WRITABLE, Done, case_folder
from tltl_runtime.support.record_json import to_json
from tltl_runtime.training.run.checkpoint import read_checkpoint
from tltl_runtime.training.run.folder import held
from tltl_runtime.training.run.initial_policy import initial_of, weights_hash
from tltl_runtime.training.run.metrics import METRICS
from tltl_runtime.training.run.record import recorded_end
from tltl_runtime.training.run.run import (
    CHECKPOINT,
    CURVE,
    POLICY,
    RECORD,
    RUN,
    Run,
    identity,
    read_level_hash,
    read_run,
)
from tltl_runtime.training.run.settings import read_settings
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import reason
from tltlc.io.writing import remove_file, write_files

FOLDER: Final = "retrained"
"""Below the folder of a run, with a training for each case."""
EPISODE: Final = "met.episode.npz"
"""In the folder of a training: an episode of the retrained policy that met the spec."""

_RESULT: Final = "retrained.json"
_VERSION: Final = 1


def retraining(suite: Suite, ready: Ready, folder: Path, minutes: float, pool: Pool) -> Run:
    """The training of a case's policy on its level, for so many minutes at the most, below the ``folder`` of a run.

    Raises:
        TltlError: TLT0942, the policy of a case lies where the training goes.
    """
    place, path = _place(suite, ready.case, folder), policy_file(ready.case.policy)
    setup, card, settings = ready.setup, ready.setup.policy.card, read_settings()
    rollout = replace(
        settings.rollout, pool="ray" if pool == "ray" else "processes", workers=0 if pool == "ray" else pool
    )
    return Run(
        folder=place,
        fspa=setup.fspa,
        params=setup.params,
        level=setup.level,
        variant=setup.variant,
        sensors=card.sensors,
        settings=replace(settings, network=card.network, rollout=rollout, stop=replace(settings.stop, minutes=minutes)),
        seed=suite.seed,
        initial=initial_of(path, setup.policy),
    )


def is_kept(run: Run) -> bool:
    """Whether the folder has this very training, be it over or not: the same level, spec, policy, seed and settings.

    Raises:
        TltlError: what is wrong with the level, which nothing in the folder is to be blamed for.
    """
    wanted = identity(run)
    try:
        # Its level may be named otherwise there; what was in it then counts.
        there = replace(read_run(run.folder), level=run.level, variant=run.variant)
        if {**identity(there), "level": read_level_hash(run.folder)} != wanted:
            return False
        checkpoint = read_checkpoint(run.folder / CHECKPOINT, wanted)
    except TltlError:
        # It is damaged, or of another version.
        return False
    # A search that was not over has none yet, and begins anew.
    over = (run.folder / RECORD).exists()
    return not over or (checkpoint is not None and (run.folder / POLICY).exists())


def check_places(suite: Suite, cases: Sequence[Case], folder: Path) -> None:
    """Raise TltlError, TLT0942, where a policy lies in the place of a training for one of the cases."""
    for case in cases:
        _place(suite, case, folder)


def _place(suite: Suite, case: Case, folder: Path) -> Path:
    """Where the training for a case goes; raises TltlError, TLT0942, where the policy of a case lies there."""
    place = case_folder(suite, case.name, folder / FOLDER)
    for other in suite.cases:
        if policy_file(other.policy).resolve().parent == place.resolve():
            whose = "its training" if other.name == case.name else f"the training for `{case.name}`"
            title = f"the policy of the case `{other.name}` lies in `{place}`, where {whose} goes"
            help_ = "move it beside the suite, and name that place there as `policy`"
            raise TltlError([Diagnostic("TLT0942", title, help=help_)])
    return place


def make_room(suite: Suite, folder: Path) -> Path | None:
    """Make room for another training in a folder: where the one that is there was moved to, None where it is removed.

    One that is over is moved as a whole, beside itself; of another nothing is left, but for files that are not its own.

    Raises:
        TltlError: TLT0005, a file cannot be removed, or the folder not be moved; TLT0865, another process trains there.
    """
    names = (RUN, CHECKPOINT, POLICY, CURVE, METRICS, EPISODE, _RESULT)
    with held(folder):
        if not (folder / RECORD).exists():
            for path in (*(folder / name for name in names), *folder.glob("events.out.tfevents.*")):
                remove_file(path, WRITABLE)
            return None
    # Not before the lock's file is closed: Windows would refuse.
    aside = _free_beside(suite, folder)
    try:
        folder.rename(aside)
    except OSError as error:
        title = f"cannot move `{folder}` to `{aside}`: {reason(error)}"
        raise TltlError([Diagnostic("TLT0005", title, help=WRITABLE)]) from None
    return aside


def _free_beside(suite: Suite, folder: Path) -> Path:
    """The first of ``FOLDER-2``, ``FOLDER-3`` and so on that is not there, and where no training of the suite goes."""
    taken = {case_folder(suite, case.name, folder.parent) for case in suite.cases}
    beside = (folder.with_name(f"{folder.name}-{number}") for number in count(2))
    return next(path for path in beside if path not in taken and not path.exists())


def retrained(suite: Suite, done: Done, run: Run, pool: Pool, told: Callable[[int, Account], None]) -> Retrained:
    """What the training in ``run.folder`` came to, which is over: its policy plays fresh episodes, or has done so.

    They end as soon as it is certain whether the pass rate is that of the case's thresholds; ``told`` gets the number
    of episodes so far and the last one.

    Raises:
        TltlError: what is wrong with the policy's file; what playing raises; TLT0005.
    """
    assert done.ready is not None
    policy, trained = read_policy(run.folder / POLICY), trained_of(run)
    error = suite.error / len(suite.cases)
    # Episodes of another seed: those of the suite's were played by the policy that this one comes of.
    setup = replace(done.ready.setup, policy=policy, seed=(suite.seed + 1) % 2**31)
    ready = replace(done.ready, setup=setup, case=replace(done.ready.case, policy=run.folder))
    inputs = _inputs(ready, weights_hash(policy), trained, error, done.report.accounts)
    if kept := _kept(run.folder, inputs):
        return kept
    accounts, recording, interval = _played(ready, error, pool, told)
    thresholds = ready.case.thresholds
    met = sum(each.success for each in (*accounts, *done.report.accounts))
    outcome = outcome_of(trained, interval[0], thresholds, met)
    of_all, best = figures_of(accounts), _best(accounts, setup.fspa)
    place = f"{FOLDER}/{run.folder.name}"
    found = Retrained(
        outcome=outcome,
        text=sentence(outcome, trained, of_all, interval, thresholds, best),
        trained=trained,
        figures=of_all,
        rate_interval=interval,
        best=best,
        policy=f"{place}/{POLICY}",
        episode=f"{place}/{EPISODE}" if recording else None,
    )
    files: dict[str, str | bytes] = {EPISODE: recording} if recording else {}
    write_files(run.folder, {**files, _RESULT: kept_text(inputs, found)}, WRITABLE, over_inputs=True)
    return found


def trained_of(run: Run) -> Trained:
    """How the training in ``run.folder`` went, which is over; raises TltlError for its checkpoint."""
    state = read_checkpoint(run.folder / CHECKPOINT, identity(run))
    assert state is not None
    end = recorded_end(run.folder) or state.reason(run.settings.stop)
    if end is None:
        title = f"`{run.folder / RECORD}` does not say how the training ended"
        raise TltlError([Diagnostic("TLT0863", title, help="remove it: the training then goes on to its end")])
    # The agent's own successes are ways, too, be they shorter or the first.
    lengths = [int(each) for process in state.processes for each in process.get("way_lengths", ())]
    return Trained(
        end=end,
        steps=state.steps,
        seconds=round(state.seconds, 1),
        searched=state.searched.steps if state.searched else 0,
        complete=state.searched is None or state.searched.complete,
        shortest=min(lengths, default=None),
    )


def _played(
    ready: Ready, error: float, pool: Pool, told: Callable[[int, Account], None]
) -> tuple[list[Account], bytes, tuple[float, float]]:
    """Episodes until it is certain whether the pass rate is the one asked for, a recording of one that met the spec,
    and the interval of the rate.
    """
    wanted, accounts, recording, interval = ready.case.thresholds.pass_rate, list[Account](), b"", (0.0, 1.0)
    with closing(episodes(ready, pool)) as playing:
        for each in playing:
            accounts.append(each.account)
            told(len(accounts), each.account)
            recording = recording or (each.recording if each.account.success else b"")
            passed = sum(account.success for account in accounts)
            interval = rate_interval(passed, len(accounts) - passed, error)
            if len(accounts) >= LEAST_EPISODES and (interval[0] >= wanted or interval[1] < wanted):
                break
    return accounts, recording, interval


def _best(accounts: Sequence[Account], fspa: Fspa) -> Best | None:
    failed = [each for each in accounts if not each.success]
    if not failed:
        return None
    farthest = max(failed, key=lambda each: each.progress)
    return Best(farthest.progress, fspa.states[farthest.unmet].label.english)


def _inputs(ready: Ready, weights: str, trained: Trained, error: float, own: Sequence[Account]) -> str:
    """The identity of all that the outcome depends on; ``own`` are the episodes by which the case was judged."""
    case = ready.case
    parts = [_VERSION, case.episodes, to_json(case.thresholds), error, to_json(ready.played), weights, to_json(trained)]
    return inputs_hash([*parts, sum(each.success for each in own)])


def _kept(folder: Path, inputs: str) -> Retrained | None:
    """What an earlier run has found, if nothing has changed since, nor its episode been removed."""
    found = read_kept(Retrained, folder / _RESULT, inputs)
    return found if found and (found.episode is None or (folder / EPISODE).is_file()) else None
