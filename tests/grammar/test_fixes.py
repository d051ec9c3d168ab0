"""The fixes of syntax errors: applying one leaves no error, and gives the intended text."""

from __future__ import annotations

import pytest

from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.tools.lint.scopes import apply_edits


def fixed_text(text: str) -> str:
    """Apply the first fix of the only error in a text, and assert that no error is left."""
    source = SourceFile("a.tltl", text)
    _, (diagnostic,) = parse(source)
    fixed = apply_edits(source, diagnostic.fixes[0].edits)
    assert not parse(fixed)[1]
    return fixed.text


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        # A condition.
        ("reach if a then b", "reach a and b"),
        ("reach a when b", "reach a and b"),
        ("reach a then b while c", "reach a then b and c"),
        ("reach a and b while c", "reach (a and b) and c"),
        ("keep if p(x) q(y)", "keep p(x) implies q(y)"),
        ("keep if not a, b", "keep not a implies b"),
        ("keep a or b while c", "keep c implies (a or b)"),
        ("avoid a when b", "avoid a and b"),
        ("require (a if b) and c", "require (b implies a) and c"),
        ("if a then reach b", "keep a implies eventually b"),
        ("when a: b", "keep a implies b"),
        ("reach a without b", "reach a avoid b"),
        ("require a without b", "require a and not b"),
        # An order.
        ("reach a after b", "reach b then a"),
        ("reach a and then b", "reach a then b"),
        ("reach a followed by b", "reach a then b"),
        ("avoid a before b", "require (not a) weak_until b"),
        ("avoid p(x) before c", "require (not p(x)) weak_until c"),
        ("avoid a after b", "require always (b implies always not a)"),
        ("keep not a before b", "require not a weak_until b"),
        ("keep once a before b", "keep b implies once a"),
        ("keep a after b", "keep b implies always a"),
        ("keep a unless b", "keep a or b"),
        ("avoid a unless b", "avoid a and not b"),
        ("require a unless b", "require a weak_until b"),
        # A time.
        ("reach a within 20 steps", "require eventually within 20 steps a"),
        ("reach a and b in 5 seconds", "require eventually within 5 s (a and b)"),
        ("reach begins a then b within 20 steps", "reach begins a then within 20 steps b"),
        ("reach a then in 20 steps b", "reach a then within 20 steps b"),
        ("reach once a within 20 steps", "reach once within 20 steps a"),
        ("keep b implies once a within 8 s", "keep b implies once within 8 s a"),
        ("keep b implies historically a for 8 s", "keep b implies historically for 8 s a"),
        ("reach a then b for 20 steps", "reach a then (always for 20 steps b) and next after 19 steps b"),
        ("reach a for 20 steps", "reach (always for 20 steps a) and next after 19 steps a"),
        ("reach a then b after 3 steps", "reach a and next after 3 steps eventually b"),
        ("reach a before 30 s", "require eventually within 30 s a"),
        ("reach within 20 steps a", "require eventually within 20 steps a"),
        ("reach a then after 5 steps b", "reach a and next after 5 steps eventually b"),
        ("avoid a within 3 steps", "require not eventually within 3 steps a"),
        ("avoid a after 3 steps", "require weak_next after 3 steps always not a"),
        ("keep a after 3 steps", "require weak_next after 3 steps always a"),
        ("keep a followed by b", "keep a implies next eventually b"),
        ("require a and if b, c", "require a and (b implies c)"),
        ("reach if a then b then c", "reach a and b then c"),
        ("reach a after 3 steps", "require next after 3 steps eventually a"),
        ("keep a implies b within 20 steps", "keep a implies eventually within 20 steps b"),
        ("keep a implies b for 20 steps", "keep a implies always for 20 steps b"),
        ("require always (a -> b for 20 steps)", "require always (a -> always for 20 steps b)"),
        ("require eventually within 20 a", "require eventually within 20 steps a"),
        # A clause in a formula, a formula for a clause.
        ("keep a implies reach b", "keep a implies eventually b"),
        ("keep a implies reach b then c", "keep a implies eventually (b then c)"),
        ("reach a then reach b", "reach a then b"),
        ("keep a or keep b", "require (always a) or (always b)"),
        ("keep a and keep b", "keep a keep b"),
        ("always a", "keep a"),
        ("F a", "reach a"),
        ("! a", "avoid a"),
        ("always for 3 steps a", "require always for 3 steps a"),
        ("never a", "avoid a"),
        ("avoids a", "avoid a"),
        ("- reach a", "reach a"),
        ("1. reach a", "reach a"),
        ("reach: a", "reach a"),
        # A limit.
        ("400 steps limit", "limit 400 steps"),
        ("timeout 400 steps", "limit 400 steps"),
        ("limit to at most 400 steps", "limit 400 steps"),
        ("limit of 400 steps", "limit 400 steps"),
        ("limit = 20 seconds", "limit 20 s"),
        ("limits 400 steps", "limit 400 steps"),
        ("judge goal", "judge at goal"),
        # Signs.
        ("reach a, b", "reach a then b"),
        ("keep a, b", "keep a and b"),
        ("avoid a, b", "avoid a or b"),
        ("reach a, then b", "reach a then b"),
        ("reach a, b or c, p(x, y)", "reach a then b or c then p(x, y)"),
        ("avoid a, b or c", "avoid a or (b or c)"),
        ("keep a, reach b", "keep a reach b"),
        ("keep a <> 3", "keep a < 3 or a > 3"),
        ("keep 3 < a < 4", "keep 3 < a and a < 4"),
        ("keep a => 3", "keep a >= 3"),
        ("keep a => b", "keep a implies b"),
        ("keep a > 2,5", "keep a > 2.5"),
        ("keep a > .5", "keep a > 0.5"),
        ("keep a × 2 > 3", "keep a * 2 > 3"),
        ("keep a is false", "keep not a"),
        ("keep p(x) is true", "keep p(x)"),
        ("keep p(x) is not true and a", "keep not p(x) and a"),
        ("keep a is more than 3", "keep a > 3"),
        ("keep a at least 3", "keep a >= 3"),
        ("keep a below 3 m/s", "keep a < 3 m/s"),
        ("reach the exit", "reach exit"),
        ("keep NOT a", "keep not a"),
        ("keep a AND b", "keep a and b"),
        ("keep a or or b", "keep a or b"),
        ("keep a not b", "keep a and not b"),
        ("keep FG a", "keep F G a"),
        # Brackets and quotes.
        ("reach p[x]", "reach p(x)"),
        ("keep {a or b} and c", "keep (a or b) and c"),
        ("keep a()", "keep a"),
        ("keep p x", "keep p(x)"),
        ("reach p door then b", "reach p(door) then b"),
        ("keep p hand", "keep p(hand)"),
        ("keep p(x, y 3)", "keep p(x, y = 3)"),
        ("keep p(x, y: 3)", "keep p(x, y = 3)"),
        ("keep p(x y = 3)", "keep p(x, y = 3)"),
        ("reach “p(x)”", "reach p(x)"),
        ("reach p('x')", "reach p(x)"),
        ('reach "a"', "reach a"),
        ("keep è", "keep e"),
    ],
)
def test_the_fix_of_a_clause_gives_the_intended_clause(clause: str, meant: str) -> None:
    text = "spec s {{\n    {}\n    keep last\n}}\n"
    assert fixed_text(text.format(clause)) == text.format(meant)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("entity a b", "entity a, b"),
        ("entity a; b", "entity a, b"),
        ("entity 2nd", "entity _2nd"),
        ("entity my-door", "entity my_door"),
        ("signal a in (0, 3)", "signal a in [0, 3]"),
        ("signal a in [0 3]", "signal a in [0, 3]"),
        ("signal a [0, 3]", "signal a in [0, 3]"),
        ("signal at(entity): bool", "signal at(x: entity): bool"),
        ("clock 20 fps", "clock 20 Hz"),
        ("spec s = keep a", "spec s { keep a }"),
        ("spec s = { keep a }", "spec s { keep a }"),
        ('spec "my spec" = G a', "spec my_spec = G a"),
        ("spec s = if a then b", "spec s = a implies b"),
        ("let l = avoid a", "let l = always not a"),
        ("test “t” for s { step a }", 'test "t" for s { step a }'),
        ("object a", "entity a"),
    ],
)
def test_the_fix_of_a_declaration_gives_the_intended_declaration(text: str, meant: str) -> None:
    assert fixed_text(f"{text}\nentity last\n") == f"{meant}\nentity last\n"


@pytest.mark.parametrize(
    ("text", "renamed"),
    [
        (
            "signal once: bool\nspec s { keep once and not once }",
            "signal once_: bool\nspec s { keep once_ and not once_ }",
        ),
        (
            "signal ends in [0, 1] signal ends_: bool spec s = F ends > 0.5",
            "signal ends_2 in [0, 1] signal ends_: bool",
        ),
        (
            "entity e predicate begins(x: entity) = 1 spec s = F begins(e)",
            "predicate begins_(x: entity) = 1 spec s = F begins_(e)",
        ),
        (
            'signal once: bool spec s = F once test "t" for s { step once expect satisfied }',
            "step once_ expect satisfied",
        ),
    ],
)
def test_a_name_that_became_a_word_is_renamed_in_the_whole_file(text: str, renamed: str) -> None:
    source = SourceFile("a.tltl", text)
    error, *_ = parse(source)[1]
    assert (error.code, len(error.fixes)) == ("TLT0106", 1)
    fixed = apply_edits(source, error.fixes[0].edits)
    assert not parse(fixed)[1]
    assert renamed in fixed.text


@pytest.mark.parametrize("use", ["once a", "once (a)", "once within 3 steps a", "once not a"])
def test_a_word_that_is_an_operator_elsewhere_is_not_renamed(use: str) -> None:
    error, *_ = parse(SourceFile("a.tltl", f"signal once: bool signal a: bool spec s = {use}"))[1]
    assert (error.code, error.fixes) == ("TLT0106", ())
