"""Say in words why a document does not fit the schema, for readers who do not know JSON schemas."""

from __future__ import annotations

import ast

from tltlc.artefact.errors import JsonSchemaValueException

_TYPES = {
    "integer": "a whole number",
    "number": "a number",
    "string": "a text",
    "object": "an object",
    "array": "a list",
    "boolean": "true or false",
    "null": "null",
}

_COUNTS = {
    "minItems": "must contain at least {} {}",
    "maxItems": "must contain at most {} {}",
    "minProperties": "is empty",
    "maxProperties": "contains fields that do not go together",
    "minLength": "is empty",
}


def schema_error_title(error: JsonSchemaValueException) -> str:
    """Return the title of a schema error, e.g. "`states[1].distance` must be a whole number or null"."""
    place = error.place.removeprefix("data").removeprefix(".")
    subject = f"`{place}`" if place else "the artefact"
    remark = str(error).removeprefix(error.place).strip()
    if error.rule == "type":
        kinds = remark.removeprefix("must be ").split(" or ")
        return f"{subject} must be {' or '.join(_TYPES[kind] for kind in kinds)}"
    if error.rule == "enum":
        return f"{subject} must be {_list_items(remark.removeprefix('must be one of '), ' or ')}"
    if error.rule == "required":
        return (
            f"{subject} lacks {_list_items(remark.removeprefix('must contain ').removesuffix(' properties'), ' and ')}"
        )
    if error.rule == "additionalProperties":
        fields = _list_items(remark.removeprefix("must not contain ").removesuffix(" properties"), " and ")
        return f"{subject} must not contain {fields}"
    if error.rule in _COUNTS:
        count = "".join(word for word in remark.split() if word.isdigit())
        return f"{subject} {_COUNTS[error.rule].format(count, 'value' if count == '1' else 'values')}"
    return f"{subject} {remark}"


def _list_items(literal: str, last: str) -> str:
    """Return the items of a list in backquotes, separated by commas, with ``last`` before the last item.

    ``literal`` is the list as Python writes it.
    """
    items = [f"`{item}`" for item in ast.literal_eval(literal)]
    return last.join([", ".join(items[:-1]), items[-1]]) if len(items) > 1 else items[0]
