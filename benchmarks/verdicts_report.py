"""The section of RESULTS.md on the quality of verdicts: goals and tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record
from benchmarks.verdicts import ERROR, JUST_BELOW, LATEST, THRESHOLD, probability_in_suite, upper_limit

ALARM_RATE: Final = 0.98
"""From this pass rate on, at most ``ERROR`` of the suites without changes may have a finding."""
PASS_RATE: Final = 0.85
"""The default threshold of the pass rate."""


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals; each is judged by the upper limit of the probability."""
    unchanged, changed = _simulated_records(records, changed=False), _simulated_records(records, changed=True)
    yield from _goal(
        f"nothing changed, pass rates from {ALARM_RATE:g} on: at most {ERROR:.0%} of suites with a `review` or `fail`",
        {name: record for name, record in unchanged.items() if record["rates"][1] >= ALARM_RATE},
        lambda shares: 1.0 - shares["pass"],
    )
    yield from _goal(
        f"all cases just below their threshold: at most {ERROR:.0%} of suites with a `pass`",
        {name: record for name, record in unchanged.items() if record["rates"][1] == JUST_BELOW},
        lambda shares: shares["pass"],
    )
    yield from _goal(
        f"all rewards changed by less than their threshold: at most {ERROR:.0%} of suites in which one certainly has",
        {name: record for name, record in changed.items() if record["slight"]},
        lambda shares: shares["certain_change"],
    )


def _goal(
    goal: str, records: Mapping[str, Record], wrong: Callable[[Mapping[str, float]], float]
) -> Iterator[Sequence[str]]:
    limits = [
        (
            probability_in_suite(upper_limit(share, record["trials"]), int(size)),
            probability_in_suite(share, int(size)),
            name,
            size,
        )
        for name, record in records.items()
        for size, shares in record["suites"].items()
        for share in [wrong(shares)]
    ]
    if limits:
        limit, seen, name, size = max(limits)
        yield (
            goal,
            f"most {limit:.1%} ({seen:.1%} were seen), in suites of {size} cases of {name}",
            met_or_missed(limit <= ERROR),
        )


def section(records: Mapping[str, Record]) -> str:
    """Return the section on verdicts; empty without measurements."""
    return "\n\n".join(part.strip() for part in (_unchanged_section(records), _changed_section(records)) if part)


def _unchanged_section(records: Mapping[str, Record]) -> str:
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
        for record in _simulated_records(records, changed=False).values()
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

`python -m benchmarks --only verdicts` draws random episodes and judges them by the rule of `tltlc regress`, with its
default thresholds and an error of {ERROR:g} for a suite. Successes have a reward of 0.79 ± 0.05, failures one of
-0.3 ± 0.2 and a progress of 0.25, 0.5 or 0.75. Here the policy plays as when the baseline was recorded. *Episodes of
equal seeds* are the same as in the baseline (`identical`: nothing that the policy meets has changed), new
(`independent`), or half of them are new (`half`). *Cases*: the number of cases of the suite, which share its error. The
next columns are shares of cases; *uncertain* verdicts came only after all episodes were played. *Suites with a finding*
are suites of such cases in which a case does not pass: false alarms, if the pass rate is above the threshold of
{PASS_RATE:g}. *Suites with a `pass`* are misses, if the pass rate is below it. In brackets: upper limits at 95 %, by
the number of trials.

{table(header, body)}
"""


def _changed_section(records: Mapping[str, Record]) -> str:
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
        for name, record in _simulated_records(records, changed=True).items()
        for size, shares in record["suites"].items()
    ]
    if not body:
        return ""
    found_columns = [f"found by {latest}" for latest in LATEST]
    header = (
        "change",
        "trials",
        "cases",
        "`pass`",
        "`review`",
        "`fail`",
        "uncertain",
        "certainly changed",
        *found_columns,
        "episodes",
    )
    return f"""
### Where something has changed

The episodes are independent. *Certainly changed*: the share of cases in which the verdict reports that progress or
reward certainly changed by more than its threshold of {THRESHOLD:g}. *Found by N*: the share of cases that had a
`review` or `fail` after N episodes. If only the pass rate falls, and stays above the threshold, a `pass` is right.

{table(header, body)}
"""


def _of_suites(share: float, trials: int, size: str) -> str:
    """Return the probability that a suite has one of the counted cases, and in brackets its upper limit.

    ``share`` is the share of these cases in the trials.
    """
    limit = probability_in_suite(upper_limit(share, trials), int(size))
    return f"{probability_in_suite(share, int(size)):.1%} ({limit:.1%})"


def _simulated_records(records: Mapping[str, Record], *, changed: bool) -> dict[str, Record]:
    """Return the records of scenarios with or without a change; records of an earlier format are left out."""
    return {name: record for name, record in records.items() if record.get("changed") is changed and "slight" in record}
