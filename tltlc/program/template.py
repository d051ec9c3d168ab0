"""Fill the templates of generated code: texts with places for what differs between monitors."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping

_BLOCK = re.compile(r"^[^\n@]*@@if (\w+)@@\n(.*?)^[^\n@]*@@end@@\n", re.MULTILINE | re.DOTALL)
_LINE = re.compile(r"^ *@@(\w+)@@\n", re.MULTILINE)
_PLACE = re.compile(r"@@(\w+)@@")


def filled(file: str, pieces: Mapping[str, str], present: Collection[str] = ()) -> str:
    """Return a file of the folder ``templates`` with its places filled.

    ``@@NAME@@`` becomes the piece of that name. A line that holds only a place disappears if the
    piece is empty. Lines from ``@@if NAME@@`` to ``@@end@@``, which may be comments and do not
    nest, are kept if NAME is in ``present``.

    Raises:
        KeyError: there is no piece of that name.
    """
    path = os.path.join(os.path.dirname(__file__), "..", "backends", "templates", file)  # noqa: PTH118, PTH120 (as codes.py)
    with open(path, encoding="utf-8") as template:  # noqa: PTH123
        return fill(template.read(), pieces, present)


def fill(text: str, pieces: Mapping[str, str], present: Collection[str] = ()) -> str:
    """Return a text with its places filled, as in :func:`filled`; places inside pieces are left alone."""
    remaining = _BLOCK.sub(lambda block: block[2] if block[1] in present else "", text)
    remaining = _LINE.sub(lambda line: line[0] if pieces[line[1]] else "", remaining)
    return _PLACE.sub(lambda place: pieces[place[1]], remaining)
