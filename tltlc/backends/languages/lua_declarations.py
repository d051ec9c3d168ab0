"""Declarations of a monitor in Lua: the types of its fields, and tables of signals, params, labels and failures."""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.backends.languages.lua_syntax import string_literal, table_key, table_text
from tltlc.program import snippets
from tltlc.program.label_texts import LabelTexts
from tltlc.program.names import printable_line
from tltlc.resolve.spec import Param, Signal


def field_annotation(name: str, type_: str, doc: str) -> str:
    """Return a comment ``---@field``, from which language servers read the type of a field of a class."""
    description = f" {printable_line(doc)}" if doc else ""
    return f"---@field {printable_line(table_key(name))} {type_}{description}"


def signal_type(signal: Signal) -> str:
    """Return the type of a signal's value, as language servers read it."""
    if signal.type == "bool":
        return "boolean | 0 | 1"
    return " | ".join(["number", *map(string_literal, signal.values)])


def label_texts_table(labels: LabelTexts) -> str:
    """Return the table of the texts of labels, each as its pieces."""
    return table_text([f"{{ {', '.join(map(string_literal, pieces))} }}" for pieces in labels.texts])


def declaration_row(field: Signal | Param, entries: str) -> str:
    """Return the row of a signal or param: its name, the given entries, its least and greatest value."""
    low, high = snippets.number_literal(field.low, "-huge"), snippets.number_literal(field.high, "huge")
    return f"{{ name = {string_literal(field.name)}, {entries}, low = {low}, high = {high} }}"


def failures_table(failures: Iterable[tuple[str | None, str | None]]) -> str:
    """Return the table of the clause and the atom of what a step can fail at; what is None is left out."""
    entries = [
        [
            f"{key} = {string_literal(text)}"
            for key, text in zip(("clause", "atom"), row, strict=True)
            if text is not None
        ]
        for row in failures
    ]
    return table_text([f"{{ {', '.join(row)} }}" if row else "{}" for row in entries])
