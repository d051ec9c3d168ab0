"""What is said of columns that are no atoms: which trace it is that is unlike the others, or that they hold numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.samples import listed

_MOST_NAMED: Final = 4
"""Columns that are named in one message."""


@record
class Columns:
    """The columns of a trace, each with whether it holds `true` and `false` alone; ``trace`` is what it is called."""

    trace: str
    columns: Mapping[str, bool]


@record
class Odd:
    """Columns, ``names``, that some ``traces`` lack, or in which these hold ``others`` than `true` and `false`."""

    traces: tuple[str, ...]
    others: bool
    names: tuple[str, ...]

    def warning(self) -> Diagnostic:
        """TLT0763, with the first of the traces."""
        is_one = len(self.names) == 1
        said, left = some(self.names), "it is left out" if is_one else "they are left out"
        if not self.others:
            lack = "lacks" if len(self.traces) == 1 else "lack"
            title = f"{_first(self.traces)} {lack} the column{'s' * (not is_one)} {said}, so {left}"
            return Diagnostic("TLT0763", title, help="record all traces with the same columns", severity="warning")
        hold = "holds" if is_one else "hold"
        title = f"{said} {hold} other values than `true` and `false` in {_first(self.traces)}, so {left}"
        way_out = "write `true` and `false` there, too, or compute atoms from numbers with `--predicates LIB`"
        return Diagnostic("TLT0763", title, help=way_out, severity="warning")


def uneven(several: Sequence[Columns], *, truths: bool) -> tuple[Odd, ...]:
    """What no more than half of the traces lack, by the traces that do.

    ``truths``: also what is other than `true` and `false` in fewer than half of them.
    """
    found: dict[tuple[tuple[str, ...], bool], list[str]] = {}
    for name in dict.fromkeys(name for each in several for name in each.columns):
        lacking = tuple(each.trace for each in several if name not in each.columns)
        others = tuple(each.trace for each in several if not each.columns.get(name, True))
        if lacking and 2 * len(lacking) <= len(several):
            found.setdefault((lacking, False), []).append(name)
        elif truths and others and not lacking and 2 * len(others) < len(several):
            found.setdefault((others, True), []).append(name)
    return tuple(Odd(*which, tuple(names)) for which, names in found.items())


def some(names: Sequence[str]) -> str:
    """The names; of many the first ones and how many more."""
    if len(names) <= _MOST_NAMED:
        return listed(names)
    shown = names[: _MOST_NAMED - 1]
    return f"{', '.join(f'`{name}`' for name in shown)} and {len(names) - len(shown)} more"


def _first(traces: Sequence[str]) -> str:
    """A trace, of several the first one and how many more."""
    more = len(traces) - 1
    return f"`{traces[0]}`" + (f" and {more} other trace{'s' * (more > 1)}" if more else "")
