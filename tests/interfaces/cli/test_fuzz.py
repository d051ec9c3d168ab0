"""Fuzzing of `tltlc check`: for any file, it ends soon with status 0 or 1, and without a traceback."""

from __future__ import annotations

import contextlib
import io
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.calls import calls
from tests.interfaces.cli.conftest import ROOT
from tltlc.interfaces.cli.main import main

SPECS = [path.read_text() for path in sorted([*ROOT.glob("examples/*.tltl"), *ROOT.glob("stdlib_predicates/*.tltl")])]
WORDS_OF_THE_LANGUAGE = (
    "spec test for { } ( ) [ ] , : = import signal predicate in let all any when otherwise then and or not "
    "F G X U W R M N reach keep avoid require level limit judge goal -> <-> ! & | + - * / ^ < <= 1 0 -1 1e999 "
    "3 m s % Hz steps inf true near alive s1 s2 exit within for after next eventually always /// //"
)
WORDS = [*WORDS_OF_THE_LANGUAGE.split(), "\n", '"', "\\", "\0", "é", "𝒰", "◇", "□", "∧"]
EACH = settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture]
)


@st.composite
def mutated_examples(draw: st.DrawFn) -> str:
    """An example with a few pieces removed, doubled or replaced."""
    text = draw(st.sampled_from(SPECS))
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(text)))
        end = draw(st.integers(start, min(len(text), start + 40)))
        piece = draw(st.sampled_from(WORDS) | st.just(text[start:end] * 2) | st.just("") | st.text(max_size=5))
        text = text[:start] + piece + text[end:]
    return text


def check(content: bytes, folder: Path) -> None:
    path = folder / "fuzz.tltl"
    path.write_bytes(content)
    err = io.StringIO()
    with contextlib.redirect_stderr(err), pytest.raises(SystemExit) as exit_:
        main(["check", str(path), "--state-budget", "2000"])
    assert exit_.value.code in (0, 1), err.getvalue()
    assert "Traceback" not in err.getvalue()


@given(content=st.binary(max_size=200))
@EACH
def test_arbitrary_bytes_end_with_a_status(content: bytes, tmp_path: Path) -> None:
    check(content, tmp_path)


@given(text=st.lists(st.sampled_from(WORDS), max_size=60).map(" ".join))
@EACH
def test_words_in_any_order_end_with_a_status(text: str, tmp_path: Path) -> None:
    check(text.encode(), tmp_path)


@given(text=mutated_examples())
@EACH
def test_mutated_examples_end_with_a_status(text: str, tmp_path: Path) -> None:
    check(text.encode("utf-8", "surrogatepass"), tmp_path)


def hostile_texts(deep: int) -> list[str]:
    """Texts that nest ``deep`` brackets or signs, or have some multiple of it in characters."""
    return [
        "spec x = " + "(" * deep,
        "spec x = " + "(" * deep + "true" + ")" * deep,
        "signal a: bool spec x = " + "!" * deep + "a",
        "signal a: bool spec x = " + "X " * 10_000 + "a",
        "signal a: bool spec x = " + " & ".join(["a"] * 10_000),
        "signal a: bool spec x = " + " U ".join(["a"] * 10_000),
        "signal a: bool spec x = " + " -> ".join(["a"] * 10_000),
        "signal a: bool spec x = F[0,1000000000] a",
        "signal a: bool spec x = " + "F[0,100] " * 6 + "a",
        "signal v in [0, 1] spec x = F v > " + "-" * deep + "1",
        "predicate p in [0, 1] = " + " + ".join(["1"] * 10_000) + " spec x = F p",
        "predicate p in [0, 1] = 2" + "^9" * 50 + " spec x = F p",
        "let f = f spec x = f",
        "let f(x) = g(x) let g(x) = f(x) signal a: bool spec x = f(a)",
        "{" * deep,
        "[" * deep,
        "spec x {" * 10_000,
        "\n" * (10 * deep),
        "a" * (10 * deep),
        "spec x = 1" + "0" * 5000 + " > 0",
        '"' * 1000,
        "///\n" * deep,
    ]


def check_in_linear_time(text: str, folder: Path) -> None:
    # The measured value is 38 calls for each character of a long text, plus some thousands.
    assert calls(lambda: check(text.encode(), folder)) < 100_000 + 200 * len(text)


@pytest.mark.parametrize("text", hostile_texts(15_000), ids=lambda text: text[:30])
def test_hostile_texts_are_checked_in_linear_time(text: str, tmp_path: Path) -> None:
    check_in_linear_time(text, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("text", hostile_texts(100_000), ids=lambda text: text[:30])
def test_longer_hostile_texts_are_checked_in_linear_time(text: str, tmp_path: Path) -> None:
    check_in_linear_time(text, tmp_path)


def test_a_file_may_import_itself(tmp_path: Path) -> None:
    check(b'import "fuzz.tltl"\nspec x = true', tmp_path)


def test_the_recursion_limit_is_restored() -> None:
    before = sys.getrecursionlimit()
    with contextlib.suppress(SystemExit):
        main(["list", "codes"])
    assert sys.getrecursionlimit() == before
