"""Trainings to their end: how long they take, and what becomes of them; and what they come to with other settings.

A cell is a level and a seed, trained by ``tltlc train`` and evaluated by ``tltlc evaluate`` on fresh episodes, or an
ablation: a training of a few minutes in which one setting differs.  What a cell has trained so far stays in a folder,
so that a run that was stopped goes on within it.

``python -m benchmarks.training --quick`` tries all of this with a few updates, and keeps nothing.
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
from benchmarks.load import Load
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest
from benchmarks.training_report import ABLATION, CORES, GPU, NO_LIMIT

SECTION = "training"
ABLATED = "cover_and_hide"
NEEDED = ("torch", "rsl_rl", "pybullet")

FOLDER = Path(__file__).with_name(".training")
PICTURE = Path(__file__).with_name(training_report.PICTURE_NAME)
FRESH_SEED = 1000
"""Of the episodes of evaluations, far from those of trainings."""
CURVE_POINTS = 60
OTHERS = "other_cores.txt"
"""In the folder of a training: what else the machine did while it ran for the last time."""
SOURCE = ".source.json"
"""Behind the name of a training's folder, beside it: the code with which it was begun, or resumed for the last time."""

Settings = Mapping[str, Mapping[str, str | int | list[int]]]
"""Settings of a training that differ from the defaults, by table and key; those of no table are under ""."""


@dataclass(frozen=True, slots=True)
class Ablation:
    """What differs from the defaults: ``settings``, and further ``options`` of ``tltlc train``."""

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
    """What is measured: ``minutes`` limit a training of a level, ``ablation_minutes`` and ``ablation_steps`` one of an
    ablation; ``settings`` are of all cells.

    By steps ablations can be compared, also those that were disturbed more than others.
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
"""The first update is beyond it."""
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
    """Train, evaluate and draw what the store does not have yet, or what failed."""
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        say(f"{SECTION} left out: {', '.join(missing)} not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    cells = dict(_cells(plan, folder))
    try:
        measure_missing(store, SECTION, cells, lambda name: cells[name](), say, done="end")
    finally:
        picture.write_bytes(training_report.picture(store.section(SECTION)))


def discard(folder: Path = FOLDER) -> None:
    """Forget what was trained so far."""
    shutil.rmtree(folder, ignore_errors=True)


def _cells(plan: Plan, folder: Path) -> Iterator[tuple[str, Callable[[], Record]]]:
    """What measures each cell, by its name."""
    for level in plan.levels:
        for seed in plan.seeds:
            yield f"{level} {seed}", Cell(folder / f"{level}-{seed}", level, seed, plan).judged
    if plan.ablations:
        yield f"{ABLATION}as it is", Cell(folder / f"{ABLATED}-{plan.seeds[0]}", ABLATED, plan.seeds[0], plan).beginning
    for name, ablation in plan.ablations.items():
        yield f"{ABLATION}{name}", Cell(folder / name.replace(" ", "-"), ABLATED, plan.seeds[0], plan, ablation).curve
    yield GPU, Cell(folder / GPU, ABLATED, plan.seeds[0], plan, Ablation(options=("--device", GPU))).on_gpu


@dataclass(frozen=True, slots=True)
class Cell:
    """A training in ``folder``, on two cores of this machine."""

    folder: Path
    level: str
    seed: int
    plan: Plan
    ablation: Ablation | None = None

    def judged(self) -> Record:
        """The training's figures, and those of its policy over fresh episodes."""
        if not self._train(self.plan.minutes, NO_LIMIT):
            return {"failed": "tltlc train"}
        report = self.folder / "evaluation.json"
        episodes = self.plan.episodes
        workers = min(CORES, episodes)
        options = ("--episodes", episodes, "--seed", FRESH_SEED, "--workers", workers, "--json", report)
        if _tltlc("evaluate", self.folder, *options) != 0:
            return {"failed": "tltlc evaluate"}
        found = json.loads(report.read_text(encoding="utf-8"))
        return {**self._figures(), "sampled": _rates(found), "argmax": _rates(found["argmax"])}

    def curve(self) -> Record:
        """The training's figures, and how it came to them."""
        if not self._train(self.plan.ablation_minutes, self.plan.ablation_steps):
            return {"failed": "tltlc train"}
        return {**self._figures(), "curve": _points(self._record()["curve"])}

    def beginning(self) -> Record:
        """The training's beginning, as long as an ablation: where nothing differs none need be trained."""
        if not self._train(self.plan.minutes, NO_LIMIT):
            return {"failed": "tltlc train"}
        whole, lines = self._figures(), [line for line in self._lines() if line["steps"] <= self.plan.ablation_steps]
        last, busy_s = lines[-1], sum(line["collect_s"] + line["learn_s"] for line in lines)
        return {
            **{name: whole[name] for name in ("end", "other_cores", "versions", "revision", "source")},
            **({"end": "steps"} if last["steps"] < whole["steps"] else {}),
            "steps": last["steps"],
            "minutes": round(last["seconds"] / 60, 2),
            "steps_per_s": round(last["steps"] / busy_s),
            "window": {name: last[name] or 0.0 for name in ("pass_rate", "progress")},
            "curve": _points(lines),
        }

    def on_gpu(self) -> Record:
        """The training's figures where a GPU is at hand."""
        import torch

        if not torch.cuda.is_available():
            return {"left_out": "no GPU is at hand"}
        if not self._train(self.plan.ablation_minutes, NO_LIMIT):
            return {"failed": "tltlc train"}
        return {**self._figures(), "gpu": torch.cuda.get_device_name()}

    def _train(self, minutes: float, steps: int) -> bool:
        """Train to the end, from where an earlier run stopped; whether that was reached."""
        before = self._source.read_text(encoding="utf-8") if self._source.exists() else None
        if before is None:
            # Nobody knows of which source it is.
            shutil.rmtree(self.folder, ignore_errors=True)
        if self._has_ended():
            return True
        load = Load()
        source = {"revision": _revision(), "source": source_digest("tltlc", "runtime")}
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        # A training outlives whoever kills this process, and its figures need the source.
        self._source.write_text(json.dumps(source), encoding="utf-8")
        self._run(minutes, steps)
        # By its status alone an error looks like the end by a limit.
        if not self._has_ended():
            if before is not None:
                # Perhaps it goes on elsewhere.
                self._source.write_text(before, encoding="utf-8")
            return False
        if (others := load.other_cores()) is not None:
            (self.folder / OTHERS).write_text(f"{others:.2f}", encoding="utf-8")
        return True

    def _has_ended(self) -> bool:
        return (self.folder / "record.json").exists()

    def _run(self, minutes: float, steps: int) -> None:
        """Have ``tltlc train`` begin, or go on."""
        limit = ("--minutes", minutes, "--steps", steps, "--workers", CORES)
        if (self.folder / "checkpoint.pt").exists():
            _tltlc("train", "--resume", self.folder, *limit)
            return
        shutil.rmtree(self.folder, ignore_errors=True)
        settings = self.folder.with_suffix(".toml")
        ablation = self.ablation or Ablation()
        settings.write_text(settings_text(self.plan.settings, ablation.settings), encoding="utf-8")
        given = ("--level", self.level, "--seed", self.seed, "--config", settings, "--out", self.folder)
        _tltlc("train", *given, *limit, *ablation.options)

    @property
    def _source(self) -> Path:
        return self.folder.with_suffix(SOURCE)

    def _record(self) -> Any:
        return json.loads((self.folder / "record.json").read_text(encoding="utf-8"))

    def _lines(self) -> Sequence[Record]:
        """What was measured after each iteration."""
        text = (self.folder / "metrics.jsonl").read_text(encoding="utf-8")
        return [json.loads(line) for line in text.splitlines()]

    def _figures(self) -> Record:
        """Why the training ended, after how much, how fast it was, and the last window."""
        record, others = self._record(), self.folder / OTHERS
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
            "other_cores": float(others.read_text(encoding="utf-8")) if others.exists() else None,
            "versions": record["versions"],
            **json.loads(self._source.read_text(encoding="utf-8")),
        }


def _points(measured: Sequence[Record]) -> Sequence[Sequence[float]]:
    """Steps, pass rate and progress of at most ``CURVE_POINTS`` of what was measured, the last one among them."""
    stride = -(-len(measured) // CURVE_POINTS)
    return [[each[name] for name in ("steps", "pass_rate", "progress")] for each in measured[::-stride][::-1]]


def settings_text(*settings: Settings) -> str:
    """The TOML text of settings together, of which later ones go before earlier ones."""
    merged: dict[str, dict[str, str | int | list[int]]] = {}
    for each in settings:
        for table, values in each.items():
            merged.setdefault(table, {}).update(values)
    lines = {table: [f"{key} = {json.dumps(value)}\n" for key, value in merged[table].items()] for table in merged}
    # TOML has those of no table before all tables.
    return "".join((f"[{table}]\n" if table else "") + "".join(lines[table]) for table in sorted(lines, key=bool))


def _tltlc(*arguments: object) -> int:
    """Run a command of tltlc, which shows on standard error how it goes; its exit status."""
    command = [sys.executable, "-m", "tltlc", *map(str, arguments)]
    with subprocess.Popen(command, cwd=ROOT, stdout=sys.stderr, preexec_fn=_on_two_cores) as child:
        try:
            return child.wait()
        except KeyboardInterrupt:
            # It has heard Ctrl-C, too, and keeps what it has learned.
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
    """What is told of an evaluation."""
    return {name: figures[name] for name in ("pass_rate", "pass_interval", "progress", "reward", "steps")}


def _revision() -> str:
    """The version in git, with a `-dirty` behind it where files differ from it."""
    command = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
    try:
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def main() -> None:
    """Try the section: a few updates in each cell."""
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
