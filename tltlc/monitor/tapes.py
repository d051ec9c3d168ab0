"""Check the lines of a tape, a recorded play with its actions, in the format of ``docs/tapes.md``."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from math import isfinite
from typing import Any, Final

from tltlc.core.record import EMPTY, record
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor.sample_times import times_name
from tltlc.resolve import units

VERSION: Final = 1
"""The version of the format that is read and written."""

DIGEST_STEPS: Final = 60
"""There is a digest after each of this many steps."""

GREATEST_SEED: Final = (1 << 53) - 1

Value = float | bool
Wrong = Callable[[str, str], TltlError]
"""Makes an error about the line that was read last. The arguments say what is wrong with it, and what to do."""

_FORMAT_HELP: Final = "docs/tapes.md describes each line; a tape of a recorder was damaged if it has another form"
_DIGEST_HELP: Final = "the tape was changed or damaged after it was recorded: use another copy, or record it again"


@record
class TapeHeader:
    """The first line of a tape: what was played, and which signals each step has.

    ``signals`` maps each signal to its declaration, as in the message ``hello`` of a game; digests
    have this order. ``scene``, ``seed``, ``spec`` (a hash of the spec) and ``clock_hz`` (steps in a
    second) are None if they are not known. ``versions`` maps names of programs to their versions.
    """

    game: str
    signals: Mapping[str, Mapping[str, Any]]
    scene: str | None = None
    variant: str = "v0"
    seed: int | None = None
    spec: str | None = None
    versions: Mapping[str, str] = EMPTY
    clock_hz: float | None = None

    def is_bool(self, signal: str) -> bool:
        """Whether the values of a signal are bools."""
        return self.signals[signal].get("type") == "bool"


@record
class TapeStep:
    """A step of a tape: an action, a value of JSON, and the values of all signals after it."""

    action: Any
    signals: Mapping[str, Value]


class TapeDigest:
    """The digest of all signals so far: the Adler-32 checksum (RFC 1950) of their values.

    Each value counts as the eight bytes of a double, the lowest byte first. A bool counts as 1 or 0,
    and -0 as 0.
    """

    def __init__(self) -> None:
        self._sums = 1

    def add(self, header: TapeHeader, signals: Mapping[str, Value]) -> None:
        """Add the values of a step."""
        values = [float(signals[name]) + 0.0 for name in header.signals]
        self._sums = zlib.adler32(struct.pack(f"<{len(values)}d", *values), self._sums)

    @property
    def text(self) -> str:
        """The digest as eight digits of base 16."""
        return f"{self._sums:08x}"


def is_header(line: Mapping[str, Any]) -> bool:
    """Whether the first object of a file is the header of a tape; otherwise it is a sample of a trace."""
    return "tape" in line and isinstance(line.get("signals"), dict)


def header_from(line: Mapping[str, Any], wrong: Wrong) -> TapeHeader:
    """Return the header in the first line of a tape; raise the error of ``wrong`` if a part of it is wrong."""
    if line["tape"] != VERSION or isinstance(line["tape"], bool):
        problem = f"this is version {line['tape']} of the format of tapes, and this tltlc reads version {VERSION}"
        raise wrong(problem, "a newer tltlc may read it; docs/tapes.md describes version 1")
    if problem := _header_problem(line) or _signals_problem(line["signals"]):
        raise wrong(problem, _FORMAT_HELP)
    seed = line.get("seed")
    return TapeHeader(
        game=line["game"],
        signals=line["signals"],
        scene=line.get("scene"),
        variant=line.get("variant", "v0"),
        seed=None if seed is None else int(seed),
        spec=line.get("spec"),
        versions=line.get("versions", {}),
        clock_hz=line.get("clock_hz"),
    )


def _header_problem(line: Mapping[str, Any]) -> str:
    """Return what is wrong with a header, its signals aside; empty if nothing is."""
    clock_hz, seed, versions = line.get("clock_hz"), line.get("seed"), line.get("versions", {})
    for key, text in (("game", line.get("game")), ("variant", line.get("variant", "v0"))):
        if not isinstance(text, str):
            return f"`{key}` must be a text"
    for key in ("scene", "spec"):
        if not isinstance(line.get(key), str | None):
            return f"`{key}` must be a text or null"
    if seed is not None and not (_is_number(seed) and seed == int(seed) and 0 <= seed <= GREATEST_SEED):
        return f"`seed` must be a whole number from 0 to {GREATEST_SEED}, or null"
    if clock_hz is not None and not (_is_number(clock_hz) and clock_hz > 0):
        return "`clock_hz` must be a number above 0, or null"
    if not isinstance(versions, dict) or not all(isinstance(value, str) for value in versions.values()):
        return "`versions` must map names to texts"
    return ""


def _signals_problem(signals: Mapping[str, Any]) -> str:
    """Return what is wrong with the declarations of the signals; empty if nothing is."""
    for name, declaration in signals.items():
        type_ = declaration.get("type", "number") if isinstance(declaration, dict) else None
        if not isinstance(type_, str) or type_ not in units.TYPES:
            return f'the signal `{name}` must have a declaration such as {{}} or {{"type": "bool"}}'
    return ""


def steps_from(header: TapeHeader, lines: Iterator[Mapping[str, Any]], wrong: Wrong) -> Iterator[TapeStep]:
    """Yield the steps in the lines after the header; raise the error of ``wrong`` at the first wrong line."""
    digest = TapeDigest()
    for number, line in enumerate(lines, start=1):
        step = _step(header, line, wrong)
        digest.add(header, step.signals)
        expected = line.get("digest")
        if expected is None and number % DIGEST_STEPS == 0:
            raise wrong(f"step {number} has no digest; each {DIGEST_STEPS}th step must have one", _FORMAT_HELP)
        if expected is not None and expected != digest.text:
            problem = f"the signals up to here have the digest {digest.text}, and the tape says {expected}"
            raise wrong(problem, _DIGEST_HELP)
        yield step


def samples_from(header: TapeHeader, steps: Iterator[TapeStep]) -> Iterator[dict[str, Any]]:
    """Yield the samples of the trace of the same play: the signals of each step.

    With the clock of the tape, each sample has its ``time`` in seconds, unless a signal has this name.
    """
    is_timed = header.clock_hz is not None and times_name(header.signals, ()) is None
    for index, step in enumerate(steps):
        time = {"time": index / header.clock_hz} if is_timed and header.clock_hz is not None else {}
        yield {**time, **step.signals}


def _step(header: TapeHeader, line: Mapping[str, Any], wrong: Wrong) -> TapeStep:
    """Return the step in a line; the digest is not checked."""
    action, signals = line.get("action"), line.get("signals")
    if action is None:
        raise wrong("this step has no `action`", _FORMAT_HELP)
    if not isinstance(signals, dict):
        raise wrong("this step has no `signals`, an object with a value for each signal", _FORMAT_HELP)
    missing = next((name for name in header.signals if name not in signals), None)
    if missing is not None:
        raise wrong(f"the signal `{missing}` of the header is missing here", _FORMAT_HELP)
    for name, value in signals.items():
        if name not in header.signals:
            raise wrong(f"the header does not declare the signal `{name}`", _FORMAT_HELP)
        if isinstance(value, bool) != header.is_bool(name) or not (isinstance(value, bool) or _is_number(value)):
            expected = "true or false" if header.is_bool(name) else "a finite number"
            raise wrong(f"the value of the signal `{name}` must be {expected}", _FORMAT_HELP)
    return TapeStep(action, signals)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and isfinite(value)
