"""Make names and sentences from files safe to print on terminals and in logs."""

from __future__ import annotations

import re
from typing import Final

_BEGINS_COMMAND: Final = re.compile(r"^(\s*):(?=:)")
_OLD_COMMAND: Final = "##["


def plain_text(text: str) -> str:
    """Return the text in one line, without control characters and without workflow commands.

    GitHub Actions takes ``::`` at the start of a line, possibly after blanks, for a command, and
    ``##[`` anywhere. So a blank is inserted: ``: :`` and ``## [``.
    """
    line = "".join(" " if char.isspace() else char if char.isprintable() else "\ufffd" for char in text)
    return _BEGINS_COMMAND.sub(r"\1: ", line).replace(_OLD_COMMAND, "## [")
