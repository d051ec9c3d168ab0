"""Checkpoints: all that a training needs to go on, in a file that is there as a whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from shlex import quote
from typing import Any, Final

import torch
from torch import Tensor

from tltl_runtime.support.record_json import RecordJsonError, from_json
from tltl_runtime.training.exploration.search import Searched
from tltl_runtime.training.ppo.windows import Score
from tltl_runtime.training.run.report import StopReason
from tltl_runtime.training.run.run import resume_command
from tltl_runtime.training.run.settings import Stop
from tltl_runtime.training.run.torch_archive import TorchArchiveError, read_torch
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import read_bytes
from tltlc.io.limits import CHECKPOINT
from tltlc.io.resources import bounded
from tltlc.io.writing import write_file

FORMAT: Final = "tltl-checkpoint"
VERSION: Final = 5
_MOST: Final = 2**53
"""The largest number of steps or seconds that a checkpoint may hold: larger ones are not exact as floats."""


@record
class Best:
    """The policy that is kept: its score, the actor's weights by name, and the steps after which it had them."""

    score: Score
    actor: Mapping[str, Tensor]
    steps: int


@record
class Checkpoint:
    """A training after iteration number ``iteration``: ``steps`` and ``seconds`` are those of all iterations.

    ``run`` is :func:`~tltl_runtime.training.run.run.identity` of what is trained, ``searched`` what the search before
    it
    found, ``replayed`` the decisions that were played again.  ``algorithm`` is what rsl-rl's algorithm saves;
    ``processes`` holds what each process has for itself: the states of torch's generators of random numbers by device,
    and that of its :class:`~tltl_runtime.training.exploration.reverse_curriculum.Restarts`; ``window`` and
    ``unbroken`` are those of
    :class:`~tltl_runtime.training.ppo.windows.Windows`, ``standstill`` what its ``Standstill`` is made of, and ``met``
    says
    whether the best policy has met the spec in them and in fresh episodes.
    """

    run: Mapping[str, str]
    iteration: int
    losses: Mapping[str, float]
    steps: int
    seconds: float
    replayed: int
    searched: Searched | None
    algorithm: Mapping[str, Any]
    processes: tuple[Mapping[str, Tensor], ...]
    window: tuple[tuple[bool, float, int, int, bool], ...]
    unbroken: int
    best: Best | None
    met: bool
    standstill: tuple[float, int]

    def reason(self, stop: Stop) -> StopReason | None:
        """Why a training with these limits is over, if it is."""
        return "met" if self.met else stop.reached(self.steps, self.seconds)

    @property
    def weights(self) -> Mapping[str, Tensor]:
        """Those of the best actor, by name, or of the last one where none is the best yet."""
        last: Mapping[str, Tensor] = self.algorithm["actor_state_dict"]
        return self.best.actor if self.best else last


_RECORDS: Final[Mapping[str, Any]] = {"best": Best, "searched": Searched}
"""The fields that are records themselves, which torch would not read again."""
_FIELDS: Final[tuple[str, ...]] = Checkpoint.__match_args__


def write_checkpoint(path: Path, checkpoint: Checkpoint) -> None:
    """Write a checkpoint; a failure, of the power too, leaves the older one.  Raises TltlError, TLT0005."""
    content: dict[str, Any] = {name: getattr(checkpoint, name) for name in _FIELDS}
    for name, kind in _RECORDS.items():
        if made := content[name]:
            content[name] = {field: getattr(made, field) for field in kind.__match_args__}
    data = BytesIO()
    torch.save({"format": FORMAT, "version": VERSION, **content}, data)
    write_file(path, data.getvalue(), "make room there, and go on with --resume", durable=True, over_inputs=True)


@bounded()
def read_checkpoint(path: Path, run: Mapping[str, str] | None = None) -> Checkpoint | None:
    """The checkpoint in a file, None where there is no such file; nothing in it is executed.

    ``run`` is the identity of the training that it must be of, None: of any.

    Raises:
        TltlError: TLT0001 it cannot be read; TLT0864 it is none, is damaged, is of another version, or of another
            training than ``run``; TLT0868, of ``run`` on another level; TLT0922, of ``run`` with other demonstrations.
    """
    if not path.exists():
        return None
    data = read_bytes(path, str(path), CHECKPOINT.size)
    if len(data) > CHECKPOINT.size:
        raise damaged(path, f"it is larger than {CHECKPOINT.size >> 20} MiB")
    content = _content(data, path)
    if type(content.get("version")) is not int or content["version"] != VERSION:
        raise _other_version(path, content.get("version"))
    try:
        checkpoint = _made(content)
        _check_figures(checkpoint)
    except KeyError as error:
        raise damaged(path, f"it lacks a part: {error}") from None
    except (RecordJsonError, RecursionError) as error:
        raise damaged(path, str(error) or "it is nested too deeply") from None
    if run is not None:
        _check_run(path, checkpoint.run, run)
    return checkpoint


def copied(value: Any) -> Any:
    """The same numbers in memory of their own, so that what goes on learning changes them no more."""
    if isinstance(value, Tensor):
        return value.detach().clone()
    if isinstance(value, Mapping):
        return {name: copied(each) for name, each in value.items()}
    return [copied(each) for each in value] if isinstance(value, list) else value


def _content(data: bytes, path: Path) -> Mapping[str, Any]:
    """The content of a checkpoint's file; error TLT0864 where it is not one."""
    try:
        content = read_torch(data)
    except TorchArchiveError as error:
        raise damaged(path, str(error)) from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise damaged(path, "it is no checkpoint of a training")
    return content


def _made(content: Mapping[str, Any]) -> Checkpoint:
    """The checkpoint of what torch has read; raises KeyError and RecordJsonError for what is not as it must be."""
    processes, algorithm = content["processes"], _object(content["algorithm"], "algorithm")
    if not isinstance(processes, (tuple, list)) or not processes:
        raise RecordJsonError("`processes` is no list, or is empty")
    _tensors(algorithm["actor_state_dict"], "algorithm.actor_state_dict")
    tensors = {
        "algorithm": algorithm,
        "best": None if content["best"] is None else _best(_object(content["best"], "best")),
        "processes": tuple(_tensors(each, "processes") for each in processes),
    }
    plain = {name: _lists(content[name]) for name in _FIELDS if name not in tensors}
    return from_json(Checkpoint, plain, "it", **tensors)


def _check_figures(checkpoint: Checkpoint) -> None:
    """Raise RecordJsonError for counts and times that no training has: below 0, or beyond all bounds."""
    best, searched, (rate, since) = checkpoint.best, checkpoint.searched, checkpoint.standstill
    names = ("iteration", "steps", "seconds", "replayed", "unbroken")
    _check_counts({f"it.{name}": getattr(checkpoint, name) for name in names})
    _check_counts({"it.standstill[1]": since}, checkpoint.steps)
    if not 0.0 <= rate <= 1.0:
        raise RecordJsonError(f"`it.standstill[0]` is {rate!r:.60}, and a number from 0 to 1 was expected")
    for index, (_, _, steps, state, _) in enumerate(checkpoint.window):
        _check_counts({f"it.window[{index}][2]": steps, f"it.window[{index}][3]": state})
    if best:
        _check_counts({"best.steps": best.steps}, checkpoint.steps)
    if searched:
        found = ("steps", "replayed", "seconds", "places")
        _check_counts({f"it.searched.{name}": getattr(searched, name) for name in found})
        _check_counts({f"it.searched.lengths[{index}]": each for index, each in enumerate(searched.lengths)})


def _check_counts(counts: Mapping[str, float], most: float = _MOST) -> None:
    for where, value in counts.items():
        if not 0 <= value <= most:
            raise RecordJsonError(f"`{where}` is {value!r:.60}, and a number from 0 to {most:,} was expected")


def _best(content: Mapping[str, Any]) -> Best:
    plain = {name: _lists(content[name]) for name in ("score", "steps")}
    return from_json(Best, plain, "best", actor=_tensors(content["actor"], "best.actor"))


def _object(value: object, where: str) -> Mapping[str, Any]:
    if isinstance(value, dict):
        return value
    raise RecordJsonError(f"`{where}` is no object")


def _tensors(value: object, where: str) -> Mapping[str, Tensor]:
    """Tensors by name; raises RecordJsonError for anything else."""
    if isinstance(value, Mapping) and all(type(k) is str and isinstance(v, Tensor) for k, v in value.items()):
        return value
    raise RecordJsonError(f"`{where}` holds no tensors")


def _lists(value: object) -> object:
    """Plain values with lists for tuples, as JSON has them."""
    if isinstance(value, dict):
        return {name: _lists(each) for name, each in value.items()}
    return [_lists(each) for each in value] if isinstance(value, (tuple, list)) else value


def _check_run(path: Path, found: Mapping[str, str], wanted: Mapping[str, str]) -> None:
    """TLT0864 where a checkpoint is of another training, and what differs; TLT0868 where the level alone does, TLT0922
    where the demonstrations do.
    """
    other = [name for name in wanted if found.get(name) != wanted[name]]
    if other == ["level"]:
        raise level_changed(path.parent)
    if other == ["demonstrations"]:
        raise _demonstrations_changed(path.parent)
    if other:
        raise damaged(path, f"it is of another training: another {' and another '.join(map(_called, other))}")


def damaged(path: Path, why: str) -> TltlError:
    """TLT0864: a checkpoint is damaged, or does not fit what is trained; ``why`` says how."""
    help_ = "put back a copy of it, or move it away: the training then begins anew"
    return TltlError([Diagnostic("TLT0864", f"`{path}` cannot be resumed from: {why}", help=help_)])


def level_changed(folder: Path) -> TltlError:
    """TLT0868: the level is another now than the one that the training in ``folder`` began on."""
    help_ = (
        f"put it back and go on by `{resume_command(folder)}`, or train on the level as it is now: anew, or by "
        f"`tltlc train --from {quote(str(folder))}` from what was learned"
    )
    title = f"the level has changed since the training in `{folder}` began"
    return TltlError([Diagnostic("TLT0868", title, help=help_)])


def _demonstrations_changed(folder: Path) -> TltlError:
    again = resume_command(folder)
    help_ = f"put them back and go on by `{again}`, or say where they are now: `{again} --demonstrations DIR`"
    title = f"the demonstrations are others than those that the training in `{folder}` began with"
    return TltlError([Diagnostic("TLT0922", title, help=help_)])


def _called(part: str) -> str:
    return "network, senses or settings" if part == "settings" else part


def _other_version(path: Path, version: object) -> TltlError:
    folder = quote(str(path.parent))
    title = f"`{path}` cannot be resumed from: it was written by another version of tltlc"
    title += f" (its own is {version!r:.20}, and only {VERSION} can be read)"
    help_ = f"go on with that version, or train anew; `tltlc evaluate {folder}` plays what was learned"
    return TltlError([Diagnostic("TLT0864", title, help=help_)])
