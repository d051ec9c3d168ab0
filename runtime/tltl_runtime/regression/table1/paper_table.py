"""Table I of Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, beside our own figures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final, Literal

from tltl_runtime.evaluation.statistics import Spread, wilson
from tltlc.api import record

Model = Literal["expert", "imitation", "ours"]

MODELS: Final[tuple[Model, ...]] = ("expert", "imitation", "ours")
LEVELS: Final = ("navigation", "cover_and_hide", "branching")
"""The levels of this package that rebuild the cases 1 to 3 of the paper."""
VARIANTS: Final = ("v0", "v1", "v2")
RUNS: Final = 25
"""The number of episodes for each figure in the paper."""


@record
class CellFigures:
    """A model's statistics over ``runs`` episodes of one variant of a level.

    ``progress`` and ``reward`` are means with standard deviations.
    """

    runs: int
    pass_rate: float
    progress: Spread
    reward: Spread


@record
class TableRow:
    """A model's statistics on one level, by variant of the level.

    ``hours`` is the duration of the model's training, or None for the expert, which is not trained.
    ``cloning_share`` is the share of training steps with behavioural cloning alone, or None if the
    model does not imitate.
    """

    figures: Mapping[str, CellFigures]
    hours: float | None
    cloning_share: float | None = None


def _row(
    hours: float | None, *figures: tuple[float, float, float, float, float], cloning_share: float | None = None
) -> TableRow:
    """Return a row of the paper's table.

    ``figures`` has five numbers for each of v0, v1 and v2: the pass rate, the mean and standard
    deviation of progress, and the mean and standard deviation of reward.
    """
    cells = (CellFigures(RUNS, rate, Spread(p, dp), Spread(r, dr)) for rate, p, dp, r, dr in figures)
    return TableRow(dict(zip(VARIANTS, cells, strict=True)), hours, cloning_share)


PAPER: Final[Mapping[tuple[str, Model], TableRow]] = {
    ("navigation", "expert"): _row(
        None, (1.00, 1.00, 0.00, 0.63, 0.01), (1.00, 1.00, 0.00, 0.65, 0.02), (0.00, 0.50, 0.01, -0.50, 0.01)
    ),
    ("navigation", "imitation"): _row(
        20.0,
        (0.92, 0.98, 0.05, 0.50, 0.19),
        (0.32, 0.79, 0.22, -0.09, 0.37),
        (0.00, 0.47, 0.07, -0.53, 0.08),
        cloning_share=0.05,
    ),
    ("navigation", "ours"): _row(
        3.5, (1.00, 1.00, 0.00, 0.64, 0.01), (0.90, 0.93, 0.21, 0.39, 0.37), (0.00, 0.49, 0.05, -0.51, 0.05)
    ),
    ("cover_and_hide", "expert"): _row(
        None, (1.00, 1.00, 0.00, 0.73, 0.01), (1.00, 1.00, 0.00, 0.74, 0.01), (0.80, 0.93, 0.14, 0.41, 0.40)
    ),
    ("cover_and_hide", "imitation"): _row(
        20.0,
        (0.05, 0.74, 0.27, -0.25, 0.27),
        (0.00, 0.49, 0.26, -0.50, 0.27),
        (0.00, 0.41, 0.22, -0.58, 0.22),
        cloning_share=0.05,
    ),
    ("cover_and_hide", "ours"): _row(
        2.7, (1.00, 1.00, 0.00, 0.74, 0.03), (0.50, 0.85, 0.20, 0.21, 0.55), (0.20, 0.70, 0.25, -0.14, 0.51)
    ),
    ("branching", "expert"): _row(
        None, (1.00, 1.00, 0.00, 0.76, 0.01), (1.00, 1.00, 0.00, 0.73, 0.02), (1.00, 1.00, 0.00, 0.74, 0.08)
    ),
    ("branching", "imitation"): _row(
        20.0,
        (0.40, 0.82, 0.37, 0.01, 0.51),
        (0.24, 0.80, 0.36, -0.11, 0.45),
        (0.10, 0.71, 0.24, -0.24, 0.33),
        cloning_share=0.05,
    ),
    ("branching", "ours"): _row(
        6.8, (1.00, 1.00, 0.00, 0.66, 0.01), (0.93, 0.96, 0.17, 0.64, 0.36), (0.47, 0.89, 0.23, 0.27, 0.46)
    ),
}
"""The rows of the paper. Its experts are humans."""


def markdown(rows: Mapping[tuple[str, Model], TableRow]) -> str:
    """Format the table as Markdown: each of our rows, and below it the same row of the paper.

    Rows that ``rows`` does not contain are left out.
    """
    return "\n".join(_lines(rows)) + "\n"


def _lines(rows: Mapping[tuple[str, Model], TableRow]) -> Iterator[str]:
    yield f"| level | model | pass {' / '.join(VARIANTS)} | progress | reward | time |"
    yield "|---|---|---|---|---|---|"
    for level in LEVELS:
        for model in MODELS:
            if (level, model) in rows:
                yield _line(level, model, rows[level, model])
                paper = PAPER[level, model]
                name = "human" if model == "expert" else model
                yield _line("", f"*the paper: {name}*", paper)


def _line(level: str, model: str, row: TableRow) -> str:
    cells = [row.figures[variant] for variant in VARIANTS if variant in row.figures]
    passed = " / ".join(_rate(cell) for cell in cells)
    spreads = (
        " / ".join(f"{spread.mean:.2f} ± {spread.std:.2f}" for spread in column)
        for column in ([figures.progress for figures in cells], [figures.reward for figures in cells])
    )
    return f"| {level} | {model} | {passed} | {' | '.join(spreads)} | {_time(row)} |"


def _rate(figures: CellFigures) -> str:
    """Format a pass rate; add its confidence interval if there are more episodes than in the paper."""
    if figures.runs <= RUNS:
        return f"{figures.pass_rate:.2f}"
    low, high = wilson(round(figures.pass_rate * figures.runs), figures.runs)
    return f"{figures.pass_rate:.2f} ({low:.2f}–{high:.2f})"


def _time(row: TableRow) -> str:
    if row.hours is None:
        return "–"
    time = f"{row.hours:.1f} h" if row.hours >= 1 else f"{row.hours * 60:.0f} min"
    return time if row.cloning_share is None else f"{time}, {100 * row.cloning_share:.1f} % cloned"
