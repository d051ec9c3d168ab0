"""The comparison itself detects every error in a monitor's output."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.tools.conformance.runner import Runner, build_program, output_differences, run_monitor, runners
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.logic import formula as f
from tltlc.tools.conformance.expected_output import COLUMNS, ExpectedOutput, Rejection

RIGHT = ("1", "0", "pending", "false", "false", "0.10000000000000001", "0", "0.5", "a, b")
HEADER = ",".join(COLUMNS)
ROW = ",".join((*RIGHT[:-1], '"a, b"'))
REJECTED = Rejection("by zero", 2, ("a",))
MESSAGE = "error: step 2: the atom `a` divides by zero"


def differences_of(
    out: str, err: str, status: int, expected: ExpectedOutput, folder: Path, tolerance: float = 0.0
) -> list[str]:
    """Return the problems with a program that prints this output and exits with this status."""
    program = f"import sys; sys.stdout.write({out!r}); sys.stderr.write({err!r}); sys.exit({status})"
    (folder / "spec.py").write_text(program)
    runner = Runner(name="it", target="python", run=(sys.executable, "{name}.py"))
    return list(output_differences(run_monitor(runner, "spec", folder, b""), expected, tolerance))


@pytest.mark.parametrize(
    ("out", "err", "status", "tolerance", "right"),
    [
        (f"{HEADER}\n{ROW}\n", "", 0, 0.0, True),
        (f"{HEADER}\r\n{ROW}\r\n", "", 0, 0.0, True),
        (f"Engine v3\n\n{HEADER}\n{ROW}\n", "", 0, 0.0, True),
        (f"Engine v3\n\n{HEADER}\n{HEADER}\n{ROW}\n", "", 0, 0.0, False),
        (f"Engine v3\n\n{ROW}\n", "", 0, 0.0, False),
        (f"{HEADER}\n{ROW}\n".replace("0001,", "0002,"), "", 0, 0.0, False),
        (f"{HEADER}\n{ROW}\n".replace("0001,", "0002,"), "", 0, 1e-12, True),
        (f"{HEADER}\n{ROW}\n".replace("0.5", "0.50001"), "", 0, 1e-12, False),
        (f"{HEADER}\n{ROW}\n".replace("0.5", "nan"), "", 0, 1e-12, False),
        (f"{HEADER}\n{ROW}\n".replace("pending", "holding"), "", 0, 1e-12, False),
        (f"{HEADER}\n{ROW}\n{ROW}\n", "", 0, 0.0, False),
        (f"{HEADER}\n", "", 0, 0.0, False),
        (f"{ROW}\n", "", 0, 0.0, False),
        ("", "", 0, 0.0, False),
        (f"{HEADER}\n{ROW[:-7]}\n", "", 0, 0.0, False),
        (f"{HEADER}\n{ROW}\n", "", 1, 0.0, False),
        (f"{HEADER}\n{ROW}\n", "warning: one\n", 0, 0.0, False),
        (f"{HEADER}\n{ROW}\n", f"{MESSAGE}\n", 0, 0.0, False),
    ],
)
def test_wrong_rows_are_detected(
    out: str, err: str, status: int, tolerance: float, right: bool, tmp_path: Path
) -> None:
    assert (not differences_of(out, err, status, ExpectedOutput((RIGHT,), None, 0), tmp_path, tolerance)) == right


@pytest.mark.parametrize(
    ("out", "err", "status", "right"),
    [
        (f"{HEADER}\n{ROW}\n", f"warning: x\n{MESSAGE}\n", 1, True),
        (f"{HEADER}\n{ROW}\n", MESSAGE.replace("2", "3"), 1, False),
        (f"{HEADER}\n{ROW}\n", MESSAGE.replace("`a`", "`ab`"), 1, False),
        (f"{HEADER}\n{ROW}\n", "error: step 2: no", 1, False),
        (f"{HEADER}\n{ROW}\n", "", 1, False),
        (f"{HEADER}\n{ROW}\n", MESSAGE, 0, False),
        ("", MESSAGE, 1, False),
    ],
)
def test_wrong_errors_are_detected(out: str, err: str, status: int, right: bool, tmp_path: Path) -> None:
    assert (not differences_of(out, err, status, ExpectedOutput((RIGHT,), REJECTED, 0), tmp_path)) == right


def test_the_header_may_be_missing_before_a_rejected_first_sample(tmp_path: Path) -> None:
    for out in ("", f"{HEADER}\n", "Engine v3\n\n"):
        assert not differences_of(
            out, "error: no sample", 1, ExpectedOutput((), Rejection("no sample", 1), 0), tmp_path
        )


def test_runners_have_unique_names_and_report_why_they_are_skipped() -> None:
    names = [runner.name for runner in runners()]
    assert len(set(names)) == len(names)
    assert "python" in names
    absent = Runner(name="x", target="python", run=("x",), tools=("no-such-tool",))
    assert absent.missing() == "x: no-such-tool is not installed"
    assert "no target" in str(Runner(name="x", target="nothing", run=("x",)).missing())


TOGETHER = """
import sys
for name, trace in zip(sys.argv[1::2], sys.argv[2::2]):
    print("@@", trace)
    print("@@", trace, file=sys.stderr)
    print("rows of", name)
    print(open(trace).read(), file=sys.stderr)
    if open(trace).read() == "end":
        sys.exit(1)
    print("@@status", len(name), file=sys.stderr)
sys.exit(STATUS)
"""


def run_together(folder: Path, *traces: str, status: int = 0) -> list[tuple[int, str, str]]:
    """Run a program of two monitors, ``one`` and ``other``, which take turns reading the traces."""

    def build_all(folder: Path, names: Sequence[str]) -> None:
        assert names == ["one", "other"]
        (folder / "it.py").write_text(TOGETHER.replace("STATUS", str(status)))

    runner = Runner("it", "python", run=(), build_all=build_all, run_all=(sys.executable, "it.py"))
    fspas = [build(spec_from_formula(f.TRUE, name)) for name in ("one", "other")]
    runs = [(fspas[number % 2].name, trace.encode()) for number, trace in enumerate(traces)]
    return build_program(runner, fspas, folder)(runs)


def test_outcomes_of_a_joint_program_are_separated(tmp_path: Path) -> None:
    outcomes = [(3, "rows of one\n", "a\n"), (5, "rows of other\n", "b\n"), (3, "rows of one\n", "c\n")]
    assert run_together(tmp_path, "a", "b", "c") == outcomes


def test_a_joint_program_that_ends_early_is_reported_with_the_monitor(tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match=r"^it, other, 1.csv: the program ended within it: end\n"):
        run_together(tmp_path, "a", "end", "c")
    with pytest.raises(AssertionError):
        run_together(tmp_path, "a", status=1)
