"""On a clock that varies, monitors in scripting languages take the time since the sample before, as the library does.

A program in each language steps its monitor with the same samples; its own program reads the same traces.
"""

from __future__ import annotations

import copy
import math
import subprocess
from collections.abc import Sequence
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any, Final

import pytest

from tests.backends.test_gdscript import GDPARSE
from tests.backends.test_javascript import TSC, type_errors
from tests.backends.test_registers import Line, needs, parsed, run
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor import Monitor, MonitorError

TEXT: Final = """\
clock varies
signal x in [0, 1]
signal dt in [0, 1]
signal a: bool

spec timed {
    keep a implies eventually within 2 s x > 0.5
    keep time_since(a) < 3 s
    reach time_holding(dt > 0.25) >= 0.75 s
}

spec timeless { keep a implies eventually x > dt }
"""

SCRIPTS: Final = ("javascript", "lua", "gdscript3", "python")


def automata() -> dict[str, Fspa]:
    return {fspa.name: fspa for fspa in compile_text(TEXT)}


def test_one_automaton_reads_the_length_of_a_step_and_one_does_not() -> None:
    kinds = {name: {register.kind for register in fspa.registers} for name, fspa in automata().items()}
    assert kinds["timed"] >= {"waiting", "time_since", "time_holding"}
    assert kinds["timeless"] == set()


# --- as a library ---------------------------------------------------------------------------------

SAVE, BACK, RESET = "save", "back", "reset"
MISSING, TEXTUAL = "missing", "text"
"""Samples without a length, and with a text in place of it."""

Length = float | str
Action = tuple[float, float, bool, Length] | str
"""A sample, the values of x, dt and a, and the length of the step; or what is done with a copy of the monitor."""

ACTIONS: Final[tuple[Action, ...]] = (
    *((0.0, 0.5, False, MISSING), (0.0, 0.5, False, -1.0), (0.0, 0.5, False, 1e6), (0.0, 0.5, True, 0.25)),
    *((0.0, 0.5, False, math.nan), (0.0, 0.5, False, math.inf), (0.0, 0.5, False, 0.25), (0.0, 0.5, False, MISSING)),
    *((0.0, 0.5, False, -0.125), (math.nan, 0.5, False, 0.5), (math.nan, 0.5, False, -0.5), SAVE),
    *((0.0, 0.5, False, 0.5), (0.0, 0.5, False, TEXTUAL), (0.0, 0.0, False, 1.25), (0.0, 0.5, True, 0.0), BACK),
    *((0.0, 0.0, False, 1.0), (0.75, 0.5, False, 0.125), (0.0, 0.5, False, -math.inf), (0.0, 0.5, False, 0.0)),
    *(RESET, (0.0, 0.5, True, -2.0), (0.0, 0.5, True, 0.125), (0.0, 0.5, False, 0.125), (0.0, 0.5, False, 0.25)),
    *((1.0, 0.5, False, 0.375), (1.0, 0.0, False, 3.0), (1.0, 0.0, False, 3)),
)


def expected_lines(fspa: Fspa, actions: Sequence[Action]) -> list[Line]:
    return _lines(Monitor(fspa), MonitorError, actions)


def _lines(monitor: Any, error: type[Exception], actions: Sequence[Action]) -> list[Line]:
    """Return what a monitor in Python, of the library or generated, does for the actions."""
    saved, lines = monitor, list[Line]()
    for action in actions:
        if action == SAVE:
            saved = copy.copy(monitor)
        elif action == BACK:
            monitor = saved
        elif action == RESET:
            monitor.reset()
        else:
            assert not isinstance(action, str)
            *values, length = action
            arguments = [] if length == MISSING else [length]
            before, registers = (monitor.state, monitor.steps, monitor.progress, monitor.done), _registers(monitor)
            try:
                step = monitor.step(dict(zip(("x", "dt", "a"), values, strict=True)), *arguments)
            except error as refused:
                assert (monitor.state, monitor.steps, monitor.progress, monitor.done) == before
                assert _registers(monitor) == registers
                text = refused.diagnostics[0].title if isinstance(refused, TltlError) else str(refused)
                lines.append(Line(0, 0.0, text, registers))
            else:
                lines.append(Line(step.state, step.robustness, "", _registers(monitor)))
    return lines


def _registers(monitor: Any) -> tuple[float, ...]:
    return tuple(getattr(monitor, "registers", ()))


def actions_for(target: str) -> list[Action]:
    """Return the actions that programs of a target take; those of Godot have types, and only Python copies monitors."""
    unknown = () if target == "python" else (SAVE, BACK)
    typed = (MISSING, TEXTUAL) if target == "gdscript3" else ()
    return [each for each in ACTIONS if each not in unknown and (isinstance(each, str) or each[3] not in typed)]


def check(lines: Sequence[Line], fspa: Fspa, target: str) -> None:
    wanted = expected_lines(fspa, actions_for(target))
    assert len(lines) == len(wanted)
    for line, want in zip(lines, wanted, strict=True):
        assert (line.state, line.robustness, line.registers) == (want.state, want.robustness, want.registers)
        if "signal `x`" in want.refused:
            assert "the signal `x`" in line.refused
        elif "'text'" in want.refused and target != "python":
            assert line.refused == want.refused.replace("'text'", "of type string")
        else:
            assert line.refused == want.refused


def test_the_actions_cause_every_error() -> None:
    for target in SCRIPTS:
        refused = [line.refused for line in expected_lines(automata()["timed"], actions_for(target))]
        lengths = ["-1", "nan", "inf", "-0.125", "-0.5", "-inf", "-2"]
        lengths += [] if target == "gdscript3" else ["'text'"]
        for length in lengths:
            text = f"its time since the sample before is {length}, not a number of seconds"
            assert sum(text in line for line in refused) == 1, length
        assert "step 1: its time since the sample before is -1, not a number of seconds" in refused
        missing = "its time since the sample before is missing, and the clock varies"
        assert sum(missing in line for line in refused) == (0 if target == "gdscript3" else 2)
        # The length is checked before the signals.
        assert sum("signal `x`" in line for line in refused) == 1


JAVASCRIPT: Final = """
import { Monitor } from "./@name@_monitor.mjs";

function take(monitor, x, dt, a, ...length) {
  let text;
  try {
    const { state, robustness } = monitor.step({ x, dt, a }, ...length);
    text = `${state}|${robustness}||`;
  } catch (error) {
    text = `0|0|${error.message}|`;
  }
  console.log(text + Array.from(monitor.registers ?? [], (value) => (Object.is(value, -0) ? "-0" : value)).join(" "));
}

const monitor = new Monitor();
@@
"""

LUA: Final = """
local Monitor = require("@name@_monitor")

local function take(monitor, x, dt, a, length)
  local result, problem = monitor:step({ x = x, dt = dt, a = a }, length)
  local text = "0|0|" .. (problem or "") .. "|"
  if result then text = ("%d|%.17g||"):format(result.state, result.robustness) end
  for _, name in ipairs({ @names@ }) do
    text = text .. ("%.17g "):format(monitor.registers[name])
  end
  print(text)
end

local monitor = assert(Monitor.new())
@@
"""

GODOT: Final = """extends SceneTree

const Monitor = preload("res://@name@_monitor.gd")


func take(monitor, x: float, dt: float, a: bool, length: float) -> void:
	var sample = Monitor.Sample.new()
	sample.x = x
	sample.dt_1 = dt
	sample.a = a
	var text: String = "0|0|"
	if monitor.step(sample, length):
		text = "%d|%.20f||" % [monitor.state, monitor.robustness]
	else:
		text += monitor.message() + "|"
	for value in monitor.get("registers") if monitor.get("registers") else []:
		text += "%.20f " % value
	print(text)


func _init() -> void:
	var monitor = Monitor.new()
@@
	quit()
"""


def program(template: str, fspa: Fspa, target: str, call: str, reset: str, words: dict[str, str]) -> str:
    """Return a program: the template with a statement for each action. ``words`` are the words of the language."""
    lines = []
    for action in actions_for(target):
        if isinstance(action, str):
            lines.append(reset)
            continue
        x, dt, a, length = action
        given = [words.get(str(value), str(value)) for value in (x, dt, length)]
        lines.append(call.format(", ".join([*given[:2], str(a).lower(), given[2]]).rstrip(", ")))
    names = ", ".join(f'"{register.name}"' for register in fspa.registers)
    text = template.replace("@name@", fspa.name).replace("@names@", names)
    return text.replace("\n@@\n", "\n" + "\n".join(lines) + "\n")


def write_program(folder: Path, target: str, fspa: Fspa, driver: str, text: str) -> None:
    for name, content in emit(target, fspa).items():
        assert isinstance(content, str)
        (folder / name).write_text(content, encoding="utf-8")
    (folder / driver).write_text(text, encoding="utf-8")


names = pytest.mark.parametrize("name", ["timed", "timeless"])


@needs("node")
@names
def test_javascript_takes_and_refuses_lengths(name: str, tmp_path: Path) -> None:
    words = {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity", MISSING: "", TEXTUAL: '"text"'}
    fspa = automata()[name]
    text = program(JAVASCRIPT, fspa, "javascript", "take(monitor, {});", "monitor.reset();", words)
    write_program(tmp_path, "javascript", fspa, "driver.mjs", text)
    check(parsed(run(tmp_path, ["node", "driver.mjs"])), fspa, "javascript")


@needs("node")
def test_javascript_names_the_type_of_what_is_no_length(tmp_path: Path) -> None:
    """An example is a result in the place of the length, as with a fixed clock."""
    lines = """
import { Monitor, Result } from "./timed_monitor.mjs";
const monitor = new Monitor();
for (const length of [new Result(), true, null]) {
  try {
    monitor.step({ x: 0, dt: 0, a: true }, length);
  } catch (error) {
    console.log(error.name, error.message);
  }
}
console.log(monitor.steps);
const result = new Result();
console.log(monitor.step({ x: 0, dt: 0, a: true }, 0.25, result) === result);
"""
    write_program(tmp_path, "javascript", automata()["timed"], "driver.mjs", lines)
    before = "MonitorError step 1: its time since the sample before is"
    assert run(tmp_path, ["node", "driver.mjs"]).splitlines() == [
        f"{before} of type object, not a number of seconds",
        f"{before} of type boolean, not a number of seconds",
        f"{before} missing, and the clock varies",
        "0",
        "true",
    ]


interpreters = pytest.mark.parametrize(
    "interpreter", [pytest.param(name, marks=needs(name)) for name in ("lua5.1", "lua5.4", "luajit")]
)


@interpreters
@names
def test_lua_takes_and_refuses_lengths(interpreter: str, name: str, tmp_path: Path) -> None:
    words = {"nan": "0 / 0", "inf": "math.huge", "-inf": "-math.huge", MISSING: "", TEXTUAL: '"text"'}
    fspa = automata()[name]
    text = program(LUA, fspa, "lua", "take(monitor, {})", "monitor:reset()", words)
    write_program(tmp_path, "lua", fspa, "driver.lua", text)
    check(parsed(run(tmp_path, [interpreter, "driver.lua"])), fspa, "lua")


@needs("godot3-server")
@names
def test_gdscript_takes_and_refuses_lengths(name: str, tmp_path: Path) -> None:
    words = {"nan": "NAN", "inf": "INF", "-inf": "-INF"}
    fspa = automata()[name]
    text = program(GODOT, fspa, "gdscript3", "\ttake(monitor, {})", "\tmonitor.reset()", words)
    write_program(tmp_path, "gdscript3", fspa, "driver.gd", text)
    (tmp_path / "project.godot").touch()
    # Godot does not accept the locale C.
    out = run(tmp_path, ["env", "LANG=en", "godot3-server", "--path", ".", "-s", "driver.gd"])
    check(parsed(out), fspa, "gdscript3")


def generated(fspa: Fspa, folder: Path) -> ModuleType:
    """Return the generated Python module of an automaton."""
    write_program(folder, "python", fspa, "empty.py", "")
    module_spec = spec_from_file_location(f"{fspa.name}_monitor", folder / f"{fspa.name}_monitor.py")
    assert module_spec is not None and module_spec.loader is not None
    module = module_from_spec(module_spec)
    module_spec.loader.exec_module(module)
    return module


@names
def test_generated_python_takes_and_refuses_lengths(name: str, tmp_path: Path) -> None:
    fspa = automata()[name]
    module = generated(fspa, tmp_path)
    check(_lines(module.Monitor(), module.MonitorError, actions_for("python")), fspa, "python")


def test_generated_python_takes_the_numbers_that_the_library_takes(tmp_path: Path) -> None:
    np = pytest.importorskip("numpy")
    fspa = automata()["timed"]
    module, sample = generated(fspa, tmp_path), {"x": 0.0, "dt": 0.5, "a": True}
    for length in (1, True, np.float32(0.1), np.array(0.25), np.int64(1)):
        own, library = module.Monitor(), Monitor(fspa)
        for _ in range(2):
            assert own.step(sample, length)[:3] == library.step(sample, length)[:3]
        assert own.registers == library.registers
    wrong: tuple[Any, ...] = ([1.0], np.array([0.5]), b"1", None, -1, 10**5000)
    for length in wrong:
        with pytest.raises(MonitorError) as library_error:
            Monitor(fspa).step(sample, length)
        with pytest.raises(module.MonitorError) as own_error:
            module.Monitor().step(sample, length)
        assert str(own_error.value) == library_error.value.diagnostics[0].title


# --- checkers of the languages --------------------------------------------------------------------


@pytest.mark.skipif(not TSC, reason="there is no TypeScript compiler (tsc) here: types are not checked")
def test_the_types_require_the_length(tmp_path: Path) -> None:
    for fspa in automata().values():
        write_program(tmp_path, "javascript", fspa, "node.d.ts", "declare const process: any;\n")
    (tmp_path / "use.mts").write_text("""
import { Monitor, Result } from "./timed_monitor.mjs";
const result: Result = new Monitor().step({ x: 0, dt: 0, a: true }, 0.1, new Result());
new Monitor().step({ x: 0, dt: 0, a: true }, 0);
// @ts-expect-error: the length is missing.
new Monitor().step({ x: 0, dt: 0, a: true });
// @ts-expect-error: it is no length.
new Monitor().step({ x: 0, dt: 0, a: true }, result);
""")
    options = {"module": "nodenext", "allowJs": True, "checkJs": True, "noImplicitAny": False, "noUnusedLocals": True}
    options |= {"noUnusedParameters": True, "useUnknownInCatchVariables": False, "lib": ["es2022", "dom"]}
    files = ["node.d.ts", "use.mts", "timed_monitor.mjs", "timeless_monitor.mjs"]
    assert type_errors(tmp_path, files, **options) == ""


@pytest.mark.skipif(not GDPARSE, reason="there is no parser of GDScript (gdparse) here")
def test_scripts_for_godot_4_are_parsed(tmp_path: Path) -> None:
    for fspa in automata().values():
        write_program(tmp_path, "gdscript", fspa, "empty.gd", "")
    scripts = sorted(tmp_path.glob("*_monitor*.gd"))
    assert len(scripts) == 4
    result = subprocess.run([str(GDPARSE), *map(str, scripts)], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
