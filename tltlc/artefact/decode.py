"""Decode artefacts (files of compiled automata) to automata, from their text or from parsed JSON."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from typing import Any

from tltlc.artefact.document_checks import RECOMPILE, Origin, check_arithmetic, check_consistency, check_format
from tltlc.automaton.fspa import NOTATIONS, BrokenClause, Edge, Fspa, Guard, Implicant, Pair, State, Text
from tltlc.core.names import split_name
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.expression.json import from_json
from tltlc.io.json_text import JsonLimitError, first_non_finite, loads
from tltlc.io.limits import ARTEFACT
from tltlc.logic.formula import Formula
from tltlc.logic.text.parser import FormulaParser
from tltlc.logic.text.printer import is_ascii_text
from tltlc.resolve.spec import Atom, Param, Register, Signal, Timer


def decode(document: object, name: str) -> Fspa:
    """Return the automaton of an artefact whose JSON is already parsed.

    ``name`` is the name of the artefact in messages. Whole numbers may be floats such as ``3.0``.
    Unknown fields are ignored, except in the expressions of atoms. Errors point into the text that
    :func:`json.dumps` writes for the document.

    Raises:
        TltlError: TLT0006 the document nests too deep, or its arithmetic is too large; TLT0601 it
            is not an artefact, or has a number that is not finite; TLT0602 it has another version;
            TLT0603 it does not fit the schema; TLT0604 its parts contradict each other.
    """
    constant = first_non_finite(document)
    if constant is not None:
        raise _not_finite(name, constant)
    return _decode_and_check(document, Origin(name, lambda: SourceFile(name, json.dumps(document, ensure_ascii=False))))


def read(source: SourceFile) -> Fspa:
    """Return the automaton of an artefact, given its text.

    Raises:
        TltlError: the errors of :func:`decode`, and also TLT0006 the text has too many values, and
            TLT0601 the text is not JSON.
    """
    return _decode_and_check(_parse(source), Origin(source.name, lambda: source))


def _parse(source: SourceFile) -> object:
    try:
        return loads(source.text, ARTEFACT, _refuse)
    except json.JSONDecodeError as error:
        where = Label(source, Span(error.pos, min(error.pos + 1, len(source.text))), _label_message(error.msg))
        raise TltlError([Diagnostic("TLT0601", f"`{source.name}` is not JSON", (where,), RECOMPILE)]) from None
    except _NonFiniteNumberError as error:
        raise _not_finite(source.name, str(error)) from None
    except JsonLimitError as error:
        raise TltlError([Diagnostic("TLT0006", f"`{source.name}` cannot be read: {error}", help=RECOMPILE)]) from None


class _NonFiniteNumberError(Exception):
    """Raised for ``NaN`` and ``Infinity``, which Python's parser would accept."""


def _refuse(constant: str) -> None:
    raise _NonFiniteNumberError(constant)


def _not_finite(name: str, constant: str) -> TltlError:
    return TltlError(
        [Diagnostic("TLT0601", f"`{name}` is not JSON: {constant} is not a finite number", help=RECOMPILE)]
    )


def _label_message(message: str) -> str:
    """Return a message of Python's JSON parser in the style of tltlc: "Expecting value" as "expecting value"."""
    return (message[:1].lower() + message[1:]).removesuffix(" at").removesuffix(" starting")


def _decode_and_check(document: object, origin: Origin) -> Fspa:
    try:
        fspa = _fspa(check_format(document, origin))
        check_arithmetic(fspa, origin)
        check_consistency(fspa, origin)
    except RecursionError:
        title = f"`{origin.name}` cannot be read: it nests too deep"
        raise TltlError([Diagnostic("TLT0006", title, help=RECOMPILE)]) from None
    return fspa


# --- from a document that fits the schema -------------------------------------------------------------


def _fspa(document: dict[str, Any]) -> Fspa:
    spec = document["spec"]
    limit = spec["limit_steps"]
    atoms = tuple(_atom(atom) for atom in document["atoms"])
    formula = _formula_reader(atoms)
    return Fspa(
        name=spec["name"],
        doc=spec["doc"],
        formula=formula(spec["formula"]),
        level=spec["level"],
        limit_steps=None if limit is None else int(limit),
        judge=spec["judge"],
        semantics=document["semantics"],
        tags=tuple(spec.get("tags", ())),
        clock_s=_number(spec.get("clock_s")),
        clock_varies=spec.get("clock_varies", False),
        clauses=tuple(spec.get("clauses", ())),
        signals=tuple(_signal(signal) for signal in document["signals"]),
        params=tuple(_param(param) for param in document["params"]),
        atoms=atoms,
        registers=tuple(_register(register) for register in document.get("registers", ())),
        exclusive=tuple(tuple(int(atom) for atom in group) for group in document["exclusive"]),
        states=tuple(_state(state, formula) for state in document["states"]),
        edges=tuple(_edge(edge, formula) for edge in document["edges"]),
        spec_size=int(document["spec_size"]),
        acceptance=tuple(_pair(pair) for pair in document.get("acceptance", {"pairs": ()})["pairs"]),
    )


def _pair(pair: dict[str, Any]) -> Pair:
    fin, inf = (tuple(int(edge) for edge in pair[kind]) for kind in ("fin", "inf"))
    return Pair(fin, inf)


_FormulaReader = Callable[[dict[str, str]], Formula | Text]


def _formula_reader(atoms: Iterable[Atom]) -> _FormulaReader:
    """Return a function that reads a formula from its texts.

    The function takes the texts by notation: ``{"ascii": …, "unicode": …, "english": …}``. It parses the
    ASCII text to a formula. If tltlc cannot parse this text, or would print the formula differently,
    the function returns the texts as a :class:`Text` instead.
    """
    parser = FormulaParser(atom.name for atom in atoms)

    def read(text: dict[str, str]) -> Formula | Text:
        formula = parser.formula(text["ascii"])
        # Another tool may have written the text with other precedences of operators. Then it means something else here.
        if formula is not None and is_ascii_text(formula, text["ascii"]):
            return formula
        return Text(text["ascii"], text["unicode"], text["english"])

    return read


def _number(value: float | None) -> float | None:
    return None if value is None else float(value)


def _signal(signal: dict[str, Any]) -> Signal:
    low, high = signal["range"]
    base, arguments = split_name(signal["name"])
    values = tuple(signal.get("values", ()))
    return Signal(base, signal["type"], _number(low), _number(high), signal.get("doc", ""), arguments, values)


def _param(param: dict[str, Any]) -> Param:
    low, high = param.get("range", (None, None))
    value = float(param["value"])
    return Param(param["name"], param["type"], value, _number(low), _number(high), param.get("doc", ""))


def _atom(atom: dict[str, Any]) -> Atom:
    base, arguments = split_name(atom["name"])
    timer = Timer(tuple(atom["timer"].get("later", ()))) if "timer" in atom else None
    return Atom(base, from_json(atom["expression"]), atom.get("doc", ""), arguments, timer)


def _register(register: dict[str, Any]) -> Register:
    low, high = map(_number, register["range"])
    initial, update = float(register["initial"]), from_json(register["update"])
    return Register(register["name"], register["kind"], register["unit"], low, high, initial, update)


def _state(state: dict[str, Any], formula: _FormulaReader) -> State:
    distance = state["distance"]
    return State(
        int(state["id"]),
        formula(state["label"]),
        state["accepting"],
        state["verdict"],
        None if distance is None else int(distance),
    )


def _edge(edge: dict[str, Any], formula: _FormulaReader) -> Edge:
    guard = edge["guard"]
    text = dict.fromkeys(NOTATIONS, guard["text"])
    primes = _primes(guard["primes"])
    broken = tuple(
        BrokenClause(int(clause["clause"]), _primes(clause["primes"]) if "primes" in clause else primes)
        for clause in edge.get("broken", ())
    )
    return Edge(int(edge["source"]), int(edge["target"]), Guard(formula(text), primes), broken)


def _primes(primes: list[list[list[Any]]]) -> tuple[Implicant, ...]:
    return tuple(tuple((int(index), polarity) for index, polarity in prime) for prime in primes)
