"""Decode the JSON document of an artefact, which must match the schema, to the automaton."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from tltlc.automaton.fspa import Edge, Fspa, Guard, Pair, State, Text
from tltlc.core.names import split_name
from tltlc.expression.json import from_json
from tltlc.logic.formula import Formula
from tltlc.logic.text.parser import FormulaParser
from tltlc.resolve.spec import Atom, Param, Signal


def decode(document: dict[str, Any]) -> Fspa:
    """Return the automaton; whole numbers may be written as ``3.0``, and unknown fields are ignored."""
    spec = document["spec"]
    limit = spec["limit_steps"]
    label = _label_reader(document["atoms"])
    return Fspa(
        name=spec["name"],
        doc=spec["doc"],
        formula=label(spec["formula"]),
        level=spec["level"],
        limit_steps=None if limit is None else int(limit),
        judge=spec["judge"],
        semantics=document["semantics"],
        tags=tuple(spec.get("tags", ())),
        clock_s=_number(spec.get("clock_s")),
        signals=tuple(_signal(signal) for signal in document["signals"]),
        params=tuple(_param(param) for param in document["params"]),
        atoms=tuple(_atom(atom) for atom in document["atoms"]),
        exclusive=tuple(tuple(int(atom) for atom in group) for group in document["exclusive"]),
        states=tuple(_state(state, label) for state in document["states"]),
        edges=tuple(_edge(edge) for edge in document["edges"]),
        spec_size=int(document["spec_size"]),
        acceptance=tuple(_pair(pair) for pair in document.get("acceptance", {"pairs": ()})["pairs"]),
    )


def _pair(pair: dict[str, Any]) -> Pair:
    fin, inf = (tuple(int(edge) for edge in pair[kind]) for kind in ("fin", "inf"))
    return Pair(fin, inf)


def _label_reader(atoms: Iterable[dict[str, Any]]) -> Callable[[dict[str, str]], Formula | Text]:
    """Return a function that parses the ASCII text of a formula; a text that is none stays text."""
    parser = FormulaParser(atom["name"] for atom in atoms)

    def read(text: dict[str, str]) -> Formula | Text:
        return parser.formula(text["ascii"]) or Text(text["ascii"], text["unicode"], text["english"])

    return read


def _number(value: float | None) -> float | None:
    return None if value is None else float(value)


def _signal(signal: dict[str, Any]) -> Signal:
    low, high = signal["range"]
    base, arguments = split_name(signal["name"])
    return Signal(base, signal["type"], _number(low), _number(high), signal.get("doc", ""), arguments)


def _param(param: dict[str, Any]) -> Param:
    low, high = param.get("range", (None, None))
    value = float(param["value"])
    return Param(param["name"], param["type"], value, _number(low), _number(high), param.get("doc", ""))


def _atom(atom: dict[str, Any]) -> Atom:
    base, arguments = split_name(atom["name"])
    return Atom(base, from_json(atom["expression"]), atom.get("doc", ""), arguments)


def _state(state: dict[str, Any], label: Callable[[dict[str, str]], Formula | Text]) -> State:
    distance = state["distance"]
    return State(
        int(state["id"]),
        label(state["label"]),
        state["accepting"],
        state["verdict"],
        None if distance is None else int(distance),
    )


def _edge(edge: dict[str, Any]) -> Edge:
    guard = edge["guard"]
    primes = tuple(tuple((int(index), polarity) for index, polarity in prime) for prime in guard["primes"])
    return Edge(int(edge["source"]), int(edge["target"]), Guard(guard["text"], primes))
