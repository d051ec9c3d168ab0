"""A help for English about times, counts and values compiles, and accepts the traces that the sentence means.

The meanings are written by hand, over all short traces and without the compiler. A second has one step.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from itertools import product

import pytest

from tests.grammar.suggestions import (
    NAMES,
    VARIES,
    Meaning,
    Trace,
    a,
    b,
    begins_twice_in_time,
    check,
    error_of,
    starts,
    suggestions,
)
from tltlc import compile_text
from tltlc.monitor import Monitor


def is_answered(trace: Trace) -> bool:
    """Whether a holds at each b, or at one of the two steps after it."""
    return all(any(a(trace)[i : i + 3]) for i, event in enumerate(b(trace)) if event)


def is_absent(trace: Trace) -> bool:
    """Whether a holds neither at a b, nor at one of the two steps after it."""
    return not any(any(a(trace)[i : i + 3]) for i, event in enumerate(b(trace)) if event)


def counted(compare: Callable[[int], bool]) -> Meaning:
    """Return the meaning that the number of times at which a has begun is right at the end."""
    return lambda trace: compare(len(starts(trace)))


MEANINGS: Mapping[str, Meaning] = {
    "keep after b, a within 2 s": is_answered,
    "require after b, a within 2 seconds": is_answered,
    "after b, a within 2 s": is_answered,
    "keep a within 2 s after b": is_answered,
    "keep a within 2 steps of b": is_answered,
    "keep within 2 s after b, a": is_answered,
    "keep within 2 seconds of b, a": is_answered,
    "keep when b, a within 2 s": is_answered,
    "keep if b then a within 2 s": is_answered,
    "keep b implies a within 2 seconds": is_answered,
    "reach a within 2 s after b": lambda t: any(
        i < j <= i + 2 for i, event in enumerate(b(t)) if event for j, goal in enumerate(a(t)) if goal
    ),
    "avoid a within 2 s after b": is_absent,
    "keep not a within 2 s after b": is_absent,
    "require not a within 2 s of b": is_absent,
    "not (a) within 2 s of b": is_absent,
    "keep within 2 s after b, not a": is_absent,
    "keep after b, a for 2 s": lambda t: all(all(a(t)[i : i + 2]) for i, event in enumerate(b(t)) if event),
    "reach a within 2 seconds": lambda t: any(a(t)[:3]),
    "reach a for 2 seconds": lambda t: any(all(a(t)[i : i + 3]) for i in range(len(t) - 2)),
    "keep a until 2 s": lambda t: all(a(t)[:2]),
    "require a until 2 seconds": lambda t: all(a(t)[:2]),
    "avoid a until 2 s": lambda t: not any(a(t)[:2]),
    "keep b implies a until 2 s": lambda t: all(all(a(t)[i : i + 2]) for i, event in enumerate(b(t)) if event),
    "keep a at most 2 times": counted(lambda n: n <= 2),
    "keep a no more than twice": counted(lambda n: n <= 2),
    "require a not more than 2 times": counted(lambda n: n <= 2),
    "keep at most 2 times a": counted(lambda n: n <= 2),
    "keep no more than 2 times a": counted(lambda n: n <= 2),
    "keep up to 2 times a": counted(lambda n: n <= 2),
    "never a more than twice": counted(lambda n: n <= 2),
    "never more than twice a": counted(lambda n: n <= 2),
    "keep a less than 2 times": counted(lambda n: n < 2),
    "reach a at least twice": counted(lambda n: n >= 2),
    "require at least twice a": counted(lambda n: n >= 2),
    "keep a no less than 2 times": counted(lambda n: n >= 2),
    "reach a at least once": counted(lambda n: n >= 1),
    "keep a more than once": counted(lambda n: n > 1),
    "never a twice": counted(lambda n: n < 2),
    "avoid a twice": counted(lambda n: n < 2),
    "keep a exactly 2 times": counted(lambda n: n == 2),
    "reach exactly twice a": counted(lambda n: n == 2),
    "never a within 2 s": lambda t: not any(a(t)[:3]),
    "never a twice within 2 s": lambda t: not begins_twice_in_time(t),
    "never twice within 2 s a": lambda t: not begins_twice_in_time(t),
    "keep never a more than once within 2 seconds": lambda t: not begins_twice_in_time(t),
    "avoid a twice in 2 steps": lambda t: not begins_twice_in_time(t),
    "keep a at most once within 2 s": lambda t: not begins_twice_in_time(t),
    "reach a twice within 2 s": begins_twice_in_time,
    "keep a == b": lambda t: a(t) == b(t),
    "keep a is 0": lambda t: not any(a(t)),
    "keep a is not true": lambda t: not any(a(t)),
    "keep a is not false": lambda t: all(a(t)),
    "keep a is false": lambda t: not any(a(t)),
    "keep a equals true": lambda t: all(a(t)),
    "keep a is b": lambda t: a(t) == b(t),
    "keep a is not b": lambda t: all(x != y for x, y in zip(a(t), b(t), strict=True)),
}


@pytest.mark.parametrize(("clause", "meaning"), MEANINGS.items(), ids=MEANINGS)
def test_a_suggestion_has_the_meaning_of_the_sentence(clause: str, meaning: Meaning) -> None:
    (suggestion,) = suggestions(clause)
    check(suggestion, meaning)


@pytest.mark.parametrize(
    "clause", ["never a twice within 2 s", "avoid a twice in 2 s", "keep a no more than once in 2 s"]
)
def test_a_count_within_a_time_counts_from_the_first_beginning_where_the_clock_varies(clause: str) -> None:
    (suggestion,) = suggestions(clause, VARIES)
    (fspa,) = compile_text(f"{VARIES}spec s {{ {suggestion} }}")
    for values, lengths in product(product((False, True), repeat=5), product((0.5, 1.0, 2.0), repeat=4)):
        monitor, time, is_kept = Monitor(fspa), 0.0, True
        begun: list[float] = []
        for i, (value, dt) in enumerate(zip(values, (1.0, *lengths), strict=True)):
            time += dt
            if value and not (i and values[i - 1]):
                is_kept &= all(time - earlier > 2 for earlier in begun)
                begun.append(time)
            assert monitor.step({"a": value}, dt).accepting == is_kept, (values, lengths)


@pytest.mark.parametrize(
    ("clause", "first", "second"),
    [
        (
            "reach b before",
            lambda t: any(b(t)),
            lambda t: any(b(t)[:-1]),
        ),
        (
            "reach b until 2 s",
            lambda t: all(b(t)[:2]),
            lambda t: any(b(t)[:3]),
        ),
    ],
)
def test_both_readings_of_an_unclear_sentence_are_given(clause: str, first: Meaning, second: Meaning) -> None:
    readings = [reading.replace("require once", "reach once") for reading in suggestions(clause)]
    assert len(readings) == 2
    check(readings[0], first)
    check(readings[1].replace("require previously", "reach previously"), second)


@pytest.mark.parametrize("clause", ["keep a twice", "keep twice a", "require a 2 times"])
def test_a_count_without_a_comparison_gets_both(clause: str) -> None:
    at_least, at_most = suggestions(clause)
    check(at_least, counted(lambda n: n >= 2))
    check(at_most, counted(lambda n: n <= 2))


@pytest.mark.parametrize(
    ("clause", "readings"),
    [
        ("keep a implies b before", ["once b", "previously b"]),
        ("keep a implies has door before", ["once has(door)", "previously has(door)"]),
        ("keep a implies has(door) before", ["once has(door)", "previously has(door)"]),
        ("keep a implies had b before", ["once b", "previously b"]),
    ],
)
def test_the_readings_of_an_unclear_formula_compile(clause: str, readings: list[str]) -> None:
    _, error = error_of(clause)
    assert error.fixes == ()
    assert re.findall("`([^`]*)`", error.help or "") == readings
    for reading in readings:
        compile_text(f"{NAMES}spec s {{ keep a implies {reading} }}")


@pytest.mark.parametrize(
    ("clause", "right"),
    [
        ("phase = 2", [2]),
        ("phase is 2", [2]),
        ("phase is not 2", [0, 1, 3]),
        ("phase is last", [0]),
        ("phase equals 2", [2]),
        ("phase is equal to 2", [2]),
        ("phase is not equal to 2", [0, 1, 3]),
        ("phase is exactly 2", [2]),
        ("phase is (2)", [2]),
        ("phase + 1 is 3", [2]),
        ("phase + 1 = 3", [2]),
        ("2 * phase - 1 is not 3", [0, 1, 3]),
        ("phase - 3 is -2", [1]),
        ("phase / 2 is 1", [2]),
        ("3 is phase", [3]),
        ("not phase is 2", [0, 1, 3]),
        ("2 = phase", [2]),
        ("phase no more than 2", [0, 1, 2]),
        ("phase not more than 2", [0, 1, 2]),
        ("phase is not less than 2", [2, 3]),
        ("no more than 2 phase", [0, 1, 2]),
    ],
)
def test_a_suggestion_for_an_int_holds_at_the_values_that_are_meant(clause: str, right: list[int]) -> None:
    (suggestion,) = suggestions(f"require {clause}")
    (fspa,) = compile_text(f"{NAMES}spec s {{ {suggestion} }}")
    samples = [{"phase": value, "last": 0} for value in range(4)]
    assert [sample["phase"] for sample in samples if Monitor(fspa).step(sample).accepting] == right


@pytest.mark.parametrize(
    ("clause", "right"),
    [
        ("charge is 1", [1.0]),
        ("charge is not 1", [-1.0, 0.0, 0.5]),
        ("charge is -1", [-1.0]),
        ("charge is not -1", [0.0, 0.5, 1.0]),
        ("charge equals 0.5", [0.5]),
        ("2 * charge is 1", [0.5]),
        ("charge is least", [0.0]),
        ("charge is not least", [-1.0, 0.5, 1.0]),
        ("a or charge is 1", [1.0]),
        ("not charge is 1", [-1.0, 0.0, 0.5]),
    ],
)
def test_a_suggestion_for_a_number_holds_at_the_values_that_are_meant(clause: str, right: list[float]) -> None:
    names = f"{NAMES}signal charge: number in [-2, 2]\nsignal least: number in [-2, 2]\n"
    (suggestion,) = suggestions(f"require {clause}", names)
    (fspa,) = compile_text(f"{names}spec s {{ {suggestion} }}")
    samples = [{"charge": value, "least": 0, "a": 0} for value in (-1.0, 0.0, 0.5, 1.0)]
    assert [sample["charge"] for sample in samples if Monitor(fspa).step(sample).accepting] == right


@pytest.mark.parametrize("clause", ["keep a is -3", "keep a is not -3", "keep coins is a", "keep phase is not a"])
def test_a_truth_compared_with_a_number_gets_no_fix(clause: str) -> None:
    _, error = error_of(clause)
    assert error.fixes == ()
    assert error.help is not None


@pytest.mark.parametrize(
    ("clause", "right"),
    [
        ("mode == 2", ["chase"]),
        ("mode != 2", ["idle", "alert"]),
        ("1 == mode", ["alert"]),
        ("mode = 1", ["alert"]),
        ("mode is 0", ["idle"]),
        ("mode is not 0", ["alert", "chase"]),
        ("mode = alert", ["alert"]),
        ("mode == alert", ["alert"]),
    ],
)
def test_a_suggestion_for_an_enum_holds_at_the_values_that_are_meant(clause: str, right: list[str]) -> None:
    (suggestion,) = suggestions(f"require {clause}")
    (fspa,) = compile_text(f"{NAMES}spec s {{ {suggestion} }}")
    assert [name for name in ("idle", "alert", "chase") if Monitor(fspa).step({"mode": name}).accepting] == right


@pytest.mark.parametrize("clause", ["require mode == 7", "require mode = 7", "require mode is 7", "require mode = up"])
def test_a_value_that_an_enum_does_not_have_gets_the_list(clause: str) -> None:
    _, error = error_of(clause)
    assert error.fixes == ()
    assert "`idle`, `alert`, `chase`" in (error.help or "")


def test_a_count_within_a_time_counts_in_the_last_seconds() -> None:
    _, error = error_of("avoid a 3 times within 10 s")
    assert (error.help or "").splitlines()[0] == "write `avoid times_within(a, 10 s) >= 3`"


@pytest.mark.parametrize(
    "clause",
    [
        "keep not a and b within 2 s of b",
        "keep b and not a within 2 s of b",
        "keep not not a within 2 s of b",
        "reach not a within 2 s of b",
        "avoid not a within 2 s of b",
    ],
)
def test_an_unclear_negation_within_a_time_gets_the_forms_with_letters(clause: str) -> None:
    _, error = error_of(clause)
    assert error.fixes == ()
    if clause.startswith("reach"):
        assert error.help == "write `reach b then within 2 s a` for `reach a within 2 s of b`"
    else:
        assert error.help == (
            "write `keep within 2 s of b, a` if `a` must come within 2 s of `b`, "
            "`keep b implies not eventually within 2 s a` if it must not"
        )


@pytest.mark.parametrize(
    "clause",
    [
        *(
            "reach b after 10 s",
            "reach a then after 5 s b",
            "keep after 5 s a",
            "keep a after 5 s",
            "avoid a after 5 s",
        ),
        *("reach a then b for 5 steps", "reach b within 20", "reach b within 20 frames", "keep a until 5 steps"),
        *("require eventually within 20 a", "require eventually within 20 frames a", "require eventually [20] a"),
        *("keep a implies once [0, 20] b", "keep a implies b for 3 steps", "keep a implies b in the last 5 steps"),
        *(
            "avoid a twice in 10 steps",
            "keep a within 5 steps of b",
            "limit: 20 s",
            "require next[3] a",
        ),
    ],
)
def test_no_help_needs_a_fixed_clock_where_the_clock_varies(clause: str) -> None:
    _, error = error_of(clause, VARIES)
    assert error.fixes == ()
    assert error.help
    quoted = re.findall("`([^`]*)`", error.help)
    # A limit may be in steps.
    texts = [text for text in quoted if text not in ("clock 60 Hz", "clock varies", "limit 400 steps")]
    assert not any(re.search(r"step|after|\[|^limit", text) for text in texts), error.help


@pytest.mark.parametrize("names", [NAMES, VARIES])
@pytest.mark.parametrize("clause", ["keep a implies (b within 3 s)", "keep not a within 3 s"])
def test_a_help_shows_the_time_that_was_written(clause: str, names: str) -> None:
    _, error = error_of(clause, names)
    assert error.fixes == ()
    assert error.help == "write `eventually within 3 s a` for `a within 3 s`"


def test_a_time_after_until_gets_no_fix_where_more_follows() -> None:
    _, error = error_of("keep a until 2 s and b")
    assert error.fixes == ()
    assert error.help == "write `always for 2 s a` for `a until 2 s`"


@pytest.mark.parametrize("clause", ["keep a until 2 s or b", "keep a until b or 2 s", "keep a until (b or 2 s)"])
def test_a_time_or_an_event_ends_what_is_asked_for_until_then(clause: str) -> None:
    (fixed,) = suggestions(clause)
    check(fixed, lambda t: all((a(t)[: b(t).index(True)] if any(b(t)) else a(t))[:2]))


@pytest.mark.parametrize("clause", ["never a for 2 s", "avoid a for 2 s", "avoid for 2 s a"])
def test_never_for_a_time_gets_both_readings(clause: str) -> None:
    _, error = error_of(clause)
    assert error.fixes == ()
    for_two, never_two = re.findall("`([^`]*)`", error.help or "")
    check(for_two, lambda t: not any(a(t)[:2]))
    assert never_two == "avoid time_holding(a) >= 2 s"
    check(never_two, lambda t: not any(all(a(t)[i : i + 3]) for i in range(len(t) - 2)))


@pytest.mark.parametrize("value", ["alert", "not alert"])
def test_an_error_after_a_value_of_an_enum_does_not_blame_is(value: str) -> None:
    _, error = error_of(f"avoid mode is {value} for 2 s")
    assert error.fixes == ()
    assert error.title == "`for` cannot stand here"
    assert f"`avoid time_holding(mode is {value}) >= 2 s` if it must never hold that long" in (error.help or "")
