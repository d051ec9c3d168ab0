"""Write SVG elements, sentences and data of the page, with escaped texts."""

from __future__ import annotations

import json
import re
from html import escape
from typing import Any, Final

from markupsafe import Markup

_CODE: Final = re.compile(r"`([^`]+)`")
_SCRIPT: Final = {"<": "\\u003c", ">": "\\u003e", "&": "\\u0026", "\u2028": "\\u2028", "\u2029": "\\u2029"}


def element(name: str, /, *contents: object, **attributes: object) -> Markup:
    """Build an SVG element.

    Its contents are escaped one by one unless they are :class:`Markup`. In names of attributes,
    ``_`` becomes ``-``, and a trailing ``_`` is dropped (``class_``).
    """
    attribute_text = "".join(_attribute(key, value) for key, value in attributes.items())
    return Markup(f"<{name}{attribute_text}>{''.join(map(_content, contents))}</{name}>")


def prose(text: str) -> Markup:
    """Convert a sentence to HTML; text between backquotes becomes ``code``."""
    return Markup(_CODE.sub(r"<code>\1</code>", escape(text)))


def script_json(data: Any) -> Markup:
    """Encode data as JSON for a ``script`` element.

    The text cannot end the element or start a comment.
    """
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return Markup("".join(_SCRIPT.get(char, char) for char in text))


def coordinate(value: float) -> str:
    """Format a number with at most two decimals, for coordinates."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _attribute(key: str, value: object) -> str:
    return f' {key.rstrip("_").replace("_", "-")}="{escape(str(value))}"'


def _content(part: object) -> str:
    return part if isinstance(part, Markup) else escape(str(part))
