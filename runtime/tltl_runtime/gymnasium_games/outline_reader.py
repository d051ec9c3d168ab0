"""Read what an environment's ``tltl_outline()`` returns."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.geometry import Box, Region
from tltl_runtime.game.outline import (
    MOST_BYTES,
    MOST_SHAPES,
    LevelOutline,
    MapImage,
    NamedBox,
    NamedPolygon,
    hull,
    image_problem,
    outline_problem,
    widened,
)
from tltl_runtime.gymnasium_games.value_text import type_text
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import TltlError, fileio, replace

_KEYS: Final = ("bounds", "boxes", "polygons", "regions", "image")
_IMAGE_KEYS: Final = ("png", "path", "pixels")
_HEIGHT: Final = 1e4
"""A box without heights reaches from this many metres below to this many above."""

_T = TypeVar("_T")

_BOX_HELP: Final = "give two corners: `((0, 0), (8, 1))`, or with heights `((0, 0, 0), (8, 1, 2))`"
_POLYGON_HELP: Final = "give its corners in order: `[(0, 0), (8, 0), (4, 6)]`"
_IMAGE_HELP: Final = (
    "give a mapping: `{'path': 'map.png', 'extent': (0, 0, 8, 6)}`, with the west, south, east and north of the image"
)


class OutlineError(ValueError):
    """Raised for an outline that cannot be used.

    The text says what is wrong with it, and ``help`` how to correct it.
    """

    def __init__(self, problem: str, help_: str) -> None:
        super().__init__(problem)
        self.help = help_


def read_outline(value: object, folder: Path) -> LevelOutline:
    """Return the outline that ``value``, a mapping from a game, describes.

    ``docs/games.md`` describes the mapping. If it has no ``bounds``, these are the smallest box around
    everything else. ``folder`` is the folder of the game file; paths of images are relative to it.

    Raises:
        OutlineError: the value describes no outline.
    """
    if not isinstance(value, Mapping):
        raise OutlineError(f"is {type_text(value)}, not a mapping", "return a mapping such as `{'boxes': {}}`")
    unknown = next((key for key in value if key not in _KEYS), None)
    if unknown is not None:
        raise OutlineError(f"has the unknown key `{unknown}`", suggestion(str(unknown), _KEYS))
    outline = LevelOutline(
        bounds=Box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
        boxes=tuple(_shapes(value, "boxes", _named_boxes)),
        polygons=tuple(_shapes(value, "polygons", _named_polygons)),
        regions=tuple(_shapes(value, "regions", _named_regions)),
        image=_image(value.get("image"), folder),
    )
    problem = outline_problem(outline)
    if problem is not None:
        raise OutlineError(problem, "correct it, or leave it out")
    bounds = hull(outline) if value.get("bounds") is None else _box(value["bounds"], "its `bounds`")
    if bounds is None:
        raise OutlineError("shows nothing", "give its `bounds`, or boxes, polygons, regions or an image")
    outline = replace(outline, bounds=bounds)
    problem = outline_problem(outline)
    if problem is not None:
        raise OutlineError(problem, _BOX_HELP)
    return outline


def _shapes(value: Mapping[str, Any], key: str, read: Callable[[str, object], Iterator[_T]]) -> Iterator[_T]:
    """Yield the shapes under a key of the outline ``value``, such as ``boxes``.

    The key has a mapping from names to shapes. ``read`` makes shapes of a name and its value.
    """
    shapes = value.get(key)
    if shapes is None:
        return
    if not isinstance(shapes, Mapping):
        raise OutlineError(
            f"has `{key}` that are {type_text(shapes)}, not a mapping", f"map names to {key}: `{{'hall': …}}`"
        )
    if len(shapes) > MOST_SHAPES:
        raise OutlineError(f"has {len(shapes):,} {key}, and at most {MOST_SHAPES:,} are allowed", "leave some out")
    for name, shape in shapes.items():
        yield from read(str(name), shape)


def _named_boxes(name: str, value: object) -> Iterator[NamedBox]:
    """Yield the box with this name; if ``value`` is a list of boxes, yield each of them. The list may be empty."""
    value = value.tolist() if isinstance(value, np.ndarray) else value
    items = list(value) if isinstance(value, (list, tuple)) else [value]
    first = _numbers(items[0]) if items else None
    are_boxes = not items or (first is not None and first.ndim == 2)
    for item in items if are_boxes else [value]:
        yield NamedBox(name, _box(item, f"the box `{name}`"))


def _named_polygons(name: str, value: object) -> Iterator[NamedPolygon]:
    array = _numbers(value)
    if array is None or array.ndim != 2 or array.shape[1] not in (2, 3) or len(array) < 3:
        raise OutlineError(f"has a polygon `{name}` that is not three or more points", _POLYGON_HELP)
    yield NamedPolygon(name, tuple((x, y) for x, y in array[:, :2].tolist()))


def _named_regions(name: str, value: object) -> Iterator[Region]:
    yield Region(name, _box(value, f"the region `{name}`"))


def _box(value: object, what: str) -> Box:
    """Return the box between two opposite corners, each (x, y) or (x, y, z); errors call the box ``what``."""
    array = _numbers(value)
    if array is None or array.shape not in ((2, 2), (2, 3)) or not np.isfinite(array).all():
        raise OutlineError(f"has {what} that is not two corners", _BOX_HELP)
    low, high = array.min(axis=0).tolist(), array.max(axis=0).tolist()
    if len(low) == 2:
        low, high = [*low, -_HEIGHT], [*high, _HEIGHT]
    return widened(Box(tuple(low), tuple(high)))


def _numbers(value: object) -> NDArray[np.float64] | None:
    """Return a number or nested sequences of numbers as an array; None for any other value."""
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        return None


def _image(value: object, folder: Path) -> MapImage | None:
    if value is None:
        return None
    extent = _numbers(value.get("extent")) if isinstance(value, Mapping) else None
    if not isinstance(value, Mapping) or extent is None or extent.shape != (4,) or not np.isfinite(extent).all():
        raise OutlineError("has an image without its extent", _IMAGE_HELP)
    given = [key for key in _IMAGE_KEYS if value.get(key) is not None]
    if len(given) != 1 or set(value) - {"extent", *_IMAGE_KEYS}:
        raise OutlineError("has an image that is not one of `path`, `png` and `pixels`", _IMAGE_HELP)
    west, south, east, north = extent.tolist()
    image = MapImage(_png(given[0], value[given[0]], folder), (west, south, east, north))
    if image_problem(image) is None and not _is_whole(image.png):
        raise OutlineError("has an image that is damaged", "give a whole PNG picture")
    return image


def _is_whole(png: bytes) -> bool:
    from PIL import Image

    try:
        Image.open(BytesIO(png), formats=("PNG",)).load()
    except Exception:  # Pillow may raise many exceptions for damaged pictures
        return False
    return True


def _png(key: str, value: object, folder: Path) -> bytes:
    if key == "png":
        if not isinstance(value, bytes):
            raise OutlineError(f"has a `png` that is {type_text(value)}, not bytes", "give the bytes of a PNG file")
        return value
    if key == "path":
        return _file(str(value), folder)
    return _encoded(np.asarray(value))


def _file(name: str, folder: Path) -> bytes:
    """Return the bytes of a file in the game's folder; raises OutlineError if it is outside or cannot be read."""
    path = folder / name
    try:
        inside = path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError, ValueError):
        inside = False
    if not inside:
        raise OutlineError(f"has an image `{name}` outside the game's folder", "copy it beside the game file")
    try:
        return fileio.read_bytes(path, name, MOST_BYTES)
    except TltlError as error:
        raise OutlineError(f"has an image `{name}` that cannot be read", error.diagnostics[0].title) from None


def _encoded(pixels: NDArray[Any]) -> bytes:
    """Return an array (height, width, 3) of bytes as a PNG picture; raises OutlineError for any other array."""
    from PIL import Image

    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] != 3 or not pixels.size:
        shape = " x ".join(map(str, pixels.shape)) or "0"
        raise OutlineError(
            f"has `pixels` of shape {shape} and type {pixels.dtype}",
            "give an array of height x width x 3 of type uint8",
        )
    stream = BytesIO()
    Image.fromarray(pixels).save(stream, format="png")
    return stream.getvalue()
