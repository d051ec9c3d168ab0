"""Declarations as newcomers type them: the first fix of each gives the declarations that are meant."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.tools.lint.scopes import apply_edits

ABC = "signal a: bool\nsignal b: bool\nsignal c: bool"
MEANT = [
    *((typed, "clock 60 Hz") for typed in ("fps 60", "clock: 60 Hz", "clock 60 fps", "clock = 60 fps", "rate 60 Hz")),
    *((typed, "clock 60 Hz") for typed in ("tick rate 60", "framerate: 60", "clock 60 frames per second", "dt = 1/60")),
    *((typed, "clock 0.1 s") for typed in ("timestep 0.1 s", "dt = 0.1", "time step 0.1", "clock every 0.1 seconds")),
    ("rate 30 fps", "clock 30 Hz"),
    ("dt varies", "clock varies"),
    *(
        (f"signal alert{values}", "signal alert: (a, b, c)")
        for values in (
            " in {a, b, c}",
            " in (a, b, c)",
            " in [a, b, c]",
            ": {a, b, c}",
            ": enum(a, b, c)",
            ": enum { a, b, c }",
            ": [a, b, c]",
            ": a | b | c",
            ': "a" | "b" | "c"',
            ": a, b, c",
            ": one of a, b, c",
            " = {a, b, c}",
            ": {a = 0, b = 1, c = 2}",
            ": (a, b, c) = a",
        )
    ),
    ("enum alert { a, b }", "signal alert: (a, b)"),
    ("state alert {a, b}", "signal alert: (a, b)"),
    ("state: {a, b}", "signal state: (a, b)"),
    ("flag: bool", "signal flag: bool"),
    ("enum alert = {\n  a,\n  b\n}", "signal alert: (a, b)"),
    ("alert: {a, b}", "signal alert: (a, b)"),
    *(
        (f"signal x{range_}", "signal x in [0, 100]")
        for range_ in (" in 0..100", " from 0 to 100", ": [0,100]", ": 0 to 100", " in (0, 100)", ": 0-100", " 0..100")
    ),
    *(
        (typed, "signal x: int in [0, 30]")
        for typed in (
            "signal x: int 0..30",
            "signal x: int [0, 30]",
            "signal x: int(0, 30)",
            "signal x: integer between 0 and 30",
            "signal x: int min 0 max 30",
            "signal int x in [0, 30]",
            "int x in [0, 30]",
            "int x: 0..30",
            "x: int in [0, 30]",
            "var x: int in [0, 30] = 3",
        )
    ),
    ("signal x: int in {0, 1, 2}", "signal x: int in [0, 2]"),
    ("signal x: float 0 to 1", "signal x: number in [0, 1]"),
    ("signal x: number >= 0 and <= 1", "signal x: number in [0, 1]"),
    ("x: int > 0, < 10", "signal x: int in [1, 9]"),
    ("number x in [0, 1]", "signal x: number in [0, 1]"),
    ("float x in [-1.5, 1]", "signal x: number in [-1.5, 1]"),
    ("signal v: 0..10 m/s", "signal v: speed in [0 m/s, 10 m/s]"),
    ("signal v: m/s in [0, 10]", "signal v: speed in [0 m/s, 10 m/s]"),
    ("signal v: km/h 0..50", "signal v: speed in [0 km/h, 50 km/h]"),
    ("signal q: m | s", "signal q: (m, s)"),
    ("signal d: float 0 m to 10 m", "signal d: length in [0 m, 10 m]"),
    ("signal d(x: entity): float 0..10", "signal d(x: entity): number in [0, 10]"),
    ("signal hp: int in [0,100];", "signal hp: int in [0, 100]"),
    *(
        (typed, "signal a: bool")
        for typed in (
            "bool a",
            "bool a;",
            "var a: bool",
            "let a: bool",
            "input a : boolean",
            "signal a: bool = false",
            "boolean a = false;",
            "signal bool a",
            "signal a bool",
            "signal a as bool",
            "flag a",
            "event a",
            "a: bool",
        )
    ),
    ("signals a, b, c: bool", ABC),
    ("signal a, b, c: bool", ABC),
    ("bool a, b, c", ABC),
    ("signals:\n  a: bool\n  b: bool\n  c: bool", ABC),
    ("signals {\n  a: bool\n  b: bool\n  c: bool\n}", ABC),
    ("signals { a: bool; b: bool; bool c = false }", ABC),
    ("signals { e: {p, q} x: 0..3 a: bool }", "signal e: (p, q)\nsignal x in [0, 3]\nsignal a: bool"),
    ("flags { a, b, c }", ABC),
    ("signal a: bool;\nsignal b: bool;\nbool c;", ABC),
    ("signal a: bool, b: bool, c: bool", ABC),
    ("entities: a, b", "entity a, b"),
    *(
        (f"signal a: bool\n{typed}", "signal a: bool\nspec s { reach a }")
        for typed in (
            "rule s { reach a }",
            "property s {\n  reach a\n}",
            'spec "s" { reach a }',
            "spec s: reach a",
            "spec s:\n  reach a",
            "spec s = { reach a }",
            "spec s = reach a",
            "spec s reach a",
            "spec s() { reach a }",
        )
    ),
    ("signal a: bool\nspec s: F a", "signal a: bool\nspec s = F a"),
    ("signal a\nspec s { reach a }", "signal a: bool\nspec s { reach a }"),
    ("signal a, b\nspec s { reach a avoid b }", "signal a: bool\nsignal b: bool\nspec s { reach a avoid b }"),
]


OF_ENUM = "signal engine: (Ok, Hot)"
ENUMS = [
    ("enum Engine { Ok, Hot }\nsignal engine: Engine", OF_ENUM),
    ("signal engine: Engine\nenum Engine {\n  Ok,\n  Hot\n}", OF_ENUM),
    ("enum class Engine : byte { Ok = 0, Hot = 1 };\nEngine engine = Engine::Ok;", OF_ENUM),
    ("enum Engine { Ok, Hot }; signal engine: Engine", OF_ENUM),
    ("type Engine = Ok | Hot\nsignal engine: enum Engine", OF_ENUM),
    ("type Engine = Ok | Hot;\nEngine engine;", OF_ENUM),
    ("enum Engine { Ok, Hot }\nsignal engine: Engine\nEngine pump", f"{OF_ENUM}\nsignal pump: (Ok, Hot)"),
    ("enum Engine { Ok, Hot }\nsignal engine, pump: Engine", f"{OF_ENUM}\nsignal pump: (Ok, Hot)"),
    (
        "enum Engine { Ok, Hot }\nenum Mood { Calm, Angry }\nsignals: engine: Engine, mood: Mood",
        f"{OF_ENUM}\nsignal mood: (Calm, Angry)",
    ),
    ("enum Engine { Ok, Hot }\nsignals { engine: Engine }", OF_ENUM),
    (
        "enum Engine { Ok, Hot }\nEngine engine\nspec s { reach engine is Engine::Hot avoid engine is Engine.Ok }",
        f"{OF_ENUM}\nspec s {{ reach engine is Hot avoid engine is Ok }}",
    ),
    ("type engine = Ok | Hot", OF_ENUM),
    ("enum class engine { Ok, Hot }", OF_ENUM),
]


def diagnostics(text: str) -> list[Diagnostic]:
    try:
        compile_text(text)
    except TltlError as error:
        return list(error.diagnostics)
    return []


def mended(text: str) -> str:
    """Apply the first fix of the first error until the text compiles; each text gets one error per line."""
    for _ in range(6):
        left = diagnostics(text)
        if not left:
            return text
        source = SourceFile("a.tltl", text)
        lines = [source.position(item.labels[0].span.start)[0] for item in left]
        assert len(set(lines)) == len(lines), left
        assert left[0].fixes, left
        text = apply_edits(source, left[0].fixes[0].edits).text
    raise AssertionError(text)


@pytest.mark.parametrize(("typed", "meant"), MEANT)
def test_the_first_fix_gives_the_declaration(typed: str, meant: str) -> None:
    assert diagnostics(typed)
    assert mended(typed).replace(" ", "").split() == meant.replace(" ", "").split() or (
        "spec" in meant and "".join(mended(typed).split()) == "".join(meant.split())
    )
    assert not diagnostics(meant)


@pytest.mark.parametrize(("typed", "meant"), ENUMS)
def test_an_enum_and_its_signals_get_one_error_with_one_fix(typed: str, meant: str) -> None:
    (error,) = diagnostics(typed)
    assert meant.splitlines()[0] in (error.help or "")
    source = SourceFile("a.tltl", typed)
    assert apply_edits(source, error.fixes[0].edits).text.strip() == meant
    assert not diagnostics(meant)


def test_the_help_for_an_enum_shows_the_signals_and_says_to_delete_it() -> None:
    (error,) = diagnostics("enum Engine { Ok, Hot }\nsignal engine: Engine")
    assert error.help == "write `signal engine: (Ok, Hot)`, and delete the line with `enum`"


def test_the_clauses_are_checked_with_the_values_of_the_enum() -> None:
    _, equal, unknown = diagnostics(
        "enum Engine { Ok, Hot }\nsignal engine: Engine\nspec s { reach engine == Hot avoid engine is Cold }"
    )
    assert equal.help == "write `reach engine is Hot`"
    assert unknown.help == "its values are `Ok`, `Hot`"


@pytest.mark.parametrize(
    ("typed", "line"),
    [
        ("int lap", "`signal lap: int in [LOW, HIGH]`"),
        ("var hp: int = 100", "`signal hp: int in [LOW, HIGH]`"),
        ("number x", "`signal x: number in [LOW, HIGH]`"),
        ("signal x\nspec s { reach x > 3 }", "`signal x: number in [LOW, HIGH]`"),
        ("x: number >= 0", "`signal x: number in [0, HIGH]`, with its greatest value for HIGH"),
        ("signal hp: int > 0", "`signal hp: int in [1, HIGH]`"),
        ("signal d: length <= 5 m", "`signal d: length in [LOW m, 5 m]`, with its least value for LOW"),
        ("signal v: m/s", "`signal v: speed in [LOW m/s, HIGH m/s]`"),
        ("clock 60", "`clock 60 Hz` for 60 steps a second, `clock 60 s` for the time of one step"),
        ("signal lap\nspec s { reach lap == 3 }", "`signal lap: int in [LOW, HIGH]`"),
        ("signal a", "`signal a: bool` if it is true or false"),
        ("spec { reach true }", "`spec NAME {`"),
    ],
)
def test_what_the_author_left_open_is_in_the_help_and_gets_no_fix(typed: str, line: str) -> None:
    (error,) = diagnostics(typed)
    assert line in (error.help or "")
    assert error.fixes == ()


def test_the_clauses_are_checked_with_the_declarations_that_are_meant() -> None:
    text = (
        "signal alert in {calm, alarmed}\nint lap\nbool seen\nrule r {\n reach lap == 3\n avoid alert == alarmed\n}\n"
    )
    *declared, clause = diagnostics(text)
    assert [error.code for error in declared] == ["TLT0101", "TLT0107", "TLT0107", "TLT0107"]
    assert clause.help == "write `avoid alert is alarmed`"


def test_a_comment_inside_a_declaration_is_not_lost() -> None:
    (error,) = diagnostics("enum alert {\n  a, // first\n  b\n}")
    assert error.help == "write `signal alert: (a, b)`"
    assert error.fixes == ()


@pytest.mark.parametrize(
    ("typed", "help_"),
    [
        ("signal x: float", "write `signal x: number in [LOW, HIGH]`, with its least value for LOW"),
        ("signal lap: integer", "write `signal lap: int in [LOW, HIGH]`"),
        ("signal v(x: entity): velocity", "write `signal v(x: entity): speed in [LOW m/s, HIGH m/s]`"),
        ("signal x: float in [0, 1]", "did you mean `number`?"),
        ("signal a: Bool", "did you mean `bool`?"),
        ("signal mass: kilograms", "or a list of values: `(idle, alert)`"),
    ],
)
def test_the_help_for_an_unknown_type_gives_the_exact_one(typed: str, help_: str) -> None:
    (error,) = diagnostics(typed)
    assert error.code == "TLT0211"
    assert help_ in (error.help or "")


def test_the_clauses_are_checked_with_the_types_that_are_meant() -> None:
    text = "signal lap: integer\nsignal x: float\nsignal v: velocity\nsignal a: boolean\nspec s {\n"
    *types, half, unit, missing = diagnostics(
        f"{text} reach lap == 3.5\n keep x > 2\n keep v > 3\n avoid a and v > 3 m/s and y\n}}"
    )
    assert [error.code for error in types] == ["TLT0211"] * 4
    assert [error.code for error in (half, unit, missing)] == ["TLT0110", "TLT0305", "TLT0201"]
