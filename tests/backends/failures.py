"""A spec of which traces break one clause or two together, and what monitors say of each step of a round."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.monitor import Monitor

ROUNDS: Final = ("..s.h", ".hs", "....", "a.", "b", "..h")
"""Rounds of steps, each after a reset: a letter names what happens at a step."""


def guarded() -> Fspa:
    """Return the automaton of a spec that ``s``, ``h`` and ``a`` break; ``b`` breaks two clauses at a step."""
    text = """
        signal seen: bool
        signal health in [0, 1]
        signal alarm: bool
        signal open: bool
        spec guarded {
            avoid seen
            keep health > 0.5
            keep alarm implies next open
            keep alarm implies next not open
        }
    """
    (fspa,) = compile_text(text)
    return fspa


def failure_lines(fspa: Fspa, no_step: str = "") -> Iterator[str]:
    """Yield, for each step, the label in words and what the trace fails at, as drivers print them.

    They print ``no_step`` while the trace has not failed.
    """
    for letters in ROUNDS:
        monitor = Monitor(fspa)
        for letter in letters:
            health = 0.25 if letter in "hb" else 1.0
            step = monitor.step({"seen": letter in "sb", "health": health, "alarm": letter == "a", "open": False})
            assert step.label_english == label_text(fspa, step.state)
            failed = (step.failed_clause or "", step.failed_atom or "", str(step.failed_step or no_step))
            yield "|".join((step.label_english, *failed))
