"""A training as it was asked for, and the file in its folder that keeps this: ``run.json``.

The names of the folder's other files stand here, too.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from shlex import quote
from typing import Any, Final

from tltl_runtime.policies.card import OBSERVATION
from tltl_runtime.policies.identity import level_hash, spec_hash
from tltl_runtime.stealth.level import Sensors
from tltl_runtime.stealth.levels.file import level_path, load_level
from tltl_runtime.stealth.levels.place import absolute_variant
from tltl_runtime.stealth.recordings.file import MAX_BYTES
from tltl_runtime.support.number_text import listed
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltl_runtime.training.imitation.demonstrations import recordings
from tltl_runtime.training.run.settings import Settings, read_settings
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import MAX_ARTEFACT_BYTES, read_bytes, read_source
from tltlc.io.json_text import loads
from tltlc.io.limits import ARTEFACT
from tltlc.io.writing import write_files
from tltlc.pipeline import read_artefact

RUN: Final = "run.json"
CHECKPOINT: Final = "checkpoint.pt"
POLICY: Final = "policy.safetensors"
RECORD: Final = "record.json"
CURVE: Final = "curve.png"
DEMONSTRATIONS: Final = "demonstrations"

MAY_CHANGE: Final = frozenset(
    {"device", "threads", "checkpoint_s", "rollout.workers", "rollout.pool", "stop.steps", "stop.minutes"}
)
"""Settings, as :func:`leaves` names them, that a training may be resumed with other values of."""
WRITABLE: Final = "see that there is room, and that you may write there; a new training may go elsewhere, with --out"
"""The advice where the folder of a training, be it new or resumed, cannot be written to."""

_FORMAT: Final = "tltl-run"
_VERSION: Final = 1
_MOST_NAMED: Final = 8
"""Of the trainings in a folder, as many are named."""


@record
class Initial:
    """A policy whose weights a training begins with: the ``path`` of its file, and what that was when it was read.

    ``weights`` is their SHA-256, in hexadecimal; ``level``, ``variant`` and ``level_hash`` are those of its card.
    """

    path: str
    weights: str
    level: str
    variant: str
    level_hash: str


@record
class Run:
    """What is trained, and the folder that keeps it.

    ``params`` are values of the params of ``fspa`` in SI units; ``level`` is what
    :func:`~tltl_runtime.stealth.levels.file.load_level` takes.  ``demonstrations`` is the folder of those that are
    imitated, None for the training's own, where the expert's are recorded.  ``initial`` is the policy whose weights the
    actor begins with, None where they are drawn.
    """

    folder: Path
    fspa: Fspa
    params: Mapping[str, float]
    level: str
    variant: str
    sensors: Sensors
    settings: Settings
    seed: int
    demonstrations: str | None = None
    initial: Initial | None = None


_PLAIN: Final[Mapping[str, Any]] = {
    "params": Mapping[str, float],
    "level": str,
    "variant": str,
    "sensors": Sensors,
    "settings": Settings,
    "seed": int,
    "demonstrations": str | None,
    "initial": Initial | None,
}
"""The fields that stand in the file as they are, and their types."""


def write_run(run: Run) -> None:
    """Write ``run.json`` into the folder, which is made where it is missing; raises TltlError, TLT0005."""
    (artefact,) = emit("json", run.fspa).values()
    # Whoever resumes it may stand in another folder.
    level = str(level_path(run.level).absolute()) if run.level.endswith(".toml") else run.level
    document = {
        "format": _FORMAT,
        "version": _VERSION,
        **{name: to_json(getattr(run, name)) for name in _PLAIN},
        "level": level,
        "variant": absolute_variant(run.variant),
        "demonstrations": run.demonstrations and str(Path(run.demonstrations).absolute()),
        "initial": run.initial and to_json(replace(run.initial, path=str(Path(run.initial.path).absolute()))),
        "level_hash": level_hash(load_level(run.level, run.variant)),
        "artefact": json.loads(artefact),
    }
    text = json.dumps(document, indent=1, ensure_ascii=False) + "\n"
    write_files(run.folder, {RUN: text}, WRITABLE, durable=True, over_inputs=True)


def read_run(folder: Path) -> Run:
    """The training in a folder.

    Raises:
        TltlError: TLT0001, its file cannot be read; TLT0863, there is none, or its file is no such.
    """
    if not (folder / RUN).exists():
        raise _no_training(folder)
    source, document = _document(folder)
    _check_settings(source, document)
    values = _values(source, document, tuple(_PLAIN))
    if "artefact" not in document:
        raise _unfit(source, "it lacks 'artefact'")
    artefact = json.dumps(document["artefact"])
    return Run(folder=folder, fspa=read_artefact(SourceFile(f"{source.name}/artefact", artefact)), **values)


def read_place(folder: Path) -> tuple[str, str]:
    """Level and variant of the training in a folder, whatever else has changed since; errors as of :func:`read_run`."""
    values = _values(*_document(folder), ("level", "variant"))
    return values["level"], values["variant"]


def read_level_hash(folder: Path) -> str | None:
    """The hash of the level that the training in a folder was begun on; errors as of :func:`read_run`."""
    found = _document(folder)[1].get("level_hash")
    return found if isinstance(found, str) else None


def _document(folder: Path) -> tuple[SourceFile, Mapping[str, Any]]:
    source = read_source(folder / RUN, max_bytes=MAX_ARTEFACT_BYTES)
    try:
        document = loads(source.text, ARTEFACT)
    except (ValueError, RecursionError):
        raise _unfit(source, "it is no JSON") from None
    if not isinstance(document, dict) or document.get("format") != _FORMAT:
        raise _unfit(source, "it describes no training")
    if document.get("version") != _VERSION:
        raise _unfit(source, f"it has version {document.get('version')!r:.20}, and only {_VERSION} can be read")
    return source, document


def _check_settings(source: SourceFile, document: Mapping[str, Any]) -> None:
    """TLT0863 where there are other settings now than in the version that wrote the document."""
    there, known = set(dict(leaves(document.get("settings", {})))), set(dict(leaves(to_json(read_settings()))))
    help_ = f"begin the training anew; `tltlc evaluate {quote(str(Path(source.name).parent))}` plays what it learned"
    if there and (later := sorted(known - there)):
        raise _unfit(source, f"it is of an older version of tltlc, which had no setting `{later[0]}`", help_)
    if gone := sorted(there - known):
        raise _unfit(source, f"it is of another version of tltlc, which had a setting `{gone[0]}`", help_)


def _values(source: SourceFile, document: Mapping[str, Any], names: Sequence[str]) -> dict[str, Any]:
    try:
        return {name: from_json(_PLAIN[name], document[name], name) for name in names}
    except KeyError as error:
        raise _unfit(source, f"it lacks {error}") from None
    except (RecordJsonError, RecursionError) as error:
        raise _unfit(source, str(error)) from None


def identity(run: Run) -> dict[str, str]:
    """What a checkpoint depends on, in parts that messages tell apart: the hashes of ``level`` and ``spec``, the
    ``seed``, and a SHA-256, in hexadecimal, of the senses and of all ``settings`` but for :data:`MAY_CHANGE`; by
    imitation one of the recordings of ``demonstrations``, too, and that of the weights of a ``policy`` to begin with.
    """
    counts = {
        "observation": OBSERVATION,
        "params": dict(run.params),
        "sensors": to_json(run.sensors),
        "settings": {path: value for path, value in leaves(to_json(run.settings)) if path not in MAY_CHANGE},
    }
    return {
        "level": level_hash(load_level(run.level, run.variant)),
        "spec": spec_hash(run.fspa),
        "seed": str(run.seed),
        "settings": hashlib.sha256(json.dumps(counts, sort_keys=True).encode()).hexdigest(),
        **({"demonstrations": _content_hash(demonstrations_of(run))} if run.settings.imitates else {}),
        # As it was recorded: once there is a checkpoint, its file need not be there any more.
        **({"policy": run.initial.weights} if run.initial else {}),
    }


def demonstrations_of(run: Run) -> Path:
    """The folder of the demonstrations that a training imitates."""
    return run.folder / DEMONSTRATIONS if run.demonstrations is None else Path(run.demonstrations)


def leaves(settings: object, path: str = "") -> Iterator[tuple[str, Any]]:
    """Settings in JSON one by one: the name, with a dot between table and key, and the value."""
    if not isinstance(settings, dict):
        yield path, settings
        return
    for name, each in settings.items():
        yield from leaves(each, f"{path}.{name}".lstrip("."))


def resume_command(folder: Path) -> str:
    """What goes on with the training in a folder, to be pasted."""
    return f"tltlc train --resume {quote(str(folder))}"


def named_trainings(folder: Path) -> str:
    """The trainings that a folder holds, as advice; empty where there is none."""
    found = sorted(path.parent for path in folder.glob(f"*/{RUN}"))
    return f"name one of them: {listed([f'`{each}`' for each in found], _MOST_NAMED)}" if found else ""


def _content_hash(folder: Path) -> str:
    """SHA-256, in hexadecimal, of the recordings in a folder and of their names."""
    found = {path.name: read_bytes(path, str(path), MAX_BYTES) for path in recordings(folder)}
    hashes = {name: hashlib.sha256(data).hexdigest() for name, data in found.items()}
    return hashlib.sha256(json.dumps(hashes, sort_keys=True).encode()).hexdigest()


def _no_training(folder: Path) -> TltlError:
    title = f"`{folder}` cannot be resumed from: there is no training in it"
    help_ = named_trainings(folder) or "name the folder of a training, as `tltlc train --out` did"
    return TltlError([Diagnostic("TLT0863", title, help=help_)])


def _unfit(
    source: SourceFile, why: str, help_: str = "name the folder of a training, as `tltlc train --out` did"
) -> TltlError:
    return TltlError([Diagnostic("TLT0863", f"`{source.name}` cannot be resumed from: {why}", help=help_)])
