"""Read and write tapes, recorded plays with their actions. ``docs/tapes.md`` describes the format."""

from __future__ import annotations

import gzip
import io
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tltlc.api import Diagnostic, TltlError, fileio, record, traces

TapeHeader = traces.TapeHeader
TapeStep = traces.TapeStep

_TOO_LARGE: Final = (
    "record shorter plays, or fewer signals; to judge this one, unpack it if it is packed: "
    "`tltlc monitor SPEC TAPE` reads an unpacked tape of any size"
)


@record
class Tape:
    """A recorded play: what was played, and the action of each step with the signals after it."""

    header: traces.TapeHeader
    steps: tuple[traces.TapeStep, ...]


@fileio.resource_limits()
def read_tape(path: str | os.PathLike[str]) -> Tape:
    """Read a tape from a file, which may be packed with gzip, and check its digests.

    Raises:
        TltlError: TLT0001, the file cannot be read; TLT0004, it is larger than 64 MiB, packed or
            unpacked; TLT0620, it has no step; TLT0622, a line is wrong, or a digest is not that of
            the signals.
    """
    name = os.fspath(path)
    most = fileio.limits.TAPE.size
    data = fileio.read_bytes(path, name, most)
    if len(data) > most:
        title = f"`{name}` is larger than {most >> 20} MiB"
        raise TltlError([Diagnostic("TLT0004", title, help=_TOO_LARGE)])
    header, steps = traces.read_tape(traces.TraceLines(io.BytesIO(traces.unpacked(data, name, _TOO_LARGE)), name))
    tape = Tape(header, tuple(steps))
    if not tape.steps:
        raise _no_step(name)
    return tape


def write_tape(path: str | os.PathLike[str], tape: Tape) -> None:
    """Write a tape to a file atomically, packed with gzip if the name ends in ``.gz``; equal tapes give equal bytes.

    Raises:
        TltlError: TLT0005, the file cannot be written; TLT0620, the tape has no step.
        ValueError: a number is not finite, or a step has no action, or other signals than the header, or
            other types.
    """
    if not tape.steps:
        raise _no_step(os.fspath(path))
    data = "".join(f"{line}\n" for line in _lines(tape)).encode()
    fileio.write_file(Path(path), gzip.compress(data, mtime=0) if os.fspath(path).endswith(".gz") else data)


def _no_step(name: str) -> TltlError:
    title = f"the tape `{name}` contains no step"
    return TltlError([Diagnostic("TLT0620", title, help="record at least one step with its action")])


def _lines(tape: Tape) -> Iterator[str]:
    yield _text(_header(tape.header))
    digest = traces.TapeDigest()
    for number, step in enumerate(tape.steps, start=1):
        if step.action is None:
            raise ValueError(f"step {number} has no action")
        if step.signals.keys() != tape.header.signals.keys():
            raise ValueError(f"step {number} has other signals than the header of the tape")
        values = {name: step.signals[name] for name in tape.header.signals}
        if any(isinstance(value, bool) != tape.header.is_bool(name) for name, value in values.items()):
            raise ValueError(f"step {number} has other types of signals than the header of the tape")
        digest.add(tape.header, step.signals)
        ends_part = number % traces.DIGEST_STEPS == 0
        yield _text({"action": step.action, "signals": values, **({"digest": digest.text} if ends_part else {})})


def _header(header: traces.TapeHeader) -> dict[str, object]:
    return {
        "tape": traces.TAPE_VERSION,
        "game": header.game,
        "scene": header.scene,
        "variant": header.variant,
        "seed": header.seed,
        "spec": header.spec,
        "versions": dict(header.versions),
        "clock_hz": header.clock_hz,
        "signals": {name: dict(declaration) for name, declaration in header.signals.items()},
    }


def _text(value: object) -> str:
    return json.dumps(value, allow_nan=False, separators=(",", ":"))
