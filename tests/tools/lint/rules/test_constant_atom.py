"""TLT0416: atoms that are always true or always false."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import block, codes, findings_in, spec_and_findings
from tests.tools.lint.predicates import PREDICATES, Predicate
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text
from tltlc.tools.lint.rules import constant_atom


@pytest.mark.parametrize(
    ("predicate", "expected"),
    [
        ("[0, 1] = x / 10", []),
        ("[-1, 0] = -x / 10", ["never"]),
        ("[-1, 0] = x / 10 - 1", ["never"]),
        ("[-1, 1] = x / 10 - 0.5", []),
        ("[0, 1] = (x + 1) / 11", ["always"]),
        ("[-1, 1] = when x > 5: -0.5 otherwise: -1", ["never"]),
        ("[-1, 1] = when x > 5: 0.5 otherwise: -1", []),
        ("[-1, 1] = when x > 11: 1 otherwise: -1", ["never"]),
        ("[-1, 1] = when x >= 10: 1 otherwise: -1", []),
        ("[0, 1] = (x / 10)^2", []),
        ("[-1, 0] = -(x / 10)^2", ["never"]),
        ("[-1, 1] = min(x / 10 - 0.5, 0.5 - x / 10)", ["never"]),
    ],
)
def test_constant_atoms_are_reported(predicate: str, expected: list[str]) -> None:
    before = f"signal x in [0, 10]\npredicate p in {predicate}\n"
    titles = [
        finding.diagnostic.title
        for finding in findings_in(block("reach p", before=before))
        if finding.diagnostic.code == "TLT0416"
    ]
    assert titles == [f"`p` {frequency} holds" for frequency in expected]


def test_an_atom_is_reported_once_per_file() -> None:
    before = "signal x in [0, 10]\npredicate p in [-1, 0] = -x / 10\n"
    assert codes(before + "spec one = F p\nspec two = G !p\n") == ["TLT0416"]


@times(40)
@given(PREDICATES)
def test_reported_atoms_are_constant_on_all_values(predicate: Predicate) -> None:
    _, reported = spec_and_findings(constant_atom.check, block("reach p", before=predicate.declaration))
    for finding in reported:
        truths = {value > 0 for value in predicate.values()}
        assert truths == {finding.title == "`p` always holds"}


SALES = "signal gold in [0, 100]\nsignal debt in [0, 100]\nsignal sold: bool\nsignal open: bool\n"
"""The signals of a shop."""


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        ("keep sold implies next(gold) > gold", "keep previously sold implies gold > previous(gold)"),
        ("keep sold implies next gold > gold", "keep previously sold implies gold > previous(gold)"),
        ("keep sold implies (weak_next(gold) >= gold)", "keep previously sold implies gold >= previous(gold)"),
        (
            "keep sold and open implies next(gold) - gold > 0",
            "keep previously (sold and open) implies gold - previous(gold) > 0",
        ),
        (
            "keep sold implies next(gold + debt) > gold + debt + 5",
            "keep previously sold implies (gold + debt) > previous(gold) + previous(debt) + 5",
        ),
    ],
)
def test_next_before_a_number_applies_to_the_comparison(clause: str, meant: str) -> None:
    (finding,) = (found for found in findings_in(block(clause, before=SALES)) if found.diagnostic.code == "TLT0416")
    assert finding.diagnostic.title.endswith(" holds")
    assert str(finding.diagnostic.help).endswith(f", not to the number: write `{meant}`")
    label = finding.diagnostic.labels[0]
    assert label.source.slice(label.span).startswith(("next", "weak_next"))
    assert set(codes(block(meant, before=SALES))) <= {"TLT0421"}


def test_what_the_help_of_next_says_is_compared_from_one_step_to_the_next() -> None:
    (fspa,) = compile_text(block("keep previously sold implies gold > previous(gold)", before=SALES))

    def is_kept(*samples: tuple[int, float]) -> bool:
        monitor = Monitor(fspa)
        steps = [monitor.step({"sold": sold, "gold": gold, "debt": 0.0, "open": 0.0}) for sold, gold in samples]
        return all(step.accepting for step in steps)

    assert is_kept((0, 5.0), (0, 5.0), (1, 5.0), (0, 6.0), (0, 1.0), (1, 1.0))
    assert not is_kept((1, 5.0), (0, 5.0))
    assert not is_kept((0, 5.0), (1, 6.0), (1, 7.0), (0, 6.0))


@pytest.mark.parametrize("clause", ["keep next(gold) > gold", "keep sold implies (open or next(gold) > gold)"])
def test_without_a_condition_only_the_comparison_is_named(clause: str) -> None:
    (finding,) = (found for found in findings_in(block(clause, before=SALES)) if found.diagnostic.code == "TLT0416")
    assert finding.diagnostic.help == (
        "`next` applies to the comparison `gold > gold`, not to the number: "
        "compare it one step later, where the step before is known: `gold > previous(gold)`"
    )
