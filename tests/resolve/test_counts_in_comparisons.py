"""Errors for comparisons with several counts, and for the order of the values of an enum."""

from __future__ import annotations

import pytest

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text

HEAD = "clock 10 Hz\nsignal a: bool\nsignal b: bool\nsignal c: bool\nsignal mode: (one, two, three)\n"


def first_error(text: str) -> Diagnostic:
    with pytest.raises(TltlError) as raised:
        compile_text(text)
    return raised.value.diagnostics[0]


def mended(text: str, error: Diagnostic) -> str:
    for edit in sorted(error.fixes[0].edits, key=lambda edit: -edit.span.start):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return text


@pytest.mark.parametrize(
    ("comparison", "offered"),
    [
        ("times(a) + times(b) <= times(c)", "times(a, 1000) + times(b, 1000) <= times(c, 1000)"),
        (
            "times_within(begins a, 3 s) - times_since(b, c) <= 3",
            "times_within(begins a, 3 s, 100) - times_since(b, c, 1000) <= 3",
        ),
        ("total_time(a) > 2 * total_time(b)", "total_time(a, 60 s) > 2 * total_time(b, 60 s)"),
    ],
)
def test_all_counts_get_a_maximum_at_once(comparison: str, offered: str) -> None:
    text = f"{HEAD}spec s {{ keep {comparison} }}"
    error = first_error(text)
    assert error.code == "TLT0321"
    assert f"`{offered}`" in (error.help or "")
    assert offered in mended(text, error)
    compile_text(mended(text, error))


@pytest.mark.parametrize(
    ("comparison", "modes", "is_kept"),
    [
        ("mode >= previous(mode)", "one one three", True),
        ("mode >= previous(mode)", "one three two", False),
        ("mode <= previous(mode)", "three one one", True),
        ("mode <= previous(mode)", "three one two", False),
        ("previous(mode) <= mode", "one three two", False),
    ],
)
def test_the_order_of_an_enum_gets_the_changes_that_are_allowed(comparison: str, modes: str, is_kept: bool) -> None:
    text = f"{HEAD}spec s {{ keep {comparison} or c }}"
    error = first_error(text)
    assert error.code == "TLT0302"
    (fspa,) = compile_text(mended(text, error))
    monitor = Monitor(fspa)
    values = {"one": 0, "two": 1, "three": 2}
    verdicts = [monitor.step({"a": 0, "b": 0, "c": 0, "mode": values[mode]}).verdict for mode in modes.split()]
    assert (verdicts[-1] != "violated") == is_kept
