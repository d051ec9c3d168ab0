"""The diagnostics of the predicate check in a program."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT
from tests.resolve.helpers import codes, resolve_text
from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.io.limits import WORK
from tltlc.resolve.imports import standard_library
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.range_proof import work_budget
from tltlc.resolve.resolution import resolve


def test_a_wrong_range_is_an_error_with_a_witness() -> None:
    _, (diagnostic,) = resolve_text("signal x in [0, 1] predicate p in [0, 1] = 2 * x spec s = F p")
    assert (diagnostic.code, diagnostic.severity) == ("TLT0306", "error")
    assert "x = 1" in diagnostic.labels[0].message
    assert diagnostic.labels[0].source.slice(diagnostic.labels[0].span) == "in [0, 1]"


@pytest.mark.parametrize(
    ("declared", "body", "bounds", "advice"),
    [
        ("", "2 * x", "[-1, 1]", "scale the value, or limit it with `clamp(…, -1, 1)`"),
        ("in [-1, 1]", "2 * x", "[-1, 1]", "scale the value, or limit it with `clamp(…, -1, 1)`"),
        (
            "in [0, 0.5]",
            "x",
            "[0, 0.5]",
            "declare the range that it really has, or limit the value with `clamp(…, 0, 0.5)`",
        ),
    ],
)
def test_the_help_for_a_wrong_range_keeps_the_value_in_it(declared: str, body: str, bounds: str, advice: str) -> None:
    signal = "signal x in [0, 1]"
    _, (diagnostic,) = resolve_text(f"{signal} predicate p {declared} = {body} spec s = F p")
    assert (diagnostic.code, diagnostic.help) == ("TLT0306", advice)
    assert diagnostic.title == f"the predicate `p` leaves its range {bounds}"
    limited = advice.split("`")[-2].replace("…", body)
    assert codes(f"{signal} predicate p {declared} = {limited} spec s = F p") == []


def test_a_range_that_only_fails_below_zero_is_a_warning() -> None:
    text = "predicate p(e: entity) in [-1, 1] = clamp(1 - sqrt(d(e) / 3 m), -1, 1) entity a spec s = F p(a)"
    _, (diagnostic,) = resolve_text("signal d(e: entity): length " + text)
    assert (diagnostic.code, diagnostic.severity) == ("TLT0401", "warning")
    assert diagnostic.help == "declare the range of that signal, e.g. `in [0 m, inf]`"
    assert codes("signal d(e: entity): length in [0 m, inf] " + text) == []


def test_a_jump_is_a_warning() -> None:
    _, (diagnostic,) = resolve_text(
        "signal x in [0, 1] predicate p in [0, 1] = when x < 0.5: 0 otherwise: 1 spec s = F p"
    )
    assert (diagnostic.code, diagnostic.severity) == ("TLT0402", "warning")


def test_a_predicate_is_checked_once_for_all_entities() -> None:
    text = (
        "signal d(e: entity) in [0, 1] predicate p(e: entity) in [0, 1] = 2 * d(e) entity a, b spec s = F p(a) & F p(b)"
    )
    assert codes(text) == ["TLT0306"]


def test_the_check_uses_the_values_of_arguments() -> None:
    declared = "signal x in [0, 4] predicate p(most: number = 4) in [0, 1] = x / most "
    assert codes(declared + "spec s = F p") == []
    assert codes(declared + "spec s = F p(8)") == []
    assert codes(declared + "spec s = F p(2)") == ["TLT0306"]


def test_a_numeric_argument_is_checked_where_its_value_is_known() -> None:
    declared = "signal x in [0, 4] predicate p(most: number) in [0, 1] = x / most "
    assert codes(declared + "let q(m: number) = F p(m) spec s = F p(8)") == []
    assert codes(declared + "predicate r(m: number) in [0, 1] = p(2 * m) spec s = F p(8)") == []
    assert codes(declared + "let q(m: number) = F p(m) spec s = q(8) & q(4)") == []
    assert codes(declared + "let q(m: number) = F p(m) spec s = q(8) & q(2)") == ["TLT0306"]
    assert codes(declared + "predicate r(m: number) in [0, 1] = p(2 * m) spec s = F r(4)") == []
    assert codes(declared + "predicate r(m: number) in [0, 1] = p(2 * m) spec s = F r(1)") == ["TLT0306", "TLT0306"]
    assert codes(declared + "let q(m: number) = F p(2) & m > 1 spec s = F p(8)") == ["TLT0306"]
    assert codes(declared + "param b in [1, 8] = 4 let q(m: number) = F p(b) & m > 1 spec s = F p(b)") == ["TLT0306"]


def test_the_check_covers_the_whole_range_of_a_param() -> None:
    assert codes("signal x in [0, 4] param m in [4, 8] = 5 predicate p in [0, 1] = x / m spec s = F p") == []
    assert codes("signal x in [0, 4] param m in [2, 8] = 5 predicate p in [0, 1] = x / m spec s = F p") == ["TLT0306"]


SIGNALS = "".join(f"signal {name} in [-1, 1] " for name in "xyz")
LINE = "(x^3 * y + {}.5e-8 * y * z^2 + x * z) / 4"
"""Values of this form are so close to each other that a jump between them is neither proved nor found."""


def nested(depth: int, first: int = 0) -> str:
    """Return nested ``when`` over three signals; each is in the last case of the one around it."""
    value = LINE.format(first + 99)
    for n in range(depth):
        a, b = "xyz"[n % 3], "xyz"[(n + 1) % 3]
        test = f"{a} + {round(0.1 + n / 9, 3)} * {b} > {round(1.8 * n / depth - 0.9, 3)}"
        value = f"(when {test}: {LINE.format(first + n)} otherwise: {value})"
    return value


def balanced(parts: list[str], op: str) -> str:
    while len(parts) > 1:
        parts = [f"({op.join(parts[n : n + 2])})" for n in range(0, len(parts), 2)]
    return parts[0]


def steps(count: int, op: str = "+") -> str:
    """Return a sum or product of ``count`` ``when`` with two cases each."""
    cases = [f"(when {'xyz'[n % 3]} > {n / count}: x * y otherwise: 0.1)" for n in range(count)]
    return f"{balanced(cases, op)} / {count}"


def chain(count: int) -> str:
    """Return one ``when`` with ``count`` cases and an ``otherwise``."""
    cases = [f"when {'xyz'[n % 3]} > {1 - 2 * n / count}: {'xyz'[n % 2]} / {n + 2}" for n in range(count)]
    return f"{' '.join(cases)} otherwise: 0.1"


@pytest.mark.parametrize(
    ("body", "expected_codes", "reason"),
    [
        (nested(8), ["TLT0503"], "the check takes too many steps: 600,000 are allowed"),
        pytest.param(
            nested(16), ["TLT0503"], "the check takes too many steps: 600,000 are allowed", marks=pytest.mark.slow
        ),
        (nested(22), ["TLT0503"], "the check takes too many steps: 600,000 are allowed"),
        (nested(40), ["TLT0503"], "more than 24 cases of its `when` may meet"),
        (chain(16), ["TLT0402"], None),
        (chain(60), ["TLT0503"], "more than 24 cases of its `when` may meet"),
        (chain(200), ["TLT0503"], "its `when` splits it into more than 64 cases"),
        (steps(16), ["TLT0503"], "its `when` splits it into more than 64 cases"),
        (steps(16, "*"), ["TLT0503"], "its `when` splits it into more than 64 cases"),
        (steps(5, "*"), ["TLT0402"], None),
        (
            f"when {balanced([f'(x*y > {n / 300} and y > {n} * z)' for n in range(1, 120)], ' or ')}: x otherwise: y",
            ["TLT0503"],
            "its `when` splits it into more than 64 cases",
        ),
        (
            f"when {balanced([f'x > {n / 999} and {0.5 + n / 999} > x' for n in range(240)], ' and ')}: x otherwise: y",
            ["TLT0503"],
            "its `when` splits it into more than 64 cases",
        ),
        (balanced(["x"] * 1500, "+") + " / 1500", ["TLT0503"], "it has more than 2,000 operands and operators"),
        # A value that is wrong at some point is an error, even if the proof would take too many steps.
        (f"3 * ({steps(16)}) + 2", ["TLT0306"], None),
        (f"2 + {nested(40)}", ["TLT0306"], None),
    ],
)
def test_a_check_stays_within_its_step_limit(
    body: str, expected_codes: list[str], reason: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TLTLC_CACHE_DIR", "")
    with work_budget.step_limit(10**9) as spent:
        _, diagnostics = resolve_text(f"{SIGNALS} predicate p in [-1, 1] = {body} spec s = F p")
    assert 10**9 - spent.left <= WORK["check of a predicate"]
    assert [diagnostic.code for diagnostic in diagnostics] == expected_codes
    assert reason is None or diagnostics[0].labels[0].message == reason


def test_the_checks_of_all_predicates_stay_within_their_step_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTLC_CACHE_DIR", "")
    monkeypatch.setitem(WORK, "check of a predicate", 50_000)  # type: ignore[attr-defined]
    monkeypatch.setitem(WORK, "checks of all predicates", 150_000)  # type: ignore[attr-defined]
    predicates = " ".join(f"predicate p{n} in [-1, 1] = {nested(8, n)}" for n in range(6))
    with work_budget.step_limit(10**9) as spent:
        _, diagnostics = resolve_text(f"{SIGNALS} {predicates} spec s = F (p0 & p1 & p2 & p3 & p4 & p5)")
    assert 10**9 - spent.left <= 150_000
    assert [diagnostic.code for diagnostic in diagnostics] == ["TLT0503"] * 4
    assert diagnostics[3].title == "the predicate `p3` and 2 more predicates were not checked"
    assert all(diagnostic.severity == "warning" for diagnostic in diagnostics)


def test_cached_answers_count_the_same_steps(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("TLTLC_CACHE_DIR", str(tmp_path))
    text = f"{SIGNALS} predicate p in [-1, 1] = {nested(3)} spec s = F p"
    counted = []
    for _ in range(2):
        with work_budget.step_limit(10**9) as spent:
            codes(text)
        counted.append(10**9 - spent.left)
    assert counted[0] == counted[1]


def test_nested_predicates_are_limited() -> None:
    doubled = " ".join(f"predicate p{n} in [-1, 1] = p{n - 1} * p{n - 1}" for n in range(1, 31))
    reported = codes(f"signal x in [-1, 1] predicate p0 in [-1, 1] = x {doubled} spec s = F p30")
    assert set(reported) == {"TLT0503", "TLT0315"}
    many = " & ".join(f"p12 > {n / 1000}" for n in range(200))
    reported = codes(f"signal x in [-1, 1] predicate p0 in [-1, 1] = x {doubled} spec s = F ({many})")
    assert set(reported) == {"TLT0503", "TLT0315"}


def test_very_long_numbers_stop_a_proof() -> None:
    from tltlc.expression.tree import Const, Op, SignalValue
    from tltlc.resolve.range_proof.elimination import GiveUpError
    from tltlc.resolve.range_proof.exact import _Translation
    from tltlc.resolve.range_proof.normal_form import TooLargeError, quotient
    from tltlc.resolve.range_proof.region import ConstrainedBox

    for exponent, compute, error in (
        (12.0, quotient, TooLargeError),
        (8.0, _Translation(ConstrainedBox({SignalValue("x"): (0.0, 1.0)}, {})).term, GiveUpError),
    ):
        power = Op("*", (Const(1e300), SignalValue("x")))
        for _ in range(8):
            power = Op("^", (power, Const(exponent)))
        with pytest.raises(error):
            compute(power)


@pytest.mark.parametrize("folder", [standard_library(), ROOT / "examples"], ids=["standard library", "examples"])
def test_libraries_and_examples_need_less_than_a_hundredth_of_the_steps(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TLTLC_CACHE_DIR", "")
    for path in sorted(folder.glob("*.tltl")):
        module, _ = parse(SourceFile(str(path), path.read_text("utf-8")))
        with work_budget.step_limit(10**9) as spent:
            diagnostics = resolve(module, ResolveOptions()).diagnostics
        assert 10**9 - spent.left < WORK["check of a predicate"] / 100
        assert not {"TLT0401", "TLT0402", "TLT0503"} & {diagnostic.code for diagnostic in diagnostics}
