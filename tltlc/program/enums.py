"""The enums of a spec, and the names that their values get in generated code."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import NamedTuple

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.program.names import VariableNames


@record
class SignalEnum:
    """An enum: the base name of its signals, such as ``mode``, and the names of its values 0, 1, 2, in order.

    ``signals`` are the full names of its signals, such as ``mode(g1)`` and ``mode(g2)``.
    """

    base: str
    values: tuple[str, ...]
    signals: tuple[str, ...]


class NamedEnum(NamedTuple):
    """An enum in generated code: the name of its type, and the names of its constants, in order."""

    enum: SignalEnum
    type: str
    constants: tuple[str, ...]

    @property
    def title(self) -> str:
        """The sentence for a comment: "The values of the signal `mode`."."""
        return f"The values of the signal `{self.enum.base}`."


def enums_of(fspa: Fspa) -> tuple[SignalEnum, ...]:
    """Return the enums of the signals, in order of the first signal of each."""
    signals: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for signal in fspa.signals:
        if signal.values:
            signals.setdefault((signal.base, signal.values), []).append(signal.name)
    return tuple(SignalEnum(base, values, tuple(names)) for (base, values), names in signals.items())


def flat_enums(fspa: Fspa, reserved: Iterable[str], spell: Callable[[str], str] = str) -> tuple[NamedEnum, ...]:
    """Return the enums with constants that share one scope: ``MODE_ALERT``.

    The names are all different and none is ``reserved``. ``spell`` converts a name to the style of the
    language. The names of the types are empty.
    """
    names = VariableNames(reserved)
    return tuple(
        NamedEnum(enum, "", tuple(names.new_name(spell(f"{enum.base}_{value}")) for value in enum.values))
        for enum in enums_of(fspa)
    )


def nested_enums(
    fspa: Fspa, types: Iterable[str], members: Iterable[str], spell: Callable[[str], str], suffix: str = ""
) -> tuple[NamedEnum, ...]:
    """Return the enums with constants inside a type: ``Mode.ALERT``.

    ``types`` and ``members`` are reserved names of types and of constants. ``spell`` converts the name of
    a constant to the style of the language. A type has its name in Pascal case, and then ``suffix``.
    """
    names = VariableNames(types)
    enums = []
    for enum in enums_of(fspa):
        type_ = names.new_name(f"{pascal_case(enum.base)}{suffix}")
        inner = VariableNames({*members, type_})
        enums.append(NamedEnum(enum, type_, tuple(inner.new_name(spell(value)) for value in enum.values)))
    return tuple(enums)


def pascal_case(name: str) -> str:
    """Return a name in Pascal case: ``GuardMode`` for ``guard_mode``. Between digits, ``_`` stays."""
    pascal = ""
    for part in name.split("_"):
        gap = "_" if pascal[-1:].isdigit() and part[:1].isdigit() else ""
        pascal += f"{gap}{part[:1].upper()}{part[1:]}"
    return pascal


def upper_case(name: str) -> str:
    """Return a name in upper case with ``_`` between words: ``GUARD_MODE`` for ``guardMode``."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).upper()
