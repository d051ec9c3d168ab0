"""Automata whose monitors read tables of states."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from math import inf
from unittest.mock import patch

from tests.unfolded import unfolded
from tltlc import compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.logic import formula as f
from tltlc.program import shapes


@cache
def counting(seconds: float = 10.0) -> Fspa:
    """Return an automaton that counts the steps of some seconds: 602 states by default."""
    rule = f"spec quiet {{ keep pit implies next always for {seconds} s not pit }}"
    with unfolded():
        (fspa,) = compile_text(f"clock 60 Hz\nsignal pit: bool\n{rule}\n")
    return fspa


def in_order(count: int) -> Fspa:
    """Return an automaton with a state for each of some goals and one more; no two states share code."""
    order = f.atom(f"g{count}")
    for number in range(count - 1, 0, -1):
        order = f.then(f.atom(f"g{number}"), order)
    return build(spec_from_formula(order))


@contextmanager
def with_tables() -> Iterator[None]:
    """Let all monitors read tables of states, even those of small automata."""
    with patch.object(shapes, "_LEAST_STATES", 0), patch.object(shapes, "_MOST_CODE", inf):
        yield
