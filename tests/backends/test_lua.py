"""The generated module agrees with :class:`tltlc.monitor.Monitor`, whatever the names; the corpus tests more."""

from __future__ import annotations

import math
import random
import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings

from tests.backends.monitors import FAR, one_atom
from tests.backends.strategies import hostile_automata
from tests.backends.test_javascript import NAMES, Outcome, awkward, printed_rows, rows, trace_of
from tests.fixtures import cover_and_hide
from tltlc import compile_text
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.record import replace
from tltlc.expression.tree import Condition, Const, Expression, Op, SignalValue, When
from tltlc.logic import formula as f
from tltlc.monitor import Monitor
from tltlc.resolve import spec

INTERPRETERS = tuple(name for name in ("lua5.1", "lua5.4", "luajit") if shutil.which(name))

pytestmark = pytest.mark.skipif(not INTERPRETERS, reason="there is no Lua here")
interpreters = pytest.mark.parametrize("interpreter", INTERPRETERS)


def write_module(fspa: Fspa, folder: Path) -> Path:
    ((name, text),) = emit("lua", fspa).items()
    assert name == f"{fspa.name}_monitor.lua"
    assert isinstance(text, str)
    (folder / name).write_text(text)
    return folder / name


def run_module(interpreter: str, module: Path, *arguments: str, stdin: bytes = b"") -> Outcome:
    command = [interpreter, module.name, *arguments]
    result = subprocess.run(command, input=stdin, capture_output=True, cwd=module.parent)
    return result.returncode, result.stdout.decode(), result.stderr.decode()


# --- names and texts ------------------------------------------------------------------------------

LUA_NAMES = (
    "and",
    "end",
    "nil",
    "repeat",
    "goto",
    "signal",
    "param",
    "value",
    "part",
    "part1",
    "failure",
    "huge",
    "--[[",
)


@settings(
    max_examples=12,
    deadline=None,
    derandomize=True,
    phases=(Phase.generate,),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
@given(fspa=hostile_automata())
def test_hostile_texts_do_not_become_code(tmp_path: Path, fspa: Fspa) -> None:
    assume("\0" not in fspa.signals[0].name)
    samples = [{fspa.signals[0].name: value, "health": 1.0} for value in (-1.0, 0.0, -0.5)]
    module = write_module(fspa, tmp_path)
    for interpreter in INTERPRETERS:
        status, out, err = run_module(interpreter, module, "--full", "-", stdin=trace_of(samples))
        assert (status, err) == (0, "")
        assert printed_rows(out) == rows(fspa, samples)


@interpreters
def test_hostile_names_stay_distinct(interpreter: str, tmp_path: Path) -> None:
    """Each atom reads a signal of the same awkward name; in each sample a different atom must be the limiting one."""
    fspa, samples = awkward([*LUA_NAMES, *NAMES])
    status, out, err = run_module(interpreter, write_module(fspa, tmp_path), "--full", "-", stdin=trace_of(samples))
    assert (status, err) == (0, "")
    assert printed_rows(out) == rows(fspa, samples)
    assert [row[8] for row in printed_rows(out)] == [*samples[0]]


# --- limits of Lua --------------------------------------------------------------------------------


@interpreters
def test_many_signals_and_long_guards_stay_within_the_limits_of_lua(interpreter: str, tmp_path: Path) -> None:
    """There are more signals than a function may have local variables, and than calls may nest."""
    names = [f"a{index}" for index in range(400)]
    fspa = build(spec_from_formula(f.eventually(f.or_(*map(f.atom, names)))))
    draw = random.Random(5)
    samples = [{name: -draw.random() for name in names} for _ in range(3)]
    samples.append({**samples[0], "a399": 0.5})
    status, out, err = run_module(interpreter, write_module(fspa, tmp_path), "--full", "-", stdin=trace_of(samples))
    assert (status, err) == (0, "")
    assert printed_rows(out) == rows(fspa, samples)


@interpreters
def test_long_predicates_stay_within_the_limits_of_lua(interpreter: str, tmp_path: Path) -> None:
    """A predicate has more parts than a function may have local variables."""
    x: Expression = SignalValue("x")
    total: Expression = Const(0.0)
    for part in range(300):
        case = When(((Condition(">", (x, Const(part / 300))), Op("*", (x, Const(0.001)))),), Const(-0.001))
        total = Op("+", (total, case))
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    fspa = replace(fspa, signals=(spec.Signal("x", "number", 0.0, 1.0),), atoms=(spec.Atom("p", total),))
    samples = [{"x": value / 10} for value in range(11)]
    with recursion_room():
        expected = rows(fspa, samples)
        module = write_module(fspa, tmp_path)
    status, out, err = run_module(interpreter, module, "--full", "-", stdin=trace_of(samples))
    assert (status, err) == (0, "")
    assert printed_rows(out) == expected


@interpreters
@pytest.mark.parametrize("within", [False, True])
def test_deeply_nested_cases_stay_within_the_limits_of_lua(interpreter: str, tmp_path: Path, within: bool) -> None:
    """Cases nest deeper than the blocks that a parser allows, with and without a computation after the inner value."""
    x = SignalValue("x")
    value: Expression = Const(0.5)
    for depth in range(300):
        value = When(((Condition(">", (x, Const(depth / 300))), value),), Const(depth / -300))
        value = Op("-", (Op("+", (value, Const(0.25))), Const(0.25))) if within else value
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    fspa = replace(fspa, signals=(spec.Signal("x", "number", 0.0, 1.0),), atoms=(spec.Atom("p", value),))
    samples = [{"x": sample / 10} for sample in (0, 3, 7, 10)]
    with recursion_room():
        expected = rows(fspa, samples)
        module = write_module(fspa, tmp_path)
    status, out, err = run_module(interpreter, module, "--full", "-", stdin=trace_of(samples))
    assert (status, err) == (0, "")
    assert printed_rows(out) == expected


@interpreters
def test_tanh_agrees_with_python(interpreter: str, tmp_path: Path) -> None:
    """Newer versions of Lua have no tanh; the replacement in the module keeps signs and small values."""
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    atom = spec.Atom("p", Op("tanh", (SignalValue("x"),)))
    fspa = replace(fspa, signals=(spec.Signal("x", "number", None, None),), atoms=(atom,))
    sizes = [0.0, 1e-300, 1e-9, 0.1, 0.25, 0.4999, 0.5, 0.5001, 0.75, 1.0, 3.0, 19.0, 25.0, 1e3, 1e308]
    samples = [{"x": sign * size} for size in sizes for sign in (-1.0, 1.0)]
    status, out, _ = run_module(interpreter, write_module(fspa, tmp_path), "--full", "-", stdin=trace_of(samples))
    assert status == 0
    for row, expected in zip(printed_rows(out), rows(fspa, samples), strict=True):
        assert row[:5] == expected[:5]
        assert float(row[7]) == pytest.approx(float(expected[7]), rel=1e-15, abs=0.0)


@interpreters
def test_numbers_are_printed_as_c_prints_them(interpreter: str, tmp_path: Path) -> None:
    """The robustness of an edge equals the signal to the last digit; ties are rounded to even."""
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    fspa = replace(fspa, signals=(spec.Signal("x", "number", -1.0, 1.0),), atoms=(spec.Atom("p", SignalValue("x")),))
    values = [sign * (1 + 2 * odd) * 2.0**-power for power in range(64) for odd in range(9) for sign in (1, -1)]
    values += [math.sin(number) * 10.0**-power for power in (0, 3, 5, 9, 99, 310) for number in range(60)]
    samples = [{"x": value} for value in values if abs(value) <= 1]
    status, out, _ = run_module(interpreter, write_module(fspa, tmp_path), "--full", "-", stdin=trace_of(samples))
    assert status == 0
    assert printed_rows(out) == rows(fspa, samples)


# --- as a module ----------------------------------------------------------------------------------

USE = """
setmetatable(_G, {
  __index = function(_, name) error("there is no global " .. tostring(name), 2) end,
  __newindex = function(_, name) error("a new global " .. tostring(name), 2) end,
})
package.path = "./?.lua"
local Monitor = require("cover_and_hide_monitor")

print(Monitor.new({ level_size = 1 }))
print(Monitor.new({ level_size = 0 / 0 }))
print(Monitor.new({ level_size = "10" }))
print(Monitor.new({ size = 1 }))
local monitor = assert(Monitor.new({ level_size = 10 }))
local result = {}
local function sample(changed)
  local made = { ["distance(s1)"] = 5, ["distance(s2)"] = 5, ["distance(exit)"] = 5, health = true, unused = "-" }
  for name, value in pairs(changed) do made[name] = value end
  return made
end
for _ = 1, 2 do
  print(monitor:step({ health = 1, ["distance(s2)"] = 5 }, result))
  print(monitor:step(sample({ health = 1 / 0 }), result))
  print(monitor:step(sample({ health = "1" }), result))
  local taken = monitor:step(sample({ health = 2 }), result)
  print(taken == result, ("%.17g"):format(result.progress), result.limiting)
  print(monitor:step(sample({ ["distance(s1)"] = 0.5, ["distance(exit)"] = 0.5 }), result))
  print(monitor.state, monitor.steps, result.label, monitor:step(sample({})) == result)
  monitor:reset()
end
print(monitor.steps, #monitor.notices, monitor.notices[1])
print(("%.17g"):format(monitor.params.level_size))
"""


@interpreters
def test_a_host_gets_results_notices_and_errors(interpreter: str, tmp_path: Path) -> None:
    fspa = cover_and_hide()
    write_module(fspa, tmp_path)
    (tmp_path / "use.lua").write_text(USE)
    step = Monitor(fspa, {"level_size": 10.0}).step({**dict.fromkeys(FAR, 5.0), "health": 1.0})
    group = "near(s1), near(s2), near(exit)"
    lines = [
        "nil\tthe param `level_size` cannot be 1: its range is [2, 10000]",
        "nil\tthe param `level_size` cannot be nan",
        "nil\tthe value given for the param `level_size` is not a number",
        "nil\tthere is no param `size` to set",
        *[
            "nil\tstep 1: no value for `distance(s1)` and `distance(exit)`",
            "nil\tstep 1: the signal `health` is inf, not a finite number",
            "nil\tstep 1: the signal `health` is not a number",
            f"true\t{step.progress:.17g}\tnear(s1)",
            f"nil\tstep 2: `near(s1)` and `near(exit)` hold at once, against `exclusive {group}`",
            "0\t1\tnil\tfalse",
        ]
        * 2,
        "0\t1\tstep 1: the signal `health` is 2, outside [0, 1]: it counts as 1",
        "10",
    ]
    status, out, err = run_module(interpreter, tmp_path / "use.lua")
    assert (status, err) == (0, "")
    assert out.splitlines() == lines


REFUSE = """
local Monitor = dofile("refusing_monitor.lua")
local monitor, result = assert(Monitor.new()), {}
assert(monitor:step(@GOOD@, result) == result and next(result))
local taken, message = monitor:step(@BAD@, result)
print(taken, message, next(result), monitor.steps)
print(monitor:step(@BAD@))
assert(monitor:step(@GOOD@, result) == result and result.verdict)
"""


def refusing(text: str) -> Fspa:
    (fspa,) = compile_text(f"signal x: number\n{text}")
    return replace(fspa, name="refusing")


X = SignalValue("x")
QUOTIENT = replace(one_atom(Op("/", (Const(1.0), X)), spec.Signal("x", "number", None, None)), name="refusing")
SHARE = refusing("predicate p = clamp(x, -1, 1) spec s { reach p }")
CUBE = refusing("predicate p = clamp(previous(x * x * x), -1, 1) spec s { reach p }")
VARYING = refusing("clock varies predicate p = clamp(x, -1, 1) spec s { keep eventually within 2 s p }")


@interpreters
@pytest.mark.parametrize(
    ("fspa", "bad", "message"),
    [
        (SHARE, "{}", "no value for `x`"),
        (SHARE, '{ x = "1" }', "the signal `x` is not a number"),
        (QUOTIENT, "{ x = 0 }", "the atom `p` divides by zero"),
        (QUOTIENT, "{ x = 1e-320 }", "the atom `p` is too large to compute"),
        (CUBE, "{ x = 1e110 }", "the register `last value of (x * x * x)` is too large to compute"),
        (VARYING, "{ x = 1 }, -1", "its time since the sample before is -1, not a number of seconds"),
    ],
)
def test_a_refused_step_empties_the_result(
    fspa: Fspa, bad: str, message: str, interpreter: str, tmp_path: Path
) -> None:
    write_module(fspa, tmp_path)
    good = "{ x = 1 }, 1" if fspa.clock_varies else "{ x = 1 }"
    (tmp_path / "refuse.lua").write_text(REFUSE.replace("@GOOD@", good).replace("@BAD@", bad))
    status, out, err = run_module(interpreter, tmp_path / "refuse.lua")
    assert (status, err) == (0, "")
    assert out.splitlines() == [f"nil\tstep 2: {message}\tnil\t1", f"nil\tstep 2: {message}"]


ALLOCATES = """
-- A compiler keeps traces of its own.
if jit then jit.off() end
local Monitor = dofile("cover_and_hide_monitor.lua")
local monitor, result = Monitor.new(), {}
local signals = { ["distance(s1)"] = 5.5, ["distance(s2)"] = 5.5, ["distance(exit)"] = 5.5, health = 2.0 }
for _ = 1, 100 do monitor:step(signals, result) end
collectgarbage("collect")
collectgarbage("stop")
local before = collectgarbage("count")
for _ = 1, 100000 do monitor:step(signals, result) end
print(collectgarbage("count") - before < 1)
"""


@interpreters
def test_a_step_allocates_nothing(interpreter: str, tmp_path: Path) -> None:
    write_module(cover_and_hide(), tmp_path)
    (tmp_path / "use.lua").write_text(ALLOCATES)
    assert run_module(interpreter, tmp_path / "use.lua") == (0, "true\n", "")
