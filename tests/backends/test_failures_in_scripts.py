"""Monitors in scripting languages say what a trace fails at, and refuse missing bools unless they are sparse."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from pathlib import Path
from typing import Any, Final

import pytest

from tests.backends import test_javascript, test_lua
from tests.backends.failures import ROUNDS, failure_lines, guarded
from tests.backends.test_javascript import printed_rows, rows
from tests.backends.test_lua import interpreters
from tests.backends.test_registers import needs
from tests.backends.test_step_lengths_in_scripts import generated
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.logic import formula as f
from tltlc.monitor import Monitor

NO_CAUSE: Final = (build(spec_from_formula(f.FALSE)), build(spec_from_formula(f.TRUE)))
"""Automata of specs that no trace meets, and that every trace meets."""

CALM: Final = {"seen": False, "health": 1.0, "alarm": False, "open": False}
SPARSE: Final[tuple[dict[str, float], ...]] = ({"seen": True}, {"health": 1}, {"health": 1, "seen": True})
DENSE_ERRORS: Final = (
    "step 1: no value for `health`, `alarm` and `open`",
    "step 1: no value for `seen`, `alarm` and `open`",
    "step 1: no value for `alarm` and `open`",
)
SPARSE_LINES: Final = ("step 1: no value for `health`", "", "seen")
"""What a sparse monitor says of the samples in ``SPARSE``: the message, or the atom that the trace fails at."""

# --- JavaScript -----------------------------------------------------------------------------------

JAVASCRIPT: Final = """
import { Monitor, Result } from "./guarded_monitor.mjs";

const monitor = new Monitor();
const result = new Result();
for (const letters of @ROUNDS@) {
  monitor.reset();
  for (const letter of letters) {
    const health = letter === "h" || letter === "b" ? 0.25 : 1;
    monitor.step({ seen: letter === "s" || letter === "b", health, alarm: letter === "a", open: false }, result);
    const { label_english, failed_clause, failed_atom, failed_step } = result;
    console.log([label_english, failed_clause ?? "", failed_atom ?? "", failed_step ?? ""].join("|"));
  }
}
"""


@needs("node")
def test_javascript_says_what_the_trace_fails_at_until_a_reset(tmp_path: Path) -> None:
    test_javascript.write_module(guarded(), tmp_path)
    (tmp_path / "use.mjs").write_text(JAVASCRIPT.replace("@ROUNDS@", str([*ROUNDS])))
    status, out, err = test_javascript.run_module(tmp_path / "use.mjs")
    assert (status, err) == (0, "")
    assert out.splitlines() == [*failure_lines(guarded())]


@needs("node")
@pytest.mark.parametrize("fspa", NO_CAUSE)
def test_javascript_names_no_cause_of_what_has_none(fspa: Fspa, tmp_path: Path) -> None:
    module = test_javascript.write_module(fspa, tmp_path)
    status, out, err = test_javascript.run_module(module, "--full", "-", stdin=b"x\n1\n1\n")
    assert (status, err) == (0, "")
    assert printed_rows(out) == rows(fspa, [{}, {}])


SPARSE_JAVASCRIPT: Final = """
import { Monitor } from "./guarded_monitor.mjs";

for (const options of [undefined, {}, { sparse: true }]) {
  const monitor = new Monitor({}, options);
  for (const sample of [{ seen: true }, { health: 1 }, { health: 1, seen: true }, { health: 1, seen: null }]) {
    try {
      console.log(monitor.step(sample).failed_atom ?? "");
    } catch (error) {
      console.log(error.message);
    }
  }
}
"""


@needs("node")
def test_javascript_refuses_missing_bools_unless_sparse(tmp_path: Path) -> None:
    test_javascript.write_module(guarded(), tmp_path)
    (tmp_path / "use.mjs").write_text(SPARSE_JAVASCRIPT)
    dense = [*DENSE_ERRORS, DENSE_ERRORS[-1]]
    status, out, err = test_javascript.run_module(tmp_path / "use.mjs")
    assert (status, err) == (0, "")
    assert out.splitlines() == [*dense, *dense, *SPARSE_LINES, "step 3: the signal `seen` is not a number"]


# --- Lua ------------------------------------------------------------------------------------------

LUA: Final = """
local Monitor = dofile("guarded_monitor.lua")

local monitor, result = assert(Monitor.new()), {}
for letters in ("@ROUNDS@"):gmatch("[^,]+") do
  monitor:reset()
  for letter in letters:gmatch(".") do
    local health = (letter == "h" or letter == "b") and 0.25 or 1
    local sample = { seen = letter == "s" or letter == "b", health = health, alarm = letter == "a", open = false }
    assert(monitor:step(sample, result))
    local failed = { result.failed_clause or "", result.failed_atom or "", result.failed_step or "" }
    print(result.label_english .. "|" .. table.concat(failed, "|"))
  end
end

-- A copy goes on by itself.
monitor:reset()
local calm = { seen = false, health = 1, alarm = false, open = false }
monitor:step({ seen = true, health = 1, alarm = false, open = false })
local copy = setmetatable({}, getmetatable(monitor))
for key, value in pairs(monitor) do copy[key] = value end
monitor:reset()
print(monitor:step(calm).failed_clause, copy:step(calm).failed_clause, copy:step(calm, result).failed_step)
print(monitor:step(calm, result).failed_step, result.failed_clause, result.failed_atom)
"""


@interpreters
def test_lua_says_what_the_trace_fails_at_until_a_reset(interpreter: str, tmp_path: Path) -> None:
    test_lua.write_module(guarded(), tmp_path)
    (tmp_path / "use.lua").write_text(LUA.replace("@ROUNDS@", ",".join(ROUNDS)))
    status, out, err = test_lua.run_module(interpreter, tmp_path / "use.lua")
    assert (status, err) == (0, "")
    assert out.splitlines() == [*failure_lines(guarded()), "nil\tavoid seen\t1", "nil\tnil\tnil"]


@interpreters
@pytest.mark.parametrize("fspa", NO_CAUSE)
def test_lua_names_no_cause_of_what_has_none(interpreter: str, fspa: Fspa, tmp_path: Path) -> None:
    module = test_lua.write_module(fspa, tmp_path)
    status, out, err = test_lua.run_module(interpreter, module, "--full", "-", stdin=b"x\n1\n1\n")
    assert (status, err) == (0, "")
    assert printed_rows(out) == rows(fspa, [{}, {}])


SPARSE_LUA: Final = """
local Monitor = dofile("guarded_monitor.lua")

for _, options in ipairs({ {}, { sparse = true } }) do
  local monitor = assert(Monitor.new(nil, options))
  for _, sample in ipairs({ { seen = true }, { health = 1 }, { health = 1, seen = true } }) do
    local result, problem = monitor:step(sample)
    print(problem or result.failed_atom or "")
  end
end
"""


@interpreters
def test_lua_refuses_missing_bools_unless_sparse(interpreter: str, tmp_path: Path) -> None:
    test_lua.write_module(guarded(), tmp_path)
    (tmp_path / "use.lua").write_text(SPARSE_LUA)
    status, out, err = test_lua.run_module(interpreter, tmp_path / "use.lua")
    assert (status, err) == (0, "")
    assert out.splitlines() == [*DENSE_ERRORS, *SPARSE_LINES]


# --- Python ---------------------------------------------------------------------------------------


def test_generated_python_says_what_the_trace_fails_at_until_a_reset(tmp_path: Path) -> None:
    monitor, lines = generated(guarded(), tmp_path).Monitor(), []
    for letters in ROUNDS:
        monitor.reset()
        for letter in letters:
            sample = {"seen": letter in "sb", "health": 0.25 if letter in "hb" else 1.0}
            step = monitor.step({**CALM, **sample, "alarm": letter == "a"})
            failed = (step.failed_clause or "", step.failed_atom or "", str(step.failed_step or ""))
            lines.append("|".join((step.label_english, *failed)))
    assert lines == [*failure_lines(guarded())]


def test_a_copy_of_generated_python_goes_on_by_itself(tmp_path: Path) -> None:
    monitor = generated(guarded(), tmp_path).Monitor()
    monitor.step({**CALM, "seen": True})
    other = copy(monitor)
    monitor.reset()
    assert monitor.step(CALM)[-3:] == (None, None, None)
    assert other.step(CALM)[-3:] == ("avoid seen", "seen", 1)


@pytest.mark.parametrize("fspa", NO_CAUSE)
def test_generated_python_names_no_cause_of_what_has_none(fspa: Fspa, tmp_path: Path) -> None:
    monitor, library = generated(fspa, tmp_path).Monitor(), Monitor(fspa)
    for _ in range(2):
        assert monitor.step({})[-4:] == library.step({})[-4:]


def _line(monitor: Any, sample: Mapping[str, float]) -> str:
    try:
        return monitor.step(sample).failed_atom or ""
    except ValueError as error:
        return str(error)


def test_generated_python_refuses_missing_bools_unless_sparse(tmp_path: Path) -> None:
    module = generated(guarded(), tmp_path)
    for monitor in (module.Monitor(), module.Monitor({}, sparse=False)):
        assert [_line(monitor, sample) for sample in SPARSE] == [*DENSE_ERRORS]
    sparse = module.Monitor(sparse=True)
    assert [_line(sparse, sample) for sample in SPARSE] == [*SPARSE_LINES]
