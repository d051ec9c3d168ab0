"""The Pygments lexer colours every word and sign of the grammar, and loses no character of a text."""

from __future__ import annotations

import sys
from importlib import import_module

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pygments import token as pygments

from tests.interfaces.cli.conftest import ROOT
from tltlc.grammar import keywords as words
from tltlc.grammar.pygments_lexer import CLASSES, TltlLexer
from tltlc.grammar.tables import load

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FILES = sorted(
    [*(ROOT / "examples").glob("*.tltl"), *(ROOT / "stdlib_predicates").glob("*.tltl"), *ROOT.glob("tests/*/*.tltl")]
)
WORDS = [
    *load().words,
    *load().soft,
    *load().signs,
    *load().units,
    "name",
    "3.5",
    '"text"',
    "// note\n",
    "/// doc\n",
    " ",
]


def classes(text: str) -> list[tuple[str, str]]:
    """Return the visible tokens of a text, each with its class."""
    pieces = TltlLexer().get_tokens_unprocessed(text)
    return [(piece, str(kind).removeprefix("Token.")) for _, kind, piece in pieces if piece.strip()]


def test_every_terminal_of_the_grammar_has_a_class() -> None:
    tables = load()
    terminals = {*tables.words.values(), *tables.soft.values(), *tables.signs.values(), *tables.patterns, "UNIT", "BAD"}
    assert set(CLASSES) == terminals - {"SPACE"}


def test_every_declaration_and_clause_is_a_keyword() -> None:
    for word in (*words.DECLARATIONS, *words.CLAUSES):
        assert CLASSES[load().words[word]] in pygments.Keyword, word


def test_every_spelling_of_an_operator_is_an_operator() -> None:
    known = load()
    for spelling, terminal in {**known.words, **known.signs}.items():
        if CLASSES[terminal] is pygments.Operator:
            word = spelling.isascii() and spelling[0].isalpha()
            assert classes(f"a {spelling} b")[1] == (spelling, "Operator.Word" if word else "Operator")


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_no_valid_source_has_an_error_token(file) -> None:  # type: ignore[no-untyped-def]
    text = file.read_text(encoding="utf-8")
    assert "Error" not in {kind for _, kind in classes(text)}


@given(
    st.one_of(st.text(), st.lists(st.sampled_from(WORDS)).map(" ".join), st.lists(st.sampled_from(WORDS)).map("".join))
)
def test_no_letter_is_lost(text: str) -> None:
    pieces = [*TltlLexer().get_tokens_unprocessed(text)]
    assert "".join(piece for _, _, piece in pieces) == text
    assert all(text.startswith(piece, start) for start, _, piece in pieces)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("signal at(x: entity): length in [0 m, 3 m]", {"at": "Name.Function", "x": "Name", "in": "Keyword"}),
        ("signal at(x: entity): length in [0 m, 3 m]", {"entity": "Keyword.Type", "length": "Keyword.Type"}),
        ("spec s { judge at goal  reach at(door) }", {"s": "Name.Class", "goal": "Name.Constant", "door": "Name"}),
        ("spec s = F within 20 steps p & step", {"within": "Keyword", "steps": "Keyword.Type", "step": "Name"}),
        (
            'test "t" for s { step 3x x  expect pending }',
            {"for": "Keyword", "step": "Keyword", "pending": "Name.Constant"},
        ),
        ("predicate p = when seen: within otherwise: in", {"seen": "Name", "within": "Name", "in": "Name"}),
        ("/// Doc.\n// No doc.\nspec s = true", {"/// Doc.": "Literal.String.Doc", "// No doc.": "Comment.Single"}),
        ("spec s = a == ö", {"==": "Operator", "ö": "Error"}),
        ("signal is: (is, alert)\nspec s = F is is is", {"is": "Name"}),
        ("spec s = mode is not alert", {"is": "Keyword", "alert": "Name"}),
    ],
)
def test_the_class_of_a_word_depends_on_its_place(text: str, expected: dict[str, str]) -> None:
    tokens = classes(text)
    assert {piece: kind for piece, kind in tokens if piece in expected} == expected


def test_a_text_beyond_the_limit_is_shown_without_colours(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.grammar.lexer.MAX_TOKENS", 2)
    assert classes("spec s = F a")[-1] == (" = F a", "Text")


def test_pygments_finds_the_lexer() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    (entry,) = project["entry-points"]["pygments.lexers"].values()
    module, _, name = entry.partition(":")
    assert getattr(import_module(module), name) is TltlLexer
    assert (TltlLexer.aliases, TltlLexer.filenames) == (["tltl"], ["*.tltl"])
