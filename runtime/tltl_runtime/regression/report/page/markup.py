"""HTML and SVG from Python: elements whose texts cannot be taken for markup."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from html import escape
from typing import Any, Final

_VOID: Final = frozenset({"br", "hr", "img", "input", "link", "meta"})
_CODE: Final = re.compile(r"`([^`]+)`")
_SCRIPT: Final = {"<": "\\u003c", ">": "\\u003e", "&": "\\u0026", "\u2028": "\\u2028", "\u2029": "\\u2029"}


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


def element(name: str, /, *inside: object, **attributes: object) -> Markup:
    """An element; what is inside is escaped unless it is :class:`Markup`, and left out where it is None.

    The names of attributes are written with ``_`` for ``-``, and one at the end is dropped (``class_``).  Of an
    attribute without a value the value is True; None and False leave it out.
    """
    written = "".join(_attribute(key, value) for key, value in attributes.items())
    if name in _VOID:
        return Markup(f"<{name}{written}>")
    return Markup(f"<{name}{written}>{joined(inside)}</{name}>")


def joined(parts: Iterable[object]) -> Markup:
    """The parts one after the other, each escaped unless it is :class:`Markup`."""
    return Markup("".join(_inside(each) for each in parts if each is not None))


def prose(text: str) -> Markup:
    """A sentence in which names stand between backquotes."""
    return Markup(_CODE.sub(r"<code>\1</code>", escape(text)))


def as_script(data: Any) -> Markup:
    """Data as JSON that can stand in a ``script`` element: nothing in it ends one, or begins a comment."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return Markup("".join(_SCRIPT.get(each, each) for each in text))


def short(value: float) -> str:
    """A number with at most two places, for coordinates."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _attribute(key: str, value: object) -> str:
    if value is None or value is False:
        return ""
    name = key.rstrip("_").replace("_", "-")
    return f" {name}" if value is True else f' {name}="{escape(str(value))}"'


def _inside(part: object) -> str:
    return part if isinstance(part, Markup) else escape(str(part))
