"""Errors for samples and params that a monitor cannot use."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

SUGGESTIONS: Final = {
    "TLT0611": "supply every signal that the atoms use, at each step",
    "TLT0612": "check how the game computes it",
    "TLT0613": "give its predicate a value for this case, with `when`",
    "TLT0614": "remove the declaration, or check how the game computes them",
    "TLT0615": "supply it on the declared scale, or declare the range that it has",
    "TLT0616": "write `clamp(…, -1, 1)` in its predicate",
    "TLT0619": "give the seconds since the sample before, at least 0, as `dt`: `monitor.step(signals, dt)`",
}
"""The advice of each diagnostic about a sample, by its code."""

MISSING_BOOLS: Final = (
    "supply them at each step; if a missing bool counts as false, use `tltlc monitor --sparse` or"
    " `Monitor(fspa, sparse=True)`"
)
"""The advice of TLT0611 if only bools are missing."""


class MonitorError(TltlError):
    """Raised for a sample or param that the monitor cannot use.

    The state of the monitor stays unchanged.
    """


def sample_error(code: str, when: int | str, text: str, advice: str | None = None) -> MonitorError:
    """Return the error that says what is wrong with a sample; ``advice`` replaces the advice of its code.

    ``when`` says which sample it is: its number, from 1, or a phrase.
    """
    return MonitorError([Diagnostic(code, f"{sample_place(when)}: {text}", help=advice or SUGGESTIONS[code])])


def sample_place(when: int | str) -> str:
    """Return the phrase for a sample that begins a message, such as ``step 3``."""
    return when if isinstance(when, str) else f"step {when}"
