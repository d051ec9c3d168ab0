"""Outlines of games in other processes are read strictly, and errors name the wrong part by its path."""

from __future__ import annotations

from contextlib import suppress
from math import inf
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from tests.fuzzing import SEEDS, mutated_json, times
from tltl_runtime.gymnasium_games.outline_reader import OutlineError, read_outline
from tltl_runtime.wire import answers, json_text
from tltl_runtime.wire.errors import MalformedMessageError
from tltl_runtime.wire.outline import outline_from

WALL = [[0, 0], [8, 1]]
PIXELS = {"base64": "/wAAAP8A", "dtype": "uint8", "shape": [1, 2, 3]}
OUTLINE: dict[str, Any] = {
    "bounds": [[0, 0], [9, 6]],
    "boxes": {"wall": [WALL, [[9, 6, 2.5], [8, 0, 0]]], "chest": [[3, 3], [4, 4]], "fence": []},
    "polygons": {"lake": [[1, 1], [3, 1, 0], [2, 2]]},
    "regions": {"hall": [[0, 1], [8, 6]]},
    "image": {"pixels": PIXELS, "extent": [0, 0, 9, 6], "later": 1},
    "later": [1],
}


def test_an_outline_is_what_a_game_in_python_returns() -> None:
    read = outline_from({"outline": OUTLINE})
    assert "later" not in read
    assert read["boxes"] == {"wall": [WALL, [[9, 6, 2.5], [8, 0, 0]]], "chest": [[[3, 3], [4, 4]]], "fence": []}
    assert read["image"]["pixels"].dtype == np.uint8
    outline = read_outline(read, Path("/nowhere"))
    assert [item.name for item in outline.boxes] == ["wall", "wall", "chest"]
    assert outline.boxes[1].box.low == (8, 0, 0) and outline.boxes[1].box.high == (9, 6, 2.5)
    assert outline.polygons[0].corners == ((1, 1), (3, 1), (2, 2)) and outline.image is not None


@pytest.mark.parametrize(
    ("outline", "problem"),
    [
        ([], "sent `outline` as a list, but it must be an object"),
        ({}, "sent an `outline` that shows nothing: it needs `bounds`, `boxes`, "),
        ({"boxes": {"wall": []}, "bounds": None}, "sent an `outline` that shows nothing"),
        ({"bounds": [[0, 0]]}, "sent `outline.bounds` as a list, but it must be a box: two opposite corners, such as"),
        ({"bounds": [[0, 0], [1, "2"]]}, 'sent `outline.bounds[1][1]` as "2", but it must be a number'),
        ({"bounds": [[0, 0], [1, 2, 3]]}, "sent `outline.bounds[1]` as a list, but it must be a list of 2 numbers, as"),
        ({"boxes": [WALL]}, "sent `outline.boxes` as a list, but it must be an object"),
        (
            {"boxes": {"wall": {}}},
            "sent `outline.boxes.wall` as an object, but it must be a box: two opposite corners,",
        ),
        (
            {"boxes": {"wall": [WALL, [[0, 0], 1]]}},
            "sent `outline.boxes.wall[1][1]` as 1, but it must be a list of two",
        ),
        ({"boxes": {"wall": [0, 0, 8, 1]}}, "sent `outline.boxes.wall` as a list, but it must be a box: two opposite"),
        ({"boxes": {"wall": [[0, 0], [1, 2e6]]}}, "sent `outline.boxes.wall[1][1]` as 2000000.0, but it must be from"),
        ({"boxes": {"wall": [[0, 0], [1, inf]]}}, "sent a number that is not finite as `outline.boxes.wall[1][1]`"),
        ({"boxes": {"": WALL}}, "sent `outline.boxes` with a name of 0 characters, but names have from 1 to 100"),
        ({"boxes": {"wall": [WALL] * 5001}}, "sent an `outline` with 5,001 shapes, but at most 5,000 are allowed"),
        ({"polygons": {"lake": [[0, 0], [1, 1]]}}, "sent `outline.polygons.lake` as a list, but it must be a list of"),
        ({"polygons": {"lake": [[0, 0]] * 20001}}, "sent an `outline` with 20,001 corners of polygons, but at most"),
        ({"regions": {"hall": [WALL]}}, "sent `outline.regions.hall` as a list, but it must be a box"),
        ({"image": "map.png"}, 'sent `outline.image` as "map.png", but it must be an object'),
        ({"image": {"path": "map.png"}}, "sent `outline.image.extent` as null, but it must be the west, south, east"),
        ({"image": {"path": "m.png", "extent": [0, 9, 1, 0]}}, "sent `outline.image.extent` as a list, but it must be"),
        ({"image": {"extent": [0, 0, 9, 6]}}, "sent `outline.image`, which must have either `pixels` or a `path`"),
        ({"image": {"pixels": [[1]], "extent": [0, 0, 9, 6]}}, "sent `outline.image.pixels` of the shape [1, 1], not"),
        ({"image": {"pixels": [[[0.5] * 3]], "extent": [0, 0, 9, 6]}}, "sent `outline.image.pixels` with numbers that"),
        (
            {"image": {"pixels": [[[0] * 3] * 4097], "extent": [0, 0, 9, 6]}},
            "sent `outline.image.pixels` with 4097 x 1 ",
        ),
    ],
)
def test_wrong_outlines_are_refused_by_the_path_of_the_wrong_part(outline: Any, problem: str) -> None:
    with pytest.raises(MalformedMessageError) as caught:
        outline_from({"outline": outline})
    assert str(caught.value).startswith(problem), str(caught.value)


@times(200)
@given(SEEDS)
def test_mutated_outlines_are_refused_or_can_be_drawn(seed: int) -> None:
    text = mutated_json(Random(seed), {"outline": OUTLINE}).encode("utf-8", "surrogatepass")
    with suppress(MalformedMessageError, answers.ReportedError, OutlineError):
        read_outline(outline_from(json_text.parse(text)), Path("/nowhere"))
