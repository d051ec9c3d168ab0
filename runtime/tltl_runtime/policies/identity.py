"""Hashes that identify specs and levels by their content."""

from __future__ import annotations

import hashlib
import json

from tltl_runtime.stealth.level import Level
from tltl_runtime.support.record_json import to_json
from tltlc.api import Fspa, expressions


def spec_hash(fspa: Fspa) -> str:
    """Return the SHA-256, in hexadecimal, of everything by which a spec judges an episode.

    The names of the spec and its atoms, labels and documentation do not count.
    """
    return _hash(
        {
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
    )


def level_hash(level: Level) -> str:
    """Return the SHA-256, in hexadecimal, of the content of a level.

    Its name, variant, documentation, spec, files and regions do not count.
    """
    left_out = ("name", "variant", "doc", "spec", "files", "regions")
    return _hash({name: value for name, value in to_json(level).items() if name not in left_out})


def _hash(document: object) -> str:
    text = json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()
