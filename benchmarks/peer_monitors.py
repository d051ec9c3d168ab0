"""The paper's specs for RTAMT and Reelay, in past-time logic.

``F(a & X F(b & X F c)) & G p`` holds of a prefix if and only if
``once(c & previous once(b & previous once a)) & historically p`` holds at its end. Neither tool has
predicates with cases, so both get the values of the atoms, which are computed before the measured
time. Both compute only the robustness of the prefix: no state, no progress, no reward.

A peer is a function of a spec's name and of the values of the atoms. It returns two functions: one
runs the monitor over the trace, the other returns the outputs of a new monitor over the trace.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

Values = list[dict[str, float]]
Peer = tuple[Callable[[], None], Callable[[], list[float]]]

NAMES = {
    "near(s1)": "s1",
    "near(s2)": "s2",
    "near(s3)": "s3",
    "near(exit)": "exit",
    "near(e_right)": "right",
    "near(e_left)": "left",
    "open_right": "open_right",
    "open_left": "open_left",
    "alive": "alive",
}

RTAMT = {
    "navigation": "once((exit > 0) and (prev (once((s2 > 0) and (prev (once(s1 > 0)))))))",
    "cover_and_hide": "once((exit > 0) and (prev (once((s2 > 0) and (prev (once(s1 > 0)))))))"
    " and historically(alive > 0)",
    "branching": "once((((open_right > 0) and (right > 0)) or ((open_left > 0) and (left > 0))) and (prev "
    "(once((s3 > 0) and (prev (once((s2 > 0) and (prev (once(s1 > 0)))))))))) and historically(alive > 0)",
}

REELAY = {
    "navigation": "once({exit > 0} and pre(once({s2 > 0} and pre(once{s1 > 0}))))",
    "cover_and_hide": "once({exit > 0} and pre(once({s2 > 0} and pre(once{s1 > 0})))) and historically{alive > 0}",
    "branching": "once((({open_right > 0} and {right > 0}) or ({open_left > 0} and {left > 0})) and "
    "pre(once({s3 > 0} and pre(once({s2 > 0} and pre(once{s1 > 0})))))) and historically{alive > 0}",
}


def rtamt_monitor(formula: str, samples: Values) -> Peer:
    """Return RTAMT's online monitor of a formula in discrete time, in Python."""
    import rtamt  # type: ignore[import-untyped,import-not-found,unused-ignore]

    monitor = rtamt.StlDiscreteTimeSpecification()
    for signal in samples[0]:
        monitor.declare_var(signal, "float")
    monitor.declare_var("out_", "float")
    monitor.spec = f"out_ = {formula}"
    monitor.parse()
    rows = [[*sample.items()] for sample in samples]
    monitor.update(0, rows[0])  # a monitor that has seen nothing cannot be reset

    def outputs() -> list[float]:
        monitor.reset()
        return [float(monitor.update(step, row)) for step, row in enumerate(rows)]

    def run_pass() -> None:
        monitor.reset()
        update = monitor.update
        for step, row in enumerate(rows):
            update(step, row)

    return run_pass, outputs


def reelay_monitor(formula: str, samples: Sequence[Mapping[str, float]], semantics: str) -> Peer:
    """Return Reelay's discrete monitor of a formula, ``boolean`` or ``robustness``; a C++ library for Python.

    It has no reset, and making a monitor takes longer than the trace. So one monitor runs on through all timed passes.
    """
    import reelay  # type: ignore[import-untyped,import-not-found,unused-ignore]

    def new_monitor() -> Any:
        return reelay.discrete_timed_monitor(pattern=formula, semantics=semantics, condense=False)

    def outputs() -> list[float]:
        monitor = new_monitor()
        return [float(monitor.update(sample)["value"]) for sample in samples]

    update = new_monitor().update

    def run_pass() -> None:
        for sample in samples:
            update(sample)

    return run_pass, outputs


def _renamed(atoms: Values) -> Values:
    return [{NAMES[atom]: value for atom, value in values.items()} for values in atoms]


PEERS: dict[str, Callable[[str, Values], Peer]] = {
    "RTAMT": lambda name, atoms: rtamt_monitor(RTAMT[name], _renamed(atoms)),
    "Reelay": lambda name, atoms: reelay_monitor(REELAY[name], _renamed(atoms), "robustness"),
}
