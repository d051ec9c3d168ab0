"""The cores of this machine, and what torchrun says of the processes that it starts."""

from __future__ import annotations

import os

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def started(variable: str, default: int) -> int:
    """The whole number, at least ``default``, in a variable of the environment that torchrun sets.

    Raises:
        TltlError: TLT0862, it holds anything else.
    """
    text = os.environ.get(variable, str(default))
    if len(text) <= 9 and text.isascii() and text.isdecimal() and int(text) >= default:
        return int(text)
    title = f"the variable {variable} of the environment is `{text:.20}`, and not a whole number from {default} on"
    raise TltlError([Diagnostic("TLT0862", title, help="unset it, or start the command with torchrun, which sets it")])
