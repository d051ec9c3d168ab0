"""Templates: texts of generated code with placeholders for the parts that differ between monitors."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping

_BLOCK = re.compile(r"^[^\n@]*@@if (\w+)@@\n(.*?)^[^\n@]*@@end@@\n", re.MULTILINE | re.DOTALL)
_LINE = re.compile(r"^ *@@(\w+)@@\n", re.MULTILINE)
_PLACE = re.compile(r"@@(\w+)@@")


def fill_template(file: str, pieces: Mapping[str, str], present: Collection[str] = ()) -> str:
    """Return the text of a template, which is a file in this folder, with its placeholders replaced.

    ``@@NAME@@`` is replaced by ``pieces["NAME"]``. If this piece is empty, a line with nothing but
    the placeholder is removed. The lines between ``@@if NAME@@`` and ``@@end@@`` are kept if NAME is
    in ``present``, and removed otherwise; these two marks may be in comments and cannot be nested.

    Raises:
        KeyError: ``pieces`` has no entry for a placeholder.
    """
    path = os.path.join(os.path.dirname(__file__), file)  # noqa: PTH118, PTH120 (as codes.py)
    with open(path, encoding="utf-8") as template:  # noqa: PTH123
        return fill(template.read(), pieces, present)


def names_in(file: str, pattern: str) -> frozenset[str]:
    """Return all texts in a template that the first group of a regular expression matches, such as its identifiers."""
    path = os.path.join(os.path.dirname(__file__), file)  # noqa: PTH118, PTH120 (as codes.py)
    with open(path, encoding="utf-8") as template:  # noqa: PTH123
        return frozenset(re.findall(pattern, template.read()))


def fill(text: str, pieces: Mapping[str, str], present: Collection[str] = ()) -> str:
    """Return a text with its placeholders replaced as in :func:`fill_template`.

    Placeholders inside ``pieces`` are not replaced.
    """
    remaining = _BLOCK.sub(lambda block: block[2] if block[1] in present else "", text)
    remaining = _LINE.sub(lambda line: line[0] if pieces[line[1]] else "", remaining)
    return _PLACE.sub(lambda place: pieces[place[1]], remaining)
