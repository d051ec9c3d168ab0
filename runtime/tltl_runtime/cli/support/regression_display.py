"""Show on standard error how many episodes of a case are finished: a bar on a terminal, lines elsewhere."""

from __future__ import annotations

import sys
from typing import Any, Final

import click

from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.suite.suite import Case
from tltl_runtime.regression.suite.trace_case import TraceCase

_EPISODES_BETWEEN_LINES: Final = 25
"""The number of episodes between two lines."""


class RegressionDisplay:
    """Shows how many episodes of a case were played, and how many of them met the spec.

    Call the display, like a function, after each episode. As a context manager, it removes the bar
    at the end. The text ``most``, such as ``at most``, is printed before the number of episodes of the
    case: ``25 of at most 100 episodes``.
    """

    def __init__(self, most: str = "") -> None:
        self._most = f"{most} " if most else ""
        self._met = 0
        self._bar: Any = None
        self._name = ""

    def __call__(self, case: Case, count: int, last: ExplainedEpisode) -> None:
        """Show that ``count`` episodes of a case are finished; ``last`` is the last one."""
        self._met = last.summary.success + (self._met if count > 1 else 0)
        if sys.stderr.isatty():
            self._update(case.name, count, case.episodes, f"{self._met} of {count} met")
        elif count % _EPISODES_BETWEEN_LINES == 0 or count == case.episodes:
            text = f"{count} of {self._most}{case.episodes} episodes, {self._met} met the spec"
            click.echo(f"{plain_text(case.name)}: {text}", err=True)

    def show_traces(self, case: TraceCase, count: int, total: int) -> None:
        """Show that ``count`` of all ``total`` recorded traces of a case are judged."""
        if sys.stderr.isatty():
            self._update(case.name, count, total, f"{count} of {total} traces")
        elif count == total:
            click.echo(f"{plain_text(case.name)}: {total} traces are judged", err=True)

    def show_verdict(self, name: str, verdict: str) -> None:
        """Show the verdict on a case that is finished. The report, which comes later, has the reasons."""
        self.clear()
        click.echo(f"{plain_text(name)}: {verdict}", err=True)

    def show_films(self, name: str, count: int, total: int) -> None:
        """Show that ``count`` of all ``total`` films of a case are drawn for the page."""
        if sys.stderr.isatty():
            if not count:
                self.clear()
            self._update(name, count, total, f"drawing films for the page, {count} of {total}")
        elif not count:
            films = "1 film" if total == 1 else f"{total} films"
            click.echo(f"{plain_text(name)}: drawing {films} for the page", err=True)

    def clear(self) -> None:
        """Remove the bar, so that other lines can be printed."""
        if self._bar is not None:
            self._bar.stop()
            self._bar = None

    def _update(self, name: str, count: int, total: int, text: str) -> None:
        if self._bar is None:
            from rich.console import Console
            from rich.markup import escape
            from rich.progress import Progress

            self._bar = Progress(console=Console(stderr=True), transient=True)
            self._name = escape(plain_text(name))
            self._bar.add_task(self._name, total=total)
            self._bar.start()
        self._bar.update(self._bar.task_ids[0], completed=count, description=f"{self._name}: {text}")

    def __enter__(self) -> RegressionDisplay:
        return self

    def __exit__(self, *_: object) -> None:
        self.clear()
