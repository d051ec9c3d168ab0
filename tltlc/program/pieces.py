"""Pieces of generated files that languages write alike, beside the program itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.samples import range_text
from tltlc.program.names import visible
from tltlc.resolve.spec import Param, Signal

_LONGEST_EXAMPLE = 60
_UNITS = {"length": " m", "time": " s", "speed": " m/s", "angle": " rad"}
_KINDS = {"ratio": "A ratio in"}


def title(fspa: Fspa, comment: Callable[[str], list[str]]) -> str:
    """The first comment: what the spec is called, what it is for, its formula; ``comment`` gives a text's lines."""
    about = [comment(f"Monitor of the specification `{fspa.name}`, written by tltlc."), comment(fspa.doc)]
    about.append([line.replace(" ", "     ", 1) for line in comment(fspa.formula.ascii)])
    mark = about[0][0].split()[0]
    return f"\n{mark}\n".join("\n".join(lines) for lines in about if lines)


def described(name: str, of: Signal | Param) -> str:
    """What is said of a field called ``name``: its name in the spec, where that is another, its text, its values."""
    # Of what is true or false the text says enough.
    values = "" if of.doc and of.type == "bool" else kind(of)
    doc = f"{of.doc}." if values and of.doc[-1:].isalnum() else of.doc
    said = f"{doc} {values}".strip()
    return said if of.name == name else f"{of.name}: {said}"


def kind(of: Signal | Param) -> str:
    """Which values it has, in SI units."""
    if of.type == "bool":
        return "True or false."
    return f"{_KINDS.get(of.type, 'In')} {range_text(of.low, of.high)}{_UNITS.get(of.type, '')}."


def example(signals: Sequence[Signal], key: Callable[[str], str], equals: str) -> str:
    """A sample, as a call gives it; it stands in a comment."""
    shown = [f"{key(signal.name)}{equals}{'true' if signal.type == 'bool' else '…'}" for signal in signals[:2]]
    text = f"{{ {', '.join([*shown, *(['…'] if len(signals) > 2 else [])])} }}" if signals else "{}"
    return visible(text) if len(text) <= _LONGEST_EXAMPLE else "signals"


def quoted(text: str, escape: Callable[[str], str], plain: Callable[[str], bool] = str.isprintable) -> str:
    """A string literal; characters that are not ``plain`` are escaped."""
    return '"' + "".join(_character(character, escape, plain) for character in text) + '"'


def _character(character: str, escape: Callable[[str], str], plain: Callable[[str], bool]) -> str:
    if character in '"\\':
        return f"\\{character}"
    return character if plain(character) else escape(character)


def in_ascii(character: str) -> bool:
    """Whether it is plain in a source of ASCII."""
    return " " <= character <= "~"


def boolean(value: bool) -> str:
    """``true`` or ``false``."""
    return "true" if value else "false"


def paragraphs(*parts: Sequence[str]) -> list[str]:
    """The lines of all parts, with an empty one between them."""
    return "\n\n".join("\n".join(part) for part in parts if part).split("\n")


def number(value: float | None, otherwise: str = "") -> str:
    """A number as most languages write doubles, which Python does, too; ``otherwise`` where there is none."""
    return otherwise if value is None else repr(float(value))
