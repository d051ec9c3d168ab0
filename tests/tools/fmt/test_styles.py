"""The four styles: their spellings of operators and bounds. A formula means the same in each."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.calls import calls
from tests.tools.fmt.laws import check
from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.io.project import FORMATTINGS
from tltlc.pipeline import compile_text
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.resolution import resolve
from tltlc.tools.fmt import STYLES, format_text

ROOT = Path(__file__).parents[3]
OPERATORS = (
    "(eventually a) and not always b or next c iff weak_next d implies true until false weak_until a release b "
    "strong_release c <= 3"
)

BOUNDS = [
    ("eventually within 20 steps p", "F[0,20] p", "<>[0,20] p", "◇[0,20] p"),
    ("eventually within 1 step p", "F[0,1] p", "<>[0,1] p", "◇[0,1] p"),
    ("eventually within 2 s (p)", "F within 2 s (p)", "<> within 2 s (p)", "◇ within 2 s (p)"),
    ("always for 20 steps not p", "G[0,19] !p", "[][0,19] !p", "□[0,19] ¬p"),
    ("always for 1 step p", "G[0,0] p", "[][0,0] p", "□[0,0] p"),
    ("always for 2 s p", "G for 2 s p", "[] for 2 s p", "□ for 2 s p"),
    ("next after 3 steps p", "X after 3 steps p", "X after 3 steps p", "○ after 3 steps p"),
    ("weak_next after 1 s (p)", "N after 1 s (p)", "N after 1 s (p)", "N after 1 s (p)"),
    ("F[2,3] p", "F[2,3] p", "<>[2,3] p", "◇[2,3] p"),
    ("G[1 s, 2 s] (p)", "G[1 s, 2 s](p)", "[][1 s, 2 s](p)", "□[1 s, 2 s](p)"),
    ("once within 3 steps p", "once within 3 steps p", "once within 3 steps p", "once within 3 steps p"),
    *[(past, past, past, past) for past in ("historically for 2 s (p)", "previously (p)", "begins p", "ends once p")],
    ("p since not p", "p since !p", "p since !p", "p since ¬p"),
    ("G[0,2 s] p", "G[0,2 s] p", "[][0,2 s] p", "□[0,2 s] p"),
]
"""Bounds in words, letters, symbols and Unicode. The four texts of a row are the same formula."""


def formula(text: str) -> object:
    source = f"clock 3 Hz  signal p: bool  spec s = {text}"
    module, diagnostics = parse(SourceFile("a", source))
    assert not diagnostics
    result = resolve(module, ResolveOptions())
    program, diagnostics = result.program, result.diagnostics
    assert not diagnostics
    return program.specs[0].formula


def test_the_styles_equal_those_of_the_project_file() -> None:
    assert tuple(STYLES) == FORMATTINGS


@pytest.mark.parametrize(
    "style, expected",
    [
        ("words", OPERATORS),
        ("letters", "(F a) & !G b | X c <-> N d -> true U false W a R b M c <= 3"),
        ("symbols", "(<>a) & ![]b | X c <-> N d -> true U false W a R b M c <= 3"),
        ("unicode", "(◇a) ∧ ¬□b ∨ ○c ⇔ N d ⇒ ⊤ 𝒰 ⊥ W a R b M c ≤ 3"),
    ],
)
def test_operators_are_written_in_each_style(style: str, expected: str) -> None:
    text = format_text(f"spec s = {OPERATORS}", style)
    assert " ".join(text.split()) == f"spec s = {expected}"
    for other_style in STYLES:
        assert format_text(format_text(text, other_style), style) == text


@pytest.mark.parametrize("row", BOUNDS, ids=lambda row: row[0])
def test_bounds_are_written_in_each_style(row: tuple[str, ...]) -> None:
    for spelling in row:
        for style, expected in zip(STYLES, row, strict=True):
            assert check(f"spec s = {spelling}", style) == f"spec s = {expected}\n"
        assert formula(spelling) == formula(row[0])


@pytest.mark.parametrize(("style", "expected"), [*zip(STYLES, BOUNDS[2], strict=True)])
def test_a_time_from_now_on_is_in_words_in_each_style(style: str, expected: str) -> None:
    # Brackets need a fixed clock, and the clock may be declared in another file.
    assert check("spec s = F[0,2 s] (p)", style) == f"spec s = {expected}\n"
    assert formula("F[0,2 s] (p)") == formula(expected)


@pytest.mark.parametrize(
    "name", ["x", "in", "at", "as", "for", "within", "after", "since", "step", "expect", "s", "m", "steps"]
)
@pytest.mark.parametrize("style", STYLES)
def test_a_contextual_keyword_can_be_a_name_in_each_style(name: str, style: str) -> None:
    text = (
        f"signal {name}: bool\n"
        f"spec a = F {name} & G[0,3] {name} & !X {name} & {name} U F within 2 steps {name}\n"
        f'test "t" for a {{ step 3x {name} step {name} expect pending }}\n'
    )
    assert [fspa.formula for fspa in compile_text(check(text, style))] == [fspa.formula for fspa in compile_text(text)]


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.tltl")), ids=lambda path: path.name)
def test_formatted_examples_compile_to_the_same_automata(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    before = compile_text(text)
    for style in STYLES:
        assert compile_text(format_text(text, style)) == before


def test_formatting_costs_less_than_two_parses() -> None:
    names = ("branching", "platformer", "puzzle", "racing", "robot_sorting")
    text = "".join((ROOT / "examples" / f"{name}.tltl").read_text(encoding="utf-8") for name in names) * 2
    assert text.count("\n") > 400

    format_text(text)  # Warm up: read the tables of the grammar.
    # Measured: 1.37.
    assert calls(lambda: format_text(text)) < 2 * calls(lambda: parse(SourceFile("a", text)))
