"""Generated code has constants for the values of enums, in the style of its language, without clashes or warnings.

Names of signals and values are chosen to clash with words of the languages and with names in the templates.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from random import Random

import pytest

from tests.backends.test_gdscript import check_scripts_for_godot_4, parses
from tests.backends.test_javascript import type_errors, types
from tltlc import backends, compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.program.enums import SignalEnum, enums_of, flat_enums, nested_enums, pascal_case, upper_case

TEXT = """
entity g1, g2
signal text: (size, room)
signal verdict: (satisfied, holding, toString)
signal step: (monitor, signals, result, equals)
signal timer: (pi, nil, self, constructor, __proto__, verdict)
signal guard_mode(g: entity): (idle, Idle, chaseDown)
signal problem: (none, nothing_wrong)
signal IntEnum: (name, mro, real)
signal phase: int in [0, 5]
spec guards {
    reach guard_mode(g1) is chaseDown and text is room then guard_mode(g2) is Idle and timer is __proto__
    reach step is equals or phase == 3
    keep verdict is not holding or problem is not nothing_wrong
    keep IntEnum is not mro or step is not signals
}
"""
STRICT_C = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wfloat-conversion", "-Werror")


@cache
def guards() -> Fspa:
    (fspa,) = compile_text(TEXT)
    return fspa


@cache
def samples() -> list[dict[str, str | float]]:
    """Return samples with the names of values."""
    random = Random(5)
    return [
        {
            signal.name: random.choice(signal.values) if signal.values else float(random.randrange(6))
            for signal in guards().signals
        }
        for _ in range(60)
    ]


@cache
def states() -> list[int]:
    """Return the state after each sample; the trace begins again after the spec is decided."""
    monitor, result = Monitor(guards()), []
    for sample in samples():
        step = monitor.step(sample)
        result.append(step.state)
        if step.verdict in ("satisfied", "violated"):
            monitor.reset()
    assert len(set(result)) > 3
    return result


def needs(*tools: str) -> pytest.MarkDecorator:
    lacking = [tool for tool in tools if shutil.which(tool) is None]
    return pytest.mark.skipif(bool(lacking), reason=f"{', '.join(lacking)} is not installed")


def write(folder: Path, target: str) -> str:
    """Write the files of a target; return the text of the monitor."""
    files = backends.emit(target, guards())
    for name, text in files.items():
        assert isinstance(text, str)
        (folder / name).write_text(text, encoding="utf-8")
    text = next(iter(files.values()))
    assert isinstance(text, str)
    return text


def run(folder: Path, *commands: Sequence[str]) -> list[int]:
    """Run commands, and return the numbers that the last one prints."""
    for command in commands:
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        assert result.returncode == 0, result.stdout + result.stderr
    return [int(word) for word in result.stdout.split() if word.isdigit()]


def assignments(fields: Sequence[str], constants: Sequence[Sequence[str]], line: str) -> list[list[str]]:
    """Return for each sample the lines that set its signals to ``constants``, the names by enum and value."""
    enum_of = {signal: number for number, enum in enumerate(enums_of(guards())) for signal in enum.signals}
    lines = []
    for sample in samples():
        values = [
            constants[enum_of[signal.name]][signal.values.index(str(sample[signal.name]))]
            if signal.values
            else f"{sample[signal.name]}"
            for signal in guards().signals
        ]
        lines.append([line.format(field, value) for field, value in zip(fields, values, strict=True)])
    return lines


def grouped(names: Sequence[str]) -> list[list[str]]:
    """Return the names of constants by enum; they are all different."""
    assert len(set(names)) == len(names)
    remaining = iter(names)
    groups = [[next(remaining) for _ in enum.values] for enum in enums_of(guards())]
    assert next(remaining, None) is None
    return groups


@needs("gcc", "g++")
@pytest.mark.parametrize("compiler", [("gcc", "-std=c99", "-xc"), ("g++", "-std=c++17", "-xc++")], ids=["c", "c++"])
def test_c_has_enumerators(compiler: Sequence[str], tmp_path: Path) -> None:
    header = write(tmp_path, "c")
    constants = [
        name
        for block in re.findall(r"// The values of[^\n]*\nenum \{\n(.*?)\};", header, re.DOTALL)
        for name in re.findall(r"    (\w+) = \d+", block)
    ]
    assert constants[-3:] == ["guards_IntEnum_name", "guards_IntEnum_mro", "guards_IntEnum_real"]
    (struct,) = re.findall(r"typedef struct \{\n(.*?)\} guards_signals;", header, re.DOTALL)
    fields = re.findall(r"double (\w+);", struct)
    lines = ['#include "guards_monitor.h"', "int main(void) {", "guards_monitor monitor;", "guards_result result;"]
    lines += ["guards_init(&monitor, NULL);", "guards_signals sample = guards_empty();"]
    for given in assignments(fields, grouped(constants), "sample.{} = {};"):
        lines += [*given, "if (!guards_step(&monitor, &sample, &result)) return 1;", 'printf("%d\\n", result.state);']
        lines += [
            "if (result.verdict == guards_satisfied || result.verdict == guards_violated) guards_reset(&monitor);"
        ]
    (tmp_path / "driver.c").write_text("\n".join([*lines, "return 0;", "}", ""]))
    assert run(tmp_path, [*compiler, *STRICT_C, "driver.c", "-o", "driver", "-lm"], ["./driver"]) == states()


@needs("rustc")
def test_rust_has_constants(tmp_path: Path) -> None:
    text = write(tmp_path, "rust")
    constants = re.findall(r"^pub const (\w+): f64 = \d", text, re.MULTILINE)
    assert "GUARD_MODE_CHASE_DOWN" in constants
    (struct,) = re.findall(r"pub struct Signals \{\n(.*?)\n\}", text, re.DOTALL)
    fields = re.findall(r"pub (\w+): f64", struct)
    lines = ["#![deny(warnings)]", "mod guards_monitor;", "use guards_monitor::*;", "fn main() {"]
    lines += ["let mut monitor = Monitor::new();", "let mut sample = Signals::default();"]
    for given in assignments(fields, grouped(constants), "sample.{} = {};"):
        lines += [*given, "let step = monitor.step(&sample).unwrap();", 'println!("{}", step.state);']
        lines += ["if step.verdict == Verdict::Satisfied || step.verdict == Verdict::Violated { monitor.reset(); }"]
    (tmp_path / "driver.rs").write_text("\n".join([*lines, "}", ""]))
    command = ["rustc", "--edition", "2021", "-D", "warnings", "driver.rs"]
    assert run(tmp_path, command, ["./driver"]) == states()


@needs("mcs", "mono")
def test_csharp_has_constants(tmp_path: Path) -> None:
    text = write(tmp_path, "csharp")
    constants = [
        f"M.{name}.{constant}"
        for name, block in re.findall(r"public static class (\w+)\n *\{\n(.*?)\n        \}", text, re.DOTALL)
        for constant in re.findall(r"public const double (\w+)", block)
    ]
    assert "M.GuardMode.ChaseDown" in constants
    (struct,) = re.findall(r"public struct Signals\n(.*?)public static Signals", text, re.DOTALL)
    fields = re.findall(r"public double\?? (\w+);", struct)
    lines = ["using M = Tltl.GuardsMonitor;", "internal static class Driver {", "private static void Main() {"]
    lines += ["var monitor = new M();", "var sample = M.Signals.Missing;", "M.Result result;"]
    # An enum that is not set does not count as its first value.
    lines += ['if (monitor.TryStep(new M.Signals(), out result)) System.Console.WriteLine("taken");']
    for given in assignments(fields, grouped(constants), "sample.{} = {};"):
        lines += [*given, "result = monitor.Step(sample);", "System.Console.WriteLine(result.State);"]
        lines += ["if (result.Verdict == M.Verdict.Satisfied || result.Verdict == M.Verdict.Violated) monitor.Reset();"]
    (tmp_path / "driver.cs").write_text("\n".join([*lines, "}", "}", ""]))
    build = ["mcs", "-langversion:6", "-warn:4", "-warnaserror", "-doc:driver.xml", "driver.cs", "GuardsMonitor.cs"]
    (tmp_path / "driver.cs").write_text("#pragma warning disable 1591\n" + (tmp_path / "driver.cs").read_text())
    assert run(tmp_path, build, ["mono", "driver.exe"]) == states()


@needs("godot3-server")
def test_gdscript_has_enums(tmp_path: Path) -> None:
    text = write(tmp_path, "gdscript3")
    constants = [
        f"Monitor.{name}.{constant}"
        for name, members in re.findall(r"^enum (\w+Value) \{ (.*) \}$", text, re.MULTILINE)
        for constant in members.split(", ")
    ]
    assert "Monitor.GuardModeValue.CHASE_DOWN" in constants
    (fields,) = re.findall(r"const FIELDS: Array = \[(.*?)\]", text, re.DOTALL)
    lines = ["extends SceneTree", 'const Monitor = preload("guards_monitor.gd")', "func _init():"]
    lines += ["\tvar monitor = Monitor.new()", "\tvar sample = Monitor.Sample.new()"]
    for given in assignments(re.findall(r'"(\w+)"', fields), grouped(constants), "\tsample.{} = {}"):
        lines += [*given, "\tassert(monitor.step(sample))", "\tprint(monitor.state)"]
        final = "[Monitor.Verdict.SATISFIED, Monitor.Verdict.VIOLATED]"
        lines += [f"\tif monitor.verdict in {final}:", "\t\tmonitor.reset()"]
    (tmp_path / "driver.gd").write_text("\n".join([*lines, "\tquit()", ""]))
    (tmp_path / "project.godot").touch()
    assert run(tmp_path, ["env", "LANG=en", "godot3-server", "--path", ".", "-s", "driver.gd"]) == states()


@parses
def test_the_enums_of_godot_4_are_parsed(tmp_path: Path) -> None:
    check_scripts_for_godot_4(tmp_path, [guards()])


def quoted(value: str | float) -> str:
    return f'"{value}"' if isinstance(value, str) else f"{value}"


def by_constant(access: Callable[[str, str], str]) -> list[dict[str, str]]:
    """Return the samples with constants, as ``access`` writes the value of a base."""
    base = {signal.name: signal.base for signal in guards().signals}
    return [
        {name: access(base[name], value) if isinstance(value, str) else f"{value}" for name, value in sample.items()}
        for sample in samples()
    ]


def entries(sample: Mapping[str, str], entry: str = '"{}": {}') -> str:
    """Return the entries of an object or table."""
    return ", ".join(entry.format(name, value) for name, value in sample.items())


def by_name() -> list[dict[str, str]]:
    return [{name: quoted(value) for name, value in sample.items()} for sample in samples()]


@needs("node")
@pytest.mark.parametrize("named", [False, True])
def test_javascript_has_a_frozen_object_and_takes_names(named: bool, tmp_path: Path) -> None:
    write(tmp_path, "javascript")
    lines = ['import { Monitor, VALUES } from "./guards_monitor.mjs";', "const monitor = new Monitor();"]
    lines += ["function take(sample) {", "  const { state, verdict } = monitor.step(sample);"]
    lines += ["  console.log(state);", '  if (verdict === "satisfied" || verdict === "violated") monitor.reset();', "}"]
    given = by_name() if named else by_constant(lambda base, value: f'VALUES["{base}"]["{value}"]')
    for sample in given:
        lines.append(f"take({{ {entries(sample)} }});")
    lines += ['if (!Object.isFrozen(VALUES) || !Object.isFrozen(VALUES.text)) throw new Error("not frozen");']
    (tmp_path / "driver.mjs").write_text("\n".join(lines))
    assert run(tmp_path, ["node", "driver.mjs"]) == states()


@needs("node")
def test_javascript_refuses_other_names(tmp_path: Path) -> None:
    write(tmp_path, "javascript")
    sample = {**by_name()[0], "verdict": '"valueOf"'}
    text = f"{{ {entries(sample)} }}"
    driver = f'import {{ Monitor }} from "./guards_monitor.mjs";\ntry {{ new Monitor().step({text}); console.log(0); }}'
    refusal = "step 1: the signal `verdict` is `valueOf`, not one of `satisfied`, `holding` and `toString`"
    driver += f' catch (error) {{ if (error.message === "{refusal}") console.log(1); }}'
    (tmp_path / "driver.mjs").write_text(driver)
    assert run(tmp_path, ["node", "driver.mjs"]) == [1]


@types
def test_the_types_of_javascript_have_the_values(tmp_path: Path) -> None:
    module = tmp_path / "guards_monitor.mjs"
    write(tmp_path, "javascript")
    sample = {**by_name()[0], "guard_mode(g1)": "VALUES.guard_mode.chaseDown"}
    text = f"{{ {entries(sample)} }}"
    use = ['import { Monitor, VALUES } from "./guards_monitor.mjs";', f"new Monitor().step({text});"]
    use += ["const two: 2 = VALUES.guard_mode.chaseDown;", "console.log(two);", "// @ts-expect-error: only read it"]
    use += ["VALUES.guard_mode.idle = 1;", "// @ts-expect-error: no such value"]
    wrong = text.replace("VALUES.guard_mode.chaseDown", '"chase"')
    use += [f"new Monitor().step({wrong});"]
    (tmp_path / "use.mts").write_text("\n".join(use))
    (tmp_path / "node.d.ts").write_text("declare const process: any;\n")
    options = {"module": "nodenext", "lib": ["es2022", "dom"], "allowJs": True, "checkJs": True}
    assert type_errors(tmp_path, ["use.mts"], module="nodenext", lib=["es2022", "dom"]) == ""
    loose = {"noImplicitAny": False, "useUnknownInCatchVariables": False, "noUnusedLocals": True}
    assert type_errors(tmp_path, ["node.d.ts", module.name], **options, **loose) == ""


@pytest.mark.parametrize("interpreter", [pytest.param(name, marks=needs(name)) for name in ("lua5.4", "luajit")])
@pytest.mark.parametrize("named", [False, True])
def test_lua_has_a_table_and_takes_names(interpreter: str, named: bool, tmp_path: Path) -> None:
    write(tmp_path, "lua")
    lines = ['local Monitor = require("guards_monitor")', "local monitor = assert(Monitor.new())"]
    lines += ["local function take(sample)", "  local result = assert(monitor:step(sample))", "  print(result.state)"]
    lines += ['  if result.verdict == "satisfied" or result.verdict == "violated" then monitor:reset() end', "end"]
    given = by_name() if named else by_constant(lambda base, value: f'Monitor.values["{base}"]["{value}"]')
    for sample in given:
        table = entries(sample, '["{}"] = {}')
        lines.append(f"take({{ {table} }})")
    (tmp_path / "driver.lua").write_text("\n".join(lines))
    assert run(tmp_path, [interpreter, "driver.lua"]) == states()


@pytest.mark.parametrize("named", [False, True])
def test_python_has_enums_and_takes_names(named: bool, tmp_path: Path) -> None:
    text = write(tmp_path, "python")
    classes = re.findall(r"^class (\w+)\(IntEnum\):", text, re.MULTILINE)
    assert "GuardMode" in classes
    lines = ["import guards_monitor as module", "from enum import IntEnum", "enums = {"]
    for enum, name in zip(enums_of(guards()), classes, strict=True):
        lines.append(f"    {enum.base!r}: dict(zip({enum.values!r}, module.{name}, strict=True)),")
    lines += ["}", "monitor = module.Monitor()", "def take(sample):", "    step = monitor.step(sample)"]
    lines += ["    print(step.state)", '    if step.verdict in ("satisfied", "violated"):', "        monitor.reset()"]
    given = by_name() if named else by_constant(lambda base, value: f'enums["{base}"]["{value}"]')
    for sample in given:
        lines.append(f"take({{{entries(sample)}}})")
    (tmp_path / "driver.py").write_text("\n".join(lines))
    assert run(tmp_path, [sys.executable, "-W", "error", "driver.py"]) == states()


@pytest.mark.skipif(find_spec("mypy") is None, reason="mypy is not installed")
def test_the_types_of_python_are_right(tmp_path: Path) -> None:
    write(tmp_path, "python")
    run(tmp_path, [sys.executable, "-m", "mypy", "--strict", "guards_monitor.py"])


def test_a_spec_without_enums_has_no_constants() -> None:
    (fspa,) = compile_text("signal a: bool\nsignal n: int in [0, 3]\nspec plain { reach a and n == 2 }")
    for target in ("c", "csharp", "rust", "gdscript", "gdscript3", "javascript", "lua", "python"):
        for text in backends.emit(target, fspa).values():
            assert not re.search(r"\bVALUES|IntEnum|values of enums|The values of the signal", str(text))


def test_names_are_unique_and_in_the_style_of_the_language() -> None:
    enum = SignalEnum("guard_mode", ("idle", "Idle", "chaseDown"), ("guard_mode(g1)", "guard_mode(g2)"))
    flat = {each.enum.base: each for each in flat_enums(guards(), ["GUARD_MODE_IDLE"], upper_case)}["guard_mode"]
    assert flat.enum == enum
    assert flat.constants == ("GUARD_MODE_IDLE_1", "GUARD_MODE_IDLE_2", "GUARD_MODE_CHASE_DOWN")
    nested = nested_enums(guards(), ["GuardMode"], ["ChaseDown"], pascal_case)
    (mode,) = (each for each in nested if each.enum == enum)
    assert (mode.type, mode.constants) == ("GuardMode_1", ("Idle", "Idle_1", "ChaseDown_1"))
