"""Links between files of the project as links between pages of the site."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Mapping
from typing import Final

from tltlc.diagnostics.codes import codes

_PART: Final = re.compile(
    # Fenced code, headings, indented lines without a link, code in a line.
    r"(?P<kept>^```.*?^```$|^#.*?$|^ {4}(?![^\n]*\]\().*?$|(?P<ticks>`+)(?:(?!\n\n).)+?(?P=ticks))"
    r"|(?P<text>!?\[(?:[^\]`]|`[^`]*`)*\])\((?P<target>[^)\s]+)\)"
    r"|(?<!\w)(?P<code>TLT[0-9]{4})(?!\w)",
    re.DOTALL | re.MULTILINE,
)


def to_pages(text: str, origin: str, uri: str, homes: Mapping[str, str]) -> str:
    """The Markdown of the file ``origin`` as that of the page ``uri``; codes of diagnostics become links.

    ``homes`` are the pages of files, or of a file's headings, by their paths in the project; what is in ``docs/`` has
    its own.  A link that leads nowhere stays, for MkDocs to report.
    """

    def part(found: re.Match[str]) -> str:
        if found["kept"]:
            return found[0]
        if found["code"]:
            return _code(found["code"], uri)
        return f"{found['text']}({_target(found['target'], origin, uri, homes)})"

    return _PART.sub(part, text)


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
