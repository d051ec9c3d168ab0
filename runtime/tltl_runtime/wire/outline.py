"""The message ``outline``: what maps of a game are drawn on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.outline import GREATEST, LONGEST_NAME, MOST_CORNERS, MOST_PIXELS, MOST_SHAPES
from tltl_runtime.wire.answers import OUTLINE, body_of, picture_from
from tltl_runtime.wire.document import a_list, a_number, a_text, an_object, member, wrong
from tltl_runtime.wire.errors import MalformedMessageError

_BOX: Final = "a box: two opposite corners, such as [[0, 0], [8, 1]]"
_EXTENT: Final = "the west, south, east and north of the image, with west < east and south < north"

Corner = list[float]


def outline_from(message: Any) -> dict[str, Any]:
    """Return the outline in a message ``outline``, as ``tltl_outline()`` of an environment in Python returns it.

    Each entry of ``boxes`` is a list of boxes. ``pixels`` of the image are an array (height, width, 3). Unknown
    keys are left out.

    Raises:
        ReportedError: the message is an ``error``.
        MalformedMessageError: the message is no ``outline``, or shows nothing, or a part is wrong. The text names
            this part by its path, such as ``outline.boxes.wall[1]``.
    """
    body = an_object(body_of(message, OUTLINE), OUTLINE)
    given = {key: read(body[key], f"{OUTLINE}.{key}") for key, read in _READERS.items() if body.get(key) is not None}
    shapes = sum(map(len, given.get("boxes", {}).values()))
    shapes += len(given.get("polygons", ())) + len(given.get("regions", ()))
    _check_count(shapes, "shapes", MOST_SHAPES)
    _check_count(sum(map(len, given.get("polygons", {}).values())), "corners of polygons", MOST_CORNERS)
    if not shapes and "bounds" not in given and "image" not in given:
        raise MalformedMessageError(
            "sent an `outline` that shows nothing: it needs `bounds`, `boxes`, `polygons`, `regions` or an `image`"
        )
    return given


def _check_count(count: int, what: str, most: int) -> None:
    if count > most:
        raise MalformedMessageError(f"sent an `outline` with {count:,} {what}, but at most {most:,} are allowed")


def _named(read: Callable[[Any, str], Any]) -> Callable[[Any, str], dict[str, Any]]:
    """Return a function that reads shapes by name, of which ``read`` reads each."""

    def read_all(value: Any, path: str) -> dict[str, Any]:
        shapes = an_object(value, path)
        for name in shapes:
            if not 0 < len(name) <= LONGEST_NAME:
                raise MalformedMessageError(
                    f"sent `{path}` with a name of {len(name)} characters, but names have from 1 to {LONGEST_NAME}"
                )
        return {name: read(shape, member(path, name)) for name, shape in shapes.items()}

    return read_all


def _boxes(value: Any, path: str) -> list[list[Corner]]:
    """Return the boxes of a name; ``value`` is a box or a list of boxes, which may be empty."""
    if not isinstance(value, list):
        raise wrong(path, f"{_BOX}, or a list of boxes", value)
    if value and not _has_lists(value[0]):
        return [_box(value, path)]
    return [_box(box, f"{path}[{index}]") for index, box in enumerate(value)]


def _has_lists(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], list)


def _box(value: Any, path: str) -> list[Corner]:
    if not isinstance(value, list) or len(value) != 2:
        raise wrong(path, _BOX, value)
    first, second = (_corner(corner, f"{path}[{index}]") for index, corner in enumerate(value))
    if len(first) != len(second):
        raise wrong(f"{path}[1]", f"a list of {len(first)} numbers, as many as the other corner has", value[1])
    return [first, second]


def _polygon(value: Any, path: str) -> list[Corner]:
    corners = a_list(value, path)
    if len(corners) < 3:
        raise wrong(path, "a list of three or more corners, such as [[0, 0], [8, 0], [4, 6]]", value)
    # The height of a corner is of no account.
    return [_corner(corner, f"{path}[{index}]")[:2] for index, corner in enumerate(corners)]


def _corner(value: Any, path: str) -> Corner:
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise wrong(path, "a list of two or three numbers", value)
    return _numbers(value, path)


def _numbers(values: Iterable[Any], path: str) -> list[float]:
    return [a_number(value, f"{path}[{index}]", -GREATEST, GREATEST) for index, value in enumerate(values)]


def _image(value: Any, path: str) -> dict[str, Any]:
    table = an_object(value, path)
    sides = table.get("extent")
    if not isinstance(sides, list) or len(sides) != 4:
        raise wrong(f"{path}.extent", _EXTENT, sides)
    west, south, east, north = extent = _numbers(sides, f"{path}.extent")
    if not (west < east and south < north):
        raise wrong(f"{path}.extent", _EXTENT, sides)
    given = [key for key in ("path", "pixels") if table.get(key) is not None]
    if len(given) != 1:
        raise MalformedMessageError(f"sent `{path}`, which must have either `pixels` or a `path`, the name of a file")
    if given == ["path"]:
        return {"extent": extent, "path": a_text(table["path"], f"{path}.path")}
    return {"extent": extent, "pixels": _pixels(table["pixels"], f"{path}.pixels")}


def _pixels(value: Any, path: str) -> NDArray[np.uint8]:
    pixels = picture_from(value, path, f"`{path}`")
    if max(pixels.shape) > MOST_PIXELS:
        height, width, _ = pixels.shape
        raise MalformedMessageError(
            f"sent `{path}` with {width} x {height} pixels, but at most {MOST_PIXELS} x {MOST_PIXELS} are allowed"
        )
    return pixels


_READERS: Final[Mapping[str, Callable[[Any, str], Any]]] = {
    "bounds": _box,
    "boxes": _named(_boxes),
    "polygons": _named(_polygon),
    "regions": _named(_box),
    "image": _image,
}
