"""The programs of all monitors read names of values of enums, and fractions of an int, as ``tltlc monitor`` does."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Final

import pytest

from tests.backends import test_lua
from tests.backends.test_enums import guards, samples
from tests.backends.test_javascript import run_module
from tests.backends.test_lua import interpreters
from tests.backends.test_registers import needs
from tests.backends.test_step_lengths_in_scripts import generated
from tests.tools.conformance.runner import Outcome, Runner, build_program, output_differences, runners, write
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor, MonitorError
from tltlc.tools.conformance.expected_output import expected_output

TEXT: Final = """
signal seen: bool
signal mode: (idle, alert, chase, hide)
signal phase: int in [0, 5]

spec bosses {
    reach mode is alert then mode is hide then phase == 2 then phase == 3
    avoid mode is chase and seen
}
"""
VARYING: Final = """
clock varies
signal mode: (idle, alert)
spec hurry { keep mode is alert implies eventually within 2 s mode is idle }
"""
HEAD: Final = "seen,mode,phase\n"

GOOD: Final = (
    f"{HEAD}0,idle,0\nfalse,alert,1\n0,0,2\n0,hide,2\n0,idle,2\n0,chase,3\n",
    # Blanks around a name, in quotes too, and numbers beside names.
    f'{HEAD}0," alert\t",0\n0, alert ,0\n0,"hide",0\n0,3.0,0\n0,1e0,2\n0,"2",3\n',
    # No value of an enum is called `true`, which is the number 1 as in any cell.
    f"{HEAD}true,idle,0\n0,True,0\n0,hide,0\n1,false,2\n1,chase,0\n",
    # Fractions are used as they are: 1.9999999 and 2.4 count as 2, and 2.5 as neither 2 nor 3.
    f"{HEAD}0,alert,0\n0,hide,0\n0,1.4999999,2.5\n0,2.9,1.9999999\n0,-7,2.5\n0,9,3.4\n",
    f"{HEAD}0,alert,0\n0,hide,0\n0,idle,2.4\n0,idle,2.6\n",
)
"""Traces that are read to their ends."""

VALUES: Final = "not one of `idle`, `alert`, `chase` and `hide`"
BAD: Final = {
    f"{HEAD}0,idle,0\n0,blue,0\n": f"line 3: the signal `mode` is `blue`, {VALUES}",
    f"{HEAD}0,Alert,0\n": f"line 2: the signal `mode` is `Alert`, {VALUES}",
    f"{HEAD}0,mode.alert,0\n": f"line 2: the signal `mode` is `mode.alert`, {VALUES}",
    f"{HEAD}0,,0\n": f"line 2: the signal `mode` is ``, {VALUES}",
    f"{HEAD}0,al\u00e9rt,0\n": f"line 2: the signal `mode` is `al\u00e9rt`, {VALUES}",
    # The names of an enum are no values of other signals.
    f"{HEAD}0,idle,alert\n": "line 2: the signal `phase` is `alert`, not a number",
    f"{HEAD}alert,idle,0\n": "line 2: the signal `seen` is `alert`, not a number",
    f"{HEAD}2,idle,0\n": "line 2: the signal `seen` is `2`, not true or false",
}
"""Traces, and the messages of all programs."""

TIMES: Final = "mode,dt\nidle,0\nalert,1\nalert,1.5\n1,0.5\n0,1\n"

USABLE: Final = [runner for runner in runners() if runner.missing() is None]

RunAll = Callable[..., list[Outcome]]


def automaton(text: str) -> Fspa:
    (fspa,) = compile_text(text)
    return fspa


def trace_of_guards() -> str:
    """Return a trace with the names of values that are words of the languages, and names in the templates."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(samples()[0])
    writer.writerows(sample.values() for sample in samples())
    return text.getvalue()


@pytest.fixture(scope="module", params=USABLE, ids=lambda runner: runner.name)
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> RunAll:
    runner: Runner = request.param
    folder = tmp_path_factory.mktemp(runner.name)
    return build_program(runner, [automaton(TEXT), automaton(VARYING), guards()], folder)


def test_programs_take_names_as_the_monitor_does(run: RunAll) -> None:
    cases = [(automaton(TEXT), trace) for trace in GOOD]
    cases += [(automaton(VARYING), TIMES), (guards(), trace_of_guards())]
    outcomes = run([(fspa.name, trace.encode()) for fspa, trace in cases])
    for (fspa, trace), outcome in zip(cases, outcomes, strict=True):
        expected = expected_output(fspa, trace.encode())
        assert expected.rejection is None
        assert expected.rows
        assert not list(output_differences(outcome, expected, 0.0)), trace


def test_programs_list_the_names_if_there_is_no_such_value(run: RunAll) -> None:
    outcomes = run([("bosses", trace.encode()) for trace in BAD])
    for (trace, message), (status, _, err) in zip(BAD.items(), outcomes, strict=True):
        assert (status, err) == (1, f"error: {message}\n"), trace


def test_fractions_of_an_int_are_used_as_they_are() -> None:
    monitor = Monitor(automaton("signal phase: int in [0, 5] spec third = G (phase == 2 | phase == 3)"))
    verdicts = [monitor.step({"phase": phase}).verdict for phase in (1.9999999, 2.4, 2.6, 2.5)]
    assert verdicts == ["holding", "holding", "holding", "violated"]


# --- samples that a game gives --------------------------------------------------------------------

SAMPLE: Final[dict[str, float | str]] = {"seen": False, "mode": "blue", "phase": 0.0}
REFUSED: Final = f"step 1: the signal `mode` is `blue`, {VALUES}"


def test_generated_python_lists_the_names(tmp_path: Path) -> None:
    monitor = generated(automaton(TEXT), tmp_path).Monitor()
    with pytest.raises(ValueError, match="not one of") as refused:
        monitor.step(SAMPLE)
    assert str(refused.value) == REFUSED
    with pytest.raises(MonitorError, match="has no value `blue`"):
        Monitor(automaton(TEXT)).step(SAMPLE)


def test_generated_python_takes_names_in_json_lines(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main = generated(automaton(TEXT), tmp_path).main
    trace = tmp_path / "trace.jsonl"
    rows: list[dict[str, float | str]] = [
        {"seen": False, "mode": "alert", "phase": 0},
        {"seen": 0, "mode": "hide", "phase": 2.4},
    ]
    monitor = Monitor(automaton(TEXT))
    states = [str(monitor.step(row).state) for row in rows]
    assert len({*states, "0"}) == 3
    trace.write_text("".join(f"{json.dumps(row)}\n" for row in rows))
    assert main([str(trace)]) == 0
    assert [line.split(",")[1] for line in capsys.readouterr().out.splitlines()[1:]] == states
    wrong = '{"seen": false, "mode": @, "phase": 0}\n'
    for value, shown in (('"blue"', "blue"), ('" alert"', " alert"), ("[]", "[]"), ('"1"', "1")):
        trace.write_text(wrong.replace("@", value))
        assert main([str(trace)]) == 1
        assert capsys.readouterr().err == f"error: line 1: the signal `mode` is `{shown}`, {VALUES}\n"
    trace.write_text(wrong.replace("@", "NaN"))
    assert main([str(trace)]) == 1
    assert capsys.readouterr().err == "error: step 1: the signal `mode` is nan, not a finite number\n"


@needs("node")
def test_javascript_lists_the_names(tmp_path: Path) -> None:
    (javascript,) = (runner for runner in runners() if runner.target == "javascript")
    write(javascript, automaton(TEXT), tmp_path)
    lines = ['import { Monitor } from "./bosses_monitor.mjs";', "try {"]
    lines += ['  new Monitor().step({ seen: false, mode: "blue", phase: 0 });']
    lines += ["} catch (error) {", "  console.log(error.message);", "}"]
    (tmp_path / "use.mjs").write_text("\n".join(lines))
    assert run_module(tmp_path / "use.mjs") == (0, f"{REFUSED}\n", "")


@interpreters
def test_lua_lists_the_names(interpreter: str, tmp_path: Path) -> None:
    test_lua.write_module(automaton(TEXT), tmp_path)
    lines = ['local Monitor = dofile("bosses_monitor.lua")', "local monitor = assert(Monitor.new())"]
    lines += ['print(select(2, monitor:step({ seen = false, mode = "blue", phase = 0 })))']
    (tmp_path / "use.lua").write_text("\n".join(lines))
    assert test_lua.run_module(interpreter, tmp_path / "use.lua") == (0, f"{REFUSED}\n", "")
