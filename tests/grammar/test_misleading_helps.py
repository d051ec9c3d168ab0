"""Helps that once led users astray say what their clause may mean, in their own words, or what no clause can say."""

from __future__ import annotations

import re

import pytest

from tltlc import compile_text
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.mistakes.sentences.validity import is_valid

HEAD = """
clock 10 Hz
signal alarm: bool
signal hidden: bool
signal seen: bool
signal hit: bool
signal mode: (wave, dive, idle)
signal speed in [0, 10]
"""


def error_of(clause: str) -> Diagnostic:
    with pytest.raises(TltlError) as failure:
        compile_text(f"{HEAD}spec s {{\n    {clause}\n}}\n")
    return failure.value.diagnostics[0]


def quoted(clause: str) -> list[str]:
    """Return the clauses that the help for a clause names; the error must have no fix."""
    error = error_of(clause)
    assert error.fixes == ()
    clauses = [text for text in re.findall("`([^`]*)`", error.help or "") if text.split(" ")[0] in ("keep", "require")]
    assert all(is_valid((text,)) for text in clauses)
    return clauses


def marked(error: Diagnostic) -> str:
    return error.labels[0].source.slice(error.labels[0].span)


BRACKETINGS = {
    "keep alarm implies within 1 s hidden until seen": [
        "keep alarm implies eventually within 1 s (hidden weak_until seen)",
        "keep alarm implies eventually within 1 s (hidden until seen)",
        "keep alarm implies (hidden until seen) and eventually within 1 s seen",
    ],
    "keep alarm implies hidden within 1 s until seen": [
        "keep alarm implies eventually within 1 s (hidden and (hidden weak_until seen))",
        "keep alarm implies eventually within 1 s (hidden and (hidden until seen))",
    ],
    "keep alarm implies hidden within 1 s or seen": [
        "keep alarm implies eventually within 1 s (hidden or seen)",
        "keep alarm implies (eventually within 1 s hidden) or seen",
    ],
    "require within 1 s hidden and seen": [
        "require eventually within 1 s (hidden and seen)",
        "require (eventually within 1 s hidden) and seen",
    ],
    "require always (alarm implies in 10 steps hidden or seen)": [
        "require always (alarm implies eventually within 10 steps (hidden or seen))",
        "require always (alarm implies (eventually within 10 steps hidden) or seen)",
    ],
    "keep alarm implies for 1 s hidden until speed > 3": [
        "keep alarm implies always for 1 s (hidden until speed > 3)",
        "keep alarm implies (always for 1 s hidden) until speed > 3",
    ],
}


@pytest.mark.parametrize(("clause", "readings"), BRACKETINGS.items(), ids=BRACKETINGS)
def test_a_time_beside_an_operator_gets_both_bracketings(clause: str, readings: list[str]) -> None:
    assert quoted(clause) == readings


@pytest.mark.parametrize(
    ("clause", "written"),
    [
        ("keep times(hit) within 3 s <= 2", "keep times_within(hit, 3 s) <= 2"),
        ("keep times(hit) in the last 3 s <= 2", "keep times_within(hit, 3 s) <= 2"),
        ("keep within 3 s times(hit) <= 2", "keep times_within(hit, 3 s) <= 2"),
        ("keep times(hit) <= 2 per 3 s", "keep times_within(hit, 3 s) <= 2"),
        ("keep alarm implies times(hit) in any 3 s < 5", "keep alarm implies times_within(hit, 3 s) < 5"),
    ],
)
def test_a_count_within_a_time_gets_the_function_that_counts_in_the_last_seconds(clause: str, written: str) -> None:
    help_, _, note = (error_of(clause).help or "").partition("\n")
    assert help_ == f"write `{written}`"
    note_on_window = "`times_within(hit, 3 s)` counts how often it has begun at this step or one of the 30 before"
    assert note == ("" if "implies" in clause else note_on_window)


def test_a_count_within_a_time_without_a_comparison_gets_no_fix() -> None:
    error = error_of("keep times(hit) within 3 s")
    assert error.fixes == ()
    assert "`times_within(hit, 3 s)` is how often `hit` has begun in the last 3 s" in (error.help or "")


@pytest.mark.parametrize(
    ("clause", "readings"),
    [
        (
            "keep speed stays the same while alarm",
            [
                "keep alarm and previously alarm implies speed >= previous(speed) and speed <= previous(speed)",
                "keep alarm implies speed >= previous(speed) and speed <= previous(speed)",
            ],
        ),
        (
            "keep not hit for 2 s after alarm",
            ["keep alarm implies always for 2 s not hit", "keep ends alarm implies always for 2 s not hit"],
        ),
        (
            "after alarm no hit for 2 s",
            ["keep alarm implies always for 2 s not hit", "keep ends alarm implies always for 2 s not hit"],
        ),
    ],
)
def test_a_rule_of_a_condition_that_lasts_gets_both_readings(clause: str, readings: list[str]) -> None:
    assert quoted(clause) == readings


@pytest.mark.parametrize(
    "clause", ["require hit at least 2 times before alarm", "require at least 2 times hit before alarm"]
)
def test_a_required_count_before_an_event_has_a_clause(clause: str) -> None:
    assert (error_of(clause).help or "").splitlines()[0] == "write `keep alarm implies times(hit) >= 2`"


def test_a_count_of_two_within_a_time_has_a_clause() -> None:
    help_ = error_of("keep times(hit) within 3 s <= 1").help or ""
    assert help_.splitlines()[0] == "write `avoid (begins hit) then within 3 s (begins hit)`"


@pytest.mark.parametrize(
    ("clause", "event"),
    [
        ("keep times(hit) since alarm <= 9", "alarm"),
        ("keep times(hit) since begins alarm <= 9", "begins alarm"),
        ("keep times(hit) since alarm", "alarm"),
        ("keep hit since alarm <= 9", "alarm"),
    ],
)
def test_a_count_since_an_event_has_a_function(clause: str, event: str) -> None:
    help_ = error_of(clause).help or ""
    assert help_.endswith(f"`times_since(hit, {event})` about those from the last step with `{event}` on")


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        ("keep (times(hit) since alarm) <= 9", "keep (times_since(hit, alarm)) <= 9"),
        ("keep times(hit) since begins mode is wave <= 9", "keep times_since(hit, begins (mode is wave)) <= 9"),
        ("keep times(hit) <= 3 in each alarm", "keep times_since(hit, begins alarm) <= 3"),
    ],
)
def test_a_count_since_an_event_gets_the_clause(clause: str, meant: str) -> None:
    assert f"`{meant}`" in (error_of(clause).help or "")


def test_a_bool_that_is_compared_may_be_counted() -> None:
    error = error_of("keep hit <= 3")
    assert error.code == "TLT0310"
    assert (error.help or "").endswith("as in `times(hit) <= 3`")


@pytest.mark.parametrize(
    ("clause", "word"),
    [
        ("keep mode is not wave < 2", "<"),
        ("keep alarm implies eventually within 5 s mode is dive unless not hidden", "unless"),
        ("keep mode is dive glows", "dive glows"),
    ],
)
def test_an_error_behind_a_test_of_an_enum_is_at_what_cannot_stand_there(clause: str, word: str) -> None:
    error = error_of(clause)
    assert marked(error) == word
    assert "`is`" not in error.title


def test_a_test_that_is_compared_may_be_counted_or_timed() -> None:
    assert "`times(mode is wave) <= 1`" in (error_of("keep mode is wave <= 1").help or "")
    assert "`time_holding(mode is wave) <= 2 s`" in (error_of("keep mode is wave <= 2 s").help or "")


CONDITIONS = {
    "keep alarm implies eventually within 5 s mode is dive unless not hidden": [
        "keep alarm implies not hidden or (eventually within 5 s mode is dive)",
        "keep alarm implies eventually within 5 s (mode is dive or not hidden)",
    ],
    "keep alarm implies next hidden when seen": [
        "keep alarm and seen implies next hidden",
        "keep alarm implies next (hidden and seen)",
    ],
    "require always (alarm implies eventually hidden unless speed > 3)": [
        "require always (alarm and not (speed > 3) implies eventually hidden)",
        "require always (alarm implies eventually (hidden or speed > 3))",
    ],
    "keep alarm implies hidden if seen": ["keep alarm and seen implies hidden"],
}


@pytest.mark.parametrize(("clause", "readings"), CONDITIONS.items(), ids=CONDITIONS)
def test_a_condition_behind_a_rule_is_about_the_event_or_its_answer(clause: str, readings: list[str]) -> None:
    assert quoted(clause) == readings


@pytest.mark.parametrize(
    "word", ["in each", "per", "between", "during", "since the", "for", "within", "every", "each", "except"]
)
def test_a_word_of_english_behind_a_number_is_no_unit(word: str) -> None:
    error = error_of(f"keep times(hit) <= 3 {word} hidden")
    assert error.code != "TLT0111"
    assert "the units are" not in (error.help or "")


def test_an_exception_behind_a_number_gets_the_whole_clause() -> None:
    error = error_of("keep alarm implies hidden and (speed <= 3 except seen)")
    assert error.help == "write `keep alarm implies hidden and (speed <= 3 or seen)`"


def test_no_help_has_a_word_that_is_not_read() -> None:
    error = error_of("keep alarm implies speed <= 3 apart within 5 s after begins hidden")
    assert "apart" not in (error.help or "")


@pytest.mark.parametrize("clause", ["when alarm, not both hidden and seen", "not both hidden and seen when alarm"])
def test_not_both_asks_for_neither_of_them(clause: str) -> None:
    assert error_of(clause).help == "write `keep alarm implies not (hidden and seen)`"


def test_what_is_not_so_before_something_else_is_no_goal() -> None:
    assert (
        error_of("mode is not dive before mode is wave").help
        == "write `require mode is not dive weak_until mode is wave`"
    )


def test_a_time_from_the_first_step_with_a_condition_on_counts_no_steps_in_a_row() -> None:
    assert "in a row" not in (error_of("hit only if seen was at least 5 s ago").help or "")


def test_another_word_behind_a_number_is_no_unit() -> None:
    assert error_of("keep speed <= 3 feet").title == "the language has no unit `feet`"


@pytest.mark.parametrize(
    ("clause", "word"),
    [
        ("keep hidden glows", "glows"),
        ("when alarm, hidden must glow", "must"),
        ("keep if hidden alarm else seen", "else"),
    ],
)
def test_a_word_that_the_language_does_not_know_is_named(clause: str, word: str) -> None:
    error = error_of(clause)
    assert f"the language has no word `{word}`" in f"{error.title}\n{error.help}"
    assert "docs/guides/phrases.md" in (error.help or "")


@pytest.mark.parametrize(
    ("clause", "title"),
    [
        ("keep hidden unless alarm", "the language has no word `unless`"),
        ("keep hidden if alarm", "the language has no word `if`"),
        ("reach seen within 5 s", "`within` cannot stand here"),
        ("keep hidden for 3 s", "`for` cannot stand here"),
    ],
)
def test_words_of_the_language_are_misplaced_and_other_words_are_unknown(clause: str, title: str) -> None:
    assert error_of(clause).title == title


def test_a_help_in_the_words_of_the_file_stays() -> None:
    assert "`keep alarm implies hidden`" in (error_of("keep alarm hidden").help or "")


def test_counting_stops_at_a_maximum() -> None:
    assert error_of("keep times(hit) >= 2 * times(seen)").help == (
        "write the greatest value that one play can reach in each, e.g. `times(hit, 1000) >= 2 * times(seen, 1000)`: "
        "from there on, they stay at it, and no difference is seen"
    )


def test_both_sides_of_a_comparison_get_a_maximum() -> None:
    assert error_of("keep time_holding(hidden) >= time_holding(seen)").help == (
        "write the greatest value that one play can reach on both sides, e.g. "
        "`time_holding(hidden, 60 s) >= time_holding(seen, 60 s)`: from there on, both stay at it, and no "
        "difference is seen"
    )


@pytest.mark.parametrize(
    ("clause", "help_"),
    [
        ("keep hidden unless alarm", "write `keep hidden or alarm`"),
        (
            "keep time_holding(hidden) >= 5 steps implies not seen",
            "write `keep time_holding(hidden) >= 0.5 s implies not seen`",
        ),
    ],
)
def test_a_help_shows_the_whole_clause(clause: str, help_: str) -> None:
    assert (error_of(clause).help or "").startswith(help_)


def test_a_sentence_that_is_not_understood_gets_the_words_that_begin_a_rule() -> None:
    (first, second, third) = (error_of("hidden glimmers sometimes like alarm").help or "").splitlines()
    assert "`keep`" in first
    assert "`avoid`" in first
    assert "`reach`" in second
    assert "`require`" in second
    assert "docs/guides/phrases.md" in third


def test_a_line_like_a_setting_gets_all_words_that_begin_a_clause() -> None:
    assert (error_of("difficulty hard").help or "").startswith("use one of `reach`, `keep`, ")


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        (
            "keep alarm implies speed == previous(speed)",
            "keep alarm implies (speed >= previous(speed) and speed <= previous(speed))",
        ),
        ("keep speed != previous(speed)", "keep speed < previous(speed) or speed > previous(speed)"),
    ],
)
def test_a_number_is_not_compared_as_true_or_false(clause: str, meant: str) -> None:
    error = error_of(clause)
    assert error.help == f"write `{meant}`"
    assert len(error.fixes) == 1
