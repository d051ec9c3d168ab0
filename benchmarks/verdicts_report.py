"""The part of RESULTS.md on how good the verdicts are: goals and tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record
from benchmarks.verdicts import ERROR, JUST_BELOW, LATEST, THRESHOLD, at_most, in_suite

ALARM_RATE: Final = 0.98
"""From this pass rate on, at most ``ERROR`` of the suites in which nothing has changed have a finding."""
PASS_RATE: Final = 0.85
"""What is asked for, where a suite says nothing else."""


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Rows of the table of goals, for what was drawn; each is judged by the upper limit of what was seen."""
    same, other = _drawn(records, changed=False), _drawn(records, changed=True)
    yield from _goal(
        f"nothing changed, pass rates from {ALARM_RATE:g} on: at most {ERROR:.0%} of suites with a `review` or `fail`",
        {name: each for name, each in same.items() if each["rates"][1] >= ALARM_RATE},
        lambda shares: 1.0 - shares["pass"],
    )
    yield from _goal(
        f"all cases just below their threshold: at most {ERROR:.0%} of suites with a `pass`",
        {name: each for name, each in same.items() if each["rates"][1] == JUST_BELOW},
        lambda shares: shares["pass"],
    )
    yield from _goal(
        f"all rewards changed by less than their threshold: at most {ERROR:.0%} of suites in which one certainly has",
        {name: each for name, each in other.items() if each["slight"]},
        lambda shares: shares["certain_change"],
    )


def _goal(
    goal: str, records: Mapping[str, Record], wrong: Callable[[Mapping[str, float]], float]
) -> Iterator[Sequence[str]]:
    found = [
        (in_suite(at_most(share, record["trials"]), int(size)), in_suite(share, int(size)), name, size)
        for name, record in records.items()
        for size, shares in record["suites"].items()
        for share in [wrong(shares)]
    ]
    if found:
        limit, seen, name, size = max(found)
        yield (
            goal,
            f"most {limit:.1%} ({seen:.1%} were seen), in suites of {size} cases of {name}",
            met_or_missed(limit <= ERROR),
        )


def section(records: Mapping[str, Record]) -> str:
    """The section on verdicts."""
    return "\n\n".join(part.strip() for part in (_unchanged(records), _changed(records)) if part)


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
            _of_suites(1.0 - shares["pass"], record["trials"], size),
            _of_suites(shares["pass"], record["trials"], size),
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
if all of its cases are like this one: false alarms where the pass rate is above the threshold of {PASS_RATE:g};
*suites with a `pass`* are misses where it is below. In brackets: upper limits of 95 %, by the number of trials.

{table(header, body)}
"""


def _changed(records: Mapping[str, Record]) -> str:
    body = [
        (
            name,
            record["trials"],
            size,
            *(f"{shares[verdict]:.3f}" for verdict in ("pass", "review", "fail")),
            f"{shares['uncertain']:.3f}",
            f"{shares['certain_change']:.3f}",
            *(f"{shares[f'changed_by_{latest}']:.2f}" for latest in LATEST),
            f"{shares['episodes']:.0f}",
        )
        for name, record in _drawn(records, changed=True).items()
        for size, shares in record["suites"].items()
    ]
    if not body:
        return ""
    found = [f"found by {latest}" for latest in LATEST]
    header = (
        "change",
        "trials",
        "cases",
        "`pass`",
        "`review`",
        "`fail`",
        "uncertain",
        "certainly changed",
        *found,
        "episodes",
    )
    return f"""
### Where something has changed

Independent episodes; *certainly changed*: the share of cases in which progress or reward was said to have changed by
more than its threshold of {THRESHOLD:g}; *found by* so many episodes: the share of cases that had a `review` or `fail`
by then. Where only the pass rate falls, and stays above the threshold, a `pass` is right.

{table(header, body)}
"""


def _of_suites(share: float, trials: int, size: str) -> str:
    """In how many suites of such cases at least one is as that share of the cases, and in how many at the most."""
    return f"{in_suite(share, int(size)):.1%} ({in_suite(at_most(share, trials), int(size)):.1%})"


def _drawn(records: Mapping[str, Record], *, changed: bool) -> dict[str, Record]:
    """The records of what has changed, or has not; those of an earlier rule do not say how much, and are left out."""
    return {name: each for name, each in records.items() if each.get("changed") is changed and "slight" in each}
