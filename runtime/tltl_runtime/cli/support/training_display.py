"""The progress display of ``tltlc train``: a live picture on a terminal, lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final, Protocol

from rich.console import Console
from rich.live import Live

from tltl_runtime.cli.support.training_picture import TrainingDisplay
from tltl_runtime.cli.support.training_text import (
    SEARCHED_AGAIN,
    WAYS_ARE_KEPT,
    demonstrations_line,
    dropped_line,
    environments_line,
    made_line,
    measuring_line,
    plan_line,
    recording_line,
    report_line,
    search_advice,
    search_end,
    search_line,
    search_result_line,
)
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.exploration.search_plan import SearchPlan
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import CHECKPOINT, TrainingRun
from tltl_runtime.training.imitation.demonstrations import Attempt
from tltl_runtime.training.ppo.distributed import process_group

_SECONDS_BETWEEN_LINES: Final = 10.0


class Display(Protocol):
    """Shows the progress of a training."""

    def show_measuring(self, *, searches: bool) -> None:
        """Show that the game is started and tried; for a search, this takes longer."""

    def show_start(self) -> None:
        """Show that the environments are started."""

    def show_made(self, count: int) -> None:
        """Show how many environments have started."""

    def show_plan(self, plan: SearchPlan) -> None:
        """Show how the game is searched for ways to meet the spec, or why it is not."""

    def show_search(self, progress: SearchProgress) -> None:
        """Show the progress of the search for ways to meet the spec, which precedes the training."""

    def show_attempt(self, attempt: Attempt) -> None:
        """Show the progress of recording the demonstrations that precede the training."""

    def show_report(self, report: TrainingReport) -> None:
        """Show a report of the training."""


@contextmanager
def display(run: TrainingRun, again: str) -> Iterator[Display]:
    """Return a context manager for a display that writes the training's progress to standard error.

    ``again`` is the command that resumes the training. If torchrun started several processes, only
    the first one writes.
    """
    if process_group().rank > 0:
        yield _NoDisplay()
        return
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal or console.is_dumb_terminal:
        yield _LineDisplay(run, again)
        return
    picture = TrainingDisplay(run, console)
    with Live(get_renderable=picture.picture, console=console, refresh_per_second=2) as live:
        live.refresh()
        yield picture


class _NoDisplay:
    def show_measuring(self, *, searches: bool) -> None:
        pass

    def show_start(self) -> None:
        pass

    def show_made(self, count: int) -> None:
        pass

    def show_plan(self, plan: SearchPlan) -> None:
        pass

    def show_search(self, progress: SearchProgress) -> None:
        pass

    def show_attempt(self, attempt: Attempt) -> None:
        pass

    def show_report(self, report: TrainingReport) -> None:
        pass


class _LineDisplay:
    """Prints a line at the first report, then every ten seconds, and at the last report."""

    def __init__(self, run: TrainingRun, again: str) -> None:
        self._run, self._again = run, again
        self._next = 0.0
        self._has_searched = self._has_trained = False

    def show_measuring(self, *, searches: bool) -> None:
        print(measuring_line(searches=searches), file=sys.stderr, flush=True)

    def show_start(self) -> None:
        print(environments_line(self._run.settings), file=sys.stderr, flush=True)
        self._next = time.monotonic() + _SECONDS_BETWEEN_LINES

    def show_made(self, count: int) -> None:
        self._print(made_line(count, self._run.settings))

    def show_plan(self, plan: SearchPlan) -> None:
        if text := plan_line(plan):
            print(text, file=sys.stderr, flush=True)

    def show_search(self, progress: SearchProgress) -> None:
        if not self._has_searched and self._has_trained:
            self._print(SEARCHED_AGAIN, always=True)
        elif not self._has_searched:
            begins = self._run.initial and not (self._run.folder / CHECKPOINT).exists()
            method = "the policy, then with random actions" if begins else "random actions"
            end = search_end(self._run.settings.exploration)
            self._print(f"searching first for ways to meet the spec, with {method}. {end}", always=True)
            self._print(WAYS_ARE_KEPT, always=True)
            self._next = 0.0
        self._has_searched = True
        line = search_line(progress, self._run.settings, self._run.fspa)
        self._print(line, always=self._has_trained and progress.complete)

    def show_attempt(self, attempt: Attempt) -> None:
        requested = self._run.settings.imitation.demonstrations
        self._print(recording_line(attempt, requested), always=attempt.path is None or attempt.kept == requested)

    def show_report(self, report: TrainingReport) -> None:
        first, self._has_trained, self._has_searched = not self._has_trained, True, False
        if first and report.imitated:
            self._print(demonstrations_line(report.imitated), always=True)
        if first and report.searched:
            self._print(search_result_line(report.searched), always=True)
            if advice := search_advice(report.plan, report.searched):
                self._print(advice, always=True)
            if dropped := dropped_line(report.searched):
                self._print(dropped, always=True)
        if first:
            self._print(f"Ctrl-C stops it and keeps what was learned; to go on: {self._again}", always=True)
        self._print(report_line(report, self._run.settings.stop), always=first or report.stop is not None)

    def _print(self, text: str, *, always: bool = False) -> None:
        now = time.monotonic()
        if now >= self._next or always:
            self._next = now + _SECONDS_BETWEEN_LINES
            print(text, file=sys.stderr, flush=True)
