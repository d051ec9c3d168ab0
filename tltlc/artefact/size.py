"""Refuse to write files that are too large to be read again."""

from __future__ import annotations

from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.limits import ARTEFACT

_ADVICE: Final = "declare atoms that never hold together `exclusive`, give the goals an order, or split the spec"
_SHORTEST_EDGE: Final = '    {"source": 0, "target": 0, "guard": {"text": "", "primes": []}},\n'


def check_size(subject: str, size: int, commas: int = 0) -> None:
    """Raise an error if a file would be too large to be read again.

    ``subject`` is the name of the file in messages, and ``size`` its size in bytes. ``commas`` is the
    number of commas in the file, which stands for the number of its values.

    Raises:
        TltlError: TLT0004 the file is larger than :data:`tltlc.io.limits.ARTEFACT` allows; TLT0006
            it has more values than this limit allows.
    """
    if size > ARTEFACT.size:
        raise _too_large("TLT0004", f"{subject} would be larger than {ARTEFACT.size >> 20} MiB")
    if ARTEFACT.values is not None and commas >= ARTEFACT.values:
        raise _too_large("TLT0006", f"{subject} would contain more than {ARTEFACT.values:,} values")


def least_size(fspa: Fspa) -> tuple[int, int]:
    """Return a lower bound for the size of an automaton's artefact in bytes, and one for its number of commas.

    Only edges are counted, since they are most of a large artefact.
    """
    literals = sum(len(prime) for edge in fspa.edges for prime in edge.guard.primes)
    size = len(_SHORTEST_EDGE) * len(fspa.edges) + len("[0, true], ") * literals
    return size, 3 * len(fspa.edges) + 2 * literals - 1


def _too_large(code: str, title: str) -> TltlError:
    return TltlError([Diagnostic(code, title, help=_ADVICE)])
