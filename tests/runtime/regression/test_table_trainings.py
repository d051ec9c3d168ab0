"""The trainings of Table I: which folder is whose, what goes on, and what counts as ended."""

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
    limits,
    limits_as_of,
    table_training,
    train_arguments,
    trained,
)
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.training.run.run import POLICY, RECORD, write_run
from tltl_runtime.training.run.settings import read_settings
from tltlc.core.record import replace

STEPS = 10**6
TO = ("--steps", "1000000")
BOTH: tuple[Model, ...] = ("ours", "imitation")


def training(folder: Path, model: Model = "ours", minutes: float = 60.0) -> TableTraining:
    return table_training(folder, "cover_and_hide", model, Limits(STEPS, minutes))


def begun(made: TableTraining, minutes: float, *, seconds: float | None = None, end: str = "minutes") -> None:
    """Have a training in its folder, which has ended after ``seconds`` unless they are None."""
    method = "imitation" if made.imitates else "automaton"
    write_run(run_in(made.folder, method=method, stop__minutes=minutes, stop__steps=STEPS))
    write_policy(made.folder / POLICY, policy_of(card_of()))
    if seconds is not None:
        imitated = {"cloned": 50} if made.imitates else None
        record = {"end": end, "steps": 1000, "seconds": seconds, "imitated": imitated}
        (made.folder / RECORD).write_text(json.dumps(record), encoding="utf-8")


def test_each_level_and_model_has_a_folder_of_its_own(tmp_path: Path) -> None:
    names = [
        table_training(tmp_path, level, model, Limits(STEPS, 60.0)).folder.name
        for level in ("navigation", "cover_and_hide")
        for model in BOTH
    ]
    assert len(set(names)) == 4
    assert [name.rpartition("-")[0] for name in names] == [
        "navigation-ours",
        "navigation-imitation",
        "cover_and_hide-ours",
        "cover_and_hide-imitation",
    ]
    assert training(tmp_path).folder == training(tmp_path).folder


def test_what_an_agent_learns_from_is_another_training(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = {training(tmp_path).folder}
    with monkeypatch.context() as patched:
        patched.setattr(table_trainings, "load_level", lambda level, variant: load_level(level, "v1"))
        found.add(training(tmp_path).folder)
    with monkeypatch.context() as patched:
        spec = tmp_path / "bold.tltl"
        spec.write_text(
            "import stealth\nentity exit\nspec bold { limit 9 steps\n reach near(exit) }\n", encoding="utf-8"
        )
        patched.setattr(table_trainings, "spec_of", lambda level: str(spec))
        found.add(training(tmp_path).folder)
    with monkeypatch.context() as patched:
        settings = read_settings()
        slower = replace(settings, ppo=replace(settings.ppo, learning_rate=1e-5))
        patched.setattr(table_trainings, "read_settings", lambda: slower)
        found.add(training(tmp_path).folder)
    assert len(found) == 4


def test_the_limit_counts_for_who_is_cloned_for_a_share_of_it(tmp_path: Path) -> None:
    assert training(tmp_path, "ours", 1.0).folder == training(tmp_path, "ours", 60.0).folder
    assert training(tmp_path, "imitation", 1.0).folder != training(tmp_path, "imitation", 60.0).folder
    more = table_training(tmp_path, "cover_and_hide", "imitation", Limits(STEPS + 1, 60.0))
    assert more.folder != training(tmp_path, "imitation", 60.0).folder


def test_limits_are_those_that_the_others_had() -> None:
    assert limits(None) == Limits(read_settings().stop.steps, 60.0)
    assert limits(5.0) == Limits(read_settings().stop.steps, 5.0)
    for path in shipped_policies().values():
        card = read_policy(path).card
        stop = card.training["settings"]["stop"]
        assert limits_as_of(card, None) == Limits(stop["steps"], stop["minutes"])
        assert limits_as_of(card, 5.0) == Limits(stop["steps"], 5.0)


def test_a_new_training_is_begun(tmp_path: Path) -> None:
    made = training(tmp_path, "imitation", 2.5)
    assert trained(made) is None
    assert train_arguments(made) == [
        *("--level", "cover_and_hide", "--out", str(made.folder), "--method", "imitation", *TO, "--minutes", "2.5")
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
def test_a_training_is_over_that_has_met_its_spec_or_passed_the_limit(
    tmp_path: Path, limit: float, seconds: float | None, end: str, wanted: float, over: bool
) -> None:
    made = training(tmp_path, minutes=wanted)
    begun(made, limit, seconds=seconds, end=end)
    found = trained(made)
    assert (found is not None) == over
    if found:
        assert seconds is not None
        assert (found.policy, found.hours, found.cloned) == (made.folder / POLICY, seconds / 3600, None)
    else:
        assert train_arguments(made) == ["--resume", str(made.folder), *TO, "--minutes", f"{wanted:g}"]


@pytest.mark.parametrize(("limit", "wanted", "goes_on_to"), [(60.0, 10.0, "60"), (0.0, 10.0, "0"), (5.0, 0.0, "0")])
def test_one_that_was_broken_off_goes_on_to_the_greater_limit(
    tmp_path: Path, limit: float, wanted: float, goes_on_to: str
) -> None:
    made = training(tmp_path, minutes=wanted)
    begun(made, limit)
    assert train_arguments(made) == ["--resume", str(made.folder), *TO, "--minutes", goes_on_to]


def test_of_who_imitates_it_is_told_in_what_share_of_its_steps_it_was_cloned(tmp_path: Path) -> None:
    made = training(tmp_path, "imitation")
    begun(made, 60.0, seconds=3601.0)
    found = trained(made)
    assert found is not None and found.cloned == 0.05
