from __future__ import annotations

import copy
import json
import random
from collections.abc import Iterator
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.backends.strategies import automata, infinite_automata
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tltlc import compile_text
from tltlc.artefact.encode import encode
from tltlc.artefact.errors import JsonSchemaValueException
from tltlc.artefact.generate import FOLDER, validator_source
from tltlc.artefact.schema_messages import schema_error_title
from tltlc.artefact.validator import validate
from tltlc.automaton.fspa import Fspa

SCHEMA = json.loads((FOLDER / "fspa.schema.json").read_text(encoding="utf-8"))
REFERENCE = jsonschema.Draft7Validator(SCHEMA)

WRONG = (None, True, -1, 1.5, "", "x", [], {}, [[]], 10**400, {"op": "+"}, {"const": 1, "op": "abs"})


def accepts(document: Any) -> bool:
    try:
        validate(document)
    except JsonSchemaValueException:
        return False
    return True


def test_the_validator_is_up_to_date_with_the_schema() -> None:
    assert (FOLDER / "validator.py").read_text(encoding="utf-8") == validator_source()


def test_the_schema_is_valid() -> None:
    jsonschema.Draft7Validator.check_schema(SCHEMA)


@settings(max_examples=30, deadline=None)
@given(automata() | infinite_automata())
def test_compiled_automata_match_the_schema(fspa: Fspa) -> None:
    document = encode(fspa)
    assert accepts(document)
    assert REFERENCE.is_valid(json.loads(json.dumps(document)))


def places(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from places(item, (*path, key))


DOCUMENT = json.loads(json.dumps(encode(cover_and_hide())))
(INFINITE,) = compile_text("signal a: bool signal b: bool spec s { semantics infinite reach a require G F b }")
DOCUMENTS = (DOCUMENT, json.loads(json.dumps(encode(INFINITE))))
PLACES = tuple((index, path) for index, document in enumerate(DOCUMENTS) for path in tuple(places(document))[1:])


@times(100)
@given(st.sampled_from(PLACES), st.sampled_from(("remove", "add", *range(len(WRONG)))))
def test_both_validators_agree_on_damaged_artefacts(
    place: tuple[int, tuple[str | int, ...]], damage: str | int
) -> None:
    index, path = place
    document = copy.deepcopy(DOCUMENTS[index])
    parent = document
    for step in path[:-1]:
        parent = parent[step]
    if damage == "remove":
        del parent[path[-1]]
    elif damage == "add":
        if isinstance(parent, dict):
            parent["extra"] = 1
        else:
            parent.append(random.Random(0).choice(WRONG))
    else:
        parent[path[-1]] = copy.deepcopy(WRONG[int(damage)])
    assert accepts(document) == REFERENCE.is_valid(document)


@pytest.mark.parametrize(
    "expression",
    [
        {},
        {"op": "+", "args": [{"const": 1}]},
        {"op": "neg", "args": [{"const": 1}, {"const": 2}]},
        {"op": "min", "args": [{"const": 1}]},
        {"op": "clamp", "args": [{"const": 1}, {"const": 1}]},
        {"op": "<", "args": [{"const": 1}, {"const": 1}]},
        {"op": "system", "args": [{"const": 1}]},
        {"op": "+", "args": [{"const": 1}, {"const": 1}], "signal": "x"},
        {"when": [[{"const": 1}, {"const": 1}]], "otherwise": {"const": 1}},
        {"when": [[{"op": "<", "args": [{"const": 1}]}, {"const": 1}]], "otherwise": {"const": 1}},
        {"when": [[{"op": "not", "args": [{"const": 1}]}, {"const": 1}]], "otherwise": {"const": 1}},
        {"when": [[{"op": "<", "args": [{"const": 1}, {"const": 2}]}, {"const": 1}]]},
        {"otherwise": {"const": 1}},
    ],
)
def test_meaningless_expressions_are_rejected(expression: dict[str, Any]) -> None:
    document = copy.deepcopy(DOCUMENT)
    document["atoms"][0]["expression"] = expression
    assert not accepts(document)
    assert not REFERENCE.is_valid(document)


@pytest.mark.parametrize(("index", "semantics"), [(0, "infinite"), (1, "finite")])
def test_an_artefact_has_pairs_only_over_infinite_traces(index: int, semantics: str) -> None:
    document = {**DOCUMENTS[index], "semantics": semantics}
    assert not accepts(document)
    assert not REFERENCE.is_valid(document)


@pytest.mark.parametrize("name", ["../x", "a b", "", "a.b", "1a", "a\n", "naïve"])
def test_names_of_specs_are_plain(name: str) -> None:
    document = copy.deepcopy(DOCUMENT)
    document["spec"]["name"] = name
    assert not accepts(document)


@pytest.mark.parametrize(
    ("path", "value", "title"),
    [
        (("states", 0, "accepting"), 0, "`states[0].accepting` must be true or false"),
        (("spec", "judge"), "me", "`spec.judge` must be `goal` or `limit`"),
        (("edges", 0, "guard", "primes"), [], "`edges[0].guard.primes` must contain at least 1 value"),
        (("atoms", 3, "expression", "b"), 1, "`atoms[3].expression` contains fields that do not go together"),
        (("atoms", 3, "expression"), {"b": 1}, "`atoms[3].expression` must not contain `b`"),
        (("states", 0), {"id": 0}, "`states[0]` lacks `accepting`, `distance`, `label` and `verdict`"),
    ],
)
def test_errors_are_in_plain_words(path: tuple[str | int, ...], value: object, title: str) -> None:
    document = copy.deepcopy(DOCUMENT)
    parent = document
    for step in path[:-1]:
        parent = parent[step]
    parent[path[-1]] = value
    with pytest.raises(JsonSchemaValueException) as caught:
        validate(document)
    assert schema_error_title(caught.value) == title


@times(60)
@given(st.sampled_from(PLACES), st.sampled_from(WRONG))
def test_every_error_is_in_plain_words(place: tuple[int, tuple[str | int, ...]], wrong: object) -> None:
    index, path = place
    document = copy.deepcopy(DOCUMENTS[index])
    parent = document
    for step in path[:-1]:
        parent = parent[step]
    parent[path[-1]] = copy.deepcopy(wrong)
    try:
        validate(document)
    except JsonSchemaValueException as error:
        assert not {"properties", "integer", "array", "[]", "'"} & set(schema_error_title(error).split())


def test_an_error_holds_the_broken_rule_as_data() -> None:
    document = copy.deepcopy(DOCUMENT)
    document["states"][1]["distance"] = "far"
    with pytest.raises(JsonSchemaValueException) as caught:
        validate(document)
    assert (caught.value.path, caught.value.rule) == (("states", 1, "distance"), "type")
    assert caught.value.definition == ["integer", "null"]
    document = copy.deepcopy(DOCUMENT)
    document["states"][0] = {"id": 0, "label": document["states"][0]["label"]}
    with pytest.raises(JsonSchemaValueException) as caught:
        validate(document)
    assert (caught.value.path, caught.value.rule) == (("states", 0), "required")
    assert caught.value.fields == ["accepting", "distance", "verdict"]
