"""Monitors of automata with many states are small, and equal to the last bit in every language."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

import pytest

from tests.backends.monitors import Programs, expected, trace_of
from tests.backends.state_tables import counting, in_order, with_tables
from tests.tools.conformance.runner import Runner, build_program, output_differences, runners
from tests.waiting import HANG_S
from tltlc import backends
from tltlc.automaton.text import label_text
from tltlc.monitor import Monitor
from tltlc.tools.conformance.corpus import CASES, is_exact
from tltlc.tools.conformance.expected_output import expected_output

LARGEST: Final = {
    "c": 81_000,
    "csharp": 70_000,
    "gdscript": 60_000,
    "gdscript3": 60_000,
    "javascript": 45_000,
    "lua": 50_000,
    "python": 50_000,
    "rust": 80_000,
}
"""The most bytes of the monitor of an automaton with 602 states. With code for each state, it had 190,000 or more."""


def _usable(among: Iterable[Runner]) -> Iterator[Any]:
    for runner in among:
        reason = runner.missing()
        yield pytest.param(runner, id=runner.name, marks=[pytest.mark.skip(reason=reason)] if reason else [])


@pytest.mark.parametrize("target", sorted(LARGEST))
def test_the_monitor_of_600_states_is_small(target: str) -> None:
    for text in backends.emit(target, counting()).values():
        assert isinstance(text, str)
        assert len(text.encode()) < LARGEST[target]


@pytest.mark.parametrize("runner", list(_usable(runners())))
def test_every_counting_state_agrees_with_the_monitor(runner: Runner, tmp_path: Path) -> None:
    fspa = counting()
    held = [0.0, 1.0, *[0.0] * 610, 1.0, *[0.0] * 300, 1.0, 0.0]
    samples = [{"pit": value} for value in held]
    programs = Programs(runner, tmp_path, [fspa])
    (outcome,) = programs.run((0, trace_of(samples, ["pit"])))
    assert outcome == expected(fspa, samples)


@pytest.mark.parametrize("runner", list(_usable(runners())))
def test_small_automata_with_tables_match_the_expected_rows(runner: Runner, tmp_path: Path) -> None:
    """The corpus has automata of all kinds, which usually have no tables."""
    cases = [CASES[name]() for name in [*CASES][1 :: 9 if runner.name in ("c++", "rust") else 3]]
    runs = [(case, trace) for case in cases for trace in case.traces]
    with with_tables():
        run = build_program(runner, [case.fspa for case in cases], tmp_path)
    for (case, trace), outcome in zip(runs, run([(case.fspa.name, trace) for case, trace in runs]), strict=True):
        tolerance = 0.0 if is_exact(case.fspa) else runner.tolerance
        assert not list(output_differences(outcome, expected_output(case.fspa, trace), tolerance)), case.fspa.name


DRIVERS: Final = {
    "javascript": (
        "labels.mjs",
        """
import { Monitor } from "./quiet_monitor.mjs";
const monitor = new Monitor();
for (let i = 0; i < 620; i++) console.log("@ " + monitor.step({ pit: i === 0 || i === 610 || i === 612 }).label);
""",
        (("node", "labels.mjs"),),
    ),
    "lua": (
        "labels.lua",
        """
local monitor = require("quiet_monitor").new()
for i = 0, 619 do print("@ " .. monitor:step({ pit = i == 0 or i == 610 or i == 612 }).label) end
""",
        (("lua", "labels.lua"),),
    ),
    "csharp": (
        "labels.cs",
        """
public static class Labels
{
    public static void Main()
    {
        var monitor = new Tltl.QuietMonitor();
        for (int i = 0; i < 620; i++)
        {
            var sample = Tltl.QuietMonitor.Signals.Missing;
            sample.Pit = i == 0 || i == 610 || i == 612;
            System.Console.WriteLine("@ " + monitor.Step(sample).Label);
        }
    }
}
""",
        (("mcs", "labels.cs", "QuietMonitor.cs"), ("mono", "labels.exe")),
    ),
    "gdscript3": (
        "labels.gd",
        """
extends SceneTree

const Monitor = preload("quiet_monitor.gd")


func _init():
	var monitor = Monitor.new()
	var sample = Monitor.Sample.new()
	for i in range(620):
		sample.pit = i == 0 or i == 610 or i == 612
		monitor.step(sample)
		print("@ " + monitor.label())
	quit()
""",
        (("env", "LANG=en", "godot3-server", "--path", ".", "-s", "labels.gd"),),
    ),
    "python": (
        "labels.py",
        """
from quiet_monitor import Monitor
monitor = Monitor()
for i in range(620): print("@", monitor.step({"pit": i in (0, 610, 612)}).label)
""",
        ((sys.executable, "labels.py"),),
    ),
}
"""For each language whose monitors make labels from texts and numbers: a file that prints them, and the commands."""


IN_WORDS: Final = {
    "javascript": (".label)", ".label_english)"),
    "lua": (".label)", ".label_english)"),
    "python": (".label)", ".label_english)"),
}
"""What to replace in a driver so that it prints the labels in words."""


@pytest.mark.parametrize("target", DRIVERS)
def test_labels_are_those_of_the_automaton(target: str, tmp_path: Path) -> None:
    labels = [str(counting().states[state].label) for state in _states()]
    assert _printed_labels(target, DRIVERS[target][1], tmp_path) == labels
    assert len(set(labels)) == 602


@pytest.mark.parametrize("target", IN_WORDS)
def test_labels_in_words_are_those_of_the_automaton(target: str, tmp_path: Path) -> None:
    driver = DRIVERS[target][1].replace(*IN_WORDS[target])
    assert _printed_labels(target, driver, tmp_path) == [label_text(counting(), state) for state in _states()]


def _states() -> list[int]:
    """Return the states that the drivers enter."""
    monitor = Monitor(counting())
    return [monitor.step({"pit": float(i in (0, 610, 612))}).state for i in range(620)]


def _printed_labels(target: str, driver: str, tmp_path: Path) -> list[str]:
    file, _, commands = DRIVERS[target]
    if reason := next(runner for runner in runners() if runner.target == target).missing():
        pytest.skip(reason)
    for name, text in backends.emit(target, counting()).items():
        assert isinstance(text, str)
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / file).write_text(driver, encoding="utf-8")
    for command in commands:
        process = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=HANG_S, check=True)
    # The engine also prints its version.
    return [line.removeprefix("@ ") for line in process.stdout.splitlines() if line.startswith("@ ")]


def test_godot_finds_one_of_many_states_by_few_tests() -> None:
    script = backends.emit("gdscript3", in_order(70))["spec_monitor.gd"]
    assert isinstance(script, str)
    tests = [line for line in script.splitlines() if line.lstrip().startswith("if state < ")]
    assert len(tests) == 70
    assert max(line.count("\t") for line in tests) <= math.log2(128)
