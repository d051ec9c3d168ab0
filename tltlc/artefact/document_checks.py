"""Check the JSON document of an artefact. Errors point at the wrong value in the text of the document."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from itertools import islice
from typing import Any, Final

from tltlc.artefact.consistency import problems
from tltlc.artefact.encode import VERSION
from tltlc.artefact.errors import JsonSchemaValueException
from tltlc.artefact.locations import JsonPath, span_of
from tltlc.artefact.validator import validate
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.expression.tree import Expression, depth, most_parts
from tltlc.io.limits import ARITHMETIC

MOST_PROBLEMS: Final = 5
"""The most contradictions of one artefact that are reported."""
RECOMPILE: Final = "compile the spec again"


class Origin:
    """Where a JSON document comes from, for messages that point into its text.

    ``name`` is the name of the document in messages. ``source`` is a function that returns the text. It
    is called only when an error first needs the text.
    """

    def __init__(self, name: str, source: Callable[[], SourceFile]) -> None:
        self.name = name
        self._source = source

    @cached_property
    def source(self) -> SourceFile:
        """The text of the document."""
        return self._source()

    def error(self, code: str, title: str, path: JsonPath, advice: str = RECOMPILE) -> Diagnostic:
        """Return an error that points at the first line of the value at ``path``."""
        span = span_of(self.source.text, path)
        line_end = self.source.text.find("\n", span.start, span.end)
        first_line = span if line_end < 0 else Span(span.start, line_end)
        return Diagnostic(code, title, (Label(self.source, first_line),), advice)


def check_format(document: object, origin: Origin) -> dict[str, Any]:
    """Return the document after checking that it is an artefact of this version and fits the schema.

    Raises:
        TltlError: TLT0601 the document is not an artefact, TLT0602 it has another version, TLT0603
            it does not fit the schema.
    """
    if not isinstance(document, dict) or document.get("format") != "fspa":
        title = f"`{origin.name}` is JSON, but not an artefact"
        raise TltlError([Diagnostic("TLT0601", title, help="`tltlc compile` writes artefacts: NAME.fspa.json")])
    version = document.get("version")
    if isinstance(version, bool) or version not in range(1, VERSION + 1):
        raise TltlError([_version_error(version, origin)])
    try:
        validate(document)
    except JsonSchemaValueException as error:
        raise TltlError([_schema_error(error, origin)]) from None
    return document


def check_arithmetic(fspa: Fspa, origin: Origin) -> None:
    """Check that the expressions of atoms and registers are within the limits that also apply to specs.

    Raises:
        TltlError: TLT0006 an expression has too many operators inside each other, or a part with too
            many cases or arguments.
    """
    checked: list[tuple[str, Expression, JsonPath]] = [
        (atom.name, atom.expression, ("atoms", index, "expression")) for index, atom in enumerate(fspa.atoms)
    ]
    checked += [
        (register.name, register.update, ("registers", index, "update"))
        for index, register in enumerate(fspa.registers)
    ]
    for name, expression, path in checked:
        if depth(expression) > ARITHMETIC.compared:
            title = f"the arithmetic of `{name}` is more than {ARITHMETIC.compared} operators deep"
            raise TltlError([origin.error("TLT0006", title, path)])
        if most_parts(expression) > ARITHMETIC.parts:
            title = f"the arithmetic of `{name}` has a part with more than {ARITHMETIC.parts} cases or arguments"
            raise TltlError([origin.error("TLT0006", title, path)])


def check_consistency(fspa: Fspa, origin: Origin) -> None:
    """Check that the parts of an automaton agree with each other.

    Raises:
        TltlError: TLT0604 the parts contradict each other; the error has at most
            :data:`MOST_PROBLEMS` contradictions, the first ones.
    """
    first = islice(problems(fspa), MOST_PROBLEMS)
    errors = [origin.error("TLT0604", problem.message, problem.path) for problem in first]
    if errors:
        raise TltlError(errors)


def _version_error(version: object, origin: Origin) -> Diagnostic:
    if not isinstance(version, int) or isinstance(version, bool):
        return origin.error("TLT0602", "this artefact does not say its version", ("version",))
    title = f"this artefact has version {version}, and only versions 1 to {VERSION} can be read"
    advice = "use a newer tltlc" if version > VERSION else RECOMPILE
    return origin.error("TLT0602", title, ("version",), advice)


def _schema_error(error: JsonSchemaValueException, origin: Origin) -> Diagnostic:
    from tltlc.artefact.schema_messages import schema_error_title

    return origin.error("TLT0603", schema_error_title(error), error.path)
