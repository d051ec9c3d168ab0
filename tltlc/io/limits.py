"""The limits of all inputs and of long computations, in one place, so that none is overlooked.

Input above a limit is reported with TLT0004 (bytes) or TLT0006 (nesting, number of values), or with
an error of the input's format. Computations that could take very long count their steps, and stop
at the limit in :data:`WORK`. They count steps and not seconds, so that all machines give the same
result.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError


@record
class Limit:
    """The limits of one kind of input, such as a level or a trace.

    ``size`` is the greatest number of bytes, as stored on disk, and ``unpacked`` after
    decompression. ``depth`` is the greatest number of nested levels. ``values`` is the greatest
    number of values, keys and separators, or of other things that the description of the limit
    names. None means that there is no such limit.
    """

    size: int
    depth: int | None = None
    values: int | None = None
    unpacked: int | None = None


@record
class Connections:
    """The limits of the connections to a server.

    ``most`` is how many connections may be open at the same time. The other limits are in
    seconds: ``idle_s`` is the time between two requests, ``request_s`` the time from the first to
    the last byte of a request, ``write_s`` the time in which the client must receive an answer, and
    ``linger_s`` the time in which the client must close the connection.
    """

    most: int
    idle_s: float
    request_s: float
    write_s: float
    linger_s: float


@record
class ProcessLimit:
    """The most memory, in bytes, and processor time ``work_s``, in seconds, that a process may use."""

    memory: int
    work_s: int


@record
class ArithmeticLimit:
    """The limits of an arithmetic expression.

    ``depth`` is the greatest depth of nested operators, functions, conditions and ``when``.
    ``compared`` is the greatest depth of an atom that compares two expressions, such as ``a < b``.
    ``parts`` is the greatest number of cases of a ``when``, and of arguments of a function.
    """

    depth: int
    compared: int
    parts: int


ARITHMETIC: Final = ArithmeticLimit(depth=100, compared=110, parts=500)
"""The limits of the expression of an atom.

Python's compiler can handle this depth, and so can recursive functions over expressions.
"""

SOURCE: Final = Limit(size=1 << 20)
"""A source text. The grammar limits the number of tokens and the nesting, too."""

IMPORTED: Final = Limit(size=1 << 24, values=100_000)
"""All imports of a source text together. ``values`` counts the names that the imports define.

``size`` counts the characters of the names that imports with `as` define. A file that is imported
twice counts twice.
"""

TOML: Final = Limit(size=1 << 20, depth=32, values=50_000)
"""A TOML file: a level, an asset, an overlay, a game file, a suite, settings, or ``tltl.toml``."""

LEVEL: Final = Limit(size=1 << 20, values=4_000)
"""A level; ``values`` counts its entities, steps of stairs, and points of paths and routes."""

SUITE: Final = Limit(size=1 << 20, values=2_000)
"""A suite; ``values`` counts cases. Each case names files to read."""

GAME_FILE: Final = Limit(size=1 << 20, values=2_000)
"""A game file; ``values`` counts the variants of all scenes, and the files that they name."""

SCENE_FILE: Final = Limit(size=1 << 30)
"""A file that a scene of a game depends on, and a Python file of the game. It is only hashed."""

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
"""An answer of the playground. A browser would accept far more, but nobody could read it."""

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
"""A row of a trace. The number of rows has no limit, since traces are read row by row.

``depth`` and ``values`` are for rows in JSON; ``values`` counts commas. Generated monitors have the
same limits.
"""

MINED_TRACE: Final = Limit(size=1 << 28)
"""A trace that `tltlc mine` keeps in memory."""

JUDGED_TRACE: Final = Limit(size=1 << 25, values=500_000)
"""One of many traces that `tltlc monitor` judges; ``values`` counts lines. Each worker keeps one trace in memory."""

PARQUET: Final = Limit(size=1 << 26, values=3_000_000, unpacked=1 << 28)
"""A trace in Parquet; ``values`` counts the cells of the columns that are read, and the rows."""

TAPE: Final = Limit(size=1 << 26, unpacked=1 << 26)
"""A tape that is read as a whole, and any trace that is packed with gzip; :data:`TRACE_LINE` limits each line."""

RECORDING: Final = Limit(size=1 << 28, unpacked=1 << 28)
"""A recorded episode."""

RECORDED_TEXTS: Final[Mapping[str, Limit]] = {
    "meta": Limit(size=1 << 24, depth=100, values=200_000),
    "artefact": ARTEFACT,
}
"""The JSON texts in a recorded episode, after decompression, by their names."""

POLICY: Final = Limit(size=1 << 26)
"""A trained policy."""

CHECKPOINT: Final = Limit(size=1 << 30, depth=32, values=1_000_000)
"""A checkpoint of a training run."""

FOUND_WAYS: Final = Limit(size=1 << 28, depth=8, values=20_000_000)
"""The ways that a search before a training has found; ``values`` counts mostly numbers of actions."""

MEASUREMENTS: Final = Limit(size=1 << 30)
"""The measurements of a training run, one line per iteration; :data:`TRACE_LINE` limits each line."""

REVISION: Final = Limit(size=1 << 28, values=20_000)
"""The files of a git revision that are read; ``values`` counts files."""

REVISION_PATHS: Final = Limit(size=1 << 29, values=5_000_000)
"""All paths of a git revision, including folders: ``values`` counts paths, ``size`` the bytes of the whole list."""

REVISION_PATH: Final = Limit(size=1 << 20)
"""One path in the list of :data:`REVISION_PATHS`."""

UNPACKED_PATH: Final = Limit(size=4096, depth=100)
"""A path in a git revision or another archive that is unpacked; ``depth`` counts its parts."""

UNPACKED_NAME: Final = Limit(size=255)
"""A part of a path that :data:`UNPACKED_PATH` limits; common file systems refuse longer names."""

WIRE_MESSAGE: Final = Limit(size=1 << 25)
"""A message of a game in another process, with its line end. A picture of 1080p has 8 MiB in base64."""

WIRE_HELLO: Final = Limit(size=1 << 20, depth=16, values=1 << 22)
"""The first message of a game in another process.

``depth`` is the most levels of nested spaces; ``values`` is the most numbers of an observation or of
an action, all parts together.
"""

WIRE_STDERR: Final = Limit(size=1 << 13, values=20)
"""The end of a game's standard error that messages show; ``values`` counts lines."""

PLAYGROUND: Final = Connections(most=64, idle_s=15.0, request_s=20.0, write_s=30.0, linger_s=2.0)
"""The connections to the playground's server."""

PLAYGROUND_CHILD: Final = ProcessLimit(memory=2 << 30, work_s=60)
"""A process that answers one request to the playground."""

COMMAND: Final = ProcessLimit(memory=4 << 30, work_s=120)
"""A command that reads files and ends by itself; `tltlc --max-cpu --max-memory` sets other limits.

Usually a limit of :data:`WORK` is reached long before.
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
    "mined times": 1_000_000_000,
    "mined candidates": 50_000,
}
"""Maps each computation that could take very long to its limit: how many steps, states or edges it may count."""


def too_deep_error(source: SourceFile, limit: Limit, span: Span | None = None) -> TltlError:
    """Return the error TLT0006 for a text that nests deeper than ``limit`` allows.

    ``span`` is the part of the text that nests too deep; None if it is not known.
    """
    return _structure_error(source, f"nests deeper than {limit.depth} levels", "reduce the nesting", span)


def too_many_values_error(source: SourceFile, limit: Limit, span: Span | None = None) -> TltlError:
    """Return the error TLT0006 for a text with more values than ``limit`` allows.

    ``span`` is the part of the text with too many values; None if it is not known.
    """
    problem = f"contains more than {limit.values:,} values"
    return _structure_error(source, problem, "split it, or leave out values that nothing reads", span)


def _structure_error(source: SourceFile, problem: str, help_: str, span: Span | None) -> TltlError:
    labels = (Label(source, span),) if span is not None else ()
    return TltlError([Diagnostic("TLT0006", f"`{source.name}` {problem}", labels, help_)])
