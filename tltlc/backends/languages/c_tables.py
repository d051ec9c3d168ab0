"""Print the tables of a monitor's states in C."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.program.printer import Printer
from tltlc.program.shapes import StateTables
from tltlc.resolve.spec import JudgeMode

_LEVELS = ("state_levels", "level_progress")


def tables_text(tables: StateTables) -> str:
    """Return the definitions of the tables that every step reads."""
    return _text(tables.step_tables("limit"))


def levels_text(tables: StateTables, judge: JudgeMode) -> str:
    """Return the definitions of the tables with progress, which a step reads if the spec is judged at its goal."""
    return _text({name: numbers for name, numbers in tables.step_tables(judge).items() if name in _LEVELS})


def _text(tables: Mapping[str, Sequence[float]]) -> str:
    lines: list[str] = []
    for name, numbers in tables.items():
        type_ = "double" if name == "level_progress" else "unsigned short" if max(numbers) < 1 << 16 else "int"
        lines += f"static const {type_} {name}[] = {{{Printer.items([*map(repr, numbers)])}}};".split("\n")
    return Printer.block(lines)
