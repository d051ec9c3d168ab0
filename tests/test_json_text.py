"""JSON is read within limits of size, depth and number of values."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.json_text import JsonLimitError, first_non_finite, load, loads
from tltlc.io.limits import Limit
from tltlc.pipeline import read_artefact

SMALL = Limit(size=100, values=10)

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | st.text(),
    lambda values: st.lists(values) | st.dictionaries(st.text(), values),
)


@given(VALUES)
def test_a_value_is_read_back_unchanged(value: object) -> None:
    text = json.dumps(value)
    limit = Limit(size=1, values=text.count(",") + 1)
    assert loads(text, limit) == loads(text.encode(), limit) == value


def test_too_many_values_are_rejected_before_they_are_created() -> None:
    assert len(loads("[" + "0," * 9 + "0]", SMALL)) == 10
    with pytest.raises(JsonLimitError, match="more than 10 values"):
        loads("[" + "[]," * 10 + "[]]", SMALL)


@pytest.mark.parametrize("opening", ["[", '{"a":'])
def test_deep_nesting_is_rejected(opening: str) -> None:
    with pytest.raises(JsonLimitError, match="nests too deep"):
        loads(opening * 100_000, SMALL)


@pytest.mark.parametrize("opening", ["[", '{"a":'])
def test_nesting_is_counted_in_levels(opening: str) -> None:
    closing = "]" if opening == "[" else "}"
    limit = Limit(size=1, depth=5, values=10)
    loads(opening * 5 + "0" + closing * 5, limit)
    with pytest.raises(JsonLimitError, match="deeper than 5 levels"):
        loads(opening * 6 + "0" + closing * 6, limit)


def test_a_large_file_is_rejected(tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_text(" " * 99 + "1")
    assert load(path, SMALL) == 1
    path.write_text(" " * 100 + "1")
    with pytest.raises(JsonLimitError, match="larger than"):
        load(path, SMALL)


@given(VALUES)
def test_a_value_with_a_number_that_is_not_finite_is_no_json(value: object) -> None:
    try:
        json.dumps(value, allow_nan=False)
    except ValueError:
        assert first_non_finite(value) in ("Infinity", "-Infinity")
    else:
        assert first_non_finite(value) is None


def test_the_first_number_that_is_not_finite_is_named() -> None:
    infinity, nan = float("inf"), float("nan")
    assert first_non_finite([1.0, {"a": [True, -infinity], "b": nan}, infinity]) == "-Infinity"
    assert first_non_finite({"a": {"b": nan}, "c": infinity}) == "NaN"


@pytest.mark.parametrize(
    "make",
    [
        lambda: "[" * 100_000,
        lambda: '{"format": "fspa", "a":' + "[" * 5000,
        lambda: "[" + "[]," * 10_000_000 + "[]]",
    ],
    ids=["brackets", "an object", "a long list"],
)
def test_an_artefact_that_would_fill_the_memory_is_rejected(make: Callable[[], str]) -> None:
    with pytest.raises(TltlError, match="TLT0006"):
        read_artefact(SourceFile("x.fspa.json", make()))
