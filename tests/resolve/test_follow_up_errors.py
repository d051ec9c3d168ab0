"""Errors in types and names are reported beside syntax errors, unless the syntax errors may explain them."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.interfaces.lsp.texts import open_text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.grammar.lexer import Token, tokenize
from tltlc.interfaces.playground.page_data import view
from tltlc.pipeline import CompileOptions, Session

ROOT = Path(__file__).parents[2]
TEXTS = {
    path: path.read_text(encoding="utf-8")
    for folder in ("examples", "stdlib_predicates")
    for path in sorted((ROOT / folder).rglob("*.tltl"))
    if path.stat().st_size < 5_000
}

GOOD = """\
signal seen: bool
signal health in [0, 1]
spec leave { reach health > 0.5 }
"""


def errors(text: str, options: CompileOptions | None = None) -> list[tuple[str, str]]:
    """Return the code of each error of a text, and what its first label covers."""
    with pytest.raises(TltlError) as raised:
        assert Session(SourceFile("game.tltl", text), options).automata
    diagnostics = raised.value.diagnostics
    return [(error.code, error.labels[0].source.slice(error.labels[0].span)) for error in diagnostics if error.labels]


def test_errors_in_other_specs_are_reported_in_the_order_of_the_text() -> None:
    text = (
        GOOD + "spec a { keep sene }\nspec b {\n    reach seen than\n    avoid health\n}\nspec c { avoid health > 3 }\n"
    )
    assert errors(text) == [
        ("TLT0201", "sene"),
        ("TLT0101", "seen than"),
        ("TLT0301", "health"),
        ("TLT0310", "health > 3"),
    ]


def test_the_language_server_and_the_playground_report_them_too() -> None:
    text = GOOD + "spec a { keep sene }\nspec b { reach seen than }\nspec c { avoid health > 3 }\n"
    expected = ["TLT0201", "TLT0101", "TLT0310"]
    document, _, _ = open_text(text)
    assert [diagnostic.code for diagnostic in document.diagnostics] == expected
    assert [diagnostic["code"] for diagnostic in view(text)["diagnostics"]] == expected


@pytest.mark.parametrize(
    "broken",
    [
        "signal loud bool",
        "singal loud: bool",
        "signal : bool",
        "signal",
        "var loud = 3",
        "signal quiet, loud: bool",
        "predicate loud(x: entity = 3",
        "let loud ==",
        'import "loud.tltl',
        "import stealth (",
        "imprt stealth",
        "loud: bool",
        "signal a: bool { signal loud: bool",
    ],
)
def test_names_that_a_broken_declaration_may_declare_are_not_reported(broken: str) -> None:
    assert not [code for code, _ in errors(f"{GOOD}{broken}\nspec a {{ keep loud }}\n") if code == "TLT0201"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("clok 2 Hz\nspec a { reach within 2 s seen }", "TLT0313"),
        ("clock 2 Hzz\nspec a { reach within 2 s seen }", "TLT0313"),
        ('spec {\n reach seen }\ntest "t" for a { step seen expect satisfied }', "TLT0208"),
        (
            'spec a {\n keep seen\n reach then health > 0.5 }\ntest "t" for a { step health > 0.5\n expect holding }',
            "TLT0209",
        ),
        ('spec a { keep seen }\ntest "t" for a {\n step seen\n expct holding\n}', "TLT0217"),
        ("import spatial\nentity x\npredicate near(a: entity, b = ] 2\nspec a { reach near(x, x) }", "TLT0210"),
        ("entity a, , door\nsignal at(e: entity): bool\nspec s { reach at(key) }", "TLT0201"),
    ],
)
def test_consequences_of_syntax_errors_are_not_reported(text: str, code: str) -> None:
    assert code not in [found for found, _ in errors(f"signal seen: bool\nsignal health in [0, 1]\n{text}\n")]


def test_a_param_that_an_option_sets_may_be_in_the_broken_part() -> None:
    options = CompileOptions(params={"most": "3"})
    assert errors("param most == 2\nspec a { keep true }\n", options) == [("TLT0110", "==")]


def _damaged(token: Token, text: str, word: str, at: Path) -> Session:
    return Session(
        SourceFile(str(at), f"{text[: token.start]} {word} {text[token.end :]}"), CompileOptions(), proofs=False
    )


@settings(max_examples=150)
@given(data=st.data())
def test_damage_to_one_token_of_a_correct_text_gives_only_syntax_errors(data: st.DataObject) -> None:
    path = data.draw(st.sampled_from([*TEXTS]))
    text = TEXTS[path]
    tokens = [token for token in tokenize(text).tokens[:-1] if token.type not in ("LBRACE", "RBRACE")]
    token = data.draw(st.sampled_from(tokens))
    session = _damaged(
        token, text, data.draw(st.sampled_from(["", "then", "(", "zork", f"{token.text} {token.text}"])), path
    )
    if any(error.severity == "error" for error in session.syntax_errors):
        with pytest.raises(TltlError) as raised:
            assert session.program
        assert {*raised.value.diagnostics} == {*session.syntax_errors}
