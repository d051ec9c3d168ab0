"""Monitors in C, C# and Rust take the time since the sample before, if the clock varies, and refuse a wrong one.

A program in each language takes the same samples as :class:`tltlc.monitor.Monitor` and prints its registers
after each of them.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import pytest

from tests.backends.test_registers import BACK, RESET, SAVE, Line, needs, parsed, run
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.monitor import Monitor, MonitorError

TEXT: Final = """\
clock varies
signal x in [-4, 4]
signal a: bool
signal b: bool

spec paced {
    keep a implies eventually within 2 s b
    keep once within 1.5 s x > 0 or time_since(b) < 4 s
    require always eventually (time_holding(a) > 0.5 s and historically for 0.25 s x > -1)
}
"""
"""The time since the sample before is in the registers of a deadline, of windows and of times."""

Action = tuple[float, float, bool, bool] | str
"""A time since the sample before and the values of x, a and b; or an action of :mod:`tests.backends.test_registers`."""

ACTIONS: Final[tuple[Action, ...]] = (
    *((math.nan, 1.0, True, False), (-1.0, 1.0, False, True), (7.0, 1.0, False, True), (0.1, 0.5, True, False)),
    *((0.0, 0.5, True, False), (-0.0, 0.5, True, False), (-1e-300, 0.5, True, False), (0.3, -2.0, True, False)),
    *((math.inf, 0.5, False, False), (-math.inf, 0.5, False, True), (math.nan, math.nan, True, True)),
    *((0.7, 0.5, True, False), SAVE, (0.9, -1.0, True, False), (0.1, -1.0, False, True), BACK),
    *((1.5, math.nan, True, False), (1.0, -3.0, False, False), (-2.5, 0.0, True, True), (60.0, 0.0, False, True)),
    *(RESET, (math.inf, 0.0, True, False), (0.016, 1.0, True, False), (2.0, -1.0, True, False)),
    *((5e-324, -1.0, True, False), RESET, RESET, (3.0, 1.0, True, True), (1e308, 1.0, False, False)),
    *((1e308, 1.0, False, False), (0.25, 1.0, False, True), RESET, (0.0, 1.0, True, True), (0.6, 1.0, True, True)),
)


def automaton() -> Fspa:
    (fspa,) = compile_text(TEXT)
    return fspa


def actions(copies: bool) -> list[Action]:
    """Return the actions; without ``copies``, those that need copies of a monitor are left out."""
    return [action for action in ACTIONS if copies or action not in (SAVE, BACK)]


def expected_lines(copies: bool) -> list[Line]:
    monitor: Any = Monitor(automaton())
    saved, lines = copy.copy(monitor), list[Line]()
    for action in actions(copies):
        if action == SAVE:
            saved = copy.copy(monitor)
        elif action == BACK:
            monitor = saved
        elif isinstance(action, str):
            monitor.reset()
        else:
            try:
                step = monitor.step(dict(zip("xab", action[1:], strict=True)), action[0])
            except MonitorError as error:
                lines.append(Line(0, 0.0, _refused(error), monitor.registers))
            else:
                lines.append(Line(step.state, step.robustness, "", monitor.registers))
    return lines


def _refused(error: MonitorError) -> str:
    """Return the message of a refused sample, after ``wrong dt`` if its time was wrong."""
    (diagnostic,) = error.diagnostics
    return f"{'wrong dt ' if diagnostic.code == 'TLT0619' else ''}{diagnostic.title}"


def check(lines: Sequence[Line], copies: bool = True) -> None:
    expected = expected_lines(copies)
    assert len(lines) == len(expected)
    for line, want in zip(lines, expected, strict=True):
        assert (line.state, line.robustness, line.registers) == (want.state, want.robustness, want.registers)
        # Languages have words of their own for a signal that is not finite.
        if "the signal `x`" in want.refused:
            assert "the signal `x`" in line.refused
        else:
            # Rust writes NaN, and C# writes 1E-300.
            assert line.refused.lower() == want.refused.lower()


def test_the_actions_reach_every_state_and_refusal() -> None:
    lines = expected_lines(True)
    assert {line.state for line in lines} == set(range(len(automaton().states)))
    refused = [line.refused for line in lines if line.refused]
    assert "wrong dt step 5: its time since the sample before is -1e-300, not a number of seconds" in refused
    times = {text.split(" is ")[1].split(",")[0] for text in refused if text.startswith("wrong dt")}
    assert times == {"nan", "-1", "-1e-300", "inf", "-inf", "-2.5"}
    assert any("the signal `x`" in text for text in refused)
    assert len({line.registers for line in lines}) > 12


# --- programs -------------------------------------------------------------------------------------

C: Final = """
#include "paced_monitor.h"

static void take(paced_monitor *monitor, double dt, double x, bool a, bool b) {
    paced_signals sample = paced_empty();
    paced_result result;
    char text[paced_text_size] = "";
    sample.x = x, sample.a = a, sample.b = b;
    if (paced_step(monitor, &sample, dt, &result)) {
        printf("%d|%.17g||", result.state, result.robustness);
    } else {
        paced_message(monitor, text, sizeof text);
        printf("0|0|%s%s|", monitor->problem == paced_wrong_dt ? "wrong dt " : "", text);
    }
    for (int i = 0; i < paced_register_count; i++) printf("%.17g ", monitor->registers[i]);
    puts("");
}

int main(void) {
    paced_monitor monitor, saved;
    paced_init(&monitor, NULL);
    saved = monitor;
@@
    return saved.state < 0;
}
"""

RUST: Final = """
mod paced_monitor;
use paced_monitor::{Monitor, Problem, Signals};

fn take(monitor: &mut Monitor, dt: f64, x: f64, a: bool, b: bool) {
    match monitor.step(&Signals { x, a: Some(a), b: Some(b) }, dt) {
        Ok(step) => print!("{}|{:?}||", step.state, step.robustness),
        Err(refused) => {
            let wrong = if refused.problem == Problem::WrongDt { "wrong dt " } else { "" };
            assert_eq!(monitor.step(&Signals { x, a: Some(a), b: Some(b) }, dt), Err(refused));
            print!("0|0|{wrong}{refused}|");
        }
    }
    for value in monitor.registers() {
        print!("{value:?} ");
    }
    println!();
}

fn main() {
    let mut monitor = Monitor::new();
@@
}
"""

CSHARP: Final = """
using System;
using System.Globalization;

internal static class Driver
{
    private static void Take(Tltl.PacedMonitor monitor, double dt, double x, bool a, bool b)
    {
        var sample = Tltl.PacedMonitor.Signals.Missing;
        sample.X = x;
        sample.A = a;
        sample.B = b;
        Tltl.PacedMonitor.Result result;
        string text;
        if (monitor.TryStep(sample, dt, out result))
        {
            text = result.State + "|" + Shown(result.Robustness) + "||";
        }
        else
        {
            string wrong = monitor.LastProblem == Tltl.PacedMonitor.Problem.WrongDt ? "wrong dt " : "";
            string message = "";
            try
            {
                monitor.Step(sample, dt);
            }
            catch (Tltl.PacedMonitor.RefusedException refused)
            {
                message = refused.Message;
            }
            text = "0|0|" + wrong + message + "|";
        }
        for (int i = 0; i < monitor.RegisterCount; i++) text += Shown(monitor.RegisterAt(i)) + " ";
        Console.Out.WriteLine(text);
    }

    private static string Shown(double value)
    {
        return value.ToString("R", CultureInfo.InvariantCulture);
    }

    private static void Main()
    {
        var monitor = new Tltl.PacedMonitor();
@@
    }
}
"""


def calls(template: str, call: str, words: dict[str, str], *, nan: str, inf: str) -> str:
    """Return a program: the template with a statement for each action in the place of the line ``@@``.

    ``words`` has the statements of actions that are no samples.
    """
    lines = []
    for action in actions(SAVE in words):
        if isinstance(action, str):
            lines.append(words[action])
            continue
        dt, x = (
            nan if math.isnan(value) else inf if value == math.inf else f"-{inf}" if value == -math.inf else repr(value)
            for value in action[:2]
        )
        lines.append(call.format(dt=dt, x=x, a=str(action[2]).lower(), b=str(action[3]).lower()))
    return template.replace("\n@@\n", "\n" + "\n".join(lines) + "\n")


def write(folder: Path, target: str, driver: str, text: str) -> None:
    for name, content in emit(target, automaton()).items():
        assert isinstance(content, str)
        (folder / name).write_text(content, encoding="utf-8")
    (folder / driver).write_text(text, encoding="utf-8")


@needs("gcc", "g++")
@pytest.mark.parametrize("compiler", [("gcc", "-std=c99", "-xc"), ("g++", "-std=c++17", "-xc++")], ids=["c", "c++"])
def test_c_takes_step_lengths(compiler: Sequence[str], tmp_path: Path) -> None:
    words = {SAVE: "    saved = monitor;", BACK: "    monitor = saved;", RESET: "    paced_reset(&monitor);"}
    text = calls(C, "    take(&monitor, {dt}, {x}, {a}, {b});", words, nan="NAN", inf="HUGE_VAL")
    write(tmp_path, "c", "driver.c", text)
    warnings = ("-Wall", "-Wextra", "-Wpedantic", "-Werror")
    check(parsed(run(tmp_path, [*compiler, *warnings, "-O1", "driver.c", "-o", "driver", "-lm"], ["./driver"])))


@needs("rustc")
def test_rust_takes_step_lengths(tmp_path: Path) -> None:
    words = {SAVE: "    let saved = monitor.clone();", BACK: "    monitor = saved.clone();"}
    words[RESET] = "    monitor.reset();"
    call = "    take(&mut monitor, {dt}, {x}, {a}, {b});"
    write(tmp_path, "rust", "driver.rs", calls(RUST, call, words, nan="f64::NAN", inf="f64::INFINITY"))
    check(parsed(run(tmp_path, ["rustc", "--edition", "2021", "-D", "warnings", "driver.rs"], ["./driver"])))


@needs("mcs", "mono")
def test_csharp_takes_step_lengths(tmp_path: Path) -> None:
    words = {RESET: "        monitor.Reset();"}
    call = "        Take(monitor, {dt}, {x}, {a}, {b});"
    text = calls(CSHARP, call, words, nan="double.NaN", inf="double.PositiveInfinity")
    write(tmp_path, "csharp", "driver.cs", text)
    build = ["mcs", "-langversion:6", "-warn:4", "-warnaserror", "driver.cs", "PacedMonitor.cs"]
    check(parsed(run(tmp_path, build, ["mono", "driver.exe"])), copies=False)
