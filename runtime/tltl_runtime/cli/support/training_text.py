"""A training in words, a line each."""

from __future__ import annotations

from typing import Final

from tltl_runtime.support.number_text import duration, number, share
from tltl_runtime.training.exploration.search import Exploration, Searched
from tltl_runtime.training.imitation.demonstrations import Tried
from tltl_runtime.training.imitation.imitation_data import Imitated
from tltl_runtime.training.run.report import Confirmation, Report
from tltl_runtime.training.run.settings import Stop

SEARCH_IS_LOST: Final = "Ctrl-C stops it; a search that is not over then begins anew."
SEARCHED_AGAIN: Final = "the pass rate rises no more: ways are searched by chance from where episodes failed"


def line(report: Report, stop: Stop) -> str:
    """A report in a line."""
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
    if report.iteration.steps:
        parts.append(f"{rate(report):,.0f} steps/s")
    if not report.stop:
        parts.append(f"at most {duration(seconds_left(report, stop))} left")
    return ", ".join(parts)


def recording_line(tried: Tried, wanted: int) -> str:
    """How far the recording of the expert's demonstrations is, in a line."""
    seed, fate = tried.episode.seed, "is kept" if tried.path else "fails, and is not kept"
    return f"recording the expert: {tried.kept} of {wanted} demonstrations, the episode of seed {seed} {fate}"


def imitated_line(imitated: Imitated) -> str:
    """What is imitated, in a line."""
    many = f"{imitated.episodes} demonstration{'s' * (imitated.episodes != 1)}"
    said = f"imitating {many} of {imitated.decisions:,} decisions, by {' and '.join(imitated.players)}"
    left = len(imitated.left_out)
    return f"{said}; {left} recording{'s' * (left > 1)} left out: {imitated.left_out[0]}" if left else said


def search_line(searched: Searched) -> str:
    """How far the search is, in a line."""
    if found := len(searched.lengths):
        ways = f"{found} way{'s' * (found > 1)} to meet the spec, the shortest of {min(searched.lengths)} steps"
    else:
        ways = "no way to meet the spec yet"
    took = f"{searched.steps:,} steps in {duration(searched.seconds)}"
    return f"searching: {took}, {searched.places:,} places, {ways}"


def search_end(exploration: Exploration) -> str:
    """When a search ends, in a sentence."""
    ways = f"{exploration.ways} way{'s' * (exploration.ways != 1)}"
    return f"The search ends when {ways} are found, at the latest after {exploration.steps:,} steps."


def found_line(searched: Searched) -> str:
    """What the search found, in a line of 72 characters at the most."""
    took, found = duration(searched.seconds), len(searched.lengths)
    if not found:
        return f"search: no way found in {took}; episodes begin at the level's start"
    return f"search: {found} way{'s' * (found > 1)} found in {took}, the shortest of {min(searched.lengths)} steps"


def confirmation_line(number: int, confirmation: Confirmation) -> str:
    """What a confirmation after iteration ``number`` came to, in a line of 72 characters at the most."""
    if confirmation.passed:
        return f"confirmed: the policy met it in {confirmation.of} fresh episodes, too"
    return f"not confirmed after iteration {number}: fresh episode {confirmation.met + 1} of {confirmation.of} failed"


def seconds_left(report: Report, stop: Stop) -> float:
    """Seconds until a limit ends the training, at the speed that it had after the search."""
    trained_s = max(0.0, report.seconds - (report.searched.seconds if report.searched else 0.0))
    left = max(0.0, (stop.steps - report.steps) * trained_s / max(report.steps, 1))
    return min(left, max(0.0, stop.minutes * 60 - report.seconds)) if stop.minutes else left


def minutes(number: float) -> str:
    """A limit of minutes."""
    return f"{number:g} minute{'s' * (number != 1)}"


def rate(report: Report) -> float:
    """Steps a second of the last iteration; 0 where a training that is over had none."""
    return report.iteration.steps / ((report.iteration.collect_s + report.iteration.learn_s) or 1.0)
