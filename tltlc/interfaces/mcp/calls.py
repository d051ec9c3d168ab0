"""Check the arguments of a call, and answer it; no exception leaves this module."""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from tltlc import __version__
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.formats.text import render
from tltlc.diagnostics.shortening import short_text
from tltlc.interfaces.mcp.answer import Answer, WrongUseError
from tltlc.interfaces.mcp.schemas import Schema
from tltlc.interfaces.mcp.tools import tools
from tltlc.io.limits import ANSWER
from tltlc.io.resources import OutOfTimeError, exhaustion_error, resource_limits

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError

_KINDS: Final = {
    "string": "a text",
    "integer": "a whole number",
    "number": "a number",
    "boolean": "true or false",
    "array": "a list",
    "object": "an object",
}


def argument_problem(schema: Schema, arguments: Mapping[str, Any]) -> str | None:
    """Return what is wrong with the arguments of a tool; None if they fit the schema."""
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import best_match

    error = best_match(Draft202012Validator(schema).iter_errors(arguments))
    return None if error is None else short_text(_problem(error))


def answer_call(name: str, arguments: Mapping[str, Any]) -> Answer:
    """Return the answer of the tool ``name``, within the limits of processor time and memory."""
    run = tools()[name].run
    assert run is not None
    try:
        with resource_limits():
            answer = run(arguments)
    except (Exception, OutOfTimeError) as error:
        return failure(error)
    if answer.document is not None and len(json.dumps(answer.document)) > ANSWER.size:
        return Answer(f"the answer would be larger than {ANSWER.size >> 20} MiB: ask for less", is_error=True)
    return answer


def failure(error: BaseException) -> Answer:
    """Return the answer for a call that an exception has ended."""
    limit_error = exhaustion_error(error)
    if limit_error is not None:
        # The traceback would keep the memory of the interrupted work alive.
        error.__traceback__ = error.__context__ = error.__cause__ = None
        error = limit_error
    if isinstance(error, WrongUseError):
        return Answer(short_text(str(error)), is_error=True)
    if isinstance(error, TltlError):
        return Answer(render(error.diagnostics).rstrip("\n"), is_error=True)
    if os.environ.get("TLTLC_DEBUG") == "1":
        traceback.print_exception(error, file=sys.stderr)
    place = traceback.extract_tb(error.__traceback__)[-1]
    where = f"{type(error).__name__} at {os.path.basename(place.filename)}:{place.lineno}"  # noqa: PTH119
    text = f"a bug in tltlc {__version__} stopped this call ({where}): please report it with what caused it"
    return Answer(text, is_error=True)


def _problem(error: ValidationError) -> str:
    """Say in words what is wrong with an argument."""
    name = "`" + ".".join(map(str, error.absolute_path)) + "`" if error.absolute_path else "the call"
    if error.validator == "required":
        missing = next(key for key in error.validator_value if key not in error.instance)
        return f"{name} needs the argument `{missing}`"
    if error.validator == "additionalProperties" and error.validator_value is False:
        known = error.schema["properties"]
        unknown = next(key for key in error.instance if key not in known)
        return f"{name} has no argument `{unknown}`; it has {', '.join(f'`{key}`' for key in known)}"
    if error.validator == "type":
        kinds = [error.validator_value] if isinstance(error.validator_value, str) else error.validator_value
        return f"{name} must be {' or '.join(_KINDS[kind] for kind in kinds)}"
    if error.validator == "enum":
        return f"{name} must be one of {', '.join(f'`{value}`' for value in error.validator_value)}"
    if error.validator == "pattern":
        return f"{name} has a character that the name of a file cannot have"
    if error.validator == "minItems":
        return f"{name} must not be empty"
    if error.validator in ("minimum", "exclusiveMinimum", "maximum"):
        relation = {"minimum": "at least", "exclusiveMinimum": "more than", "maximum": "at most"}[error.validator]
        return f"{name} must be {relation} {error.validator_value}"
    return f"{name}: {error.message}"
