"""Monitors of every language keep registers as :class:`tltlc.monitor.Monitor` does, beyond refused samples and resets.

A program in each language takes the same samples and prints its registers after each of them.
"""

from __future__ import annotations

import copy
import math
import shutil
import subprocess
from collections.abc import Sequence
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from random import Random
from typing import Any, Final

import pytest

from tests.backends.monitors import Programs, Sample, expected, trace_of
from tests.backends.strategies import HOSTILE
from tests.backends.test_javascript import awkward
from tests.tools.conformance.runner import Runner, runners
from tests.tools.conformance.runners.c import WITHOUT_REGISTERS
from tests.waiting import HANG_S
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.record import record, replace
from tltlc.expression.tree import Before, Condition, Const, Expression, Op, SignalValue, When
from tltlc.monitor import Monitor, MonitorError
from tltlc.resolve.spec import Register, Signal

TEXT: Final = """\
signal x: number
signal a: bool
signal b: bool
exclusive a, b
clock 4 Hz
predicate square = clamp(highest(x * x) / 64 - 1, -1, 1)
predicate share = clamp(lowest(8 / x) / 8, -1, 1)
predicate cube = clamp(previous(x * x * x), -1, 1)

spec told {
    require always eventually (square and not share and cube)
    require always (a implies eventually (b since a))
    require always eventually (once (times(a) > 2) and time_since(b) <= 1 s)
}
"""

SAVE, BACK, RESET = "save", "back", "reset"

Action = tuple[float, bool, bool] | str
"""A sample, the values of x, a and b; or ``save`` and ``back``, which keep a copy of the monitor and return to it."""

ACTIONS: Final[tuple[Action, ...]] = (
    *((math.nan, True, False), (0.0, True, False), (1e200, True, False), (2.0, True, True)),
    *((2.0, True, False), (0.5, False, True), (0.0, True, False), (-0.25, True, False)),
    *((math.nan, False, False), (4.0, False, False), (1e110, True, False), (1e200, False, True)),
    *((-0.125, True, True), (8.0, True, False), SAVE, (1.0, False, True), (16.0, False, False), BACK),
    *((4.0, False, False), RESET, (0.0, False, True), (-2.0, False, True), (-4.0, False, False)),
    *((math.inf, True, False), (1.0, True, False), (0.0, False, False), RESET, RESET, (8.0, False, True)),
)


@record
class Line:
    """What a program prints after a sample: the state and robustness, or why it was refused, and the registers."""

    state: int
    robustness: float
    refused: str
    registers: tuple[float, ...]


def automaton() -> Fspa:
    (fspa,) = compile_text(TEXT)
    return fspa


def expected_lines(copies: bool) -> list[Line]:
    monitor, saved, lines = Monitor(automaton()), Monitor(automaton()), list[Line]()
    for action in actions(copies):
        if isinstance(action, str):
            monitor, saved = _acted(action, monitor, saved)
            continue
        try:
            step = monitor.step(dict(zip("xab", action, strict=True)))
        except MonitorError as error:
            lines.append(Line(0, 0.0, error.diagnostics[0].title, monitor.registers))
        else:
            lines.append(Line(step.state, step.robustness, "", monitor.registers))
    return lines


def _acted(action: str, monitor: Any, saved: Any) -> tuple[Any, Any]:
    """Return the monitor and its saved copy after an action that is no sample."""
    if action == SAVE:
        return monitor, copy.copy(monitor)
    if action == BACK:
        return saved, saved
    monitor.reset()
    return monitor, saved


def actions(copies: bool) -> list[Action]:
    """Return the actions; without ``copies``, those that need copies of a monitor are left out."""
    return [action for action in ACTIONS if copies or action not in (SAVE, BACK)]


def parsed(output: str) -> list[Line]:
    """Return the lines that a program printed: ``STATE|ROBUSTNESS|REFUSED|REGISTER REGISTER …``."""
    lines = []
    for text in output.splitlines():
        if text.count("|") == 3:
            state, robustness, refused, registers = text.split("|")
            lines.append(Line(int(state), float(robustness), refused, tuple(map(float, registers.split()))))
    return lines


def check(lines: Sequence[Line], copies: bool = False) -> None:
    wanted = expected_lines(copies)
    assert len(lines) == len(wanted)
    for line, want in zip(lines, wanted, strict=True):
        assert (line.state, line.robustness, line.registers) == (want.state, want.robustness, want.registers)
        # Languages have words of their own for a signal that is not finite.
        if "not a finite number" not in want.refused:
            assert line.refused == want.refused
        else:
            assert "the signal `x`" in line.refused


def test_the_actions_reach_every_error() -> None:
    refused = " ".join(line.refused for line in expected_lines(True))
    for text in ("`lowest(8 / x)` divides by zero", "`highest(x * x)` is too large", "hold at once", "not a finite"):
        assert text in refused
    assert "the register `last value of (x * x * x)` is too large to compute" in refused
    kinds = {register.kind for register in automaton().registers}
    assert kinds == {"highest", "lowest", "previous", "last", "first", "since", "once", "times", "time_since"}
    assert len({line.registers for line in expected_lines(True)}) > 12


# --- programs -------------------------------------------------------------------------------------


def _truth(value: bool) -> str:
    return str(value).lower()


def _number(value: float, nan: str, inf: str) -> str:
    return nan if math.isnan(value) else inf if math.isinf(value) else repr(value)


def run(folder: Path, *commands: Sequence[str]) -> str:
    """Run commands in a folder, and return what the last one printed."""
    for command in commands:
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=HANG_S)
        assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def write(folder: Path, target: str, driver: str, text: str) -> None:
    for name, content in emit(target, automaton()).items():
        assert isinstance(content, str)
        (folder / name).write_text(content, encoding="utf-8")
    (folder / driver).write_text(text, encoding="utf-8")


C: Final = """
#include "told_monitor.h"

static void take(told_monitor *monitor, double x, bool a, bool b) {
    told_signals sample = told_empty();
    told_result result;
    char text[told_text_size] = "";
    sample.x = x, sample.a = a, sample.b = b;
    if (told_step(monitor, &sample, &result)) {
        printf("%d|%.17g||", result.state, result.robustness);
    } else {
        told_message(monitor, text, sizeof text);
        printf("0|0|%s|", text);
    }
    for (int i = 0; i < told_register_count; i++) printf("%.17g ", monitor->registers[i]);
    puts("");
}

int main(void) {
    told_monitor monitor, saved;
    told_init(&monitor, NULL);
    saved = monitor;
@@
    puts(told_register_name(told_register_count - 1));
    return saved.state < 0;
}
"""

RUST: Final = """
mod told_monitor;
use told_monitor::{Monitor, Signals, REGISTER_NAMES};

fn take(monitor: &mut Monitor, x: f64, a: bool, b: bool) {
    match monitor.step(&Signals { x, a: Some(a), b: Some(b), ..Signals::default() }) {
        Ok(step) => print!("{}|{:?}||", step.state, step.robustness),
        Err(refused) => print!("0|0|{refused}|"),
    }
    for value in monitor.registers() {
        print!("{value:?} ");
    }
    println!();
}

fn main() {
    let mut monitor = Monitor::new();
@@
    println!("{}", REGISTER_NAMES[REGISTER_NAMES.len() - 1]);
}
"""

CSHARP: Final = """
using System;
using System.Globalization;

internal static class Driver
{
    private static void Take(Tltl.ToldMonitor monitor, double x, bool a, bool b)
    {
        var sample = Tltl.ToldMonitor.Signals.Missing;
        sample.X = x;
        sample.A = a;
        sample.B = b;
        Tltl.ToldMonitor.Result result;
        bool taken = monitor.TryStep(sample, out result);
        string text = taken ? result.State + "|" + Shown(result.Robustness) + "||" : "0|0|" + monitor.Message() + "|";
        for (int i = 0; i < monitor.RegisterCount; i++) text += Shown(monitor.RegisterAt(i)) + " ";
        Console.Out.WriteLine(text);
    }

    private static string Shown(double value)
    {
        return value.ToString("R", CultureInfo.InvariantCulture);
    }

    private static void Main()
    {
        var monitor = new Tltl.ToldMonitor();
@@
        Console.Out.WriteLine(Tltl.ToldMonitor.NameOfRegister(monitor.RegisterCount - 1));
    }
}
"""

JAVASCRIPT: Final = """
import { Monitor, REGISTERS } from "./told_monitor.mjs";

function take(monitor, x, a, b) {
  let text;
  try {
    const { state, robustness } = monitor.step({ x, a, b });
    text = `${state}|${robustness}||`;
  } catch (error) {
    text = `0|0|${error.message}|`;
  }
  console.log(text + Array.from(monitor.registers, (value) => (Object.is(value, -0) ? "-0" : value)).join(" "));
}

const monitor = new Monitor();
@@
console.log(REGISTERS[REGISTERS.length - 1]);
"""

LUA: Final = """
local Monitor = require("told_monitor")

local function take(monitor, x, a, b)
  local result, problem = monitor:step({ x = x, a = a, b = b })
  local text = "0|0|" .. (problem or "") .. "|"
  if result then text = ("%d|%.17g||"):format(result.state, result.robustness) end
  for _, name in ipairs({ @@names@@ }) do
    text = text .. ("%.17g "):format(monitor.registers[name])
  end
  print(text)
end

local monitor = assert(Monitor.new())
@@
"""

GODOT: Final = """extends SceneTree

const Told = preload("res://told_monitor.gd")


func take(monitor, x: float, a: bool, b: bool) -> void:
	var sample = Told.Sample.new()
	sample.x = x
	sample.a = a
	sample.b = b
	var text: String = "0|0|"
	if monitor.step(sample):
		text = "%d|%.20f||" % [monitor.state, monitor.robustness]
	else:
		text += monitor.message() + "|"
	for value in monitor.registers:
		text += "%.20f " % value
	print(text)


func _init() -> void:
	var monitor = Told.new()
@@
	print(Told.REGISTERS[-1])
	quit()
"""


def calls(template: str, call: str, reset: str, *, nan: str, inf: str, save: str = "", back: str = "") -> str:
    """Return a program: the template with a statement for each action in the place of the line ``@@``."""
    lines = []
    for action in actions(bool(save)):
        if isinstance(action, str):
            lines.append({SAVE: save, BACK: back, RESET: reset}[action])
        else:
            x, a, b = action
            lines.append(call.format(x=_number(x, nan, inf), a=_truth(a), b=_truth(b)))
    return template.replace("\n@@\n", "\n" + "\n".join(lines) + "\n")


def needs(*tools: str) -> pytest.MarkDecorator:
    lacking = [tool for tool in tools if shutil.which(tool) is None]
    return pytest.mark.skipif(bool(lacking), reason=f"{', '.join(lacking)} is not installed")


@needs("gcc", "g++")
@pytest.mark.parametrize("compiler", [("gcc", "-std=c99", "-xc"), ("g++", "-std=c++17", "-xc++")], ids=["c", "c++"])
def test_c_keeps_registers(compiler: Sequence[str], tmp_path: Path) -> None:
    call = "    take(&monitor, {x}, {a}, {b});"
    words = {"nan": "NAN", "inf": "HUGE_VAL", "save": "    saved = monitor;", "back": "    monitor = saved;"}
    write(tmp_path, "c", "driver.c", calls(C, call, "    told_reset(&monitor);", **words))
    warnings = ("-Wall", "-Wextra", "-Wpedantic", "-Werror")
    out = run(tmp_path, [*compiler, *warnings, "-O1", "driver.c", "-o", "driver", "-lm"], ["./driver"])
    check(parsed(out), copies=True)
    assert out.splitlines()[-1] == automaton().registers[-1].name


@needs("rustc")
def test_rust_keeps_registers(tmp_path: Path) -> None:
    call = "    take(&mut monitor, {x}, {a}, {b});"
    words = {"nan": "f64::NAN", "inf": "f64::INFINITY"}
    words |= {"save": "    let saved = monitor.clone();", "back": "    monitor = saved.clone();"}
    write(tmp_path, "rust", "driver.rs", calls(RUST, call, "    monitor.reset();", **words))
    out = run(tmp_path, ["rustc", "--edition", "2021", "-A", "clippy::all", "driver.rs"], ["./driver"])
    check(parsed(out), copies=True)
    assert out.splitlines()[-1] == automaton().registers[-1].name


@needs("mcs", "mono")
def test_csharp_keeps_registers(tmp_path: Path) -> None:
    call = "        Take(monitor, {x}, {a}, {b});"
    words = {"nan": "double.NaN", "inf": "double.PositiveInfinity"}
    write(tmp_path, "csharp", "driver.cs", calls(CSHARP, call, "        monitor.Reset();", **words))
    build = ["mcs", "-langversion:6", "-warn:4", "-warnaserror", "driver.cs", "ToldMonitor.cs"]
    out = run(tmp_path, build, ["mono", "driver.exe"])
    check(parsed(out))
    assert out.splitlines()[-1] == automaton().registers[-1].name


@needs("node")
def test_javascript_keeps_registers(tmp_path: Path) -> None:
    call = "take(monitor, {x}, {a}, {b});"
    text = calls(JAVASCRIPT, call, "monitor.reset();", nan="NaN", inf="Infinity")
    write(tmp_path, "javascript", "driver.mjs", text)
    out = run(tmp_path, ["node", "driver.mjs"])
    check(parsed(out))
    assert out.splitlines()[-1] == automaton().registers[-1].name


@pytest.mark.parametrize(
    "interpreter", [pytest.param(name, marks=needs(name)) for name in ("lua5.1", "lua5.4", "luajit")]
)
def test_lua_keeps_registers(interpreter: str, tmp_path: Path) -> None:
    names = ", ".join(f'"{register.name}"' for register in automaton().registers)
    call = "take(monitor, {x}, {a}, {b})"
    text = calls(LUA.replace("@@names@@", names), call, "monitor:reset()", nan="0 / 0", inf="math.huge")
    write(tmp_path, "lua", "driver.lua", text)
    check(parsed(run(tmp_path, [interpreter, "driver.lua"])))


@needs("godot3-server")
def test_gdscript_keeps_registers(tmp_path: Path) -> None:
    call = "\ttake(monitor, {x}, {a}, {b})"
    text = calls(GODOT, call, "\tmonitor.reset()", nan="NAN", inf="INF")
    write(tmp_path, "gdscript3", "driver.gd", text)
    (tmp_path / "project.godot").touch()
    # Godot does not accept the locale C.
    out = run(tmp_path, ["env", "LANG=en", "godot3-server", "--path", ".", "-s", "driver.gd"])
    check(parsed(out))
    assert automaton().registers[-1].name in out


def test_python_keeps_registers(tmp_path: Path) -> None:
    write(tmp_path, "python", "empty.py", "")
    module_spec = spec_from_file_location("told_monitor", tmp_path / "told_monitor.py")
    assert module_spec is not None and module_spec.loader is not None
    module = module_from_spec(module_spec)
    module_spec.loader.exec_module(module)
    monitor = saved = module.Monitor()
    lines: list[Line] = []
    for action in ACTIONS:
        if isinstance(action, str):
            monitor, saved = _acted(action, monitor, saved)
            continue
        try:
            step = monitor.step(dict(zip("xab", action, strict=True)))
        except module.MonitorError as error:
            lines.append(Line(0, 0.0, str(error), monitor.registers))
        else:
            lines.append(Line(step.state, step.robustness, "", monitor.registers))
    check(lines, copies=True)
    assert [*module.REGISTERS] == [register.name for register in automaton().registers]


# --- limits of languages --------------------------------------------------------------------------


def run_traces(runner: Runner, folder: Path, fspa: Fspa, samples: Sequence[Sample]) -> None:
    programs = Programs(runner, folder, [fspa])
    assert programs.run((0, trace_of(samples, [signal.name for signal in fspa.signals]))) == [expected(fspa, samples)]


@pytest.mark.parametrize("runner", [pytest.param(runner, id=runner.name) for runner in runners()])
def test_many_registers_fit_into_a_function(runner: Runner, tmp_path: Path) -> None:
    """Lua allows 200 local variables."""
    if runner.missing():
        pytest.skip(str(runner.missing()))
    signals = "".join(f"signal x{number} in [-1, 1]\n" for number in range(70))
    terms = " or ".join(f"x{number} > previous(x{number})" for number in range(70))
    (fspa,) = compile_text(f"{signals}spec many {{ require always eventually ({terms}) }}")
    assert len(fspa.registers) == 141
    draw = Random(3)
    samples = [{f"x{number}": draw.choice((-1.0, 0.25, 0.5)) for number in range(70)} for _ in range(5)]
    samples += [{name: value - 0.125 for name, value in samples[-1].items()}] * 3
    run_traces(runner, tmp_path, fspa, [{name: max(value, -1.0) for name, value in s.items()} for s in samples])


@pytest.mark.parametrize("runner", [pytest.param(runner, id=runner.name) for runner in runners()])
def test_deep_updates_fit_into_a_function(runner: Runner, tmp_path: Path) -> None:
    """The update of a register has cases inside cases, more than most languages can nest."""
    if runner.missing():
        pytest.skip(str(runner.missing()))
    (fspa,) = compile_text("signal x in [-1, 1]\nspec deep { require always eventually x > previous(x) }")
    value: Expression = Const(0.5)
    for level in range(96):
        value = When(
            ((Condition(">", (SignalValue("x"), Const(level / 100 - 0.5))), value),), Const(level / 1000 - 0.5)
        )
    registers = tuple(replace(each, update=value) if each.kind == "last" else each for each in fspa.registers)
    samples = [{"x": step / 20 - 0.75} for step in range(30)]
    run_traces(runner, tmp_path, replace(fspa, registers=registers), samples)


NAMES: Final = (*HOSTILE, "register", "registers", "before", "x", "r_before", "r", "REGISTERS", "Registers", "starts")


@pytest.mark.parametrize("runner", [pytest.param(runner, id=runner.name) for runner in runners()])
def test_hostile_names_of_registers_stay_distinct_and_do_not_become_code(runner: Runner, tmp_path: Path) -> None:
    """Each register has the name of an atom that reads it; in each sample another atom limits the progress."""
    if runner.missing():
        pytest.skip(str(runner.missing()))
    names = [name.replace("\0", "") for name in NAMES]
    fspa, _ = awkward(names)
    signals = tuple(Signal(f"x{place}", "number", -1.0, 1.0) for place in range(len(names)))
    registers = tuple(
        Register(
            name,
            "last",
            "",
            -1.0,
            1.0,
            -1.0,
            Op("min", (SignalValue(signal.name), Op("+", (Before(name), Const(2.0))))),
        )
        for name, signal in zip(names, signals, strict=True)
    )
    last = replace(registers[-1], update=Op("/", (Const(1.0), SignalValue(signals[-1].name))))
    fspa = replace(fspa, signals=signals, registers=(*registers[:-1], replace(last, low=None, high=None)))
    samples = [
        {signal.name: -0.25 if at == place else 0.5 for at, signal in enumerate(signals)}
        for place in range(len(names) - 1)
    ]
    programs = Programs(runner, tmp_path, [fspa])
    ((status, out, _),) = programs.run((0, trace_of(samples, [signal.name for signal in signals])))
    assert (status, out) == expected(fspa, samples)[:2]
    samples.append(dict.fromkeys(samples[0], 0.0))
    ((status, _, errors),) = programs.run((0, trace_of(samples, [signal.name for signal in signals])))
    assert status == 1
    assert errors.startswith(f"error: step {len(samples)}: the register `starts` divides by zero\n")


def test_a_c_monitor_without_registers_to_read_may_have_one_that_nothing_needs(tmp_path: Path) -> None:
    if reason := WITHOUT_REGISTERS.missing():
        pytest.skip(reason)
    (fspa,) = compile_text("signal p: bool\nsignal q: bool\nspec s { reach p or (p and previously q) }")
    assert [atom.name for atom in fspa.atoms] == ["p", "previously q", "q"]
    samples: list[Sample] = [{"p": 0.0, "q": 1.0}, {"p": 1.0, "q": 0.0}]
    trace = trace_of(samples, [signal.name for signal in fspa.signals])
    assert Programs(WITHOUT_REGISTERS, tmp_path, [fspa]).run((0, trace)) == [expected(fspa, samples)]


@pytest.mark.parametrize(
    ("clause", "kind", "unread"),
    [
        ("require always for 0.3 s (previously q implies (q implies q))", "previously", "previously_q_register"),
        ("keep p implies always for 1 s q\nreach p and not p", "breach", "breach_1_s_p_q_register"),
        ("keep p implies eventually within 1 s q\nreach p and not p", "due", ""),
        ("keep p implies always for 1 s q", "breach", ""),
    ],
)
def test_c_monitors_give_no_warnings_where_no_guard_needs_a_register(
    clause: str, kind: str, unread: str, tmp_path: Path
) -> None:
    if reason := WITHOUT_REGISTERS.missing():
        pytest.skip(reason)
    (fspa,) = compile_text(f"clock varies\nsignal p: bool\nsignal q: bool\nspec s {{ {clause} }}")
    ((name, header),) = emit("c", fspa).items()
    assert kind in {register.kind for register in fspa.registers}
    assert unread in str(header)
    (tmp_path / name).write_text(str(header), encoding="utf-8")
    (tmp_path / "main.c").write_text(f'#include "{name}"\nint main(void) {{ return 0; }}\n', encoding="utf-8")
    for options in ((), ("-DTLTL_NO_REGISTERS",)):
        command = ["gcc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *options, "-fsyntax-only", "main.c"]
        subprocess.run(command, cwd=tmp_path, check=True, timeout=HANG_S)
