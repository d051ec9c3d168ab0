"""What ``tltlc train`` shows while it trains: on a terminal a picture that is kept up to date, elsewhere lines."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, Protocol

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.panel import Panel
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from tltl_runtime.training.distributed import peers
from tltl_runtime.training.report import Report, Window
from tltl_runtime.training.run import CHECKPOINT, Run
from tltl_runtime.training.search import Searched
from tltl_runtime.training.settings import Stop
from tltlc.automaton.fspa import State

_SECONDS_BETWEEN_LINES: Final = 10.0
_WIDTH: Final = 100
"""Of the picture in characters, where there is so much room."""

_MOST_STATES: Final = 8
_BAR: Final = 24
"""Width of a bar in characters."""


class Display(Protocol):
    """What shows a training."""

    def searched(self, searched: Searched) -> None:
        """Show how far the search is that comes first."""

    def trained(self, report: Report) -> None:
        """Show how far the training is."""


@contextmanager
def display(run: Run) -> Iterator[Display]:
    """Within, all that is given to what this yields is shown on standard error.

    Of the processes that torchrun started, the first one speaks.
    """
    if peers().rank > 0:
        yield _Nothing()
        return
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal or console.is_dumb_terminal:
        yield _Lines(run)
        return
    picture = _Picture(run, console)
    with Live(get_renderable=picture.drawn, console=console, refresh_per_second=2) as live:
        live.refresh()
        yield picture


class _Nothing:
    def searched(self, searched: Searched) -> None:
        pass

    def trained(self, report: Report) -> None:
        pass


class _Lines:
    """A line at the first report, then every ten seconds, and at the last."""

    def __init__(self, run: Run) -> None:
        self._run = run
        self._next = 0.0
        self._searched: Searched | None = None

    def searched(self, searched: Searched) -> None:
        self._searched = searched
        self._print(search_line(searched))

    def trained(self, report: Report) -> None:
        if self._searched:
            self._print(search_line(self._searched), always=True)
            self._searched, self._next = None, 0.0
        self._print(line(report, self._run.settings.stop), always=report.stop is not None)

    def _print(self, text: str, *, always: bool = False) -> None:
        now = time.monotonic()
        if now >= self._next or always:
            self._next = now + _SECONDS_BETWEEN_LINES
            print(text, file=sys.stderr, flush=True)


class _Picture:
    """The last report as a picture; its clock goes on between reports."""

    def __init__(self, run: Run, console: Console) -> None:
        self._run, self._console = run, console
        self._last: Report | None = None
        self._searched: Searched | None = None
        self._in_a_row = 0
        self._at = time.monotonic()
        self._checkpoint: float | None = None
        self._resumed = (run.folder / CHECKPOINT).exists()

    def searched(self, searched: Searched) -> None:
        self._searched = searched

    def trained(self, report: Report) -> None:
        self._last, self._at = report, time.monotonic()
        self._in_a_row = in_a_row(report, self._in_a_row)
        if report.checkpointed:
            self._checkpoint = self._at

    def drawn(self) -> RenderableType:
        """The picture now."""
        now = time.monotonic()
        run = self._run
        title = Text(f"{run.fspa.name} on {Path(run.level).stem} {run.variant}, seed {run.seed}", "bold")
        report = self._last
        if report is None:
            body: RenderableType = self._before()
        else:
            count, stop = report.window.count, run.settings.stop
            ended = f"where the last {count} episodes ended" if count else "no episode has ended yet"
            body = Group(
                _success(report.window, stop, self._in_a_row),
                Text(f"\n{ended}", "dim"),
                _states(report.window, run.fspa.states),
                Text(),
                _figures(report, stop, 0.0 if report.stop else now - self._at),
                self._kept(now),
            )
        return Panel(
            body,
            title=title,
            subtitle=Text(str(run.folder), "dim"),
            width=min(_WIDTH, self._console.width),
            title_align="left",
        )

    def _before(self) -> RenderableType:
        """What there is to see before the first iteration."""
        exploration, searched = self._run.settings.exploration, self._searched
        if searched is None:
            return Text("playing the first steps …")
        found = len(searched.lengths)
        table = _grid()
        wanted = f"of at least {exploration.ways}"
        table.add_row("ways found", _bar(found / exploration.ways, "green"), f"{found:4}", wanted)
        share = min(1.0, searched.steps / exploration.steps)
        table.add_row("searched", _bar(share, "blue"), f"{share:4.0%}", f"of {exploration.steps:,} steps at the most")
        return Group(table, Text(f"\n{search_line(searched)}"))

    def _kept(self, now: float) -> str:
        if self._checkpoint is None:
            return "resumed from its checkpoint" if self._resumed else "no checkpoint yet"
        return f"last checkpoint {duration(now - self._checkpoint)} ago"


def line(report: Report, stop: Stop) -> str:
    """A report in a line."""
    window = report.window
    parts = [f"iteration {report.iteration.number}: {report.steps:,} steps in {duration(report.seconds)}"]
    if window.count:
        parts += [
            f"met in {window.successes} of the last {window.count} episodes",
            f"progress {window.progress:.2f}",
            f"reward {window.reward:.2f}",
        ]
    parts.append(f"{_rate(report):,.0f} steps/s")
    if not report.stop:
        parts.append(f"at most {duration(seconds_left(report, stop))} left")
    return ", ".join(parts)


def search_line(searched: Searched) -> str:
    """How far the search is, in a line."""
    if found := len(searched.lengths):
        ways = f"{found} way{'s' * (found > 1)} to meet the spec, the shortest of {min(searched.lengths)} steps"
    else:
        ways = "no way to meet the spec yet"
    took = f"{searched.steps:,} steps in {duration(searched.seconds)}"
    return f"searching by chance: {took}, {searched.places:,} places, {ways}"


def in_a_row(report: Report, before: int) -> int:
    """How many episodes without a failure the last ones are, of which there were ``before`` at the last report."""
    if report.window.successes == report.window.count:
        return report.window.count
    ends = [episode.success for episode in report.iteration.finished]
    return before + len(ends) if all(ends) else ends[::-1].index(False)


def seconds_left(report: Report, stop: Stop) -> float:
    """Seconds until a limit ends the training, at the speed that it had so far."""
    left = max(0.0, (stop.steps - report.steps) * report.seconds / max(report.steps, 1))
    return min(left, max(0.0, stop.minutes * 60 - report.seconds)) if stop.minutes else left


def duration(seconds: float) -> str:
    """A span of time for people: ``45 s``, ``12 min 5 s``, ``3 h 20 min``."""
    minutes, rest = divmod(round(seconds), 60)
    if not minutes:
        return f"{rest} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s"


def _success(window: Window, stop: Stop, in_a_row: int) -> Table:
    """How often the spec is met, and how much of the rule is fulfilled by which training stops."""
    wanted = stop.windows * stop.episodes
    row = min(in_a_row, wanted)
    table = _grid()
    table.add_row(
        "spec met", _bar(window.pass_rate, "green"), f"{window.pass_rate:4.0%}", f"of {window.count} episodes"
    )
    table.add_row("met in a row", _bar(row / wanted, "green"), f"{row:4}", f"of {wanted}, with which training ends")
    table.add_row("progress", _bar(window.progress, "blue"), f"{window.progress:4.2f}")
    return table


def _states(window: Window, states: tuple[State, ...]) -> Table:
    """In which states the last episodes ended, and what remained to be satisfied there."""
    shown = sorted(states, key=lambda state: -window.states.get(state.id, 0.0))[:_MOST_STATES]
    table = _grid()
    for state in sorted(shown, key=lambda state: state.id):
        share = window.states.get(state.id, 0.0)
        colour = "green" if state.accepting else "red" if state.distance is None else "cyan"
        label = Text(state.label.english, "" if share else "dim")
        table.add_row(f"state {state.id}", _bar(share, colour), f"{share:4.0%}", label)
    return table


def _figures(report: Report, stop: Stop, since: float) -> Text:
    """Numbers, ``since`` seconds after the report."""
    window, iteration = report.window, report.iteration
    learning = iteration.learn_s / ((iteration.learn_s + iteration.collect_s) or 1.0)
    best = "" if report.best_pass_rate is None else f"; best so far: met in {report.best_pass_rate:.0%}"
    speed = f"{_rate(report):,.0f} a second, {learning:.0%} of the time learning"
    left = max(0.0, seconds_left(report, stop) - since)
    end = "ended" if report.stop else f"at most {duration(left)} left"
    return Text(
        f"reward {window.reward:.2f}, {window.steps:.0f} steps an episode{best}\n"
        f"{report.steps:,} of at most {stop.steps:,} steps; {speed}\n"
        f"{duration(report.seconds + since)} so far, {end}"
    )


def _rate(report: Report) -> float:
    """Steps a second of the last iteration; 0 where a training that is over had none."""
    return report.iteration.steps / ((report.iteration.collect_s + report.iteration.learn_s) or 1.0)


def _grid() -> Table:
    table = Table.grid(padding=(0, 2, 0, 0), expand=True)
    for width in (12, _BAR, 5):
        table.add_column(width=width, min_width=width, no_wrap=True)
    table.add_column(ratio=1, no_wrap=True, overflow="ellipsis")
    return table


def _bar(share: float, colour: str) -> ProgressBar:
    return ProgressBar(1.0, share, _BAR, complete_style=colour, finished_style=colour)
