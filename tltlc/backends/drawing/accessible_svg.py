"""Make the SVG that Graphviz writes accessible: titles for screen readers, and texts that fit in any font."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Final
from xml.etree import ElementTree as ET

from tltlc.automaton.fspa import State
from tltlc.backends.drawing.texts import escape_invisible

_SVG: Final = "{http://www.w3.org/2000/svg}"
_LINK_TITLE: Final = "{http://www.w3.org/1999/xlink}title"

Area = tuple[float, float, float, float]
"""The left, top, right and bottom edges of a shape, in the units of the SVG."""

_number = re.compile(r"-?\d+(?:\.\d+)?")
_ends = re.compile(r"(\d+)(?::\w+)?->(\d+)(?::\w+)?")


def make_accessible(svg: bytes, name: str, folded: Mapping[int, Sequence[State]]) -> bytes:
    """Return the picture with a title, and with the tooltips of its states and edges as their titles.

    ``svg`` is the picture as Graphviz writes it, and ``name`` the automaton's name. Each drawn state
    gets the attribute ``data-states`` with its number, or with the numbers of all states that are
    folded into it (``folded``, by the number of the drawn state). Each edge gets ``data-source`` and
    ``data-target`` with the numbers of its states. Texts are centred in their shapes, so that they
    stay inside even if the reader's font is wider than Graphviz assumed.
    """
    root = ET.fromstring(svg)
    root.set("role", "group")
    title = ET.Element(f"{_SVG}title")
    title.text = f"The automaton of {escape_invisible(name)}"
    root.insert(0, title)
    for group in list(root.iter(f"{_SVG}g")):
        kind = group.get("class")
        if kind == "graph":
            group.remove(group[0])
            _unwrap_links(group)
        elif kind in ("node", "edge"):
            _set_title(group, folded)
            _centre_texts(group)
        group.attrib.pop("id", None)
    ET.register_namespace("", _SVG[1:-1])
    picture: bytes = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    return picture + b"\n"


def _set_title(group: ET.Element, folded: Mapping[int, Sequence[State]]) -> None:
    """Replace the title of a state or an edge by its tooltip; Graphviz writes its name in the graph as the title.

    Also set the attributes ``data-states``, ``data-source`` and ``data-target``.
    """
    title = group[0]
    name = title.text or ""
    title.text = next((link.get(_LINK_TITLE, "") for link in group.iter(f"{_SVG}a")), "start")
    _unwrap_links(group)
    group.set("role", "img")
    if name.isdigit():
        numbers = [str(state.id) for state in folded.get(int(name), ())]
        group.set("data-states", " ".join(numbers or [name]))
    elif ends := _ends.fullmatch(name):
        group.set("data-source", ends[1])
        group.set("data-target", ends[2])
        title.text = f"from {ends[1]} to {ends[2]}: {title.text}"


def _unwrap_links(group: ET.Element) -> None:
    """Replace each link in a group by its contents; Graphviz makes links only to attach tooltips."""
    children: list[ET.Element] = []
    for child in group:
        link = child.find(f"{_SVG}a")
        children += [child] if link is None else link
    group[:] = children


def _centre_texts(group: ET.Element) -> None:
    """Centre each text in the narrowest shape that contains the text's start."""
    # The curve of an edge has no fill; it is not a shape around a text.
    shapes = (
        element
        for element in group
        if element.tag in (f"{_SVG}path", f"{_SVG}polygon") and element.get("fill") != "none"
    )
    areas = [_area(shape) for shape in shapes]
    for text in group.iter(f"{_SVG}text"):
        x, y = float(text.get("x", "")), float(text.get("y", ""))
        around = [area for area in areas if area[0] <= x <= area[2] and area[1] <= y <= area[3]]
        if around:
            left, _, right, _ = min(around, key=lambda area: area[2] - area[0])
            text.set("x", f"{(left + right) / 2:.2f}")
            text.set("text-anchor", "middle")


def _area(shape: ET.Element) -> Area:
    numbers = [float(text) for text in _number.findall(shape.get("points") or shape.get("d") or "")]
    return min(numbers[::2]), min(numbers[1::2]), max(numbers[::2]), max(numbers[1::2])
