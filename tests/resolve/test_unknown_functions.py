"""Calls of functions that do not exist, or not with these arguments."""

from __future__ import annotations

import pytest

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.pipeline import compile_source, compile_text

HEAD = "clock 10 Hz\nsignal a: bool\nsignal x in [0, 100]\nsignal turn: int in [0, 9]\nsignal mode: (idle, alert)\n"


def first_error(text: str) -> Diagnostic:
    with pytest.raises(TltlError) as raised:
        compile_source(SourceFile("a.tltl", text))
    return raised.value.diagnostics[0]


@pytest.mark.parametrize(
    ("clause", "call", "written"),
    [
        ("keep changed(turn) implies a", "changed(turn)", "turn != previous(turn)"),
        ("keep a implies not changed(a)", "changed(a)", "(begins a or ends a)"),
        ("keep changed(x) implies a", "changed(x)", "(x < previous(x) or x > previous(x))"),
        ("keep delta(turn) <= 3", "delta(turn)", "(turn - previous(turn))"),
    ],
)
def test_a_function_that_says_the_same_as_others_gets_a_fix(clause: str, call: str, written: str) -> None:
    error = first_error(f"{HEAD}spec s {{ {clause} }}")
    assert (error.code, error.help) == ("TLT0201", f"write `{clause.replace(call, written)}`")
    assert error.fixes[0].edits[0].text == written


@pytest.mark.parametrize(
    ("number", "form"),
    [
        ("total_in(a, a) <= 60 s", "total_time(p)"),
        ("min_since(x, a) > 3", "lowest_since(x, q)"),
        ("max_since(x, a) > 3", "highest_since(x, q)"),
        ("count_since(a, begins a) > 3", "times_since(p, q)"),
        ("times_sinse(a, a) > 3", "times_since(p, q)"),
    ],
)
def test_a_call_of_an_unknown_function_names_those_that_are_like_it(number: str, form: str) -> None:
    error = first_error(f"{HEAD}spec s {{ keep {number} }}")
    assert error.code == "TLT0201"
    assert f"`{form}`" in (error.help or "") or error.fixes[0].edits[0].text == form.partition("(")[0]
    assert "declare" not in (error.help or "")


@pytest.mark.parametrize(
    ("rule", "signal"),
    [
        ("time_in_last(a) <= 10 s", "signal a_time_in_last: time in [0 s, 60 s]"),
        ("mean(x, 60 s) <= 85", "signal x_mean in [0, 100]"),
        ("moving_average(x + 1, 60 s) <= 85", "signal moving_average in [0, 100]"),
        ("sum(x) <= 85", "signal x_sum in [0, 100]"),
    ],
)
def test_a_function_of_many_values_is_for_the_game_to_record(rule: str, signal: str) -> None:
    error = first_error(f"{HEAD}spec s {{ keep {rule} }}")
    assert f"`{signal}`" in (error.help or "")
    name = signal.split(" ")[1].rstrip(":")
    compile_source(
        SourceFile("a.tltl", f"clock 10 Hz\n{signal}\nspec s {{ keep {name} <= 10{' s' * (': time' in signal)} }}")
    )


@pytest.mark.parametrize(
    ("call", "known"),
    [
        ("max_within(x, 5 s)", "highest_within(x, 5 s)"),
        ("lowest_in_last(x, 5 s)", "lowest_within(x, 5 s)"),
        ("time_in_last(a, 60 s)", "total_time_within(a, 60 s)"),
    ],
)
def test_a_function_of_the_last_seconds_has_a_name(call: str, known: str) -> None:
    error = first_error(f"{HEAD}spec s {{ keep {call} <= {'8 s' if '(a' in call else '8'} }}")
    assert f"keep {known} <=" in (error.help or "")
    assert [edit.text for edit in error.fixes[0].edits] == [known]


@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("time_between(a, a)", "`avoid (begins a) then within 3 s (begins a)`"),
        ("gap(begins a, a)", "`time_since(begins a)`"),
    ],
)
def test_the_time_between_two_events_is_no_function(call: str, said: str) -> None:
    error = first_error(f"{HEAD}spec s {{ keep {call} >= 3 s }}")
    assert said in (error.help or "")


def test_a_call_that_is_like_no_function_gets_a_list_of_them() -> None:
    error = first_error(f"{HEAD}spec s {{ keep foo(a, x > 3) <= 3 }}")
    assert error.title == "there is no function `foo`"
    assert "`total_time_since(p, q)`" in (error.help or "")


def test_a_predicate_of_entities_may_still_be_declared() -> None:
    error = first_error(f"{HEAD}entity key\nspec s {{ reach shiny(key) }}")
    assert "declare it" in (error.help or "")


@pytest.mark.parametrize(
    ("call", "code", "text"),
    [
        ("previous(x, 3)", "TLT0210", "write `previous(x, 3 steps)`"),
        ("previous(x, a)", "TLT0210", "write e.g. `previous(x, 1 s)`, or `previous(x, 3 steps)`"),
        ("previous(x, 99 s)", "TLT0303", "supply the value that `x` had 99 s ago as a signal"),
        ("previous(x, 0 steps)", "TLT0303", "write `x` for the value at this step"),
        ("previous(x, 20 m)", "TLT0312", "write e.g. `20 steps` or `2 s`"),
    ],
)
def test_how_long_ago_a_value_is_must_be_some_steps(call: str, code: str, text: str) -> None:
    error = first_error(f"{HEAD}spec s {{ keep x >= {call} - 5 }}")
    assert error.code == code
    assert text in (error.help or "")


@pytest.mark.parametrize("argument", ["mode is idle", "(mode is idle)", "turn > 3", "x <= 2"])
def test_a_formula_at_the_step_before_is_no_number(argument: str) -> None:
    error = first_error(f"{HEAD}spec s {{ keep previous({argument}) implies a }}")
    assert error.code == "TLT0302"
    assert f"`previously ({argument.strip('()')})`" in (error.help or "")


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        ("keep times(a then within 5 s (x > 3), 9) <= 2", "(x > 3) and previously once within 49 steps a"),
        ("keep once (a then within 2 steps b) implies a", "b and previously once within 1 step a"),
        ("keep once (a then within 1 steps b) implies a", "b and previously a"),
        ("keep once (a then mode is idle) implies a", "(mode is idle) and previously once a"),
        ("keep previously (a then b then a)", "a and previously once (b and previously once a)"),
    ],
)
def test_a_sequence_in_the_past_is_told_at_its_last_step(rule: str, said: str) -> None:
    text = f"{HEAD}signal b: bool\nspec s {{ {rule} }}"
    error = first_error(text)
    assert error.code == "TLT0320"
    assert said in (error.help or "")
    (edit,) = error.fixes[0].edits
    assert edit.text == said
    compile_text(text[: edit.span.start] + edit.text + text[edit.span.end :])
