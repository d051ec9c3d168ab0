import pytest

from tests.grammar.reading import brackets, read
from tltlc.grammar.tables import load

UNARY = {
    "NOT": ("!", "not ¬"),
    "EVENTUALLY": ("F", "eventually <> ◇"),
    "ALWAYS": ("G", "always [] □"),
    "NEXT": ("X", "next ○"),
    "WEAK_NEXT": ("N", "weak_next"),
}
BINARY = {
    "AND": ("&", "and && ∧"),
    "OR": ("|", "or || ∨"),
    "IMPLIES": ("->", "implies ⇒ →"),
    "IFF": ("<->", "iff ⇔ ↔"),
    "UNTIL": ("U", "until 𝒰"),
    "WEAK_UNTIL": ("W", "weak_until"),
    "RELEASE": ("R", "release"),
    "STRONG_RELEASE": ("M", "strong_release"),
}
CONSTANTS = {"TRUE": ("true", "⊤"), "FALSE": ("false", "⊥")}


@pytest.mark.parametrize(("letter", "spellings"), UNARY.values())
def test_all_spellings_of_a_unary_operator_are_equal(letter: str, spellings: str) -> None:
    for spelling in spellings.split():
        assert brackets(read(f"a & {spelling} b")) == brackets(read(f"a & {letter} b"))


@pytest.mark.parametrize(("letter", "spellings"), BINARY.values())
def test_all_spellings_of_a_binary_operator_are_equal(letter: str, spellings: str) -> None:
    for spelling in spellings.split():
        assert brackets(read(f"a {spelling} b")) == brackets(read(f"a {letter} b"))


@pytest.mark.parametrize(("letter", "spellings"), CONSTANTS.values())
def test_all_spellings_of_a_constant_are_equal(letter: str, spellings: str) -> None:
    for spelling in spellings.split():
        assert brackets(read(spelling)) == brackets(read(letter))


@pytest.mark.parametrize("terminal", [*UNARY, *BINARY, *CONSTANTS])
def test_every_spelling_is_tested(terminal: str) -> None:
    letter, other_spellings = {**UNARY, **BINARY, **CONSTANTS}[terminal]
    tables = load()
    spellings = {text for text, name in {**tables.words, **tables.signs}.items() if name == terminal}
    assert spellings == {letter, *other_spellings.split()}


def test_signs_need_no_spaces() -> None:
    assert brackets(read("a𝒰b∧¬c⇒□d&&[]e||<>f<->!g")) == brackets(read("a U b & !c -> G d & G e | F f <-> !g"))


def test_spans_cover_the_text() -> None:
    text = "  F (a & near(s1, close = 3 m)) U all x in (s1): b "
    formula = read(text)

    def walk(node: object) -> None:
        if hasattr(node, "span"):
            assert text[node.span.start : node.span.end].strip() == text[node.span.start : node.span.end] != ""
            for name in type(node).__match_args__:
                value = getattr(node, name)
                for part in value if isinstance(value, tuple) else [value]:
                    if hasattr(part, "span"):
                        assert node.span.start <= part.span.start <= part.span.end <= node.span.end
                        walk(part)

    walk(formula)
    assert text[formula.span.start : formula.span.end] == text.strip()
