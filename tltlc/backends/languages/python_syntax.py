"""The syntax of tuples and dicts in Python."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.program.printer import Printer


def tuple_items(items: Sequence[str]) -> Sequence[str]:
    """Return the items of a tuple; a single one ends with a comma."""
    return (f"{items[0]},",) if len(items) == 1 else items


def short_tuple(items: Sequence[str]) -> str:
    """Return the text of a tuple on one line."""
    return f"({', '.join(tuple_items(items))})"


def long_tuple(items: Sequence[str]) -> str:
    """Return the text of a tuple, with a line for each item; ``()`` if there are no items."""
    return "\n".join(["(", *(f"{Printer.INDENT}{item}," for item in items), ")"]) if items else "()"


def long_dict(items: Sequence[str]) -> str:
    """Return the text of a dict, with a line for each item; ``{}`` if there are no items."""
    return "\n".join(["{", *(f"{Printer.INDENT}{item}," for item in items), "}"]) if items else "{}"
