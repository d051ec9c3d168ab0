"""The exception that the generated validator raises."""

from __future__ import annotations


class JsonSchemaValueException(ValueError):
    """Raised when a value does not match the schema.

    ``place`` is the path of the value, such as ``data.states[0].id``; the message begins with it.
    ``rule`` is the keyword of the schema that the value violates, such as ``type``.
    """

    def __init__(self, message: str, place: str, rule: str) -> None:
        super().__init__(message)
        self.place = place
        self.rule = rule
