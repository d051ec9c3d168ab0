"""Checkpoints with one changed value: a training resumes from them, or rejects them with an error code."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import pytest
import torch
from torch import Tensor

from tests.runtime.training.runs import run_in
from tltl_runtime.training.files.checkpoint import read_checkpoint
from tltl_runtime.training.files.run_file import CHECKPOINT, TrainingRun
from tltl_runtime.training.run import train as training
from tltl_runtime.training.run.preparation import make_environments
from tltl_runtime.training.run.spaces import training_spaces
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

Content = dict[Any, Any]
Path_ = tuple[Any, ...]
"""The keys on the path to a value in a checkpoint."""

SPEC: Final = """\
signal stamina: ratio
predicate tired in [-1, 1] = 0.98 - stamina
spec get_tired { limit 3 steps  require eventually tired }
"""
"""With random actions some episodes meet the spec, and others fail."""
MISSING: Final = object()
PARTS: Final = 4
"""A change is tried with every fourth value, so that each value has a quarter of the changes."""
REPLACEMENTS: Final[Mapping[str, Callable[[Any], object]]] = {
    "missing": lambda value: MISSING,
    "None": lambda value: None,
    "a number": lambda value: 3,
    "a number below 0": lambda value: -5,
    "a huge number": lambda value: 10**30,
    "a large number": lambda value: 2**62,
    "a fraction": lambda value: 0.5,
    "no number": lambda value: float("nan"),
    "infinite": lambda value: float("inf"),
    "a text": lambda value: "x",
    "true": lambda value: True,
    "an empty list": lambda value: [],
    "a list": lambda value: [0, 1],
    "an empty table": lambda value: {},
    "a table": lambda value: {"x": {"y": [1]}},
    "an empty tensor": lambda value: torch.zeros(0),
    "a tensor of another shape": lambda value: torch.zeros(3, 2),
    "a tensor of whole numbers": lambda value: _like(value).long() if isinstance(value, Tensor) else torch.tensor(1),
    "a tensor of other numbers": lambda value: _like(value).double(),
    "a tensor of no numbers": lambda value: torch.full_like(_like(value).float(), float("nan")),
    "a tensor of numbers below 0": lambda value: torch.full_like(_like(value), -1),
    "a tensor of large numbers": lambda value: torch.full_like(_like(value), 100),
    "a tensor of zeros": lambda value: torch.zeros_like(_like(value)),
    "a sparse tensor": lambda value: torch.zeros(2, 2).to_sparse(),
    "one value more": lambda value: _with_one_more(value),
}

_OPTIMIZER: Final = "algorithm", "optimizer_state_dict"
_GROUP: Final = *_OPTIMIZER, "param_groups", 0
_NUMBERS: Final = "a number below 0", "a large number", "a huge number", "no number"
CRASHING_CHANGES: Final[Mapping[Path_, tuple[str, ...]]] = {
    ("algorithm", "critic_state_dict"): ("missing", "None", "a number"),
    _OPTIMIZER: ("missing", "None", "a number", "an empty table", "one value more"),
    (*_OPTIMIZER, "param_groups"): ("None", "an empty list", "one value more"),
    (*_OPTIMIZER, "state"): ("None", "an empty table", "one value more"),
    (*_OPTIMIZER, "state", 0): ("None", "an empty table", "one value more"),
    (*_OPTIMIZER, "state", 0, "exp_avg"): ("None", "a tensor of another shape", "a tensor of no numbers"),
    (*_OPTIMIZER, "state", 0, "exp_avg_sq"): ("a tensor of numbers below 0", "a sparse tensor"),
    (*_OPTIMIZER, "state", 0, "step"): ("a tensor of numbers below 0", "a tensor of no numbers", "a number"),
    (*_GROUP, "lr"): ("a text", "no number", "a tensor of zeros", "a number below 0"),
    (*_GROUP, "betas"): ("None", "one value more"),
    (*_GROUP, "betas", 1): ("a number", "a large number"),
    (*_GROUP, "amsgrad"): ("None", "true"),
    (*_GROUP, "capturable"): ("true",),
    (*_GROUP, "params", 1): ("a tensor of another shape", "a huge number"),
    ("algorithm", "actor_state_dict", "mlp.0.bias"): ("a tensor of no numbers", "a sparse tensor"),
    ("best", "actor", "mlp.0.bias"): ("a tensor of no numbers",),
    ("processes",): ("None", "an empty list", "one value more"),
    ("processes", 0, "cpu"): ("a tensor of zeros", "an empty tensor", "a sparse tensor"),
    ("processes", 0, "failure_lengths"): ("a tensor of zeros", "a tensor of numbers below 0"),
    **{(name,): _NUMBERS for name in ("iteration", "steps", "seconds", "unbroken", "replayed")},
    **{("standstill", index): _NUMBERS for index in (0, 1)},
    **{("window", 0, index): _NUMBERS for index in (2, 3)},
}
"""Changes that once crashed a training, or silently changed its results."""


def _like(value: object) -> Tensor:
    return value if isinstance(value, Tensor) else torch.zeros(2)


def _with_one_more(value: Any) -> object:
    """A container with one more value, or a list of a value and itself."""
    if isinstance(value, dict):
        return value | {99: {"x": 1}}
    return [*value, None] if isinstance(value, (list, tuple)) else [value, value]


def values(content: object, path: Path_ = ()) -> Iterator[Path_]:
    """The paths of all values in a checkpoint, including tables and lists."""
    if path:
        yield path
    items = content.items() if isinstance(content, dict) else enumerate(content) if _is_list(content) else ()
    for key, value in items:
        yield from values(value, (*path, key))


def changed(content: Any, path: Path_, change: Callable[[Any], object]) -> Any:
    """The content with a changed value at a path."""
    if not path:
        return change(content)
    items = dict(content) if isinstance(content, dict) else dict(enumerate(content))
    items[path[0]] = changed(items[path[0]], path[1:], change)
    items = {key: value for key, value in items.items() if value is not MISSING}
    return items if isinstance(content, dict) else type(content)(items.values())


def _is_list(value: object) -> bool:
    return isinstance(value, (list, tuple))


@pytest.fixture(name="made", scope="module")
def _training_with_search(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[TrainingRun, Content]]:
    """A training with a search, and the content of its checkpoint, in which no part is empty.

    All trainings of this module share its environments, since starting processes for each is slow.
    """
    run = run_in(
        tmp_path_factory.mktemp("damaged") / "run",
        SPEC,
        exploration__ways=2,
        exploration__steps=200,
        exploration__imitation=1,
        stop__steps=192,
        stop__windows=1,
        stop__episodes=4,
        stop__confirmation=1000,
        checkpoint_s=1e9,
    )
    env = make_environments(run, training_spaces(run))
    close, env.close = env.close, lambda: None  # type: ignore[method-assign]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(training, "make_environments", lambda run, spaces, on_made: env)
        assert list(training.train(run))
        yield (
            replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, steps=10**9))),
            torch.load(run.folder / CHECKPOINT, weights_only=True),
        )
    close()


def goes_on(run: TrainingRun, content: Any, folder: Path) -> bool:
    """Whether a training resumes from a checkpoint with this content; if not, check that the rejection has a code."""
    shutil.copytree(run.folder, folder)
    run = replace(run, folder=folder)
    torch.save(content, folder / CHECKPOINT)
    before = (folder / CHECKPOINT).read_bytes()
    reports = training.train(run, resume=True)
    try:
        next(reports)
        reports.close()
        assert read_checkpoint(folder / CHECKPOINT)
        return True
    except TltlError as error:
        assert {diagnostic.code for diagnostic in error.diagnostics} <= {"TLT0864", "TLT0866", "TLT0868"}
        # A rejected checkpoint is not changed.
        assert error.diagnostics[0].code == "TLT0866" or (folder / CHECKPOINT).read_bytes() == before
        return False
    finally:
        shutil.rmtree(folder)


def test_no_part_of_the_checkpoint_is_empty(made: tuple[TrainingRun, Content], tmp_path: Path) -> None:
    run, content = made
    process = content["processes"][0]
    assert all(process[name].numel() for name in ("way_actions", "failure_actions", "rates"))
    assert content["window"]
    assert content["best"]
    assert content["searched"]["lengths"]
    assert goes_on(run, content, tmp_path / "copy")


def check(made: tuple[TrainingRun, Content], chosen: list[tuple[Path_, str]], folder: Path) -> None:
    run, content = made
    errors = []
    for number, (path, name) in enumerate(chosen):
        try:
            goes_on(run, changed(content, path, REPLACEMENTS[name]), folder / str(number))
        except Exception as error:
            errors.append(f"{'.'.join(map(str, path))}, {name}: {error!r:.200}")
    assert not errors, "\n".join(errors)


@pytest.mark.slow
def test_changes_that_once_crashed_are_rejected_or_harmless(made: tuple[TrainingRun, Content], tmp_path: Path) -> None:
    check(made, [(path, name) for path, names in CRASHING_CHANGES.items() for name in names], tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", REPLACEMENTS)
def test_changes_of_each_value_are_rejected_or_harmless(
    made: tuple[TrainingRun, Content], tmp_path: Path, name: str
) -> None:
    """Each value is changed in several ways, and each way is tried with a part of the values: all would take long."""
    first = list(REPLACEMENTS).index(name) % PARTS
    check(made, [(path, name) for path in [*values(made[1])][first::PARTS]], tmp_path)
