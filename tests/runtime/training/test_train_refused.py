"""Trainings that are rejected, and their files afterwards."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import torch

from tests.runtime.training.runs import checkpoint_of, run_in
from tests.runtime.training.test_settings import compare
from tltl_runtime.training.files.checkpoint import VERSION, write_checkpoint
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import (
    CHECKPOINT,
    RUN,
    TrainingRun,
    read_run,
)
from tltl_runtime.training.files.training_lock import lock_training
from tltl_runtime.training.run.train import train
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError


@pytest.fixture(name="copy")
def _copy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, whole: tuple[TrainingRun, list[TrainingReport]]
) -> Iterator[TrainingRun]:
    """A copy of the whole training, in the folder `run`."""
    shutil.copytree(whole[0].folder, tmp_path / "run")
    monkeypatch.chdir(tmp_path)
    return replace(whole[0], folder=Path("run"))


def _torn(run: TrainingRun) -> TrainingRun:
    data = (run.folder / CHECKPOINT).read_bytes()
    (run.folder / CHECKPOINT).write_bytes(data[: len(data) // 2])
    return run


def _flipped(run: TrainingRun) -> TrainingRun:
    data = bytearray((run.folder / CHECKPOINT).read_bytes())
    data[len(data) // 2] ^= 1
    (run.folder / CHECKPOINT).write_bytes(data)
    return run


class _Harmful:
    def __reduce__(self) -> tuple[Callable[[str], object], tuple[str]]:
        return Path, ("harm",)


def _harmful(run: TrainingRun) -> TrainingRun:
    torch.save({"format": "tltl-checkpoint", "version": 1, "run": _Harmful()}, run.folder / CHECKPOINT)
    return run


def _other_seed(run: TrainingRun) -> TrainingRun:
    return replace(run, seed=4)


def _other_settings(run: TrainingRun) -> TrainingRun:
    """Write a checkpoint with another hash of the settings, as another version writes it."""
    content = torch.load(run.folder / CHECKPOINT, weights_only=True)
    torch.save({**content, "run": {**content["run"], "settings": "0" * 64}}, run.folder / CHECKPOINT)
    return run


def _newer(run: TrainingRun) -> TrainingRun:
    content = torch.load(run.folder / CHECKPOINT, weights_only=True)
    torch.save({**content, "version": VERSION + 1}, run.folder / CHECKPOINT)
    return run


def _partial(run: TrainingRun) -> TrainingRun:
    content = torch.load(run.folder / CHECKPOINT, weights_only=True)
    del content["window"]
    torch.save(content, run.folder / CHECKPOINT)
    return run


def _wider(run: TrainingRun) -> TrainingRun:
    """Write a checkpoint with weights of another shape, as another network has them."""
    content = torch.load(run.folder / CHECKPOINT, weights_only=True)
    weights = content["algorithm"]["actor_state_dict"]
    weights |= {name: torch.zeros(3, 5) for name in list(weights)[:1]}
    torch.save(content, run.folder / CHECKPOINT)
    return run


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("TLT0864", _torn),
        ("TLT0864_flipped", _flipped),
        ("TLT0864_harmful", _harmful),
        ("TLT0864_seed", _other_seed),
        ("TLT0864_settings", _other_settings),
        ("TLT0864_newer", _newer),
        ("TLT0864_partial", _partial),
        ("TLT0864_shape", _wider),
    ],
)
def test_a_checkpoint_that_does_not_fit_is_rejected(
    copy: TrainingRun, name: str, change: Callable[[TrainingRun], TrainingRun]
) -> None:
    with pytest.raises(TltlError) as caught:
        next(train(change(copy), resume=True))
    compare(name, caught.value)


def test_a_new_training_does_not_overwrite_another_one(copy: TrainingRun) -> None:
    with pytest.raises(TltlError) as caught:
        next(train(copy))
    compare("TLT0867", caught.value)


def test_a_folder_is_used_by_one_training_at_a_time(copy: TrainingRun) -> None:
    with lock_training(copy.folder), pytest.raises(TltlError) as caught:
        next(train(copy, resume=True))
    compare("TLT0865", caught.value)


def test_an_unwritable_folder_is_reported_on_resume(copy: TrainingRun) -> None:
    (copy.folder / ".lock").unlink()
    (copy.folder / ".lock").mkdir()
    with pytest.raises(TltlError) as caught:
        next(train(copy, resume=True))
    compare("TLT0005_resumed", caught.value)


def _with_ppo(document: Any, **changes: Any) -> Any:
    """The description with changed settings of PPO; None removes a setting."""
    ppo = {name: value for name, value in {**document["settings"]["ppo"], **changes}.items() if value is not None}
    return {**document, "settings": {**document["settings"], "ppo": ppo}}


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("TLT0863", lambda document: None),
        ("TLT0863_other", lambda document: []),
        ("TLT0863_key", lambda document: {name: value for name, value in document.items() if name != "seed"}),
        ("TLT0863_value", lambda document: _with_ppo(document, epochs="three")),
        ("TLT0863_older", lambda document: _with_ppo(document, entropy_schedule=None)),
        ("TLT0863_gone", lambda document: _with_ppo(document, momentum=0.9)),
    ],
)
def test_an_invalid_description_is_rejected(copy: TrainingRun, name: str, change: Callable[[Any], Any]) -> None:
    path = copy.folder / RUN
    changed = change(json.loads(path.read_text()))
    path.write_text("{" if changed is None else json.dumps(changed))
    with pytest.raises(TltlError) as caught:
        read_run(copy.folder)
    compare(name, caught.value)


@pytest.mark.parametrize(
    ("artefact", "reason"),
    [
        (None, "TLT0601: `run/run.json/artefact` is JSON, but not an artefact"),
        ({"format": "fspa", "version": 9}, "TLT0602: this artefact has version 9"),
        ({"format": "fspa", "version": float("inf")}, "TLT0601: .* is not JSON: Infinity is not a finite number"),
    ],
)
def test_an_invalid_automaton_in_the_description_is_rejected(copy: TrainingRun, artefact: object, reason: str) -> None:
    path = copy.folder / RUN
    path.write_text(json.dumps({**json.loads(path.read_text()), "artefact": artefact}))
    with pytest.raises(TltlError, match=reason):
        read_run(copy.folder)


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("TLT0862_module", {"classes__runner": "nowhere:Runner"}),
        ("TLT0862_class", {"classes__algorithm": "MLPModel"}),
        ("TLT0862_device", {"device": "cuda:31"}),
    ],
)
def test_missing_classes_and_devices_are_reported_before_anything_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, changes: dict[str, Any]
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(TltlError) as caught:
        next(train(run_in(Path("run"), **changes)))
    compare(name, caught.value)
    assert not Path("run", RUN).exists()


@pytest.mark.parametrize(("name", "device"), [("TLT0862_one_device", "cuda:0"), ("TLT0862_devices", "cuda")])
def test_each_process_of_torchrun_needs_its_own_device(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, device: str
) -> None:
    for variable, value in (("WORLD_SIZE", 128), ("LOCAL_WORLD_SIZE", 64), ("RANK", 0), ("LOCAL_RANK", 0)):
        monkeypatch.setenv(variable, str(value))
    with pytest.raises(TltlError) as caught:
        next(train(run_in(tmp_path / "run", device=device)))
    if not torch.cuda.is_available():
        compare(name, caught.value)
    assert not (tmp_path / "run").exists()


def test_a_diverging_training_ends_before_its_checkpoint_is_overwritten(folder: Path) -> None:
    run = run_in(folder / "diverged", classes__runner="tests.runtime.training.runs:Diverging")
    with pytest.raises(TltlError) as caught:
        list(train(run))
    compare("TLT0866", caught.value)
    assert checkpoint_of(run).iteration == 1


def test_nan_in_an_observation_ends_the_training(folder: Path) -> None:
    run = run_in(folder / "failing", classes__runner="tests.runtime.training.runs:Failing")
    with pytest.raises(TltlError) as caught:
        list(train(run))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0854"
    assert diagnostic.title.startswith("iteration 2: The observation group 'entities'")
    assert checkpoint_of(run).iteration == 1


def test_a_policy_with_too_large_weights_is_rejected(folder: Path) -> None:
    run = run_in(folder / "large", classes__runner="tests.runtime.training.runs:Growing")
    with pytest.raises(TltlError) as caught:
        list(train(run))
    compare("TLT0866_weight", caught.value)
    assert checkpoint_of(run).iteration < 3


@pytest.mark.skipif(sys.platform == "win32", reason="limits the size of files as other systems do")
def test_a_failed_write_keeps_the_older_checkpoint(copy: TrainingRun) -> None:
    import resource

    path = copy.folder / CHECKPOINT
    before = path.read_bytes()
    checkpoint = checkpoint_of(copy)
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) // 2, hard))
    try:
        with pytest.raises(TltlError, match="TLT0005"):
            write_checkpoint(path, checkpoint)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_bytes() == before
    assert not list(copy.folder.glob("*.tmp"))
