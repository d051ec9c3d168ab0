"""The generated module agrees with :class:`tltlc.monitor.Monitor`, whatever the names; the corpus tests more."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings

from tests.backends.failures import guarded
from tests.backends.monitors import FAR
from tests.backends.strategies import HOSTILE, hostile_automata
from tests.fixtures import cover_and_hide
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.record import replace
from tltlc.expression.tree import Const, Op, SignalValue
from tltlc.logic import formula as f
from tltlc.monitor import Monitor
from tltlc.resolve import spec
from tltlc.tools.conformance.corpus import CASES
from tltlc.tools.conformance.expected_output import COLUMNS

TSC = os.environ.get("TSC") or shutil.which("tsc")
ESBUILD = os.environ.get("ESBUILD") or shutil.which("esbuild")

pytestmark = pytest.mark.skipif(shutil.which("node") is None, reason="there is no node here")

NAMES = (
    *("this", "state", "steps", "class", "await", "arguments", "let", "undefined", "NaN", "constructor", "__proto__"),
    *("toString", "signals", "result", "target", "best", "entered", "min", "max", "STATES", "Math", "t_1", "nearest"),
    *("\x1b[31m", "a\u2028b", "entered", "hasOwnProperty", "process"),
    *("x", "x_1", "x.1", "x(1)", "1", "a" * 300, "a,b", "//", "/*", "${1}", "@@step@@", "\\", "`"),
    *(text for text in HOSTILE if text == text.strip() and "\0" not in text and "\ufeff" not in text),
)

Outcome = tuple[int, str, str]
"""Exit status, standard output, standard error."""


def write_module(fspa: Fspa, folder: Path) -> Path:
    """Write the module and its types, and return the path of the module."""
    files = emit("javascript", fspa)
    assert list(files) == [f"{fspa.name}_monitor.mjs", f"{fspa.name}_monitor.d.mts"]
    for name, text in files.items():
        assert isinstance(text, str)
        (folder / name).write_text(text)
    return folder / f"{fspa.name}_monitor.mjs"


def run_module(module: Path, *arguments: str, stdin: bytes = b"") -> Outcome:
    result = subprocess.run(["node", module.name, *arguments], input=stdin, capture_output=True, cwd=module.parent)
    return result.returncode, result.stdout.decode(), result.stderr.decode()


def trace_of(samples: Sequence[Mapping[str, float]]) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, quoting=csv.QUOTE_ALL)
    writer.writerow(samples[0])
    writer.writerows(sample.values() for sample in samples)
    return text.getvalue().encode()


def rows(fspa: Fspa, samples: Sequence[Mapping[str, float]]) -> list[list[str]]:
    """Return the rows that the program must print with ``--full``, without the header."""
    monitor, rows_ = Monitor(fspa), []
    for number, sample in enumerate(samples, start=1):
        step = monitor.step(sample)
        flags = [str(flag).lower() for flag in (step.accepting, step.done)]
        figures = [f"{value:.17g}" for value in (step.progress, step.reward, step.robustness)]
        failed = (step.failed_clause or "", step.failed_atom or "", str(step.failed_step or ""))
        rows_.append([str(number), str(step.state), step.verdict, *flags, *figures, step.limiting or "", *failed])
    return rows_


def printed_rows(out: str) -> list[list[str]]:
    header, *rows_ = csv.reader(io.StringIO(out, newline=""), strict=True)
    assert header == [*COLUMNS]
    return rows_


# --- names and texts ------------------------------------------------------------------------------


@settings(
    max_examples=8,
    deadline=None,
    derandomize=True,
    phases=(Phase.generate,),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
@given(fspa=hostile_automata())
def test_hostile_texts_do_not_become_code(tmp_path: Path, fspa: Fspa) -> None:
    assume("\0" not in fspa.signals[0].name)
    samples = [{fspa.signals[0].name: value, "health": 1.0} for value in (-1.0, 0.0, -0.5)]
    status, out, err = run_module(write_module(fspa, tmp_path), "--full", "-", stdin=trace_of(samples))
    assert (status, err) == (0, "")
    assert printed_rows(out) == rows(fspa, samples)


def test_hostile_names_stay_distinct(tmp_path: Path) -> None:
    """Each atom reads a signal of the same awkward name; in each sample a different atom must be the limiting one."""
    fspa, samples = awkward(NAMES)
    status, out, err = run_module(write_module(fspa, tmp_path), "--full", "-", stdin=trace_of(samples))
    assert (status, err) == (0, "")
    assert printed_rows(out) == rows(fspa, samples)
    assert [row[8] for row in printed_rows(out)] == [*samples[0]]


def awkward(all_names: Sequence[str]) -> tuple[Fspa, list[dict[str, float]]]:
    """Return an automaton whose signals, params and atoms have these names; each sample makes another atom false."""
    names = list(dict.fromkeys(all_names))
    fspa = build(spec_from_formula(f.eventually(f.and_(*(f.atom(f"v{index}") for index in range(len(names)))))))
    fspa = replace(
        fspa,
        doc="*/ ends in \\",
        signals=tuple(spec.Signal(name, "number", -1.0, 1.0, name) for name in names),
        params=tuple(spec.Param(name, "number", 0.0, None, None, name) for name in names),
        atoms=tuple(spec.Atom(name, Op("+", (SignalValue(name), Const(0.0))), name) for name in names),
    )
    return fspa, [{other: -0.25 if other == name else 0.5 for other in names} for name in names]


def test_docs_cannot_close_a_comment_of_the_types(tmp_path: Path) -> None:
    fspa = cover_and_hide()
    signals = (*fspa.signals[:3], replace(fspa.signals[3], doc="*/ export const x = 1; /*"))
    text = write_module(replace(fspa, signals=signals), tmp_path).with_suffix(".d.mts").read_text()
    assert "/** * / export const x = 1; /* A ratio in [0, 1]. */\n  health: number;" in text


# --- numbers --------------------------------------------------------------------------------------


def test_numbers_are_printed_as_c_prints_them(tmp_path: Path) -> None:
    """The robustness of an edge equals the signal to the last digit; ties are rounded to even."""
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    fspa = replace(fspa, signals=(spec.Signal("x", "number", -1.0, 1.0),), atoms=(spec.Atom("p", SignalValue("x")),))
    values = [sign * (1 + 2 * odd) * 2.0**-power for power in range(64) for odd in range(9) for sign in (1, -1)]
    values += [math.sin(number) * 10.0**-power for power in (0, 3, 5, 9, 99, 310) for number in range(60)]
    samples = [{"x": value} for value in values if abs(value) <= 1]
    status, out, _ = run_module(write_module(fspa, tmp_path), "--full", "-", stdin=trace_of(samples))
    assert status == 0
    assert printed_rows(out) == rows(fspa, samples)


# --- as a module ----------------------------------------------------------------------------------

USE = """
import { Monitor, MonitorError, Result } from "./cover_and_hide_monitor.mjs";

function told(action) {
  try {
    return action();
  } catch (error) {
    console.log(error instanceof MonitorError, error.name, error.message);
  }
}

told(() => new Monitor({ level_size: 1 }));
told(() => new Monitor({ level_size: NaN }));
told(() => new Monitor({ level_size: "10" }));
told(() => new Monitor({ size: 1 }));
new Monitor({ level_size: undefined });
const monitor = new Monitor({ level_size: 10 });
const result = new Result();
const far = { "distance(s1)": 5, "distance(s2)": 5, "distance(exit)": 5, health: true, unused: "-" };
for (const round of [1, 2]) {
  told(() => monitor.step({ health: 1, "distance(s2)": 5 }, result));
  told(() => monitor.step({ ...far, health: NaN }, result));
  told(() => monitor.step({ ...far, health: "1" }, result));
  console.log(monitor.step({ ...far, health: 2 }, result) === result, result.progress, result.limiting);
  told(() => monitor.step({ ...far, "distance(s1)": 0.5, "distance(exit)": 0.5 }, result));
  console.log(monitor.state, monitor.steps, result.label, monitor.step(far) === result);
  monitor.reset();
}
console.log(monitor.steps, monitor.notices.join());
"""


def test_a_host_gets_results_notices_and_errors(tmp_path: Path) -> None:
    fspa = cover_and_hide()
    write_module(fspa, tmp_path)
    (tmp_path / "use.mjs").write_text(USE)
    step = Monitor(fspa, {"level_size": 10.0}).step({**dict.fromkeys(FAR, 5.0), "health": 1.0})
    group = "near(s1), near(s2), near(exit)"
    lines = [
        "true MonitorError the param `level_size` cannot be 1: its range is [2, 10000]",
        "true MonitorError the param `level_size` cannot be nan",
        "true MonitorError the value given for the param `level_size` is not a number",
        "true MonitorError there is no param `size` to set",
        *[
            "true MonitorError step 1: no value for `distance(s1)` and `distance(exit)`",
            "true MonitorError step 1: the signal `health` is nan, not a finite number",
            "true MonitorError step 1: the signal `health` is not a number",
            f"true {step.progress!r} near(s1)",
            f"true MonitorError step 2: `near(s1)` and `near(exit)` hold at once, against `exclusive {group}`",
            f"0 1 {step.label} false",
        ]
        * 2,
        "0 step 1: the signal `health` is 2, outside [0, 1]: it counts as 1",
    ]
    status, out, err = run_module(tmp_path / "use.mjs")
    assert (status, err) == (0, "")
    assert out.splitlines() == lines


def test_a_boolean_is_a_bool_and_a_number(tmp_path: Path) -> None:
    """As in Python, true counts as 1; no other type is accepted as a number."""
    expression = Op("-", (Op("*", (SignalValue("x"), SignalValue("seen"))), Const(0.5)))
    fspa = build(spec_from_formula(f.eventually(f.atom("p"))))
    signals = (spec.Signal("x", "number", None, None), spec.Signal("seen", "bool", 0.0, 1.0))
    write_module(replace(fspa, signals=signals, atoms=(spec.Atom("p", expression),)), tmp_path)
    (tmp_path / "use.mjs").write_text(f"""
import {{ Monitor }} from "./{fspa.name}_monitor.mjs";
for (const [x, seen] of [[1, true], [true, 1], [1, false], [1, 0.5], ["1", 1], [null, 1], [1, [1]], [1n, 1]]) {{
  try {{
    console.log(new Monitor().step({{ x, seen }}).robustness);
  }} catch (error) {{
    console.log(error.message);
  }}
}}
""")
    _, out, err = run_module(tmp_path / "use.mjs")
    problems = ["seen` is 0.5, not true or false", "x` is not a number", "x` is not a number", "seen` is not a number"]
    messages = [f"step 1: the signal `{message}" for message in [*problems, "x` is not a number"]]
    assert out.splitlines() == ["0.5", "0.5", "0.5", *messages], err


# --- for TypeScript -------------------------------------------------------------------------------

TYPED_USE = """
import { Monitor, MonitorError, Result, type Params, type Signals, type Verdict } from "./cover_and_hide_monitor.mjs";

const monitor = new Monitor({ level_size: 10 });
const result = new Result();
const sample: Signals = { "distance(s1)": 5, "distance(s2)": 5, "distance(exit)": 5, health: 1 };
const same: Result = monitor.step(sample, result);
const verdict: Verdict = same.verdict;
const limiting: string | null = same.limiting;
const params: Params = { level_size: 10 };
monitor.reset();
// @ts-expect-error: there is no such param.
new Monitor({ size: 1 });
// @ts-expect-error: it is no number.
new Monitor({ level_size: "10" });
// @ts-expect-error: signals are missing.
monitor.step({ health: 1 });
// @ts-expect-error: there is no such signal.
monitor.step({ ...sample, wealth: 1 });
// @ts-expect-error: it is for the monitor to change.
monitor.state = 1;
// @ts-expect-error: it may be null.
const name: string = same.limiting;
// @ts-expect-error: a verdict is one of four.
if (verdict === "unknown") throw new MonitorError("never");
const failed: [string, string | null, string | null, number | null] =
  [same.label_english, same.failed_clause, same.failed_atom, same.failed_step];
export { failed, limiting, name, params };
"""

SPARSE_TYPED_USE = """
import { Monitor, type SparseSignals } from "./guarded_monitor.mjs";

const monitor = new Monitor<SparseSignals>({}, { sparse: true });
monitor.step({ health: 1 });
// @ts-expect-error: numbers are needed.
monitor.step({ seen: true });
// @ts-expect-error: all bools are needed.
new Monitor().step({ health: 1 });
// @ts-expect-error: there is no such option.
new Monitor({}, { spare: true });
"""

PLAIN_USE = """
import { Monitor } from "./again_monitor.mjs";

new Monitor({}).step({ seen: true });
// @ts-expect-error: there are no params.
new Monitor({ size: 1 });
"""

types = pytest.mark.skipif(not TSC, reason="there is no TypeScript compiler (tsc) here: types are not checked")


def type_errors(folder: Path, files: Sequence[str], **options: object) -> str:
    """Return the messages of the TypeScript compiler for the files."""
    strict = {"strict": True, "noEmit": True, "target": "es2022", "lib": ["es2022"], "types": []}
    # The declarations of the language itself need no check.
    strict |= {"skipDefaultLibCheck": True}
    (folder / "tsconfig.json").write_text(json.dumps({"compilerOptions": strict | options, "files": files}))
    return subprocess.run([str(TSC), "-p", "."], cwd=folder, capture_output=True, text=True).stdout


@types
@pytest.mark.parametrize(("module", "resolution"), [("nodenext", "nodenext"), ("esnext", "bundler")])
def test_types_are_found_and_correct(tmp_path: Path, module: str, resolution: str) -> None:
    write_module(cover_and_hide(), tmp_path)
    write_module(build(spec_from_formula(f.TRUE, "again")), tmp_path)
    (tmp_path / "use.mts").write_text(TYPED_USE)
    write_module(guarded(), tmp_path)
    (tmp_path / "plain.mts").write_text(PLAIN_USE)
    (tmp_path / "sparse.mts").write_text(SPARSE_TYPED_USE)
    assert (
        type_errors(tmp_path, ["use.mts", "plain.mts", "sparse.mts"], module=module, moduleResolution=resolution) == ""
    )


@types
def test_the_code_passes_the_type_checker(tmp_path: Path) -> None:
    """Some modules of the corpus, and hostile ones; untyped parameters of helpers count as ``any``."""
    fspas = [*(make().fspa for make in [*CASES.values()][::5]), awkward(NAMES)[0], guarded()]
    fspas += [build(spec_from_formula(f.TRUE)), build(spec_from_formula(f.FALSE, "never"))]
    modules = [write_module(fspa, tmp_path).name for fspa in fspas]
    (tmp_path / "node.d.ts").write_text("declare const process: any;\n")
    messages = type_errors(
        tmp_path,
        ["node.d.ts", *modules],
        module="nodenext",
        lib=["es2022", "dom"],
        allowJs=True,
        checkJs=True,
        noImplicitAny=False,
        useUnknownInCatchVariables=False,
        noUnusedLocals=True,
        noImplicitReturns=True,
        noFallthroughCasesInSwitch=True,
    )
    assert messages == ""


# --- for bundlers ---------------------------------------------------------------------------------

BUNDLED_USE = """
import { Monitor } from "./cover_and_hide_monitor.mjs";
const far = { "distance(s1)": 5, "distance(s2)": 5, "distance(exit)": 5, health: 1 };
console.log(new Monitor().step(far).verdict);
"""


@pytest.mark.skipif(not ESBUILD, reason="there is no bundler (esbuild) here: no module is bundled")
@pytest.mark.parametrize("platform", ["browser", "node"])
@pytest.mark.parametrize("layout", ["esm", "iife", "cjs"])
def test_bundlers_accept_the_module(tmp_path: Path, platform: str, layout: str) -> None:
    """Bundling gives no error or warning, and the bundle does not run the monitor's own program."""
    write_module(cover_and_hide(), tmp_path)
    (tmp_path / "use.mjs").write_text(BUNDLED_USE)
    bundle = "use.bundle." + ("mjs" if layout == "esm" else "cjs")
    options = ["--bundle", f"--format={layout}", f"--platform={platform}", "--target=es2022", f"--outfile={bundle}"]
    command = [str(ESBUILD), "use.mjs", *options, "--log-level=warning"]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (result.returncode, result.stderr) == (0, "")
    assert run_module(tmp_path / bundle) == (0, "pending\n", "")


def test_the_module_imports_nothing() -> None:
    """A bundler for browsers would fail to resolve Node's modules."""
    text = emit("javascript", cover_and_hide())["cover_and_hide_monitor.mjs"]
    assert isinstance(text, str)
    code = re.sub(r"^//.*|/\*.*?\*/", "", text, flags=re.MULTILINE | re.DOTALL)
    assert not re.search(r"\bimport\b|require\(|^(if )?\(?await ", code, re.MULTILINE)
