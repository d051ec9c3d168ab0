"""What the headers say that tltlc writes for itself, and other tools pass over."""

from __future__ import annotations

from typing import Any, Final

from tltlc.core.record import record
from tltlc.resolve.spec import Judge
from tltlc.tools.hoa.problems import other_kind
from tltlc.tools.hoa.tree import Header, Hoa

_LARGEST: Final = 10**9


@record
class Metadata:
    """Fields as of :class:`~tltlc.resolve.spec.Spec`; None where the file does not say."""

    judge: Judge | None = None
    limit_steps: int | None = None
    level: str | None = None
    formula: str | None = None


def metadata(hoa: Hoa) -> Metadata:
    """What ``tltlc-formula:``, ``tltlc-judge:``, ``tltlc-level:`` and ``tltlc-limit:`` say.

    Raises:
        TltlError: TLT0652, a header does not say what it is for.
    """
    found: dict[str, Any] = {}
    for header in hoa.headers:
        if header.name == "tltlc-judge:":
            found["judge"] = _one_of(hoa, header, ("goal", "limit"))
        elif header.name == "tltlc-limit:":
            found["limit_steps"] = _steps(hoa, header)
        elif header.name in ("tltlc-level:", "tltlc-formula:"):
            found[header.name.removeprefix("tltlc-")[:-1]] = " ".join(header.values) or None
    return Metadata(**found)


def _one_of(hoa: Hoa, header: Header, values: tuple[str, ...]) -> str:
    if len(header.values) != 1 or header.values[0] not in values:
        title, way_out = f"this header says {' or '.join(f'`{each}`' for each in values)}", "or leave it out"
        raise other_kind(hoa.source, header.span, title, way_out)
    return header.values[0]


def _steps(hoa: Hoa, header: Header) -> int:
    value = header.values[0] if len(header.values) == 1 else ""
    if not value.isdecimal() or not 0 < int(value[:12]) <= _LARGEST:
        title, way_out = "this header says a number of steps, at least 1", "or leave it out"
        raise other_kind(hoa.source, header.span, title, way_out)
    return int(value)
