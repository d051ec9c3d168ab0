"""Build markup from texts, which are escaped: SVG elements, HTML sentences, and data for scripts."""

from __future__ import annotations

import json
import re
from html import escape
from typing import Any, Final

from markupsafe import Markup

_CODE: Final = re.compile(r"`([^`]+)`")
_SCRIPT: Final = {"<": "\\u003c", ">": "\\u003e", "&": "\\u0026", "\u2028": "\\u2028", "\u2029": "\\u2029"}


def element(name: str, /, *contents: object, **attributes: object) -> Markup:
    """Build an SVG element: ``element("g", "a < b", class_="x")`` -> ``<g class="x">a &lt; b</g>``.

    Each of the ``contents`` is escaped unless it is :class:`Markup`. In the name of an attribute,
    ``_`` becomes ``-``, and a ``_`` at the end is dropped.
    """
    attribute_text = "".join(_attribute(key, value) for key, value in attributes.items())
    return Markup(f"<{name}{attribute_text}>{''.join(map(_content, contents))}</{name}>")


def prose(text: str) -> Markup:
    """Convert a sentence to HTML; text between backquotes becomes a ``code`` element."""
    return Markup(_CODE.sub(r"<code>\1</code>", escape(text)))


def script_json(data: Any) -> Markup:
    """Encode data as JSON that can stand inside a ``script`` element of HTML.

    ``<``, ``>`` and ``&`` are escaped, so that the text cannot end the element or start a comment.
    """
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return Markup("".join(_SCRIPT.get(char, char) for char in text))


def coordinate(value: float) -> str:
    """Format a coordinate with at most two decimals: ``1.50`` -> ``1.5``, ``-0.001`` -> ``0``."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _attribute(key: str, value: object) -> str:
    return f' {key.rstrip("_").replace("_", "-")}="{escape(str(value))}"'


def _content(part: object) -> str:
    return part if isinstance(part, Markup) else escape(str(part))
