"""Settings of resolution that come from outside the source text."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from tltlc.core.record import EMPTY, record


@record
class ResolveOptions:
    """Settings of resolution.

    ``library_dirs`` are searched for imports after the file's own folder. ``params`` maps names of
    params to values that replace the declared ones. A value is written as in a source text,
    ``"25 m"``; without a unit, it is in SI units. ``proofs`` turns on the proofs that predicates stay
    in their ranges. The proofs take longer than everything else. ``unfolded`` has the names of specs in
    which each bound becomes states, however many these are.
    """

    library_dirs: tuple[Path, ...] = ()
    params: Mapping[str, str] = EMPTY
    proofs: bool = True
    unfolded: tuple[str, ...] = ()
