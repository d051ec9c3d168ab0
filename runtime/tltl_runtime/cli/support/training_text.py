"""Lines that describe a training."""

from __future__ import annotations

from typing import Final

from tltl_runtime.support.number_text import duration, number, share
from tltl_runtime.training.exploration.search import SearchProgress, SearchSettings
from tltl_runtime.training.exploration.search_plan import MEASURED_STEPS, SearchPlan, obstacle_text
from tltl_runtime.training.files.report import Confirmation, TrainingReport
from tltl_runtime.training.files.settings import Stop, TrainingSettings
from tltl_runtime.training.imitation.demonstrations import Attempt, ImitationSummary
from tltlc.api import Fspa, label_text

WAYS_ARE_KEPT: Final = "Ctrl-C stops it and keeps the ways found; when you continue, it looks for the others."
SEARCHED_AGAIN: Final = "the pass rate no longer rises: a random search for ways starts from where episodes failed"


def report_line(report: TrainingReport, stop: Stop) -> str:
    """Describe the progress that a training reports after an iteration, in one line."""
    window = report.window
    parts = [f"iteration {report.iteration.number}: {report.steps:,} steps in {duration(report.seconds)}"]
    if window.count:
        parts += [
            f"met in {window.successes} of the last {window.count} episodes",
            f"progress {share(window.progress)}",
            f"reward {number(window.reward, 2)}",
        ]
    if report.confirmation:
        parts.append(confirmation_line(report.iteration.number, report.confirmation))
    if report.lost:
        parts.append(f"{report.lost.count:,} lost")
    if report.iteration.steps:
        parts.append(f"{rate(report):,.0f} steps/s")
    if not report.stop:
        parts.append(f"at most {duration(seconds_left(report, stop))} left")
    return ", ".join(parts)


def limits_line(stop: Stop) -> str:
    """Say in one line when a training ends at the latest."""
    limit = f"after {stop.steps:,} steps"
    if stop.minutes:
        limit += f" or {minutes(stop.minutes)}, whichever comes first"
    return f"it ends when the spec is met, at the latest {limit}"


def measuring_line(*, searches: bool) -> str:
    """Say in one line that the game is started and tried, which comes before everything else."""
    tries = "starting the game once, to see what it observes and does"
    return f"{tries}, and playing it twice for {MEASURED_STEPS} steps, to see whether it repeats" if searches else tries


def environments_line(settings: TrainingSettings) -> str:
    """Say in one line that the environments of a training are started."""
    envs, workers = settings.rollout.envs, settings.rollout.workers
    games = "1 environment" if envs == 1 else f"{envs:,} environments"
    from tltl_runtime.training.ppo.distributed import cores  # it imports torch, which takes seconds

    if settings.rollout.pool == "ray":
        return f"starting {games} in a Ray cluster"
    count = min(workers or cores(), envs)
    return f"starting {games} in {count} process{'es' * (count != 1)}"


def made_line(count: int, settings: TrainingSettings) -> str:
    """Say in one line how many environments of a training have started."""
    return f"{count:,} of {settings.rollout.envs:,} environments started"


def recording_line(attempt: Attempt, requested: int) -> str:
    """Say in one line whether the expert's last episode is kept, and how many demonstrations there are."""
    seed, fate = attempt.episode.seed, "is kept" if attempt.path else "fails and is not kept"
    return f"recording the expert: {attempt.kept} of {requested} demonstrations, the episode of seed {seed} {fate}"


def demonstrations_line(summary: ImitationSummary) -> str:
    """Describe in one line the demonstrations that an agent imitates."""
    count = f"{summary.episodes} demonstration{'s' * (summary.episodes != 1)}"
    text = f"imitating {count} of {summary.decisions:,} decisions, by {' and '.join(summary.players)}"
    left = len(summary.left_out)
    return f"{text}; {left} recording{'s' * (left > 1)} left out: {summary.left_out[0]}" if left else text


def plan_line(plan: SearchPlan) -> str | None:
    """Say in one line how a training searches a game, or why it does not.

    None if there is nothing to say: the game is searched, and names its cells itself.
    """
    if plan.obstacle is not None:
        return f"trains from the start alone, without a search: {obstacle_text(plan.obstacle)}"
    if plan.cells == "own":
        return None
    method = "restoring the game's snapshots" if plan.snapshots else "replaying actions: the game gives no snapshots"
    if plan.grid is not None and plan.grid.side is not None:
        places = f"places are squares of {plan.grid.side:.3g} in which the player stands"
    else:
        places = "places are values of signals, because the game gives no positions"
    return f"searches by {method}; {places}"


def no_search_line(plan: SearchPlan | None) -> str:
    """Say in one line, at the end of a training, why it began without a search."""
    reason = "" if plan is None or plan.obstacle is None else f", because {obstacle_text(plan.obstacle)}"
    return f"it began without a search for demonstrations{reason}: see docs/games.md"


def search_line(progress: SearchProgress, settings: TrainingSettings, fspa: Fspa) -> str:
    """Describe in one line the progress of the search for ways to meet the spec, and how long it may still take.

    Without a way, the line says what remained at best, by the automaton ``fspa``.
    """
    exploration, limit = settings.exploration, settings.stop.minutes
    if count := len(progress.lengths):
        ways = f"{count} of {exploration.ways} ways to meet the spec, the shortest of {min(progress.lengths)} steps"
    else:
        ways = "no way to meet the spec yet"
        if progress.state is not None:
            ways += f"; at best this remained: {label_text(fspa, progress.state, 'english').removesuffix('.')}"
    spent = f"{progress.steps:,} steps in {duration(progress.seconds)}"
    left = ""
    if progress.steps and not progress.complete:
        left_s = progress.seconds / progress.steps * (exploration.steps - progress.steps)
        left_s = min(left_s, limit * 60 - progress.seconds) if limit else left_s
        left = f", at most {duration(left_s)} left" if left_s > 0 else ""
    places = f"{progress.places:,} place{'s' * (progress.places != 1)}"
    episodes = "1 episode was" if progress.lost == 1 else f"{progress.lost:,} episodes were"
    lost = f"; {episodes} lost: {progress.loss}" if progress.lost else ""
    return f"searching: {spent}, {places}, {ways}{left}{lost}"


def kept_ways_text(count: int) -> str:
    """Say in a clause how many ways a search that was stopped has found and kept."""
    return f"with the {count} ways that it has found" if count > 1 else "with the way that it has found"


def search_end(exploration: SearchSettings) -> str:
    """Say in a sentence when the search for ways to meet the spec ends."""
    demonstrations = "1 way is" if exploration.ways == 1 else f"{exploration.ways} ways are"
    return f"The search ends when {demonstrations} found, at the latest after {exploration.steps:,} steps."


def search_result_line(progress: SearchProgress) -> str:
    """Describe the result of the search before a training in one line of at most 72 characters."""
    spent, count = duration(progress.seconds), len(progress.lengths)
    if not count:
        return f"search: no way found in {spent}; episodes begin at the level's start"
    return f"search: {count} way{'s' * (count > 1)} found in {spent}, the shortest of {min(progress.lengths)} steps"


def search_advice(plan: SearchPlan | None, progress: SearchProgress) -> str | None:
    """Say in one line how to help a search that has found no way.

    None if it has found one, or if the game names its places itself.
    """
    if progress.lengths or plan is None or plan.cells == "own":
        return None
    places = "where the player stands" if plan.cells == "positions" else "values of signals"
    advice = "if the way needs more, such as a key, name it with `then` in the spec, or in the `cell` of the game"
    return f"its places were {places}, and the state of the spec: {advice} (docs/games.md)"


def dropped_line(progress: SearchProgress) -> str | None:
    """Say, in at most 72 characters, how many places the search has left out; None if it left out none."""
    count = progress.dropped
    if not count:
        return None
    return f"the search left out {count:,} place{'s' * (count > 1)}: the game did not lead there again"


def confirmation_line(number: int, confirmation: Confirmation) -> str:
    """Say, in at most 72 characters, whether a policy met the spec in fresh episodes, too.

    These episodes confirm the policy after iteration ``number`` of its training.
    """
    if confirmation.passed:
        return f"confirmed: the policy met it in {confirmation.of} fresh episodes, too"
    return f"not confirmed after iteration {number}: fresh episode {confirmation.met + 1} of {confirmation.of} failed"


def seconds_left(report: TrainingReport, stop: Stop) -> float:
    """Estimate the seconds until a limit ends the training.

    The estimate uses the mean speed so far. The time before the first iteration does not count, in
    which the games started and ways to meet the spec were searched.
    """
    trained_s = max(0.0, report.seconds - report.setup_s - (report.searched.seconds if report.searched else 0.0))
    left = max(0.0, (stop.steps - report.steps) * trained_s / max(report.steps, 1))
    return min(left, max(0.0, stop.minutes * 60 - report.seconds)) if stop.minutes else left


def minutes(number: float) -> str:
    """Return a number of minutes as text, for example ``1 minute``."""
    return f"{number:g} minute{'s' * (number != 1)}"


def rate(report: TrainingReport) -> float:
    """Return the steps per second of the last iteration; 0 if a finished training had no iteration."""
    return report.iteration.steps / ((report.iteration.collect_s + report.iteration.learn_s) or 1.0)
