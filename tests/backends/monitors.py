"""Helpers for tests of monitors in other languages: the expected output of a program, and its traces."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from hypothesis import HealthCheck, Phase, assume, settings
from hypothesis import strategies as st

from tests.tools.conformance.runner import Outcome, Runner, build_program
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.expression.tree import Expression
from tltlc.logic import formula as f
from tltlc.monitor import Monitor, MonitorError
from tltlc.resolve import spec

HEADER = ["step", "state", "verdict", "accepting", "done", "progress", "reward", "robustness", "limiting"]
HEADER += ["failed_clause", "failed_atom", "failed_step"]
FAR = {"distance(s1)": 20.0, "distance(s2)": 20.0, "distance(exit)": 20.0, "health": 1.0}
HEAD = "health,distance(s1),distance(s2),distance(exit)\n"

Drawn = TypeVar("Drawn")

batches = settings(
    max_examples=1,
    deadline=None,
    derandomize=True,
    phases=(Phase.generate,),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.function_scoped_fixture],
)

Sample = Mapping[str, float]


def different(data: st.DataObject, strategy: st.SearchStrategy[Drawn], count: int) -> list[Drawn]:
    """Draw values that are not all equal. Otherwise Hypothesis first tries the simplest value for each of them."""
    values = [data.draw(strategy) for _ in range(count)]
    assume(any(value != values[0] for value in values))
    return values


class Programs:
    """The programs of several automata, built together, so that their files share a folder."""

    def __init__(self, runner: Runner, folder: Path, fspas: Sequence[Fspa]) -> None:
        self.fspas = [replace(fspa, name=f"spec{number}") for number, fspa in enumerate(fspas)]
        self._run = build_program(runner, self.fspas, folder)

    def run(self, *runs: tuple[int, str]) -> list[Outcome]:
        """Run programs with ``--full``, each given by the number of its automaton and its trace."""
        return self._run([(self.fspas[number].name, trace.encode()) for number, trace in runs])


def trace_of(samples: Sequence[Sample], names: Sequence[str]) -> str:
    """Return the samples as CSV.  The names are quoted, since a trace that begins with `{` is read as JSON."""
    text = io.StringIO()
    csv.writer(text, quoting=csv.QUOTE_ALL).writerow([*names, "unused"])
    csv.writer(text).writerows([*(repr(sample[name]) for name in names), "-"] for sample in samples)
    return text.getvalue()


def expected(fspa: Fspa, samples: Sequence[Sample]) -> Outcome:
    """Return the expected status, output and errors of the program."""
    monitor, text, status, errors = Monitor(fspa), io.StringIO(), 0, ""
    rows = csv.writer(text, lineterminator="\n")
    for sample in samples:
        try:
            step = monitor.step(sample)
        except MonitorError as error:
            status, errors = 1, f"error: {error.diagnostics[0].title}\n"
            break
        if monitor.steps == 1:
            rows.writerow(HEADER)
        flags = ["true" if flag else "false" for flag in (step.accepting, step.done)]
        figures = [f"{value:.17g}" for value in (step.progress, step.reward, step.robustness)]
        texts = (step.limiting, step.failed_clause, step.failed_atom, step.failed_step)
        names = ["" if text is None else str(text).replace("\0", "") for text in texts]
        rows.writerow([monitor.steps, step.state, step.verdict, *flags, *figures, *names])
    warnings = "".join(f"warning: {notice.title}\n" for notice in monitor.notices)
    return status, text.getvalue(), errors + warnings


def one_atom(expression: Expression, *signals: spec.Signal) -> Fspa:
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    return replace(fspa, signals=signals, atoms=(spec.Atom("p", expression),), params=())
