"""``tltlc witness`` on the command line: the printed blocks pass when pasted into the file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, Outcome, inside, tltlc

__all__ = ["inside", "tltlc"]

Run = Callable[..., Outcome]


def test_two_blocks_that_pass_are_printed_by_default(tltlc: Run, inside: Path) -> None:
    outcome = tltlc("witness", EXAMPLE)
    assert (outcome.status, outcome.err) == (0, "")
    assert outcome.out.count('test "') == 2
    assert "    step not alive\n    expect violated\n" in outcome.out
    Path("pasted.tltl").write_text(EXAMPLE.read_text() + "\n" + outcome.out)
    result = tltlc("test", "pasted.tltl")
    assert result.status == 0, result.err
    assert result.out.endswith("5 passed, 0 failed\n")


def test_monitor_reads_a_cover_written_as_csv(tltlc: Run, inside: Path) -> None:
    outcome = tltlc("witness", EXAMPLE, "--cover", "--accepting", "--as", "csv", "-o", "traces")
    assert (outcome.status, outcome.out) == (0, "")
    files = sorted(Path("traces").iterdir())
    assert len(files) == outcome.err.count("wrote ") == 6
    statuses = {file.name: tltlc("monitor", EXAMPLE, file).status for file in files}
    assert statuses["cover_and_hide_accepting.csv"] == 0
    assert 1 in statuses.values()


def test_only_a_single_csv_trace_is_printed(tltlc: Run, inside: Path) -> None:
    outcome = tltlc("witness", EXAMPLE, "--rejecting", "--as", "csv")
    assert outcome.out.splitlines()[0] == "distance(s1),distance(s2),distance(exit),health"
    both = tltlc("witness", EXAMPLE, "--as", "csv")
    assert both.status == 2
    assert "-o" in both.err


def test_an_artefact_of_an_infinite_spec_has_witnesses(tltlc: Run, inside: Path) -> None:
    Path("watch.tltl").write_text(
        "signal at_post: bool\nspec watch { semantics infinite  require always eventually at_post }\n"
    )
    tltlc("compile", "watch.tltl", "-t", "json")
    outcome = tltlc("witness", "watch.fspa.json", "--accepting")
    assert outcome.out.startswith("// Step 1 repeats for ever; here it is written once.\n")
    Path("pasted.tltl").write_text(Path("watch.tltl").read_text() + outcome.out)
    assert tltlc("test", "pasted.tltl").status == 0
    csv = tltlc("witness", "watch.fspa.json", "--rejecting", "--as", "csv")
    assert csv.out == "at_post\nfalse\n"
    assert "step 1 repeats for ever" in csv.err


def test_a_spec_without_atoms_does_not_block_the_others(tltlc: Run, inside: Path) -> None:
    Path("two.tltl").write_text("signal a: bool\nspec long = X true\nspec reached = F a\n")
    outcome = tltlc("witness", "two.tltl", "--accepting")
    assert outcome.status == 1
    assert "error[TLT0742]: `long` has no atoms" in outcome.err
    assert outcome.out.startswith('test "reached: a shortest trace that is accepted" for reached {')


@pytest.mark.parametrize("options", [[], ["--cover"], ["--cover", "--as", "csv", "-o", "out"]])
def test_the_output_is_deterministic(options: list[str], tltlc: Run, inside: Path) -> None:
    assert tltlc("witness", EXAMPLE, *options).out == tltlc("witness", EXAMPLE, *options).out


def test_a_spec_without_signals_has_no_csv(tltlc: Run, inside: Path) -> None:
    Path("constant.tltl").write_text("param p in [0, 2] = 1\nspec s = F p > 1\n")
    outcome = tltlc("witness", "constant.tltl", "--as", "csv")
    assert outcome.status == 1
    assert "error[TLT0742]: `s` reads no signal, so a CSV trace of it has no columns" in outcome.err
    assert "TLT0620" not in outcome.err
    assert 'test "s: a shortest trace that is rejected"' in tltlc("witness", "constant.tltl").out


def test_the_warning_says_that_values_were_not_found_not_that_there_are_none(tltlc: Run, inside: Path) -> None:
    Path("never.tltl").write_text("signal x in [0, 1]\nspec s = F (x > 0.7 & x < 0.3)\n")
    message = tltlc("witness", "never.tltl").err
    assert "no values of the signals were found that give `x > 0.7` and `x < 0.3`" in message


@pytest.mark.parametrize("size", ["1e12", "1e150", "1e308"])
@pytest.mark.parametrize("sign", ["", "-"])
def test_values_between_very_large_thresholds_are_found(tltlc: Run, inside: Path, size: str, sign: str) -> None:
    Path("far.tltl").write_text(
        "signal x: number\n"
        f"predicate p in [-1, 1] = clamp({sign}x / {size} - 1, -1, 1)\n"
        f"predicate q in [-1, 1] = clamp({sign}x / {size} - 1.5, -1, 1)\n"
        "spec s = F (p & !q) & F (p & q)\n"
    )
    outcome = tltlc("witness", "far.tltl", "--accepting", "--as", "csv")
    assert (outcome.status, outcome.err) == (0, "")
    Path("trace.csv").write_text(outcome.out)
    assert tltlc("monitor", "far.tltl", "trace.csv").status == 0
