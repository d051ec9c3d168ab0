"""Monitors in C and Rust say what a trace fails at, and refuse samples in which a bool is missing."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from contextlib import nullcontext
from pathlib import Path
from typing import Final

import pytest

from tests.backends.monitors import Programs, expected, trace_of
from tests.backends.state_tables import with_tables
from tests.backends.test_c import COMPILERS, STRICT
from tests.tools.conformance.runner import runners
from tests.tools.conformance.runners.c import SANITIZED
from tests.waiting import HANG_S
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import emit
from tltlc.monitor import Monitor

SPEC: Final = """
signal health: ratio
signal open: bool
signal key: bool
spec s {
    keep open implies once key
    avoid health <= 0
}
"""
C: Final = r"""
#include "s_monitor.h"

static const char *shown(const char *text) {
    return text ? text : "-";
}

static void take(s_monitor *monitor, s_signals sample) {
    s_result result;
    if (!s_step(monitor, &sample, &result)) {
        char text[s_text_size];
        s_message(monitor, text, sizeof text);
        puts(text);
        return;
    }
    printf("%s|%s|", result.label, result.label_english);
    printf("%s|%s|%lld\n", shown(result.failed_clause), shown(result.failed_atom), result.failed_step);
}

int main(void) {
    s_monitor monitor;
    s_init(&monitor, NULL);
    s_signals sample = s_empty();
    take(&monitor, sample);
    sample.health = 1.0;
    take(&monitor, sample);
    sample.open = false;
    take(&monitor, sample);
    sample.key = true;
    take(&monitor, sample);

    s_monitor copy = monitor;
    sample = s_sparse();
    take(&copy, sample);
    sample.health = 0.0;
    take(&copy, sample);
    sample.health = 1.0;
    take(&copy, sample);
    take(&monitor, sample);

    s_reset(&copy);
    take(&copy, sample);
    sample.open = sample.health > 0.0;
    take(&copy, sample);
    return 0;
}
"""
RUST: Final = r"""
mod s_monitor;
use s_monitor::{Monitor, Signals};

fn take(monitor: &mut Monitor, sample: Signals) {
    match monitor.step(&sample) {
        Err(refused) => println!("{refused}"),
        Ok(step) => println!(
            "{}|{}|{}|{}|{}",
            step.label,
            step.label_english(),
            step.failed_clause.unwrap_or("-"),
            step.failed_atom.unwrap_or("-"),
            step.failed_step.map_or(0, u64::from)
        ),
    }
}

fn main() {
    let mut monitor = Monitor::new();
    let mut sample = Signals::default();
    take(&mut monitor, sample);
    sample.health = 1.0;
    take(&mut monitor, sample);
    sample.open = Some(false);
    take(&mut monitor, sample);
    sample.key = Some(true);
    take(&mut monitor, sample);

    let mut copy = monitor.clone();
    take(&mut copy, Signals::SPARSE);
    take(&mut copy, Signals { health: 0.0, ..Signals::SPARSE });
    take(&mut copy, Signals { health: 1.0, ..Signals::SPARSE });
    take(&mut monitor, Signals { health: 1.0, ..Signals::SPARSE });

    copy.reset();
    take(&mut copy, Signals { health: 1.0, ..Signals::SPARSE });
    take(&mut copy, Signals { health: 1.0, open: Some(true), ..Signals::SPARSE });
}
"""
MISSING: Final = {
    "health": "no finite number for the signal `health`",
    "open": "the signal `open` is not set",
    "key": "the signal `key` is not set",
}
EMPTY: Final = {"health": 1.0, "open": 0.0, "key": 0.0}


def rows(fspa: Fspa) -> Iterator[str]:
    """Yield what the programs above print, from :class:`tltlc.monitor.Monitor`."""
    order = [signal.name for signal in fspa.signals]
    for given in ((), ("health",), ("health", "open")):
        yield f"step 1: {MISSING[next(name for name in order if name not in given)]}"
    monitor, copy = Monitor(fspa), Monitor(fspa)
    yield row(monitor, {**EMPTY, "key": 1.0})
    copy.step({**EMPTY, "key": 1.0})
    yield f"step 2: {MISSING['health']}"
    yield row(copy, {**EMPTY, "health": 0.0})
    yield row(copy, EMPTY)
    yield row(monitor, EMPTY)
    copy.reset()
    yield row(copy, EMPTY)
    yield row(copy, {**EMPTY, "open": 1.0})


def row(monitor: Monitor, sample: dict[str, float]) -> str:
    step = monitor.step(sample)
    assert step.label_english == label_text(monitor.fspa, step.state)
    texts = (step.label, step.label_english, step.failed_clause or "-", step.failed_atom or "-", step.failed_step or 0)
    return "|".join(map(str, texts))


def spec_and_rows() -> tuple[Fspa, list[str]]:
    (fspa,) = compile_text(SPEC)
    found = list(rows(fspa))
    assert [line.split("|")[2:] for line in found if line.split("|")[-1] in "12"] == [
        *[["avoid health <= 0", "health > 0", "2"]] * 2,
        ["keep open implies once key", "once key", "2"],
    ]
    return fspa, found


def write(target: str, fspa: Fspa, folder: Path, *, tables: bool) -> None:
    with with_tables() if tables else nullcontext():
        for name, text in emit(target, fspa).items():
            (folder / name).write_text(str(text), encoding="utf-8")


def output(folder: Path, *command: str) -> list[str]:
    process = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=HANG_S)
    assert process.returncode == 0, process.stderr
    return process.stdout.splitlines()


def usable(target: str) -> None:
    if reason := next(runner for runner in runners() if runner.target == target).missing():
        pytest.skip(reason)


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("tables", [False, True])
@pytest.mark.parametrize("options", [(), ("-DTLTL_NO_REGISTERS",), ("-O2",)])
def test_a_game_in_c(compiler: str, options: tuple[str, ...], tables: bool, tmp_path: Path) -> None:
    usable("c")
    fspa, wanted = spec_and_rows()
    write("c", fspa, tmp_path, tables=tables)
    (tmp_path / "game.c").write_text(C, encoding="utf-8")
    output(tmp_path, *COMPILERS[compiler], *STRICT, *SANITIZED, *options, "game.c", "-o", "game", "-lm")
    assert output(tmp_path, "./game") == wanted


SPARSE: Final = r"""
#include "s_monitor.h"

int main(void) {
    s_monitor monitor;
    s_result result;
    s_init(&monitor, NULL);
    s_signals sample = s_empty();
    if (sample.open || sample.key || s_sparse().open) return 1;
    if (s_step(&monitor, &sample, &result)) return 2;
    char text[s_text_size];
    s_message(&monitor, text, sizeof text);
    puts(text);
    sample.health = 1.0;
    for (int step = 0; step < 3; step++) {
        sample.open = step == 2;
        if (!s_step(&monitor, &sample, &result)) return 3;
        puts(s_verdict_name(result.verdict));
    }
    return 0;
}
"""


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("option", ["-O0", "-O2", "-DTLTL_NO_REGISTERS", "-DTLTL_VERDICT_ONLY"])
def test_bools_that_are_not_set_are_false_in_a_sparse_monitor(compiler: str, option: str, tmp_path: Path) -> None:
    usable("c")
    (fspa,) = compile_text(SPEC)
    write("c", fspa, tmp_path, tables=False)
    (tmp_path / "game.c").write_text(SPARSE, encoding="utf-8")
    output(tmp_path, *COMPILERS[compiler], *STRICT, *SANITIZED, option, "-DTLTL_SPARSE", "game.c", "-o", "game", "-lm")
    assert output(tmp_path, "./game") == [f"step 1: {MISSING['health']}", "holding", "holding", "violated"]


@pytest.mark.parametrize("tables", [False, True])
def test_a_game_in_rust(tables: bool, tmp_path: Path) -> None:
    usable("rust")
    fspa, wanted = spec_and_rows()
    write("rust", fspa, tmp_path, tables=tables)
    (tmp_path / "game.rs").write_text(RUST, encoding="utf-8")
    output(tmp_path, "rustc", "--edition", "2021", "-D", "warnings", "game.rs")
    assert output(tmp_path, "./game") == wanted


VERDICT_ONLY: Final = r"""
#include "s_monitor.h"

int main(void) {
    s_monitor monitor;
    s_result result;
    s_init(&monitor, NULL);
    s_signals sample = s_empty();
    sample.health = 1.0;
    sample.open = true;
    if (s_step(&monitor, &sample, &result)) return 1;
    char text[s_text_size];
    s_message(&monitor, text, sizeof text);
    puts(text);
    sample = s_sparse();
    sample.health = 1.0;
    return s_step(&monitor, &sample, &result) && result.verdict == s_holding ? 0 : 2;
}
"""


def test_a_monitor_of_verdicts_refuses_the_same_samples(tmp_path: Path) -> None:
    usable("c")
    (fspa,) = compile_text(SPEC)
    write("c", fspa, tmp_path, tables=False)
    (tmp_path / "game.c").write_text(VERDICT_ONLY, encoding="utf-8")
    output(tmp_path, *COMPILERS["gcc"], *STRICT, "-DTLTL_VERDICT_ONLY", "game.c", "-o", "game", "-lm")
    assert output(tmp_path, "./game") == [f"step 1: {MISSING['key']}"]


@pytest.mark.parametrize("target", ["c", "rust"])
def test_specs_that_fail_at_once_or_never(target: str, tmp_path: Path) -> None:
    """A spec that no trace meets fails at step 1, without a clause; one that can always be met never fails."""
    usable(target)
    fspas = [
        compile_text(f"signal seen: bool\nspec s {{ {rule} }}\n")[0]
        for rule in ("require seen and not seen", "require eventually seen")
    ]
    runner = next(runner for runner in runners() if runner.target == target)
    programs = Programs(runner, tmp_path, fspas)
    samples = [{"seen": 0.0}, {"seen": 1.0}, {"seen": 0.0}]
    outcomes = programs.run(*((number, trace_of(samples, ["seen"])) for number in range(2)))
    for fspa, outcome in zip(programs.fspas, outcomes, strict=True):
        assert outcome == expected(fspa, samples)
    ends = [[line.rsplit(",", 3)[1:] for line in out.splitlines()[1:]] for _, out, _ in outcomes]
    assert ends == [[["", "", "1"]] * 3, [["", "", ""]] * 3]
