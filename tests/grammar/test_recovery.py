from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltlc.core.source import SourceFile
from tltlc.grammar import tree
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.mistakes.recovery import MAX_ERRORS, recover
from tltlc.grammar.parser import parse

TEXT = Path(__file__).with_name("everything.tltl").read_text(encoding="utf-8")
GOOD_CLAUSES = ["reach a then b", "keep a", "avoid b | c", "require F (a & X b)", "limit 3 steps", "tag x, y"]
BROKEN_CLAUSES = [
    "reach a then",
    "keep",
    "avoid b |",
    "require F (a & X b",
    "require a) & b",
    "require a = b",
    "limit steps",
    "tag x y",
    "kepe a",
    "require F a then b",
    "judge at goool",
    "keep a @ b",
    'level "one',
    "require always within 3 steps a",
    "reach level",
]
GOOD = ["entity a, b", "signal c: ratio", "let d = F c", "spec e = G c", "spec f { keep c }", "clock 20 Hz"]
BROKEN = [
    "entity",
    "signal c",
    "sginal c: ratio",
    "let d = F",
    "spec = G c",
    "spec f { keep c",
    "clock",
    "spec g = (a & b",
    "param x: length",
    "predicate p in [0, 1 = a",
    'test "t" for { expect holding }',
    "entity é",
]


@given(
    st.lists(
        st.sampled_from([(text, good) for good in (True, False) for text in (GOOD_CLAUSES if good else BROKEN_CLAUSES)])
    )
)
def test_every_broken_clause_is_reported_once(lines: list[tuple[str, bool]]) -> None:
    text = "spec s {\n" + "".join(f"    {line}\n" for line, _ in lines) + "    keep last\n}\n"
    module, diagnostics = parse(SourceFile("a.tltl", text))
    broken = [number for number, (_, good) in enumerate(lines, 2) if not good]
    reported = [label.source.position(label.span.start)[0] for label in (item.labels[0] for item in diagnostics)]
    assert reported == broken
    (spec,) = module.declarations
    assert isinstance(spec, tree.SpecDecl)
    assert len(spec.clauses) >= len(lines) - len(broken) + 1


@given(st.lists(st.sampled_from([(text, good) for good in (True, False) for text in (GOOD if good else BROKEN)])))
def test_every_broken_declaration_is_reported_once(lines: list[tuple[str, bool]]) -> None:
    text = "".join(f"{line}\n" for line, _ in lines)
    module, diagnostics = parse(SourceFile("a.tltl", text))
    broken = [number for number, (_, good) in enumerate(lines, 1) if not good]
    reported = [label.source.position(label.span.start)[0] for label in (item.labels[0] for item in diagnostics)]
    assert reported == broken
    assert len(module.declarations) >= len(lines) - len(broken)


def test_recovery_gives_the_same_tree_for_valid_text() -> None:
    source = SourceFile("a.tltl", TEXT)
    assert recover(source, tokenize(TEXT)) == (parse(source)[0].declarations, ())


@given(st.integers(0, len(TEXT) - 1))
def test_declarations_around_an_error_are_read(cut: int) -> None:
    """An error affects only its own clause or declaration; declarations before and after it are read."""
    text = f"entity first\nentity second\n{TEXT[:cut]} @ {TEXT[cut:]}\nentity last"
    module, diagnostics = parse(SourceFile("a.tltl", text))
    (first, *_, last) = module.declarations
    assert isinstance(first, tree.EntityDecl)
    assert isinstance(last, tree.EntityDecl) or cut > TEXT.rindex("}")
    lines = {item.labels[0].source.position(item.labels[0].span.start)[0] for item in diagnostics}
    assert lines <= {text[: text.index("@")].count("\n") + 1}


def test_errors_are_in_the_order_of_the_text() -> None:
    text = "spec a { judge at foo\n keep }\nspec b { }\nspec c = F a then b\nentity"
    starts = [item.labels[0].span.start for item in parse(SourceFile("a", text))[1]]
    assert starts == sorted(starts)
    assert len(starts) == 5


def test_the_number_of_errors_is_limited() -> None:
    for text in ("entity\n" * 1000, "spec a {\n" + "keep\n" * 1000 + "}"):
        assert len(parse(SourceFile("a", text))[1]) == MAX_ERRORS


@pytest.mark.parametrize(
    "text", ["spec s { keep a", "spec s {", 'test "t" for s {', "spec s { keep a\nspec t { keep b }"]
)
def test_a_missing_brace_is_one_error(text: str) -> None:
    (diagnostic,) = parse(SourceFile("a", text))[1]
    assert diagnostic.code == "TLT0105"
