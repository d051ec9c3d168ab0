"""Measured trainings: finished work is kept, and interrupted work is resumed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks import training, training_report
from benchmarks.store import Record, Store
from tltlc.interfaces.cli.main import main


def trained(pass_rate: float, minutes: float, end: str = "met") -> Record:
    spread = {"mean": 0.5, "std": 0.1}
    figures = {"pass_rate": pass_rate, "pass_interval": [0.9, 1.0], "progress": spread, "reward": spread}
    return {
        "end": end,
        "steps": 900_000,
        "minutes": minutes,
        "search_minutes": 1.0,
        "all_steps": 900_000,
        "steps_per_s": 1600,
        "learn_share": 0.4,
        "other_cores": 0.1,
        "window": {"pass_rate": pass_rate, "progress": 0.75},
        "versions": {"torch": "2.13.0"},
        "revision": "abc",
        "sampled": figures,
        "argmax": figures,
    }


@pytest.mark.slow
def test_a_quick_run_is_resumed_and_skips_finished_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for package in training.NEEDED:
        pytest.importorskip(package)
    store, folder, picture = Store(tmp_path / "results.json"), tmp_path / "cells", tmp_path / "curves.png"
    ran: list[str] = []
    run, failing = training._tltlc, iter([2])

    def run_here(*arguments: object) -> object:
        """Run the command in this process."""
        with pytest.raises(SystemExit) as ended:
            main([*map(str, arguments)])
        return ended.value.code

    def recorded_run(*arguments: object) -> object:
        """Run the command, but interrupt after the first training and let the first evaluation fail.

        The first training runs in a process of its own, and has two workers.
        """
        paths = [argument for argument in arguments if isinstance(argument, Path)]
        (cell_name,) = (path.name for path in paths if path.parent == folder and not path.suffix)
        ran.append(f"{arguments[0]} {cell_name}")
        status = next(failing, None) if arguments[0] == "evaluate" else None
        if len(ran) == 1:
            run(*arguments)
            monkeypatch.setattr(training, "CORES", 1)
            raise KeyboardInterrupt
        return run_here(*arguments) if status is None else status

    monkeypatch.setattr(training, "_tltlc", recorded_run)
    messages: list[str] = []
    with pytest.raises(KeyboardInterrupt):
        training.measure(store, 0.0, messages.append, training.QUICK, folder, picture)
    for _ in range(3):
        training.measure(store, 0.0, messages.append, training.QUICK, folder, picture)
    cell, ablation = "cover_and_hide 1", "ablation: no semantic map"
    # Later runs continue with the evaluation instead of training again; after the last run, everything is finished.
    first_cell, second_cell = "cover_and_hide-1", "no-semantic-map"
    expected = [f"train {first_cell}", f"evaluate {first_cell}", f"train {second_cell}", f"evaluate {first_cell}"]
    assert [command for command in ran if command != "train cuda"] == expected
    assert messages[0] == f'{cell}: {{"failed": "tltlc evaluate"}}'
    records = store.section(training.SECTION)
    assert records[cell]["end"] == records[ablation]["end"] == records["ablation: as it is"]["end"] == "minutes"
    assert records["ablation: as it is"]["curve"][-1][0] == records[cell]["steps"]
    assert records[cell]["steps"] == 4 * 32
    assert 0 < records[cell]["learn_share"] < 1
    settings = json.loads((folder / "no-semantic-map" / "run.json").read_text(encoding="utf-8"))
    assert settings["sensors"]["map"] is None
    text = training_report.section(records)
    assert "| cover_and_hide | 1 | minutes | 128 |" in text
    assert "--minutes 30 --steps 1000000000 --workers 2`" in text
    assert "| no semantic map | minutes | 128 |" in text
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("status", [1, 2])
@pytest.mark.parametrize("left, how", [("checkpoint.pt", "--resume"), ("run.json", "--level")])
def test_a_training_resumes_from_its_checkpoint_or_starts_again(
    left: str, how: str, status: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran: list[object] = []
    monkeypatch.setattr(training, "_tltlc", lambda *arguments: ran.append(arguments[1]) or status)
    cell = training.Cell(tmp_path / "cell", "navigation", 1, training.FULL)
    cell.folder.mkdir()
    (cell.folder / left).touch()
    source = cell.folder.with_suffix(training.SOURCE_SUFFIX)
    source.write_text("of who began it")
    assert cell.measure_level() == {"failed": "tltlc train"}
    assert ran == [how]
    assert source.read_text() == "of who began it"
    assert cell.folder.exists() == (how == "--resume")


def test_a_training_of_an_unknown_source_starts_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[object] = []
    monkeypatch.setattr(training, "_tltlc", lambda *arguments: ran.append(arguments[1]) or 1)
    cell = training.Cell(tmp_path / "cell", "navigation", 1, training.FULL)
    cell.folder.mkdir()
    (cell.folder / "record.json").touch()
    assert cell.measure_level() == {"failed": "tltlc train"}
    assert ran == ["--level"]


def test_settings_of_the_plan_and_of_an_ablation_are_merged() -> None:
    exploration = {"exploration": {"ways": 0}}
    text = training.settings_text(training.QUICK.settings, exploration, {"reward": {"mode": "edge"}})
    assert text == ('[rollout]\nenvs = 4\nsteps = 32\n[exploration]\nsteps = 64\nways = 0\n[reward]\nmode = "edge"\n')


@pytest.mark.parametrize("name", training.ABLATIONS)
def test_the_settings_of_an_ablation_are_valid(name: str, tmp_path: Path) -> None:
    for package in training.NEEDED:
        pytest.importorskip(package)
    from tltl_runtime.training.files.settings import read_settings

    ablation = training.ABLATIONS[name]
    (tmp_path / "settings.toml").write_text(training.settings_text(training.QUICK.settings, ablation.settings))
    changed = read_settings(tmp_path / "settings.toml")
    assert changed.rollout.envs == 4
    (tmp_path / "settings.toml").write_text(training.settings_text(training.QUICK.settings))
    assert (changed == read_settings(tmp_path / "settings.toml")) == (not ablation.settings)


def test_the_picture_has_a_curve_for_each_ablation() -> None:
    pytest.importorskip("matplotlib")
    curve = {"curve": [[64, 0.0, 0.1], [128, 0.5, 0.6]]}
    records = {f"{training_report.ABLATION}{name}": {**trained(0.5, 10.0), **curve} for name in training.ABLATIONS}
    one_less = dict(list(records.items())[:-1])
    assert training_report.picture(records) != training_report.picture(one_less)


def test_missed_goals_name_their_trainings() -> None:
    records = {"navigation 1": trained(1.0, 12.0), "branching 2": trained(0.95, 30.1, "minutes")}
    first, speed, share = training_report.goals(records)
    assert first[1] == "1 of 9, longest 30 minutes; not: branching 2 0.95 after 30 minutes; 7 not measured"
    assert speed[1] == "slowest 1,600; the same steps over all of the time, searches included, 498 of the 2 measured"
    assert share[1] == "most 0.40 of the 2 measured"
    assert {row[2] for row in (first, speed, share)} == {"**missed**"}
    cells = [f"{level} {seed}" for level in training.FULL.levels for seed in training.FULL.seeds]
    figures = [row[1:] for row in training_report.goals({name: trained(1.0, 12.0) for name in cells})]
    assert figures == [
        ("9 of 9, longest 12 minutes", "met"),
        ("slowest 1,600; the same steps over all of the time, searches included, 1,250", "met"),
        ("most 0.40", "met"),
    ]
    (only_goal,) = training_report.goals({"navigation 1": {"failed": "tltlc train"}})
    assert only_goal[1:] == ("0 of 9; 9 not measured", "**missed**")
    assert list(training_report.goals({"cuda": {"left_out": "no GPU is at hand"}})) == []


def test_failures_and_the_gpu_are_reported() -> None:
    records = {"navigation 1": {"failed": "tltlc train"}, "cuda": {**trained(1.0, 3.0), "gpu": "a GPU"}}
    del records["cuda"]["sampled"]
    text = training_report.section(records)
    assert text.startswith("Learning on a GPU (a GPU), the game on two cores, cover_and_hide: 1,600 steps/s")
    assert text.endswith("Failed: navigation 1 (tltlc train).")
