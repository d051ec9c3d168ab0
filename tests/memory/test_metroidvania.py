"""Monitors of the rules of a game agree with the definition, in the languages of engines, on random traces.

The rules are those of ``examples/metroidvania.tltl``, whose bounds become timers, at a slower clock: the
definition looks at every sample of every window.
"""

from __future__ import annotations

import csv
import io
from functools import cache
from pathlib import Path
from random import Random
from typing import Final

import pytest

from tests.backends.monitors import trace_of
from tests.memory.definition import Definition, formula
from tests.tools.conformance.runner import Runner, build_program, runners
from tests.tools.conformance.runners.c import WITHOUT_REGISTERS
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.grammar.module import Module
from tltlc.monitor import Monitor
from tltlc.pipeline import Session

EXAMPLE: Final = Path(__file__).resolve().parents[2] / "examples/metroidvania.tltl"
RULES: Final = (
    "always (boss_door implies once double_jump)",
    "always (all p in pits: begins falls(p) implies next always for 10 s not begins falls(p))",
    "always (begins damage implies next always for 1 s not damage)",
    "always (alarm implies all g in guards: eventually within 5 s answers(g))",
)
LONGEST: Final = 40
REST: Final = 21
"""The least samples from a fall to another one into the same pit: 10 s are 20 steps."""
DEADLINE: Final = 10
"""The most samples from an alarm to the answer of a guard."""

ENDS: Final = 4
"""The most prefixes of a trace at which acceptance is compared."""

BATCH: Final = 1000
TARGETS: Final = ("c", "csharp", "gdscript", "gdscript3")
RUNNERS: Final = {
    runner.name: runner
    for runner in (*runners(), WITHOUT_REGISTERS)
    if runner.target in TARGETS and runner.name != "c++"
}

Trace = list[dict[str, float]]


@cache
def rules() -> tuple[Module, Fspa]:
    """Return the module and the automaton of the rules, at 2 Hz."""
    session = Session(SourceFile("<rules>", EXAMPLE.read_text(encoding="utf-8").replace("60 Hz", "2 Hz")))
    (fspa,) = session.automata
    return session.module, fspa


def random_trace(random: Random) -> Trace:
    """Return a trace that tries one or two of the rules, so that late violations of each are seen."""
    tried = random.sample(("boss_door", "falls", "damage", "alarm"), random.randint(1, 2))
    chances = {signal.name: 0.0 for signal in rules()[1].signals}
    for name in chances:
        if name.startswith(tuple(tried)):
            chances[name] = random.choice((0.01, 0.03, 0.1))
        elif name.startswith(("answers", "double_jump")):
            chances[name] = random.choice((0.05, 0.15, 0.4))
    trace = [
        {name: float(random.random() < chance) for name, chance in chances.items()}
        for _ in range(random.randint(1, LONGEST))
    ]
    # Two falls into a pit, and an alarm and its answer, about as far apart as they may be.
    if "falls" in tried:
        stage(trace, ("falls(pit1)", "falls(pit1)"), REST + random.randint(-1, 1), random)
    if "alarm" in tried:
        stage(trace, ("alarm", "answers(g2)"), DEADLINE + random.randint(-1, 1), random)
    return trace


def stage(trace: Trace, names: tuple[str, str], gap: int, random: Random) -> None:
    """Let two signals be true only once each, ``gap`` samples after each other, if the trace is long enough."""
    if len(trace) > gap:
        first = random.randrange(len(trace) - gap)
        for i, sample in enumerate(trace):
            sample |= dict.fromkeys(names, 0.0)
            for name, place in zip(names, (first, first + gap), strict=True):
                if i == place:
                    sample[name] = 1.0


def check(verdicts: list[str], trace: Trace, random: Random) -> set[str]:
    """Compare the verdicts after each sample of a trace with the definition; return those that occurred."""
    assert len(verdicts) == len(trace)
    definition = Definition(rules()[0], trace, {})
    requirements = [formula(rule) for rule in RULES]
    breaks = [i for i, verdict in enumerate(verdicts) if verdict == "violated"]
    # The first violation, the sample before it, and the last sample are where an error would be seen.
    ends = {len(trace) - 1, *breaks[:1], *(i - 1 for i in breaks[:1] if i)}
    while len(ends) < min(ENDS, len(trace)):
        ends.add(random.randrange(len(trace)))
    for i in ends:
        holds = all(definition.holds(requirement, end=i + 1) for requirement in requirements)
        assert (verdicts[i] in ("satisfied", "holding")) == holds, f"after sample {i}"
    assert breaks == [*range(breaks[0] if breaks else len(trace), len(trace))], "a violation stays"
    return set(verdicts)


def check_runner(runner: Runner, count: int, folder: Path) -> None:
    """Compare the program of a language with the definition, on random traces."""
    fspa, random = rules()[1], Random(f"{runner.name} {count}")
    names = [signal.name for signal in fspa.signals]
    run = build_program(runner, [fspa], folder)
    found: set[str] = set()
    for first in range(0, count, BATCH):
        traces = [random_trace(random) for _ in range(min(BATCH, count - first))]
        outcomes = run([(fspa.name, trace_of(trace, names).encode()) for trace in traces])
        for trace, (status, output, errors) in zip(traces, outcomes, strict=True):
            assert (status, errors) == (0, "")
            found |= check([row["verdict"] for row in csv.DictReader(io.StringIO(output))], trace, random)
    assert found == {"holding", "pending", "violated"}


def test_timers_keep_the_rules() -> None:
    fspa = rules()[1]
    assert len(fspa.states) == 3
    assert any(register.name.startswith("waiting") for register in fspa.registers)


def test_the_monitor_agrees_with_the_definition() -> None:
    random, monitor = Random("rules"), Monitor(rules()[1])
    for _ in range(200):
        monitor.reset()
        trace = random_trace(random)
        check([monitor.step(sample).verdict for sample in trace], trace, random)


def test_a_wrong_verdict_is_found() -> None:
    calm = dict.fromkeys((signal.name for signal in rules()[1].signals), 0.0)
    with pytest.raises(AssertionError, match="after sample 1"):
        check(["holding", "holding"], [calm, calm | {"boss_door": 1.0}], Random(0))
    with pytest.raises(AssertionError, match="after sample 0"):
        check(["violated"], [calm], Random(0))


@pytest.mark.parametrize("runner", RUNNERS.values(), ids=RUNNERS)
def test_engines_agree_with_the_definition(runner: Runner, tmp_path: Path) -> None:
    if reason := runner.missing():
        pytest.skip(reason)
    check_runner(runner, 300, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("runner", RUNNERS.values(), ids=RUNNERS)
def test_engines_agree_with_the_definition_on_many_traces(runner: Runner, tmp_path: Path) -> None:
    if reason := runner.missing():
        pytest.skip(reason)
    check_runner(runner, 10_000, tmp_path)
