"""Diagnostics about columns that are atoms in most traces, but not in all.

In the other traces, the column is missing, or has values other than `true` and `false`. So the
column is left out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.samples import name_list

_MOST_NAMED: Final = 4
"""The most columns that one message names."""


@record
class TraceColumns:
    """The columns of the trace with the name ``trace``.

    ``columns`` maps the name of each column to whether all its values are `true`, `false`, 1 or 0.
    """

    trace: str
    columns: Mapping[str, bool]


@record
class OddColumns:
    """Columns (``names``) that cannot be atoms because of the same few ``traces``.

    If ``has_other_values`` is false, these traces lack the columns. If it is true, they have the
    columns, but with values other than `true` and `false`.
    """

    traces: tuple[str, ...]
    has_other_values: bool
    names: tuple[str, ...]

    def warning(self) -> Diagnostic:
        """Return the warning TLT0763, which names some of the columns and the first of the traces."""
        is_one = len(self.names) == 1
        listed_names, consequence = first_names(self.names), "it is left out" if is_one else "they are left out"
        if not self.has_other_values:
            lack = "lacks" if len(self.traces) == 1 else "lack"
            title = f"{_first(self.traces)} {lack} the column{'s' * (not is_one)} {listed_names}, so {consequence}"
            return Diagnostic("TLT0763", title, help="record all traces with the same columns", severity="warning")
        have = "has" if is_one else "have"
        title = f"{listed_names} {have} values other than `true` and `false` in {_first(self.traces)}, so {consequence}"
        help_ = "write `true` and `false` there, too, or compute atoms from numbers with `--predicates LIB`"
        return Diagnostic("TLT0763", title, help=help_, severity="warning")


def odd_columns(traces: Sequence[TraceColumns], *, truths: bool) -> tuple[OddColumns, ...]:
    """Return the columns that would be atoms if a few traces did not differ from the others.

    - At least one trace lacks the column, and at most half of the traces do.
    - With ``truths``, also: no trace lacks the column, but at least one trace, and fewer than half,
      have values other than `true` and `false` in it.

    Columns that are odd for the same reason in the same traces are in one group.
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


def first_names(names: Sequence[str]) -> str:
    """Return a list of names as text: ```a`, `b` and `c```.

    If there are more than ``_MOST_NAMED`` names, list the first ones and say how many more there are.
    """
    if len(names) <= _MOST_NAMED:
        return name_list(names)
    first = names[: _MOST_NAMED - 1]
    return f"{', '.join(f'`{name}`' for name in first)} and {len(names) - len(first)} more"


def _first(traces: Sequence[str]) -> str:
    """Return the name of the first trace, and how many others there are: ```run.csv` and 2 other traces``."""
    remaining = len(traces) - 1
    return f"`{traces[0]}`" + (f" and {remaining} other trace{'s' * (remaining > 1)}" if remaining else "")
