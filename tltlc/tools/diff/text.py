"""Write the differences between two files in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Final

from tltlc.automaton.compare import Trace
from tltlc.automaton.memory_phrases import spoken
from tltlc.automaton.text import label_text
from tltlc.io.spec_file import STDIN, STDIN_NAME
from tltlc.logic.formula import atom as atom_of
from tltlc.logic.formula import not_
from tltlc.logic.text.phrases import phrase
from tltlc.resolve.registers import following_atoms
from tltlc.resolve.spec import Param, Signal
from tltlc.resolve.values import number_text
from tltlc.tools.diff.differences import Difference
from tltlc.tools.diff.phrases import (
    method_sentence,
    name_list,
    sample_text,
    type_text,
    unrelated_reason,
    value_text,
    values_text,
)
from tltlc.tools.diff.relation import OF_A, OF_B
from tltlc.tools.diff.traces import difference_test, step_lines, trace_description

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa, State
    from tltlc.tools.diff.pairs import FileDiff, SpecPair
    from tltlc.tools.diff.relation import ExclusiveGroup, Relation

_RELATIONS: Final = {
    "equivalent": ("B accepts the same traces as A", ""),
    "stricter": ("B is stricter than A", "A also accepts every trace that B accepts"),
    "looser": ("B is looser than A", "B also accepts every trace that A accepts"),
    "incomparable": ("B accepts different traces than A", "each accepts some that the other does not"),
    "undecided": ("it was not decided whether B accepts the same traces as A", ""),
}
_BREAKING: Final[Mapping[Relation | None, str]] = {
    "equivalent": "The same beginnings of traces break both for good, if any do.",
    "stricter": "Every beginning of a trace that breaks A for good also breaks B, and some others break only B.",
    "looser": "Every beginning of a trace that breaks B for good also breaks A, and some others break only A.",
    "incomparable": "Each is broken for good by beginnings of traces that do not break the other.",
    "undecided": "It was not decided whether the same beginnings of traces break both for good.",
}
"""What to print about the beginnings of traces that violate A or B.

The key is ``Comparison.beginnings.relation``, which compares the beginnings that do not violate them.
"""

_WIDTH: Final = 100
_MOST_LEFT_OUT: Final = 5
_MOST_ATOMS: Final = 10
_MOST_REMAINS: Final = 500
"""The most characters of what remains: the rules of a large spec would hide what the trace shows."""
_TITLES: Final = {"A": "no longer accepted", "B": "not accepted before"}
"""Titles of printed tests, by the spec that accepts the trace."""
_TITLES_OF_BEGINNINGS: Final = {"A": "broken now", "B": "broken before"}
"""Titles of printed tests that show the beginning of a trace, by the spec that it does not violate."""


def text(report: FileDiff) -> str:
    """Return the differences between two files in words, with a newline at the end."""
    paragraphs = [f"A is {report.a}\nB is {report.b}"]
    paragraphs += ["\n\n".join(_pair(pair)) for pair in report.pairs]
    for side, names in (("A", report.only_a), ("B", report.only_b)):
        if names:
            paragraphs.append(f"only in {side}: {name_list(names, len(names))}")
    if report.only_a and report.only_b:
        a, b = (STDIN if name == STDIN_NAME else name for name in (report.a, report.b))
        both = f"`{a}:{report.only_a[0]}` and `{b}:{report.only_b[0]}`"
        paragraphs.append(f"to compare specs of different names, name both, e.g. {both}")
    if len(paragraphs) == 1:
        paragraphs.append("neither of them contains a spec")
    return "\n\n".join(paragraphs) + "\n"


def _pair(pair: SpecPair) -> Iterator[str]:
    """Yield the paragraphs about a pair of specs."""
    comparison = pair.comparison
    name = pair.a.name if pair.a.name == pair.b.name else f"{pair.a.name} and {pair.b.name}"
    if comparison.relation is None:
        assert comparison.beginnings is not None
        yield f"{name}\n  {fill(unrelated_reason(pair.a, pair.b), _WIDTH, subsequent_indent='  ')}"
        yield f"  {_BREAKING[comparison.beginnings.relation]}"
    else:
        summary, meaning = _RELATIONS[comparison.relation]
        if comparison.relation == "undecided" and (comparison.only_a or comparison.only_b):
            side, other = ("A", "B") if comparison.only_a else ("B", "A")
            summary, meaning = f"{side} accepts a trace that {other} does not", "the opposite was not decided"
        if comparison.relation == "equivalent":
            summary += _rest(pair)
        yield f"{name}\n  {summary}{f': {meaning}' if meaning else ''}."
    if method := method_sentence(comparison):
        yield f"  {fill(method, _WIDTH, subsequent_indent='  ')}"
    one_sided = [group for group in comparison.exclusive if not (group.in_a and group.in_b)]
    if one_sided:
        yield _exclusive(one_sided)
    if comparison.split_names:
        yield _split(comparison.split_names)
    if comparison.impossible:
        yield _left_out(pair)
    trace_comparison = comparison.beginnings or comparison
    if trace_comparison.only_a is not None:
        yield from _trace(pair, trace_comparison.only_a, "A", "B")
    if trace_comparison.only_b is not None:
        yield from _trace(pair, trace_comparison.only_b, "B", "A")
    if pair.differences:
        lines = ["  what else differs:"] if comparison.relation != "equivalent" else ["  what differs:"]
        yield "\n".join([*lines, *(f"    {sentence(difference, pair)}" for difference in pair.differences)])


def _rest(pair: SpecPair) -> str:
    """Return what follows "B accepts the same traces as A"; it agrees with :attr:`SpecPair.is_same`."""
    if pair.differences:
        return ", but something else differs"
    if pair.comparison.impossible:
        return ", except perhaps for the traces that are left out"
    return ", and nothing else differs"


def _exclusive(groups: Sequence[ExclusiveGroup]) -> str:
    lines = ["  judged on traces in which at most one of these holds at a time:"]
    lines += [
        f"    {name_list(group.names, _MOST_ATOMS)} (exclusive only in {'A' if group.in_a else 'B'})"
        for group in groups
    ]
    return "\n".join(lines)


def _split(names: tuple[str, ...]) -> str:
    first = names[0]
    are, atoms, they_are = ("is", "atom", "it is") if len(names) == 1 else ("are", "atoms", "they are")
    called = f"`{first} of A` and `{first} of B`" if len(names) == 1 else f"`{first} of A`, `{first} of B` and so on"
    return (
        f"  {name_list(names)} {are} not the same {atoms} in B as in A, so {they_are} called {called}\n"
        "  (--by-name treats atoms with the same name as one atom)"
    )


def _left_out(pair: SpecPair) -> str:
    impossible = pair.comparison.impossible
    lines = ["  no values of the signals were found that give these, so traces with them are left out:"]
    lines += [
        f"    {' and '.join(_literal(pair, name, holds) for name, holds in literals)}"
        for literals in impossible[:_MOST_LEFT_OUT]
    ]
    if len(impossible) > _MOST_LEFT_OUT:
        lines.append(f"    and {len(impossible) - _MOST_LEFT_OUT} more")
    return "\n".join(lines)


def _literal(pair: SpecPair, name: str, holds: bool) -> str:
    """Return a literal of an atom over both specs: its name, or words for a timer."""
    for fspa, suffix in ((pair.a, OF_A), (pair.b, OF_B)):
        own = {
            f"{atom}{suffix if atom in pair.comparison.split_names else ''}": atom
            for atom in following_atoms(fspa.atoms, fspa.registers)
        }
        if name in own:
            literal = atom_of(own[name])
            return phrase(spoken(literal if holds else not_(literal), fspa))
    return f"{'' if holds else 'not '}`{name}`"


def _trace(pair: SpecPair, trace: Trace, by: str, other: str) -> Iterator[str]:
    """Yield a trace in words and, if a test can show the difference, as a ``test`` block.

    ``by`` is the spec that accepts the trace, and ``other`` the spec that does not.
    """
    description = trace_description(pair, trace)
    is_whole = pair.comparison.relation is not None
    heading = (
        f"a trace that {by} accepts and {other} does not"
        if is_whole
        else f"a beginning that breaks {other} and not {by}"
    )
    lines = [f"  {heading} (atoms that are not named do not hold):"]
    lines += [f"    {line}" for line in step_lines(pair, trace.prefix)]
    if trace.cycle:
        lines.append(f"    {'then ' if trace.prefix else ''}again and again:")
        lines += [f"      {line}" for line in step_lines(pair, trace.cycle)]
    states = {"A": (pair.a, description.a), "B": (pair.b, description.b)}
    after = "after one round" if trace.cycle else "after these" if len(trace.prefix) > 1 else "after it"
    lines += [f"    {after}, {side} is {_state(*states[side])}" for side in (by, other)]
    yield "\n".join(lines)
    test = difference_test(pair, description, (_TITLES if is_whole else _TITLES_OF_BEGINNINGS)[by])
    if test is not None:
        side, lines_of_test = test
        yield f"  as a test of {side}:\n\n{_indent(lines_of_test)}"


def _state(fspa: Fspa, state: State) -> str:
    if state.verdict in ("satisfied", "violated"):
        return state.verdict
    remains = label_text(fspa, state.id)
    return f"{state.verdict}; what remains: {remains}" if len(remains) <= _MOST_REMAINS else state.verdict


def _indent(text: str) -> str:
    return "\n".join(f"    {line}" if line else "" for line in text.rstrip("\n").splitlines())


def sentence(difference: Difference, pair: SpecPair) -> str:
    """Describe one difference in words, without a full stop: ``limit: 400 steps in A, none in B``."""
    a, b, name = difference.a, difference.b, difference.name
    match difference.kind:
        case "semantics":
            return f"semantics: {a} in A, {b} in B"
        case "judge":
            return f"judged at the {a} in A, at the {b} in B"
        case "limit":
            return f"limit: {_steps(a)} in A, {_steps(b)} in B"
        case "level":
            return f"level: {a or 'none'} in A, {b or 'none'} in B"
        case "clock":
            return f"clock: {_clock(a)} in A, {_clock(b)} in B"
        case "exclusive":
            return f"exclusive {', '.join(_names(a) or _names(b))}: only in {'A' if a else 'B'}"
        case "atom":
            return f"`{name}`: {_atom(difference, pair)}"
        case _:
            return f"{difference.kind} `{name}`: {_declared_value(a)} in A, {_declared_value(b)} in B"


def _atom(difference: Difference, pair: SpecPair) -> str:
    if difference.value_difference is None:
        return "B has another expression; no sample was found at which its value differs"
    types = {signal.name: signal.type for signal in (*pair.a.signals, *pair.b.signals)}
    first, second = values_text(difference.value_difference)
    return f"{first} in A, {second} in B, {sample_text(difference.value_difference.sample, types)}"


def _declared_value(value: object) -> str:
    if isinstance(value, Param):
        return f"{type_text(value)} = {value_text(value.value, value.type)}"
    return type_text(value) if isinstance(value, Signal) else "none"


def _names(value: object) -> tuple[str, ...]:
    return value if isinstance(value, tuple) else ()


def _steps(limit: object) -> str:
    return "none" if limit is None else f"{limit} step{'' if limit == 1 else 's'}"


def _clock(period: object) -> str:
    return f"{number_text(period)} s" if isinstance(period, float) else str(period or "none")
