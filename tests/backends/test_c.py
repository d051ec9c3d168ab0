"""The generated header, compiled as C and as C++, agrees with :class:`tltlc.monitor.Monitor`, whatever the names."""

from __future__ import annotations

import csv
import io
import platform
import re
import shutil
import subprocess
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.monitors import Programs, Sample, batches, different, expected, one_atom, trace_of
from tests.backends.strategies import HOSTILE, hostile_automata
from tests.fixtures import cover_and_hide
from tests.monitor.strategies import PARAMS, SIGNALS, atom_traces, automata, expressions, numbers
from tests.tools.conformance.runners.c import CPP, RUNNERS, SANITIZED, C, link
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.record import replace
from tltlc.expression.tree import Condition, Const, Expression, Op, SignalValue, When
from tltlc.logic import formula as f
from tltlc.monitor import Monitor
from tltlc.resolve import spec
from tltlc.tools.conformance.corpus import CASES

COMPILERS = {"gcc": C, "g++": CPP}
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wfloat-conversion", "-Werror")

pytestmark = pytest.mark.skipif(not (shutil.which("gcc") and shutil.which("g++")), reason="there is no C compiler here")
compilers = pytest.mark.parametrize("compiler", COMPILERS)


def header_of(fspa: Fspa) -> str:
    ((name, text),) = emit("c", fspa).items()
    assert name == f"{fspa.name}_monitor.h"
    assert isinstance(text, str)
    assert text.isascii()
    return text


def programs_of(folder: Path, compiler: str, fspas: Sequence[Fspa]) -> Programs:
    """Build the programs of automata; only ``gcc`` adds sanitizers, which take long to compile."""
    command = (*COMPILERS[compiler], *STRICT, *(SANITIZED if compiler == "gcc" else ()))
    (runner,) = (runner for runner in RUNNERS if runner.name == ("c" if compiler == "gcc" else "c++"))
    programs = Programs(replace(runner, build_all=partial(link, command)), folder, fspas)
    assert all((folder / f"{fspa.name}_monitor.h").read_bytes().isascii() for fspa in programs.fspas)
    return programs


def compile_source(folder: Path, compiler: str, source: str, path: Path, *options: str) -> None:
    command = [*COMPILERS[compiler], *STRICT, *SANITIZED, *options, source, "-o", str(path), "-lm"]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


def check(programs: Programs, traces: Sequence[Sequence[Sample]]) -> None:
    texts = [
        trace_of(samples, [signal.name for signal in fspa.signals])
        for fspa, samples in zip(programs.fspas, traces, strict=True)
    ]
    outcomes = programs.run(*enumerate(texts))
    for fspa, samples, trace, outcome in zip(programs.fspas, traces, texts, outcomes, strict=True):
        expected_outcome = expected(fspa, samples)
        assert (*outcome[:2], comparable(outcome[2])) == (*expected_outcome[:2], comparable(expected_outcome[2])), trace


def comparable(text: str) -> str:
    """Return the messages without the parts that may differ.

    C and Python write exponents for different numbers.  If an atom has no value for two reasons, C may report either.
    """
    text = re.sub(
        r" (divides by zero|is too large to compute|takes a root or power that does not exist)", " fails", text
    )
    return re.sub(r"\d[\d.]*(e[+-]\d+)?", lambda number: repr(float(number[0])), text)


# --- equality -------------------------------------------------------------------------------------


@compilers
@batches
@given(data=st.data())
def test_steps_agree_with_the_monitor_on_random_automata(compiler: str, tmp_path: Path, data: st.DataObject) -> None:
    fspas = different(data, automata(), 8)
    traces = []
    for fspa in fspas:
        names = [atom.name for atom in fspa.atoms]
        rows = data.draw(atom_traces(fspa, max_size=12))
        traces.append([dict(zip(names, row, strict=True)) for row in rows])
    check(programs_of(tmp_path, compiler, fspas), traces)


@compilers
@batches
@given(data=st.data())
def test_values_of_atoms_agree_with_the_monitor(compiler: str, tmp_path: Path, data: st.DataObject) -> None:
    """This includes clamped values with their notices, and failures."""
    fspas, traces = [], []
    whole = build(spec_from_formula(f.eventually(f.and_(f.atom("a"), f.atom("b")))))
    for params in different(data, st.tuples(numbers, numbers), 14):
        fspas.append(
            replace(
                whole,
                signals=(spec.Signal(SIGNALS[0], "number", None, 2.0), spec.Signal(SIGNALS[1], "number", -3.0, None)),
                params=tuple(
                    spec.Param(name, "number", value, None, None) for name, value in zip(PARAMS, params, strict=True)
                ),
                atoms=(spec.Atom("a", data.draw(expressions())), spec.Atom("b", SignalValue(SIGNALS[0]))),
            )
        )
        rows = data.draw(st.lists(st.tuples(numbers, numbers), min_size=3, max_size=3))
        traces.append([dict(zip(SIGNALS, row, strict=True)) for row in rows])
    check(programs_of(tmp_path, compiler, fspas), traces)


@compilers
def test_special_cases_agree_with_the_monitor(compiler: str, tmp_path: Path) -> None:
    number, holds = spec.Signal("x", "number", None, None), spec.Signal("open", "bool", 0.0, 1.0)
    x = SignalValue("x")
    deep: Expression = x
    for _ in range(100):
        deep = Op("*", (Const(0.5), Op("+", (Op("^", (deep, Const(2.0))), Const(0.25)))))
    crowd = [f"a{index}" for index in range(10)]
    crowded = build(spec_from_formula(f.eventually(f.atom("a0")), exclusive=[crowd, ("a1", "a2")]))
    empty: list[Sample] = [{}, {}]
    quiet = dict.fromkeys(crowd, -1.0)
    fspas: list[tuple[Fspa, list[Sample]]] = [
        *[(build(spec_from_formula(formula)), empty) for formula in (f.TRUE, f.FALSE, f.next_(f.TRUE))],
        (replace(build(spec_from_formula(f.next_(f.TRUE))), judge="limit", limit_steps=2), [{}, {}, {}]),
        (one_atom(Op("-", (SignalValue("open"), Const(0.5))), holds), [{"open": 0.0}, {"open": 1.0}, {"open": 0.5}]),
        (one_atom(Const(-0.5), holds), [{"open": 0.0}]),
        (one_atom(Op("/", (Const(1.0), x)), number), [{"x": 4.0}, {"x": 0.0}]),
        (one_atom(Op("sqrt", (x,)), number), [{"x": 0.25}, {"x": -0.0}, {"x": -1.0}]),
        (one_atom(Op("^", (x, Const(0.5))), number), [{"x": 0.25}, {"x": -1.0}]),
        (one_atom(Op("^", (x, Const(-1.0))), number), [{"x": 4.0}, {"x": 0.0}]),
        (one_atom(Op("^", (x, Const(5.0))), number), [{"x": 0.5}, {"x": 1e300}]),
        (one_atom(Op("exp", (x,)), number), [{"x": -1.0}, {"x": 1e4}]),
        (one_atom(Op("tanh", (Op("*", (x, x)),)), number), [{"x": 0.5}, {"x": 1e300}]),
        (one_atom(Op("*", (x, x)), number), [{"x": 0.5}, {"x": 1e300}]),
        (one_atom(x, number), [{"x": float("inf")}]),
        (
            one_atom(When(((Condition(">", (x, Const(0.0))), Op("/", (Const(1.0), x))),), Const(0.0)), number),
            [{"x": 2.0}, {"x": 0.0}],
        ),
        (one_atom(x, replace(number, low=-1.5, high=1e14)), [{"x": -0.1}, {"x": 1e22}, {"x": -2.0}, {"x": -0.3}]),
        (crowded, [quiet, {**quiet, "a3": 1.0}, {**quiet, "a3": 0.5, "a9": 1.0, "a1": 0.1}]),
        (crowded, [{**quiet, "a1": 1.0, "a2": 1.0}]),
    ]
    with recursion_room():
        fspas.append((one_atom(deep, number), [{"x": 0.5}]))
    programs = programs_of(tmp_path, compiler, [fspa for fspa, _ in fspas])
    traces = [trace_of(samples, [signal.name for signal in fspa.signals]) for fspa, samples in fspas]
    for fspa, (_, samples), outcome in zip(programs.fspas, fspas, programs.run(*enumerate(traces)), strict=True):
        status, out, err = expected(fspa, samples)
        # The program reads cells of a file, and quotes them in its messages.
        err = err.replace("step 3: the signal `open` is 0.5, not", "line 4: the signal `open` is `0.5`, not")
        err = err.replace("the signal `x` is inf, not a finite number", "no finite number for the signal `x`")
        assert outcome == (status, out, err)


# --- names and texts ------------------------------------------------------------------------------

NAMES = (
    *("self", "state", "steps", "double", "class", "near", "far", "small", "min", "max", "interface", "I", "linux"),
    *("monitor", "sample", "result", "none", "target", "best", "reward", "done", "ends", "states", "progress", "t"),
    *("t_1", "t2_1", "y1", "index", "time", "signal", "sin", "NULL", "EOF", "errno", "and", "nullptr", "bool", "_Bool"),
    *("x", "x_1", "x.1", "x(1)", "1", "a" * 300, "??/", "what??/", "a,b", "//", "/*", "%s%n", "@@p@@", "\\"),
    *(text for text in HOSTILE if text == text.strip()),
)


@compilers
@batches
@given(data=st.data())
def test_hostile_texts_do_not_become_code(compiler: str, tmp_path: Path, data: st.DataObject) -> None:
    fspas = different(data, hostile_automata(), 6)
    programs = programs_of(tmp_path, compiler, fspas)
    # Each trace lacks the first signal of its program.
    assert {status for status, _, _ in programs.run(*((number, "nothing\n1\n") for number in range(6)))} == {1}
    for number, fspa in enumerate(programs.fspas):
        if fspa.signals[0].name.strip() and "\0" not in fspa.signals[0].name:
            samples = [{fspa.signals[0].name: value, "health": 1.0} for value in (-1.0, 0.0, 1.0)]
            trace = '"{}",health\n'.format(fspa.signals[0].name.replace('"', '""'))
            trace += "".join(f"{sample[fspa.signals[0].name]},1.0\n" for sample in samples)
            (outcome,), expected_outcome = programs.run((number, trace)), expected(fspa, samples)
            assert outcome[0] == expected_outcome[0]
            assert outcome[1] == expected_outcome[1]
            assert outcome[2] == expected_outcome[2].replace("\0", "")


@compilers
def test_hostile_names_stay_distinct(compiler: str, tmp_path: Path) -> None:
    """Each atom reads a signal of the same awkward name; in each sample a different atom must be the limiting one."""
    names = [name for name in dict.fromkeys(NAMES) if "\0" not in name]
    atoms = [f"v{index}" for index in range(len(names))]
    fspa = build(spec_from_formula(f.eventually(f.and_(*map(f.atom, atoms)))))
    fspa = replace(
        fspa,
        doc="ends in ??/",
        signals=tuple(spec.Signal(name, "number", -1.0, 1.0, name) for name in names),
        params=tuple(spec.Param(name, "number", 0.0, None, None, name) for name in names),
        atoms=tuple(spec.Atom(name, Op("+", (SignalValue(name), Const(0.0))), name) for name in names),
    )
    programs = programs_of(tmp_path, compiler, [fspa])
    samples = [{other: -0.25 if other == name else 0.5 for other in names} for name in names]
    check(programs, [samples])
    ((_, out, _),) = programs.run((0, trace_of(samples, names)))
    assert [row["limiting"] for row in csv.DictReader(io.StringIO(out, newline=""))] == names


MACROS = ("M_PI", "M_E", "MAXFLOAT", "EXIT_SUCCESS", "FD_SETSIZE", "L_tmpnam", "FP_ILOGB0", "RAND_MAX", "EDOM", "PI")


@compilers
def test_names_of_macros_are_avoided(compiler: str, tmp_path: Path) -> None:
    """The names are all macros of the headers that a monitor includes on this machine, and some of game engines."""
    includes = "".join(f"{line}\n" for line in header_of(cover_and_hide()).splitlines() if line.startswith("#include"))
    (tmp_path / "includes.h").write_text(includes)
    macros = set(MACROS)
    for standard in ("-std=gnu17", "-std=c99") if compiler == "gcc" else ("-std=gnu++17", "-std=c++17"):
        command = [*COMPILERS[compiler], standard, "-dM", "-E", "includes.h"]
        text = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stdout
        macros |= set(re.findall(r"^#define ([A-Za-z]\w*) ", text, re.MULTILINE))
    names = sorted(macros)
    fspa = replace(
        build(spec_from_formula(f.eventually(f.atom("p")))),
        name="all",
        signals=tuple(spec.Signal(name, "number", -1.0, 1.0) for name in names),
        atoms=(spec.Atom("p", Op("min", tuple(map(SignalValue, names)))),),
    )
    text = header_of(fspa)
    assert not [name for name in names if f"double {name};" in text]
    (tmp_path / "all_monitor.h").write_text(text)
    for options in ((), ("-DTLTL_MAIN",), ("-DTLTL_MAIN", "-std=gnu++17" if compiler == "g++" else "-std=gnu17")):
        compile_source(tmp_path, compiler, "all_monitor.h", tmp_path / "all", "-fsyntax-only", *options)


def test_names_of_headers_do_not_clash() -> None:
    """The name of a spec with one suffix never equals the name of another spec with another suffix."""
    fspas = (cover_and_hide(), CASES["counts"]().fspa)
    suffixes = {name for fspa in fspas for name in re.findall(r"\bZ_(\w+)", header_of(replace(fspa, name="Z")))}
    assert {"monitor", "step", "verdict_name"} <= suffixes
    for name in suffixes:
        assert not [other for other in suffixes if name.endswith(f"_{other}")], name


@compilers
def test_specs_with_similar_names_compile_together(compiler: str, tmp_path: Path) -> None:
    lines, names = ["#define TLTL_MAIN"], ("a", "a_signal", "A", "int", "_x", "a_read")
    for number, name in enumerate(names):
        (tmp_path / f"{number}.h").write_text(header_of(replace(cover_and_hide(), name=name)))
        lines += [f"#define main main{number}", f'#include "{number}.h"', f'#include "{number}.h"', "#undef main"]
    calls = [f"    main{number}(argc, argv);" for number in range(len(names))]
    lines += ["int main(int argc, char **argv) {", *calls, "    return 0;", "}", ""]
    (tmp_path / "all.c").write_text("\n".join(lines))
    compile_source(tmp_path, compiler, "all.c", tmp_path / "all")
    assert subprocess.run([str(tmp_path / "all")], stderr=subprocess.DEVNULL).returncode == 0


# --- as a library ---------------------------------------------------------------------------------

LIBRARY = r"""
#include "cover_and_hide_monitor.h"

static void told(const cover_and_hide_monitor *monitor) {
    char text[cover_and_hide_text_size], few[9];
    cover_and_hide_message(monitor, text, sizeof text);
    cover_and_hide_message(monitor, few, sizeof few);
    printf("%d|%s|%s\n", (int)monitor->problem, text, few);
}

int main(void) {
    cover_and_hide_monitor monitor;
    cover_and_hide_params params = cover_and_hide_defaults();
    params.level_size = 1.0;
    printf("%d ", cover_and_hide_init(&monitor, &params));
    told(&monitor);
    params.level_size = -HUGE_VAL;
    printf("%d ", cover_and_hide_init(&monitor, &params));
    told(&monitor);
    params.level_size = 10.0;
    printf("%d ", cover_and_hide_init(&monitor, &params));
    told(&monitor);
    cover_and_hide_signals sample = cover_and_hide_empty();
    cover_and_hide_result result;
    for (int round = 0; round < 2; round++) {
        sample.distance_s1 = sample.distance_s2 = sample.distance_exit = 5.0;
        sample.health = HUGE_VAL;
        printf("%d ", cover_and_hide_step(&monitor, &sample, &result));
        told(&monitor);
        sample.health = 2.0;
        printf("%d ", cover_and_hide_step(&monitor, &sample, &result));
        printf("%s %s %.17g\n", result.label, result.limiting, result.progress);
        sample.distance_s1 = sample.distance_exit = 0.5;
        printf("%d ", cover_and_hide_step(&monitor, &sample, &result));
        told(&monitor);
        printf("%d %d\n", monitor.state, (int)monitor.steps);
        cover_and_hide_reset(&monitor);
    }
    char text[cover_and_hide_text_size];
    for (int i = 0; i < monitor.notice_count; i++) {
        cover_and_hide_warning(&monitor.notices[i], text, sizeof text);
        printf("%s\n", text);
    }
    return 0;
}
"""


@compilers
def test_a_host_gets_results_notices_and_errors(compiler: str, tmp_path: Path) -> None:
    fspa = cover_and_hide()
    (tmp_path / "cover_and_hide_monitor.h").write_text(header_of(fspa))
    (tmp_path / "library.c").write_text(LIBRARY)
    compile_source(tmp_path, compiler, "library.c", tmp_path / "library")
    monitor = Monitor(fspa, {"level_size": 10.0})
    step = monitor.step({"distance(s1)": 5.0, "distance(s2)": 5.0, "distance(exit)": 5.0, "health": 1.0})
    together = "step 2: `near(s1)` and `near(exit)` hold at once, against `exclusive near(s1), near(s2), near(exit)`"
    rows = [
        "0 1|step 1: no finite number for the signal `health`|step 1: ",
        f"1 {step.label} near(s1) {step.progress:.17g}",
        f"0 5|{together}|step 2: ",
        "0 1",
    ]
    lines = [
        "0 6|the param `level_size` cannot be 1: its range is [2, 10000]|the para",
        "0 6|the param `level_size` cannot be -inf: its range is [2, 10000]|the para",
        "1 0||",
        *rows,
        *rows,
        "step 1: the signal `health` is 2, outside [0, 1]: it counts as 1",
    ]
    result = subprocess.run([str(tmp_path / "library")], capture_output=True, text=True, check=True)
    assert result.stdout.splitlines() == lines


@pytest.mark.skipif(platform.machine() != "x86_64", reason="asks for instructions of x86-64")
def test_products_and_sums_are_not_fused(tmp_path: Path) -> None:
    (tmp_path / "cover_and_hide_monitor.h").write_text(header_of(cover_and_hide()))
    for compiler, language in (("gcc", "c"), ("g++", "c++")):
        command = [compiler, "-x", language, "-O3", "-mfma", "-DTLTL_MAIN", "-S", "-o", "out.s"]
        command.append("cover_and_hide_monitor.h")
        subprocess.run(command, cwd=tmp_path, check=True, stderr=subprocess.DEVNULL)
        text = (tmp_path / "out.s").read_text()
        assert "mulsd" in text
        assert not re.search(r"\bvfn?m(add|sub)", text)


HOSTED = ("cover_and_hide", "exclusive_many", "by_zero", "no_root", "power_of_zero", "too_large", "names_of_code")
HOST = r"""
#include "@_monitor.h"

double judged_@(@_monitor *monitor, const @_signals *samples, int count);

double judged_@(@_monitor *monitor, const @_signals *samples, int count) {
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        @_result result;
        if (!@_step(monitor, &samples[i], &result)) continue;
        sum += result.reward + result.robustness;
        if (result.done) return sum + result.progress + result.state;
    }
    return sum;
}
"""


# Each compiler inlines differently, and so at each level. The other pairs are slow tests.
OPTIMIZED = [("gcc", "-O2"), ("g++", "-O3")]
SELDOM = [(compiler, level) for compiler in COMPILERS for level in ("-O2", "-O3", "-Os")]
SELDOM = [pair for pair in SELDOM if pair not in OPTIMIZED]


@pytest.mark.parametrize(
    ("compiler", "level"), [*OPTIMIZED, *(pytest.param(*pair, marks=pytest.mark.slow) for pair in SELDOM)]
)
def test_optimizing_compilers_give_no_warnings(compiler: str, level: str, tmp_path: Path) -> None:
    """A result is used only after a step; an optimizer that does not see this warns of uninitialized values."""
    hosts, programs = "", "#define TLTL_MAIN\n"
    for name in HOSTED:
        (tmp_path / f"{name}_monitor.h").write_text(header_of(CASES[name]().fspa))
        hosts += HOST.replace("@", name)
        programs += f'#define main main_of_{name}\n#include "{name}_monitor.h"\n#undef main\n'
    (tmp_path / "hosts.c").write_text(hosts)
    (tmp_path / "programs.c").write_text(programs)
    for source in ("hosts.c", "programs.c"):
        command = [*COMPILERS[compiler], "-Wall", "-Wextra", "-Werror", level, "-c", source, "-o", "object.o"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
