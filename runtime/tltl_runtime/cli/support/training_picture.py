"""The live picture of a training, which fits into a terminal of 80 x 24 characters."""

from __future__ import annotations

import time
from typing import Final

from rich.console import Console, Group, RenderableType
from rich.panel import Panel
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from tltl_runtime.cli.support.place_title import place_title
from tltl_runtime.cli.support.training_text import (
    WAYS_ARE_KEPT,
    confirmation_line,
    demonstrations_line,
    dropped_line,
    environments_line,
    made_line,
    measuring_line,
    plan_line,
    rate,
    recording_line,
    search_end,
    search_line,
    search_result_line,
    seconds_left,
)
from tltl_runtime.support.number_text import duration, number, percent, share
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.exploration.search_plan import SearchPlan
from tltl_runtime.training.files.report import EpisodeWindow, TrainingReport
from tltl_runtime.training.files.run_file import CHECKPOINT, TrainingRun
from tltl_runtime.training.files.settings import Stop
from tltl_runtime.training.imitation.demonstrations import Attempt
from tltlc.api import Fspa, State, label_text

_WIDTH: Final = 100
"""The greatest width of the picture, in characters."""
_MARGIN: Final = 4
"""The free columns at the right. There, the terminal prints `^C`, which the next picture erases."""
_MOST_STATES: Final = 8
_LINES_FOR_SPACE: Final = 17
"""With at least this many lines inside the border, empty lines separate the parts."""
_NAME: Final = 12
_BAR: Final = 24, 10
"""The width of a bar, in characters: in a picture of full width, and in a narrower one."""


class TrainingDisplay:
    """Draws the last report of a training as text and bars.

    The times in the picture keep counting between two reports.
    """

    def __init__(self, run: TrainingRun, console: Console) -> None:
        self._run, self._console = run, console
        # The name of a scene may be in the game file, which the user may change while the training goes on.
        self._title = f"{run.fspa.name} on {place_title(run.level, run.variant.text)}, seed {run.seed}"
        self._report: TrainingReport | None = None
        self._plan = self._stage = ""
        self._search: SearchProgress | None = None
        self._attempt: Attempt | None = None
        self._confirmation = ""
        self._report_time = time.monotonic()
        self._checkpoint: float | None = None
        self._resumed = (run.folder / CHECKPOINT).exists()

    def show_measuring(self, *, searches: bool) -> None:
        """Store that the game is started and tried."""
        self._stage = measuring_line(searches=searches)

    def show_start(self) -> None:
        """Store that the environments are started."""
        self._stage = environments_line(self._run.settings)

    def show_made(self, count: int) -> None:
        """Store how many environments have started."""
        self._stage = f"{environments_line(self._run.settings)}\n{made_line(count, self._run.settings)}"

    def show_plan(self, plan: SearchPlan) -> None:
        """Store how the game is searched, or why it is not."""
        self._plan = plan_line(plan) or ""

    def show_search(self, progress: SearchProgress) -> None:
        """Store the progress of the search for ways to meet the spec."""
        self._search = progress

    def show_attempt(self, attempt: Attempt) -> None:
        """Store the progress of recording demonstrations."""
        self._attempt = attempt

    def show_report(self, report: TrainingReport) -> None:
        """Store a report of the training."""
        self._report, self._report_time, self._search = report, time.monotonic(), None
        if report.confirmation:
            self._confirmation = confirmation_line(report.iteration.number, report.confirmation)
        if report.checkpointed:
            self._checkpoint = self._report_time

    def picture(self) -> RenderableType:
        """Return the current picture, fitted to the current size of the terminal."""
        run, (columns, lines) = self._run, self._console.size
        width = min(_WIDTH, columns - _MARGIN)
        bar = _BAR[width < _WIDTH]
        return Panel(
            # Two lines are for the border, and one line below the border stays free.
            self._before_first_iteration(bar)
            if self._report is None
            else self._after_iteration(self._report, bar, lines - 3),
            title=Text(self._title, "bold", overflow="ellipsis"),
            subtitle=Text(_tail(str(run.folder), width - 6), "dim"),
            width=width,
            title_align="left",
        )

    def _before_first_iteration(self, bar: int) -> RenderableType:
        """Return the picture before the training: the progress of searching, or of recording demonstrations."""
        exploration, searched = self._run.settings.exploration, self._search
        if attempt := self._attempt:
            return Text(recording_line(attempt, self._run.settings.imitation.demonstrations))
        if searched is None:
            return Text("\n\n".join(filter(None, (self._plan, self._stage or "playing the first steps …"))))
        count = len(searched.lengths)
        table = _grid(bar)
        required = f"of at least {exploration.ways}"
        table.add_row("ways found", _bar(count / exploration.ways, "green", bar), f"{count:4}", required)
        fraction = min(1.0, searched.steps / exploration.steps)
        most = f"of at most {exploration.steps:,} steps"
        table.add_row("searched", _bar(fraction, "blue", bar), f"{percent(fraction):>4}", most)
        lines = filter(
            None,
            (
                self._plan,
                search_line(searched, self._run.settings, self._run.fspa),
                search_end(exploration),
                WAYS_ARE_KEPT,
            ),
        )
        return Group(table, Text("\n" + "\n\n".join(lines)))

    def _after_iteration(self, report: TrainingReport, bar: int, room: int) -> RenderableType:
        """Return the picture after an iteration of the training, in ``room`` lines.

        The fewer lines there are, the fewer states of the automaton it shows.
        """
        now, run, window, stop = time.monotonic(), self._run, report.window, self._run.settings.stop
        space = [Text()] if room >= _LINES_FOR_SPACE else []
        since = 0.0 if report.stop else now - self._report_time
        messages = [self._confirmation] if self._confirmation else []
        messages += [search_line(self._search, self._run.settings, self._run.fspa)] if self._search else []
        messages += [report.lost.text] if report.lost else []
        lines = [*_figures(report, stop, since), *messages, self._checkpoint_text(now, report)]
        # Leave out violated states: an episode that violated the spec counts for its state before the violation.
        states = tuple(state for state in run.fspa.states if state.verdict != "violated")
        count = max(1, min(_MOST_STATES, room - len(lines) - 2 * len(space) - 4))
        return Group(
            _success_table(report, stop, bar),
            *space,
            Text(_ends_title(window, count, len(states)), "dim", no_wrap=True, overflow="ellipsis"),
            _state_table(window, run.fspa, states, count, bar),
            *space,
            *(Text(line, no_wrap=True, overflow="ellipsis") for line in lines),
        )

    def _checkpoint_text(self, now: float, report: TrainingReport) -> str:
        if self._checkpoint is not None:
            text = f"last checkpoint {duration(now - self._checkpoint)} ago"
        else:
            text = "resumed from its checkpoint" if self._resumed else "no checkpoint yet"
        return text if report.stop else f"{text}; Ctrl-C writes one to continue from"


def _success_table(report: TrainingReport, stop: Stop, bar: int) -> Table:
    """Return a table with the pass rate, the episodes met in a row, and the mean progress."""
    window, row, required = report.window, report.unbroken, stop.windows * stop.episodes
    table = _grid(bar)
    rate_of = f"of {window.count} episodes"
    table.add_row("spec met", _bar(window.pass_rate, "green", bar), f"{percent(window.pass_rate):>4}", rate_of)
    ends = f"of {required}, then the policy is confirmed"
    table.add_row("met in a row", _bar(row / required, "green", bar), f"{row:4}", ends)
    table.add_row("progress", _bar(window.progress, "blue", bar), share(window.progress))
    return table


def _ends_title(window: EpisodeWindow, shown_states: int, states: int) -> str:
    if not window.count:
        return "no episode has ended yet"
    of_states = f" ({shown_states} of {states} states)" if shown_states < states else ""
    return f"where the last {window.count} episodes ended{of_states}"


def _state_table(window: EpisodeWindow, fspa: Fspa, states: tuple[State, ...], count: int, bar: int) -> Table:
    """Return a table of the ``count`` states in which most of the last episodes ended.

    A row shows the share of episodes that ended in the state, and what remained to be done in it.
    """
    shown_states = sorted(states, key=lambda state: -window.states.get(state.id, 0.0))[:count]
    table = _grid(bar)
    for state in sorted(shown_states, key=lambda state: state.id):
        fraction, violated = window.states.get(state.id, 0.0), window.violated.get(state.id, 0.0)
        colour = "red" if violated > fraction / 2 else "green" if state.accepting else "cyan"
        label = Text(label_text(fspa, state.id), "" if fraction else "dim")
        if violated:
            label = Text.assemble((f"{percent(violated)} violated: ", "red"), label)
        table.add_row(f"state {state.id}", _bar(fraction, colour, bar), f"{percent(fraction):>4}", label)
    return table


def _figures(report: TrainingReport, stop: Stop, since: float) -> list[str]:
    """Return lines about reward, steps, speed and time, ``since`` seconds after the report.

    If there was a search, or if demonstrations are imitated, a line describes each of them.
    """
    window, iteration = report.window, report.iteration
    best = "" if report.best_pass_rate is None else f"; best so far: met in {percent(report.best_pass_rate)}"
    learning = iteration.learn_s / ((iteration.learn_s + iteration.collect_s) or 1.0)
    speed = f", {rate(report):,.0f} a second ({learning:.0%} learning)" if iteration.steps else ""
    left = max(0.0, seconds_left(report, stop) - since)
    end = "ended" if report.stop else f"at most {duration(left)} left"
    return [
        f"reward {number(window.reward, 2)}, {window.steps:.0f} steps an episode{best}",
        f"{report.steps:,} of at most {stop.steps:,} steps{speed}",
        f"{duration(report.seconds + since)} so far, {end}",
        *([search_result_line(report.searched)] if report.searched else ()),
        *([dropped] if report.searched and (dropped := dropped_line(report.searched)) else ()),
        *([demonstrations_line(report.imitated)] if report.imitated else ()),
    ]


def _grid(bar: int) -> Table:
    table = Table.grid(padding=(0, 2, 0, 0), expand=True)
    for width in (_NAME, bar, 5):
        table.add_column(width=width, min_width=width, no_wrap=True)
    table.add_column(ratio=1, no_wrap=True, overflow="ellipsis")
    return table


def _bar(share: float, colour: str, width: int) -> ProgressBar:
    return ProgressBar(1.0, share, width, complete_style=colour, finished_style=colour)


def _tail(text: str, width: int) -> str:
    """Shorten a text at its start, because the end of a path says most."""
    return text if len(text) <= width else f"…{text[1 - width :]}"
