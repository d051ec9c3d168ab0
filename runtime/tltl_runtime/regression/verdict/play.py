"""The cases of a suite are played: against their baseline until the verdict is certain, or to record it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Generator
from contextlib import closing
from functools import partial
from shlex import join
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool, results, set_up
from tltl_runtime.evaluation.player import Setup, Task
from tltl_runtime.policies.file import MAX_BYTES, from_bytes
from tltl_runtime.policies.fit import differences
from tltl_runtime.policies.identity import level_hash, spec_hash
from tltl_runtime.regression.explain.account import Account, account
from tltl_runtime.regression.suite.named_files import policy_file
from tltl_runtime.regression.suite.suite import Case
from tltl_runtime.regression.verdict.baseline import Identity, Reference
from tltl_runtime.regression.verdict.verdict import Judgement, judge
from tltl_runtime.spec.task import read_spec
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.levels.file import level_and_changes, load_level
from tltl_runtime.stealth.recordings.file import from_bytes as episode_from_bytes
from tltl_runtime.training.run.versions import versions
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import read_bytes
from tltlc.io.spec_file import split

Told = Callable[[Case, int, Account], None]
"""Is told of a case the number of episodes so far, and the last one."""

_PLAYER: Final = "policy"


@record
class Ready:
    """A case that can be played: the evaluation, and what is recorded of what it depends on.

    ``changes`` are what the overlays of its variant say that they change in the ``level``.  ``outdated`` says that the
    spec that the level is made for has changed since the policy was trained, which is judged by the old one.
    """

    case: Case
    setup: Setup
    played: Identity
    level: Level
    changes: tuple[str, ...] = ()
    outdated: str | None = None


@record
class Recorded:
    """An episode that was played: its account, and the bytes of its recording."""

    account: Account
    recording: bytes


@record
class Result:
    """A case that was judged by the episodes that were played, in their order."""

    ready: Ready
    reference: Reference
    judgement: Judgement
    episodes: tuple[Recorded, ...]


def ready(case: Case, seed: int, variant: str | None = None) -> Ready:
    """A case made ready to play, by default in its own variant; raises TltlError for all that does not fit."""
    path = policy_file(case.policy)
    data = read_bytes(path, str(path), MAX_BYTES)
    policy = from_bytes(data, str(path))
    setup = set_up(policy, case.level, variant or case.variant, case.spec, seed, "all")
    level, changes = level_and_changes(setup.level, setup.variant)
    sha256 = hashlib.sha256(data).hexdigest()
    played = Identity(
        level=level.name,
        variant=level.variant,
        spec=setup.fspa.name,
        policy=sha256,
        seed=seed,
        level_hash=level_hash(level),
        spec_hash=spec_hash(setup.fspa),
        files=level.files,
        versions=versions(),
        place=case.place,
    )
    return Ready(case, setup, played, level, changes, _outdated(case, setup, level))


def episodes(made: Ready, pool: Pool) -> Generator[Recorded]:
    """The case's episodes as they are played; closing the iterator ends the workers.

    Raises:
        TltlError: TLT0905, the level is not the one that was made ready, or not any more when all are over; what
            playing raises.
    """
    tasks = [Task(index) for index in range(made.case.episodes)]
    with closing(results(made.setup, tasks, pool, alone=partial(_alone, made))) as playing:
        for count, each in enumerate(playing):
            # Before an error come all results that are there: a gap among them would leave out the slow episodes.
            if each.played.index != count:
                continue
            episode = episode_from_bytes(each.recording, _PLAYER)
            # Each worker has loaded the level for itself.
            _check_unedited(made, episode.level)
            yield Recorded(account(each.played, episode), each.recording)
    check_unedited(made)


def _alone(made: Ready, task: Task) -> str:
    """The command that plays one of the case's episodes."""
    place = ["--level", f"{made.setup.level}:{made.setup.variant}"]
    spec = [] if made.case.spec is None else ["--spec", made.case.spec]
    episode = ["--seed", str(made.setup.seed), "--first", str(task.index), "--episodes", "1"]
    return join(["tltlc", "evaluate", str(made.case.policy), *place, *spec, *episode])


def check_unedited(made: Ready) -> None:
    """Raise TltlError, TLT0905, where the level was edited since it was made ready, which workers that had loaded it do
    not see; and what is wrong with it now.
    """
    _check_unedited(made, load_level(made.setup.level, made.setup.variant))


def judged(made: Ready, reference: Reference, error: float, pool: Pool, told: Callable[[int, Account], None]) -> Result:
    """Play a case until its verdict is certain; ``told`` gets the number of episodes so far and the last one."""
    found: list[Recorded] = []
    with closing(episodes(made, pool)) as playing:
        for each in playing:
            found.append(each)
            told(len(found), each.account)
            now = [recorded.account for recorded in found]
            judgement = judge(now, reference.accounts, made.case.episodes, made.case.thresholds, error)
            if judgement:
                check_unedited(made)
                return Result(made, reference, judgement, tuple(found))
    raise AssertionError("the last episode settles every verdict")


def _check_unedited(made: Ready, level: Level) -> None:
    before, now = made.level.files, level.files
    if before != now:
        # Overlays of one name may come from several folders.
        names = dict.fromkeys(f"`{each[0]}`" for each in (*before, *now) if (each in before) != (each in now))
        title = f"{', '.join(names)} changed while `{made.case.name}` was played"
        raise TltlError([Diagnostic("TLT0905", title, help="give the same command again")])


def _outdated(case: Case, setup: Setup, level: Level) -> str | None:
    """That the level's spec has changed, where the policy's own of that name judges.

    Raises TltlError for what is wrong with the level's spec.
    """
    name = split(level.spec)[1]
    if case.spec is not None or name != setup.fspa.name:
        return None
    now = read_spec(level.spec)[0]
    if spec_hash(now) == spec_hash(setup.fspa):
        return None
    how = f"({differences(setup.fspa, now)})"
    help_ = "train it again, or name the new one as the case's `spec`"
    return f"the spec `{name}` has changed since the policy was trained {how}, and its old one judges: {help_}"
