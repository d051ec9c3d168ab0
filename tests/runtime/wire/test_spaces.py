"""Spaces and their values as JSON, and back; what is wrong is refused with its path."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from gymnasium import Space, spaces
from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.wire.errors import MalformedMessageError
from tltl_runtime.wire.spaces import document_of, size, space_from
from tltl_runtime.wire.values import value_reader, value_writer

KEYS = st.text("abcxyz_", min_size=1, max_size=4)
SHAPES = st.lists(st.integers(1, 3), max_size=3).map(tuple)
FLOATS = st.floats(-1e6, 1e6, width=32)


@st.composite
def boxes(draw: st.DrawFn) -> Space[Any]:
    shape = draw(SHAPES)
    name = draw(st.sampled_from(["float32", "float64", "int8", "int32", "uint8"]))
    if name.startswith("float"):
        ends = sorted(draw(st.tuples(FLOATS, FLOATS)))
        low = draw(st.sampled_from([ends[0], -np.inf]))
        high = draw(st.sampled_from([ends[1], np.inf]))
    else:
        low, high = sorted(draw(st.tuples(st.integers(0, 100), st.integers(0, 100))))
    lows = np.full(shape, low, dtype=name)
    if lows.size > 1 and draw(st.booleans()):
        lows.flat[0] = high if np.isfinite(high) else 0
    return spaces.Box(
        np.minimum(lows, np.full(shape, high, dtype=name)), np.full(shape, high, dtype=name), shape, np.dtype(name).type
    )


SIMPLE = st.one_of(
    st.builds(spaces.Discrete, st.integers(1, 9), start=st.integers(-3, 3)),
    st.builds(spaces.MultiDiscrete, st.lists(st.integers(1, 5), min_size=1, max_size=4)),
    st.builds(spaces.MultiBinary, st.integers(1, 5)),
    boxes(),
)
SPACES = st.recursive(
    SIMPLE,
    lambda inner: st.one_of(
        st.dictionaries(KEYS, inner, max_size=3).map(spaces.Dict), st.lists(inner, max_size=3).map(spaces.Tuple)
    ),
    max_leaves=6,
)


@given(SPACES)
def test_a_space_survives_the_way_through_json(space: Space[Any]) -> None:
    assert space_from(json.loads(json.dumps(document_of(space))), "s") == space


@given(SPACES, st.integers(0, 2**31))
def test_a_value_survives_the_way_through_json(space: Space[Any], seed: int) -> None:
    space.seed(seed)
    value = space.sample()
    read = value_reader(space, "v")(json.loads(json.dumps(value_writer(space)(value))))
    assert space.contains(read)
    assert _equal(read, value)


def _equal(one: Any, other: Any) -> bool:
    if isinstance(one, dict):
        return all(_equal(one[key], other[key]) for key in other)
    if isinstance(one, tuple):
        return all(map(_equal, one, other))
    return bool(np.array_equal(one, other))


@pytest.mark.parametrize(
    ("document", "message"),
    [
        (7, "sent `a` as 7, but it must be an object"),
        ({}, "sent `a.type` as null, but it must be a text"),
        (
            {"type": "discreet", "n": 3},
            "declares `a` as a space of the unknown type `discreet`; did you mean `discrete`?",
        ),
        ({"type": "discrete", "n": 0}, "sent `a.n` as 0, but it must be a whole number from 1 to 2147483647"),
        ({"type": "discrete", "n": True}, "sent `a.n` as true, but it must be a whole number from 1 to 2147483647"),
        ({"type": "discrete", "n": "3"}, 'sent `a.n` as "3", but it must be a whole number from 1 to 2147483647'),
        (
            {"type": "multi_discrete", "nvec": []},
            "sent `a.nvec` as a list, but it must be a list of whole numbers, at least one",
        ),
        (
            {"type": "box", "shape": [2], "dtype": "complex64"},
            'sent `a.dtype` as "complex64", but '
            "it must be one of float32, float64, int8, int16, int32, int64, uint8, uint16, uint32, uint64",
        ),
        ({"type": "box", "shape": [2], "low": 1, "high": 0}, "declares `a` with a `low` above its `high`"),
        (
            {"type": "box", "shape": [2], "low": [0, 0, 0]},
            "sent `a.low` as a list, but it must be a number, or nested lists of the space's shape",
        ),
        ({"type": "box", "shape": [2], "low": "0"}, 'sent `a.low` as "0", but it must be numbers of the type float32'),
        (
            {"type": "box", "shape": [2], "dtype": "uint8", "low": -1},
            "sent `a.low` as -1, but it must be numbers of the type uint8",
        ),
        ({"type": "box", "shape": [100000, 100000]}, "declares `a.shape` with more than 4,194,304 numbers"),
        (
            {"type": "tuple", "spaces": [{"type": "box", "shape": [4000000]}] * 2},
            "declares `a` with 8,000,000 numbers; at most 4,194,304 are allowed",
        ),
        (
            {"type": "dict", "spaces": {"move": {"type": "discrete", "n": 1.5}}},
            "sent `a.spaces.move.n` as 1.5, but it must be a whole number from 1 to 2147483647",
        ),
    ],
)
def test_what_is_no_space_is_refused_by_its_path(document: Any, message: str) -> None:
    with pytest.raises(MalformedMessageError) as caught:
        space_from(document, "a")
    assert str(caught.value) == message


def test_deep_spaces_are_refused() -> None:
    document: Any = {"type": "discrete", "n": 2}
    for _ in range(20):
        document = {"type": "tuple", "spaces": [document]}
    with pytest.raises(MalformedMessageError, match="nests deeper than 16 levels"):
        space_from(document, "a")


def test_a_space_that_the_protocol_does_not_have_cannot_be_written() -> None:
    with pytest.raises(TypeError, match="no space such as Text"):
        document_of(spaces.Text(4))


IMAGE = spaces.Box(0, 255, (2, 2, 3), np.uint8)


def test_an_array_may_come_in_base64() -> None:
    array = np.arange(12, dtype=np.uint8).reshape(2, 2, 3)
    text = base64.b64encode(array.tobytes()).decode()
    read = value_reader(IMAGE, "v")({"base64": text, "dtype": "uint8", "shape": [2, 2, 3]})
    assert read.dtype == np.uint8 and np.array_equal(read, array)


PAIR = spaces.Box(np.float32(0), np.float32(10), (2,), np.float32)


@pytest.mark.parametrize(
    ("space", "value", "message"),
    [
        (PAIR, [1, 2, 3], "sent `v` in the shape [3], but declared [2]"),
        (spaces.Box(0, 1, (2, 3), np.float32), [], "sent `v` in the shape [0], but declared [2, 3]"),
        (PAIR, [1, [2]], "sent `v` with lists of unequal lengths"),
        (PAIR, ["1", "2"], 'sent `v` as "1", but it must be numbers, in nested lists or in base64'),
        (PAIR, [1, None], "sent `v` as 1, but it must be numbers, in nested lists or in base64"),
        (PAIR, None, "sent `v` as null, but it must be numbers, in nested lists or in base64"),
        (PAIR, [1, 1e999], "sent `v` with a number that is not finite"),
        (PAIR, [1, 11], "sent 11 as `v[1]`, outside its declared range from 0 to 10"),
        (PAIR, {"base64": "!", "dtype": "uint8", "shape": [2]}, "sent `v.base64`, which is not base64"),
        (
            PAIR,
            {"base64": "AAAA", "dtype": "uint8", "shape": [2]},
            "sent `v` with 3 bytes, which do not fill its shape [2]",
        ),
        (IMAGE, [[[0, 0, 0], [0, 0, 300]]] * 2, "sent 300 as `v[0][1][2]`, outside its declared range from 0 to 255"),
        (IMAGE, [[[0, 0, 0], [0, 0, 0.5]]] * 2, "sent `v` with numbers that are not whole, but declared uint8"),
        (spaces.Discrete(3), 3, "sent `v` as 3, but it must be a whole number from 0 to 2"),
        (spaces.Dict({"a": PAIR}), {"b": [1, 2]}, "sent `v` without the declared key `a`"),
        (spaces.Tuple([PAIR]), [], "sent `v` with 0 parts, but declared 1"),
        (
            spaces.Box(-np.inf, np.inf, (1,), np.float32),
            [1e300],
            "sent `v` with numbers that are too large for float32",
        ),
    ],
)
def test_what_is_no_value_of_the_space_is_refused(space: Space[Any], value: Any, message: str) -> None:
    with pytest.raises(MalformedMessageError) as caught:
        value_reader(space, "v")(value)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("space", "action"),
    [
        *((spaces.Discrete(3), action) for action in (3, 0.5, None, np.inf)),
        *((PAIR, action) for action in ([0, 11], [0], [0, np.nan], [0, 10**400], None)),
        *((PAIR, np.array(action, np.float32)) for action in ([0, 11], [0], [0, np.nan], [[0, 1]], 1)),
        (spaces.Box(-np.inf, np.inf, (1,), np.float32), np.array([np.inf], np.float32)),
        (spaces.MultiBinary(2), [0, np.inf]),
        *((spaces.Dict({"a": PAIR}), action) for action in ({}, {"a": None}, np.zeros(2), None)),
    ],
)
def test_an_action_outside_the_space_is_refused(space: Space[Any], action: Any) -> None:
    write: Callable[[Any], Any] = value_writer(space)
    with pytest.raises(ValueError, match="which is not in"):
        write(action)


def test_the_size_of_a_space_counts_all_numbers() -> None:
    assert size(spaces.Dict({"a": IMAGE, "b": spaces.Tuple([spaces.Discrete(3), PAIR])})) == 15
