"""Run the ``test`` blocks of a source text: traces of atoms, with expectations."""

from __future__ import annotations

from collections.abc import Iterable
from operator import ge, gt, le, lt
from typing import Final

from tltlc.automaton.fspa import NOTATIONS, Fspa
from tltlc.automaton.text import label_text
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.monitor.errors import MonitorError
from tltlc.monitor.failure_words import failure_words
from tltlc.monitor.monitor import Monitor, Step
from tltlc.monitor.samples import number_text
from tltlc.resolve.spec import Expect, ResolvedFile, Test

_COMPARISONS: Final = {"<": lt, "<=": le, ">": gt, ">=": ge}

_TOLERANCE: Final = 1e-12
"""Numbers whose difference is at most this count as equal, so that 0.1 + 0.2 is not above 0.3."""


@record
class TestResult:
    """The result of a ``test`` block.

    ``failure`` is a diagnostic about the first expectation that fails, or about a sample at which
    exclusive atoms hold together. It is None if the test passed.
    """

    test: Test
    failure: Diagnostic | None

    @property
    def passed(self) -> bool:
        """Whether the test passed."""
        return self.failure is None


def run_tests(program: ResolvedFile, automata: Iterable[Fspa]) -> tuple[TestResult, ...]:
    """Run the tests of a source text, and return their results in order.

    A test is skipped if ``automata`` has no automaton for the spec that it tests.
    """
    by_name = {fspa.name: fspa for fspa in automata}
    return tuple(run_test(test, by_name[test.spec]) for test in program.tests if test.spec in by_name)


def run_test(test: Test, fspa: Fspa) -> TestResult:
    """Run one test of a spec on the automaton of the spec, and return the result.

    At each ``step`` of the test, the atoms that the step names have the value 1, and all other atoms -1,
    except those that follow from others or from numbers of the test (:meth:`Monitor.step_test`). An
    ``expect`` is about the trace of all steps before it. The test ends with the first failure, which has
    the code TLT0640 if an expectation fails, or TLT0614 if exclusive atoms hold at the same step.
    """
    monitor = Monitor(fspa)
    last: Step | None = None
    for item in test.items:
        if isinstance(item, Expect):
            failure = _failed_expectation(item, last, monitor)
            if failure is not None:
                return TestResult(test, failure)
            continue
        try:
            for _ in range(item.times):
                before, registers = last, monitor.registers
                last = monitor.step_test(item.numbers, item.holds, item.dt_s if fspa.clock_varies else None)
                if last == before and monitor.registers == registers:
                    break  # Further steps with the same sample would give the same result.
        except MonitorError as error:
            label = Label(test.source, test.span, "in this test")
            advice = "name at most one of them in each step"
            return TestResult(test, replace(error.diagnostics[0], labels=(label,), help=advice))
    return TestResult(test, None)


def _failed_expectation(expect: Expect, step: Step | None, monitor: Monitor) -> Diagnostic | None:
    """Return a diagnostic if an ``expect`` of a test fails; None if it holds.

    ``step`` is the last step of ``monitor`` before the expectation; None if the test begins with it.
    """
    fspa = monitor.fspa
    if step is None:
        return _failure(expect, "a trace has at least one sample", "put a `step` before the first `expect`")
    if expect.kind == "verdict":
        if expect.value != step.verdict:
            why = None if monitor.failure is None else failure_words(fspa, monitor.failure)
            return _failure(expect, f"it is {step.verdict}", why or _remaining_text(step, fspa))
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
    """Return the label of a state without white space, so that `F (a)` and `F(a)` compare equal."""
    return "".join(label.split())


def _remaining_text(step: Step, fspa: Fspa) -> str | None:
    return None if step.label in ("true", "false") else f"what remains: {label_text(fspa, step.state)}"


def _failure(expect: Expect, message: str, help: str | None = None) -> Diagnostic:  # noqa: A002
    return Diagnostic("TLT0640", "this expectation does not hold", (Label(expect.source, expect.span, message),), help)
