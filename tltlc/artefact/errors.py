"""What the generated validator raises."""

from __future__ import annotations


class JsonSchemaValueException(ValueError):
    """A value breaks the schema.

    ``place`` is where (``data.states[0].id``), ``rule`` the schema's keyword; the message begins with the place.
    """

    def __init__(self, message: str, place: str, rule: str) -> None:
        super().__init__(message)
        self.place = place
        self.rule = rule
