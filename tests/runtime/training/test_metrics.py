"""The measurements of a training: ``metrics.jsonl`` and the events for TensorBoard."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from tests.docs.blocks import DOCS
from tests.runtime.training.reports import a_report, an_episode
from tltl_runtime.spec.task import read_spec
from tltl_runtime.training.files.metrics import METRICS, read_metrics
from tltl_runtime.training.files.metrics_writer import Metrics
from tltl_runtime.training.files.report import Confirmation
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import Limit

LEFT = {
    "label": "F(near(s2) & X F near(exit)) & G alive",
    "english": "Reach near(s2), then near(exit), and keep alive throughout.",
}
"""What remains in state 1."""


@pytest.fixture(scope="module")
def fspa() -> Fspa:
    return read_spec(DOCS.parent / "examples" / "cover_and_hide.tltl")[0]


def _measure(folder: Path, fspa: Fspa, numbers: range, after: int = 0) -> None:
    metrics = Metrics(folder, fspa, after=after, steps=4096 * after)
    for number in numbers:
        metrics.add(a_report(number))
    metrics.close()


def test_each_iteration_is_a_line(tmp_path: Path, fspa: Fspa) -> None:
    metrics = Metrics(tmp_path, fspa)
    metrics.add(a_report(1, count=0, successes=0))
    metrics.add(a_report(2, finished=(an_episode(True), an_episode(False)), confirmation=Confirmation(12, 100)))
    first, second = read_metrics(tmp_path / METRICS)  # lines are written before the files are closed
    metrics.close()
    assert (first["window"], first["pass_rate"], first["confirmation"], first["states"]) == (0, None, None, [])
    assert second == {
        "iteration": 2,
        "steps": 8192,
        "seconds": 4.0,
        "steps_per_s": 2048.0,
        "collect_s": 1.5,
        "learn_s": 0.5,
        "episodes": 2,
        "window": 50,
        "pass_rate": 0.8,
        "progress": 0.9,
        "reward": 0.65,
        "episode_steps": 130.0,
        "confirmation": {"met": 12, "of": 100},
        "states": [
            {"state": 1, **LEFT, "share": 0.2, "violated": 0.15},
            {"state": 4, "label": "G alive", "english": "Keep alive throughout.", "share": 0.8, "violated": 0.0},
        ],
        "losses": {"value": 0.25, "entropy": 3.5},
    }


def test_the_page_lists_the_fields_of_a_line(tmp_path: Path, fspa: Fspa) -> None:
    _measure(tmp_path, fspa, range(1, 2))
    page = (DOCS / "training.md").read_text(encoding="utf-8")
    table = page[page.index("### `metrics.jsonl`") : page.index("## The record")]
    documented = [
        name for row in re.findall(r"^\| (`.*?) \|", table, re.MULTILINE) for name in re.findall(r"`(\w+)`", row)
    ]
    assert documented == list(read_metrics(tmp_path / METRICS)[0])


def test_iterations_after_the_checkpoint_are_measured_again(tmp_path: Path, fspa: Fspa) -> None:
    _measure(tmp_path, fspa, range(1, 6))
    with (tmp_path / METRICS).open("a") as file:
        file.write('{"iteration": 6, "st')  # an incomplete line, as after a power failure
    _measure(tmp_path, fspa, range(4, 8), after=3)
    assert [line["iteration"] for line in read_metrics(tmp_path / METRICS)] == list(range(1, 8))


@pytest.mark.parametrize("name", ["iteration", "steps", "seconds", "episodes", "window", "pass_rate", "reward"])
def test_a_line_without_a_required_key_is_left_out(tmp_path: Path, fspa: Fspa, name: str) -> None:
    _measure(tmp_path, fspa, range(1, 4))
    lines = (tmp_path / METRICS).read_text().splitlines(keepends=True)
    second = json.loads(lines[1])
    del second[name]
    (tmp_path / METRICS).write_text(lines[0] + json.dumps(second) + "\n" + lines[2])
    assert [line["iteration"] for line in read_metrics(tmp_path / METRICS)] == [1, 3]


@pytest.mark.parametrize("value", [None, "2", 2.0, True, []])
@pytest.mark.parametrize("name", ["iteration", "steps", "episodes", "window"])
def test_a_line_with_an_invalid_count_is_left_out(tmp_path: Path, fspa: Fspa, name: str, value: Any) -> None:
    _measure(tmp_path, fspa, range(1, 3))
    first, second = (tmp_path / METRICS).read_text().splitlines(keepends=True)
    (tmp_path / METRICS).write_text(first + json.dumps({**json.loads(second), name: value}) + "\n" + "[" * 10**5)
    assert [line["iteration"] for line in read_metrics(tmp_path / METRICS)] == [1]
    _measure(tmp_path, fspa, range(2, 3), after=1)
    assert [line["iteration"] for line in read_metrics(tmp_path / METRICS)] == [1, 2]


def test_tensorboard_shows_each_step_once(tmp_path: Path, fspa: Fspa) -> None:
    _measure(tmp_path, fspa, range(1, 6))
    # TensorBoard orders the files by their names: by the second, and then by counters that are texts.
    (first,) = tmp_path.glob("events.out.tfevents.*")
    first.rename(first.with_name(re.sub(r"\d{10}", "1000000000", first.name, count=1)))
    _measure(tmp_path, fspa, range(4, 8), after=3)
    events = EventAccumulator(str(tmp_path))
    events.Reload()
    for tag in ("train/pass_rate", "train/progress", "state/4", "violated/1", "time/steps_per_s", "loss/entropy"):
        assert [event.step for event in events.Scalars(tag)] == [4096 * number for number in range(1, 8)], tag
    assert events.Scalars("train/pass_rate")[0].value == pytest.approx(0.8)


def test_an_unwritable_file_is_reported(tmp_path: Path, fspa: Fspa) -> None:
    (tmp_path / METRICS).mkdir()
    with pytest.raises(TltlError, match="it is a folder"):
        Metrics(tmp_path, fspa)


def test_endless_measurements_are_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.io.limits.MEASUREMENTS", Limit(size=1 << 20))
    (tmp_path / METRICS).symlink_to("/dev/zero")
    with pytest.raises(TltlError, match="TLT0004"):
        read_metrics(tmp_path / METRICS)
