"""Monitors of specs with bounds: generated, handwritten and the peers' agree on random traces."""

from __future__ import annotations

import shutil
from pathlib import Path
from random import Random

import pytest

from benchmarks import bounds_report
from benchmarks.bounds import SECTION, peer_pass, random_traces
from benchmarks.bounds_c import TIMED, Program, build, disagreement
from benchmarks.bounds_specs import NAMES, SPECS, trace
from benchmarks.store import Store
from tltlc import compile_text
from tltlc.monitor import Monitor


@pytest.mark.parametrize("name", NAMES)
def test_c_monitors_agree_at_every_step(name: str, tmp_path: Path) -> None:
    if shutil.which("gcc") is None:
        pytest.skip("gcc is not installed")
    program = build(name, tmp_path, random_traces(name, Random(name), 20, 1500))
    assert disagreement(program) is None
    assert {verdict for verdicts in program.verdicts for verdict in verdicts} == {"holding", "pending", "violated"}
    first, *rest = program.verdicts
    wrong = Program(program.folder, (("violated", *first[1:]), *rest))
    assert disagreement(wrong) == f"generated, step 0: {first[0]}, not violated"


@pytest.mark.parametrize("name", NAMES)
def test_the_timed_trace_breaks_no_rule(name: str) -> None:
    (fspa,) = compile_text(SPECS[name])
    monitor = Monitor(fspa)
    assert {monitor.step(sample).verdict for sample in trace(name, Random(name), 3000)} == {"holding", "pending"}


@pytest.mark.parametrize(("peer", "module"), [("RTAMT", "rtamt"), ("Reelay", "reelay")])
@pytest.mark.parametrize("name", NAMES)
def test_peers_judge_random_traces_alike(name: str, peer: str, module: str) -> None:
    pytest.importorskip(module)
    (fspa,) = compile_text(SPECS[name])
    for samples in random_traces(name, Random(peer), 2, 1000):
        peer_pass(peer, name, samples, fspa)


def test_the_report_says_which_goals_are_missed(tmp_path: Path) -> None:
    store = Store(tmp_path / "results.json")
    assert bounds_report.section(store) == ""
    assert not [*bounds_report.goals(store)]
    sizes = {"artefact": 31_000, "C": 70_000, "C#": 90_000, "GDScript": 60_000}
    compiled = {
        "rounds": 15,
        "states": dict.fromkeys(SPECS, 3),
        "cpu_ms": dict.fromkeys(SPECS, 20.0),
        "bounded_to_unbounded": (1.0, 1.25, 2.0),
        "command_cpu_ms": 200.0,
        "bytes": dict.fromkeys(SPECS, sizes),
    }
    monitors = {
        "python_steps_per_s": {"generated": 300_000, "Reelay": 100_000},
        "c_steps_per_s": dict.fromkeys(TIMED, 5_000_000),
        "to": dict.fromkeys(TIMED[1:], (0.8, 0.85, 0.9)),
        "no_registers_to": dict.fromkeys(TIMED[2:], (0.8, 0.85, 0.9)),
        "generated_verdict_to": dict.fromkeys(TIMED[3:], (0.9, 0.95, 1.0)),
        "left_out": {"RTAMT": "not installed"},
    }
    store.put(SECTION, "compile", compiled)
    for name in NAMES:
        store.put(SECTION, name, monitors)
    verdicts = [row[2] for row in bounds_report.goals(store)]
    assert [verdict == "met" for verdict in verdicts] == [True, False, True, True, True, True, False, True, True]
    figures = " ".join(row[1] for row in bounds_report.goals(store))
    assert "deadlines 0.85 (0.85 with them)" in figures
    assert "deadlines 0.95 (0.85 with every field)" in figures
    text = bounds_report.section(store)
    assert "| Python, Reelay | 0.10 (Python generated 3.0 times as fast, C generated 50 times)" in text
    assert "Left out: RTAMT (not installed)." in text
