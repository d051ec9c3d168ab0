"""The layout, in examples of a source text and its formatted text."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.tools.fmt.laws import check
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.tools.fmt import format_text

ROOT = Path(__file__).parents[3]

CASES = {
    "spaces": (
        'import   "a.tltl"  import b(c,d)import e as f signal g(h:entity,i):length in[-1m,inf]signal j in[0,1]',
        'import "a.tltl"\nimport b (c, d)\nimport e as f\nsignal g(h: entity, i): length in [-1 m, inf]\n'
        "signal j in [0, 1]\n",
    ),
    "arithmetic": (
        "predicate p(x:length=1m)in[-1,1]=-a*2-(b+-3)/x^-2+20 m / s  predicate q=9.81 m / s^2*t",
        "predicate p(x: length = 1 m) in [-1, 1] = -a * 2 - (b + -3) / x^-2 + 20 m/s\npredicate q = 9.81 m/s^2 * t\n",
    ),
    "cases, always on lines of their own": (
        "predicate p = when a<1: 2 otherwise: min((when b: 1 otherwise: 2), 3)",
        "predicate p =\n    when a < 1: 2\n    otherwise:  min((when b: 1 otherwise: 2), 3)\n",
    ),
    "a block on one line": (
        'spec s{reach a then b keep c}\n\n\n\ntest "t" for s{step 3 x a,not b expect progress>=50%}test""for s{\n}',
        "spec s { reach a then b keep c }\n\n"
        'test "t" for s { step 3x a, not b expect progress >= 50 % }\ntest "" for s {\n}\n',
    ),
    "empty lines": (
        "\n\nspec s {\n\n\n    level x\n    tag a,b\n\n\n\n    judge at\n goal\n    limit 3 s\n keep p\n\n}\n\n\n",
        "spec s {\n    level x\n    tag a, b\n\n    judge at goal\n    limit 3 s\n    keep p\n}\n",
    ),
    "comments of a block": (
        "// head\n\n/// doc\nspec s { // behind the brace\n\n// above\n keep a // behind\n\n//last\n\n}// end",
        "// head\n\n/// doc\nspec s {  // behind the brace\n    // above\n"
        "    keep a  // behind\n\n    //last\n}  // end\n",
    ),
    "comments in an empty block": (
        'test "" for s { // nothing\n // yet\n }',
        'test "" for s {  // nothing\n    // yet\n}\n',
    ),
    "comments behind lines in one column": (
        "signal a: bool // one\nsignal long_name: bool // two\n\nsignal b: bool // three",
        "signal a: bool          // one\nsignal long_name: bool  // two\n\nsignal b: bool  // three\n",
    ),
    "comments behind operators and commas": (
        "spec s = a and // one\n b // two\n and // three\n c\nentity x, // x\n y // y\n , z",
        "spec s =\n    a      // one\n    and b  // two\n    // three\n    and c\n"
        "entity x,  // x\n    y,     // y\n    z\n",
    ),
    "comments in brackets and cases": (
        "spec s = F ( // open\n a // a\n // close\n)\n"
        "predicate p = when a: // one\n 1 // two\n // else\n otherwise: 2 // three",
        "spec s =\n    eventually (  // open\n        a  // a\n        // close\n    )\n"
        "predicate p =\n    when a:  // one\n        1  // two\n    // else\n    otherwise: 2  // three\n",
    ),
    "a brace on a line of its own": (
        "spec s // why\n{\n keep a }",
        "spec s {  // why\n    keep a\n}\n",
    ),
    "a documentation comment before a brace documents no clause": (
        "spec s /// why\n{\n keep a }",
        "spec s  /// why\n    {\n    keep a\n}\n",
    ),
    "windows": ("\ufeffsignal a: bool\r\n\r\n\r\n// b\r\n", "signal a: bool\n\n// b\n"),
    "nothing": ("\n \n", ""),
}


@pytest.mark.parametrize("case", CASES)
def test_each_example_is_laid_out_as_expected(case: str) -> None:
    text, expected = CASES[case]
    assert check(text, "words") == expected


LONG = "a_name_of_thirty_characters_at"


def test_long_expressions_break_at_their_weakest_operators() -> None:
    text = f"spec s {{ require {LONG} and {LONG} or not {LONG} and p until {LONG} implies all x in (a, b): near(x) }}"
    assert check(text, "letters") == (
        "spec s {\n"
        "    require\n"
        f"        {LONG} & {LONG}\n"
        f"            | !{LONG} & p U {LONG}\n"
        "        -> all x in (a, b): near(x)\n"
        "}\n"
    )


def test_long_parts_in_brackets_get_lines_of_their_own() -> None:
    text = (
        f"spec s = G({LONG} -> F(f({LONG}, {LONG}, {LONG}, p) & p)) & clamp(min({LONG}, {LONG}, x - {LONG}), -1, 1) > 0"
    )
    assert check(text, "symbols") == (
        "spec s =\n"
        "    [](\n"
        f"        {LONG}\n"
        "        -> <>(\n"
        "            f(\n"
        f"                {LONG},\n"
        f"                {LONG},\n"
        f"                {LONG},\n"
        "                p\n"
        "            )\n"
        "            & p\n"
        "        )\n"
        "    )\n"
        "    & clamp(min(\n"
        f"        {LONG},\n"
        f"        {LONG},\n"
        f"        x - {LONG}\n"
        "    ), -1, 1)\n"
        "        > 0\n"
    )


def test_a_line_ending_in_brackets_leaves_room_for_the_rest() -> None:
    text = f"predicate p = clamp(min({LONG}, {LONG}, 1 - a * a_b_c), -1 + {LONG}, 1)"
    assert max(map(len, check(text, "words").split("\n"))) <= 100
    short = LONG[:20]
    assert check(f"predicate p = clamp(min({LONG}, {LONG}, {short}), -1, 1)", "words") == (
        f"predicate p =\n    clamp(min(\n        {LONG}, {LONG}, {short}\n    ), -1, 1)\n"
    )


def test_long_heads_and_lists_are_broken() -> None:
    text = f"entity {', '.join([LONG] * 4)}\npredicate p({LONG}: length, {LONG}: length, {LONG}: length) in [0, 1] = 1"
    assert check(text, "words") == (
        f"entity {LONG}, {LONG},\n"
        f"    {LONG}, {LONG}\n"
        "predicate p(\n"
        f"    {LONG}: length,\n"
        f"    {LONG}: length,\n"
        f"    {LONG}: length\n"
        ") in [0, 1] = 1\n"
    )


def test_the_example_of_the_guide_is_in_the_standard_layout() -> None:
    page = (ROOT / "docs" / "guides" / "formatting.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"^```tltl\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    assert check(example, "words") == example


@pytest.mark.parametrize(
    "text",
    [
        "spec s = " + "!" * 900 + "a",
        "spec s = " + "(" * 199 + "a" + ")" * 199,
        "spec s = " + "(a -> b | c & !" * 199 + "a" + ")" * 199,
        "spec s = " + " & ".join(["a"] * 900),
        "spec s = " + "all x in (a): " * 400 + "b",
        "predicate p = " + "^".join(["2"] * 900),
    ],
    ids=lambda text: text[:25],
)
def test_deeply_nested_texts_are_formatted(text: str) -> None:
    formatted = format_text(text)
    assert len(formatted) < 1 << 17
    assert format_text(formatted) == formatted


def test_a_text_with_errors_is_rejected() -> None:
    with pytest.raises(TltlError) as failure:
        format_text("spec s = F (\nspec t { keep }")
    assert [diagnostic.code for diagnostic in failure.value.diagnostics] == ["TLT0101", "TLT0101"]
