"""The hash that identifies a spec by its content."""

from __future__ import annotations

from typing import Any

from tltl_runtime.support.json_hash import json_hash
from tltlc.api import Fspa, expressions


def spec_hash(fspa: Fspa) -> str:
    """Return the SHA-256, in hexadecimal, of everything by which a spec judges an episode.

    Two specs with equal hashes judge all episodes alike, and agents observe the same numbers of their
    automata. The names of the spec and of its atoms, its labels and its documentation do not change
    the hash. Only in a spec with registers, names of atoms do, because updates of registers read
    atoms by name.
    """
    content: dict[str, Any] = {
        "semantics": fspa.semantics,
        "judge": fspa.judge,
        "limit_steps": fspa.limit_steps,
        "clock_s": fspa.clock_s,
        "params": {param.name: param.value for param in fspa.params},
        "atoms": [expressions.to_json(atom.expression) for atom in fspa.atoms],
        "exclusive": fspa.exclusive,
        "states": [(state.accepting, state.verdict, state.distance) for state in fspa.states],
        "edges": [(edge.source, edge.target, edge.guard.primes) for edge in fspa.edges],
    }
    if fspa.clock_varies:
        content["clock_varies"] = True
    if fspa.registers:
        content["registers"] = [
            (register.name, register.low, register.high, register.initial, expressions.to_json(register.update))
            for register in fspa.registers
        ]
    return json_hash(content)
