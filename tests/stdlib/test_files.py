"""The libraries and examples have no diagnostics, are documented and tested, and agree with the oracle."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import pytest

from tests.resolve.helpers import valid_program
from tltlc.automaton.finite.build import build
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.core.source import SourceFile
from tltlc.expression.evaluate import evaluate
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import PredicateDecl, SignalDecl
from tltlc.logic.oracle import holds
from tltlc.monitor import Monitor
from tltlc.resolve.spec import Expect, RepeatedSample, ResolvedFile, Spec

ROOT = Path(__file__).parents[2]
LIBRARIES = sorted(path for path in (ROOT / "stdlib_predicates").glob("*.tltl") if "_tests" not in path.name)
TESTS = sorted((ROOT / "stdlib_predicates").glob("*_tests.tltl"))
EXAMPLES = sorted((ROOT / "examples").glob("*.tltl"))


def _program(path: Path) -> ResolvedFile:
    return valid_program(path.read_text(encoding="utf-8"), str(path))


@pytest.mark.parametrize("path", LIBRARIES, ids=lambda path: path.stem)
def test_every_predicate_is_documented_and_tested(path: Path) -> None:
    _program(path)
    module, _ = parse(SourceFile(str(path), path.read_text(encoding="utf-8")))
    tests = (path.parent / f"{path.stem}_tests.tltl").read_text(encoding="utf-8")
    steps = "\n".join(line for line in tests.splitlines() if line.strip().startswith("step"))
    for declaration in module.declarations:
        if isinstance(declaration, PredicateDecl):
            assert declaration.doc, declaration.name
            assert declaration.name in steps
        if isinstance(declaration, SignalDecl) and declaration.parameters:
            assert declaration.doc, declaration.name


@pytest.mark.parametrize("path", [*TESTS, *EXAMPLES], ids=lambda path: path.stem)
def test_the_test_blocks_agree_with_the_oracle(path: Path) -> None:
    program = _program(path)
    specs = {spec.name: spec for spec in program.specs}
    assert program.tests
    for test in program.tests:
        if specs[test.spec].registers:
            continue  # The oracle knows only letters; `tests/memory` checks what monitors remember.
        trace: list[frozenset[str]] = []
        for item in test.items:
            if isinstance(item, RepeatedSample):
                trace += [item.holds] * item.times
            elif item.kind == "verdict":
                assert _agrees(str(item.value), specs[test.spec], trace), (test.title, item)
        assert any(isinstance(item, Expect) and item.kind == "verdict" for item in test.items)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_recorded_trace_is_accepted(path: Path) -> None:
    program = _program(path)
    with path.with_suffix(".csv").open(encoding="utf-8") as file:
        samples = [{name: _cell(text) for name, text in row.items()} for row in csv.DictReader(file)]
    assert 20 <= len(samples) <= 400
    spec = program.specs[0]
    assert {signal.name for signal in spec.signals} <= set(samples[0])
    for signal in spec.signals:
        values = [sample[signal.name] for sample in samples]
        assert min(values) >= (signal.low if signal.low is not None else min(values))
        assert max(values) <= (signal.high if signal.high is not None else max(values))
    assert spec.limit_steps is None or len(samples) <= spec.limit_steps
    if spec.registers:
        monitor = Monitor(build(spec))
        assert [monitor.step(sample).accepting for sample in samples][-1]
        return
    trace = [_atoms(spec, sample) for sample in samples]
    if spec.semantics == "finite":
        assert holds(spec.formula, trace)
    else:
        assert any(holds_on_lasso(spec.formula, trace, cycle) for cycle in _cycles(spec))
    for group in spec.exclusive:
        names = {spec.atoms[i].name for i in group}
        assert all(len(names & _atoms(spec, sample)) <= 1 for sample in samples)


def _agrees(verdict: str, spec: Spec, trace: list[frozenset[str]]) -> bool:
    """Whether the oracle agrees with a verdict; over infinite traces, it judges continuations of the trace."""
    if spec.semantics == "finite":
        return holds(spec.formula, trace) == (verdict in ("satisfied", "holding"))
    answers = {holds_on_lasso(spec.formula, trace, cycle) for cycle in _cycles(spec)}
    return answers == {"satisfied": {True}, "violated": {False}}.get(verdict, {True, False})


def _cycles(spec: Spec) -> Iterator[tuple[frozenset[str], ...]]:
    """Yield every cycle of up to three samples that the exclusive atoms allow."""
    names = [atom.name for atom in spec.atoms]
    groups = [{names[place] for place in group} for group in spec.exclusive]
    candidates = (
        frozenset(name for name, is_true in zip(names, row, strict=True) if is_true)
        for row in product((False, True), repeat=len(names))
    )
    samples = [sample for sample in candidates if all(len(sample & group) <= 1 for group in groups)]
    for length in (1, 2, 3):
        yield from product(samples, repeat=length)


def _cell(text: str) -> float:
    return {"true": 1.0, "false": 0.0}.get(text) if text in ("true", "false") else float(text)  # type: ignore[return-value]


def _atoms(spec: Spec, sample: dict[str, float]) -> frozenset[str]:
    params = {param.name: param.value for param in spec.params}
    return frozenset(atom.name for atom in spec.atoms if evaluate(atom.expression, sample, params) > 0)
