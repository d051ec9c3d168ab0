"""A document gives the automaton and the errors that its text gives."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.strategies import automata, hostile_automata, infinite_automata
from tests.backends.test_schema import DOCUMENT, DOCUMENTS, PLACES
from tests.fuzzing import times
from tltlc import backends, compile_text
from tltlc.artefact.decode import decode, read
from tltlc.automaton.fspa import Fspa, Text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

WRONG = (None, True, -1, 1.5, 7, "é\n", [], {}, [[]], math.nan, math.inf, -math.inf, {"op": "+"})


def result(decoder: Callable[[], Fspa]) -> Fspa | tuple[Diagnostic, ...]:
    """Return the automaton, or the errors."""
    try:
        return decoder()
    except TltlError as error:
        return error.diagnostics


def errors(document: object) -> tuple[Diagnostic, ...]:
    with pytest.raises(TltlError) as caught:
        decode(document, "bot/artefact")
    return caught.value.diagnostics


@times(25)
@given(automata() | infinite_automata() | hostile_automata())
def test_the_document_of_an_automaton_is_decoded_unchanged(fspa: Fspa) -> None:
    (text,) = backends.emit("json", fspa).values()
    assert decode(json.loads(str(text)), "bot/artefact") == fspa


@pytest.mark.parametrize("clause", ["reach seen", "keep once within 2 s seen"])
def test_the_document_on_a_clock_that_varies_is_decoded_unchanged(clause: str) -> None:
    (fspa,) = compile_text(f"clock varies signal seen: bool spec s {{ {clause} }}")
    (text,) = backends.emit("json", fspa).values()
    assert decode(json.loads(str(text)), "bot/artefact") == fspa


@times(60)
@given(st.sampled_from(PLACES), st.sampled_from(WRONG))
def test_a_damaged_document_has_the_errors_of_its_text(place: tuple[int, tuple[str | int, ...]], value: Any) -> None:
    index, path = place
    document = copy.deepcopy(DOCUMENTS[index])
    parent = document
    for step in path[:-1]:
        parent = parent[step]
    parent[path[-1]] = value
    text = json.dumps(document, ensure_ascii=False)
    assert result(lambda: decode(document, "x")) == result(lambda: read(SourceFile("x", text)))


@pytest.mark.parametrize("document", [None, [], "fspa", {"format": "gltf"}, {"format": "fspa"}])
def test_another_document_is_rejected_as_its_text_is(document: object) -> None:
    text = json.dumps(document)
    assert errors(document) == result(lambda: read(SourceFile("bot/artefact", text)))


@pytest.mark.parametrize(("number", "constant"), [(math.nan, "NaN"), (math.inf, "Infinity"), (-math.inf, "-Infinity")])
def test_a_number_that_is_not_finite_is_rejected_even_in_an_unknown_field(number: float, constant: str) -> None:
    (error,) = errors({**DOCUMENT, "generator": {"versions": [1.0, number]}})
    assert error.code == "TLT0601"
    assert error.title == f"`bot/artefact` is not JSON: {constant} is not a finite number"


def test_an_error_points_into_the_document_on_one_line() -> None:
    document = copy.deepcopy(DOCUMENT)
    document["states"][1]["distance"] = "2"
    (error,) = errors(document)
    (label,) = error.labels
    assert error.title == "`states[1].distance` must be a whole number or null"
    assert label.source.name == "bot/artefact"
    assert label.source.slice(label.span) == '"2"'
    assert json.loads(label.source.text) == document
    assert "\n" not in label.source.text


def test_a_document_that_nests_too_deep_is_rejected() -> None:
    expression: dict[str, Any] = {"const": 1}
    for _ in range(20_000):
        expression = {"op": "neg", "args": [expression]}
    atom = {**DOCUMENT["atoms"][0], "expression": expression}
    (error,) = errors({**DOCUMENT, "atoms": [atom, *DOCUMENT["atoms"][1:]]})
    assert error.code == "TLT0006"
    assert error.title == "`bot/artefact` cannot be read: it nests too deep"


@pytest.mark.parametrize("form", ["F[0,1]({b} | {inner})", "F[0,1] {inner}", "G[0,1](F[0,1]({b} & {inner}) | {a})"])
def test_a_short_label_is_read_at_once_even_if_its_formula_would_be_printed_too_long(form: str) -> None:
    document = copy.deepcopy(DOCUMENT)
    a, b, *_ = (atom["name"] for atom in document["atoms"])
    label = a
    for _ in range(60):
        label = form.format(inner=label, a=a, b=b)
    document["states"][1]["label"] = {"ascii": label, "unicode": "u", "english": "e"}
    assert decode(document, "bot/artefact").states[1].label == Text(label, "u", "e")
