"""The section of RESULTS.md on training: goals, tables, and a picture of the learning curves."""

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
"""A number of steps that no training reaches, so that only the minutes limit it."""
PAPER_HOURS = {"navigation": 3.5, "cover_and_hide": 2.7, "branching": 6.8}
LEVELS: Final = tuple(PAPER_HOURS)
SEEDS: Final = (1, 2, 3)
ABLATION: Final = "ablation: "
ABLATION_STEPS: Final = 500_000
GPU: Final = "cuda"
PICTURE_NAME: Final = "training.png"

_COLORS = ("#0f172a", "#e69f00", "#56b4e9", "#009e73", "#d55e00", "#0072b2", "#cc79a7", "#999999", "#b8a200", "#7a4a1e")
"""Our own colour, then colours that colour-blind people can tell apart (M. Okabe and K. Ito)."""
_LINES = ("-", "--", ":")


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals, once anything was measured; missing and failed cells miss the goals."""
    cells = [f"{level} {seed}" for level in LEVELS for seed in SEEDS]
    if not any(name in records for name in cells):
        return
    level_records = {name: record for name, record in _level_records(records).items() if name in cells}
    missing_count = len(cells) - len(level_records)
    reached = {
        name: record["sampled"]["pass_rate"] >= PASS_RATE and record["minutes"] <= MINUTES
        for name, record in level_records.items()
    }
    missed = [
        f"{name} {record['sampled']['pass_rate']:.2f} after {record['minutes']:.0f} minutes"
        for name, record in level_records.items()
        if not reached[name]
    ]
    yield (
        "each level trained within 30 minutes on two cores, for each seed, to a pass rate of 0.98 on fresh episodes",
        f"{sum(reached.values())} of {len(cells)}"
        + (
            f", longest {max(record['minutes'] for record in level_records.values()):.0f} minutes"
            if level_records
            else ""
        )
        + (f"; not: {', '.join(missed)}" if missed else "")
        + (f"; {missing_count} not measured" if missing_count else ""),
        met_or_missed(not missed and not missing_count),
    )
    if not level_records:
        return
    slowest = min(record["steps_per_s"] for record in level_records.values())
    whole = min(record["steps"] / record["minutes"] / 60 for record in level_records.values())
    yield (
        "playing and learning at least 1,500 steps per second, after the search",
        f"slowest {slowest:,}; the same steps over all of the time, searches included, {whole:,.0f}"
        + _of_measured(missing_count, cells),
        met_or_missed(slowest >= STEPS_PER_S and not missing_count),
    )
    most = max(record["learn_share"] for record in level_records.values())
    yield (
        "learning under half of that time",
        f"most {most:.2f}" + _of_measured(missing_count, cells),
        met_or_missed(most < LEARN_SHARE and not missing_count),
    )


def section(records: Mapping[str, Record]) -> str:
    """Return the section on training; empty without measurements."""
    parts = [
        _levels_section(_level_records(records)),
        _ablations_section(_ablation_records(records)),
        _gpu_text(records.get(GPU, {})),
        _failures_text(records),
    ]
    return "\n\n".join(part.strip() for part in parts if part)


def picture(records: Mapping[str, Record]) -> bytes:
    """Return a PNG of the progress and pass rate of each ablation over its steps."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.5), dpi=100, layout="constrained")
    for axes, title, column in zip(figure.subplots(1, 2, sharey=True), ("progress", "pass rate"), (2, 1), strict=True):
        for (name, record), (line, color) in zip(
            _ablation_records(records).items(), product(_LINES, _COLORS), strict=False
        ):
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


def _levels_section(records: Mapping[str, Record]) -> str:
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
            _other_cores(record),
            *_rates(record["sampled"]),
            *_rates(record["argmax"]),
            record["revision"],
        )
        for name, record in records.items()
        for level, seed in [name.split()]
    ]
    return f"""
## Training

`python -m benchmarks --only training` measures these figures; a stopped run resumes. A row is
`tltlc train --level LEVEL --seed SEED --minutes {MINUTES:g} --steps {NO_LIMIT} --workers {CORES}` on two cores, with
minutes as the only limit, then `tltlc evaluate` of its policy on fresh episodes, with actions sampled and with the
likeliest ones. *Ended*: `met` if the spec was met in two successive windows of 50 episodes, and then in 300 fresh
episodes of the policy. *Steps* are the decisions that the agent learned from; *all steps* also counts the decisions of
the search for demonstrations, and those that were played again to begin at a point of a demonstration.
*Minutes* are wall time, including the search; *steps/s* refers to the time after the search; *learning* is the share of
updates in the time of playing and learning; *others* is the number of cores that were busy with other work. *Pass rate*
has its Wilson interval; *progress* and *reward* (with the undiscounted terminal penalty) are means
with standard deviations. *Paper*: Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, Table I.

{table(header, body)}

{_measured_with(records)}
"""


def _ablations_section(records: Mapping[str, Record]) -> str:
    if not records:
        return ""
    body = [
        (
            name,
            *_course(record),
            f"{record['window']['pass_rate']:.2f}",
            f"{record['window']['progress']:.2f}",
            f"{record['steps_per_s']:,}",
            _other_cores(record),
        )
        for name, record in records.items()
    ]
    header = ("setting", "ended", "steps", "minutes", "pass rate", "progress", "steps/s", "others")
    return f"""
### Ablations

Each row is a training on cover_and_hide with seed 1, of {ABLATION_STEPS:,} steps and at most ten minutes. One setting
differs from *as it is*, the beginning of the training above. *Pass rate* and *progress* are those of the last episodes
of the training, at most 100. A row that *ended* as `met` shows the steps and minutes that it took.

{table(header, body)}

![Progress and pass rate over the steps of each]({PICTURE_NAME})

{_measured_with(records)}
"""


def _gpu_text(record: Record) -> str:
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


def _failures_text(records: Mapping[str, Record]) -> str:
    failed = [f"{name} ({record['failed']})" for name, record in records.items() if "failed" in record]
    return f"Failed: {', '.join(failed)}." if failed else ""


def _of_measured(missing_count: int, cells: Sequence[str]) -> str:
    return f" of the {len(cells) - missing_count} measured" if missing_count else ""


def _level_records(records: Mapping[str, Record]) -> dict[str, Record]:
    return {name: record for name, record in records.items() if "sampled" in record}


def _ablation_records(records: Mapping[str, Record]) -> dict[str, Record]:
    return {name.removeprefix(ABLATION): record for name, record in records.items() if "curve" in record}


def _course(record: Record) -> tuple[str, str, str]:
    """Return why a training ended, and after how many steps and minutes."""
    return record["end"], f"{record['steps']:,}", f"{record['minutes']:.1f}"


def _other_cores(record: Record) -> str:
    return "–" if record["other_cores"] is None else f"{record['other_cores']:.1f}"


def _rates(figures: Mapping[str, Any]) -> tuple[str, ...]:
    low, high = figures["pass_interval"]
    spreads = (f"{figures[name]['mean']:.2f} ± {figures[name]['std']:.2f}" for name in ("progress", "reward"))
    return (f"{figures['pass_rate']:.2f} ({low:.2f}–{high:.2f})", *spreads)


def _measured_with(records: Mapping[str, Record]) -> str:
    """Return the versions with which the records were made; several of one package if they differ."""
    versions: dict[str, list[str]] = {}
    for record in records.values():
        for name, version in {**record["versions"], "revision": record["revision"]}.items():
            versions.setdefault(name, [])
            if version not in versions[name]:
                versions[name].append(version)
    return f"With {', '.join(' '.join([name, ' and '.join(values)]) for name, values in versions.items())}."


def _thousands(value: float, _: object) -> str:
    return f"{value:,.0f}"
