"""The generated Rust agrees with :class:`tltlc.monitor.Monitor`, whatever the names; the corpus tests more."""

from __future__ import annotations

import csv
import io
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.monitors import Programs, batches, different, expected, one_atom, trace_of
from tests.backends.strategies import hostile_automata
from tests.backends.test_c import NAMES
from tests.fixtures import cover_and_hide
from tests.tools.conformance.runner import Outcome
from tests.tools.conformance.runners.rust import RUNNERS, STRICT
from tests.waiting import HANG_S
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa, Text
from tltlc.backends import emit
from tltlc.core.record import replace
from tltlc.expression.tree import Const, Op, SignalValue
from tltlc.logic import formula as f
from tltlc.monitor import Monitor
from tltlc.resolve import spec

pytestmark = pytest.mark.skipif(not shutil.which("rustc"), reason="there is no Rust compiler here")


def write_monitor(fspa: Fspa, folder: Path) -> str:
    ((name, text),) = emit("rust", fspa).items()
    assert name == f"{fspa.name}_monitor.rs"
    assert isinstance(text, str)
    (folder / name).write_text(text)
    return text


def compile_crate(folder: Path, *words: str, edition: str = "2021") -> None:
    command = ["rustc", "--edition", edition, *STRICT[2:-2], *words]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


def run_program(program: Path, *words: str, stdin: bytes = b"") -> Outcome:
    result = subprocess.run(
        [str(program), *words], input=stdin, capture_output=True, cwd=program.parent, timeout=HANG_S
    )
    return result.returncode, result.stdout.decode(), result.stderr.decode()


# --- names and texts ------------------------------------------------------------------------------


@batches
@given(data=st.data())
def test_hostile_texts_do_not_become_code(tmp_path: Path, data: st.DataObject) -> None:
    programs = Programs(*RUNNERS, tmp_path, different(data, hostile_automata(), 6))
    assert {status for status, _, _ in programs.run(*((number, "nothing\n1\n") for number in range(6)))} == {1}
    for number, fspa in enumerate(programs.fspas):
        name = fspa.signals[0].name
        if name == name.strip() and "\0" not in name:
            samples = [{name: value, "health": 1.0} for value in (-1.0, 0.0, 1.0)]
            assert programs.run((number, trace_of(samples, [name, "health"]))) == [expected(fspa, samples)]


def test_hostile_names_stay_distinct(tmp_path: Path) -> None:
    """Each atom reads a signal of the same name; the names are awkward ones, and all words of the generated file."""
    own = re.findall(r"\w+", write_monitor(cover_and_hide(), tmp_path))
    names = [name for name in dict.fromkeys([*NAMES, *own]) if "\0" not in name]
    atoms = [f"v{index}" for index in range(len(names))]
    fspa = build(spec_from_formula(f.eventually(f.and_(*map(f.atom, atoms)))))
    fspa = replace(
        fspa,
        signals=tuple(spec.Signal(name, "number", -1.0, 1.0, name) for name in names),
        params=tuple(spec.Param(name, "number", 0.0, None, None, name) for name in names),
        atoms=tuple(spec.Atom(name, Op("+", (SignalValue(name), Const(0.0))), name) for name in names),
    )
    programs = Programs(*RUNNERS, tmp_path, [fspa])
    samples = [{other: -0.25 if other == name else 0.5 for other in names} for name in names]
    ((_, out, err),) = programs.run((0, trace_of(samples, names)))
    assert [row["limiting"] for row in csv.DictReader(io.StringIO(out, newline=""))] == names, err


# --- as a library ---------------------------------------------------------------------------------

LIBRARY = r"""
mod cover_and_hide_monitor;
use cover_and_hide_monitor::{Monitor, Params, Signals};

fn tell(monitor: &mut Monitor, sample: &Signals) {
    if let Err(refused) = monitor.step(sample) {
        println!("{:?}: {refused}", refused.problem);
    }
}

fn main() {
    println!("{}", Monitor::with(Params { level_size: 1.0 }).unwrap_err());
    let mut monitor = Monitor::with(Params { level_size: 10.0 }).unwrap();
    println!("{}", monitor.params().level_size);
    for _ in 0..2 {
        let mut sample =
            Signals { distance_s1: 5.0, distance_s2: 5.0, distance_exit: 5.0, ..Signals::default() };
        tell(&mut monitor, &sample);
        sample.health = 2.0;
        let step = monitor.step(&sample).unwrap();
        println!("{} {} {:?}", step.label, step.limiting.unwrap(), step.progress);
        sample.distance_s1 = 0.5;
        sample.distance_exit = 0.5;
        tell(&mut monitor, &sample);
        println!("{} {} {}", monitor.state(), monitor.steps(), monitor.done());
        monitor.reset();
    }
    for notice in monitor.notices() {
        println!("{notice}");
    }
}
"""


def test_a_host_gets_results_notices_and_errors(tmp_path: Path) -> None:
    fspa = cover_and_hide()
    write_monitor(fspa, tmp_path)
    (tmp_path / "library.rs").write_text(LIBRARY)
    compile_crate(tmp_path, "library.rs")
    monitor = Monitor(fspa, {"level_size": 10.0})
    step = monitor.step({"distance(s1)": 5.0, "distance(s2)": 5.0, "distance(exit)": 5.0, "health": 1.0})
    together = "step 2: `near(s1)` and `near(exit)` hold at once, against `exclusive near(s1), near(s2), near(exit)`"
    rows = [
        "NotFinite: step 1: no finite number for the signal `health`",
        f"{step.label} near(s1) {step.progress!r}",
        f"Together: {together}",
        "0 1 false",
    ]
    lines = [
        "the param `level_size` cannot be 1: its range is [2, 10000]",
        "10",
        *rows,
        *rows,
        "step 1: the signal `health` is 2, outside [0, 1]: it counts as 1",
    ]
    assert run_program(tmp_path / "library") == (0, "".join(f"{line}\n" for line in lines), "")


@pytest.mark.parametrize("edition", ["2018", "2021"])
def test_a_monitor_builds_without_the_standard_library(tmp_path: Path, edition: str) -> None:
    """With and without functions that `core` lacks, in crates that deny many lints."""
    x = SignalValue("x")
    value = Op("tanh", (Op("+", (Op("sqrt", (x,)), Op("exp", (x,)), Op("^", (x, Const(0.3))))),))
    write_monitor(replace(one_atom(value, spec.Signal("x", "number", None, None)), name="much"), tmp_path)
    assert "It needs `core` alone." in write_monitor(cover_and_hide(), tmp_path)
    lines = ["//! A crate.", "#![no_std]", "#![deny(missing_docs, rust_2018_idioms, unreachable_pub)]"]
    lines += ["pub mod cover_and_hide_monitor;", "pub mod much_monitor;", "mod tltl_math {"]
    lines += [f"    pub(crate) fn {name}(x: f64) -> f64 {{ x }}" for name in ("sqrt", "exp", "tanh")]
    lines += ["    pub(crate) fn pow(x: f64, _: f64) -> f64 { x }", "}", ""]
    (tmp_path / "bare.rs").write_text("\n".join(lines))
    compile_crate(tmp_path, "--crate-type", "lib", "--cfg", "tltl_no_std", "bare.rs", edition=edition)
    assert (tmp_path / "libbare.rlib").stat().st_size > 0


def test_a_monitor_that_reads_no_signal_compiles(tmp_path: Path) -> None:
    fspa = one_atom(Const(0.5), spec.Signal("open", "bool", 0.0, 1.0))
    fspa = replace(fspa, name="blind", atoms=(replace(fspa.atoms[0], doc="Of each sample.  The same."),))
    write_monitor(fspa, tmp_path)
    (tmp_path / "alone.rs").write_text("pub mod blind_monitor;\n")
    compile_crate(tmp_path, "--crate-type", "lib", "--emit", "metadata", "alone.rs")
    assert (tmp_path / "libalone.rmeta").stat().st_size > 0


@pytest.mark.skipif(not shutil.which("rustdoc"), reason="there is no rustdoc here")
@pytest.mark.parametrize("text", ["~~~ " + "x " * 60, "``` " + "x " * 60, "```", "~~~", "<script>alert(1)</script>"])
def test_documentation_is_no_code(tmp_path: Path, text: str) -> None:
    """Code in the documentation would run in the doctests of a host crate, and HTML in the browser."""
    fspa = cover_and_hide()
    fspa = replace(
        fspa,
        doc=text,
        formula=Text(text, text, text),
        signals=tuple(replace(signal, doc=text) for signal in fspa.signals),
    )
    write_monitor(fspa, tmp_path)
    (tmp_path / "host.rs").write_text("pub mod cover_and_hide_monitor;\n")
    words = ["rustdoc", "--edition", "2021", "--crate-name", "host", "host.rs"]
    result = subprocess.run([*words, "--test"], cwd=tmp_path, capture_output=True, text=True)
    assert (result.returncode, "running 0 tests" in result.stdout) == (0, True), result.stdout
    result = subprocess.run([*words, "-D", "warnings"], cwd=tmp_path, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    pages = [page.read_text() for page in (tmp_path / "doc" / "host" / "cover_and_hide_monitor").rglob("*.html")]
    assert pages
    assert not any("<script>alert" in page for page in pages)


# --- as a program ---------------------------------------------------------------------------------


def test_the_program_builds_in_any_edition(tmp_path: Path) -> None:
    """The program uses every function that `core` lacks."""
    x = SignalValue("x")
    value = Op("tanh", (Op("+", (Op("sqrt", (x,)), Op("exp", (x,)), Op("^", (x, Const(0.3))))),))
    fspa = one_atom(value, spec.Signal("x", "number", None, None))
    write_monitor(fspa, tmp_path)
    for edition in ("2015", "2018", "2021"):
        compile_crate(tmp_path, "--cfg", "tltl_main", "--emit", "metadata", f"{fspa.name}_monitor.rs", edition=edition)
        library = tmp_path / f"lib{fspa.name}_monitor.rmeta"
        assert library.exists()
        library.unlink()


NUMBERS = r"""
mod cover_and_hide_monitor;

fn main() {
    for line in std::io::stdin().lines() {
        let value: f64 = line.unwrap().parse().unwrap();
        println!("{}", cover_and_hide_monitor::program::general(value));
    }
}
"""


def test_decimals_agree_with_c(tmp_path: Path) -> None:
    """Ties in the last digit, and powers of two and ten."""
    values = [0.5**power for power in range(0, 1075, 7)] + [10.0**power for power in range(-323, 309)]
    values += [(2 * odd + 1) / 2.0**power for power in range(1, 60) for odd in (3, 5461, 131071, 200003)]
    values += [-numerator / 97 for numerator in range(98)] + [5e-324, 0.0, -0.0]
    write_monitor(cover_and_hide(), tmp_path)
    (tmp_path / "numbers.rs").write_text(NUMBERS)
    compile_crate(tmp_path, "--cfg", "tltl_main", "numbers.rs")
    status, out, err = run_program(tmp_path / "numbers", stdin="".join(f"{value!r}\n" for value in values).encode())
    assert (status, err) == (0, "")
    assert out.splitlines() == [f"{value:.17g}" for value in values]
