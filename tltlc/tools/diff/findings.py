"""The findings of ``tltlc breaking`` as diagnostics, each with a help text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Union

from tltlc.automaton.compare import Trace
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, Label, Severity
from tltlc.resolve.spec import Atom, Param, Signal, ValueType
from tltlc.resolve.values import number_text
from tltlc.tools.diff.differences import Difference
from tltlc.tools.diff.pairs import SpecPair
from tltlc.tools.diff.phrases import ends_text, name_list, sample_text, type_text, value_text, values_text
from tltlc.tools.diff.traces import step_lines
from tltlc.tools.diff.values import ValueDifference

BREAKING: Final[Severity] = "error"
"""The severity of a change after which a host (a game) must change, or recordings are judged differently."""
CHANGED: Final[Severity] = "warning"
"""The severity of a change of numbers or behaviour after which everything still works."""
COMPATIBLE: Final[Severity] = "note"
"""The severity of a change that needs no action."""

_MOST_LINES: Final = 8
"""The most lines that a trace takes in a message."""
_ANEW: Final = "if you want this change, record the baselines again"
_VALUES_IN_RANGE: Final = "set it only to values in this range: other values are an error now"


def spec_removed(name: str, place: Label) -> Diagnostic:
    """Return TLT0752: a spec was removed."""
    help_ = "keep it, or tell the people who load its artefact or monitor"
    return Diagnostic("TLT0752", f"the spec `{name}` is gone", (at_old_place(place),), help_, BREAKING)


def spec_renamed(old: str, new: str, before: Label, place: Label) -> Diagnostic:
    """Return TLT0752: a spec has another name, but accepts the same traces.

    ``before`` is its old place, and ``place`` its new one.
    """
    title = f"the spec `{old}` is now called `{new}`"
    help_ = "keep the old name, or tell the people who load its artefact or monitor by that name"
    return Diagnostic("TLT0752", title, (place, at_old_place(before)), help_, BREAKING)


def spec_moved(name: str, before: Label, place: Label) -> Diagnostic:
    """Return TLT0752: a spec moved to another file.

    ``before`` is its old place, and ``place`` its new one.
    """
    title = f"the spec `{name}` has moved here from `{before.source.name}`"
    help_ = "name this file instead of the old one; artefacts and monitors keep their names"
    return Diagnostic("TLT0752", title, (place,), help_, COMPATIBLE)


def spec_added(name: str, place: Label) -> Diagnostic:
    """Return TLT0752: a spec is new."""
    return Diagnostic("TLT0752", f"the spec `{name}` is new", (place,), "nothing needs to be done", COMPATIBLE)


def traces_changed(pair: SpecPair, place: Label) -> Diagnostic:
    """Return TLT0753: a spec accepts different traces than before, or this was not decided."""
    name, comparison = pair.b.name, pair.comparison
    if comparison.relation == "undecided" and comparison.only_a is None:
        title = f"it was not decided whether `{name}` still accepts the traces that it accepted before"
        help_ = "its atoms remember the trace so far: judge recorded traces by both versions"
        return Diagnostic("TLT0753", title, (place,), help_, CHANGED)
    if comparison.only_a is None:
        assert comparison.only_b is not None
        title = f"`{name}` is looser: it accepts traces that it did not accept before"
        help_ = f"if you do not want this change, make it reject:{_trace(pair, comparison.only_b)}"
        return Diagnostic("TLT0753", title, (place,), help_, CHANGED)
    title = f"`{name}` is stricter: it no longer accepts some traces that it accepted before"
    if comparison.relation == "incomparable":
        title = f"`{name}` accepts different traces: it no longer accepts some, and now accepts others"
    if pair.b.states[0].verdict == "violated":
        title = f"`{name}` is stricter: no trace satisfies it any more"
    help_ = f"if you do not want this change, make it accept:{_trace(pair, comparison.only_a)}"
    return Diagnostic("TLT0753", title, (place,), help_, BREAKING)


def signal_changed(difference: Difference, specs: Sequence[str], place: Label) -> Diagnostic:
    """Return TLT0754 or TLT0755: a signal is new, gone or renamed, or has another type or range.

    ``specs`` are the names of the specs that read it.
    """
    name, used_by = difference.name, name_list(specs)
    if difference.a is None:
        assert isinstance(difference.b, Signal)
        title = f"the signal `{name}` must now be supplied to {used_by}"
        help_ = f"have the game supply it: {type_text(difference.b)}"
        return Diagnostic("TLT0754", title, (place,), help_, BREAKING)
    if difference.b is None:
        title = f"the signal `{name}` is no longer read by {used_by}"
        return Diagnostic("TLT0754", title, (place,), "the game may stop supplying it", COMPATIBLE)
    assert isinstance(difference.a, Signal) and isinstance(difference.b, Signal)
    if difference.b.name != name:
        title = f"the signal `{difference.b.name}` must now be supplied to {used_by} in place of `{name}`"
        return Diagnostic("TLT0754", title, (place,), f"have the game supply it: {type_text(difference.b)}", BREAKING)
    return signal_type_changed(difference.a, difference.b, place)


def signal_type_changed(old: Signal, new: Signal, place: Label) -> Diagnostic:
    """Return TLT0755: a signal has another type, unit or range, or other values of an enum."""
    name = new.name
    if old.type != new.type:
        title = f"the signal `{name}` is now {_with_article(new.type)} (it was {_with_article(old.type)})"
        return Diagnostic("TLT0755", title, (place,), f"have the game supply it as {type_text(new)}", BREAKING)
    if old.values != new.values:
        title = f"the signal `{name}` is now {type_text(new)} (it was {type_text(old)})"
        if old.values and new.values[: len(old.values)] == old.values:
            return Diagnostic(
                "TLT0755", title, (place,), "nothing needs to be done: each value keeps its number", COMPATIBLE
            )
        help_ = "check what the game supplies: a value may have another number, or be gone"
        return Diagnostic("TLT0755", title, (place,), help_, BREAKING)
    title = f"the range of the signal `{name}` is now {ends_text(new)} (it was {ends_text(old)})"
    if _is_within(old, new):
        help_ = "nothing needs to be done in hosts; atoms that the range scales have messages of their own"
        return Diagnostic("TLT0755", title, (place,), help_, COMPATIBLE)
    help_ = "check what the game supplies: a value outside this range counts as the nearest end"
    return Diagnostic("TLT0755", title, (place,), help_, BREAKING)


def param_changed(difference: Difference, new_name: str | None, place: Label) -> Diagnostic:
    """Return TLT0756: a param was removed, added or renamed, or has another type, value or range.

    ``new_name`` is the new name of a renamed param, and else None.
    """
    name, old, new = difference.name, difference.a, difference.b
    if not isinstance(old, Param):
        assert isinstance(new, Param)
        title = f"the param `{name}` is new, with the value {value_text(new.value, new.type)}"
        return Diagnostic("TLT0756", title, (place,), "nothing needs to be done", COMPATIBLE)
    if new_name is not None:
        title = f"the param `{name}` is now called `{new_name}`"
        return Diagnostic("TLT0756", title, (place,), f"set `{new_name}` wherever `{name}` is set", BREAKING)
    if not isinstance(new, Param):
        title = f"the param `{name}` is gone"
        return Diagnostic("TLT0756", title, (place,), "do not set it any more: setting it is an error", BREAKING)
    if old.type != new.type:
        title = f"the param `{name}` is now {_with_article(new.type)} (it was {_with_article(old.type)})"
        return Diagnostic("TLT0756", title, (place,), f"set it as {type_text(new)}", BREAKING)
    if old.value != new.value:
        now, before = value_text(new.value, new.type), value_text(old.value, old.type)
        title = f"the param `{name}` is now {now} (it was {before})"
        if not _is_within(old, new):
            title += f", and its range is now {ends_text(new)} (it was {ends_text(old)})"
        help_ = f"if you need the old value, set it: `{name}={before}`"
        if not _is_in_range(old.value, new):
            help_ = _VALUES_IN_RANGE
        return Diagnostic("TLT0756", title, (place,), help_, CHANGED if _is_within(old, new) else BREAKING)
    title = f"the range of the param `{name}` is now {ends_text(new)} (it was {ends_text(old)})"
    if _is_within(old, new):
        return Diagnostic("TLT0756", title, (place,), "nothing needs to be done", COMPATIBLE)
    return Diagnostic("TLT0756", title, (place,), _VALUES_IN_RANGE, BREAKING)


def atom_changed(difference: Difference, others: Sequence[str], pair: SpecPair, place: Label) -> Diagnostic:
    """Return TLT0757: an atom now has other values than before.

    ``others`` are the names of further atoms of the same predicate that have other values, too.
    """
    assert difference.value_difference is not None
    types: dict[str, ValueType] = {signal_.name: signal_.type for signal_ in (*pair.a.signals, *pair.b.signals)}
    return values_changed(f"`{difference.name}`", others, difference.value_difference, types, place)


def atoms_renamed(renamings: Sequence[Difference], place: Label) -> Diagnostic:
    """Return TLT0757: atoms of a predicate have other names, but the same meaning."""
    names = [renaming.b.name for renaming in renamings if isinstance(renaming.b, Atom)]
    are = "is" if len(names) == 1 else "are"
    title = f"{name_list([renaming.name for renaming in renamings])} {are} now called {name_list(names)}"
    help_ = "nothing needs to be done, unless the game looks for the old name in what a monitor reports"
    return Diagnostic("TLT0757", title, (place,), help_, COMPATIBLE)


def values_changed(
    subject: str,
    others: Sequence[str],
    difference: ValueDifference,
    types: dict[str, ValueType],
    place: Label,
    kind: str = "atom",
) -> Diagnostic:
    """Return TLT0757: an atom or predicate now has other values than before; the help shows a sample.

    ``subject`` is the name of the atom or predicate in the title. ``others`` are the names of further
    atoms that changed in the same way. ``types`` has the types of the signals in the sample.
    """
    title = f"the {kind} {subject} is {'judged' if difference.differs_in_truth else 'scaled'} differently"
    if others:
        title += f", and so {'is' if len(others) == 1 else 'are'} {name_list(others)}"
    before, now = values_text(difference)
    was = "had" if difference.values[0] is None else "was"
    is_now = "now has" if difference.values[1] is None else "is now"
    help_ = f"{sample_text(difference.sample, types)}, it {is_now} {now} and {was} {before}"
    if difference.differs_in_truth:
        help_ += f"; {_ANEW}"
    else:
        help_ += ": progress and rewards differ, but verdicts do not"
    return Diagnostic("TLT0757", title, (place,), help_, BREAKING if difference.differs_in_truth else CHANGED)


def clock_changed(difference: Difference, specs: Sequence[str], place: Label) -> Diagnostic:
    """Return TLT0758: the specs with the names ``specs`` have another clock."""
    are, were = ("is", "it was") if len(specs) == 1 else ("are", "they were")
    title = f"{name_list(specs)} {are} now sampled {_clock(difference.b)} ({were} sampled {_clock(difference.a)})"
    return Diagnostic("TLT0758", title, (place,), _clock_help(difference.b), BREAKING)


def library_clock_changed(old: float | str | None, new: float | str | None, place: Label) -> Diagnostic:
    """Return TLT0758: the clock that a library declares has changed.

    ``old`` and ``new`` are its period in seconds or ``varies``; None without a clock.
    """
    title = f"specs are now sampled {_clock(new)} (they were sampled {_clock(old)})"
    return Diagnostic("TLT0758", title, (place,), _clock_help(new), BREAKING)


def exclusive_added(names: Sequence[str], place: Label) -> Diagnostic:
    """Return TLT0758: a library now declares atoms to be exclusive."""
    help_ = "check the game: a sample in which two of them hold is an error for specs that name both"
    return Diagnostic("TLT0758", f"{name_list(names)} are now exclusive", (place,), help_, BREAKING)


def exclusive_removed(names: Sequence[str], place: Label) -> Diagnostic:
    """Return TLT0758: a library no longer declares atoms to be exclusive."""
    title = f"{name_list(names)} are no longer exclusive"
    return Diagnostic(
        "TLT0758", title, (at_old_place(place),), "steps may be skipped, so progress and rewards may differ", CHANGED
    )


def setting_changed(name: str, difference: Difference, place: Label) -> Diagnostic:
    """Return TLT0758: the spec ``name`` has another limit, judge, level, semantics or ``exclusive`` group."""
    old, new = difference.a, difference.b
    severity, help_ = BREAKING, _ANEW
    match difference.kind:
        case "semantics":
            title = f"`{name}` is now about {_traces(new)} (it was about {_traces(old)})"
        case "judge":
            title = f"`{name}` is now judged at the {new} (it was judged at the {old})"
            help_ = f"if you do not want this change, write `judge at {old}`"
        case "limit":
            title = f"`{name}` now has {_limit(new)} (it had {_limit(old)})"
        case "level":
            title = f"`{name}` is now about {_level(new)} (it was about {_level(old)})"
            severity, help_ = CHANGED, "check whether a program that loads it uses this to choose the level"
        case _:
            names = new if isinstance(new, tuple) else old if isinstance(old, tuple) else ()
            if old is None:
                title = f"{name_list(names)} are now exclusive in `{name}`"
                help_ = "check the game: a sample in which two of them hold is an error now"
            else:
                title = f"{name_list(names)} are no longer exclusive in `{name}`"
                severity, help_ = CHANGED, "steps may be skipped, so progress and rewards may differ"
    return Diagnostic("TLT0758", title, (place,), help_, severity)


def declaration_removed(kind: str, name: str, place: Label) -> Diagnostic:
    """Return TLT0759: a library no longer declares a name."""
    help_ = "keep it, at least as another name for its replacement"
    return Diagnostic("TLT0759", f"the {kind} `{name}` is gone", (at_old_place(place),), help_, BREAKING)


def parameters_changed(kind: str, name: str, place: Label, why: str) -> Diagnostic:
    """Return TLT0759: uses of a declaration in a library are no longer valid.

    ``why`` is the reason in words, such as "the argument close must now be given, too".
    """
    help_ = "add new parameters after the others, with a default, and leave the others as they are"
    if kind == "signal":
        help_ = "leave its parameters as they are, and declare another signal for the new ones"
    return Diagnostic("TLT0759", f"the {kind} `{name}` takes other parameters: {why}", (place,), help_, BREAKING)


def signals_added(predicate: str, signals: Sequence[str], place: Label) -> Diagnostic:
    """Return TLT0754: a predicate of a library reads additional signals."""
    title = f"the predicate `{predicate}` now reads {name_list(signals)}"
    help_ = f"have the game supply {'it' if len(signals) == 1 else 'them'} wherever the predicate is used"
    return Diagnostic("TLT0754", title, (place,), help_, BREAKING)


def at_old_place(place: Label) -> Label:
    """Return the label with the message ``it was here``, for something that was removed."""
    return replace(place, message="it was here")


def _trace(pair: SpecPair, trace: Trace) -> str:
    """Return a trace as text that can follow a colon.

    A trace of one line stays on the line of the colon. A longer trace has lines of its own, of which
    there are at most ``_MOST_LINES``.
    """
    lines = step_lines(pair, trace.prefix)
    if trace.cycle:
        lines.append(f"{'then ' if lines else ''}again and again:")
        lines += [f"  {line}" for line in step_lines(pair, trace.cycle)]
    if len(lines) == 1:
        return f" {lines[0]}"
    if len(lines) > _MOST_LINES:
        steps = len(trace.prefix) + len(trace.cycle)
        lines = [*lines[: _MOST_LINES - 1], f"… ({steps} steps; `tltlc diff` shows them all)"]
    return "\n".join(["", *lines])


def _is_within(old: Union[Signal, Param], new: Union[Signal, Param]) -> bool:
    """Whether the new range contains the old one."""
    low = new.low is None or (old.low is not None and new.low <= old.low)
    return low and (new.high is None or (old.high is not None and old.high <= new.high))


def _is_in_range(value: float, new: Param) -> bool:
    return (new.low is None or new.low <= value) and (new.high is None or value <= new.high)


def _with_article(type_: str) -> str:
    return f"{'an' if type_[0] in 'ai' else 'a'} {type_}"


def _traces(semantics: object) -> str:
    return f"{semantics} traces"


def _limit(limit: object) -> str:
    return "no limit" if limit is None else f"a limit of {limit} step{'' if limit == 1 else 's'}"


def _level(level: object) -> str:
    return f"the level `{level}`" if level else "no level in particular"


def _clock_help(period: object) -> str:
    if period is None:
        return "declare the old clock if the game takes its steps at that interval"
    if period == "varies":
        return "have the game pass the time since the step before, as `dt`, at each step"
    return "have the game take its steps at this interval"


def _clock(period: object) -> str:
    if period == "varies":
        return "at times that vary"
    return f"every {number_text(period)} s" if isinstance(period, float) else "without a clock"
