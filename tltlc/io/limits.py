"""The limits of all input that is read or checked, in one table, so that no reader of foreign input lacks a limit.

A reader takes its limit from here. It reports larger input with TLT0004 (bytes) or TLT0006 (nesting,
number of values), or with an error of its own format. A checker counts its steps against an entry of
:data:`WORK`. It counts steps instead of seconds, so that every machine gives the same answer.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError


@record
class Limit:
    """The limits of one kind of input.

    ``size`` is in bytes, as stored on disk. ``depth`` counts levels of nesting. ``values`` counts
    values, keys and separators. ``unpacked`` is in bytes, after decompression. A limit is None if the
    format has no such quantity.
    """

    size: int
    depth: int | None = None
    values: int | None = None
    unpacked: int | None = None


@record
class Connections:
    """The most connections that a server keeps open, and the time for each phase of a connection, in seconds.

    ``idle_s`` limits the time between requests, ``request_s`` the time from the first to the last
    byte of a request, ``write_s`` the time in which the client must receive an answer, and
    ``linger_s`` the time in which the client must close the connection.
    """

    most: int
    idle_s: float
    request_s: float
    write_s: float
    linger_s: float


@record
class ProcessLimit:
    """The resources of a process: ``memory`` in bytes, ``work_s`` in seconds of processor time."""

    memory: int
    work_s: int


@record
class ArithmeticLimit:
    """The limits of an expression: ``depth`` counts nested operators, including functions, conditions and ``when``.

    ``compared`` is the depth of an atom that compares two such expressions. ``parts`` counts the
    cases of one ``when``, or the arguments of one function.
    """

    depth: int
    compared: int
    parts: int


ARITHMETIC: Final = ArithmeticLimit(depth=100, compared=110, parts=500)
"""The arithmetic of an atom. All code that walks expressions recursively, Python's compiler included, copes with it."""

SOURCE: Final = Limit(size=1 << 20)
"""A source text. The grammar limits the number of tokens and the nesting, too."""

IMPORTED: Final = Limit(size=1 << 24, values=100_000)
"""The names that all imports of a program bring in. A file that is imported twice counts twice.

``size`` bounds the characters of the names that imports with `as` create.
"""

TOML: Final = Limit(size=1 << 20, depth=32, values=50_000)
"""A level, an asset, an overlay, a suite, settings, ``tltl.toml``."""

LEVEL: Final = Limit(size=1 << 20, values=4_000)
"""A level with its parts; ``values`` counts things, steps of stairs, and points of paths and routes."""

SUITE: Final = Limit(size=1 << 20, values=2_000)
"""A suite; ``values`` counts cases. Each case names files to read."""

OVERLAYS: Final = 100
"""The most overlays of one variant of a level."""

ARTEFACT: Final = Limit(size=1 << 27, depth=400, values=10_000_000)
"""An artefact, an automaton of another tool, or a training run, which contains an artefact.

``depth`` leaves room for :data:`ARITHMETIC`: an operator takes at most three levels of JSON.
"""

REPORT: Final = Limit(size=1 << 27, depth=100, values=10_000_000)
"""A baseline, or a record of a training run."""

MESSAGE: Final = Limit(size=1 << 22, depth=100, values=1_000_000)
"""A request to the playground or to the language server."""

ANSWER: Final = Limit(size=1 << 25)
"""An answer of the playground. A browser accepts far more, but too much for a person to read."""

WORKSPACE: Final = Limit(size=1 << 26, values=200_000)
"""The source texts in the folders that are open in an editor; ``values`` counts all files and folders."""

WORKSPACE_PARSED: Final = Limit(size=1 << 22)
"""The source texts that one request of the editor parses."""

REQUEST_LINE: Final = Limit(size=1 << 13)
"""The first line of a request to the playground, with its line end."""

REQUEST_HEAD: Final = Limit(size=1 << 15, values=100)
"""The first line and the header lines of a request to the playground; ``values`` counts lines."""

MESSAGE_HEAD: Final = Limit(size=1 << 13)
"""A header line of the language server's protocol."""

TRACE_LINE: Final = Limit(size=1 << 20, depth=32, values=50_000)
"""A row of a trace. The number of rows has no limit, since traces are read as a stream.

``depth`` and ``values`` limit a row of JSON; ``values`` counts commas. Generated monitors have the
same limits.
"""

MINED_TRACE: Final = Limit(size=1 << 28)
"""A trace that `tltlc mine` keeps in memory."""

RECORDING: Final = Limit(size=1 << 28, unpacked=1 << 28)
"""A recorded episode."""

RECORDED_TEXTS: Final[Mapping[str, Limit]] = {
    "meta": Limit(size=1 << 24, depth=100, values=200_000),
    "artefact": ARTEFACT,
}
"""The JSON in a recorded episode, after decompression, which may yield a thousand times the size of the file."""

POLICY: Final = Limit(size=1 << 26)
"""A trained policy."""

CHECKPOINT: Final = Limit(size=1 << 30, depth=32, values=1_000_000)
"""A checkpoint of a training run."""

MEASUREMENTS: Final = Limit(size=1 << 30)
"""The measurements of a training run, one line per iteration; :data:`TRACE_LINE` limits each line."""

REVISION: Final = Limit(size=1 << 28, values=20_000)
"""The files of a git revision that are read."""

REVISION_PATHS: Final = Limit(size=1 << 29, values=5_000_000)
"""All paths of a git revision, including folders: ``values`` counts paths, ``size`` the bytes of the whole list."""

REVISION_PATH: Final = Limit(size=1 << 20)
"""One path in the list of :data:`REVISION_PATHS`."""

UNPACKED_PATH: Final = Limit(size=4096, depth=100)
"""A path in a git revision or another archive that is unpacked; ``depth`` counts its parts."""

UNPACKED_NAME: Final = Limit(size=255)
"""A part of a path that is unpacked: no common file system allows longer names."""

PLAYGROUND: Final = Connections(most=64, idle_s=15.0, request_s=20.0, write_s=30.0, linger_s=2.0)
"""The connections to the playground's server."""

PLAYGROUND_CHILD: Final = ProcessLimit(memory=2 << 30, work_s=60)
"""A process that answers one request to the playground."""

COMMAND: Final = ProcessLimit(memory=4 << 30, work_s=120)
"""The resources of a command that reads files and ends by itself; `tltlc --max-cpu --max-memory` sets others.

This is the last bound: the limits of :data:`WORK` stop the work long before.
"""

WORK: Final[Mapping[str, int]] = {
    "check of a predicate": 600_000,
    "checks of all predicates": 1_500_000,
    "arithmetic of all atoms": 200_000,
    "expanded bounds": 100_000,
    "guard literals": 1_500_000,
    "states of parts": 150_000,
    "states of blamed parts": 40_000,
    "estimate of states": 20_000_000,
    "steps in the given order of atoms": 100_000,
    "edges": 1_000_000,
    "partial products": 20_000_000,
    "label nodes": 6_000_000,
    "arrow nodes": 200_000,
    "fixes tried": 200,
    "cells of floor": 1_000_000,
    "cells of reachable space": 3_000_000_000,
    "mined columns": 5_000,
    "mined instances": 2_000,
    "mined pairs": 60_000,
    "mined sequences": 800_000,
    "mined candidates": 50_000,
}
"""The most steps of a checker, by what it counts."""


def too_deep_error(source: SourceFile, limit: Limit, span: Span | None = None) -> TltlError:
    """Return TLT0006: a text nests too deep for its reader; ``span`` is the place, if known."""
    return _structure_error(source, f"nests deeper than {limit.depth} levels", "flatten it", span)


def too_many_values_error(source: SourceFile, limit: Limit, span: Span | None = None) -> TltlError:
    """Return TLT0006: a text has too many values for its reader; ``span`` is the place, if known."""
    problem = f"holds more than {limit.values:,} values"
    return _structure_error(source, problem, "split it, or leave out what nothing reads", span)


def _structure_error(source: SourceFile, problem: str, help_: str, span: Span | None) -> TltlError:
    labels = (Label(source, span),) if span is not None else ()
    return TltlError([Diagnostic("TLT0006", f"`{source.name}` {problem}", labels, help_)])
