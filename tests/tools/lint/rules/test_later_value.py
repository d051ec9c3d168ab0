"""TLT0480: two values of an enum in an `avoid` clause with `then`, which forbid more than the direct change."""

from __future__ import annotations

from itertools import pairwise, product

import pytest

from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text

MODES = ("idle", "alert", "chase")
BEFORE = f"{SIGNALS}signal mode: (idle, alert, chase)\nsignal door: (open, shut)\nsignal gate: (idle, alert, chase)\n"
GUARDS = "entity g1, g2\nentity guards = g1, g2\nsignal state(g: entity): (idle, alert, chase)\n"


def offered(text: str) -> str:
    """Return the clause that the help of the only TLT0480 offers."""
    (note,) = (found.diagnostic for found in findings_in(text) if found.diagnostic.code == "TLT0480")
    assert note.severity == "note"
    return (note.help or "").split("`")[1]


@pytest.mark.parametrize(
    "clause",
    [
        "avoid (mode is idle) then (mode is chase)",
        "avoid mode is idle then mode is chase",
        "avoid ((mode is idle) then ((mode is chase)))",
    ],
)
def test_a_later_value_gets_a_note(clause: str) -> None:
    assert offered(block(clause, before=BEFORE)) == "avoid previously mode is idle and mode is chase"


def test_the_offered_clause_forbids_the_direct_change_alone() -> None:
    texts = "avoid (mode is idle) then (mode is chase)", "avoid previously mode is idle and mode is chase"
    typed, direct = (compile_text(block(text, before=BEFORE))[0] for text in texts)
    for trace in product(range(3), repeat=4):
        pairs = [(trace[one], trace[other]) for one in range(4) for other in range(one + 1, 4)]
        for fspa, forbidden in ((typed, pairs), (direct, [*pairwise(trace)])):
            monitor = Monitor(fspa)
            steps = [monitor.step({"mode": float(value)}) for value in trace]
            assert (steps[-1].verdict == "violated") == ((0, 2) in forbidden), trace


def test_the_values_may_be_in_an_any() -> None:
    text = block("avoid any g in guards: (state(g) is idle then state(g) is chase)", before=GUARDS)
    clause = "avoid any g in guards: (previously state(g) is idle and state(g) is chase)"
    assert offered(text) == clause
    assert "TLT0480" not in codes(block(clause, before=GUARDS))


@pytest.mark.parametrize(
    "clause",
    [
        # With two values, a later one comes by a direct change.
        "avoid (door is open) then (door is shut)",
        "avoid (mode is idle) then (gate is chase)",
        "avoid (mode is idle) then (mode is idle)",
        "avoid (mode is idle) then (mode is not chase)",
        "avoid (mode is idle) then within 3 steps (mode is chase)",
        "avoid (mode is idle) then (mode is alert) then (mode is chase)",
        "avoid (mode is idle and a) then (mode is chase)",
        "avoid (begins mode is idle) then (mode is chase)",
        "avoid previously mode is idle and mode is chase",
        "reach mode is idle then mode is chase",
        "avoid (mode is idle) then (mode is chase)  // tltlc: allow TLT0480",
    ],
)
def test_other_clauses_get_none(clause: str) -> None:
    assert "TLT0480" not in codes(block(clause, before=BEFORE))
