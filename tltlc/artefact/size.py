"""What is too large to be read again is not written."""

from __future__ import annotations

from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.limits import ARTEFACT

_ADVICE: Final = "declare atoms that never hold together `exclusive`, give the goals an order, or split the spec"
_SHORTEST_EDGE: Final = '    {"source": 0, "target": 0, "guard": {"text": "", "primes": []}},\n'


def check_size(what: str, size: int, commas: int = 0) -> None:
    """Refuse a file that could not be read again; ``size`` is in bytes, ``what`` is what messages call it.

    Raises:
        TltlError: TLT0004, it is larger than :data:`tltlc.io.limits.ARTEFACT`; TLT0006, it holds more values.
    """
    if size > ARTEFACT.size:
        raise _too_large("TLT0004", f"{what} would be larger than {ARTEFACT.size >> 20} MiB")
    if ARTEFACT.values is not None and commas >= ARTEFACT.values:
        raise _too_large("TLT0006", f"{what} would hold more than {ARTEFACT.values:,} values")


def least_size(fspa: Fspa) -> tuple[int, int]:
    """Bytes and commas that the edges of an artefact take at least; little else of a large one counts."""
    literals = sum(len(prime) for edge in fspa.edges for prime in edge.guard.primes)
    texts = sum(len(edge.guard.text) for edge in fspa.edges)
    size = len(_SHORTEST_EDGE) * len(fspa.edges) + texts + len("[0, true], ") * literals
    return size, 3 * len(fspa.edges) + 2 * literals - 1


def _too_large(code: str, title: str) -> TltlError:
    return TltlError([Diagnostic(code, title, help=_ADVICE)])
