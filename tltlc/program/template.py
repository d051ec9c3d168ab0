"""The files that generated code is cut from: texts with places for what differs from one monitor to the next."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping

_BLOCK = re.compile(r"^[^\n@]*@@if (\w+)@@\n(.*?)^[^\n@]*@@end@@\n", re.MULTILINE | re.DOTALL)
_LINE = re.compile(r"^ *@@(\w+)@@\n", re.MULTILINE)
_PLACE = re.compile(r"@@(\w+)@@")


def filled(file: str, pieces: Mapping[str, str], present: Collection[str] = ()) -> str:
    """A file of the folder ``templates`` with its places filled.

    ``@@NAME@@`` becomes the piece of that name; a line that holds nothing else goes where the piece is empty.  Lines
    from ``@@if NAME@@`` to ``@@end@@``, which may stand in comments and do not nest, stay where NAME is in ``present``.

    Raises:
        KeyError: there is no such piece.
    """
    path = os.path.join(os.path.dirname(__file__), "..", "backends", "templates", file)  # noqa: PTH118, PTH120 (as codes.py)
    with open(path, encoding="utf-8") as template:  # noqa: PTH123
        return fill(template.read(), pieces, present)


def fill(text: str, pieces: Mapping[str, str], present: Collection[str] = ()) -> str:
    """A text with its places filled, as :func:`filled` says; what pieces hold is left as it is."""
    kept = _BLOCK.sub(lambda block: block[2] if block[1] in present else "", text)
    kept = _LINE.sub(lambda line: line[0] if pieces[line[1]] else "", kept)
    return _PLACE.sub(lambda place: pieces[place[1]], kept)
