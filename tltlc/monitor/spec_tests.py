"""Run the ``test`` blocks of a program: traces of atoms, with expectations."""

from __future__ import annotations

from collections.abc import Iterable
from operator import ge, gt, le, lt
from typing import Final

from tltlc.automaton.fspa import NOTATIONS, Fspa
from tltlc.automaton.text import label_text
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.monitor.monitor import Monitor, Step
from tltlc.monitor.samples import MonitorError, number_text
from tltlc.resolve.spec import Expect, ResolvedFile, Test

_COMPARISONS: Final = {"<": lt, "<=": le, ">": gt, ">=": ge}

_TOLERANCE: Final = 1e-12
"""Allows for the rounding of sums: 0.1 + 0.2 counts as 0.3, so it meets ``progress >= 0.3``, not ``progress < 0.3``."""


@record
class TestResult:
    """A test and its failure.

    The failure is a diagnostic for the first expectation that fails, or for a sample in which
    exclusive atoms hold; None if the test passed.
    """

    test: Test
    failure: Diagnostic | None

    @property
    def passed(self) -> bool:
        """Whether every expectation held."""
        return self.failure is None


def run_tests(program: ResolvedFile, automata: Iterable[Fspa]) -> tuple[TestResult, ...]:
    """Return the results of a program's tests, in order. Tests of specs without an automaton are skipped."""
    by_name = {fspa.name: fspa for fspa in automata}
    return tuple(run_test(test, by_name[test.spec]) for test in program.tests if test.spec in by_name)


def run_test(test: Test, fspa: Fspa) -> TestResult:
    """Return the result of one test. An atom that a step names has the robustness 1, every other atom -1.

    Each expectation judges the prefix so far. Diagnostics: TLT0640 an expectation fails, TLT0614
    exclusive atoms hold in one step.
    """
    monitor = Monitor(fspa)
    last: Step | None = None
    for item in test.items:
        if isinstance(item, Expect):
            failure = _failed_expectation(item, last, fspa)
            if failure is not None:
                return TestResult(test, failure)
            continue
        values = [1.0 if atom.name in item.holds else -1.0 for atom in fspa.atoms]
        try:
            for _ in range(item.times):
                before, last = last, monitor.step_atoms(values)
                if last == before:
                    break  # repeating the same sample would change nothing
        except MonitorError as error:
            label = Label(test.source, test.span, "in this test")
            advice = "let each step name one of them at most"
            return TestResult(test, replace(error.diagnostics[0], labels=(label,), help=advice))
    return TestResult(test, None)


def _failed_expectation(expect: Expect, step: Step | None, fspa: Fspa) -> Diagnostic | None:
    """Return why the expectation fails; None if it holds."""
    if step is None:
        return _failure(expect, "a trace has at least one sample", "put a `step` before the first `expect`")
    if expect.kind == "verdict":
        if expect.value != step.verdict:
            return _failure(expect, f"it is {step.verdict}", _remaining_text(step, fspa))
    elif expect.kind == "progress":
        if not _meets(step.progress, expect):
            return _failure(expect, f"the progress is {number_text(step.progress)}", _remaining_text(step, fspa))
    else:
        texts = [label_text(fspa, step.state, notation) for notation in NOTATIONS]
        if _without_blanks(str(expect.value)) not in map(_without_blanks, texts):
            return _failure(expect, f"the state is `{step.label}`", "`tltlc render` shows every state with its label")
    return None


def _meets(progress: float, expect: Expect) -> bool:
    value = float(expect.value)
    if abs(progress - value) <= _TOLERANCE:
        progress = value
    return bool(_COMPARISONS[expect.comparison or ">="](progress, value))


def _without_blanks(label: str) -> str:
    """Return a label without white space, so that `F (a)` and `F(a)` compare equal."""
    return "".join(label.split())


def _remaining_text(step: Step, fspa: Fspa) -> str | None:
    return None if step.label in ("true", "false") else f"what remains: {label_text(fspa, step.state)}"


def _failure(expect: Expect, remark: str, help: str | None = None) -> Diagnostic:  # noqa: A002
    return Diagnostic("TLT0640", "this expectation does not hold", (Label(expect.source, expect.span, remark),), help)
