"""No text makes the parser raise an exception or run for a long time."""

import random
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.calls import calls
from tests.fuzzing import times
from tltlc.core.source import SourceFile
from tltlc.diagnostics.code_pages import codes
from tltlc.diagnostics.render import FORMATS, render
from tltlc.grammar.parser import MAX_CHARACTERS, parse, parse_formula
from tltlc.grammar.tables import load

TEXT = Path(__file__).with_name("everything.tltl").read_text(encoding="utf-8")
TABLES = load()
WORDS = [
    *TABLES.words,
    *TABLES.signs,
    *TABLES.soft,
    "a",
    "b",
    "1",
    "20 steps",
    '"t"',
    "//",
    "\n",
    "@",
    '"',
    "é",
    "{",
    "}",
]


def check_diagnostics(text: str) -> None:
    source = SourceFile("a.tltl", text)
    for diagnostics in (parse(source)[1], parse_formula(source)[1]):
        for diagnostic in diagnostics:
            assert diagnostic.code in codes()
            assert diagnostic.severity == "error"
            (label,) = diagnostic.labels
            assert 0 <= label.span.start <= label.span.end <= len(text)
            own_words = re.sub("`[^`]*`", "", diagnostic.title)
            assert not re.search(r"\$|_|[A-Z]{2}", own_words), "the name of a terminal"
        for format_ in FORMATS:
            render(diagnostics, format_)


@given(st.text())
def test_any_text_is_parsed_without_an_exception(text: str) -> None:
    check_diagnostics(text)


@given(st.lists(st.sampled_from(WORDS), max_size=40), st.sampled_from(["", " ", "\n"]))
def test_words_in_any_order_are_parsed_without_an_exception(words: list[str], between: str) -> None:
    check_diagnostics(between.join(words))


@times(80)
@given(st.randoms(use_true_random=False), st.integers(1, 5))
def test_mutated_specs_are_parsed_without_an_exception(generator: random.Random, times: int) -> None:
    text = TEXT
    for _ in range(times):
        start = generator.randrange(len(text))
        end = min(len(text), start + generator.choice([0, 1, 3, 20]))
        text = text[:start] + generator.choice(["", " ", *WORDS]) + text[end:]
    check_diagnostics(text)


BIG = MAX_CHARACTERS // 8


@pytest.mark.parametrize("divisor", [pytest.param(1, marks=pytest.mark.slow), 8], ids=["large", "smaller"])
@pytest.mark.parametrize(
    ("start", "repeated", "times", "end"),
    [
        ("spec s = ", "!", BIG, "a"),
        ("spec s = ", "(", BIG, ""),
        ("spec s = ", "a & ", BIG, "a"),
        ("spec s = ", "a then ", 10_000, "a"),
        ("spec s = ", "a -> ", 10_000, "a"),
        ("predicate p = ", "when a: ", 10_000, ""),
        ("spec s = ", "f(", 10_000, ""),
        ("", "a b\n", BIG, ""),
        ("", "spec a { keep a }\n", 20_000, ""),
        ("", "spec a {\n", 20_000, ""),
        ("spec a {\n", "keep\n", 20_000, ""),
        ("spec a {\n", "kepe a\n", 20_000, "}"),
        ("spec a {\n keep b", " &\na b", 20_000, "}"),
        ("spec a {\n", "1 2 3 4 ", 20_000, "}"),
        ("spec a { limit ", "3 steps ", 20_000, "}"),
        ("spec a { reach ", "a then ", 20_000, "b for 5 steps }"),
        ("", "{}", BIG, ""),
        ("", '"', BIG, ""),
        ("", "aé", BIG, ""),
    ],
)
def test_large_texts_take_a_few_calls_for_each_character(
    start: str, repeated: str, times: int, end: str, divisor: int
) -> None:
    check_number_of_calls(start + repeated * (times // divisor) + end)


@pytest.mark.parametrize(
    "text",
    ["1" * MAX_CHARACTERS, "x" * (MAX_CHARACTERS + 1), "\n" * MAX_CHARACTERS, "a " * (BIG + 1)],
    ids=lambda text: repr(text[:2]),
)
def test_texts_at_the_limits_take_a_few_calls_for_each_character(text: str) -> None:
    check_number_of_calls(text)


def check_number_of_calls(text: str) -> None:
    def parse_and_render() -> None:
        _, diagnostics = parse(SourceFile("a", text))
        render(diagnostics)

    # Measured: at most 62 calls for each character.
    assert calls(parse_and_render) < 200 * len(text)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("(" * 200 + "a" + ")" * 200, None),
        ("(" * 201 + "a" + ")" * 201, "TLT0103"),
        ("!" * 999 + "a", None),
        ("!" * 1000 + "a", "TLT0103"),
        (" & ".join("a" for _ in range(1000)), None),
        (" & ".join("a" for _ in range(10_000)), "TLT0103"),
        (" then ".join("a" for _ in range(10_000)), "TLT0103"),
        ("a " * MAX_CHARACTERS, "TLT0004"),
    ],
    ids=lambda part: repr(part)[:12],
)
def test_deep_and_long_formulas_are_limited(text: str, code: str | None) -> None:
    formula, diagnostics = parse_formula(SourceFile("a", text))
    assert [diagnostic.code for diagnostic in diagnostics] == ([code] if code else [])
    assert (formula is None) == (code is not None)
    _, diagnostics = parse(SourceFile("a", f"entity b\nspec s = {text}"))
    assert [diagnostic.code for diagnostic in diagnostics] == ([code] if code else [])
