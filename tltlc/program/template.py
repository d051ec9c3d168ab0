"""Fill the templates of generated code: texts with places for the parts that differ between monitors."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping

_BLOCK = re.compile(r"^[^\n@]*@@if (\w+)@@\n(.*?)^[^\n@]*@@end@@\n", re.MULTILINE | re.DOTALL)
_LINE = re.compile(r"^ *@@(\w+)@@\n", re.MULTILINE)
_PLACE = re.compile(r"@@(\w+)@@")


def fill_template(file: str, pieces: Mapping[str, str], present: Collection[str] = ()) -> str:
    """Return the text of a file of the folder ``templates`` with its places filled.

    ``@@NAME@@`` becomes ``pieces["NAME"]``. A line that has only a place disappears if the piece is
    empty. Lines from ``@@if NAME@@`` to ``@@end@@``, which may be comments and do not nest, are kept
    if NAME is in ``present``.

    Raises:
        KeyError: there is no piece for a place.
    """
    path = os.path.join(os.path.dirname(__file__), "..", "backends", "templates", file)  # noqa: PTH118, PTH120 (as codes.py)
    with open(path, encoding="utf-8") as template:  # noqa: PTH123
        return fill(template.read(), pieces, present)


def fill(text: str, pieces: Mapping[str, str], present: Collection[str] = ()) -> str:
    """Return a text with its places filled, as in :func:`fill_template`; places inside pieces are left alone."""
    remaining = _BLOCK.sub(lambda block: block[2] if block[1] in present else "", text)
    remaining = _LINE.sub(lambda line: line[0] if pieces[line[1]] else "", remaining)
    return _PLACE.sub(lambda place: pieces[place[1]], remaining)
