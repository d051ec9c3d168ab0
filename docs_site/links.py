"""Turn links between files of the project into links between pages of the site."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Mapping
from typing import Final

from tltlc.diagnostics.code_pages import codes

_PART: Final = re.compile(
    # Fenced code, headings, indented lines without a link, code in a line.
    r"(?P<kept>^```.*?^```$|^#.*?$|^ {4}(?![^\n]*\]\().*?$|(?P<ticks>`+)(?:(?!\n\n).)+?(?P=ticks))"
    r"|(?P<text>!?\[(?:[^\]`]|`[^`]*`)*\])\((?P<target>[^)\s]+)\)"
    r"|(?<!\w)(?P<code>TLT[0-9]{4})(?!\w)",
    re.DOTALL | re.MULTILINE,
)


def to_pages(text: str, origin: str, uri: str, homes: Mapping[str, str]) -> str:
    """Return the Markdown of the file ``origin`` with links that are right on the page ``uri``.

    Codes of diagnostics become links. ``homes`` has the URIs of the pages that stand for files, or
    for sections of files (``FILE#ANCHOR``). Files in ``docs/`` need no entry. A link to a file
    without a page stays as it is, and MkDocs reports it.
    """

    def replace_part(match: re.Match[str]) -> str:
        if match["kept"]:
            return match[0]
        if match["code"]:
            return _code(match["code"], uri)
        return f"{match['text']}({_target(match['target'], origin, uri, homes)})"

    return _PART.sub(replace_part, text)


def _code(code: str, uri: str) -> str:
    place = f"diagnostics/{code}.md"
    return code if place == uri or code not in codes() else f"[{code}]({_relative(place, uri)})"


def _target(target: str, origin: str, uri: str, homes: Mapping[str, str]) -> str:
    if re.match(r"\w+:", target):
        return target
    path, hash_, anchor = target.partition("#")
    path = posixpath.normpath(posixpath.join(posixpath.dirname(origin), path)) if path else origin
    home = homes.get(f"{path}#{anchor}") or homes.get(path)
    if home is None:
        if not path.startswith("docs/"):
            return target
        home = path.removeprefix("docs/")
    return f"#{anchor}" if home == uri and anchor else _relative(home, uri) + hash_ + anchor


def _relative(place: str, uri: str) -> str:
    return posixpath.relpath(place, posixpath.dirname(uri) or ".")
