"""What resolution is told from outside the source text."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from tltlc.core.record import EMPTY, record


@record
class ResolveOptions:
    """``library_dirs`` are searched for imports after the file's own folder; ``params`` overrides values by name.

    A value is written as in a source text, ``"25 m"``; without a unit it is in SI units.  ``proofs`` says whether
    predicates are proved to stay in their ranges, which takes longer than all the rest.
    """

    library_dirs: tuple[Path, ...] = ()
    params: Mapping[str, str] = EMPTY
    proofs: bool = True
