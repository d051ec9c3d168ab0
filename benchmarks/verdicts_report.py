"""The part of RESULTS.md on how good the verdicts are: goals and tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record
from benchmarks.verdicts import ERROR, LATEST, in_suite

ALARM_RATE: Final = 0.98
"""From this pass rate on, at most ``ERROR`` of the suites in which nothing has changed have a finding."""
THRESHOLD: Final = 0.85
"""The pass rate that is asked for, where a suite says nothing else."""


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Rows of the table of goals, for what was drawn."""
    alarms = list(_worst(records, lambda rate: rate >= ALARM_RATE, lambda shares: 1.0 - shares["pass"]))
    if alarms:
        most, name, size = max(alarms)
        yield (
            f"nothing changed, pass rates from {ALARM_RATE:g} on: at most {ERROR:.0%} of suites with a `review` or"
            " `fail`",
            f"most {most:.1%}, in suites of {size} cases of {name}",
            met_or_missed(most <= ERROR),
        )
    misses = list(_worst(records, lambda rate: rate < THRESHOLD, lambda shares: shares["pass"]))
    if misses:
        most, name, size = max(misses)
        yield (
            f"all cases below their threshold: at most {ERROR:.0%} of suites with a `pass`",
            f"most {most:.1%}, in suites of {size} cases of {name}",
            met_or_missed(most <= ERROR),
        )


def section(records: Mapping[str, Record]) -> str:
    """The section on verdicts."""
    return "\n\n".join(part.strip() for part in (_unchanged(records), _changed(records)) if part)


def _worst(
    records: Mapping[str, Record], holds: Callable[[float], bool], wrong: Callable[[Mapping[str, float]], float]
) -> Iterable[tuple[float, str, int]]:
    """How many suites have a wrong verdict, where nothing has changed and ``holds`` says so of the pass rate."""
    for name, record in _drawn(records, changed=False).items():
        if holds(record["rates"][1]):
            for size, shares in record["suites"].items():
                yield in_suite(wrong(shares), int(size)), name, int(size)


def _unchanged(records: Mapping[str, Record]) -> str:
    body = [
        (
            f"{record['rates'][1]:g}",
            record["pairing"],
            record["trials"],
            size,
            *(f"{shares[verdict]:.3f}" for verdict in ("pass", "review", "fail")),
            f"{shares['uncertain']:.3f}",
            f"{shares['episodes']:.0f}",
            f"{in_suite(1.0 - shares['pass'], int(size)):.1%}",
            f"{in_suite(shares['pass'], int(size)):.1%}",
        )
        for record in _drawn(records, changed=False).values()
        for size, shares in record["suites"].items()
    ]
    if not body:
        return ""
    header = (
        "pass rate",
        "episodes of equal seeds",
        "trials",
        "cases",
        "`pass`",
        "`review`",
        "`fail`",
        "uncertain",
        "episodes",
        "suites with a finding",
        "suites with a `pass`",
    )
    return f"""
## Verdicts, by simulation

`python -m benchmarks --only verdicts` draws episodes at random and has them judged by the rule of `tltlc regress`, with
its default thresholds and an error of {ERROR:g} for a suite. Successes have a reward of 0.79 ± 0.05, failures one of
-0.3 ± 0.2 and a progress of 0.25, 0.5 or 0.75. Here the policy plays as when the baseline was recorded; *episodes of
equal seeds* are the same as in the baseline (`identical`: nothing that the policy meets has changed), drawn anew
(`independent`), or half of them so. *Cases*: of the suite, which share its error. Shares of cases: *uncertain* are
verdicts that only came since all episodes were played. *Suites with a finding* are those in which a case does not pass,
if all of its cases are like this one: false alarms where the pass rate is above the threshold of {THRESHOLD:g};
*suites with a `pass`* are misses where it is below.

{table(header, body)}
"""


def _changed(records: Mapping[str, Record]) -> str:
    body = [
        (
            name,
            record["trials"],
            size,
            *(f"{shares[verdict]:.3f}" for verdict in ("pass", "review", "fail")),
            *(f"{shares[f'changed_by_{latest}']:.2f}" for latest in LATEST),
            f"{shares['episodes']:.0f}",
        )
        for name, record in _drawn(records, changed=True).items()
        for size, shares in record["suites"].items()
    ]
    if not body:
        return ""
    found = [f"found by {latest}" for latest in LATEST]
    header = ("change", "trials", "cases", "`pass`", "`review`", "`fail`", *found, "episodes")
    return f"""
### Where something has changed

Independent episodes; *found by* so many episodes: the share of cases that had a `review` or `fail` by then. Where only
the pass rate falls, and stays above the threshold, a `pass` is right.

{table(header, body)}
"""


def _drawn(records: Mapping[str, Record], *, changed: bool) -> dict[str, Record]:
    return {name: record for name, record in records.items() if record.get("changed") is changed}
