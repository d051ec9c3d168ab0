"""Say in words why a document does not fit the schema, for readers who do not know JSON schemas."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.artefact.errors import JsonSchemaValueException
from tltlc.artefact.locations import JsonPath

_TYPES: Final = {
    "integer": "a whole number",
    "number": "a number",
    "string": "a text",
    "object": "an object",
    "array": "a list",
    "boolean": "true or false",
    "null": "null",
}

_REMARKS: Final = {
    "minProperties": "is empty",
    "maxProperties": "contains fields that do not go together",
    "minLength": "is empty",
    "minimum": "must be bigger than or equal to {}",
    "maximum": "must be smaller than or equal to {}",
    "exclusiveMinimum": "must be bigger than {}",
    "pattern": "must match pattern {}",
    "uniqueItems": "must contain unique items",
}


def schema_error_title(error: JsonSchemaValueException) -> str:
    """Return the title of a schema error, e.g. "`states[1].distance` must be a whole number or null"."""
    subject = f"`{_path_text(error.path)}`" if error.path else "the artefact"
    return f"{subject} {_remark(error)}"


def _remark(error: JsonSchemaValueException) -> str:
    definition = error.definition
    if error.rule == "type":
        types = [definition] if isinstance(definition, str) else definition
        return f"must be {' or '.join(_TYPES[name] for name in types)}"
    if error.rule == "enum":
        return f"must be {_item_list(definition, ' or ')}"
    if error.rule == "required":
        return f"lacks {_item_list(error.fields, ' and ')}"
    if error.rule == "additionalProperties":
        return f"must not contain {_item_list(error.fields, ' and ')}"
    if error.rule == "dependencies":
        ((name, needed),) = definition.items()
        return f"missing dependency {needed} for {name}"
    if error.rule in ("minItems", "maxItems"):
        limit = "least" if error.rule == "minItems" else "most"
        return f"must contain at {limit} {definition} {'value' if definition == 1 else 'values'}"
    return _REMARKS[error.rule].format(definition)


def _path_text(path: JsonPath) -> str:
    """Return the text of a path: ``states[0].id`` for ``("states", 0, "id")``."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path).removeprefix(".")


def _item_list(values: Sequence[object], last: str) -> str:
    """Return values in backquotes: "`a`, `b` or `c`" if ``last`` is " or "."""
    items = [f"`{value}`" for value in values]
    return last.join([", ".join(items[:-1]), items[-1]]) if len(items) > 1 else items[0]
