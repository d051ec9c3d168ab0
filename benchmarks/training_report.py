"""The part of RESULTS.md on training: goals, tables, and a picture of the ablations' curves."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from io import BytesIO
from itertools import product
from typing import Any, Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record

PASS_RATE = 0.98
MINUTES = 30.0
STEPS_PER_S = 1500.0
LEARN_SHARE = 0.5
CORES: Final = 2
NO_LIMIT: Final = 10**9
"""Of steps: minutes alone end a training."""
PAPER_HOURS = {"navigation": 3.5, "cover_and_hide": 2.7, "branching": 6.8}
LEVELS: Final = tuple(PAPER_HOURS)
SEEDS: Final = (1, 2, 3)
ABLATION: Final = "ablation: "
ABLATION_STEPS: Final = 500_000
GPU: Final = "cuda"
PICTURE_NAME: Final = "training.png"

_COLORS = ("#0f172a", "#e69f00", "#56b4e9", "#009e73", "#d55e00", "#0072b2", "#cc79a7", "#999999", "#b8a200", "#7a4a1e")
"""Told apart by the colour-blind, too: those of M. Okabe and K. Ito, behind our own."""
_LINES = ("-", "--", ":")


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Rows of the table of goals, once anything was measured; what was not, or failed, reaches none."""
    cells = [f"{level} {seed}" for level in LEVELS for seed in SEEDS]
    if not any(name in records for name in cells):
        return
    judged = {name: record for name, record in _judged(records).items() if name in cells}
    lacking = len(cells) - len(judged)
    reached = {
        name: record["sampled"]["pass_rate"] >= PASS_RATE and record["minutes"] <= MINUTES
        for name, record in judged.items()
    }
    missed = [
        f"{name} {record['sampled']['pass_rate']:.2f} after {record['minutes']:.0f} minutes"
        for name, record in judged.items()
        if not reached[name]
    ]
    yield (
        "each level trained within 30 minutes on two cores, for each seed, to a pass rate of 0.98 on fresh episodes",
        f"{sum(reached.values())} of {len(cells)}"
        + (f", longest {max(record['minutes'] for record in judged.values()):.0f} minutes" if judged else "")
        + (f"; not: {', '.join(missed)}" if missed else "")
        + (f"; {lacking} not measured" if lacking else ""),
        met_or_missed(not missed and not lacking),
    )
    if not judged:
        return
    slowest = min(record["steps_per_s"] for record in judged.values())
    whole = min(record["steps"] / record["minutes"] / 60 for record in judged.values())
    yield (
        "playing and learning at least 1,500 steps per second, after the search",
        f"slowest {slowest:,}; the same steps over all of the time, searches included, {whole:,.0f}"
        + _of_some(lacking, cells),
        met_or_missed(slowest >= STEPS_PER_S and not lacking),
    )
    most = max(record["learn_share"] for record in judged.values())
    yield (
        "learning under half of that time",
        f"most {most:.2f}" + _of_some(lacking, cells),
        met_or_missed(most < LEARN_SHARE and not lacking),
    )


def section(records: Mapping[str, Record]) -> str:
    """The section on training."""
    parts = [_trained(_judged(records)), _ablations(_ablated(records)), _gpu(records.get(GPU, {})), _failed(records)]
    return "\n\n".join(part.strip() for part in parts if part)


def picture(records: Mapping[str, Record]) -> bytes:
    """A PNG of how progress and pass rate rise in each ablation."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.5), dpi=100, layout="constrained")
    for axes, title, column in zip(figure.subplots(1, 2, sharey=True), ("progress", "pass rate"), (2, 1), strict=True):
        for (name, record), (line, color) in zip(_ablated(records).items(), product(_LINES, _COLORS), strict=False):
            points = [point for point in record["curve"] if point[column] is not None]
            steps, values = [point[0] for point in points], [point[column] for point in points]
            axes.plot(steps, values, color=color, linestyle=line, label=name)
        axes.set_title(title, loc="left", fontsize=11)
        axes.set_xlabel("steps of all environments")
        axes.xaxis.set_major_formatter(_thousands)
        axes.set_xlim(left=0)
        axes.set_ylim(-0.02, 1.02)
        axes.grid(color="#e2e8f0")
        axes.spines[["top", "right"]].set_visible(False)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    file = BytesIO()
    figure.savefig(file, format="png", metadata={"Software": None})
    return file.getvalue()


def _trained(records: Mapping[str, Record]) -> str:
    if not records:
        return ""
    header = (
        "level",
        "seed",
        "ended",
        "steps",
        "minutes",
        "of them search",
        "all steps",
        "paper, hours",
        "steps/s",
        "learning",
        "others",
        "pass rate (95 %)",
        "progress",
        "reward",
        "arg-max: pass rate (95 %)",
        "progress",
        "reward",
        "revision",
    )
    body = [
        (
            level,
            seed,
            *_course(record),
            f"{record['search_minutes']:.1f}",
            f"{record['all_steps']:,}",
            PAPER_HOURS[level],
            f"{record['steps_per_s']:,}",
            f"{record['learn_share']:.2f}",
            _others(record),
            *_rates(record["sampled"]),
            *_rates(record["argmax"]),
            record["revision"],
        )
        for name, record in records.items()
        for level, seed in [name.split()]
    ]
    return f"""
## Training

`python -m benchmarks --only training` makes these figures, and goes on where it was stopped. A row is
`tltlc train --level LEVEL --seed SEED --minutes {MINUTES:g} --steps {NO_LIMIT} --workers {CORES}` on two cores, with
minutes as the only limit, then `tltlc evaluate` of its policy on fresh episodes, with actions sampled and with the
likeliest ones. *Ended*: `met` where the spec was met in two successive windows of 50 episodes, and by the policy then
in 300 fresh ones. *Steps* are the decisions that the agent learned from; *all steps* also those of the search for ways
and those that were played again to begin on a way.
*Minutes* are of wall time, those of the search included; *steps/s* are of the time after it; *learning* is the share
that updates took of the time of playing and learning; *others* are how many cores of the machine were busy with other
work. *Pass rate* with its Wilson interval; *progress* and *reward* (with the undiscounted terminal penalty) are means
with standard deviations. *Paper*: Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, Table I.

{table(header, body)}

{_measured_with(records)}
"""


def _ablations(records: Mapping[str, Record]) -> str:
    if not records:
        return ""
    body = [
        (
            name,
            *_course(record),
            f"{record['window']['pass_rate']:.2f}",
            f"{record['window']['progress']:.2f}",
            f"{record['steps_per_s']:,}",
            _others(record),
        )
        for name, record in records.items()
    ]
    header = ("setting", "ended", "steps", "minutes", "pass rate", "progress", "steps/s", "others")
    return f"""
### Ablations

One training each on cover_and_hide with seed 1, of {ABLATION_STEPS:,} steps and at most ten minutes, in which one
setting differs from *as it is*, the beginning of the training above. *Pass rate* and *progress* are those of its last
episodes, at most 100 of them, as the training played them; a row that *ended* as `met` shows the steps and minutes that
it took.

{table(header, body)}

![Progress and pass rate over the steps of each]({PICTURE_NAME})

{_measured_with(records)}
"""


def _gpu(record: Record) -> str:
    if not record:
        return ""
    if "left_out" in record:
        return f"Learning on a GPU: not measured, {record['left_out']}."
    if "end" not in record:
        return ""
    ended, steps, minutes = _course(record)
    return (
        f"Learning on a GPU ({record['gpu']}), the game on two cores, cover_and_hide: "
        f"{record['steps_per_s']:,} steps/s, learning {record['learn_share']:.2f} of the time; "
        f"ended ({ended}) after {steps} steps, {minutes} minutes."
    )


def _failed(records: Mapping[str, Record]) -> str:
    failed = [f"{name} ({record['failed']})" for name, record in records.items() if "failed" in record]
    return f"Failed: {', '.join(failed)}." if failed else ""


def _of_some(lacking: int, cells: Sequence[str]) -> str:
    return f" of the {len(cells) - lacking} measured" if lacking else ""


def _judged(records: Mapping[str, Record]) -> dict[str, Record]:
    return {name: record for name, record in records.items() if "sampled" in record}


def _ablated(records: Mapping[str, Record]) -> dict[str, Record]:
    return {name.removeprefix(ABLATION): record for name, record in records.items() if "curve" in record}


def _course(record: Record) -> tuple[str, str, str]:
    """Why a training ended, and after how many steps and minutes."""
    return record["end"], f"{record['steps']:,}", f"{record['minutes']:.1f}"


def _others(record: Record) -> str:
    return "–" if record["other_cores"] is None else f"{record['other_cores']:.1f}"


def _rates(figures: Mapping[str, Any]) -> tuple[str, ...]:
    low, high = figures["pass_interval"]
    spreads = (f"{figures[name]['mean']:.2f} ± {figures[name]['std']:.2f}" for name in ("progress", "reward"))
    return (f"{figures['pass_rate']:.2f} ({low:.2f}–{high:.2f})", *spreads)


def _measured_with(records: Mapping[str, Record]) -> str:
    """The versions with which records were made; several of one package where they differ."""
    found: dict[str, list[str]] = {}
    for record in records.values():
        for name, version in {**record["versions"], "revision": record["revision"]}.items():
            found.setdefault(name, [])
            if version not in found[name]:
                found[name].append(version)
    return f"With {', '.join(' '.join([name, ' and '.join(each)]) for name, each in found.items())}."


def _thousands(value: float, _: object) -> str:
    return f"{value:,.0f}"
