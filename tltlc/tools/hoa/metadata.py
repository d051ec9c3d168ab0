"""Read the headers that tltlc adds to its HOA files, and that other tools ignore."""

from __future__ import annotations

from typing import Any, Final

from tltlc.core.record import record
from tltlc.resolve.spec import JudgeMode
from tltlc.tools.hoa.problems import unsupported_error
from tltlc.tools.hoa.tree import Header, Hoa

_LARGEST: Final = 10**9


@record
class Metadata:
    """The values of the headers that tltlc adds; None for each header that is missing.

    The fields mean the same as in :class:`~tltlc.resolve.spec.Spec`, but ``formula`` is a text.
    """

    judge: JudgeMode | None = None
    limit_steps: int | None = None
    level: str | None = None
    formula: str | None = None


def metadata(hoa: Hoa) -> Metadata:
    """Return the values of ``tltlc-formula:``, ``tltlc-judge:``, ``tltlc-level:`` and ``tltlc-limit:``.

    Raises:
        TltlError: TLT0652 if a header has a wrong value.
    """
    fields: dict[str, Any] = {}
    for header in hoa.headers:
        if header.name == "tltlc-judge:":
            fields["judge"] = _choice(hoa, header, ("goal", "limit"))
        elif header.name == "tltlc-limit:":
            fields["limit_steps"] = _steps(hoa, header)
        elif header.name in ("tltlc-level:", "tltlc-formula:"):
            fields[header.name.removeprefix("tltlc-")[:-1]] = " ".join(header.values) or None
    return Metadata(**fields)


def _choice(hoa: Hoa, header: Header, values: tuple[str, ...]) -> str:
    if len(header.values) != 1 or header.values[0] not in values:
        title, help_ = (
            f"this header must be {' or '.join(f'`{value}`' for value in values)}",
            "write one of these, or leave it out",
        )
        raise unsupported_error(hoa.source, header.span, title, help_)
    return header.values[0]


def _steps(hoa: Hoa, header: Header) -> int:
    value = header.values[0] if len(header.values) == 1 else ""
    if not value.isdecimal() or not 0 < int(value[:12]) <= _LARGEST:
        title = f"this header must be a number of steps from 1 to {_LARGEST:,}"
        help_ = "write such a number, or leave it out"
        raise unsupported_error(hoa.source, header.span, title, help_)
    return int(value)
