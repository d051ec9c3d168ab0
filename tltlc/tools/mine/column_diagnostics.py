"""Diagnostics about columns that cannot be atoms.

They name the traces that differ from the others, or say that a column holds numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.samples import listed

_MOST_NAMED: Final = 4
"""The most columns that one message names."""


@record
class Columns:
    """The columns of a trace, each with whether it holds only `true` and `false`.

    ``trace`` is the name of the trace.
    """

    trace: str
    columns: Mapping[str, bool]


@record
class OddColumns:
    """Columns that some traces lack, or that hold values other than `true` and `false` there.

    ``names`` are the columns, ``traces`` the traces; ``others`` selects the second case.
    """

    traces: tuple[str, ...]
    others: bool
    names: tuple[str, ...]

    def warning(self) -> Diagnostic:
        """Return the warning TLT0763; it names the first of the traces."""
        is_one = len(self.names) == 1
        listed_names, consequence = some(self.names), "it is left out" if is_one else "they are left out"
        if not self.others:
            lack = "lacks" if len(self.traces) == 1 else "lack"
            title = f"{_first(self.traces)} {lack} the column{'s' * (not is_one)} {listed_names}, so {consequence}"
            return Diagnostic("TLT0763", title, help="record all traces with the same columns", severity="warning")
        hold = "holds" if is_one else "hold"
        title = f"{listed_names} {hold} other values than `true` and `false` in {_first(self.traces)}, so {consequence}"
        suggestion = "write `true` and `false` there, too, or compute atoms from numbers with `--predicates LIB`"
        return Diagnostic("TLT0763", title, help=suggestion, severity="warning")


def uneven(traces: Sequence[Columns], *, truths: bool) -> tuple[OddColumns, ...]:
    """Return the columns that at most half of the traces lack, grouped by these traces.

    ``truths``: also return columns with values other than `true` and `false` in fewer than half of
    them.
    """
    groups: dict[tuple[tuple[str, ...], bool], list[str]] = {}
    for name in dict.fromkeys(name for trace in traces for name in trace.columns):
        lacking = tuple(trace.trace for trace in traces if name not in trace.columns)
        others = tuple(trace.trace for trace in traces if not trace.columns.get(name, True))
        if lacking and 2 * len(lacking) <= len(traces):
            groups.setdefault((lacking, False), []).append(name)
        elif truths and others and not lacking and 2 * len(others) < len(traces):
            groups.setdefault((others, True), []).append(name)
    return tuple(OddColumns(*key, tuple(names)) for key, names in groups.items())


def some(names: Sequence[str]) -> str:
    """Return the names as a list; of many, the first ones and the number of the rest."""
    if len(names) <= _MOST_NAMED:
        return listed(names)
    shown = names[: _MOST_NAMED - 1]
    return f"{', '.join(f'`{name}`' for name in shown)} and {len(names) - len(shown)} more"


def _first(traces: Sequence[str]) -> str:
    """Return the first trace, and the number of further ones."""
    remaining = len(traces) - 1
    return f"`{traces[0]}`" + (f" and {remaining} other trace{'s' * (remaining > 1)}" if remaining else "")
