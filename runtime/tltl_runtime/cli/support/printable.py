"""Names and sentences out of files, printed so that neither a terminal nor a log takes them for commands."""

from __future__ import annotations

import re
from typing import Final

_BEGINS_COMMAND: Final = re.compile(r"^(\s*):(?=:)")
_OLD_COMMAND: Final = "##["


def plain(text: str) -> str:
    """The text in one line, without control characters, such as those of colours.

    Nothing in it is a workflow command of GitHub Actions, which are told by ``::`` at the beginning of a line, blanks
    before it or not, and by ``##[`` anywhere: there is a blank within these.
    """
    line = "".join(" " if sign.isspace() else sign if sign.isprintable() else "\ufffd" for sign in text)
    return _BEGINS_COMMAND.sub(r"\1: ", line).replace(_OLD_COMMAND, "## [")
