"""Layouts of spaces: values make the round trip through arrays; spaces that no policy can have are refused."""

from __future__ import annotations

import json
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.vector.utils import batch_space, concatenate, create_empty_array, iterate
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.policies.spaces.random_spaces import ACTIONS, OBSERVATIONS
from tltl_runtime.game.sensors import MapSensor, Sensors
from tltl_runtime.policies.spaces.action_layout import action_layout
from tltl_runtime.policies.spaces.layouts import SpaceLayouts, space_layouts
from tltl_runtime.policies.spaces.observation_layout import observation_layout
from tltl_runtime.policies.spaces.values import action_value, flat_action, observation_arrays, squashed
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render

SEEDS = st.integers(0, 2**31 - 1)


def equal(first: Any, second: Any) -> bool:
    """Whether two values of a space are equal, with the same types of arrays."""
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(equal(first[key], second[key]) for key in first)
    if isinstance(first, tuple):
        return len(first) == len(second) and all(map(equal, first, second))
    return bool(np.array_equal(first, second)) and np.asarray(first).dtype == np.asarray(second).dtype


@pytest.mark.hypothesis
@given(space=ACTIONS, seed=SEEDS)
def test_an_action_makes_the_round_trip(space: spaces.Space[Any], seed: int) -> None:
    space.seed(seed)
    layout = action_layout(space)
    for _ in range(5):
        action = space.sample()
        flat = flat_action(layout, action)
        assert flat.shape == (layout.width,)
        assert equal(action_value(layout, flat), action)
        assert (flat_action(layout, action_value(layout, flat)) == flat).all()


@pytest.mark.hypothesis
@given(space=ACTIONS, seed=SEEDS, count=st.integers(1, 3))
def test_a_batch_of_actions_makes_the_round_trip(space: spaces.Space[Any], seed: int, count: int) -> None:
    space.seed(seed)
    layout = action_layout(space)
    actions = [space.sample() for _ in range(count)]
    batch = batch_of(space, actions)
    flat = flat_action(layout, batch, count)
    assert (flat == np.stack([flat_action(layout, action) for action in actions])).all()
    values = action_value(layout, flat, count)
    assert all(map(equal, iterate(batch_space(space, count), values), actions))


@pytest.mark.hypothesis
@given(space=ACTIONS, seed=SEEDS, scale=st.sampled_from([0.1, 1.0, 1e3, 1e30]))
def test_whatever_a_policy_outputs_is_an_action_of_the_space(space: spaces.Space[Any], seed: int, scale: float) -> None:
    layout, generator = action_layout(space), np.random.default_rng(seed)
    choices = generator.integers(0, layout.sizes) if layout.sizes else np.zeros(0)
    outputs = np.concatenate([choices, scale * generator.normal(size=layout.number_count)])
    action = action_value(layout, squashed(layout, outputs))
    assert space.contains(action), action


@pytest.mark.hypothesis
@given(space=OBSERVATIONS, seed=SEEDS)
def test_every_number_of_an_observation_is_in_one_array(space: spaces.Space[Any], seed: int) -> None:
    space.seed(seed)
    layout = observation_layout(space)
    observation = space.sample()
    arrays = observation_arrays(layout, observation)
    assert {key: array.shape for key, array in arrays.items()} == {part.key: part.shape for part in layout}
    assert sum(array.size for array in arrays.values()) == sum(map(np.size, leaves(observation)))
    for part in layout:
        if part.sizes:
            assert ((arrays[part.key] >= 0) & (arrays[part.key] < np.array(part.sizes))).all()
    batch = batch_of(space, [observation, observation])
    batched = observation_arrays(layout, batch, 2)
    assert all((batched[key][1] == array).all() for key, array in arrays.items())


def batch_of(space: spaces.Space[Any], values: list[Any]) -> Any:
    empty: Any = create_empty_array(space, len(values))
    return concatenate(space, values, empty)


def leaves(value: Any) -> list[Any]:
    if isinstance(value, (dict, tuple)):
        return [leaf for inner in (value.values() if isinstance(value, dict) else value) for leaf in leaves(inner)]
    return [value]


@pytest.mark.hypothesis
@given(observation=OBSERVATIONS, action=ACTIONS)
def test_layouts_make_the_round_trip_through_json(observation: spaces.Space[Any], action: spaces.Space[Any]) -> None:
    layouts = SpaceLayouts(observation_layout(observation), action_layout(action))
    text = json.dumps(to_json(layouts), allow_nan=False)
    assert from_json(SpaceLayouts, json.loads(text), "spaces") == layouts


BOX = spaces.Box(-1, 1, (3,), np.float32)
KINDS: dict[str, tuple[spaces.Space[Any], str, tuple[int, ...]]] = {
    "a vector": (BOX, "numbers", (3,)),
    "a matrix of floats": (spaces.Box(0, 1, (4, 2), np.float32), "numbers", (8,)),
    "bytes in a row": (spaces.Box(0, 255, (128,), np.uint8), "numbers", (128,)),
    "an image": (spaces.Box(0, 255, (84, 84, 3), np.uint8), "image", (84, 84, 3)),
    "a grey image": (spaces.Box(0, 255, (84, 84), np.uint8), "image", (84, 84, 1)),
    "stacked images": (spaces.Box(0, 255, (4, 84, 84), np.uint8), "image", (4, 84, 84)),
    "a grid": (spaces.Box(0, 255, (7, 7, 3), np.uint8), "grid", (7, 7, 3)),
    "a grid of integers": (spaces.Box(0, 4, (5, 9), np.int64), "grid", (5, 9, 1)),
    "a map": (spaces.Box(0, 1, (6, 9, 9), np.uint8), "image", (6, 9, 9)),
    "black and white": (spaces.Box(0, 1, (84, 84, 1), np.uint8), "image", (84, 84, 1)),
    "planes of zeros and ones": (spaces.Box(0, 1, (10, 10, 4), np.int8), "image", (10, 10, 4)),
    "planes of bools": (spaces.Box(0, 1, (10, 10, 4), np.bool_), "image", (10, 10, 4)),
    "heights without bounds": (spaces.Box(-np.inf, np.inf, (5, 5, 1), np.float32), "numbers", (25,)),
    "a choice": (spaces.Discrete(5, start=2), "categories", (1,)),
    "choices": (spaces.MultiDiscrete(np.array([[2, 3], [4, 5]])), "categories", (4,)),
    "bits": (spaces.MultiBinary([2, 2]), "numbers", (4,)),
}


@pytest.mark.parametrize("name", KINDS)
def test_the_kind_of_a_part(name: str) -> None:
    space, kind, shape = KINDS[name]
    (part,) = observation_layout(space)
    assert (part.key, part.path, part.kind, part.shape) == ("observation", (), kind, shape)
    assert prod(part.shape) == observation_arrays([part], space.sample())["observation"].size


def test_the_planes_of_a_map_and_of_stacked_images_come_first() -> None:
    for name in ("stacked images", "a map"):
        assert observation_layout(KINDS[name][0])[0].planes_first
    for name in ("a grid", "black and white", "planes of zeros and ones"):
        assert not observation_layout(KINDS[name][0])[0].planes_first


def test_bounds_that_say_nothing_are_none() -> None:
    low, high = np.array([-4.8, -np.inf, -3e38, 2.0, 0.0]), np.array([4.8, np.inf, 3e38, 2.0, np.inf])
    (part,) = observation_layout(spaces.Box(low, high, dtype=np.float64))
    assert part.bounds == ((-4.8, 4.8), *[(None, None)] * 4)


def test_spaces_whose_values_the_network_takes_as_they_are_need_no_layout() -> None:
    vectors = spaces.Dict({"progress": spaces.Box(0, 1, (1,), np.float32), "map": KINDS["a map"][0]})
    sensors = Sensors((), (), MapSensor(tuple("abcdef"), 1.0, 9))
    assert space_layouts(vectors, spaces.MultiDiscrete([3, 2]), sensors) is None
    assert space_layouts(vectors, spaces.MultiDiscrete([3, 2])) is not None
    assert space_layouts(vectors, spaces.Discrete(3), sensors) is not None
    assert space_layouts(vectors, spaces.MultiDiscrete([3, 2], start=[0, 1]), sensors) is not None
    for other in ("a grid", "a choice", "bytes in a row"):
        more = spaces.Dict({**vectors.spaces, "x": KINDS[other][0]})
        assert space_layouts(more, spaces.MultiDiscrete([2]), sensors) is not None


# --- refusals ---------------------------------------------------------------------------------------

GOLDEN = Path(__file__).parents[3] / "golden" / "policy"
MISSION = spaces.Dict({"image": KINDS["a grid"][0], "direction": spaces.Discrete(4), "mission": spaces.Text(9)})
REFUSED: dict[str, tuple[spaces.Space[Any], str]] = {
    "a text": (MISSION, (GOLDEN / "TLT0844.txt").read_text(encoding="utf-8")),
    "a nested sequence": (
        spaces.Dict({"bag": spaces.Tuple([spaces.Sequence(BOX)]), "automaton": BOX, "body": BOX}),
        "error[TLT0844]: `bag/0` of the observation is a Sequence space, which no network can read\n"
        '  help: leave it out: write `observation = ["body"]` in the game file\n',
    ),
    "a graph": (spaces.Graph(BOX, None), "the observation is a Graph space, which no network can read\n  help: wrap"),
    "one of several": (spaces.OneOf([BOX, BOX]), "the observation is a OneOf space"),
    "an empty box": (spaces.Box(-1, 1, (0,), np.float32), "the observation has no numbers"),
    "an empty dict": (spaces.Dict({}), "the observation is empty"),
    "a large image": (spaces.Box(0, 255, (480, 640, 3), np.uint8), "has 921,600 numbers, and a network can read at mo"),
    "many categories": (spaces.Discrete(10**6), "has 1,000,000 numbers, and a network can read at most 65,536"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_an_observation_that_no_network_can_read_is_refused_by_name(name: str) -> None:
    space, expected = REFUSED[name]
    with pytest.raises(TltlError) as caught:
        observation_layout(space)
    assert expected in render(caught.value.diagnostics)


def test_every_refused_part_is_named() -> None:
    with pytest.raises(TltlError) as caught:
        observation_layout(spaces.Dict({"a": spaces.Text(3), "b": spaces.Graph(BOX, None), "c": BOX}))
    assert [diagnostic.title.split("`")[1] for diagnostic in caught.value.diagnostics] == ["a", "b"]


@pytest.mark.parametrize(
    ("space", "expected"),
    [
        (spaces.Text(3), "the action is a Text space, which no policy can choose in"),
        (spaces.Dict({"say": spaces.Text(3), "go": BOX}), "`say` of the action is a Text space"),
        (spaces.Box(-1, 1, (0,), np.float32), "the action has 0 elements"),
        (spaces.Tuple([]), "the action is empty"),
        (spaces.Discrete(10**6), "the action has 1,000,000 choices, and at most 65,536 are possible"),
        (spaces.Box(-1, 1, (5000,), np.float32), "the action has 5,000 numbers, and at most 4,096 are possible"),
    ],
)
def test_an_action_that_no_policy_can_choose_is_refused(space: spaces.Space[Any], expected: str) -> None:
    with pytest.raises(TltlError) as caught:
        action_layout(space)
    assert expected in render(caught.value.diagnostics)


def test_layouts_that_contradict_themselves_are_rejected() -> None:
    (part,) = observation_layout(KINDS["a choice"][0])
    (image,) = observation_layout(KINDS["an image"][0])
    layout = action_layout(spaces.Discrete(3))
    wrong: list[Any] = [
        replace_json(part, sizes=[]),
        replace_json(part, shape=[10**9]),
        replace_json(part, kind="image"),
        replace_json(image, shape=[0, 4, 4]),
        replace_json(image, low=[]),
        replace_json(image, low=[None]),
        replace_json(image, high=[-1.0]),
    ]
    for data in wrong:
        with pytest.raises(RecordJsonError):
            from_json(type(part), data, "part")
    changes: list[dict[str, Any]] = [
        {"sizes": [0]},
        {"shape": [2]},
        {"starts": []},
        {"low": [1.0]},
        {"dtype": "object"},
    ]
    for change in changes:
        with pytest.raises(RecordJsonError):
            from_json(type(layout.parts[0]), replace_json(layout.parts[0], **change), "part")
    with pytest.raises(ValueError, match="different keys"):
        SpaceLayouts((part, replace(part, path=("a",))), layout)


def replace_json(value: object, **changes: Any) -> Any:
    return {**to_json(value), **changes}
