"""The exception that the generated validator raises."""

from __future__ import annotations


class JsonSchemaValueException(ValueError):
    """Raised when a value does not match the schema.

    ``place`` is the value's place (``data.states[0].id``), ``rule`` the keyword of the schema that
    it breaks.  The message begins with the place.
    """

    def __init__(self, message: str, place: str, rule: str) -> None:
        super().__init__(message)
        self.place = place
        self.rule = rule
