"""The limits of everything that is read or checked: one table, so that no reader of foreign input is without one.

A reader takes its row from here. It reports input that is larger with TLT0004 (bytes) or TLT0006 (nesting, number of
values), or with the error of its own format. A checker counts its steps against a row of :data:`WORK`. Steps, not
seconds, decide, so that every machine gives the same answer.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError


@record
class Limit:
    """How much a reader takes of one kind of input.

    ``size`` is in bytes, as the input lies on the disk; ``depth`` counts levels of nesting; ``values`` counts values,
    keys and separators; ``unpacked`` is in bytes, after decompression. None where the format has no such thing.
    """

    size: int
    depth: int | None = None
    values: int | None = None
    unpacked: int | None = None


@record
class Connections:
    """How many connections a server keeps open, and how long each may take over each part, in seconds.

    ``idle_s`` is the time between requests, ``request_s`` that of a whole request from its first byte to its last,
    ``write_s`` that in which an answer must be taken, ``linger_s`` that in which the other side hangs up.
    """

    most: int
    idle_s: float
    request_s: float
    write_s: float
    linger_s: float


@record
class Process:
    """What a process may use: ``memory`` in bytes, ``work_s`` in seconds of processor time."""

    memory: int
    work_s: int


@record
class Arithmetic:
    """How large an expression may be: ``depth`` counts operators in each other, functions, conditions and ``when`` too.

    ``compared`` is the depth of two such expressions that an atom compares; ``parts`` counts the cases of one ``when``,
    or the arguments of one function.
    """

    depth: int
    compared: int
    parts: int


ARITHMETIC: Final = Arithmetic(depth=100, compared=110, parts=500)
"""The arithmetic of an atom: all code that walks expressions by recursion has room for it, Python's compiler, too."""

SOURCE: Final = Limit(size=1 << 20)
"""A source text; the grammar has more limits of its own, on words and on nesting."""

IMPORTED: Final = Limit(size=1 << 24, values=100_000)
"""The names that all imports of a program offer: a file that is imported twice offers its names twice.

``size`` counts letters: `as` writes each name anew.
"""

TOML: Final = Limit(size=1 << 20, depth=32, values=50_000)
"""A level, an asset, an overlay, a suite, settings, ``tltl.toml``."""

LEVEL: Final = Limit(size=1 << 20, values=4_000)
"""A level with the parts that it uses; ``values`` counts things, steps of stairs, and points of ways and routes."""

SUITE: Final = Limit(size=1 << 20, values=2_000)
"""A suite; ``values`` counts cases, each of which names files that are read."""

OVERLAYS: Final = 100
"""The overlays of one variant of a level."""

ARTEFACT: Final = Limit(size=1 << 27, depth=400, values=10_000_000)
"""An artefact, an automaton of another tool, or a run of a training, which holds an artefact.

``depth`` leaves room for :data:`ARITHMETIC`, of which an operator takes three levels of JSON at most.
"""

REPORT: Final = Limit(size=1 << 27, depth=100, values=10_000_000)
"""A baseline or a record of a training."""

MESSAGE: Final = Limit(size=1 << 22, depth=100, values=1_000_000)
"""A request to the playground or to the language server."""

ANSWER: Final = Limit(size=1 << 25)
"""An answer of the playground; a browser takes far more, but nobody looks at it."""

WORKSPACE: Final = Limit(size=1 << 26, values=200_000)
"""The source texts in the folders that an editor shows; ``values`` counts files and folders of any kind."""

WORKSPACE_PARSED: Final = Limit(size=1 << 22)
"""Those source texts that one request of the editor needs parsed."""

REQUEST_LINE: Final = Limit(size=1 << 13)
"""The first line of a request to the playground, with its line end."""

REQUEST_HEAD: Final = Limit(size=1 << 15, values=100)
"""The first line and the header lines of a request to the playground; ``values`` counts lines."""

MESSAGE_HEAD: Final = Limit(size=1 << 13)
"""A header line of the language server's protocol."""

TRACE_LINE: Final = Limit(size=1 << 20, depth=32, values=50_000)
"""A row of a trace; the number of rows has no limit, since traces are read as a stream.

``depth`` and ``values``, counted as commas, are those of a line of JSON. Generated monitors have the same limits.
"""

MINED_TRACE: Final = Limit(size=1 << 28)
"""A trace that `tltlc mine` holds in memory."""

RECORDING: Final = Limit(size=1 << 28, unpacked=1 << 28)
"""A recorded episode."""

RECORDED_TEXTS: Final[Mapping[str, Limit]] = {
    "meta": Limit(size=1 << 24, depth=100, values=200_000),
    "artefact": ARTEFACT,
}
"""The JSON in a recorded episode, unpacked: a file may be a thousand times smaller than what is compressed in it."""

POLICY: Final = Limit(size=1 << 26)
"""A trained policy."""

CHECKPOINT: Final = Limit(size=1 << 30, depth=32, values=1_000_000)
"""A checkpoint of a training."""

MEASUREMENTS: Final = Limit(size=1 << 30)
"""The measurements of a training, a line an iteration; each line has the limits of :data:`TRACE_LINE`."""

REVISION: Final = Limit(size=1 << 28, values=20_000)
"""The files of a git revision that are read."""

REVISION_PATHS: Final = Limit(size=1 << 29, values=5_000_000)
"""All paths of a git revision, folders too: ``values`` counts paths, ``size`` the bytes of the list of them."""

REVISION_PATH: Final = Limit(size=1 << 20)
"""One path in that list."""

UNPACKED_PATH: Final = Limit(size=4096, depth=100)
"""A path in a git revision or another archive that is unpacked; ``depth`` counts its parts."""

UNPACKED_NAME: Final = Limit(size=255)
"""A part of such a path: no common file system allows longer ones."""

PLAYGROUND: Final = Connections(most=64, idle_s=15.0, request_s=20.0, write_s=30.0, linger_s=2.0)
"""The connections to the playground's server."""

PLAYGROUND_CHILD: Final = Process(memory=2 << 30, work_s=60)
"""A process that answers one request to the playground."""

COMMAND: Final = Process(memory=4 << 30, work_s=120)
"""What a command that reads files and ends by itself uses at most, unless `tltlc --max-cpu --max-memory` say otherwise.

The last bound: the work that :data:`WORK` counts ends long before.
"""

WORK: Final[Mapping[str, int]] = {
    "check of a predicate": 600_000,
    "checks of all predicates": 1_500_000,
    "arithmetic of all atoms": 200_000,
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
"""How many steps a checker may take, by what it counts."""


def too_deep(source: SourceFile, limit: Limit, span: Span | None = None) -> TltlError:
    """TLT0006: a text nests deeper than a reader takes; ``span`` is where, if that is known."""
    return _structure(source, f"nests deeper than {limit.depth} levels", "flatten it", span)


def too_many(source: SourceFile, limit: Limit, span: Span | None = None) -> TltlError:
    """TLT0006: a text holds more values than a reader takes; ``span`` is where, if that is known."""
    what = f"holds more than {limit.values:,} values"
    return _structure(source, what, "split it, or leave out what nothing reads", span)


def _structure(source: SourceFile, what: str, help_: str, span: Span | None) -> TltlError:
    labels = (Label(source, span),) if span is not None else ()
    return TltlError([Diagnostic("TLT0006", f"`{source.name}` {what}", labels, help_)])
