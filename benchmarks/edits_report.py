"""The section of RESULTS.md on random edits: goals, and a row for each edit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record

EXPERT: Final = "expert "
"""Prefix of the records of the expert on unedited levels; the name of the level follows."""

ALARM_RATE: Final = 1 / 20
"""The greatest share of edits without effect that may get a `review` or `fail`."""

_INFEASIBLE: Final = ("infeasible", "in part")
_TRUTHS: Final = (*_INFEASIBLE, "changed", "unchanged")
_VERDICTS: Final = ("pass", "review", "fail")


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals for what was measured."""
    edits = _edits(records)
    infeasible = {name: edit for name, edit in edits.items() if edit["truth"] in _INFEASIBLE}
    if infeasible:
        misses = [name for name, edit in infeasible.items() if edit["verdict"] == "pass"]
        yield (
            "of random edits, no `pass` where some of what the spec asks cannot be done any more",
            f"{len(misses)} of {len(infeasible)}" + (f": {', '.join(misses)}" if misses else ""),
            met_or_missed(not misses),
        )
    unchanged = {name: edit for name, edit in edits.items() if edit["truth"] == "unchanged"}
    if unchanged:
        alarms = [name for name, edit in unchanged.items() if edit["verdict"] != "pass"]
        yield (
            "of random edits that change nothing, at most 1 in 20 with a `review` or `fail`",
            f"{len(alarms)} of {len(unchanged)}" + (f": {', '.join(alarms)}" if alarms else ""),
            met_or_missed(len(alarms) <= ALARM_RATE * len(unchanged)),
        )


def section(records: Mapping[str, Record]) -> str:
    """Return the section on random edits; empty without measurements."""
    edits = _edits(records)
    if not edits:
        return ""
    counts = Counter((edit["truth"], edit["verdict"]) for edit in edits.values())
    truths = [truth for truth in _TRUTHS if any(edit["truth"] == truth for edit in edits.values())]
    sums = [(truth, *(counts[truth, verdict] for verdict in _VERDICTS)) for truth in truths]
    header = ("edit", "what it says", "truth", "expert", "same", "verdict", "met", "same", "progress", "reward")
    failed = [f"{name} ({record['failed']})" for name, record in records.items() if "failed" in record]
    parts = [
        f"""
## Verdicts on random edits

`python -m benchmarks --only regression` makes {len(edits)} random edits of the assets that the levels share. The
shipped policies play the edited levels, and `tltlc regress` judges them as one suite. *Truth*: `infeasible` if nobody
can meet the spec, by an over-approximation of what can be reached; `in part` if that holds in some episodes, since
chance decides which way opens; `unchanged` if all of the scripted expert's episodes go as before the edit, step by
step; otherwise `changed`. *Expert*: in how many of its episodes it meets the spec (25, unless it fails in five in a
row), and how many go as before (*same*); for {_before(records)} before. *Met*: how many episodes of the policy met the
spec, of the episodes that were played until the verdict was certain; `*` marks a verdict that is not certain. *Same*:
how many of them went as before the edit. *Progress* and *reward* are means, with those of the baseline in brackets.

{table(("truth", *(f"`{verdict}`" for verdict in _VERDICTS)), sums)}

{_bounds(counts)}

{table(header, [_row(name, edit) for name, edit in edits.items()])}
""",
        f"Failed: {', '.join(failed)}." if failed else "",
    ]
    return "\n\n".join(part.strip() for part in parts if part)


def _bounds(counts: Mapping[tuple[str, str], int]) -> str:
    """Return a sentence with upper limits, at 95 %, of the probabilities of mistakes that did not occur."""
    questions = (
        ("a `pass` of an infeasible one", _INFEASIBLE, ("pass",)),
        ("a finding on an unchanged one", ("unchanged",), ("review", "fail")),
    )
    bounds = []
    for title, truths, wrong in questions:
        trials = sum(counts[truth, verdict] for truth in truths for verdict in _VERDICTS)
        if trials and not any(counts[truth, verdict] for truth in truths for verdict in wrong):
            bounds.append(
                f"{title}, seen in 0 of {trials}, may have a probability of up to {1 - 0.05 ** (1 / trials):.0%}"
            )
    return f"So few edits leave much open: {'; '.join(bounds)} (at 95 %)." if bounds else ""


def _row(name: str, edit: Record) -> Sequence[object]:
    expert, now, before, episodes = edit["expert"], edit["now"], edit["before"], edit["episodes"]
    return (
        name,
        edit["doc"],
        edit["truth"],
        f"{expert['successes']} of {expert['episodes']}",
        expert["same"],
        f"`{edit['verdict']}`" + ("" if edit["certain"] else " *"),
        f"{round(now['pass_rate'] * episodes)} of {episodes}",
        edit["same"],
        *(f"{now[figure]:.2f} ({before[figure]:.2f})" for figure in ("progress", "reward")),
    )


def _before(records: Mapping[str, Record]) -> str:
    """Return how often the expert meets the spec of each level before the edits."""
    return ", ".join(
        f"{record['successes']} of {len(record['ways'])} in {name.removeprefix(EXPERT)}"
        for name, record in records.items()
        if "ways" in record
    )


def _edits(records: Mapping[str, Record]) -> dict[str, Record]:
    return {name: record for name, record in records.items() if "verdict" in record}
