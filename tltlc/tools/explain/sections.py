"""Arrange an explanation in sections of paragraphs, lists and tables.

The text and Markdown outputs are written from these sections.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.backends.drawing.folding import distance_range
from tltlc.core.names import ComparisonName, split_name
from tltlc.core.record import record
from tltlc.tools.explain.ending import limit_text
from tltlc.tools.explain.explanation import ANYTHING, CountingRun, ExampleTrace, Explanation, TraceStep, TrapCondition

_MOST_RANGES = 3
_MOST_ROWS = 40
_MOST_ROWS_OF_MEMORY = 12
"""With timers and other memory, a table with more rows is left out: their guards are long."""
_MOST_LETTERS = 600
"""A table with a longer cell is left out."""
_MOST_LEADS = 4
_MOST_FAILURES = 12
_MOST_STATES = 3
_MOST_STEPS = 60
_MOST_GOALS = 3
"""The most goals of a chain in a sentence."""

_NOT_FOUND = "The search found none within its limit. There may still be one."


@record
class SectionList:
    """A list of items, numbered from 1 if ``numbered``. The title may be empty."""

    title: str
    items: tuple[str, ...]
    numbered: bool = False


@record
class SectionTable:
    """Rows of cells under a header."""

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@record
class Section:
    """A heading, and the paragraphs (strings), lists and tables under it, called ``blocks``."""

    heading: str
    blocks: tuple[str | SectionList | SectionTable, ...]


def sections(explanation: Explanation) -> tuple[Section, ...]:
    """Return the sections of an explanation. The heading of the first one is the spec's name."""
    # Over infinite traces and with memory, the search finds short traces, but not always the shortest.
    article = "A way" if explanation.semantics == "infinite" or explanation.memory else "The shortest way"
    return (
        Section(explanation.name, tuple(filter(None, (explanation.doc, _sentence(explanation))))),
        *_requirements(explanation),
        *([Section("At the edges", (SectionList("", explanation.boundaries),))] if explanation.boundaries else ()),
        *_memory(explanation),
        Section("What breaks it", _failures(explanation)),
        Section("When it ends", (explanation.ending, *_limit(explanation))),
        Section("States", _states(explanation)),
        Section(f"{article} to succeed", _trace_blocks(explanation.succeed, _no_success(explanation))),
        Section(f"{article} to fail", _trace_blocks(explanation.fail, _no_failure(explanation))),
    )


def _limit(explanation: Explanation) -> tuple[str, ...]:
    text = limit_text(explanation.limit_steps, explanation.limit_s)
    if explanation.limit_steps is None:
        return (text,)
    return text, "`tltlc monitor` judges a longer recording whole; with `--episodes`, up to the limit."


def _sentence(explanation: Explanation) -> str:
    """Return the formula as a sentence; empty if it has a long chain of goals, which a list says better."""
    rows = explanation.outline.goals if explanation.outline is not None else ()
    return "" if any(len(goals) > _MOST_GOALS for goals in rows) else explanation.english


def _requirements(explanation: Explanation) -> tuple[Section, ...]:
    outline = explanation.outline
    if outline is None:
        return ()
    rows = [[f"{'now or later, ' if goal.together else ''}{goal.text}" for goal in goals] for goals in outline.goals]
    lists = [SectionList("Reach, in this order:", tuple(row), numbered=True) for row in rows if len(row) > 1]
    single = tuple(row[0] for row in rows if len(row) == 1)
    if single:
        lists.append(SectionList("Reach, in any order:" if len(single) > 1 else "Reach:", single))
    for title, items in (
        ("Throughout:", outline.throughout),
        ("Again and again, for ever:", outline.recurring),
        ("And:" if lists or outline.throughout or outline.recurring else "Do this:", outline.others),
        ("At most one of these holds at a time:", tuple(", ".join(group) for group in _declared(explanation))),
    ):
        if items:
            lists.append(SectionList(title, items))
    return (Section("What it asks for", tuple(lists)),) if lists else ()


def _declared(explanation: Explanation) -> tuple[tuple[str, ...], ...]:
    """Return the groups of exclusive atoms without the values of one enum, of which everyone knows it."""
    return tuple(group for group in explanation.exclusive if len(set(map(_tested_enum, group))) > 1)


def _tested_enum(atom: str) -> str:
    """Return the enum that an atom tests, such as ``mode`` for ``mode is alert``, and for other atoms the atom."""
    name = split_name(atom)[0]
    return name.left if isinstance(name, ComparisonName) and name.operator == "is" else atom


def _memory(explanation: Explanation) -> tuple[Section, ...]:
    texts = (f"{value.words} ({value.start})" if value.start else value.words for value in explanation.memory)
    items = tuple(dict.fromkeys(texts))
    return (Section("What it remembers", (SectionList("", items),)),) if items else ()


def _failures(explanation: Explanation) -> tuple[str | SectionList, ...]:
    if not explanation.failures:
        is_broken = explanation.states[0].verdict == "violated"
        return ("It cannot be met at all." if is_broken else "Nothing breaks it for good.",)
    return (SectionList("", failure_texts(explanation)),)


def failure_texts(explanation: Explanation) -> tuple[str, ...]:
    """Describe each condition that breaks the spec for good: ``seen, in states 1, 2``, or ``seen, in 9 of 12 states``.

    If there are more than ``_MOST_FAILURES`` conditions, the last text says how many are left out.
    """
    ends_well = any(state.verdict == "satisfied" for state in explanation.states)
    step = "at any step before it is met for good" if ends_well else "at any step"
    states = len(explanation.states)
    texts = [_failure_text(failure, step, states) for failure in explanation.failures[:_MOST_FAILURES]]
    rest = len(explanation.failures) - len(texts)
    return (*texts, *([f"and {rest} more"] if rest else ()))


def _failure_text(failure: TrapCondition, everywhere: str, states: int) -> str:
    if failure.everywhere:
        return f"{failure.when}, {everywhere}"
    if len(failure.states) > _MOST_STATES:
        return f"{failure.when}, in {len(failure.states)} of {states} states"
    return f"{failure.when}, in state{'s' * (len(failure.states) > 1)} {', '.join(map(str, failure.states))}"


def _states(explanation: Explanation) -> tuple[str | SectionTable, ...]:
    """Return a table with a row for each state, and a sentence on the rows that are left out.

    States that differ only in a count share a row. There are at most ``_MOST_ROWS`` rows. A sentence replaces
    the table if it is long.
    """
    runs = {run.states[0]: run for run in explanation.counting}
    continued = {state for run in explanation.counting for state in run.states[1:]}
    shared_rows = [
        runs.get(state.id, CountingRun((state.id,), state.remains))
        for state in explanation.states
        if state.id not in continued
    ]
    rows = tuple(_row(explanation, run) for run in shared_rows[:_MOST_ROWS])
    is_long = bool(explanation.memory) and len(shared_rows) > _MOST_ROWS_OF_MEMORY
    if is_long or any(len(row[-1]) > _MOST_LETTERS for row in rows):
        count = len(explanation.states)
        return (f"The table of the {count} states is left out, because it is long; `--format json` shows them.",)
    table = SectionTable(("State", "Verdict", "To go", "What remains", "What leads on"), rows)
    rest = sum(len(run.states) for run in shared_rows[_MOST_ROWS:])
    return (table, f"And {rest} more state{'s' * (rest > 1)}; `--format json` shows all of them.") if rest else (table,)


def _row(explanation: Explanation, run: CountingRun) -> tuple[str, ...]:
    first, last = explanation.states[run.states[0]], explanation.states[run.states[-1]]
    successor = run.states[1] if len(run.states) > 1 else None
    leads = [
        f"{lead.when} (to {'the next' if lead.state == successor else lead.state})"
        for lead in first.leads[:_MOST_LEADS]
    ]
    rest = len(first.leads) - len(leads)
    return (
        _numbers(run.states),
        first.verdict,
        distance_range(first.distance, last.distance, none="-"),
        run.remains,
        "; ".join([*leads, *([f"{rest} more"] * bool(rest))]),
    )


def _numbers(states: Sequence[int]) -> str:
    """Return the numbers of states as ranges: ``2, 4–101``.

    If there are more than ``_MOST_RANGES`` ranges, leave out those before the last: ``2, 4–101, …, 200``.
    """
    ranges: list[list[int]] = []
    for state in sorted(states):
        if ranges and state == ranges[-1][-1] + 1:
            ranges[-1][1:] = [state]
        else:
            ranges.append([state])
    texts = ["–".join(map(str, range_)) for range_ in ranges]
    return ", ".join(texts if len(texts) <= _MOST_RANGES else [*texts[: _MOST_RANGES - 1], "…", texts[-1]])


def _step_text(step: TraceStep) -> str:
    times = f", for {step.times} steps" if step.times > 1 else ""
    if step.seconds:
        times += f" in {step.seconds:g} s" if times else f", {step.seconds:g} s later"
    return f"{step.what}{times} (to state {step.state})"


def _trace_blocks(trace: ExampleTrace | None, otherwise: str) -> tuple[str | SectionList, ...]:
    if trace is None:
        return (otherwise,)
    cycle = () if trace.cycle is None else trace.steps[trace.cycle :]
    is_decided = bool(trace.cycle) and all(step.what == ANYTHING for step in cycle)
    steps = trace.steps[: trace.cycle] if is_decided else trace.steps
    items = [_step_text(step) for step in steps[:_MOST_STEPS]]
    blocks: list[str | SectionList] = [SectionList("", tuple(items), numbered=True)]
    if len(items) < len(steps):
        blocks.append(f"And {len(steps) - len(items)} more; `--format json` shows all of them.")
    elif is_decided:
        blocks.append("After that, whatever comes makes no difference.")
    elif cycle:
        first, last = len(steps) - len(cycle) + 1, len(steps)
        blocks.append(
            f"Then {f'{first} to {last} come' if first < last else f'{last} comes'} again and again, for ever."
        )
    return tuple(blocks)


def _no_success(explanation: Explanation) -> str:
    return "There is none." if explanation.states[0].verdict == "violated" else _NOT_FOUND


def _no_failure(explanation: Explanation) -> str:
    if explanation.failures:
        return _NOT_FOUND
    if explanation.states[0].verdict == "satisfied":
        return "There is none: every trace meets it."
    return "There is none: it fails only if it is not met when the episode is over."
