"""Checkpoints: everything that a training needs to resume, in one file that is written atomically."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from shlex import quote
from typing import Any, Final

import torch
from torch import Tensor

from tltl_runtime.support.record_json import RecordJsonError, from_json
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.files.report import Score, StopReason
from tltl_runtime.training.files.run_file import resume_command
from tltl_runtime.training.files.settings import Stop
from tltl_runtime.training.files.torch_archive import TorchArchiveError, read_torch
from tltlc.api import Diagnostic, TltlError, fileio, record

FORMAT: Final = "tltl-checkpoint"
VERSION: Final = 5
_MOST: Final = 2**53
"""The largest number of steps or seconds. Larger integers are not exact as floats."""


@record
class BestPolicy:
    """The best policy of a training so far, and its score.

    ``actor`` are the weights of its network, by name. The network had them after ``steps`` steps of
    the training.
    """

    score: Score
    actor: Mapping[str, Tensor]
    steps: int


@record
class Checkpoint:
    """The state of a training after iteration number ``iteration``.

    - ``run`` identifies the training by hashes of its level, its spec and its settings
      (:func:`~tltl_runtime.training.files.run_file.identity`).
    - ``losses`` are the losses of that iteration.
    - ``steps`` and ``seconds`` are totals over all iterations; ``replayed`` counts replayed
      decisions.
    - ``searched`` is the progress of the searches so far.
    - ``algorithm`` is what rsl-rl's algorithm saves.
    - ``processes`` has the state of each process, by rank: the states of torch's random generators
      by device, and the arrays of its
      :class:`~tltl_runtime.training.exploration.reverse_curriculum.ReverseCurriculum`.
    - ``window`` describes the last episodes. ``unbroken`` is the number of successive episodes, up
      to the last one, that met the spec. Both are arguments of
      :meth:`tltl_runtime.training.ppo.recent_episodes.RecentEpisodes.load`.
    - ``standstill`` has the greatest pass rate so far and the step at which it was reached, as
      arguments of :class:`~tltl_runtime.training.ppo.recent_episodes.Standstill`.
    - ``best`` is the best policy so far; None if there is none yet. ``met`` says whether this
      policy has met the spec in all the episodes that
      :class:`~tltl_runtime.training.files.settings.Stop` demands.
    """

    run: Mapping[str, str]
    iteration: int
    losses: Mapping[str, float]
    steps: int
    seconds: float
    replayed: int
    searched: SearchProgress | None
    algorithm: Mapping[str, Any]
    processes: tuple[Mapping[str, Tensor], ...]
    window: tuple[tuple[bool, float, int, int, bool], ...]
    unbroken: int
    best: BestPolicy | None
    met: bool
    standstill: tuple[float, int]

    def reason(self, stop: Stop) -> StopReason | None:
        """Return why a training with the limits of ``stop`` is over; None if it goes on."""
        return "met" if self.met else stop.reached_limit(self.steps, self.seconds)

    @property
    def weights(self) -> Mapping[str, Tensor]:
        """The weights of the best actor, by name; if there is none yet, those of the current actor."""
        last: Mapping[str, Tensor] = self.algorithm["actor_state_dict"]
        return self.best.actor if self.best else last


_RECORDS: Final[Mapping[str, Any]] = {"best": BestPolicy, "searched": SearchProgress}
"""The fields of a checkpoint that are records, and their classes.

They are saved as dicts, because torch refuses to load classes that it does not know.
"""
_FIELDS: Final[tuple[str, ...]] = Checkpoint.__match_args__


def write_checkpoint(path: Path, checkpoint: Checkpoint) -> None:
    """Write a checkpoint to a file. If writing fails, even by a power cut, the older file stays.

    Raises TltlError, TLT0005, if the file cannot be written.
    """
    content: dict[str, Any] = {name: getattr(checkpoint, name) for name in _FIELDS}
    for name, kind in _RECORDS.items():
        if value := content[name]:
            content[name] = {field: getattr(value, field) for field in kind.__match_args__}
    data = BytesIO()
    torch.save({"format": FORMAT, "version": VERSION, **content}, data)
    fileio.write_file(
        path, data.getvalue(), "make room there, and continue with --resume", durable=True, over_inputs=True
    )


@fileio.resource_limits()
def read_checkpoint(path: Path, run: Mapping[str, str] | None = None) -> Checkpoint | None:
    """Read a checkpoint; return None if there is no such file. Nothing in the file is executed.

    ``run`` identifies the expected training
    (:func:`~tltl_runtime.training.files.run_file.identity`); if it is None, a checkpoint of any
    training is accepted.

    Raises:
        TltlError: TLT0001, the file cannot be read; TLT0864, it is not a checkpoint, is damaged,
            has another version, or is of another training than ``run``; TLT0868, only the level
            differs from that of ``run``; TLT0922, only the demonstrations differ.
    """
    if not path.exists():
        return None
    data = fileio.read_bytes(path, str(path), fileio.limits.CHECKPOINT.size)
    if len(data) > fileio.limits.CHECKPOINT.size:
        raise checkpoint_error(path, f"it is larger than {fileio.limits.CHECKPOINT.size >> 20} MiB")
    content = _content(data, path)
    if type(content.get("version")) is not int or content["version"] != VERSION:
        raise _version_error(path, content.get("version"))
    try:
        checkpoint = _checkpoint(content)
        _check_figures(checkpoint)
    except KeyError as error:
        raise checkpoint_error(path, f"a part is missing: {error}") from None
    except (RecordJsonError, RecursionError) as error:
        raise checkpoint_error(path, str(error) or "it is nested too deeply") from None
    if run is not None:
        _check_run(path, checkpoint.run, run)
    return checkpoint


def deep_copy(value: Any) -> Any:
    """Return a deep copy of nested mappings, lists and tensors, so that learning cannot change it.

    Tensors in the copy have no gradients. Values of other types are not copied.
    """
    if isinstance(value, Tensor):
        return value.detach().clone()
    if isinstance(value, Mapping):
        return {name: deep_copy(item) for name, item in value.items()}
    return [deep_copy(item) for item in value] if isinstance(value, list) else value


def _content(data: bytes, path: Path) -> Mapping[str, Any]:
    """Return the content of a checkpoint file.

    Raises TltlError, TLT0864, if the file is something else.
    """
    try:
        content = read_torch(data)
    except TorchArchiveError as error:
        raise checkpoint_error(path, str(error)) from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise checkpoint_error(path, "it is not a checkpoint of a training")
    return content


def _checkpoint(content: Mapping[str, Any]) -> Checkpoint:
    """Make a checkpoint from the content of its file.

    Raises KeyError or RecordJsonError if a part is missing or invalid.
    """
    processes, algorithm = content["processes"], _object(content["algorithm"], "algorithm")
    if not isinstance(processes, (tuple, list)) or not processes:
        raise RecordJsonError("`processes` is not a list, or is empty")
    _tensors(algorithm["actor_state_dict"], "algorithm.actor_state_dict")
    tensors = {
        "algorithm": algorithm,
        "best": None if content["best"] is None else _best_policy(_object(content["best"], "best")),
        "processes": tuple(_tensors(process, "processes") for process in processes),
    }
    plain = {name: _lists(content[name]) for name in _FIELDS if name not in tensors}
    return from_json(Checkpoint, plain, "it", **tensors)


def _check_figures(checkpoint: Checkpoint) -> None:
    """Raise RecordJsonError if a count, a time or a pass rate is below 0 or too large."""
    best, searched, (rate, since) = checkpoint.best, checkpoint.searched, checkpoint.standstill
    names = ("iteration", "steps", "seconds", "replayed", "unbroken")
    _check_counts({f"it.{name}": getattr(checkpoint, name) for name in names})
    _check_counts({"it.standstill[1]": since}, checkpoint.steps)
    if not 0.0 <= rate <= 1.0:
        raise RecordJsonError(f"`it.standstill[0]` is {rate!r:.60}, but a number from 0 to 1 was expected")
    for index, (_, _, steps, state, _) in enumerate(checkpoint.window):
        _check_counts({f"it.window[{index}][2]": steps, f"it.window[{index}][3]": state})
    if best:
        _check_counts({"best.steps": best.steps}, checkpoint.steps)
    if searched:
        counts = ("steps", "replayed", "seconds", "places", "dropped")
        _check_counts({f"it.searched.{name}": getattr(searched, name) for name in counts})
        _check_counts({f"it.searched.lengths[{index}]": length for index, length in enumerate(searched.lengths)})


def _check_counts(counts: Mapping[str, float], greatest: float = _MOST) -> None:
    for where, value in counts.items():
        if not 0 <= value <= greatest:
            raise RecordJsonError(f"`{where}` is {value!r:.60}, but a number from 0 to {greatest:,} was expected")


def _best_policy(content: Mapping[str, Any]) -> BestPolicy:
    plain = {name: _lists(content[name]) for name in ("score", "steps")}
    return from_json(BestPolicy, plain, "best", actor=_tensors(content["actor"], "best.actor"))


def _object(value: object, where: str) -> Mapping[str, Any]:
    if isinstance(value, dict):
        return value
    raise RecordJsonError(f"`{where}` is not an object")


def _tensors(value: object, where: str) -> Mapping[str, Tensor]:
    """Return ``value`` if it maps names to tensors. Raises RecordJsonError otherwise."""
    if isinstance(value, Mapping) and all(type(k) is str and isinstance(v, Tensor) for k, v in value.items()):
        return value
    raise RecordJsonError(f"`{where}` must map names to tensors")


def _lists(value: object) -> object:
    """Return nested plain values with every tuple replaced by a list, as in JSON."""
    if isinstance(value, dict):
        return {name: _lists(item) for name, item in value.items()}
    return [_lists(item) for item in value] if isinstance(value, (tuple, list)) else value


def _check_run(path: Path, actual: Mapping[str, str], expected: Mapping[str, str]) -> None:
    """Check that a checkpoint is of the ``expected`` training.

    ``actual`` is what the checkpoint says of its training: hashes and the seed, by name. Raises
    TLT0868 if only the level differs, TLT0922 if only the demonstrations differ, and TLT0864 with
    all differences otherwise.
    """
    different = [name for name in expected if actual.get(name) != expected[name]]
    if different == ["level"]:
        raise level_changed_error(path.parent)
    if different == ["demonstrations"]:
        raise _demonstrations_changed_error(path.parent)
    if different:
        raise checkpoint_error(
            path, f"it is of another training: another {' and another '.join(map(_part_name, different))}"
        )


def checkpoint_error(path: Path, reason: str) -> TltlError:
    """Return error TLT0864: the checkpoint at ``path`` cannot be used, for ``reason``."""
    help_ = "put back a copy of it, or move it away: --resume then starts the training from its beginning"
    return TltlError([Diagnostic("TLT0864", f"cannot use the checkpoint `{path}`: {reason}", help=help_)])


def level_changed_error(folder: Path) -> TltlError:
    """Return error TLT0868: the level has changed since the training in ``folder`` began."""
    help_ = (
        f"put it back and continue with `{resume_command(folder)}`, or train on the level as it is now: from the "
        f"beginning, or with `tltlc train --from {quote(str(folder))}` from what was learned"
    )
    title = f"the level has changed since the training in `{folder}` began"
    return TltlError([Diagnostic("TLT0868", title, help=help_)])


def _demonstrations_changed_error(folder: Path) -> TltlError:
    again = resume_command(folder)
    help_ = f"put them back and continue with `{again}`, or say where they are now: `{again} --demonstrations DIR`"
    title = f"the demonstrations are not those that the training in `{folder}` began with"
    return TltlError([Diagnostic("TLT0922", title, help=help_)])


def _part_name(part: str) -> str:
    return "network, sensors or settings" if part == "settings" else part


def _version_error(path: Path, version: object) -> TltlError:
    folder = quote(str(path.parent))
    title = f"cannot use the checkpoint `{path}`: it was written by another version of tltlc"
    title += f" (it has version {version!r:.20} of the format, and only {VERSION} can be read)"
    help_ = f"continue with that version, or train again; `tltlc evaluate {folder}` plays what was learned"
    return TltlError([Diagnostic("TLT0864", title, help=help_)])
