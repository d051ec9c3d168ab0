"""Which lines of a game's standard error are shown."""

from __future__ import annotations

import pytest

from tltl_runtime.wire.error_lines import has_unreadable_script, last_message, script_error, telling_lines

PARSE_ERROR = ["SCRIPT ERROR: GDScript::reload: Parse Error: misplaced: func", "   At: res://player.gd:20."]
STEP_ERROR = ["SCRIPT ERROR: step: Invalid operands 'int' and 'Nil'.", "   At: res://main.gd:47."]
FOLLOWS = ["ERROR: reload: Method failed. Returning: ERR_PARSE_ERROR", "   At: modules/gdscript/gdscript.cpp:599."]
NOISE = [
    "error: XDG_RUNTIME_DIR is invalid or not set in the environment.",
    "ALSA lib confmisc.c:855:(parse_card) cannot find card '0'",
    'ERROR: init_device: Condition "status < 0" is true. Returned: ERR_CANT_OPEN',
    "   At: drivers/alsa/audio_driver_alsa.cpp:88.",
    "ERROR: set_locale: Unsupported locale 'C', falling back to 'en'.",
    "   At: core/translation.cpp:969.",
    "bash: warning: setlocale: LC_ALL: cannot change locale (de_DE.UTF-8)",
    "WARNING: cleanup: ObjectDB instances leaked at exit (run with --verbose for details).",
    "   At: core/object.cpp:2135.",
]


def test_noise_of_the_system_is_left_out() -> None:
    assert telling_lines([*NOISE, "no map", *NOISE], 20) == ["no map"]
    assert telling_lines(NOISE, 20) == []


def test_errors_in_scripts_come_first_and_what_follows_from_them_is_left_out() -> None:
    own = ["ERROR: push_error: the door has no key", "   At: modules/gdscript/gdscript_functions.cpp:655."]
    lines = ["loading", *NOISE, *PARSE_ERROR, *FOLLOWS, *own, "ready"]
    assert telling_lines(lines, 20) == [*PARSE_ERROR, "loading", *own, "ready"]
    assert telling_lines(["loading", *FOLLOWS], 20) == ["loading", *FOLLOWS]


def test_an_error_in_a_script_is_shown_even_if_much_was_written_after_it() -> None:
    lines = [*PARSE_ERROR, *(f"tick {number}" for number in range(50))]
    assert telling_lines(lines, 5) == [*PARSE_ERROR, "tick 47", "tick 48", "tick 49"]


def test_what_comes_in_each_step_is_shown_once() -> None:
    assert telling_lines(STEP_ERROR * 30, 20) == [*STEP_ERROR, "   (several times in a row)"]
    assert telling_lines(["no such node"] * 30, 20) == ["no such node", "   (several times in a row)"]


def test_the_rest_of_a_message_is_no_line_of_another_one() -> None:
    assert telling_lines([STEP_ERROR[1], *STEP_ERROR], 20) == STEP_ERROR


def test_the_last_lines_are_shown() -> None:
    assert telling_lines([f"line {number}" for number in range(30)], 2) == ["line 28", "line 29"]


@pytest.mark.parametrize(
    ("line", "is_unreadable"),
    [
        ('SCRIPT ERROR: Parse Error: Expected expression after "=".', True),
        ("Uncaught SyntaxError: Unexpected token '}'", True),
        ("SCRIPT ERROR: _ready: Invalid call. Nonexistent function 'foo' in base 'Nil'.", False),
        ("Uncaught TypeError: hall.reset is not a function", False),
        ("a log line about a Parse Error", False),
    ],
)
def test_a_script_that_cannot_be_read_is_told_from_one_that_fails(line: str, is_unreadable: bool) -> None:
    assert has_unreadable_script(["loading", line]) == is_unreadable


def test_the_first_error_in_a_script_is_one_line() -> None:
    assert script_error(["loading", *NOISE, *STEP_ERROR, *PARSE_ERROR]) == (
        "SCRIPT ERROR: step: Invalid operands 'int' and 'Nil'. At: res://main.gd:47."
    )
    assert script_error([*NOISE, "loading"]) == ""


def test_the_last_message_is_one_line_also_if_it_is_repeated() -> None:
    assert last_message(["loading", *["no such node"] * 2, *NOISE]) == "no such node"
    assert last_message(["loading", *FOLLOWS]) == f"{FOLLOWS[0]} {FOLLOWS[1].strip()}"
    assert last_message(NOISE) == ""
