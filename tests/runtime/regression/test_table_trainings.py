"""The trainings of Table I: their folders, resuming them, and when they are finished."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.runtime.policies.examples import card_of, policy_of
from tests.runtime.training.runs import run_in
from tltl_runtime.policies.file import read_policy, write_policy
from tltl_runtime.policies.shipped import shipped_policies
from tltl_runtime.regression.table1 import table_trainings
from tltl_runtime.regression.table1.paper_table import Model
from tltl_runtime.regression.table1.table_trainings import (
    Limits,
    TableTraining,
    finished_training,
    limits,
    limits_of_policy,
    table_training,
    train_arguments,
)
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.stealth_game import StealthGame
from tltl_runtime.training.files.run_file import POLICY, RECORD, write_run
from tltl_runtime.training.files.settings import read_settings
from tltlc.core.record import replace

STEPS = 10**6
STEPS_OPTION = ("--steps", "1000000")
MODELS: tuple[Model, ...] = ("ours", "imitation")


def training(folder: Path, model: Model = "ours", minutes: float = 60.0) -> TableTraining:
    return table_training(folder, "cover_and_hide", model, Limits(STEPS, minutes))


def write_training(
    cell_training: TableTraining, minutes: float, *, seconds: float | None = None, end: str = "minutes"
) -> None:
    """Write the files of a training into its folder; it ended after ``seconds``, or is unfinished if None."""
    method = "imitation" if cell_training.imitates else "automaton"
    write_run(run_in(cell_training.folder, method=method, stop__minutes=minutes, stop__steps=STEPS))
    write_policy(cell_training.folder / POLICY, policy_of(card_of()))
    if seconds is not None:
        imitated = {"cloned": 50} if cell_training.imitates else None
        record = {"end": end, "steps": 1000, "seconds": seconds, "imitated": imitated}
        (cell_training.folder / RECORD).write_text(json.dumps(record), encoding="utf-8")


def test_each_level_and_model_has_its_own_folder(tmp_path: Path) -> None:
    names = [
        table_training(tmp_path, level, model, Limits(STEPS, 60.0)).folder.name
        for level in ("navigation", "cover_and_hide")
        for model in MODELS
    ]
    assert len(set(names)) == 4
    assert [name.rpartition("-")[0] for name in names] == [
        "navigation-ours",
        "navigation-imitation",
        "cover_and_hide-ours",
        "cover_and_hide-imitation",
    ]
    assert training(tmp_path).folder == training(tmp_path).folder


def test_another_level_spec_or_setting_is_another_training(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folders = {training(tmp_path).folder}
    with monkeypatch.context() as patched:
        patched.setattr(StealthGame, "load_level", lambda game, level, variant: load_level(level, "v1"))
        folders.add(training(tmp_path).folder)
    with monkeypatch.context() as patched:
        spec = tmp_path / "bold.tltl"
        spec.write_text(
            "import stealth\nentity exit\nspec bold { limit 9 steps\n reach near(exit) }\n", encoding="utf-8"
        )
        patched.setattr(table_trainings, "default_spec", lambda level: str(spec))
        folders.add(training(tmp_path).folder)
    with monkeypatch.context() as patched:
        settings = read_settings()
        slower = replace(settings, ppo=replace(settings.ppo, learning_rate=1e-5))
        patched.setattr(table_trainings, "read_settings", lambda: slower)
        folders.add(training(tmp_path).folder)
    assert len(folders) == 4


def test_the_limit_determines_the_folder_only_for_imitation(tmp_path: Path) -> None:
    assert training(tmp_path, "ours", 1.0).folder == training(tmp_path, "ours", 60.0).folder
    assert training(tmp_path, "imitation", 1.0).folder != training(tmp_path, "imitation", 60.0).folder
    longer = table_training(tmp_path, "cover_and_hide", "imitation", Limits(STEPS + 1, 60.0))
    assert longer.folder != training(tmp_path, "imitation", 60.0).folder


def test_limits_are_the_defaults_or_the_limits_of_a_policy() -> None:
    assert limits(None) == Limits(read_settings().stop.steps, 60.0)
    assert limits(5.0) == Limits(read_settings().stop.steps, 5.0)
    for path in shipped_policies().values():
        card = read_policy(path).card
        stop = card.training["settings"]["stop"]
        assert limits_of_policy(card, None) == Limits(stop["steps"], stop["minutes"])
        assert limits_of_policy(card, 5.0) == Limits(stop["steps"], 5.0)


def test_a_new_training_is_started(tmp_path: Path) -> None:
    cell_training = training(tmp_path, "imitation", 2.5)
    assert finished_training(cell_training) is None
    assert train_arguments(cell_training) == [
        *(
            "--level",
            "cover_and_hide",
            "--out",
            str(cell_training.folder),
            "--method",
            "imitation",
            *STEPS_OPTION,
            "--minutes",
            "2.5",
        )
    ]
    assert "--method" not in train_arguments(training(tmp_path))


@pytest.mark.parametrize(
    ("limit", "seconds", "end", "wanted", "over"),
    [
        (60.0, 3601.0, "minutes", 60.0, True),
        (1.0, 61.0, "minutes", 60.0, False),
        (1.0, 61.0, "minutes", 0.0, False),
        (1.0, 61.0, "minutes", 0.5, True),
        (1.0, 30.0, "met", 60.0, True),
        (60.0, None, "", 60.0, False),
    ],
)
def test_a_training_is_finished_if_it_met_its_spec_or_passed_the_limit(
    tmp_path: Path, limit: float, seconds: float | None, end: str, wanted: float, over: bool
) -> None:
    cell_training = training(tmp_path, minutes=wanted)
    write_training(cell_training, limit, seconds=seconds, end=end)
    finished = finished_training(cell_training)
    assert (finished is not None) == over
    if finished:
        assert seconds is not None
        assert (finished.policy, finished.hours, finished.cloning_share) == (
            cell_training.folder / POLICY,
            seconds / 3600,
            None,
        )
    else:
        assert train_arguments(cell_training) == [
            "--resume",
            str(cell_training.folder),
            *STEPS_OPTION,
            "--minutes",
            f"{wanted:g}",
        ]


@pytest.mark.parametrize(("limit", "wanted", "goes_on_to"), [(60.0, 10.0, "60"), (0.0, 10.0, "0"), (5.0, 0.0, "0")])
def test_an_interrupted_training_resumes_to_the_greater_limit(
    tmp_path: Path, limit: float, wanted: float, goes_on_to: str
) -> None:
    cell_training = training(tmp_path, minutes=wanted)
    write_training(cell_training, limit)
    assert train_arguments(cell_training) == [
        "--resume",
        str(cell_training.folder),
        *STEPS_OPTION,
        "--minutes",
        goes_on_to,
    ]


def test_the_share_of_cloned_steps_is_reported_for_imitation(tmp_path: Path) -> None:
    cell_training = training(tmp_path, "imitation")
    write_training(cell_training, 60.0, seconds=3601.0)
    finished = finished_training(cell_training)
    assert finished is not None and finished.cloning_share == 0.05
