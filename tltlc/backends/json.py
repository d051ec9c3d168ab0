"""The JSON artefact, which monitors, training and all other tools load."""

from __future__ import annotations

from typing import Any

from tltlc.artefact.decode import decode
from tltlc.artefact.encode import encode
from tltlc.artefact.errors import JsonSchemaValueException
from tltlc.artefact.layout import layout
from tltlc.artefact.locations import Path, path_of, span_of
from tltlc.artefact.size import check_size, least_size
from tltlc.artefact.validator import validate
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.expression.tree import depth, most_parts
from tltlc.io.limits import ARITHMETIC, ARTEFACT

TARGET = Target("json", "the automaton as JSON, for every tool that loads one", (".fspa.json",))

VERSION = 1
MOST_PROBLEMS = 5
RECOMPILE = "compile the spec again"


def emit(fspa: Fspa, options: Options) -> Files:
    """Return ``NAME.fspa.json``, checked against the schema.

    Raises:
        TltlError: TLT0004 the file would be larger than :func:`read` accepts; TLT0006 it would have
            more values.
        ValueError: the automaton cannot be written in the format (a bug of the construction).
    """
    subject = f"the artefact of `{fspa.name}`"
    # This finds most automata that are too large before any text is built.
    check_size(subject, *least_size(fspa))
    document = encode(fspa)
    validate(document)
    blocks: list[str] = []
    size = commas = 0
    for block in layout(document):
        blocks.append(block)
        size, commas = size + len(block.encode()), commas + block.count(",")
        check_size(subject, size, commas)
    return {f"{fspa.name}.fspa.json": "".join(blocks)}


def read(text: str, name: str) -> Fspa:
    """Return the automaton of an artefact; messages call the artefact ``name``.

    Raises:
        TltlError: TLT0006 it is too large or nests too deep, TLT0601 it is not an artefact, TLT0602
            it has another version, TLT0603 it does not fit the schema, TLT0604 it is inconsistent.
    """
    from tltlc.artefact.consistency import problems

    source = SourceFile(name, text)
    try:
        fspa = decode(_document(source))
        _check_arithmetic(fspa, source)
        diagnostics = []
        for problem in problems(fspa):
            diagnostics.append(_problem(source, "TLT0604", problem.message, problem.path))
            if len(diagnostics) == MOST_PROBLEMS:
                break
    except RecursionError:
        title = f"`{name}` cannot be read: it nests too deep"
        raise TltlError([Diagnostic("TLT0006", title, help=RECOMPILE)]) from None
    if diagnostics:
        raise TltlError(diagnostics)
    return fspa


def _check_arithmetic(fspa: Fspa, source: SourceFile) -> None:
    """Raise TLT0006 for the first atom whose expression is larger than any spec could produce."""
    for index, atom in enumerate(fspa.atoms):
        path = ("atoms", index, "expression")
        if depth(atom.expression) > ARITHMETIC.compared:
            title = f"the arithmetic of `{atom.name}` is more than {ARITHMETIC.compared} operators deep"
            raise TltlError([_problem(source, "TLT0006", title, path)])
        if most_parts(atom.expression) > ARITHMETIC.parts:
            title = f"the arithmetic of `{atom.name}` has a part with more than {ARITHMETIC.parts} cases or arguments"
            raise TltlError([_problem(source, "TLT0006", title, path)])


def _document(source: SourceFile) -> dict[str, Any]:
    """Return the parsed text after checking that it is an artefact of this version and fits the schema."""
    import json

    from tltlc.io.json_text import JsonLimitError, loads

    try:
        document = loads(source.text, ARTEFACT, _no_constant)
    except json.JSONDecodeError as error:
        where = Label(source, Span(error.pos, min(error.pos + 1, len(source.text))), _remark(error.msg))
        raise TltlError([Diagnostic("TLT0601", f"`{source.name}` is not JSON", (where,), RECOMPILE)]) from None
    except _NoNumberError as error:
        title = f"`{source.name}` is not JSON: {error} is no number"
        raise TltlError([Diagnostic("TLT0601", title, help=RECOMPILE)]) from None
    except JsonLimitError as error:
        raise TltlError([Diagnostic("TLT0006", f"`{source.name}` cannot be read: {error}", help=RECOMPILE)]) from None
    if not isinstance(document, dict) or document.get("format") != "fspa":
        title = f"`{source.name}` is JSON, but not an artefact"
        raise TltlError([Diagnostic("TLT0601", title, help="`tltlc compile` writes artefacts: NAME.fspa.json")])
    version = document.get("version")
    if isinstance(version, bool) or version != VERSION:
        raise TltlError([_other_version(source, version)])
    try:
        validate(document)
    except JsonSchemaValueException as error:
        raise TltlError([_broken_schema(source, error)]) from None
    return document


class _NoNumberError(Exception):
    """``NaN`` or ``Infinity``, which Python's parser would accept."""


def _no_constant(constant: str) -> None:
    raise _NoNumberError(constant)


def _remark(message: str) -> str:
    """Return the parser's message as the text of a label."""
    return (message[:1].lower() + message[1:]).removesuffix(" at").removesuffix(" starting")


def _other_version(source: SourceFile, version: object) -> Diagnostic:
    if not isinstance(version, int) or isinstance(version, bool):
        return _problem(source, "TLT0602", "this artefact does not say its version", ("version",))
    title = f"this artefact has version {version}, and only version {VERSION} can be read"
    return _problem(source, "TLT0602", title, ("version",), "use a newer tltlc" if version > VERSION else RECOMPILE)


def _broken_schema(source: SourceFile, error: JsonSchemaValueException) -> Diagnostic:
    from tltlc.artefact.schema_messages import worded

    return _problem(source, "TLT0603", worded(error), path_of(error.place))


def _problem(source: SourceFile, code: str, title: str, path: Path, advice: str | None = RECOMPILE) -> Diagnostic:
    span = span_of(source.text, path)
    line_end = source.text.find("\n", span.start, span.end)
    first_line = span if line_end < 0 else Span(span.start, line_end)
    return Diagnostic(code, title, (Label(source, first_line),), advice)
