"""Check that a sample keeps to the ``exclusive`` declarations of a spec."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.errors import sample_error
from tltlc.monitor.samples import name_list


def check_exclusive(fspa: Fspa, values: Sequence[float], step: int) -> None:
    """Raise MonitorError (TLT0614) if two atoms of an ``exclusive`` declaration hold at once.

    ``values`` are the values of the atoms, and ``step`` is the number of the sample, from 1.
    """
    for group in fspa.exclusive:
        holding = [fspa.atoms[atom].name for atom in group if values[atom] > 0.0]
        if len(holding) > 1:
            declaration = ", ".join(fspa.atoms[atom].name for atom in group)
            raise sample_error("TLT0614", step, f"{name_list(holding)} hold at once, against `exclusive {declaration}`")
