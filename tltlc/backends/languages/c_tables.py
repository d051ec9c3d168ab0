"""Print the tables of a monitor's states in C."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.backends.languages.c_text import string_literal
from tltlc.core.record import record
from tltlc.program.label_texts import LabelTexts
from tltlc.program.printer import Printer
from tltlc.program.shapes import StateTables
from tltlc.resolve.spec import JudgeMode

_LEVELS = ("state_levels", "level_progress")


@record
class Labels:
    """The items of an array of labels, and the lines that define the macros in them and that end these macros."""

    items: str
    macros: str = ""
    ends: str = ""


def shared_labels(labels: LabelTexts, macro: str) -> Labels:
    """Return the labels of all states; a text that several of them share is a macro, whose arguments are numbers.

    The names of the macros begin with ``macro``.
    """
    numbers, items = iter(labels.numbers), []
    for place in labels.state_texts:
        texts = labels.texts[place]
        arguments = ", ".join(str(next(numbers)) for _ in texts[1:])
        items.append(f"{macro}{place}_({arguments})" if arguments else string_literal(texts[0]))
    defines, ends = [], []
    for place, (first, *rest) in enumerate(labels.texts):
        if not rest:
            continue
        names = [f"n{number}" for number in range(len(rest))]
        pieces = [f"#{name} {string_literal(text)}" for name, text in zip(names, rest, strict=True)]
        defines.append(f"#define {macro}{place}_({', '.join(names)}) {string_literal(first)} {' '.join(pieces)}")
        ends.append(f"#undef {macro}{place}_")
    return Labels(Printer.items(items, depth=1), "\n".join(defines), "\n".join(ends))


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
