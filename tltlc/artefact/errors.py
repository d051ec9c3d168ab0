"""The exception that the generated validator raises."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tltlc.artefact.locations import JsonPath


class JsonSchemaValueException(ValueError):
    """Raised when a value does not match the schema.

    ``path`` leads to the value in the document. ``rule`` is the keyword of the schema that the value
    violates, such as ``type``. ``definition`` is what the schema says under this keyword, such as
    ``"string"``. ``fields`` are the names of the fields that are missing or not allowed; it is empty
    for other rules.
    """

    def __init__(self, path: JsonPath, rule: str, definition: Any, fields: Sequence[str] = ()) -> None:
        super().__init__(path, rule, definition, fields)
        self.path = path
        self.rule = rule
        self.definition = definition
        self.fields = fields
