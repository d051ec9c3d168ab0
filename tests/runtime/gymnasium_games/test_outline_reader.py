"""Outlines as games return them, right and wrong."""

from __future__ import annotations

from io import BytesIO
from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from tltl_runtime.game.geometry import Box
from tltl_runtime.game.outline import GREATEST, outline_problem
from tltl_runtime.game.png_header import png_size
from tltl_runtime.gymnasium_games.outline_reader import OutlineError, read_outline

FOLDER = Path("/nowhere")
PIXELS = np.zeros((3, 4, 3), np.uint8)


def png(width: int = 4, height: int = 3) -> bytes:
    stream = BytesIO()
    Image.new("RGB", (width, height)).save(stream, format="png")
    return stream.getvalue()


def test_everything_that_a_map_can_show_is_read() -> None:
    outline = read_outline(
        {
            "boxes": {"wall": [((0, 0), (1, 8)), ((8, 1), (0, 0))], "chest": ((2, 2, 0), (3, 3, 1))},
            "polygons": {"lake": [(4, 4), (6, 4), (5, 6)]},
            "regions": {"hall": ((0, 0, 0), (10, 10, 3))},
            "image": {"pixels": PIXELS, "extent": (-1, 0, 12, 9)},
        },
        FOLDER,
    )
    assert [item.name for item in outline.boxes] == ["wall", "wall", "chest"]
    assert (outline.boxes[1].box.low[:2], outline.boxes[1].box.high[:2]) == ((0, 0), (8, 1)), "corners in any order"
    assert outline.boxes[0].box.low[2] < -100 and outline.boxes[0].box.high[2] > 100, "of every height"
    assert outline.boxes[2].box == Box((2, 2, 0), (3, 3, 1))
    assert outline.polygons[0].corners == ((4, 4), (6, 4), (5, 6))
    assert [region.name for region in outline.regions] == ["hall"]
    assert outline.image is not None and png_size(outline.image.png) == (4, 3)
    assert (outline.bounds.low[:2], outline.bounds.high[:2]) == ((-1, 0), (12, 10)), "the hull of all"


def test_boxes_of_a_name_may_differ_in_having_heights_and_be_none() -> None:
    boxes = {"wall": [((0, 0), (1, 8)), ((8, 1, 0), (9, 2, 3))], "fence": []}
    outline = read_outline({"boxes": boxes}, FOLDER)
    assert [(item.name, item.box.high) for item in outline.boxes] == [("wall", (1, 8, 1e4)), ("wall", (9, 2, 3))]


def test_bounds_alone_are_an_outline() -> None:
    outline = read_outline({"bounds": np.array([[0, 0], [8, 0]])}, FOLDER)
    assert outline.bounds.high[:2] == (8, pytest.approx(0.01)), "no side is shorter than a centimetre"


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        ([], "is a list, not a mapping"),
        (None, "is None, not a mapping"),
        ({}, "shows nothing"),
        ({"boxs": {}}, "has the unknown key `boxs`"),
        ({"boxes": [((0, 0), (1, 1))]}, "has `boxes` that are a list"),
        ({"boxes": {"wall": (0, 0, 1, 1)}}, "has the box `wall` that is not two corners"),
        ({"boxes": {"wall": ((0, 0), (1, nan))}}, "has the box `wall` that is not two corners"),
        ({"boxes": {"wall": ((0, 0), (1, inf))}}, "has the box `wall` that is not two corners"),
        ({"boxes": {"wall": "big"}}, "has the box `wall` that is not two corners"),
        ({"boxes": {"": ((0, 0), (1, 1))}}, "has the name ''"),
        ({"regions": {"hall": ((0, 0), (1, 2 * GREATEST))}}, "has coordinates that are not numbers from"),
        ({"bounds": ((0, 0), (1, 1), (2, 2))}, "has its `bounds` that is not two corners"),
        ({"polygons": {"lake": [(0, 0), (1, 1)]}}, "has a polygon `lake` that is not three or more points"),
        ({"polygons": {"lake": [(0, 0), (1, 1), (1, nan)]}}, "has coordinates that are not numbers from"),
        ({"boxes": {"wall": [((0, 0), (1, 1))] * 5001}}, "has 5,001 shapes"),
        ({"regions": dict.fromkeys(map(str, range(5001)), ((0, 0), (1, 1)))}, "has 5,001 regions"),
        ({"polygons": {"lake": [(0, 0)] * 20_001}}, "has polygons with 20,001 corners"),
        ({"image": "map.png"}, "has an image without its extent"),
        ({"image": {"png": png(), "extent": (0, 0, 1)}}, "has an image without its extent"),
        ({"image": {"png": png(), "extent": (0, 0, 0, 1)}}, "has an image whose extent is empty"),
        ({"image": {"extent": (0, 0, 1, 1)}}, "has an image that is not one of `path`, `png` and `pixels`"),
        ({"image": {"png": "map", "extent": (0, 0, 1, 1)}}, "has a `png` that is a str, not bytes"),
        ({"image": {"png": b"GIF89a", "extent": (0, 0, 1, 1)}}, "has an image that is no PNG picture"),
        ({"image": {"png": png()[:40], "extent": (0, 0, 1, 1)}}, "has an image that is damaged"),
        ({"image": {"png": png(4097, 1), "extent": (0, 0, 1, 1)}}, "has an image of 4097 x 1 pixels"),
        ({"image": {"pixels": PIXELS[..., 0], "extent": (0, 0, 1, 1)}}, "has `pixels` of shape 3 x 4 and type uint8"),
        ({"image": {"pixels": PIXELS * 1.0, "extent": (0, 0, 1, 1)}}, "has `pixels` of shape 3 x 4 x 3 and type"),
        ({"image": {"path": "../map.png", "extent": (0, 0, 1, 1)}}, "has an image `../map.png` outside the game's"),
        ({"image": {"path": "map.png", "extent": (0, 0, 1, 1)}}, "has an image `map.png` that cannot be read"),
    ],
)
def test_wrong_outlines_are_refused(value: Any, problem: str) -> None:
    with pytest.raises(OutlineError) as caught:
        read_outline(value, FOLDER)
    assert str(caught.value).startswith(problem), str(caught.value)
    assert caught.value.help


def test_an_image_may_be_a_file_of_the_game(tmp_path: Path) -> None:
    (tmp_path / "map.png").write_bytes(png())
    outline = read_outline({"image": {"path": "map.png", "extent": (0, 0, 4, 3)}}, tmp_path)
    assert outline.image is not None and outline.image.png == png()


NUMBERS = st.floats(-1e7, 1e7) | st.sampled_from([nan, inf, 0.0])
VALUES: st.SearchStrategy[Any] = st.recursive(
    NUMBERS | st.text(max_size=3) | st.none() | st.binary(max_size=4),
    lambda values: st.lists(values, max_size=3) | st.dictionaries(st.text(max_size=3), values, max_size=3),
    max_leaves=8,
)
BOXES = st.lists(st.lists(NUMBERS, min_size=2, max_size=3), min_size=2, max_size=2)


@given(
    st.fixed_dictionaries(
        {},
        optional={
            "bounds": BOXES | VALUES,
            "boxes": st.dictionaries(st.text(max_size=3), BOXES | VALUES, max_size=3) | VALUES,
            "polygons": st.dictionaries(st.text(max_size=3), VALUES, max_size=3) | VALUES,
            "regions": st.dictionaries(st.text(max_size=3), BOXES | VALUES, max_size=3) | VALUES,
            "image": st.fixed_dictionaries({"extent": st.lists(NUMBERS, min_size=4, max_size=4)}) | VALUES,
        },
    )
)
def test_what_a_game_returns_is_an_outline_or_is_refused(value: Any) -> None:
    try:
        outline = read_outline(value, FOLDER)
    except OutlineError as error:
        assert error.help
    else:
        assert outline_problem(outline) is None
