"""Measure trainings: how long they take, how well their policies play, and the effect of settings.

A cell is a level and a seed, trained by ``tltlc train`` and evaluated by ``tltlc evaluate`` on fresh
episodes; or an ablation, a training of a few minutes in which one setting differs. The folder of a
cell keeps its training, so that a stopped run resumes.

``python -m benchmarks.training --quick`` tries all of this with a few updates, and stores nothing.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from benchmarks import training_report
from benchmarks.load import LoadMeter
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest
from benchmarks.training_report import ABLATION, CORES, GPU, NO_LIMIT

SECTION = "training"
ABLATED = "cover_and_hide"
NEEDED = ("torch", "rsl_rl", "pybullet")

FOLDER = Path(__file__).with_name(".training")
PICTURE = Path(__file__).with_name(training_report.PICTURE_NAME)
FRESH_SEED = 1000
"""The first seed of evaluations, far from the seeds of trainings."""
CURVE_POINTS = 60
OTHER_CORES_FILE = "other_cores.txt"
"""A file in the folder of a training: it says how many cores other processes used during the last run."""
SOURCE_SUFFIX = ".source.json"
"""Suffix of a file beside the folder of a training; it identifies the code that last began or resumed the training."""

Settings = Mapping[str, Mapping[str, str | int | list[int]]]
"""Settings of a training that differ from the defaults, by table and key; keys outside tables are under ""."""


@dataclass(frozen=True, slots=True)
class Ablation:
    """The differences from the defaults: ``settings``, and further ``options`` of ``tltlc train``."""

    settings: Settings = field(default_factory=dict)
    options: Sequence[str] = ()


ABLATIONS: Mapping[str, Ablation] = {
    "reward sparse": Ablation({"reward": {"mode": "sparse"}}),
    "reward edge": Ablation({"reward": {"mode": "edge"}}),
    "reward potential": Ablation({"reward": {"mode": "potential"}}),
    "terminal penalty undiscounted": Ablation({"reward": {"terminal_penalty": "undiscounted"}}),
    "terminal penalty that stays discounted": Ablation({"reward": {"penalty_schedule": "fixed"}}),
    "no sharpening": Ablation({"ppo": {"sharpening": 1}}),
    "no semantic map": Ablation(options=("--no-map",)),
    "one convolution": Ablation({"network": {"channels": [32]}}),
    "no imitation of ways": Ablation({"exploration": {"imitation": 0}}),
    "no search for ways": Ablation({"exploration": {"ways": 0}}),
    "two threads that learn": Ablation({"": {"threads": 2}}),
}


@dataclass(frozen=True, slots=True)
class Plan:
    """The size of the measurement.

    ``minutes`` limits the training of a level; ``ablation_minutes`` and ``ablation_steps`` limit an
    ablation. ``settings`` apply to all cells. Equal numbers of steps make ablations comparable, even
    if other work slowed some of them down.
    """

    levels: Sequence[str] = training_report.LEVELS
    seeds: Sequence[int] = training_report.SEEDS
    minutes: float = training_report.MINUTES
    episodes: int = 100
    ablations: Mapping[str, Ablation] = field(default_factory=lambda: ABLATIONS)
    ablation_minutes: float = 10.0
    ablation_steps: int = training_report.ABLATION_STEPS
    settings: Settings = field(default_factory=dict)


FULL = Plan()
_QUICK_MINUTES = 0.001
"""Shorter than the first update."""
QUICK = Plan(
    levels=(ABLATED,),
    seeds=(1,),
    minutes=_QUICK_MINUTES,
    episodes=1,
    ablations={"no semantic map": ABLATIONS["no semantic map"]},
    ablation_minutes=_QUICK_MINUTES,
    settings={"rollout": {"envs": 4, "steps": 32}, "exploration": {"steps": 64}},
)


def measure(
    store: Store,
    _: float,
    say: Callable[[str], None],
    plan: Plan = FULL,
    folder: Path = FOLDER,
    picture: Path = PICTURE,
) -> None:
    """Train, evaluate and draw each cell without a record in the store, or with a failed one."""
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        say(f"{SECTION} left out: {', '.join(missing)} not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    cells = dict(_cells(plan, folder))
    try:
        measure_missing(store, SECTION, cells, lambda name: cells[name](), say, field="end")
    finally:
        picture.write_bytes(training_report.picture(store.section(SECTION)))


def discard(folder: Path = FOLDER) -> None:
    """Delete the stored trainings."""
    shutil.rmtree(folder, ignore_errors=True)


def _cells(plan: Plan, folder: Path) -> Iterator[tuple[str, Callable[[], Record]]]:
    """Yield the name of each cell with the function that measures it."""
    for level in plan.levels:
        for seed in plan.seeds:
            yield f"{level} {seed}", Cell(folder / f"{level}-{seed}", level, seed, plan).measure_level
    if plan.ablations:
        yield (
            f"{ABLATION}as it is",
            Cell(folder / f"{ABLATED}-{plan.seeds[0]}", ABLATED, plan.seeds[0], plan).measure_beginning,
        )
    for name, ablation in plan.ablations.items():
        yield (
            f"{ABLATION}{name}",
            Cell(folder / name.replace(" ", "-"), ABLATED, plan.seeds[0], plan, ablation).measure_curve,
        )
    yield GPU, Cell(folder / GPU, ABLATED, plan.seeds[0], plan, Ablation(options=("--device", GPU))).measure_on_gpu


@dataclass(frozen=True, slots=True)
class Cell:
    """A training in ``folder``, on two cores of this machine."""

    folder: Path
    level: str
    seed: int
    plan: Plan
    ablation: Ablation | None = None

    def measure_level(self) -> Record:
        """Return the figures of the training, and of its policy in fresh episodes."""
        if not self._train(self.plan.minutes, NO_LIMIT):
            return {"failed": "tltlc train"}
        report = self.folder / "evaluation.json"
        episodes = self.plan.episodes
        workers = min(CORES, episodes)
        options = ("--episodes", episodes, "--seed", FRESH_SEED, "--workers", workers, "--json", report)
        if _tltlc("evaluate", self.folder, *options) != 0:
            return {"failed": "tltlc evaluate"}
        evaluation = json.loads(report.read_text(encoding="utf-8"))
        return {**self._figures(), "sampled": _rates(evaluation), "argmax": _rates(evaluation["argmax"])}

    def measure_curve(self) -> Record:
        """Return the figures of the training, and its learning curve."""
        if not self._train(self.plan.ablation_minutes, self.plan.ablation_steps):
            return {"failed": "tltlc train"}
        return {**self._figures(), "curve": _points(self._record()["curve"])}

    def measure_beginning(self) -> Record:
        """Return the figures of the first part of the training, which is as long as an ablation."""
        if not self._train(self.plan.minutes, NO_LIMIT):
            return {"failed": "tltlc train"}
        figures, lines = self._figures(), [line for line in self._lines() if line["steps"] <= self.plan.ablation_steps]
        last, busy_s = lines[-1], sum(line["collect_s"] + line["learn_s"] for line in lines)
        return {
            **{name: figures[name] for name in ("end", "other_cores", "versions", "revision", "source")},
            **({"end": "steps"} if last["steps"] < figures["steps"] else {}),
            "steps": last["steps"],
            "minutes": round(last["seconds"] / 60, 2),
            "steps_per_s": round(last["steps"] / busy_s),
            "window": {name: last[name] or 0.0 for name in ("pass_rate", "progress")},
            "curve": _points(lines),
        }

    def measure_on_gpu(self) -> Record:
        """Return the figures of a training on a GPU, if there is one."""
        import torch

        if not torch.cuda.is_available():
            return {"left_out": "no GPU is at hand"}
        if not self._train(self.plan.ablation_minutes, NO_LIMIT):
            return {"failed": "tltlc train"}
        return {**self._figures(), "gpu": torch.cuda.get_device_name()}

    def _train(self, minutes: float, steps: int) -> bool:
        """Train, or continue an earlier run; return whether the training has ended."""
        earlier_source = self._source.read_text(encoding="utf-8") if self._source.exists() else None
        if earlier_source is None:
            # The source of an earlier training is unknown, so start again.
            shutil.rmtree(self.folder, ignore_errors=True)
        if self._has_ended():
            return True
        load = LoadMeter()
        source = {"revision": _revision(), "source": source_digest("tltlc", "runtime")}
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        # The training goes on if this process is killed, and its figures need the source.
        self._source.write_text(json.dumps(source), encoding="utf-8")
        self._run(minutes, steps)
        # The exit status does not tell an error from the end by a limit.
        if not self._has_ended():
            if earlier_source is not None:
                # The training may be running elsewhere.
                self._source.write_text(earlier_source, encoding="utf-8")
            return False
        if (other_cores := load.other_cores()) is not None:
            (self.folder / OTHER_CORES_FILE).write_text(f"{other_cores:.2f}", encoding="utf-8")
        return True

    def _has_ended(self) -> bool:
        return (self.folder / "record.json").exists()

    def _run(self, minutes: float, steps: int) -> None:
        """Start ``tltlc train``, or resume it."""
        limit = ("--minutes", minutes, "--steps", steps, "--workers", CORES)
        if (self.folder / "checkpoint.pt").exists():
            _tltlc("train", "--resume", self.folder, *limit)
            return
        shutil.rmtree(self.folder, ignore_errors=True)
        settings = self.folder.with_suffix(".toml")
        ablation = self.ablation or Ablation()
        settings.write_text(settings_text(self.plan.settings, ablation.settings), encoding="utf-8")
        options = ("--level", self.level, "--seed", self.seed, "--config", settings, "--out", self.folder)
        _tltlc("train", *options, *limit, *ablation.options)

    @property
    def _source(self) -> Path:
        return self.folder.with_suffix(SOURCE_SUFFIX)

    def _record(self) -> Any:
        return json.loads((self.folder / "record.json").read_text(encoding="utf-8"))

    def _lines(self) -> Sequence[Record]:
        """Return the metrics of each iteration."""
        text = (self.folder / "metrics.jsonl").read_text(encoding="utf-8")
        return [json.loads(line) for line in text.splitlines()]

    def _figures(self) -> Record:
        """Return why the training ended, its steps, time and speed, and the figures of its last window."""
        record, other_cores = self._record(), self.folder / OTHER_CORES_FILE
        collect_s, learn_s = (sum(line[name] for line in self._lines()) for name in ("collect_s", "learn_s"))
        search = record["search"] or {"steps": 0, "replayed": 0, "seconds": 0.0}
        return {
            "end": record["end"],
            "steps": record["steps"],
            "all_steps": record["steps"] + record["replayed"] + search["steps"] + search["replayed"],
            "minutes": round(record["seconds"] / 60, 2),
            "search_minutes": round(search["seconds"] / 60, 2),
            "steps_per_s": round(record["steps"] / (record["seconds"] - search["seconds"])),
            "learn_share": round(learn_s / (collect_s + learn_s), 3),
            "window": record["window"],
            "other_cores": float(other_cores.read_text(encoding="utf-8")) if other_cores.exists() else None,
            "versions": record["versions"],
            **json.loads(self._source.read_text(encoding="utf-8")),
        }


def _points(measured: Sequence[Record]) -> Sequence[Sequence[float]]:
    """Return steps, pass rate and progress of at most ``CURVE_POINTS`` records, among them the last one."""
    stride = -(-len(measured) // CURVE_POINTS)
    return [[record[name] for name in ("steps", "pass_rate", "progress")] for record in measured[::-stride][::-1]]


def settings_text(*settings: Settings) -> str:
    """Return the merged settings as TOML; later settings override earlier ones."""
    merged: dict[str, dict[str, str | int | list[int]]] = {}
    for settings_ in settings:
        for table, values in settings_.items():
            merged.setdefault(table, {}).update(values)
    lines = {table: [f"{key} = {json.dumps(value)}\n" for key, value in merged[table].items()] for table in merged}
    # In TOML, keys outside tables come first.
    return "".join((f"[{table}]\n" if table else "") + "".join(lines[table]) for table in sorted(lines, key=bool))


def _tltlc(*arguments: object) -> int:
    """Run a command of tltlc with its output on standard error; return its exit status."""
    command = [sys.executable, "-m", "tltlc", *map(str, arguments)]
    with subprocess.Popen(command, cwd=ROOT, stdout=sys.stderr, preexec_fn=_on_two_cores) as child:
        try:
            return child.wait()
        except KeyboardInterrupt:
            # The training has received Ctrl-C, too, and stores its checkpoint.
            child.wait()
            raise
        except BaseException:
            child.terminate()
            child.wait()
            raise


def _on_two_cores() -> None:
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:CORES])


def _rates(figures: Mapping[str, Any]) -> Record:
    """Return the figures of an evaluation that the report shows."""
    return {name: figures[name] for name in ("pass_rate", "pass_interval", "progress", "reward", "steps")}


def _revision() -> str:
    """Return the git revision, with `-dirty` if files differ from it; "unknown" without git."""
    command = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
    try:
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def main() -> None:
    """Measure every cell with a few updates, and print the section."""
    if sys.argv[1:] != ["--quick"]:
        sys.exit("usage: python -m benchmarks.training --quick")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        store = Store(folder / "results.json")
        measure(store, 0.0, _say, QUICK, folder / "cells", folder / "curves.png")
        print(training_report.section(store.section(SECTION)))


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
