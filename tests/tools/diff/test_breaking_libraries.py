"""``tltlc breaking``: changes of predicates, params and signals of libraries."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT, tltlc  # noqa: F401
from tests.tools.diff.repository import Run, codes, write


def test_shipped_specs_equal_themselves(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(ROOT)
    for folder in ("examples", "stdlib_predicates"):
        shutil.copytree(folder, tmp_path / folder, ignore=shutil.ignore_patterns("*.csv"))
    outcome = tltlc("breaking", "examples", "stdlib_predicates", "--against", tmp_path)
    assert (outcome.status, outcome.out) == (0, "")
    assert outcome.err.endswith("0 breaking, 0 changed, 0 compatible\n")


@pytest.mark.parametrize(
    ("library", "old", "new", "expected"),
    [
        ("core", "(x - threshold) / margin, -1", "(x - threshold) / margin / 2, -1", ["warning TLT0757"]),
        ("core", "tanh((x - y) / scale)", "tanh((y - x) / scale)", ["error TLT0757"]),
        ("core", "about(x, y, tolerance)", "about(x, y, tolerance = 1)", []),
        (
            "core",
            "(x, low, high) in [-1, 1] =\n    clamp(1",
            "(x, high, low) in [-1, 1] =\n    clamp(1",
            ["error TLT0759"],
        ),
        ("stealth", "threshold: ratio = 50 %", "threshold: ratio = 60 %", ["error TLT0757"]),
        ("stealth", "1 - time / deadline", "1 - 2 * time / deadline", ["error TLT0757"]),
        ("stealth", "min(2 * crouching - 1, 2 * grounded - 1)", "2 * crouching - 1", ["error TLT0757"]),
        (
            "stealth",
            "[-1, 1] = 1 - 2 * seen",
            "[-1, 1] = min(1 - 2 * seen, 1 - 2 * visible)",
            ["error TLT0754", "error TLT0757"],
        ),
        ("stealth", "signal time: time in [0 s, inf]", "signal time: time", ["note TLT0755"]),
        ("spatial", "= 20 m", "= 20.5 m", ["warning TLT0756", "warning TLT0757"]),
        ("spatial", "param level_size", "param size", None),
        (
            "spatial",
            "param level_size: length in [2 m, 10 km]",
            "param level_size: length in [3 m, 10 km]",
            ["error TLT0756"],
        ),
        ("spatial", "tolerance: angle = 30 deg", "tolerance: angle", ["error TLT0759"]),
    ],
)
def test_a_change_of_a_shipped_library_is_reported_by_its_severity(
    library: str,
    old: str,
    new: str,
    expected: list[str] | None,
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    before = (ROOT / f"stdlib_predicates/{library}.tltl").read_text(encoding="utf-8")
    after = before.replace(old, new)
    assert after != before
    if expected is None:
        after, expected = after.replace("= level_size", "= size"), ["error TLT0756"]
    write(old__mine=before, mine=after)
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == expected


def test_changed_declarations_of_a_library_are_reported(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    base = "signal a: bool\nsignal b: bool\nsignal c: bool\nexclusive a, c\n"
    plain = "import base\nlet d = a and b\n"

    def diagnostics(old: str, new: str) -> list[tuple[str, str]]:
        write(base=base, old__base=base, old__mine=old, mine=new)
        outcome = tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")
        return [(diagnostic["severity"], diagnostic["title"]) for diagnostic in json.loads(outcome.out)["diagnostics"]]

    with_rules = f"clock 20 Hz\n{plain}exclusive a, b\n"
    assert diagnostics(plain, with_rules) == [
        ("error", "`a` and `b` are now exclusive"),
        ("error", "specs are now sampled every 0.05 s (they were sampled without a clock)"),
    ]
    assert diagnostics(with_rules, plain) == [
        ("warning", "`a` and `b` are no longer exclusive"),
        ("error", "specs are now sampled without a clock (they were sampled every 0.05 s)"),
    ]
    assert diagnostics(with_rules, with_rules.replace("a, b", "b, a").replace("20 Hz", "50 ms")) == []
    # A group that a wider group implies is not reported.
    wide = f"{plain}exclusive a, b, c\n"
    narrow = wide.replace("a, b, c", "a, b")
    assert diagnostics(narrow, wide) == [("error", "`a`, `b` and `c` are now exclusive")]
    assert diagnostics(wide, narrow) == [("warning", "`a`, `b` and `c` are no longer exclusive")]
    assert diagnostics(wide, f"{narrow}exclusive b, c\nexclusive c, a\n") == []
    # The same holds for specs.
    spec = "spec s = F (a | b | c)\n"
    assert diagnostics(wide + spec, narrow + spec) == [("warning", "`a`, `b` and `c` are no longer exclusive in `s`")]
    assert diagnostics(narrow + spec, wide + spec) == [("error", "`a`, `b` and `c` are now exclusive in `s`")]
    # A declaration that was imported is reported for the file that declares it.
    assert diagnostics(plain, "let d = true\n") == [("error", f"the signal `{name}` is gone") for name in "abc"]
    Path("old/mine.tltl").unlink()
    assert tltlc("breaking", "mine.tltl", "--against", "old").err.endswith("0 breaking, 0 changed, 0 compatible\n")


def test_a_library_exports_what_it_imports(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    own = "signal noise: ratio\nparam most: ratio = 20 %\npredicate calm in [-1, 1] = clamp(most - noise, -1, 1)\n"
    write(old__mine=f"import base\n{own}", old__base="signal far: length in [0 m, 9 m]\nlet near = far < 3 m\n")
    # Declarations that move into an imported file still exist.
    write(mine="import base\nimport moved\n", moved=own, base=Path("old/base.tltl").read_text(encoding="utf-8"))
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == []
    write(mine=own)
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == ["error TLT0759"] * 2


def test_a_predicate_that_reads_more_signals_is_reported(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    signals = "signal a: bool\nsignal b: bool\nsignal c: bool\n"
    write(old__mine=f"{signals}predicate p = 2 * a - 1\n", mine=f"{signals}predicate p = 2 * min(a, b, c) - 1\n")
    (added_signals, _) = json.loads(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json").out)[
        "diagnostics"
    ]
    assert added_signals["title"] == "the predicate `p` now reads `b` and `c`"
    assert added_signals["help"] == "have the game supply them wherever the predicate is used"
