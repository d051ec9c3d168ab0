"""Print the tables of a monitor's states in C."""

from __future__ import annotations

from tltlc.program.printer import Printer
from tltlc.program.shapes import StateTables
from tltlc.resolve.spec import JudgeMode


def tables_text(tables: StateTables, judge: JudgeMode) -> str:
    """Return the definitions of the tables that a step reads if the spec is judged as ``judge`` says."""
    lines: list[str] = []
    for name, numbers in tables.step_tables(judge).items():
        type_ = "double" if name == "level_progress" else "unsigned short" if max(numbers) < 1 << 16 else "int"
        lines += f"static const {type_} {name}[] = {{{Printer.items([*map(repr, numbers)])}}};".split("\n")
    return Printer.block(lines)
