"""Specs with bounds for RTAMT and Reelay, in past-time logic with Boolean signals.

A response within n samples, ``G(p -> F[0,n] q)``, holds of a prefix if and only if every p that is n
samples old has had its q, ``historically(once[n:n] p -> once[0:n] q)``, and none is open at the end of
the prefix, ``not (not q since (p and not q))``. Of the ways to write this, both tools are fastest with
this one. Neither RTAMT's ``always`` nor unbounded future operators exist in an online monitor, so
RTAMT's own rewriting of bounded future operators (``pastify``) does not apply.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from typing import Final

from benchmarks.bounds_specs import Trace
from benchmarks.engines.engine import field
from benchmarks.peer_monitors import Peer, reelay_monitor, rtamt_monitor

Literal = Callable[[str], str]
"""Writes a Boolean signal as an atom of a tool."""


def _formula(name: str, atom: Literal, previous: str) -> str:
    def response(request: str, answer: str) -> list[str]:
        return [
            f"(historically((once[300:300]{atom(request)}) implies (once[0:300]{atom(answer)})))",
            f"(not((not {atom(answer)}) since ({atom(request)} and (not {atom(answer)}))))",
        ]

    def begins(signal: str) -> str:
        return f"({atom(signal)} and (not({previous}({atom(signal)}))))"

    if name == "deadlines":
        return " and ".join(response("alarm", "hidden") + response("hidden", "out"))
    parts = [f"(historically({atom('boss_door')} implies (once({atom('double_jump')}))))"]
    for pit in ("falls_pit1", "falls_pit2", "falls_pit3"):
        parts += [f"(historically(not({begins(pit)} and (once[1:600]{begins(pit)}))))", f"(not{begins(pit)})"]
    parts += [f"(historically(not({atom('damage')} and (once[1:60]{begins('damage')}))))", f"(not{begins('damage')})"]
    for guard in ("answers_g1", "answers_g2", "answers_g3"):
        parts += response("alarm", guard)
    return " and ".join(parts)


def rtamt_peer(name: str, trace: Trace) -> Peer:
    """Return RTAMT's online monitor in discrete time, in Python; true is 1 and false is -1.

    RTAMT 0.4.10 updates the memory of equal subformulas once for each place where they stand, and then judges
    wrongly. So each place has a threshold of its own.
    """
    places = count()
    samples = [{field(signal): 2 * value - 1 for signal, value in sample.items()} for sample in trace]
    return rtamt_monitor(_formula(name, lambda signal: f"({signal} > {next(places) / 1000})", "s_prev"), samples)


def reelay_peer(name: str, trace: Trace) -> Peer:
    """Return Reelay's discrete Boolean monitor, a C++ library with a Python interface."""
    samples = [{field(signal): value > 0 for signal, value in sample.items()} for sample in trace]
    return reelay_monitor(_formula(name, lambda signal: f"{{{signal}}}", "pre"), samples, "boolean")


PEERS: Final[dict[str, Callable[[str, Trace], Peer]]] = {"RTAMT": rtamt_peer, "Reelay": reelay_peer}
