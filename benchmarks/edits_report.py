"""The part of RESULTS.md on random edits: goals, and a row for each edit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record

EXPERT: Final = "expert "
"""Before the name of a level: how the expert's episodes go there before the edits."""

ALARMS: Final = 1 / 20
"""Of the edits that change nothing, at most so many are found fault with."""

_INFEASIBLE: Final = ("infeasible", "in part")
_TRUTHS: Final = (*_INFEASIBLE, "changed", "unchanged")
_VERDICTS: Final = ("pass", "review", "fail")


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Rows of the table of goals, for what was played."""
    edits = _edits(records)
    infeasible = {name: edit for name, edit in edits.items() if edit["truth"] in _INFEASIBLE}
    if infeasible:
        passed = [name for name, edit in infeasible.items() if edit["verdict"] == "pass"]
        yield (
            "of random edits, no `pass` where some of what the spec asks cannot be done any more",
            f"{len(passed)} of {len(infeasible)}" + (f": {', '.join(passed)}" if passed else ""),
            met_or_missed(not passed),
        )
    unchanged = {name: edit for name, edit in edits.items() if edit["truth"] == "unchanged"}
    if unchanged:
        found = [name for name, edit in unchanged.items() if edit["verdict"] != "pass"]
        yield (
            "of random edits that change nothing, at most 1 in 20 with a `review` or `fail`",
            f"{len(found)} of {len(unchanged)}" + (f": {', '.join(found)}" if found else ""),
            met_or_missed(len(found) <= ALARMS * len(unchanged)),
        )


def section(records: Mapping[str, Record]) -> str:
    """The section on random edits."""
    edits = _edits(records)
    if not edits:
        return ""
    counts = Counter((edit["truth"], edit["verdict"]) for edit in edits.values())
    truths = [truth for truth in _TRUTHS if any(edit["truth"] == truth for edit in edits.values())]
    summed = [(truth, *(counts[truth, verdict] for verdict in _VERDICTS)) for truth in truths]
    header = ("edit", "what it says", "truth", "expert", "same", "verdict", "met", "same", "progress", "reward")
    failed = [f"{name} ({record['failed']})" for name, record in records.items() if "failed" in record]
    parts = [
        f"""
## Verdicts on random edits

`python -m benchmarks --only regression` makes {len(edits)} edits of the assets that the levels share, at random,
plays them with the policies that come with tltlc, and has them judged by `tltlc regress` as one suite. *Truth*:
`infeasible` where nobody can do what the spec asks, by an over-approximation of what can be reached, and `in part`
where that holds of some episodes, since chance decides which way opens; `unchanged` where all of the scripted
expert's episodes go as before the edit, step by step; else `changed`. *Expert*: in how many of its episodes, 25
unless it fails in five in a row, it meets the spec, and how many go as before (*same*), for {_before(records)}
before. *Met*: the policy's episodes that meet the spec, of those that were played until the verdict was certain; a
`*` marks one that is not. *Same*: how many of them went as before the edit. *Progress* and *reward* are means, those
of the baseline in brackets.

{table(("truth", *(f"`{verdict}`" for verdict in _VERDICTS)), summed)}

{_bounds(counts)}

{table(header, [_row(name, edit) for name, edit in edits.items()])}
""",
        f"Failed: {', '.join(failed)}." if failed else "",
    ]
    return "\n\n".join(part.strip() for part in parts if part)


def _bounds(counts: Mapping[tuple[str, str], int]) -> str:
    """What so few edits leave open: upper limits of 95 % for what was not seen once."""
    asked = (
        ("a `pass` of an infeasible one", _INFEASIBLE, ("pass",)),
        ("a finding on an unchanged one", ("unchanged",), ("review", "fail")),
    )
    said = []
    for what, truths, wrong in asked:
        tried = sum(counts[truth, verdict] for truth in truths for verdict in _VERDICTS)
        if tried and not any(counts[truth, verdict] for truth in truths for verdict in wrong):
            said.append(f"{what}, seen in 0 of {tried}, may have a probability of up to {1 - 0.05 ** (1 / tried):.0%}")
    return f"So few edits leave much open: {'; '.join(said)} (at 95 %)." if said else ""


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
    """How often the expert meets the spec of each level before the edits."""
    return ", ".join(
        f"{record['successes']} of {len(record['ways'])} in {name.removeprefix(EXPERT)}"
        for name, record in records.items()
        if "ways" in record
    )


def _edits(records: Mapping[str, Record]) -> dict[str, Record]:
    return {name: record for name, record in records.items() if "verdict" in record}
