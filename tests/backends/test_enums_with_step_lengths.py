"""On a clock that varies, monitors have constants for the values of enums, too."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import pytest

from tests.backends.test_registers import needs, run
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.monitor import Monitor

TEXT: Final = """\
clock varies
signal mode: (idle, alert, chase)

spec hurry {
    keep mode is alert implies eventually within 2 s mode is chase
}
"""
SAMPLES: Final = (
    *(("idle", 0.0), ("alert", 0.5), ("idle", 1.5), ("chase", 0.5), ("alert", 9.0)),
    *(("idle", 1.0), ("alert", 0.75), ("idle", 0.5), ("chase", 0.25)),
)

C: Final = """
#include "hurry_monitor.h"
int main(void) {
    hurry_monitor monitor;
    hurry_result result;
    hurry_signals sample = hurry_empty();
    hurry_init(&monitor, NULL);
@@
    return 0;
}
"""
C_CALL: Final = """\
    sample.mode = hurry_mode_{value};
    if (!hurry_step(&monitor, &sample, {dt}, &result)) return 1;
    printf("%d\\n", result.state);
"""

RUST: Final = """
mod hurry_monitor;
use hurry_monitor::*;
fn main() {
    let mut monitor = Monitor::new();
@@
}
"""
RUST_CALL: Final = '    println!("{{}}", monitor.step(&Signals {{ mode: MODE_{upper} }}, {dt}).unwrap().state);\n'

CSHARP: Final = """
using M = Tltl.HurryMonitor;
internal static class Driver
{
    private static void Main()
    {
        var monitor = new M();
        var sample = M.Signals.Missing;
@@
    }
}
"""
CSHARP_CALL: Final = """\
        sample.Mode = M.Mode.{title};
        System.Console.WriteLine(monitor.Step(sample, {dt}).State);
"""

GODOT: Final = """
extends SceneTree
const Monitor = preload("hurry_monitor.gd")
func _init():
	var monitor = Monitor.new()
	var sample = Monitor.Sample.new()
@@
	quit()
"""
GODOT_CALL: Final = """\
	sample.mode = Monitor.ModeValue.{upper}
	assert(monitor.step(sample, {dt}))
	print(monitor.state)
"""

JAVASCRIPT: Final = """
import { Monitor, VALUES } from "./hurry_monitor.mjs";
const monitor = new Monitor();
@@
"""
LUA: Final = """
local Monitor = require("hurry_monitor")
local monitor = assert(Monitor.new())
@@
"""
PYTHON: Final = """
from hurry_monitor import Mode, Monitor
monitor = Monitor()
@@
"""


def automaton() -> Fspa:
    (fspa,) = compile_text(TEXT)
    return fspa


def check(folder: Path, target: str, driver: tuple[str, str, str], *commands: Sequence[str]) -> None:
    """Run a program that takes the samples; ``driver`` is the name of its file, its text, and the call for each."""
    for name, content in emit(target, automaton()).items():
        assert isinstance(content, str)
        (folder / name).write_text(content, encoding="utf-8")
    name, text, call = driver
    calls = "".join(
        call.format(value=value, upper=value.upper(), title=value.title(), dt=repr(dt)) for value, dt in SAMPLES
    )
    (folder / name).write_text(text.replace("@@\n", calls), encoding="utf-8")
    monitor = Monitor(automaton())
    states = [monitor.step({"mode": value}, dt).state for value, dt in SAMPLES]
    assert set(states) == {0, 1, 2}
    printed = run(folder, *commands).split()
    assert [int(word) for word in printed if word.isdigit()] == states


@needs("gcc", "g++")
@pytest.mark.parametrize("compiler", [("gcc", "-std=c99", "-xc"), ("g++", "-std=c++17", "-xc++")], ids=["c", "c++"])
def test_c(compiler: Sequence[str], tmp_path: Path) -> None:
    warnings = ("-Wall", "-Wextra", "-Wpedantic", "-Werror")
    command = [*compiler, *warnings, "driver.c", "-o", "driver", "-lm"]
    check(tmp_path, "c", ("driver.c", C, C_CALL), command, ["./driver"])


@needs("rustc")
def test_rust(tmp_path: Path) -> None:
    command = ["rustc", "--edition", "2021", "-D", "warnings", "driver.rs"]
    check(tmp_path, "rust", ("driver.rs", RUST, RUST_CALL), command, ["./driver"])


@needs("mcs", "mono")
def test_csharp(tmp_path: Path) -> None:
    command = ["mcs", "-langversion:6", "-warn:4", "-warnaserror", "driver.cs", "HurryMonitor.cs"]
    check(tmp_path, "csharp", ("driver.cs", CSHARP, CSHARP_CALL), command, ["mono", "driver.exe"])


@needs("godot3-server")
def test_gdscript(tmp_path: Path) -> None:
    (tmp_path / "project.godot").touch()
    command = ["env", "LANG=en", "godot3-server", "--path", ".", "-s", "driver.gd"]
    check(tmp_path, "gdscript3", ("driver.gd", GODOT, GODOT_CALL), command)


@needs("node")
@pytest.mark.parametrize("value", ["VALUES.mode.{value}", '"{value}"'])
def test_javascript(value: str, tmp_path: Path) -> None:
    call = f"console.log(monitor.step({{{{ mode: {value} }}}}, {{dt}}).state);\n"
    check(tmp_path, "javascript", ("driver.mjs", JAVASCRIPT, call), ["node", "driver.mjs"])


@pytest.mark.parametrize("interpreter", [pytest.param(name, marks=needs(name)) for name in ("lua5.4", "luajit")])
@pytest.mark.parametrize("value", ["Monitor.values.mode.{value}", '"{value}"'])
def test_lua(value: str, interpreter: str, tmp_path: Path) -> None:
    call = f"print(assert(monitor:step({{{{ mode = {value} }}}}, {{dt}})).state)\n"
    check(tmp_path, "lua", ("driver.lua", LUA, call), [interpreter, "driver.lua"])


@pytest.mark.parametrize("value", ["Mode.{upper}", '"{value}"'])
def test_python(value: str, tmp_path: Path) -> None:
    call = f'print(monitor.step({{{{"mode": {value}}}}}, {{dt}}).state)\n'
    check(tmp_path, "python", ("driver.py", PYTHON, call), [sys.executable, "-W", "error", "driver.py"])
