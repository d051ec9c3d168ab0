"""The generated scripts, run by Godot 3, agree with :class:`tltlc.monitor.Monitor`, whatever the names in the spec.

The scripts for Godot 4 are parsed if gdtoolkit's ``gdparse`` is installed; they differ from the others in few lines.
"""

from __future__ import annotations

import csv
import difflib
import io
import math
import os
import random
import re
import shutil
import struct
import subprocess
from collections.abc import Sequence
from contextlib import nullcontext
from decimal import Decimal, localcontext
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.failures import ROUNDS, failure_lines, guarded
from tests.backends.monitors import Programs, Sample, batches, different, expected, one_atom, trace_of
from tests.backends.state_tables import counting, with_tables
from tests.backends.strategies import HOSTILE, hostile_automata
from tests.fixtures import cover_and_hide
from tests.monitor.strategies import PARAMS, SIGNALS, atom_traces, automata, expressions, numbers
from tests.tools.conformance.runner import Outcome
from tests.tools.conformance.runners.gdscript3 import RUNNERS
from tests.waiting import HANG_S
from tltlc import compile_text
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import emit, gdscript, gdscript3
from tltlc.backends.godot import source
from tltlc.backends.godot.names import RESERVED, snake_case
from tltlc.backends.godot.numbers import number
from tltlc.core.record import replace
from tltlc.expression.tree import Condition, Const, Expression, Op, SignalValue, When
from tltlc.logic import formula as f
from tltlc.monitor import Monitor
from tltlc.resolve import spec
from tltlc.tools.conformance.corpus import CASES

GDPARSE = os.environ.get("GDPARSE") or shutil.which("gdparse")

runs = pytest.mark.skipif(not shutil.which("godot3-server"), reason="there is no Godot 3 here")
parses = pytest.mark.skipif(not GDPARSE, reason="there is no gdparse (gdtoolkit) here: no script for Godot 4 is parsed")


def write(folder: Path, fspa: Fspa, target: str = "gdscript3") -> None:
    for name, text in emit(target, fspa).items():
        assert isinstance(text, str)
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "project.godot").touch()


def run(folder: Path, script: str, *arguments: str, stdin: bytes = b"") -> Outcome:
    """Run a script, and return its outcome without the banner of the engine."""
    command = ["godot3-server", "--path", ".", "-s", script, *arguments]
    environment = {**os.environ, "LANG": "en"}
    result = subprocess.run(command, cwd=folder, input=stdin, capture_output=True, env=environment, timeout=HANG_S)
    banner, _, out = result.stdout.decode().partition("\n \n")
    assert banner.startswith("Godot Engine v3.")
    return result.returncode, out, result.stderr.decode()


def run_monitor(folder: Path, fspa: Fspa, trace: str) -> Outcome:
    write(folder, fspa)
    (folder / "trace.csv").write_text(trace, encoding="utf-8", newline="")
    return run(folder, f"{fspa.name}_monitor_main.gd", "--full", "trace.csv")


def comparable(text: str) -> str:
    """Return the messages without the parts that may differ.

    Godot 3 writes numbers with six digits, and names cannot contain a null character.
    """
    text = re.sub(r" is -?(\d|inf|nan)[^\n]*, outside [^\n]*", " is outside", text)
    text = re.sub(r"the signal (`[^`]*`) is -?inf, not a finite number", r"no finite number for the signal \1", text)
    return text.replace("\0", "")


def check(folder: Path, *cases: tuple[Fspa, Sequence[Sample]]) -> None:
    """Run each automaton on its trace, all in one engine, and compare with the monitor."""
    programs = Programs(*RUNNERS, folder, [fspa for fspa, _ in cases])
    traces = [trace_of(samples, [signal.name for signal in fspa.signals]) for fspa, samples in cases]
    outcomes = programs.run(*enumerate(traces))
    for fspa, (_, samples), trace, outcome in zip(programs.fspas, cases, traces, outcomes, strict=True):
        expected_outcome = expected(fspa, samples)
        assert (*outcome[:2], comparable(outcome[2])) == (*expected_outcome[:2], comparable(expected_outcome[2])), trace


# --- equality -------------------------------------------------------------------------------------


@runs
@batches
@given(data=st.data())
def test_steps_agree_with_the_monitor_on_random_automata(tmp_path: Path, data: st.DataObject) -> None:
    cases = []
    for fspa in different(data, automata(), 6):
        names = [atom.name for atom in fspa.atoms]
        rows = data.draw(atom_traces(fspa, max_size=12))
        cases.append((fspa, [dict(zip(names, row, strict=True)) for row in rows]))
    check(tmp_path, *cases)


@runs
@batches
@given(data=st.data())
def test_values_of_atoms_agree_with_the_monitor(tmp_path: Path, data: st.DataObject) -> None:
    """This includes clamped values with their notices, and failures."""
    cases = []
    whole = build(spec_from_formula(f.eventually(f.and_(f.atom("a"), f.atom("b")))))
    for params in different(data, st.tuples(numbers, numbers), 14):
        fspa = replace(
            whole,
            signals=(spec.Signal(SIGNALS[0], "number", None, 2.0), spec.Signal(SIGNALS[1], "number", -3.0, None)),
            params=tuple(
                spec.Param(name, "number", value, None, None) for name, value in zip(PARAMS, params, strict=True)
            ),
            atoms=(spec.Atom("a", data.draw(expressions())), spec.Atom("b", SignalValue(SIGNALS[0]))),
        )
        rows = data.draw(st.lists(st.tuples(numbers, numbers), min_size=3, max_size=3))
        cases.append((fspa, [dict(zip(SIGNALS, row, strict=True)) for row in rows]))
    check(tmp_path, *cases)


NUMBER = spec.Signal("x", "number", None, None)
X = SignalValue("x")


@runs
def test_special_cases_agree_with_the_monitor(tmp_path: Path) -> None:
    holds = spec.Signal("open", "bool", 0.0, 1.0)
    deep: Expression = X
    for _ in range(100):
        deep = Op("*", (Const(0.5), Op("+", (Op("^", (deep, Const(2.0))), Const(0.25)))))
    crowd = [f"a{index}" for index in range(10)]
    crowded = build(spec_from_formula(f.eventually(f.atom("a0")), exclusive=[crowd, ("a1", "a2")]))
    quiet = dict.fromkeys(crowd, -1.0)
    order = f.atom("g")
    for _ in range(150):
        order = f.and_(f.atom("g"), f.next_(order))
    decided: list[tuple[Fspa, list[Sample]]] = [
        (build(spec_from_formula(formula)), [{}, {}]) for formula in (f.TRUE, f.FALSE, f.next_(f.TRUE))
    ]
    fspas: list[tuple[Fspa, list[Sample]]] = [
        *decided,
        (replace(build(spec_from_formula(f.next_(f.TRUE))), judge="limit", limit_steps=2), [{}, {}, {}]),
        (one_atom(Op("-", (SignalValue("open"), Const(0.5))), holds), [{"open": 0.0}, {"open": 1.0}]),
        (one_atom(Const(-0.5), holds), [{"open": 0.0}]),
        (one_atom(Op("/", (Const(1.0), X)), NUMBER), [{"x": 4.0}, {"x": 0.0}]),
        (one_atom(Op("sqrt", (X,)), NUMBER), [{"x": 0.25}, {"x": -0.0}, {"x": -1.0}]),
        (one_atom(Op("^", (X, Const(0.5))), NUMBER), [{"x": 0.25}, {"x": -1.0}]),
        (one_atom(Op("^", (X, Const(-1.0))), NUMBER), [{"x": 4.0}, {"x": 0.0}]),
        (one_atom(Op("exp", (X,)), NUMBER), [{"x": -1.0}, {"x": 1e4}]),
        (one_atom(Op("tanh", (Op("*", (X, X)),)), NUMBER), [{"x": 0.5}, {"x": 1e300}]),
        (one_atom(Op("*", (X, X)), NUMBER), [{"x": 0.5}, {"x": 1e300}]),
        (one_atom(X, NUMBER), [{"x": float("inf")}]),
        (
            one_atom(When(((Condition(">", (X, Const(0.0))), Op("/", (Const(1.0), X))),), Const(0.0)), NUMBER),
            [{"x": 2.0}, {"x": 0.0}],
        ),
        (crowded, [quiet, {**quiet, "a3": 1.0}, {**quiet, "a3": 0.5, "a9": 1.0, "a1": 0.1}]),
        (crowded, [{**quiet, "a1": 1.0, "a2": 1.0}]),
        (build(spec_from_formula(order)), [{"g": 0.5}] * 152),
    ]
    with recursion_room():
        fspas.append((one_atom(deep, NUMBER), [{"x": 0.5}]))
    check(tmp_path, *fspas)


# --- numbers --------------------------------------------------------------------------------------


def _values() -> list[float]:
    draw = random.Random(11)
    bits = [struct.unpack("<d", struct.pack("<Q", draw.getrandbits(62)))[0] for _ in range(150)]
    edges = [5e-324, 2.2250738585072014e-308, 2.225073858507201e-308, 1e-5, 1e-4, 0.1, 1 / 3, 1.0 - 2**-53, 2**-600]
    return [*edges, *(x if x <= 1.0 else 1.0 / x for x in bits), *(draw.random() for _ in range(50))]


@runs
def test_numbers_are_read_and_printed_exactly(tmp_path: Path) -> None:
    samples: list[Sample] = [{"x": -value} for value in _values()]
    check(tmp_path, (one_atom(X, replace(NUMBER, low=-1.0, high=0.0)), samples))


def half_way(odd: int, power: int) -> list[str]:
    """Return ``odd * 2**power``, which lies halfway between two doubles, and its nearest neighbours, as decimals."""
    with localcontext() as context:
        context.prec = 1200
        tie = format(Decimal(odd) * Decimal(2) ** power, "f")
    return [f"-{tie}", f"-{tie}00001", f"-{tie[:-1]}4999"]


@runs
def test_many_digits_and_ties_are_read_exactly(tmp_path: Path) -> None:
    """Ties next to powers of two, at odd and even doubles, and among subnormal numbers."""
    ties = [(2**54 - 1, -54), (2**54 - 3, -54), (2**53 + 1, -54), (2**53 + 3, -54), (2**54 - 1, -55), (2**54 + 2, -55)]
    ties += [(2**53 + 11, -201), (7, -1075), (9, -1075), (2**53 - 1, -1075), (2**53 + 1, -1075), (1, -1075), (3, -1075)]
    cells = [cell for tie in ties for cell in half_way(*tie)]
    # A value above 0 would reach the goal, after which no value is printed.
    cells += ["-0.1000000000000000055511151231257827021181583404541015625"]
    cells += ["-" + "9" * 40 + "e-40", "-1" + "0" * 30 + "E-31", "-2.4703282292062328e-324"]
    cells += ["-0." + "0" * 1_040_000 + "25e1040000", "-25" + "0" * 1_040_000 + "e-1040002"]
    # The last one is not finite, and ends the trace.
    cells += ["-1.7976931348623157e308", "-1.7976931348623158e308", "-1e-9999999999", "-179769313486231580793e289"]
    samples = [{"x": float(cell)} for cell in cells]
    fspa = one_atom(X, NUMBER)
    outcome = run_monitor(tmp_path, fspa, "\n".join(["x", *cells, ""]))
    expected_outcome = expected(fspa, samples)
    assert (*outcome[:2], comparable(outcome[2])) == (*expected_outcome[:2], comparable(expected_outcome[2]))


@runs
def test_literals_are_exact(tmp_path: Path) -> None:
    values = [*_values(), 1e22, 1e23, 1.7976931348623157e308, 123456789012345678.0, 1 / 30, 5 / 7, 1 / 365]
    lines = ["extends SceneTree", "func _init():"]
    lines += [f"\tprint(var2bytes({number(value)}).hex_encode())" for value in values]
    (tmp_path / "numbers.gd").write_text("\n".join([*lines, "\tquit()", ""]))
    (tmp_path / "project.godot").touch()
    _, out, _ = run(tmp_path, "numbers.gd")
    for value, text in zip(values, out.splitlines(), strict=True):
        data = bytes.fromhex(text)
        assert struct.unpack("<d" if len(data) == 12 else "<f", data[4:])[0] == value, number(value)


def test_literals_are_readable_where_possible() -> None:
    assert [number(value) for value in (20.0, 0.1, 1e-5, 2 / 13)] == ["20.0", "0.1", "1e-05", "(2.0 / 13.0)"]
    assert math.pi == eval(number(math.pi))


# --- names and texts ------------------------------------------------------------------------------

NAMES = (
    *("self", "state", "steps", "float", "class", "near", "signal", "min", "max", "Node", "Vector2", "PI", "node", "I"),
    *("sample", "script", "free", "clear", "new", "target", "best", "reward", "done", "ends", "progress", "t", "OS"),
    *("t_1", "t2_1", "INF", "NodePath", "nodePath", "Color", "match", "func", "and", "null", "bool", "_init", "values"),
    *("\x1b[31m", "a\u2028b", "[b]", "read", "value", "_read", "params"),
    *("x", "x_1", "x.1", "x(1)", "1", "a" * 300, "a,b", "#", "$x", "%s%n", "@@name@@", "\\", "tool", "yield", "await"),
    *(text for text in HOSTILE if text == text.strip()),
)


def awkward() -> Fspa:
    """Return an automaton in which each atom reads a signal of the same awkward name."""
    names = [name for name in dict.fromkeys(NAMES) if "\0" not in name]
    atoms = [f"v{index}" for index in range(len(names))]
    fspa = build(spec_from_formula(f.eventually(f.and_(*map(f.atom, atoms)))))
    return replace(
        fspa,
        signals=tuple(spec.Signal(name, "number", -1.0, 1.0, name) for name in names),
        params=tuple(spec.Param(name, "number", 0.0, None, None, name) for name in names),
        atoms=tuple(spec.Atom(name, Op("+", (SignalValue(name), Const(0.0))), name) for name in names),
    )


@runs
def test_hostile_names_stay_distinct(tmp_path: Path) -> None:
    fspa = awkward()
    names = [signal.name for signal in fspa.signals]
    samples = [{other: -0.25 if other == name else 0.5 for other in names} for name in names]
    outcome = run_monitor(tmp_path, fspa, trace_of(samples, names))
    assert outcome[:2] == expected(fspa, samples)[:2], outcome[2]
    assert [row["limiting"] for row in csv.DictReader(io.StringIO(outcome[1], newline=""))] == names


@runs
@batches
@given(data=st.data())
def test_hostile_texts_do_not_become_code(tmp_path: Path, data: st.DataObject) -> None:
    fspas = different(data, hostile_automata(), 5)
    programs = Programs(*RUNNERS, tmp_path, fspas)
    assert {status for status, _, _ in programs.run(*((number, "nothing\n1\n") for number in range(5)))} == {1}
    names = [fspa.signals[0].name for fspa in fspas]
    check(
        tmp_path,
        *(
            (fspa, [{name: value, "health": 1.0} for value in (-1.0, 0.0, 1.0)])
            for fspa, name in zip(fspas, names, strict=True)
            if name == name.strip() and "\0" not in name
        ),
    )


def test_names_with_capitals_become_snake_case() -> None:
    new_names = snake_case(["Node", "near", "isOpen", "is_open", "Sin"])
    assert new_names == {"Node": "node", "isOpen": "is_open_1", "Sin": "sin_1"}
    assert not set(new_names.values()) & RESERVED


# --- the version for Godot 4 ----------------------------------------------------------------------


WORDS = (
    ("Godot 4", "Godot 3"),
    ("extends RefCounted", "extends Reference"),
    (r"\bArray\[\w+\]", "Array"),
    (r"(?<=: )(Verdict|Problem)(?=[,)]| = )", "int"),
)
"""Words of Godot 4, and the words of Godot 3 that replace them."""


def test_the_versions_differ_only_in_keywords() -> None:
    """No test runs Godot 4, but its scripts differ from those of Godot 3 only in names of types and functions."""
    (varying,) = compile_text("clock varies\nsignal a: bool\nspec varying { keep once within 2 s a }")
    for fspa in (cover_and_hide(), awkward(), varying, *(make().fspa for make in [*CASES.values()][::8])):
        dialect_4 = replace(gdscript.DIALECT, functions=gdscript3.DIALECT.functions, swapped=frozenset())
        new, old = (
            "\n".join(map(str, source.files(fspa, dialect).values())) for dialect in (dialect_4, gdscript3.DIALECT)
        )
        for word, older in WORDS:
            new = re.sub(word, older, new)
        # The part that adapts to the engine may differ.
        new, old = (
            re.sub(r"# --- what the engine provides ---.*?# ---", "", script, flags=re.DOTALL) for script in (new, old)
        )
        new, old = (re.sub(r"^#     godot .*\n", "", script, flags=re.MULTILINE) for script in (new, old))
        differences = [line for line in difflib.ndiff(new.splitlines(), old.splitlines()) if line[0] in "+-"]
        assert not [line for line in differences if "integer_division" not in line and "\\U" not in line]


def test_only_godot_4_uses_built_in_min_and_max() -> None:
    """In Godot 4, ``minf(x, y)`` is ``x if x < y else y``."""
    fspa = one_atom(Op("min", (X, Op("max", (Const(0.5), X)))), NUMBER)
    assert "minf(maxf(x, 0.5), x)" in str(emit("gdscript", fspa)[f"{fspa.name}_monitor.gd"])
    assert "_min(x, (x if x > 0.5 else 0.5))" in str(emit("gdscript3", fspa)[f"{fspa.name}_monitor.gd"])


def check_scripts_for_godot_4(folder: Path, fspas: Sequence[Fspa]) -> None:
    """Parse the scripts of these automata, and the main programs of the first two, which are alike."""
    for fspa in fspas:
        write(folder, fspa, "gdscript")
    scripts = list(folder.glob("*_monitor.gd"))
    mains = [folder / f"{fspa.name}_monitor_main.gd" for fspa in fspas[:2]]
    result = subprocess.run([str(GDPARSE), *map(str, [*scripts, *mains])], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


@parses
def test_scripts_for_godot_4_are_parsed(tmp_path: Path) -> None:
    """These are hostile automata and every eighth case of the corpus."""
    cases = [make().fspa for make in [*CASES.values()][::8]]
    check_scripts_for_godot_4(tmp_path, [cover_and_hide(), awkward(), build(spec_from_formula(f.TRUE)), *cases])


@parses
@pytest.mark.slow
def test_all_scripts_of_the_corpus_for_godot_4_are_parsed(tmp_path: Path) -> None:
    check_scripts_for_godot_4(tmp_path, [make().fspa for make in CASES.values()])


# --- as a library ---------------------------------------------------------------------------------

LIBRARY = """extends SceneTree

const Monitor = preload("cover_and_hide_monitor.gd")


func told(monitor, taken):
	print(taken, "|", monitor.problem, "|", monitor.message())


func _init():
	var monitor = Monitor.new()
	var params = Monitor.Params.new()
	params.level_size = 1.0
	told(monitor, monitor.begin(params))
	params.level_size = NAN
	told(monitor, monitor.begin(params))
	params.level_size = 10.0
	told(monitor, monitor.begin(params))
	params.level_size = 3.0
	var sample = Monitor.Sample.new()
	for _round in range(2):
		sample.clear()
		sample.distance_s1 = 5.0
		sample.distance_s2 = 5.0
		sample.distance_exit = 5.0
		told(monitor, monitor.step(sample))
		sample.health = 2.0
		told(monitor, monitor.step(sample))
		var verdict = Monitor.Verdict.keys()[monitor.verdict]
		var bits = var2bytes(monitor.progress).hex_encode()
		print(monitor.label(), "|", monitor.limiting_atom(), "|", verdict, "|", bits)
		sample.distance_s1 = 0.5
		sample.distance_exit = 0.5
		told(monitor, monitor.step(sample))
		print(monitor.state, " ", monitor.steps)
		monitor.reset()
	for notice in monitor.notices:
		print(notice)
	quit()
"""


@runs
def test_a_host_gets_results_notices_and_errors(tmp_path: Path) -> None:
    fspa = cover_and_hide()
    write(tmp_path, fspa)
    (tmp_path / "library.gd").write_text(LIBRARY)
    step = Monitor(fspa, {"level_size": 10.0}).step(
        {"distance(s1)": 5.0, "distance(s2)": 5.0, "distance(exit)": 5.0, "health": 1.0}
    )
    together = "step 2: `near(s1)` and `near(exit)` hold at once, against `exclusive near(s1), near(s2), near(exit)`"
    rows = [
        "False|1|step 1: no finite number for the signal `health`",
        "True|0|",
        f"{step.label}|near(s1)|PENDING|03000100{struct.pack('<d', step.progress).hex()}",
        f"False|5|{together}",
        "0 1",
    ]
    wrong = "False|6|the param `level_size` cannot be 1: its range is [2, 10000]"
    notice = "step 1: the signal `health` is 2, outside [0, 1]: it counts as 1"
    status, out, err = run(tmp_path, "library.gd")
    lines = [wrong, wrong.replace("be 1", "be nan"), "True|0|", *rows, *rows, notice]
    assert (status, out.splitlines()) == (0, lines), err


FAILURES = """extends SceneTree

const Monitor = preload("guarded_monitor.gd")


func _init():
	var monitor = Monitor.new()
	var sample = Monitor.Sample.new()
	for letters in ROUNDS:
		for letter in letters:
			sample.sparse()
			# A sample that is refused changes nothing.
			print(monitor.step(sample))
			sample.health = 0.25 if letter in "hb" else 1.0
			if letter in "sb":
				sample.seen = true
			if letter == "a":
				sample.alarm = true
			monitor.step(sample)
			var failed = [monitor.failed_clause(), monitor.failed_atom(), monitor.failed_step]
			print(monitor.label_english(), "|%s|%s|%s" % failed)
			# What a game keeps of a monitor is enough to go on with another one.
			var other = Monitor.new()
			for member in ["state", "verdict", "steps", "failed_step", "failure"]:
				other.set(member, monitor.get(member))
			monitor = other
		monitor.reset()
	quit()
"""


@runs
@pytest.mark.parametrize("kept_in_tables", [False, True])
def test_a_host_learns_what_a_trace_fails_at(kept_in_tables: bool, tmp_path: Path) -> None:
    fspa = guarded()
    with with_tables() if kept_in_tables else nullcontext():
        write(tmp_path, fspa)
    assert ("_LABEL_TEXTS" in (tmp_path / "guarded_monitor.gd").read_text()) is kept_in_tables
    (tmp_path / "failures.gd").write_text(FAILURES.replace("ROUNDS", str(list(ROUNDS))))
    status, out, err = run(tmp_path, "failures.gd")
    lines = [line for step in failure_lines(fspa, no_step="0") for line in ("False", step)]
    assert (status, out.splitlines()) == (0, lines), err


@runs
def test_labels_of_counting_states_are_also_in_words(tmp_path: Path) -> None:
    fspa = counting()
    write(tmp_path, fspa)
    head = 'extends SceneTree\nfunc _init():\n\tvar kind = preload("quiet_monitor.gd")\n'
    (tmp_path / "labels.gd").write_text(
        f"{head}\tfor i in range(602):\n\t\tprint(kind.label_english_of(i))\n\tquit()\n"
    )
    status, out, err = run(tmp_path, "labels.gd")
    assert (status, out.splitlines()) == (0, [label_text(fspa, state.id) for state in fspa.states]), err


FORGOTTEN = """extends SceneTree

const Monitor = preload("guarded_monitor.gd")

var monitor = Monitor.new()


func told(sample):
	print(Monitor.Verdict.keys()[monitor.verdict] if monitor.step(sample) else monitor.message())


func _init():
	var sample = Monitor.Sample.new()
	told(sample)
	sample.seen = false
	told(sample)
	sample.health = 1.0
	told(sample)
	sample.alarm = false
	# No clause needs it, but it is a signal.
	told(sample)
	sample.open = true
	told(sample)
	sample.clear()
	sample.health = 1.0
	told(sample)
	sample.sparse()
	told(sample)
	sample.health = 1.0
	told(sample)
	sample.seen = true
	told(sample)
	quit()
"""


@runs
def test_a_forgotten_signal_is_refused_unless_it_is_a_bool_of_a_sparse_sample(tmp_path: Path) -> None:
    write(tmp_path, guarded())
    (tmp_path / "forgotten.gd").write_text(FORGOTTEN)
    first = [
        "step 1: the signal `seen` is not set",
        "step 1: no finite number for the signal `health`",
        "step 1: the signal `alarm` is not set",
        "step 1: the signal `open` is not set",
    ]
    second = ["step 2: the signal `seen` is not set", "step 2: no finite number for the signal `health`"]
    status, out, err = run(tmp_path, "forgotten.gd")
    assert (status, out.splitlines()) == (0, [*first, "HOLDING", *second, "HOLDING", "VIOLATED"]), err
