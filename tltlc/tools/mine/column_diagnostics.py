"""Diagnostics about columns that are atoms in most traces, but not in all.

In the other traces, the column is missing, or has values other than `true` and `false`, or than
robustness values. So the column is left out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, Literal

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.samples import name_list
from tltlc.tools.mine.columns import ColumnKind

_MOST_NAMED: Final = 4
"""The most columns that one message names."""

_Problem = Literal["lacking", "no truths", "no robustness"]


@record
class TraceColumns:
    """The columns of the trace with the name ``trace``: ``columns`` maps the name of each column to its kind."""

    trace: str
    columns: Mapping[str, ColumnKind]


@record
class OddColumns:
    """Columns (``names``) that cannot be atoms because of the same few ``traces``.

    These traces lack the columns, or have values in them that are no truth values, or no robustness values.
    """

    traces: tuple[str, ...]
    problem: _Problem
    names: tuple[str, ...]

    def warning(self) -> Diagnostic:
        """Return the warning TLT0763, which names some of the columns and the first of the traces."""
        is_one = len(self.names) == 1
        listed_names, consequence = first_names(self.names), "it is left out" if is_one else "they are left out"
        if self.problem == "lacking":
            lack = "lacks" if len(self.traces) == 1 else "lack"
            title = f"{_first(self.traces)} {lack} the column{'s' * (not is_one)} {listed_names}, so {consequence}"
            return Diagnostic("TLT0763", title, help="record all traces with the same columns", severity="warning")
        have = "has" if is_one else "have"
        values, help_ = "other than `true` and `false`", "write `true` and `false` there, too"
        if self.problem == "no robustness":
            values, help_ = "outside [-1, 1]", "write robustness values there, too"
        title = f"{listed_names} {have} values {values} in {_first(self.traces)}, so {consequence}"
        help_ += ", or compute atoms from numbers with `--predicates LIB`"
        return Diagnostic("TLT0763", title, help=help_, severity="warning")


def odd_columns(
    traces: Sequence[TraceColumns], common: Mapping[str, ColumnKind] | None = None
) -> tuple[OddColumns, ...]:
    """Return the columns that would be atoms if a few traces did not differ from the others.

    - At least one trace lacks the column, and at most half of the traces do.
    - With ``common``, the kinds of the columns that all traces have, also: no trace lacks the column, but
      at least one trace, and fewer than half, have values in it that make it no atom.

    Columns that are odd for the same reason in the same traces are in one group.
    """
    groups: dict[tuple[tuple[str, ...], _Problem], list[str]] = {}
    for name in dict.fromkeys(name for trace in traces for name in trace.columns):
        lacking = tuple(trace.trace for trace in traces if name not in trace.columns)
        if lacking and 2 * len(lacking) <= len(traces):
            groups.setdefault((lacking, "lacking"), []).append(name)
        elif common and not lacking and common[name] in (ColumnKind.SHARES, ColumnKind.OTHER):
            no_truths = tuple(trace.trace for trace in traces if trace.columns[name] != ColumnKind.TRUTHS)
            no_robustness = tuple(trace.trace for trace in traces if trace.columns[name] == ColumnKind.OTHER)
            is_robustness = any(trace.columns[name] == ColumnKind.ROBUSTNESS for trace in traces)
            if 0 < 2 * len(no_truths) < len(traces):
                groups.setdefault((no_truths, "no truths"), []).append(name)
            elif is_robustness and 0 < 2 * len(no_robustness) < len(traces):
                groups.setdefault((no_robustness, "no robustness"), []).append(name)
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
