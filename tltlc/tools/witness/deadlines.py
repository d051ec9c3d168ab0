"""The times that matter to automata whose clock varies: those of their deadlines and windows."""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.automaton.fspa import Fspa

_WITHOUT_DEADLINE_S = 1.0


def shortest_deadline_s(automata: Iterable[Fspa]) -> float:
    """Return the shortest time that a register of the automata is compared with, in seconds; 1 s if there is none.

    A register that counts time stops at twice the greatest time that it is compared with.
    """
    maxima = (register.high for fspa in automata for register in fspa.registers if register.unit == "s")
    return min((high / 2 for high in maxima if high), default=_WITHOUT_DEADLINE_S)
