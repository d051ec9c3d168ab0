"""TLT0432: implications whose two sides never hold together."""

from __future__ import annotations

import re
from itertools import groupby, product

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import (
    APART,
    accepted_traces,
    block,
    codes,
    findings_in,
    labelled_texts_in_block,
    spec_and_findings,
)
from tests.tools.lint.strategies import World, specs
from tltlc.logic.formula import and_
from tltlc.pipeline import compile_text
from tltlc.tools.diff.relation import compare
from tltlc.tools.lint.rules import never_answered


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("require always (at(x) implies at(y))", ["at(x) implies at(y)"]),
        ("keep at(x) implies at(y)", ["at(x) implies at(y)"]),
        ("keep d(x) > 5 m implies d(x) < 2 m", ["d(x) > 5 m implies d(x) < 2 m"]),
        ("require always (at(x) implies eventually at(y))", []),
        ("require always (at(x) implies not at(y))", []),
        ("require always (at(x) implies at(z))", []),
        ("keep d(x) > 5 m implies d(x) > 2 m", []),
        ("keep at(x) implies false", []),
        ("require not (at(x) implies at(y))", []),
        ("require F (at(x) implies at(y))", []),
        ("keep at(z) iff (at(x) implies at(y))", []),
        ("keep at(z) or (at(x) implies at(y))", []),
        ("keep at(z) implies (at(x) implies at(y))", []),
        ("require (at(x) implies at(y)) until at(z)", []),
        ("require at(z) weak_until (at(x) implies at(y))", []),
        ("keep at(z) and (at(x) implies at(y))", ["at(x) implies at(y)"]),
    ],
)
def test_implications_of_exclusive_atoms_are_reported(clause: str, expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0432", "reach at(z)", clause, before=APART) == expected


def test_an_implication_is_reported_beside_the_contradiction_that_it_causes() -> None:
    text = block("reach at(x)", "reach at(z)", "require always (at(x) implies at(y))", before=APART)
    assert {code for code in codes(text) if code != "TLT0415"} == {"TLT0410", "TLT0432"}


def test_a_clause_that_is_impossible_is_reported_as_a_contradiction_only() -> None:
    clause = "keep (!at(x) -> at(x)) and at(y)"
    assert labelled_texts_in_block("TLT0432", clause, before=APART) == []
    assert labelled_texts_in_block("TLT0410", clause, before=APART) != []
    assert labelled_texts_in_block("TLT0432", "keep (!at(x) -> at(x)) and not at(y)", before=APART) == [
        "!at(x) -> at(x)"
    ]


@times(40)
@given(specs("keep {} implies {}", "require G ({} -> {})", "require {} implies {}", most=1))
def test_the_two_sides_of_a_reported_implication_never_hold_together(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(never_answered.check, text)
    for finding in reported:
        trees = {part.tree.span: part for _, clause in spec.clauses("keep", "require") for part in clause.parts()}
        formula = trees[finding.labels[0].span].formula()
        assert formula and not any(world.traces.holding_at_some_step(and_(*formula.args)))
        assert all(any(world.traces.holding_at_some_step(side)) for side in formula.args)


AGAIN = "to forbid that it begins again within 1 s, write `avoid (begins a) then within 1 s (begins a)`"
ALTOGETHER = "to forbid `a` altogether, write `avoid a`"


@pytest.mark.parametrize(
    ("clause", "advice"),
    [
        ("keep a implies always for 1 s not a", f"{AGAIN}; {ALTOGETHER}"),
        ("require always (a implies always for 1 s not a)", f"{AGAIN}; {ALTOGETHER}"),
        ("require a implies always for 1 s not a", AGAIN),
        ("keep a implies (always for 1 s not a) and b", f"{AGAIN}; {ALTOGETHER}"),
        (
            "keep begins a implies (always for 10 s not begins a)",
            "for the steps after it, write `avoid (begins a) then within 10 s (begins a)`; "
            "to forbid `begins a` altogether, write `avoid begins a`",
        ),
        (
            "keep a implies always for 1 s (b and not a)",
            f"for the steps after it, write `a implies weak_next always for 1 s (b and not a)`; {ALTOGETHER}",
        ),
        (
            "keep a implies always not a",
            f"for the steps after it, write `a implies weak_next always not a`; {ALTOGETHER}",
        ),
        ("keep a implies not eventually within 1 s a", f"{AGAIN}; {ALTOGETHER}"),
        (
            "keep (a and b) implies always for 1 s not a",
            "for the steps after it, write `avoid (a and b) then within 1 s a`; "
            "to forbid `a and b` altogether, write `avoid a and b`",
        ),
        (
            "keep begins a implies not (F begins a)",
            "for the steps after it, write `begins a implies weak_next not (F begins a)`; "
            "to forbid `begins a` altogether, write `avoid begins a`",
        ),
        ("keep a implies not eventually within 1 s b", None),
        ("keep a implies eventually within 1 s a", None),
        *(
            (
                f"keep {condition} implies {timer} > 2 s",
                f"`{timer}` is 0 s at that step; to forbid a second beginning so soon, write "
                "`avoid (begins a) then within 2 s (begins a)`; "
                f"to forbid `{condition}` altogether, write `avoid {condition}`",
            )
            for condition in ("a", "begins a")
            for timer in ("time_since(a)", "time_holding(not a)")
        ),
        ("keep a implies time_since(a) < 2 s", None),
        ("keep not a implies time_since(a) >= 2 s", None),
        ("keep a implies time_since(b) >= 2 s", None),
        ("keep a and b implies time_holding(a) >= 2 s", None),
        ("keep a implies time_holding(a) >= 2 s or b", None),
        ("keep a implies time_holding(a) < 2 s", None),
        ("keep not a and time_holding(a) < 2 s", None),
        ("keep ends a implies previously (time_holding(a) >= 2 s)", None),
        (
            "keep ends a implies time_holding(a) > 2 s",
            "`time_holding(a)` is 0 s at that step: write `previously (time_holding(a) > 2 s)`; "
            "to forbid `ends a` altogether, write `avoid ends a`",
        ),
        ("keep not a implies time_holding(a) < 2 s", None),
        (
            "keep not a implies time_holding(a and b) >= 2 s",
            "`time_holding(a and b)` is 0 s at that step: compare it at another step; "
            "to forbid `not a` altogether, write `keep a`",
        ),
        ("keep a implies next always for 1 s not a", None),
        ("keep a implies always for 1 s not b", None),
    ],
)
@pytest.mark.parametrize("clock", ["clock 60 Hz", "clock varies"])
def test_a_rule_that_forbids_its_own_event_is_reported(clause: str, advice: str | None, clock: str) -> None:
    settings = "limit 3600 steps\n    judge at limit"
    text = f"{clock}\nsignal a: bool\nsignal b: bool\nspec s {{\n    {settings}\n    {clause}\n}}\n"
    found = [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0432"]
    assert [diagnostic.help for diagnostic in found] == ([] if advice is None else [advice])


@pytest.mark.parametrize("clause", ["keep a implies G[1,5] not a", "keep a implies not F[1,5] a"])
def test_a_bound_that_begins_later_is_not_reported(clause: str) -> None:
    text = f"clock 60 Hz\nsignal a: bool\nspec s {{\n    limit 60 s\n    judge at limit\n    {clause}\n}}\n"
    assert "TLT0432" not in codes(text)


@pytest.mark.parametrize(
    ("clause", "same"),
    [
        ("keep a implies always for 1 s not a", "avoid a"),
        ("keep a implies (always for 1 s not a)", "avoid a"),
        ("keep a implies not eventually within 1 s a", "avoid a"),
        ("keep begins a implies always for 1 s not begins a", "avoid begins a"),
        ("keep (a and b) implies always for 1 s not a", "avoid a and b"),
        ("keep a implies time_since(a) >= 2 s", "avoid a"),
        ("keep not a implies time_holding(a and b) >= 2 s", "keep a"),
    ],
)
def test_the_clause_that_forbids_the_event_altogether_means_the_same(clause: str, same: str) -> None:
    head = "clock 2 Hz\nsignal a: bool\nsignal b: bool\nspec s {{ judge at limit limit 9 steps {} }}\n"
    (finding,) = (found for found in findings_in(head.format(clause)) if found.diagnostic.code == "TLT0432")
    assert str(finding.diagnostic.help).endswith(f"write `{same}`")
    assert accepted_traces(head.format(clause), "ab") == accepted_traces(head.format(same), "ab")


@pytest.mark.parametrize(
    ("clause", "lasting", "forbidding"),
    [
        ("keep a implies time_holding(a) >= 2 s", "keep begins a implies always for 2 s a", "avoid a"),
        ("keep a implies time_holding(a) > 2 s", "keep begins a implies always for 2 s a", "avoid a"),
        ("keep a implies 2 s <= time_holding(a)", "keep begins a implies always for 2 s a", "avoid a"),
        ("require always (a -> time_holding(a) >= 2 s)", "keep begins a implies always for 2 s a", "avoid a"),
        ("keep begins a implies time_holding(a) >= 2 s", "keep begins a implies always for 2 s a", "avoid a"),
        ("keep b and (a implies time_holding(a) >= 2 s)", "keep begins a implies always for 2 s a", "avoid a"),
        ("keep a or b implies time_holding(a) >= 2 s", "keep begins a implies always for 2 s a", "avoid a or b"),
        ("avoid a and time_holding(a) < 2 s", "keep begins a implies always for 2 s a", "avoid a"),
        ("avoid a and not time_holding(a) >= 2 s", "keep begins a implies always for 2 s a", "avoid a"),
        (
            "keep not a implies time_holding(not a) >= 2 s",
            "keep begins not a implies always for 2 s not a",
            "keep a",
        ),
        (
            "keep a and b implies time_holding(a and b) >= 2 s",
            "keep begins (a and b) implies always for 2 s (a and b)",
            "avoid a and b",
        ),
        (
            "keep a implies time_holding(a and b) >= 2 s",
            "keep begins (a and b) implies always for 2 s (a and b)",
            "avoid a",
        ),
        ("keep a implies time_holding(a) > 0 s", None, "avoid a"),
    ],
)
@pytest.mark.parametrize("clock", ["clock 60 Hz", "clock varies"])
def test_a_rule_that_each_stretch_breaks_at_its_first_step_is_reported(
    clause: str, lasting: str | None, forbidding: str, clock: str
) -> None:
    (finding,) = (found.diagnostic for found in findings_in(stretch_spec(clause, clock)) if found.fix == ())
    event = re.findall(r"time_holding\((.*?)\)", clause)[0]
    forbidden = forbidding.removeprefix("avoid ").replace("keep ", "not ")
    assert (finding.code, finding.title) == (
        "TLT0432",
        f"`time_holding({event})` is 0 s when `{event}` begins, so this forbids `{forbidden}`",
    )
    advice = [] if lasting is None else [f"if each stretch of `{event}` lasts at least 2 s, write `{lasting}`"]
    assert finding.help == "; ".join([*advice, f"to forbid `{forbidden}` altogether, write `{forbidding}`"])
    for offered in filter(None, (lasting, forbidding)):
        assert "TLT0432" not in codes(stretch_spec(offered, clock))


def test_a_spec_that_is_a_formula_is_offered_formulas() -> None:
    (finding,) = findings_in("clock 2 Hz\nsignal a: bool\nspec s = always (a implies time_holding(a) >= 2 s)\n")
    assert finding.diagnostic.help == (
        "if each stretch of `a` lasts at least 2 s, write `always (begins a implies always for 2 s a)`; "
        "to forbid `a` altogether, write `always not a`"
    )


def stretch_spec(clause: str, clock: str = "clock 2 Hz") -> str:
    head = "limit 9000 steps judge at limit"
    return f"{clock}\nsignal a: bool\nsignal b: bool\nspec s {{\n    {head}\n    {clause}\n}}\n"


@pytest.mark.parametrize(
    ("clause", "same"),
    [
        ("keep a implies time_holding(a) >= 1 s", "avoid a"),
        ("keep begins a implies time_holding(a) > 0 s", "avoid a"),
        ("avoid a and time_holding(a) < 1 s", "avoid a"),
        ("keep not a implies time_holding(not a) >= 1 s", "keep a"),
        ("keep a or b implies time_holding(a) >= 1 s", "avoid a or b"),
        ("keep a implies time_holding(a and b) >= 1 s", "avoid a"),
    ],
)
def test_such_a_rule_forbids_the_event(clause: str, same: str) -> None:
    assert "TLT0432" in codes(stretch_spec(clause))
    assert accepted_traces(stretch_spec(clause), "ab", 4) == accepted_traces(stretch_spec(same), "ab", 4)


@pytest.mark.parametrize(("seconds", "least"), [("1 s", 2), ("1.5 s", 3), ("2 s", 4)])
def test_the_suggested_rule_accepts_traces_whose_stretches_last_long_enough(seconds: str, least: int) -> None:
    """Each sample lasts for half a second here. The stretch at the end of a trace may go on after it."""
    accepted = accepted_traces(stretch_spec(f"keep begins a implies always for {seconds} a"), "a", 7)
    for length in range(1, 8):
        for trace in product(("", "a"), repeat=length):
            stretches = [len([*samples]) for is_a, samples in groupby(trace) if is_a]
            whole = stretches[:-1] if trace[-1] else stretches
            assert (trace in accepted) == all(samples >= least for samples in whole)


TIMED = "{}\nsignal a: bool\nspec s {{\n    limit 3600 steps\n    judge at limit\n    {}\n}}\n"


def quoted(clause: str, clock: str) -> list[str]:
    """Return what the help of TLT0432 names, between backquotes."""
    (finding,) = (found for found in findings_in(TIMED.format(clock, clause)) if found.diagnostic.code == "TLT0432")
    return re.findall("`([^`]*)`", finding.diagnostic.help or "")


@pytest.mark.parametrize(
    ("clock", "comparison", "time", "steps"),
    [
        ("clock 10 Hz", ">= 2 s", "1.9 s", 19),
        ("clock 10 Hz", "> 2 s", "2 s", 20),
        ("clock 10 Hz", ">= 2.05 s", "2 s", 20),
        ("clock 10 Hz", "> 2.05 s", "2 s", 20),
        ("clock 60 Hz", ">= 2 s", "1.98 s", 119),
        ("clock 60 Hz", ">= 500 ms", "483 ms", 29),
        ("clock 10 Hz", ">= 0.1 min", "0.098 min", 59),
        ("clock 1 Hz", ">= 3 s", "2 s", 2),
        ("clock varies", ">= 2 s", "2 s", None),
    ],
)
def test_a_second_beginning_is_forbidden_as_long_as_the_comparison_forbids_it(
    clock: str, comparison: str, time: str, steps: int | None
) -> None:
    offered = quoted(f"keep a implies time_since(a) {comparison}", clock)[1]
    assert offered == f"avoid (begins a) then within {time} (begins a)"
    assert set(codes(TIMED.format(clock, offered))) <= {"TLT0418"}
    if steps is not None:
        counted = f"avoid (begins a) then within {steps} steps (begins a)"
        one, other = (compile_text(TIMED.format(clock, clause))[0] for clause in (offered, counted))
        assert compare(one, other).relation == "equivalent"


def test_the_time_between_two_beginnings_is_the_one_of_the_comparison() -> None:
    offered = quoted("keep a implies time_since(a) >= 0.5 s", "clock 10 Hz")[1]
    between = "keep (begins a and previously once a) implies previously (time_since(begins a) >= 0.4 s)"
    one, other = (compile_text(TIMED.format("clock 10 Hz", clause))[0] for clause in (offered, between))
    assert compare(one, other).relation == "equivalent"


@pytest.mark.parametrize("comparison", [">= 0.2 s", ">= 0.1 s", "> 0.1 s"])
def test_no_second_beginning_comes_at_the_next_step(comparison: str) -> None:
    assert "avoid (begins a)" not in " ".join(quoted(f"keep a implies time_since(a) {comparison}", "clock 10 Hz"))


def test_the_time_of_a_stretch_that_ends_is_compared_at_its_last_step_or_from_its_first() -> None:
    clause = "keep ends a implies time_holding(a) >= 2 s"
    (finding,) = (found for found in findings_in(TIMED.format("clock 10 Hz", clause)))
    assert finding.diagnostic.help == (
        "`time_holding(a)` is 0 s at that step: write `previously (time_holding(a) >= 2 s)`, or "
        "`keep begins a implies always for 2 s a`, which needs one step less; "
        "to forbid `ends a` altogether, write `avoid ends a`"
    )
    _, previously, lasting, _, _ = quoted(clause, "clock 10 Hz")
    one_less = "keep ends a implies previously (time_holding(a) >= 1.9 s)"
    texts = (f"keep ends a implies {previously}", lasting, one_less)
    longer, shorter, same = (compile_text(TIMED.format("clock 10 Hz", text))[0] for text in texts)
    assert compare(shorter, same).relation == "equivalent"
    assert compare(shorter, longer).relation == "stricter"
    assert codes(TIMED.format("clock 10 Hz", lasting)) == []
    assert "one step less" not in " ".join(
        found.diagnostic.help or "" for found in findings_in(TIMED.format("clock varies", clause))
    )
