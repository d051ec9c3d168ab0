"""No regular expression takes exponential time on any text, and those that read files take linear time."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from lark import Lark

from tests.time_limit import run_with_time_limit
from tltlc.grammar.lexer import _pattern as lexer_pattern

_ROOT = Path(__file__).resolve().parents[1]
# The terminals of the grammar of English sentences are words, which another module names.
_GRAMMARS = sorted(path for path in _ROOT.glob("tltlc/**/*.lark") if path.parent.name != "english")
_OF_RE = ("compile", "match", "search", "fullmatch", "sub", "split", "findall", "finditer")
_FLAGS = {"DOTALL", "MULTILINE", "ASCII", "IGNORECASE", "I"}


def _terminals(grammar: Path) -> Iterator[tuple[str, int]]:
    rules = re.findall(r"^\??(\w+):", grammar.read_text(encoding="utf-8"), re.MULTILINE)
    parser = Lark(
        grammar.read_text(encoding="utf-8"), parser="lalr", start=next(rule for rule in rules if rule.islower())
    )
    for terminal in parser.terminals:
        yield terminal.pattern.to_regexp(), 0


def _in_code() -> Iterator[tuple[str, str, int]]:
    """Yield module, pattern and flags of each call of ``re`` whose pattern follows from constants of the module."""
    for path in sorted([*_ROOT.glob("tltlc/**/*.py"), *_ROOT.glob("runtime/tltl_runtime/**/*.py")]):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        known: dict[str, object] = {}
        for node in tree.body:
            target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
            if isinstance(target, ast.Name):
                known[target.id] = _value(getattr(node, "value", None), known)
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute) or not node.args:
                continue
            if ast.unparse(node.func.value) != "re" or node.func.attr not in _OF_RE:
                continue
            pattern = _value(node.args[0], known)
            if isinstance(pattern, (str, bytes)):
                flags = {
                    word.attr for word in ast.walk(node) if isinstance(word, ast.Attribute) and word.attr in _FLAGS
                }
                text = pattern.decode("latin-1") if isinstance(pattern, bytes) else pattern
                yield path.stem, text, int(sum(getattr(re, flag) for flag in flags))


def _value(node: ast.AST | None, known: dict[str, object]) -> object:
    """Return the value of a constant expression, or None for any other expression."""
    try:
        return eval(ast.unparse(node), {"__builtins__": {}}, known) if node is not None else None
    except Exception:
        return None


def _match_soon(patterns: list[tuple[str, int]], times: int) -> None:
    run_with_time_limit(
        "import re\n"
        "from tests.hostile_texts import hostile_texts\n"
        f"for pattern, flags in {patterns!r}:\n"
        "    print(repr(pattern), flush=True)\n"
        "    matches = re.compile(pattern, flags).match\n"
        f"    for text in hostile_texts(pattern, flags, {times}):\n"
        "        matches(text)\n"
    )


@pytest.mark.parametrize("grammar", _GRAMMARS, ids=lambda path: path.stem)
def test_every_terminal_of_a_grammar_takes_linear_time(grammar: Path) -> None:
    _match_soon(list(_terminals(grammar)), 50_000)


def test_the_pattern_of_all_tokens_takes_linear_time() -> None:
    _match_soon([(lexer_pattern().pattern, lexer_pattern().flags)], 20_000)


def test_no_pattern_in_the_code_takes_exponential_time() -> None:
    patterns = list(dict.fromkeys((pattern, flags) for _, pattern, flags in _in_code()))
    assert len(patterns) > 80
    _match_soon(patterns, 300)


def test_hostile_texts_include_one_for_an_ambiguous_repetition() -> None:
    from tests.hostile_texts import hostile_texts

    texts = set(hostile_texts(r'(?s:"(\\.|[^\"])*")', 0, 49))
    assert '"' + "\\" * 49 in texts
