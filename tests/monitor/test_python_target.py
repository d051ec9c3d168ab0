"""The generated monitor agrees with :class:`tltlc.monitor.Monitor` to the last bit, whatever the names in the spec."""

from __future__ import annotations

import csv
import io
import itertools
import json
import math
import subprocess
import sys
import types
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.automaton import letters
from tests.backends.strategies import HOSTILE, hostile_automata
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.monitor.strategies import PARAMS, SIGNALS, atom_traces, automata, expressions, numbers
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa, Text
from tltlc.backends import emit
from tltlc.core.record import replace
from tltlc.expression.tree import Const, Expression, Op, SignalValue
from tltlc.logic import formula as f
from tltlc.logic import oracle
from tltlc.monitor import Monitor, MonitorError
from tltlc.resolve import spec

ROOT = Path(__file__).parents[2]
FAR = {"distance(s1)": 20.0, "distance(s2)": 20.0, "distance(exit)": 20.0, "health": 1.0}


def source_of(fspa: Fspa) -> str:
    ((name, text),) = emit("python", fspa).items()
    assert name == f"{fspa.name}_monitor.py"
    assert isinstance(text, str)
    return text


def module_of(fspa: Fspa) -> Any:
    """Generate the module, execute it, and return it."""
    module = types.ModuleType("generated")
    sys.modules["generated"] = module  # NamedTuple looks its module up
    exec(compile(source_of(fspa), "generated.py", "exec"), module.__dict__)
    return module


def outcome(step: Callable[[Mapping[str, Any]], Any], sample: Mapping[str, Any]) -> object:
    """Return the fields of a step as texts, in which 0 differs from -0, or the message of the error."""
    try:
        return [repr(field) for field in step(sample)]
    except MonitorError as error:
        return error.diagnostics[0].title
    except ValueError as error:
        return str(error)


def notices(monitor: Monitor) -> list[str]:
    return [notice.title for notice in monitor.notices]


# --- equality -------------------------------------------------------------------------------------


@times(60)
@given(st.data(), automata())
def test_steps_agree_with_the_monitor_on_random_automata(data: st.DataObject, fspa: Fspa) -> None:
    generated, monitor = module_of(fspa).Monitor(), Monitor(fspa)
    names = [atom.name for atom in fspa.atoms]
    for values in data.draw(atom_traces(fspa, max_size=12)):
        sample = dict(zip(names, values, strict=True))
        assert outcome(generated.step, sample) == outcome(monitor.step, sample)


@times(60)
@given(st.data(), formulas(), st.sampled_from([(), (("a", "b"),), (("a", "b"), ("b", "c", "d"))]))
def test_oracle_automaton_monitor_and_generated_monitor_agree(
    data: st.DataObject, formula: f.Formula, exclusive: tuple[tuple[str, ...], ...]
) -> None:
    """The traces have many exact zeros, with and without exclusive atoms; the rewards of an episode also add up."""
    limit = data.draw(st.integers(1, 6))
    judge: spec.JudgeMode = data.draw(st.sampled_from(["goal", "limit"]))
    fspa = replace(build(spec_from_formula(formula, exclusive=exclusive)), limit_steps=limit, judge=judge)
    generated, monitor = module_of(fspa).Monitor(), Monitor(fspa)
    names = [atom.name for atom in fspa.atoms]
    state, prefix, total, progress = 0, [], 0.0, 0.0
    for values in data.draw(atom_traces(fspa)):
        state = letters.step(fspa, state, tuple(value > 0.0 for value in values))
        prefix.append({name for name, value in zip(names, values, strict=True) if value > 0.0})
        was_done = monitor.done
        step = monitor.step_atoms(values)
        assert repr(tuple(generated.step(dict(zip(names, values, strict=True))))) == repr(tuple(step))
        assert (step.state, step.accepting) == (state, oracle.holds(formula, prefix))
        total += step.reward
        if was_done:
            assert step.reward == 0.0
        elif step.verdict == "violated":
            # The cost of the steps and the terminal penalty add up to 1.
            assert step.done
            assert total == pytest.approx(step.progress - 1)
        else:
            assert total == pytest.approx(step.progress - len(prefix) / limit)
            goal = step.accepting if judge == "goal" else step.verdict == "satisfied"
            assert step.done == (goal or len(prefix) == limit)
        assert progress <= step.progress <= 1.0
        progress = step.progress


@given(st.data(), expressions(), st.tuples(numbers, numbers))
def test_values_of_atoms_agree_with_the_monitor(
    data: st.DataObject, expression: Expression, params: tuple[float, float]
) -> None:
    """This includes clamped values with their notices, and failures."""
    fspa = replace(
        build(spec_from_formula(f.eventually(f.and_(f.atom("a"), f.atom("b"))))),
        signals=(spec.Signal(SIGNALS[0], "number", None, 2.0), spec.Signal(SIGNALS[1], "number", -3.0, None)),
        params=tuple(spec.Param(name, "number", value, None, None) for name, value in zip(PARAMS, params, strict=True)),
        atoms=(spec.Atom("a", expression), spec.Atom("b", SignalValue(SIGNALS[0]))),
    )
    generated, monitor = module_of(fspa).Monitor(), Monitor(fspa)
    for _ in range(3):
        sample = dict(zip(SIGNALS, data.draw(st.tuples(numbers, numbers)), strict=True))
        assert outcome(generated.step, sample) == outcome(monitor.step, sample)
    assert generated.notices == notices(monitor)


@pytest.mark.parametrize(
    "changes",
    [
        [{"distance(s1)": 0.5}, {"distance(s2)": 3}, {"distance(s2)": 0}, {"distance(exit)": 0.25}, {"health": 0}],
        [{"health": 2.0, "distance(s1)": -4.0}, {"health": 1.5}, {"health": True}],
        [{"health": math.nan}, {"health": math.inf}, {"health": "1"}, {"health": None}, {"health": 10**400}, {}],
        [{"distance(s1)": 0.0, "distance(s2)": 0.0}, {"distance(s1)": 0.0, "distance(exit)": 0.0}, {}],
    ],
)
def test_the_generated_monitor_treats_invalid_samples_as_the_monitor_does(changes: list[dict[str, Any]]) -> None:
    generated, monitor = module_of(cover_and_hide()).Monitor(), Monitor(cover_and_hide())
    for change in changes:
        assert outcome(generated.step, {**FAR, **change}) == outcome(monitor.step, {**FAR, **change})
        assert (generated.state, generated.steps) == (monitor.state, monitor.steps)
    assert generated.notices == notices(monitor)


def test_missing_signals_agree_with_the_monitor() -> None:
    for count in range(4):
        for names in itertools.combinations(FAR, count):
            sample = {name: FAR[name] for name in names}
            expected = outcome(Monitor(cover_and_hide()).step, sample)
            assert outcome(module_of(cover_and_hide()).Monitor().step, sample) == expected


def test_bools_agree_with_the_monitor() -> None:
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    atom = spec.Atom("p", Op("-", (Op("*", (Const(2.0), SignalValue("x"))), Const(1.0))))
    fspa = replace(fspa, signals=(spec.Signal("x", "bool", 0.0, 1.0),), atoms=(atom,))
    generated = module_of(fspa).Monitor()
    monitor = Monitor(fspa)
    for value in (False, 0, 0.0, 0.5, 2, -1, "true", True, 1, 1.0):
        assert outcome(generated.step, {"x": value}) == outcome(monitor.step, {"x": value})


def test_many_exclusive_atoms_agree_with_the_monitor() -> None:
    names = [f"a{index}" for index in range(10)]
    fspa = build(spec_from_formula(f.eventually(f.atom("a0")), exclusive=[names]))
    generated, monitor = module_of(fspa).Monitor(), Monitor(fspa)
    for holding in [(), (3, 9), (9,), (0,)]:
        sample = {name: 1.0 if index in holding else -1.0 for index, name in enumerate(names)}
        assert outcome(generated.step, sample) == outcome(monitor.step, sample)


def test_params_agree_with_the_monitor() -> None:
    module = module_of(cover_and_hide())
    given_ = {"level_size": 10.0}
    assert outcome(module.Monitor(given_).step, FAR) == outcome(Monitor(cover_and_hide(), given_).step, FAR)
    for wrong in ({"size": 1.0}, {"level_size": 1.0}, {"level_size": math.nan}, {"level_size": -math.inf}):
        with pytest.raises(MonitorError) as ours:
            Monitor(cover_and_hide(), wrong)
        with pytest.raises(module.MonitorError) as theirs:
            module.Monitor(wrong)
        assert str(theirs.value) == ours.value.diagnostics[0].title


def test_after_a_reset_the_same_samples_give_the_same_steps() -> None:
    generated = module_of(cover_and_hide()).Monitor()
    first = [generated.step({**FAR, "distance(s1)": 0.5}), generated.step({**FAR, "health": 0})]
    generated.reset()
    assert [generated.step({**FAR, "distance(s1)": 0.5}), generated.step({**FAR, "health": 0})] == first


@pytest.mark.parametrize("formula", [f.TRUE, f.FALSE, f.next_(f.TRUE)])
def test_a_spec_without_atoms_agrees_with_the_monitor(formula: f.Formula) -> None:
    fspa = build(spec_from_formula(formula))
    generated, monitor = module_of(fspa).Monitor(), Monitor(fspa)
    for _ in range(3):
        assert outcome(generated.step, {}) == outcome(monitor.step, {})


@pytest.mark.parametrize("depth", [100])
def test_deep_arithmetic_agrees_with_the_monitor(depth: int) -> None:
    expression: Expression = SignalValue("x")
    for _ in range(depth):
        expression = Op("*", (Const(0.5), Op("+", (Op("^", (expression, Const(2.0))), Const(0.25)))))
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    fspa = replace(fspa, signals=(spec.Signal("x", "number", -1.0, 1.0),), atoms=(spec.Atom("p", expression),))
    assert outcome(module_of(fspa).Monitor().step, {"x": 0.5}) == outcome(Monitor(fspa).step, {"x": 0.5})


# --- names and texts ------------------------------------------------------------------------------


@times(40)
@given(hostile_automata())
def test_hostile_texts_do_not_become_code(fspa: Fspa) -> None:
    module = module_of(fspa)
    assert source_of(fspa).encode().decode() == source_of(fspa)
    # All atoms read the same signal here, so a value above 0 violates the exclusive atoms, which the error names.
    generated, monitor = module_of(fspa).Monitor(), Monitor(fspa)
    for value in (1.0, -1.0, 0.0):
        sample = {fspa.signals[0].name: value, "health": 1.0}
        assert outcome(generated.step, sample) == outcome(monitor.step, sample)
    assert module.Step._fields == Monitor(cover_and_hide()).step(FAR)._fields


NAMES = (
    *("self", "state", "step", "None", "class", "max", "min", "float", "failing", "nearest", "robustness", "inf"),
    *("sqrt", "_base", "__class__", "x", "x_1", "x.1", "x(1)", "Step", "match", "tuple", "signals", "error", "sum"),
    *("_STATES", "_from_0", "values", "1", "", "a" * 300, *HOSTILE),
)


def test_hostile_names_stay_distinct() -> None:
    """Each atom reads a signal of the same awkward name; in each sample a different atom must be the limiting one."""
    names = list(dict.fromkeys(NAMES))
    atoms = [f"v{index}" for index in range(len(names))]
    fspa = build(spec_from_formula(f.eventually(f.and_(*map(f.atom, atoms)))))
    fspa = replace(
        fspa,
        signals=tuple(spec.Signal(name, "number", -1.0, 1.0) for name in names),
        params=tuple(spec.Param(name, "number", 0.0, None, None) for name in names),
        atoms=tuple(spec.Atom(name, SignalValue(name)) for name in names),
    )
    module = module_of(fspa)
    for name in names:
        step = module.Monitor().step({other: -0.25 if other == name else 0.5 for other in names})
        assert (step.limiting, step.robustness) == (name, 0.25)


def test_hostile_texts_execute_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    attack = 'open("broken", "w")'
    for text in (
        f'"""\n{attack}\n"""',
        f"\n{attack}\n",
        f"\r{attack}",
        f"\\\n{attack}",
        f"{{{attack}}}",
        f"'+{attack}+'",
    ):
        fspa = cover_and_hide()
        label = Text(text, text, text)
        fspa = replace(
            fspa,
            doc=text,
            formula=label,
            states=tuple(replace(state, label=label) for state in fspa.states),
            atoms=tuple(
                replace(atom, base=f"{text}{index}", arguments=(), doc=text) for index, atom in enumerate(fspa.atoms)
            ),
            edges=tuple(replace(edge, guard=replace(edge.guard, formula=label)) for edge in fspa.edges),
        )
        step = module_of(fspa).Monitor().step(FAR)
        assert step.label == text
    assert not Path("broken").exists()


# --- the file -------------------------------------------------------------------------------------


def test_output_is_the_same_for_the_same_input() -> None:
    assert source_of(cover_and_hide()) == source_of(cover_and_hide())


def test_the_file_imports_nothing_of_the_project_and_passes_mypy(tmp_path: Path) -> None:
    path = tmp_path / "cover_and_hide_monitor.py.txt"
    path.write_text(source_of(cover_and_hide()), encoding="utf-8")
    command = [sys.executable, "-I", "-W", "error", "-c", "import runpy, sys; runpy.run_path(sys.argv[1])", str(path)]
    subprocess.run(command, check=True, cwd=tmp_path)
    pytest.importorskip("mypy")
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file=", "--python-version=3.10", str(path)],
        capture_output=True,
        text=True,
        cwd=tmp_path,
    )
    assert checked.returncode == 0, checked.stdout


def run_script(tmp_path: Path, trace: str | None, *arguments: str, stdin: str = "") -> tuple[int, str, str]:
    path = tmp_path / "cover_and_hide_monitor.py.txt"
    path.write_text(source_of(cover_and_hide()), encoding="utf-8")
    if trace is not None:
        (tmp_path / "trace.csv").write_text(trace, encoding="utf-8", errors="surrogateescape")
    command = [sys.executable, path.name, *arguments]
    result = subprocess.run(command, input=stdin, capture_output=True, text=True, cwd=tmp_path)
    assert "Traceback" not in result.stderr
    return result.returncode, result.stdout, result.stderr


TRACE = [{**FAR, "distance(s1)": 0.3}, {**FAR, "distance(s2)": 7.7}, {**FAR, "health": 0.1}, {**FAR, "health": -1.0}]


def as_csv(rows: list[dict[str, float]]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, [*FAR, "unused"], restval="?")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def test_the_script_prints_the_steps(tmp_path: Path) -> None:
    monitor = Monitor(cover_and_hide())
    lines = ["step,state,verdict,accepting,done,progress,reward"]
    for number, sample in enumerate(TRACE, start=1):
        step = monitor.step(sample)
        flags = f"{'true' if step.accepting else 'false'},{'true' if step.done else 'false'}"
        lines.append(f"{number},{step.state},{step.verdict},{flags},{step.progress:.17g},{step.reward:.17g}")
    expected = "\n".join([*lines, ""])
    warning = "warning: step 4: the signal `health` is -1, outside [0, 1]: it counts as 0\n"
    assert run_script(tmp_path, as_csv(TRACE), "trace.csv") == (0, expected, warning)
    assert run_script(tmp_path, None, "-", stdin=as_csv(TRACE)) == (0, expected, warning)
    objects = "\n".join(str(row).replace("'", '"') for row in TRACE)
    assert run_script(tmp_path, objects, "trace.csv") == (0, expected, warning)


@pytest.mark.parametrize(
    ("trace", "arguments", "status", "message"),
    [
        (as_csv([]), ["trace.csv"], 1, "error: the trace contains no sample\n"),
        ("", ["trace.csv"], 1, "error: the trace contains no sample\n"),
        ("health\n1\n", ["trace.csv"], 1, "error: line 1: the trace has no column for `distance(s1)`, "),
        ("health,health\n1,1\n", ["trace.csv"], 1, "error: line 1: the trace has no column for `distance(s1)`, "),
        ("health," + as_csv([FAR]), ["trace.csv"], 1, "error: line 1: two columns are called `health`\n"),
        (as_csv([FAR]) + "1\n", ["trace.csv"], 1, "error: line 3: 1 values for 5 columns\n"),
        (
            as_csv([{**FAR, "health": "x"}]),  # type: ignore[dict-item]
            ["trace.csv"],
            1,
            "error: line 2: the signal `health` is `x`, not a number\n",
        ),
        (as_csv([{**FAR, "health": math.nan}]), ["trace.csv"], 1, "error: step 1: the signal `health` is nan"),
        ('{"health": 1}\n', ["trace.csv"], 1, "error: step 1: no value for `distance(s1)`, "),
        ('{"health": 1\n', ["trace.csv"], 1, 'error: line 1: `{"health": 1` is not a JSON object'),
        (json.dumps(FAR) + "\n[]\n", ["trace.csv"], 1, "error: line 2: `[]` is not a JSON object"),
        (json.dumps(FAR) + "\n" + "[" * 100_000, ["trace.csv"], 1, "error: line 2: it nests deeper than 32 levels\n"),
        (as_csv([FAR]) + "\udcff\n", ["trace.csv"], 1, "error: line 3: it is not UTF-8, or contains a NUL\n"),
        (as_csv([FAR]) + '"1\n', ["trace.csv"], 1, "error: line 3: a quote is not closed\n"),
        (None, ["missing.csv"], 3, "error: cannot read `missing.csv`: No such file or directory\n"),
        (None, ["."], 3, "error: cannot read `.`: Is a directory\n"),
        (None, [], 2, "usage: python cover_and_hide_monitor.py [--full] TRACE.csv"),
        (None, ["--help"], 2, "usage: python cover_and_hide_monitor.py [--full] TRACE.csv"),
    ],
)
def test_the_script_reports_errors_with_a_status_and_a_message(
    tmp_path: Path, trace: str | None, arguments: list[str], status: int, message: str
) -> None:
    returncode, _, errors = run_script(tmp_path, trace, *arguments)
    assert returncode == status
    assert errors.startswith(message)
