"""The cores of this machine, and the variables that torchrun sets for its processes."""

from __future__ import annotations

import os

from tltlc.api import Diagnostic, TltlError


def cores() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def torchrun_variable(variable: str, default: int) -> int:
    """Return the integer in an environment variable that torchrun sets, such as ``WORLD_SIZE``.

    If the variable is not set, return ``default``, which is also the least value.

    Raises:
        TltlError: TLT0862, the value is not an integer, or is below ``default``.
    """
    text = os.environ.get(variable, str(default))
    if len(text) <= 9 and text.isascii() and text.isdecimal() and int(text) >= default:
        return int(text)
    title = f"the environment variable {variable} is `{text:.20}`, not a whole number of at least {default}"
    raise TltlError([Diagnostic("TLT0862", title, help="unset it, or start the command with torchrun, which sets it")])
