"""Encode an automaton as the JSON document of an artefact, the file of a compiled automaton."""

from __future__ import annotations

from typing import Any, Final

from tltlc.automaton.fspa import NOTATIONS, BrokenClause, Edge, Fspa, Implicant, State
from tltlc.automaton.text import formula_text, guard_texts, label_text
from tltlc.expression.json import to_json
from tltlc.resolve.spec import Atom, Param, Register, Signal

VERSION: Final = 2
"""The newest version of the format. Automata without registers on a fixed clock are written as version 1."""


def encode(fspa: Fspa) -> dict[str, Any]:
    """Return an automaton as JSON data, with the keys in the order of the file.

    Signals, params and atoms without documentation have no key ``doc``.
    """
    version = VERSION if fspa.registers or fspa.clock_varies else 1
    return {
        "format": "fspa",
        "version": version,
        "spec": {
            "name": fspa.name,
            "doc": fspa.doc,
            "formula": _formula(fspa),
            "limit_steps": fspa.limit_steps,
            "judge": fspa.judge,
            "level": fspa.level,
            "tags": list(fspa.tags),
            "clock_s": fspa.clock_s,
            **({"clock_varies": True} if fspa.clock_varies else {}),
            **({"clauses": list(fspa.clauses)} if fspa.clauses else {}),
        },
        "semantics": fspa.semantics,
        "signals": [_signal(signal) for signal in fspa.signals],
        "params": [_param(param) for param in fspa.params],
        "atoms": [_atom(atom) for atom in fspa.atoms],
        **({"registers": [_register(register) for register in fspa.registers]} if version == VERSION else {}),
        "exclusive": [list(group) for group in fspa.exclusive],
        "states": [_state(fspa, state) for state in fspa.states],
        "initial": 0,
        "edges": _edges(fspa),
        "spec_size": fspa.spec_size,
        **_acceptance(fspa),
    }


def _atom(atom: Atom) -> dict[str, Any]:
    timer = {} if atom.timer is None else {"timer": {"later": list(atom.timer.later)} if atom.timer.later else {}}
    return {"name": atom.name, "expression": to_json(atom.expression), **timer, **_doc(atom.doc)}


def _acceptance(fspa: Fspa) -> dict[str, Any]:
    if fspa.semantics == "finite":
        return {}
    return {"acceptance": {"pairs": [{"fin": list(pair.fin), "inf": list(pair.inf)} for pair in fspa.acceptance]}}


def _formula(fspa: Fspa) -> dict[str, str]:
    return {notation: formula_text(fspa, notation) for notation in NOTATIONS}


def _label(fspa: Fspa, state: int) -> dict[str, str]:
    return {notation: label_text(fspa, state, notation) for notation in NOTATIONS}


def _doc(doc: str) -> dict[str, str]:
    return {"doc": doc} if doc else {}


def _signal(signal: Signal) -> dict[str, Any]:
    document: dict[str, Any] = {"name": signal.name, "type": signal.type, "range": [signal.low, signal.high]}
    values = {"values": list(signal.values)} if signal.values else {}
    return {**document, **values, **_doc(signal.doc)}


def _param(param: Param) -> dict[str, Any]:
    document: dict[str, Any] = {"name": param.name, "type": param.type, "value": param.value}
    return {**document, "range": [param.low, param.high], **_doc(param.doc)}


def _register(register: Register) -> dict[str, Any]:
    return {
        "name": register.name,
        "kind": register.kind,
        "unit": register.unit,
        "range": [register.low, register.high],
        "initial": register.initial,
        "update": to_json(register.update),
    }


def _state(fspa: Fspa, state: State) -> dict[str, Any]:
    return {
        "id": state.id,
        "label": _label(fspa, state.id),
        "accepting": state.accepting,
        "verdict": state.verdict,
        "distance": state.distance,
    }


def _edges(fspa: Fspa) -> list[dict[str, Any]]:
    # Equal literals share one list: a large automaton has millions of them.
    literals: dict[tuple[int, bool], list[int | bool]] = {}

    def literal(atom: int, polarity: bool) -> list[int | bool]:
        return literals.setdefault((atom, polarity), [atom, polarity])

    def implicants(primes: tuple[Implicant, ...]) -> list[list[list[int | bool]]]:
        return [[literal(*pair) for pair in prime] for prime in primes]

    def broken_clause(edge: Edge, broken: BrokenClause) -> dict[str, Any]:
        primes = {} if broken.primes == edge.guard.primes else {"primes": implicants(broken.primes)}
        return {"clause": broken.clause, **primes}

    def encoded(edge: Edge, guard: str) -> dict[str, Any]:
        primes = implicants(edge.guard.primes)
        broken = {"broken": [broken_clause(edge, part) for part in edge.broken]} if edge.broken else {}
        return {"source": edge.source, "target": edge.target, "guard": {"text": guard, "primes": primes}, **broken}

    return [encoded(edge, guard) for edge, guard in zip(fspa.edges, guard_texts(fspa), strict=True)]
