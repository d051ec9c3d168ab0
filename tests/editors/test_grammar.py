"""The extension's TextMate grammar covers every word and sign of tltl.lark."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.golden.cases import sources
from tltlc.core.source import SourceFile
from tltlc.grammar.keywords import CLAUSES, DECLARATIONS, VERDICTS
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.parser import parse
from tltlc.grammar.tables import load
from tltlc.resolve.scope import FUNCTIONS, MEMORY_FUNCTIONS
from tltlc.resolve.units import TYPES

ROOT = Path(__file__).parents[2]
EXTENSION = ROOT / "editors" / "vscode"
GRAMMAR = json.loads((EXTENSION / "syntaxes" / "tltl.tmLanguage.json").read_text(encoding="utf-8"))
SOURCES = sorted([*(ROOT / "examples").glob("*.tltl"), *(ROOT / "stdlib_predicates").glob("*.tltl")])

SCOPES = {
    **dict.fromkeys(map(str.upper, DECLARATIONS), "keyword.declaration"),
    **dict.fromkeys(map(str.upper, CLAUSES), "keyword.control"),
    **dict.fromkeys(["ALL", "ANY", "WHEN", "OTHERWISE"], "keyword.control"),
    **dict.fromkeys(["TRUE", "FALSE"], "constant.language"),
    **dict.fromkeys(["LESS", "AT_MOST", "MORE", "AT_LEAST", "EQUALS", "UNEQUAL"], "keyword.operator.comparison"),
    **dict.fromkeys(["PLUS", "MINUS", "TIMES_SIGN", "DIVIDE", "POWER"], "keyword.operator.arithmetic"),
    "EQUAL": "keyword.operator.assignment",
    **dict.fromkeys(["COLON", "COMMA"], "punctuation.separator"),
    **dict.fromkeys(["LPAR", "RPAR", "LBRACE", "RBRACE", "LSQB", "RSQB"], "punctuation.bracket"),
}
"""The scope of each terminal. All other terminals are operators of formulas."""


def rules(patterns: list[dict[str, object]]) -> Iterator[dict[str, object]]:
    """Yield the rules of the grammar in the order in which they are tried."""
    for pattern in patterns:
        if "include" in pattern:
            yield from rules(GRAMMAR["repository"][str(pattern["include"])[1:]]["patterns"])
        else:
            yield pattern


RULES = [(re.compile(str(rule["match"])), rule) for rule in rules(GRAMMAR["patterns"])]


def scopes(text: str) -> dict[int, tuple[str, str]]:
    """Return the scoped pieces of a text as an editor finds them: line by line, the earliest match
    first."""
    pieces = {}
    start = 0
    for line in text.splitlines(keepends=True):
        at = 0
        while at < len(line):
            matches = [
                (match.start(), order, match)
                for order, (pattern, _) in enumerate(RULES)
                if (match := pattern.search(line, at))
            ]
            if not matches:
                break
            _, order, match = min(matches, key=lambda candidate: candidate[:2])
            rule = RULES[order][1]
            captures = rule.get("captures", {"0": {"name": rule.get("name")}})
            assert isinstance(captures, dict)
            for group, scope in captures.items():
                piece = match.group(int(group))
                if piece and piece.strip():
                    blank = len(piece) - len(piece.lstrip())
                    pieces[start + match.start(int(group)) + blank] = (piece.strip(), scope["name"])
            at = max(match.end(), at + 1)
        start += len(line)
    return pieces


@pytest.mark.parametrize(("spelling", "terminal"), [*load().words.items(), *load().signs.items()])
def test_every_word_and_sign_has_its_scope(spelling: str, terminal: str) -> None:
    piece, scope = scopes(f"{spelling} ")[0]
    assert piece == spelling
    assert scope.startswith(SCOPES.get(terminal, "keyword.operator"))


@pytest.mark.parametrize("unit", load().units)
def test_every_unit_has_its_scope(unit: str) -> None:
    for space in ("", " "):
        assert scopes(f"x > 1.5{space}{unit}")[len(f"x > 1.5{space}")] == (unit, "keyword.other.unit.tltl")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        *((f"signal n: {type_}", (type_,)) for type_ in (*TYPES, "entity")),
        *((f"{function}(", (function,)) for function in (*FUNCTIONS, *MEMORY_FUNCTIONS)),
        *((f"expect {verdict}", ("expect", verdict)) for verdict in (*VERDICTS, "progress", "state")),
        ("judge at goal", ("at", "goal")),
        ("judge at limit", ("at", "limit")),
        ("clock varies", ("clock", "varies")),
        ("semantics infinite", ("infinite",)),
        ("import core as c", ("as",)),
        ("F within 3 steps p", ("within",)),
        ("G for 3 steps p", ("for",)),
        ("X after 3 steps p", ("after",)),
        ("a since b", ("since",)),
        ("(a) since (b)", ("since",)),
        ("once within 5 s p", ("once", "within")),
        ("in [0, 1]", ("in",)),
        ("all x in (a)", ("in",)),
        ("mode(g1) is alert", ("is",)),
        ("mode is not alert", ("is", "not")),
        ("step 3x a", ("step", "x")),
        ('test "t" for s {', ("for",)),
    ],
)
def test_contextual_keywords_have_a_scope(text: str, words: tuple[str, ...]) -> None:
    names = {piece for piece, scope in scopes(text).values() if not scope.startswith("variable.")}
    assert set(words) <= names


def test_all_contextual_keywords_are_tested() -> None:
    words = {"after", "as", "at", "expect", "for", "in", "is", "of", "since", "step", "varies", "x", "within"}
    assert words == set(load().soft)


@pytest.mark.slow
def test_real_files_are_split_like_the_compiler_splits_them() -> None:
    folders = ("examples", "stdlib_predicates", "tltlc", "runtime", "tests", "editors")
    count = 0
    files = {str(path): path.read_bytes() for folder in folders for path in (ROOT / folder).rglob("*.tltl")}
    for path, data in {**files, **sources()}.items():
        source = SourceFile(path, data.decode("utf-8", "replace"))
        _, syntax_errors = parse(source)
        if not syntax_errors:
            count += 1
            pieces = scopes(source.text)
            for token in tokenize(source.text).tokens[:-1]:
                assert pieces[token.start][0] == token.text, path
    assert count > 100


@pytest.mark.parametrize("file", ["vim/syntax/tltl.vim", "emacs/tltl-mode.el", "kate/tltl.xml"])
def test_other_editors_know_every_word(file: str) -> None:
    words = re.findall(r"\w+", (ROOT / "editors" / file).read_text(encoding="utf-8"))
    assert set(load().words) <= set(words)


def test_comments_and_strings_are_not_coloured_inside() -> None:
    assert scopes("// spec a = G b")[0] == ("// spec a = G b", "comment.line.double-slash.tltl")
    assert scopes("/// spec a")[0][1] == "comment.line.documentation.tltl"
    assert scopes('"spec a // b"')[0] == ('"spec a // b"', "string.quoted.double.tltl")
