"""The description of a training, and the file in its folder that stores it: ``run.json``.

The names of the other files in the folder are also defined here.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from shlex import quote
from typing import Any, Final

from tltl_runtime.game.level_name import Variant, level_file, parse_variant, with_level_file
from tltl_runtime.game.registry import game_of
from tltl_runtime.game.sensors import Sensors
from tltl_runtime.policies.card import OBSERVATION
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.support.number_text import short_list
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltl_runtime.training.files.settings import TrainingSettings, read_settings
from tltl_runtime.training.imitation.demonstrations import recordings
from tltlc.api import Diagnostic, Fspa, SourceFile, TltlError, compiler, fileio, record, replace

RUN: Final = "run.json"
CHECKPOINT: Final = "checkpoint.pt"
POLICY: Final = "policy.safetensors"
RECORD: Final = "record.json"
CURVE: Final = "curve.png"
WAYS: Final = "ways.json"
DEMONSTRATIONS: Final = "demonstrations"

MAY_CHANGE: Final = frozenset(
    {"device", "threads", "checkpoint_s", "rollout.workers", "rollout.pool", "stop.steps", "stop.minutes"}
)
"""The settings, as named by :func:`leaves`, that may change when a training is resumed."""
WRITABLE: Final = (
    "check that there is room, and that you may write there; for a new training, you can name another folder with --out"
)
"""The help if the folder of a new or resumed training cannot be written to."""

_FORMAT: Final = "tltl-run"
_VERSION: Final = 1
_MOST_NAMED: Final = 8
"""The most trainings that a help text names."""


@record
class InitialPolicy:
    """The policy whose weights a training begins with.

    ``path`` is its file. The other fields describe the content of the file when it was read:
    ``weights`` is the SHA-256, in hexadecimal, of its weights. ``level``, ``variant`` and
    ``level_hash`` are from the policy's metadata and say on which level it was trained.
    """

    path: str
    weights: str
    level: str
    variant: str
    level_hash: str


@record
class TrainingRun:
    """The description of a training: what is trained, with which settings, and in which folder.

    ``params`` are the values, in SI units, of the params that the spec declares; ``fspa`` is the
    automaton of the spec. ``level`` is the name of a level or the path of its file, as for
    :meth:`~tltl_runtime.game.game.Game.load_level`. ``demonstrations`` is the folder of the
    demonstrations to imitate. If it is None, tltlc records demonstrations of the expert in the
    training's folder. ``initial`` is the policy whose weights the actor begins with, None for
    random weights.
    """

    folder: Path
    fspa: Fspa
    params: Mapping[str, float]
    level: str
    variant: Variant
    sensors: Sensors
    settings: TrainingSettings
    seed: int
    demonstrations: str | None = None
    initial: InitialPolicy | None = None


_PLAIN: Final[Mapping[str, Any]] = {
    "params": Mapping[str, float],
    "level": str,
    "variant": str,
    "sensors": Sensors,
    "settings": TrainingSettings,
    "seed": int,
    "demonstrations": str | None,
    "initial": InitialPolicy | None,
}
"""The fields that the file stores as plain JSON values, and the types of these values."""


def write_run(run: TrainingRun) -> None:
    """Write ``run.json`` into the folder of the training; create the folder if it is missing.

    Raises TltlError, TLT0005, if the file cannot be written.
    """
    # Paths are absolute, because the training may be resumed from another folder.
    file = level_file(run.level)
    level = run.level if file is None else with_level_file(run.level, file.absolute())
    document = {
        "format": _FORMAT,
        "version": _VERSION,
        **{name: to_json(getattr(run, name)) for name in _PLAIN},
        "level": level,
        "variant": run.variant.absolute().text,
        "demonstrations": run.demonstrations and str(Path(run.demonstrations).absolute()),
        "initial": run.initial and to_json(replace(run.initial, path=str(Path(run.initial.path).absolute()))),
        "level_hash": current_level_hash(run),
        "artefact": compiler.encode_artefact(run.fspa),
    }
    text = json.dumps(document, indent=1, ensure_ascii=False) + "\n"
    fileio.write_files(run.folder, {RUN: text}, WRITABLE, durable=True, over_inputs=True)


def read_run(folder: Path) -> TrainingRun:
    """Read the description of a training from ``run.json`` in its folder.

    Raises:
        TltlError: TLT0001, the file cannot be read; TLT0863, there is no such file, or it is
            invalid.
    """
    if not (folder / RUN).exists():
        raise _no_training_error(folder)
    source, document = _read_document(folder)
    _check_settings(source, document)
    values = _values(source, document, tuple(_PLAIN))
    if "artefact" not in document:
        raise _invalid_run_error(source, "it has no 'artefact'")
    fspa = compiler.decode_artefact(document["artefact"], f"{source.name}/artefact")
    return TrainingRun(folder=folder, fspa=fspa, **{**values, "variant": parse_variant(values["variant"])})


def read_level_and_variant(folder: Path) -> tuple[str, str]:
    """Return the level and the variant of the training in a folder.

    The rest of ``run.json`` may be invalid. Raises the errors of :func:`read_run`.
    """
    values = _values(*_read_document(folder), ("level", "variant"))
    return values["level"], values["variant"]


def read_level_hash(folder: Path) -> str | None:
    """Return the hash of the level on which the training in a folder began.

    Returns None if ``run.json`` does not have it. Raises the errors of :func:`read_run`.
    """
    digest = _read_document(folder)[1].get("level_hash")
    return digest if isinstance(digest, str) else None


def _read_document(folder: Path) -> tuple[SourceFile, Mapping[str, Any]]:
    source = fileio.read_source(folder / RUN, max_bytes=fileio.MAX_ARTEFACT_BYTES)
    try:
        document = fileio.parse_json(source.text, fileio.limits.ARTEFACT)
    except (ValueError, RecursionError):
        raise _invalid_run_error(source, "it is not JSON") from None
    if not isinstance(document, dict) or document.get("format") != _FORMAT:
        raise _invalid_run_error(source, "it does not describe a training")
    if document.get("version") != _VERSION:
        raise _invalid_run_error(
            source, f"it has version {document.get('version')!r:.20}, and only {_VERSION} can be read"
        )
    return source, document


def _check_settings(source: SourceFile, document: Mapping[str, Any]) -> None:
    """Raise TLT0863 if ``run.json`` is from another version of tltlc, which had other settings.

    ``source`` is the file, and ``document`` its content.
    """
    stored, known = set(dict(leaves(document.get("settings", {})))), set(dict(leaves(to_json(read_settings()))))
    help_ = f"train again; `tltlc evaluate {quote(str(Path(source.name).parent))}` plays what was learned"
    if stored and (missing := sorted(known - stored)):
        raise _invalid_run_error(
            source, f"it is from an older version of tltlc, which had no setting `{missing[0]}`", help_
        )
    if unknown := sorted(stored - known):
        raise _invalid_run_error(
            source, f"it is from another version of tltlc, which had a setting `{unknown[0]}`", help_
        )


def _values(source: SourceFile, document: Mapping[str, Any], names: Sequence[str]) -> dict[str, Any]:
    try:
        return {name: from_json(_PLAIN[name], document[name], name) for name in names}
    except KeyError as error:
        raise _invalid_run_error(source, f"it has no {error}") from None
    except (RecordJsonError, RecursionError) as error:
        raise _invalid_run_error(source, str(error)) from None


def identity(run: TrainingRun) -> dict[str, str]:
    """Return the inputs of a training as texts by name; a checkpoint fits only equal inputs.

    ``level`` and ``spec`` are hashes, ``seed`` is the seed. ``settings`` is a hash of the version
    of the observations, the params, the sensors and all settings except :data:`MAY_CHANGE`. With
    imitation, ``demonstrations`` is a hash of the recordings. With an initial policy, ``policy`` is
    the hash of its weights. All hashes are in hexadecimal. Errors name the inputs that differ.
    """
    relevant = {
        "observation": OBSERVATION,
        "params": dict(run.params),
        "sensors": to_json(run.sensors),
        "settings": {path: value for path, value in leaves(to_json(run.settings)) if path not in MAY_CHANGE},
    }
    return {
        "level": current_level_hash(run),
        "spec": spec_hash(run.fspa),
        "seed": str(run.seed),
        "settings": hashlib.sha256(json.dumps(relevant, sort_keys=True).encode()).hexdigest(),
        **({"demonstrations": _content_hash(demonstrations_of(run))} if run.settings.imitates else {}),
        # The recorded hash: once there is a checkpoint, the policy's file is no longer needed.
        **({"policy": run.initial.weights} if run.initial else {}),
    }


def current_level_hash(run: TrainingRun) -> str:
    """Read the level of a training from its file, which may have changed; return the level's hash."""
    game = game_of(run.level)
    return game.level_hash(game.load_level(run.level, run.variant))


def demonstrations_of(run: TrainingRun) -> Path:
    """Return the folder of the demonstrations that a training imitates."""
    return run.folder / DEMONSTRATIONS if run.demonstrations is None else Path(run.demonstrations)


def leaves(settings: object, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the dotted name and the value of each setting: ``{"stop": {"steps": 9}}`` -> ``("stop.steps", 9)``.

    ``settings`` are settings as JSON data, and ``path`` is the prefix of the names.
    """
    if not isinstance(settings, dict):
        yield path, settings
        return
    for name, value in settings.items():
        yield from leaves(value, f"{path}.{name}".lstrip("."))


def resume_command(folder: Path) -> str:
    """Return the shell command that resumes the training in a folder."""
    return f"tltlc train --resume {quote(str(folder))}"


def named_trainings(folder: Path) -> str:
    """Return a help text that lists the folders of trainings directly in ``folder``; empty if there are none."""
    trainings = sorted(path.parent for path in folder.glob(f"*/{RUN}"))
    return f"name one of them: {short_list([f'`{path}`' for path in trainings], _MOST_NAMED)}" if trainings else ""


def _content_hash(folder: Path) -> str:
    """Return the SHA-256, in hexadecimal, of the recordings in a folder and of their names."""
    max_bytes = fileio.limits.RECORDING.size
    contents = {path.name: fileio.read_bytes(path, str(path), max_bytes) for path in recordings(folder)}
    hashes = {name: hashlib.sha256(data).hexdigest() for name, data in contents.items()}
    return hashlib.sha256(json.dumps(hashes, sort_keys=True).encode()).hexdigest()


def _no_training_error(folder: Path) -> TltlError:
    title = f"there is no training in `{folder}`"
    help_ = named_trainings(folder) or "name the folder of a training, as in `tltlc train --out`"
    return TltlError([Diagnostic("TLT0863", title, help=help_)])


def _invalid_run_error(
    source: SourceFile, reason: str, help_: str = "name the folder of a training, as in `tltlc train --out`"
) -> TltlError:
    return TltlError([Diagnostic("TLT0863", f"cannot use `{source.name}`: {reason}", help=help_)])
