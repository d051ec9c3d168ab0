"""The fixes of errors, on all golden error messages and on typical mistakes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import tltlc
from tests.golden.cases import Case, cases
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, TltlError
from tltlc.grammar.parser import parse
from tltlc.resolve.resolution import resolve
from tltlc.tools.lint.fixes import OfferedFix, fixes_of_errors
from tltlc.tools.lint.scopes import apply_edits

GOLDEN = [case for case in cases("error") if re.match("TLT0[123]", case.name) and "input.tltl" in case.files]
HEAD = """clock 10 Hz
import stealth
entity key, chest
signal a: bool
signal b: bool
signal c: bool
signal d: bool
signal at(x: entity): bool
signal coins in [0, 50]
signal hp: ratio
signal width: length in [0 m, 10 m]
signal turn: angle in [0 rad, 4 rad]
signal pace: speed in [0 m/s, 9 m/s]
let both(p, q) = p and q
"""
CORRECTIONS = {
    # Brackets around one operand of `then`.
    "keep a and b then c": ["keep (a and b) then c", "keep a and (b then c)"],
    "keep a then b and c": ["keep a then (b and c)", "keep (a then b) and c"],
    "require a then b implies c": ["require a then (b implies c)", "require (a then b) implies c"],
    "require a or b then c or d": ["require (a or b) then (c or d)"],
    "require a and b then c then d": ["require (a and b) then c then d"],
    "require a then b and c then d": ["require a then (b and c) then d"],
    "avoid a until b then c": ["avoid (a until b) then c", "avoid a until (b then c)"],
    "require F a then b": ["require (F a) then b", "require F (a then b)"],
    "require a then F b": ["require a then (F b)"],
    "reach a then F b then c": [],
    "require F a then F b": [],
    "reach F a then b then c": [],
    "reach G a then F b": ["reach (G a) then (F b)"],
    "require a then all x in (key, chest): F at(x)": ["require a then (all x in (key, chest): F at(x))"],
    # Comparisons that are always true or always false.
    "keep coins < 0": ["keep false"],
    "reach coins > 60": ["reach false"],
    "avoid coins >= 0": ["avoid true"],
    "require a or coins > 50": ["require a or false"],
    "require not coins < 0 and a": ["require not false and a"],
    "keep 1 < 2 implies a": ["keep true implies a"],
    "keep hp > 50": ["keep hp > 50 %"],
    # Operators from other languages.
    "reach ~a": ["reach not a"],
    "keep a|~b": ["keep a|not b"],
    "keep ~(a | b)": ["keep not(a | b)"],
    "keep a=>b": ["keep a implies b"],
    "keep coins =< 3": ["keep coins <= 3"],
    "keep coins=>3": ["keep coins>=3"],
    "keep coins × 2 > 3": ["keep coins * 2 > 3"],
    "keep coins − 2 > 3": ["keep coins - 2 > 3"],
    "keep turn > 90°and a": ["keep turn > 90 deg and a"],
    "keep coins > .5": ["keep coins > 0.5"],
    "keep coins == 3": [],
    "keep coins == 3.5": ["keep coins >= 3.5 and coins <= 3.5"],
    "keep alive == hidden": ["keep alive >= hidden and alive <= hidden", "keep alive iff hidden"],
    "keep near(key) != near(chest)": [
        "keep near(key) < near(chest) or near(key) > near(chest)",
        "keep not (near(key) iff near(chest))",
    ],
    "keep near(key) == 0": ["keep near(key) >= 0 and near(key) <= 0", "keep not near(key)"],
    "keep a == false": ["keep not a"],
    "keep 3 < coins < 9": ["keep 3 < coins and coins < 9"],
    "keep a -- a comment": ["keep a // a comment"],
    "keep a -- why not b?": ["keep a // why not b?"],
    "keep a -- the player's": ["keep a // the player's"],
    "keep coins --3 > 1 a": [],
    "keep coins ≠ 3": [],
    "keep coins ≠ 3.5": ["keep coins < 3.5 or coins > 3.5"],
    "keep a – b": [],
    # Numbers.
    "keep coins > 1,5": ["keep coins > 1.5"],
    "keep coins > 0,125": ["keep coins > 0.125"],
    "keep coins > 12,50": ["keep coins > 12.50"],
    "keep coins > 1,000": [],
    "keep coins < 20,000": [],
    "keep coins < 1,000,000": [],
    "keep coins < 1,234.5": [],
    "keep coins² > 4": ["keep coins^2 > 4"],
    "keep 3² > coins": ["keep 3^2 > coins"],
    "keep coins > 2 and coins³ < 99": ["keep coins > 2 and coins^3 < 99"],
    "require eventually within 20 a": [],
    "require eventually within 20 seconds a": ["require eventually within 20 s a"],
    "limit 400 reach a": ["limit 400 steps reach a", "limit 400 s reach a"],
    "keep width > 3": ["keep width > 3 m"],
    "keep pace > 3 m": ["keep pace > 3 m/s"],
    "keep pace > 3 km": [],
    "keep width > 3 s": [],
    "keep turn > 90": [],
    "keep coins > 3 m": ["keep coins > 3"],
    # Operators without a space before a name.
    "reach Fa": ["reach F a"],
    "require !Fa": ["require !F a"],
    "require Fat(key)": ["require F at(key)"],
    "require FGa & b": ["require F G a & b"],
    "require FG a": ["require F G a"],
    "keep Falive": ["keep F alive"],
    # Commas.
    "reach a, b": ["reach a then b"],
    "keep a, b or c": [],
    "keep a, b and c": ["keep a and (b and c)"],
    "reach all x in (key, chest): at(x), a": ["reach (all x in (key, chest): at(x)) then a"],
    "reach a then any x in (key, chest): at(x), b": ["reach a then (any x in (key, chest): at(x)) then b"],
    "reach not all x in (key, chest): at(x), b": [],
    "avoid any x in (key, chest): at(x), a": ["avoid (any x in (key, chest): at(x)) or a"],
    # Names and keywords.
    "keep aliev": ["keep alive"],
    "kepe a": ["keep a"],
    "keep NOT a": ["keep not a"],
    "keep a adn b": ["keep a and b"],
    "keep both(a, z = b)": [],
    "keep both(a, qq = b)": [],
    "keep 5 < coins < 40": ["keep 5 < coins and coins < 40"],
    "keep 5 < coins < coins < 40": ["keep 5 < coins and coins < coins and coins < 40"],
    "keep coins > 30 percent": [],
    "reach a, not b": [],
    "keep coins > 3 -- comment": [],
    "keep a <- b": [],
    "reach a then next b": [],
    "reach a then always b": [],
    "reach a then not eventually b": [],
    "keep a implies keep b": [],
    "keep a implies never b": [],
    "keep a implies reach b": ["keep a implies eventually b"],
    "keep a or FALSE": ["keep a or false"],
    "keep a = TRUE": ["keep a"],
    "limit time 30": [],
    "limit 30 keep a": ["limit 30 steps keep a", "limit 30 s keep a"],
    "reach a within 5": [],
    "keep a()": ["keep a"],
    "keep at key": ["keep at(key)"],
    'keep at("key")': ["keep at(key)"],
    "judge goal keep a": ["judge at goal keep a"],
    "judge at goall keep a": ["judge at goal keep a"],
    "keep ä or b": ["keep a or b"],
    "reach alive(key)": [],
    "reach at": [],
    "reach a and then b": ["reach a then b"],
    "keep a and then b": [],
    "require always (a and then b)": [],
    "reach a or then b": [],
    "reach a until then b": [],
    "keep a not b": ["keep a and not b"],
    "keep a and b not c": ["keep a and b and not c"],
    "keep a or b not c": [],
    "keep a not b or c": [],
    "reach a or b next c": [],
    "keep a and keep b": ["keep a keep b"],
    "require always a and reach b": [],
    "require not a and reach b": [],
    "keep all x in (key, chest): at(x) and reach a": [],
    "keep coins is more than 3": ["keep coins > 3"],
}  # fmt: skip
"""Clauses with a mistake, and the clauses that the offered fixes produce without errors.

The list is empty where the intention is unclear.
"""


def errors(source: SourceFile) -> tuple[Diagnostic, ...]:
    module, syntax_errors = parse(source)
    return tuple(
        diagnostic for diagnostic in (*syntax_errors, *resolve(module).diagnostics) if diagnostic.severity == "error"
    )


def all_fixes(source: SourceFile) -> Iterator[tuple[Diagnostic, Fix]]:
    """Yield every fix of an error in a text, offered or not."""
    for diagnostic in errors(source):
        for fix in diagnostic.fixes:
            yield diagnostic, fix


def offers(source: SourceFile) -> list[OfferedFix]:
    return list(fixes_of_errors(errors(source), source, lambda text: (parse(text)[1], errors(text))))


def in_spec(clause: str) -> SourceFile:
    return SourceFile("a.tltl", f"{HEAD}spec s {{\n    {clause}\n}}\n")


def check(source: SourceFile) -> None:
    """Assert that edits are within the text and do not overlap, and that each offered fix reduces
    the errors."""
    for diagnostic, fix in all_fixes(source):
        if diagnostic.labels[0].source == source:
            spans = sorted((edit.span.start, edit.span.end) for edit in fix.edits)
            flat = [offset for span in spans for offset in span]
            assert flat == sorted(flat)
            assert 0 <= flat[0] <= flat[-1] <= len(source.text)
            assert len(set(fix.edits)) == len(fix.edits) > 0
    for offer in offers(source):
        fixed = apply_edits(source, offer.fix.edits)
        assert (len(parse(fixed)[1]), len(errors(fixed))) < (len(parse(source)[1]), len(errors(source)))


@pytest.mark.parametrize("case", GOLDEN, ids=lambda case: case.name)
def test_fixes_of_golden_messages_are_sound(case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case.unpack(tmp_path)
    monkeypatch.chdir(tmp_path)
    check(SourceFile("input.tltl", case.files["input.tltl"].decode()))


@pytest.mark.parametrize(("clause", "corrections"), CORRECTIONS.items(), ids=CORRECTIONS)
def test_fixes_of_a_clause_produce_the_corrections(clause: str, corrections: list[str]) -> None:
    source = in_spec(clause)
    check(source)
    fixed_sources = [apply_edits(source, offer.fix.edits) for offer in offers(source)]
    assert [fixed_source.text for fixed_source in fixed_sources] == [
        in_spec(correction).text for correction in corrections
    ]
    for fixed_source, correction in zip(fixed_sources, corrections, strict=True):
        assert formula(fixed_source) == formula(in_spec(correction))


def formula(source: SourceFile) -> str:
    (fspa,) = tltlc.compile_text(source.text)
    return str(fspa.formula)


def test_every_fix_of_the_table_is_offered() -> None:
    """A fix is tried before it is offered. This is only a safeguard: all fixes should pass."""
    refused = {
        (clause, fix.title)
        for clause in CORRECTIONS
        for _, fix in all_fixes(in_spec(clause))
        if fix not in [offer.fix for offer in offers(in_spec(clause))]
    }
    assert not refused


def test_the_table_has_many_rows() -> None:
    assert len(CORRECTIONS) >= 60


def test_bad_arguments_of_one_use_offer_no_fix_of_the_definition() -> None:
    text = f"{HEAD}let more(n) = coins > n\nspec s {{\n    keep more(3)\n    keep more(60)\n}}\n"
    (diagnostic,) = errors(SourceFile("a.tltl", text))
    assert (diagnostic.code, diagnostic.fixes) == ("TLT0310", ())


def test_a_fix_inserts_a_space_between_two_words() -> None:
    with pytest.raises(TltlError):
        tltlc.compile_text(f"{HEAD}spec s = a|~b")
    ((_, fix),) = all_fixes(SourceFile("a.tltl", f"{HEAD}spec s = a|~b"))
    assert fix.title == "Write `not`"
    assert fix.edits[0].text == "not "


def test_a_fix_that_keeps_the_meaning_is_safe() -> None:
    for clause, applicability in (("keep coins < 0", "safe"), ("keep aliev", "maybe")):
        ((_, fix),) = all_fixes(in_spec(clause))
        assert fix.applicability == applicability


OPPOSITES = [
    *(("seen", f"{word}seen") for word in ("un", "not", "not_", "non", "no_", "never_", "isnt_", "dis", "in")),
    ("locked", "unlocked"),
    ("active", "inactive"),
    ("legal", "illegal"),
    ("possible", "impossible"),
    ("enabled", "disabled"),
    ("increasing", "decreasing"),
    ("has_key", "has_no_key"),
    ("is_open", "is_not_open"),
    ("is_open", "isnt_open"),
    ("enemy_near", "enemy_not_near"),
    ("min_speed", "max_speed"),
    ("left_door", "right_door"),
    ("red_open", "red_closed"),
    ("near_key", "far_key"),
    ("door_1", "door_2"),
    ("door1", "door12"),
    ("playerSeen", "playerUnseen"),
    ("guardAwake", "guardAsleep"),
    ("north", "south"),
    ("north_gate", "south_gate"),
    ("near_east", "near_west"),
    ("eastDoor", "westDoor"),
    ("firstkey", "lastkey"),
    ("doorA", "doorB"),
    ("keya", "keyb"),
    ("posX", "posY"),
    ("xpos", "ypos"),
    ("red_hp", "rod_hp"),
    ("levelI", "levelII"),
    ("locked", "blocked"),
    ("start", "restart"),
    ("opened", "reopened"),
    ("health", "half"),
]


@pytest.mark.parametrize(("known", "other"), [*OPPOSITES, *((b, a) for a, b in OPPOSITES)])
def test_a_name_of_opposite_meaning_is_no_misspelling(known: str, other: str) -> None:
    source = SourceFile("a.tltl", f"signal {known}: bool\nspec s {{ keep {other} }}\n")
    # The fix declares the name, or imports the library that has it.
    assert not [fix.title for _, fix in all_fixes(source) if fix.title.startswith("Write")]


@pytest.mark.parametrize("other", ["sen", "seeen", "Seen", "sene", "eseen"])
def test_a_misspelt_name_is_corrected(other: str) -> None:
    ((_, fix),) = all_fixes(SourceFile("a.tltl", f"signal seen: bool\nspec s {{ keep {other} }}\n"))
    assert fix.title == "Write `seen`"


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("door_open", "dooropen"),
        ("playerSeen", "player_seen"),
        ("guardAwake", "guardAwke"),
        ("chest_opened", "chets_opened"),
        ("door2_open", "door2_opne"),
    ],
)
def test_a_misspelling_in_one_part_of_a_name_is_corrected(name: str, other: str) -> None:
    ((_, fix),) = all_fixes(SourceFile("a.tltl", f"signal {name}: bool\nspec s {{ keep {other} }}\n"))
    assert fix.title == f"Write `{name}`"


def test_no_correction_is_offered_between_two_likely_names() -> None:
    text = "signal swing: bool\nsignal sting: bool\nspec s { keep sing or swing or sting }\n"
    assert not [fix.title for _, fix in all_fixes(SourceFile("a.tltl", text)) if fix.title.startswith("Write")]


VERBS = """
leave live elevate lift target stage bag reveal lever flee list raid sleep deep retire quite race area read replace
teach beach stop
"""


@pytest.mark.parametrize("verb", VERBS.split())
def test_an_english_verb_is_no_misspelt_keyword(verb: str) -> None:
    assert not [fix.title for _, fix in all_fixes(in_spec(f"{verb} a")) if fix.title.startswith("Write")]


WORDS = """
off for around end stand other often there their these least raise reset please more work door form hand
"""


@pytest.mark.parametrize("clause", [*(f"keep a {word} b" for word in WORDS.split()), "keep away a", "keep anyway a"])
def test_an_english_word_is_no_misspelt_operator(clause: str) -> None:
    titles = [fix.title for _, fix in all_fixes(in_spec(clause)) if fix.title.startswith("Write")]
    # A name before another name may be a predicate with an argument.
    assert all("(" in title for title in titles)


@pytest.mark.parametrize("verb", ["reject", "repeat", "select", "stop", "store", "state", "sleep"])
def test_an_english_verb_is_no_misspelt_line_of_a_test(verb: str) -> None:
    text = f'signal a: bool\nspec s = F a\ntest "t" for s {{\n    step a\n    {verb} a\n}}\n'
    assert not [*all_fixes(SourceFile("a.tltl", text))]


def test_a_declaration_is_inserted_above_documentation() -> None:
    source = SourceFile("a.tltl", "/// Nobody sees.\n// TODO tune\n\nspec s = F a\n")
    (fix,) = (fix for _, fix in all_fixes(source) if fix.title.startswith("Declare"))
    assert apply_edits(source, fix.edits).text == f"signal a: bool\n{source.text}"


def test_a_plain_number_is_not_read_as_a_percentage() -> None:
    for declared, correction in (("hearts in [0, 1]", "false"), ("hearts: ratio", "hearts >= 3 %")):
        source = SourceFile("a.tltl", f"signal {declared}\nspec s {{ reach hearts >= 3 }}\n")
        ((_, fix),) = all_fixes(source)
        assert apply_edits(source, fix.edits).text == source.text.replace("hearts >= 3", correction)


@pytest.mark.parametrize(
    "text",
    [
        "clock 60 Hz\nsignal t: time in [0 s, 9 s]\nlet long(m: time = 3 min) = t > m\nspec s { reach long(5) }\n",
        "signal v: speed in [0 km/h, 200 km/h]\nspec s { reach v > 30 m }\n",
    ],
)
def test_a_number_may_have_a_unit_outside_the_si(text: str) -> None:
    assert not [*all_fixes(SourceFile("a.tltl", text))]


@pytest.mark.parametrize(
    "clause",
    ["keepnot a", "dontreach a", "neverreach a", "keep a andnot b", "require a untilnot b"],
)
def test_a_word_joined_with_a_negation_is_no_misspelt_keyword(clause: str) -> None:
    assert not [*all_fixes(in_spec(clause))]


def test_a_name_is_corrected_to_an_operator_only_if_the_first_letters_agree() -> None:
    assert [fix.title for _, fix in all_fixes(in_spec("reach exit a"))] == ["Write `exit(a)`"]
    assert [fix.title for _, fix in all_fixes(in_spec("require nxt a"))] == ["Write `next`"]


@pytest.mark.parametrize(
    "clause",
    ["reach a // why\n, b", "keep (a == // why\n true)", "reach a, b // why\n, c"],
)
def test_no_comment_is_dropped(clause: str) -> None:
    assert not [*all_fixes(in_spec(clause))]
    assert [*all_fixes(in_spec(clause.replace("// why", "")))]


@pytest.mark.parametrize(
    ("declared", "unit"),
    [("length in [0 {}, 5 {}]", unit) for unit in ("m", "km", "cm")]
    + [("time in [0 {}, 500 {}]", unit) for unit in ("s", "ms", "min")]
    + [("speed in [0 {}, 50 {}]", unit) for unit in ("m/s", "km/h", "m/min")],
)
def test_a_missing_unit_is_added_only_if_si_units_are_declared(declared: str, unit: str) -> None:
    text = f"signal it: {declared.replace('{}', unit)}\nspec s {{ reach it > 3 }}\n"
    titles = [fix.title for _, fix in all_fixes(SourceFile("a.tltl", text))]
    assert titles == ([f"Write `3 {unit}`"] if unit in ("m", "s", "m/s") else [])
