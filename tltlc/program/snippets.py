"""Texts that generated files in several languages share: comments, and literals of strings and numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.samples import range_text
from tltlc.program.build import Program
from tltlc.program.names import printable_line
from tltlc.resolve.spec import Param, Signal

_LONGEST_EXAMPLE = 60
_UNITS = {"length": " m", "time": " s", "speed": " m/s", "angle": " rad"}
_KINDS = {"ratio": "A ratio in", "int": "A whole number in"}


def title_comment(fspa: Fspa, comment: Callable[[str], list[str]]) -> str:
    """Return the comment that begins a file: the name of the spec, its documentation and its formula.

    ``comment`` converts a text to the lines of a comment.
    """
    about = [comment(f"Monitor of the specification `{fspa.name}`, written by tltlc."), comment(fspa.doc)]
    about.append([line.replace(" ", "     ", 1) for line in comment(str(fspa.formula))])
    mark = about[0][0].split()[0]
    return f"\n{mark}\n".join("\n".join(lines) for lines in about if lines)


def field_comment(name: str, field: Signal | Param, escape: Callable[[str], str] = str) -> str:
    """Return the comment on a signal or parameter: its documentation and its possible values.

    ``name`` is its name in the generated file. If its name in the spec is different, the comment
    begins with the name in the spec. ``escape`` escapes characters that have a meaning in a
    comment. It is applied to the name and the documentation.
    """
    # A documented bool needs no "True or false."
    values = "" if field.doc and field.type == "bool" else values_sentence(field)
    doc = f"{field.doc}." if values and field.doc[-1:].isalnum() else field.doc
    text = f"{escape(doc)} {values}".strip()
    return text if field.name == name else f"{escape(field.name)}: {text}"


def values_sentence(field: Signal | Param) -> str:
    """Return a sentence with the possible values of a signal or parameter, in SI units, such as "In [0, 1]."."""
    if field.type == "bool":
        return "True or false."
    if isinstance(field, Signal) and field.values:
        return f"{', '.join(f'{number} {name}' for number, name in enumerate(field.values))}."
    return f"{_KINDS.get(field.type, 'In')} {range_text(field.low, field.high)}{_UNITS.get(field.type, '')}."


def range_tests(value: str, field: Signal | Param) -> list[str]:
    """Return the comparisons of ``value``, a text, with the ends of a range, as most languages write them."""
    tests = [] if field.low is None else [f"{value} >= {number_literal(field.low)}"]
    return tests if field.high is None else [*tests, f"{value} <= {number_literal(field.high)}"]


def common_blocks(program_: Program) -> list[str]:
    """Return the names of the blocks of templates that say the same about a monitor in every language."""
    return [
        "states" if program_.tables is None else "tables",
        "exclusive" if program_.exclusive else "single",
        "varies" if program_.fspa.clock_varies else "fixed",
        enum_block(program_.fspa),
        *(["registers"] if program_.registers else []),
    ]


def enum_block(fspa: Fspa) -> Literal["enums", "no_enums"]:
    """Return the name of the block of a template for specs with enums, or of that for specs without them."""
    return "enums" if any(signal.values for signal in fspa.signals) else "no_enums"


def failure_texts(program_: Program) -> list[tuple[str | None, str | None]]:
    """Return the clause and the atom of what a step can fail at, in the order of ``program_.failures``."""
    fspa = program_.fspa
    return [
        (None if clause is None else fspa.clauses[clause], None if atom is None else fspa.atoms[atom].name)
        for clause, atom in program_.failures
    ]


def example_sample(signals: Sequence[Signal], key: Callable[[str], str], equals: str) -> str:
    """Return an example of a sample for a comment: ``{ health: …, seen: true }``.

    The example is written as in the language of the generated file. ``key`` returns the name of a
    signal as this language writes it, and ``equals`` is the text between the name and its value. If
    the example is too long, return the word ``signals`` instead.
    """
    shown = [f"{key(signal.name)}{equals}{'true' if signal.type == 'bool' else '…'}" for signal in signals[:2]]
    text = f"{{ {', '.join([*shown, *(['…'] if len(signals) > 2 else [])])} }}" if signals else "{}"
    return printable_line(text) if len(text) <= _LONGEST_EXAMPLE else "signals"


def string_literal(text: str, escape: Callable[[str], str], plain: Callable[[str], bool] = str.isprintable) -> str:
    """Return a string literal in double quotes; ``escape`` replaces characters that are not ``plain``."""
    return '"' + "".join(_character(character, escape, plain) for character in text) + '"'


def _character(character: str, escape: Callable[[str], str], plain: Callable[[str], bool]) -> str:
    if character in '"\\':
        return f"\\{character}"
    return character if plain(character) else escape(character)


def is_plain_ascii(character: str) -> bool:
    """Whether the character is a printable ASCII character."""
    return " " <= character <= "~"


def boolean_literal(value: bool) -> str:
    """Return ``true`` or ``false``."""
    return "true" if value else "false"


def paragraphs(*parts: Sequence[str]) -> list[str]:
    """Return the lines of all parts that are not empty, with an empty line between each two parts."""
    return "\n\n".join("\n".join(part) for part in parts if part).split("\n")


def number_literal(value: float | None, otherwise: str = "") -> str:
    """Return a float literal in the syntax that most languages share.

    Return ``otherwise`` if the value is None.
    """
    return otherwise if value is None else repr(float(value))
