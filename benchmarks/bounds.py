"""Measure bounds that are timers: compiling, sizes, and monitors beside handwritten C, RTAMT and Reelay.

``python -m benchmarks.bounds compile`` measures compiling in a process of its own, and ``python -m
benchmarks.bounds SPEC`` the monitors of a spec. Before anything is timed, they are compared: C
monitors on random traces, step by step, and all monitors on the trace of the measurement.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from random import Random
from types import ModuleType
from typing import Any, Final

from benchmarks.bounded_peers import PEERS
from benchmarks.bounds_c import TIMED, build, disagreement, time_rounds
from benchmarks.bounds_specs import NAMES, SPECS, Trace, trace
from benchmarks.measure import median, quartiles, run, run_in_fork
from benchmarks.monitors import rounds_of
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.monitor import Monitor

SECTION = "bounds"
ROUNDS: Final = 15
PYTHON_ROUNDS: Final = 5
SAMPLES: Final = 3000
RANDOM_TRACES: Final = 60
PEER_TRACES: Final = 5
TARGETS: Final = {"artefact": "json", "C": "c", "C#": "csharp", "GDScript": "gdscript"}
TIMEOUT_S: Final = 1200.0


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure what has no record in the store, or was made by another compiler."""
    measure_missing(
        store, SECTION, ("compile", *NAMES), _measure_in_process, say, field="rounds", current={"source": _source()}
    )


def _source() -> str:
    return source_digest("tltlc")


def _measure_in_process(name: str) -> Record:
    process_run = run([sys.executable, "-m", "benchmarks.bounds", name], TIMEOUT_S, cwd=ROOT)
    record: Record = (
        json.loads(process_run.output) if process_run.status == 0 else {"failed": f"exit status {process_run.status}"}
    )
    return record


def compile_times() -> Record:
    """Return the CPU times of compiling each spec to an artefact, in ms, and the bytes of what is written for it."""

    def compiled(text: str) -> dict[str, Any]:
        (fspa,) = compile_text(text)
        return {"states": len(fspa.states), "bytes": _size(emit("json", fspa))}

    rounds: list[dict[str, dict[str, Any]]] = []
    for _ in range(ROUNDS):
        results = {name: run_in_fork(lambda text=text: compiled(text)) for name, text in SPECS.items()}  # type: ignore[misc]
        rounds.append({name: result for name, result in results.items() if result is not None})
    sizes = {}
    for name, text in SPECS.items():
        (fspa,) = compile_text(text)
        sizes[name] = {title: _size(emit(target, fspa)) for title, target in TARGETS.items()}
    return {
        "rounds": ROUNDS,
        "states": {name: rounds[0][name]["states"] for name in SPECS},
        "cpu_ms": {name: round(median([results[name]["cpu_ms"] for results in rounds]), 2) for name in SPECS},
        "bounded_to_unbounded": quartiles(
            [results["deadlines"]["cpu_ms"] / results["unbounded"]["cpu_ms"] for results in rounds]
        ),
        "command_cpu_ms": _command_times(),
        "bytes": sizes,
        "source": _source(),
    }


def _command_times() -> float:
    """Return the median CPU time of the whole command that compiles the example for three engines, in ms."""
    targets = ",".join(target for target in TARGETS.values() if target != "json")
    with tempfile.TemporaryDirectory() as folder:
        example = str(ROOT / "examples/metroidvania.tltl")
        command = [sys.executable, "-m", "tltlc", "compile", example, "-t", targets, "-o"]
        times = []
        for place in range(ROUNDS):
            command_run = run([*command, f"{folder}/{place}"], TIMEOUT_S, cwd=ROOT)
            assert command_run.status == 0, command_run.output
            times.append(command_run.cpu_ms)
    return round(median(times), 1)


def _size(files: Mapping[str, str | bytes]) -> int:
    return sum(len(content.encode() if isinstance(content, str) else content) for content in files.values())


def compare_monitors(name: str) -> Record:
    """Return the steps per second of all monitors of a spec on a trace that breaks no rule.

    Raises AssertionError if monitors disagree.
    """
    (fspa,) = compile_text(SPECS[name])
    random = Random(name)
    samples = trace(name, random, SAMPLES)
    module = ModuleType("generated")
    sys.modules[module.__name__] = module
    exec(compile(next(iter(emit("python", fspa).values())), f"{name}_monitor.py", "exec"), module.__dict__)
    generated = module.Monitor()
    verdicts = {generated.step(sample).verdict for sample in samples}
    assert verdicts == {"pending", "holding"}, f"the trace breaks a rule, or wakes none: {verdicts}"

    def run_generated() -> None:
        generated.reset()
        step = generated.step
        for sample in samples:
            step(sample)

    passes: dict[str, Callable[[], None]] = {"generated": run_generated}
    left_out: dict[str, str] = {}
    broken = random_traces(name, random, PEER_TRACES, 1500)
    for title in PEERS:
        try:
            for samples_of_run in (*broken, samples):
                passes[title] = peer_pass(title, name, samples_of_run, fspa)
        except ImportError:
            left_out[title] = "not installed"
    record: Record = {"samples": SAMPLES, "rounds": ROUNDS, "left_out": left_out, "source": _source()}
    record["python_steps_per_s"] = {
        title: round(median(rates)) for title, rates in rounds_of(passes, SAMPLES, PYTHON_ROUNDS).items()
    }
    if shutil.which("gcc") is None:
        left_out["C"] = "gcc is not installed"
        return record
    with tempfile.TemporaryDirectory() as folder:
        traces = [samples, *random_traces(name, random, RANDOM_TRACES, 1500)]
        program = build(name, Path(folder), traces)
        difference = disagreement(program)
        assert difference is None, difference
        rounds = time_rounds(program, ROUNDS)
    return record | {
        "random_traces": RANDOM_TRACES,
        "c_steps_per_s": {author: round(median([rates[author] for rates in rounds])) for author in TIMED},
        "to": {author: quartiles([rates["generated"] / rates[author] for rates in rounds]) for author in TIMED[1:]},
        "no_registers_to": {
            author: quartiles([rates["no_registers"] / rates[author] for rates in rounds]) for author in TIMED[2:]
        },
        "generated_verdict_to": {
            author: quartiles([rates["generated_verdict"] / rates[author] for rates in rounds]) for author in TIMED[3:]
        },
    }


def random_traces(name: str, random: Random, count: int, length: int) -> list[Trace]:
    """Return random traces of which about half break a rule."""
    return [trace(name, random, random.randint(1, length), random.choice((0.9, 1.0, 1.05, 2.0))) for _ in range(count)]


def peer_pass(title: str, name: str, samples: Trace, fspa: Fspa) -> Callable[[], None]:
    """Return a pass of a peer over a trace.

    Raises AssertionError if it judges a prefix otherwise than the monitor of an automaton, ImportError if
    it is not installed.
    """
    run_pass, outputs = PEERS[title](name, samples)
    monitor = Monitor(fspa)
    accepting = [monitor.step(sample).accepting for sample in samples]
    assert [value > 0 for value in outputs()] == accepting, f"{title} judges the trace otherwise"
    return run_pass


def main() -> None:
    """Measure what the command line names, and print the record."""
    name = sys.argv[1]
    print(json.dumps(compile_times() if name == "compile" else compare_monitors(name)))


if __name__ == "__main__":
    main()
