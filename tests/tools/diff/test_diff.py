"""The output of ``tltlc diff`` as text, in the golden files ``golden/NAME``, and as JSON.

``UPDATE_GOLDEN=1`` rewrites the golden files.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
from collections.abc import Callable
from pathlib import Path

import jsonschema
import pytest
from hypothesis import given

from tests.calls import calls
from tests.fuzzing import times
from tests.interfaces.cli.conftest import ROOT, Outcome, inside, tltlc  # noqa: F401
from tests.logic.strategies import formulas
from tltlc import TltlError, compile_text
from tltlc.core.source import SourceFile
from tltlc.io.spec_file import STDIN_NAME
from tltlc.logic.formula import Formula
from tltlc.logic.text.notation import ASCII, write
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import compile_source
from tltlc.tools.diff.diff_json import document
from tltlc.tools.diff.pairs import FileDiff, diff, diff_files
from tltlc.tools.diff.text import text
from tltlc.tools.diff.traces import difference_test, trace_description

GOLDEN = Path(__file__).parent / "golden"
CASES = sorted(path for path in GOLDEN.iterdir() if path.is_dir())
SCHEMA = json.loads((ROOT / "tltlc/tools/diff/diff.schema.json").read_text(encoding="utf-8"))
SMALL = formulas(atoms=("a", "b"), max_leaves=4)
Run = Callable[..., Outcome]


def arguments(case: Path) -> list[str]:
    return shlex.split((case / "cmd").read_text(encoding="utf-8"))


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[Path], None]:
    def into(case: Path) -> None:
        shutil.copytree(case, tmp_path / "case")
        monkeypatch.chdir(tmp_path / "case")

    return into


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_text_matches_the_golden_file(case: Path, copy, tltlc: Run) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    copy(case)
    outcome = tltlc(*arguments(case))
    expected = case / "expected.txt"
    if os.environ.get("UPDATE_GOLDEN") == "1":
        expected.write_text(outcome.out, encoding="utf-8")
    assert outcome.out == expected.read_text(encoding="utf-8")
    assert outcome.err == ""
    assert outcome.status == (0 if case.name in ("equivalent", "no_specs") else 1)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_document_fits_the_schema(case: Path, copy, tltlc: Run) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    copy(case)
    outcome = tltlc(*arguments(case), "--format", "json")
    document = json.loads(outcome.out)
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.validate(document, SCHEMA)
    assert document["same"] == (outcome.status == 0)
    for spec in document["specs"]:
        if spec["relation"] is not None:
            sides = spec["only_a"] is not None, spec["only_b"] is not None
            relations = {
                (False, False): "equivalent",
                (True, False): "stricter",
                (False, True): "looser",
                (True, True): "incomparable",
            }
            assert spec["relation"] == relations[sides]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_printed_tests_pass(case: Path, copy, tltlc: Run) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    copy(case)
    out = tltlc(*arguments(case)).out
    blocks = re.findall(r"as a test of ([AB]):\n\n(    test .*?^    })$", out, re.DOTALL | re.MULTILINE)
    for side, test in blocks:
        file = Path(arguments(case)["AB".index(side) + 1].partition(":")[0])
        pasted = Path("pasted.tltl")
        pasted.write_text(f"{file.read_text(encoding='utf-8')}\n{test}\n", encoding="utf-8")
        assert tltlc("test", pasted).out.splitlines()[-1] == "1 passed, 0 failed"


@times(40)
@given(SMALL, SMALL)
def test_a_printed_test_passes_for_one_spec_and_fails_for_the_other(first: Formula, second: Formula) -> None:
    texts = [f"signal a: bool  signal b: bool  spec s = {write(formula, ASCII)}\n" for formula in (first, second)]
    (a,), (b,) = map(compile_text, texts)
    pair = diff(a, b)
    for trace in (pair.comparison.only_a, pair.comparison.only_b):
        if trace is None:
            continue
        test = difference_test(pair, trace_description(pair, trace), "a difference")
        if test is None:
            assert not a.atoms and not b.atoms
            continue
        side, lines = test
        results = []
        for source in texts if side == "A" else texts[::-1]:
            try:
                compiled = compile_source(SourceFile("pasted", source + lines))
            except TltlError:
                # The trace has an atom that this spec does not have.
                continue
            results += [result.passed for result in run_tests(compiled.program, compiled.automata)]
        assert results[0] is True
        if {atom.name for atom in a.atoms} == {atom.name for atom in b.atoms}:
            assert results == [True, False]


@times(25)
@given(SMALL, SMALL)
def test_every_document_fits_the_schema(first: Formula, second: Formula) -> None:
    for clause in ("", "semantics infinite "):
        a, b = (
            compile_text(f"signal a: bool  signal b: bool  spec s {{ {clause}require {write(formula, ASCII)} }}")
            for formula in (first, second)
        )
        file_diff = diff_files(("a", a), ("b", b))
        jsonschema.validate(document(file_diff), SCHEMA)
        assert text(file_diff).startswith("A is a\nB is b\n")


def test_an_artefact_equals_its_source(tltlc: Run, inside: Path) -> None:  # noqa: F811
    assert tltlc("compile", "hide.tltl", "-t", "json").status == 0
    outcome = tltlc("diff", "hide.fspa.json", "hide.tltl")
    assert (outcome.status, outcome.err) == (0, "")
    assert "B accepts the same traces as A, and nothing else differs" in outcome.out


def test_the_summary_agrees_with_the_status_if_traces_are_left_out(tltlc: Run, inside: Path) -> None:  # noqa: F811
    spec = "signal x in [0, 10]\nspec s {\n    avoid x > 8\n"
    Path("a.tltl").write_text(f"{spec}}}\n")
    Path("b.tltl").write_text(f"{spec}    avoid x > 9\n}}\n")
    outcome = tltlc("diff", "a.tltl", "b.tltl")
    assert outcome.status == 1
    assert "B accepts the same traces as A, except perhaps for the traces that are left out.\n" in outcome.out
    assert "nothing else differs" not in outcome.out


def test_exclusive_groups_declared_on_both_sides_restrict_the_traces(tltlc: Run, inside: Path) -> None:  # noqa: F811
    signals = "signal a: bool\nsignal b: bool\nsignal c: bool\n"
    Path("old.tltl").write_text(f"{signals}exclusive a, b, c\nspec s = b\n", encoding="utf-8")
    Path("new.tltl").write_text(f"{signals}exclusive a, b\nspec s = !a\n", encoding="utf-8")
    Path("free.tltl").write_text(f"{signals}exclusive a, c\nspec s = !a\n", encoding="utf-8")

    def relation_and_counterexample(old: str, new: str) -> tuple[str, list[list[str]] | None]:
        (spec,) = json.loads(tltlc("diff", old, new, "--format", "json").out)["specs"]
        return spec["relation"], spec["only_a"]

    assert relation_and_counterexample("old.tltl", "new.tltl") == ("looser", None)
    assert relation_and_counterexample("old.tltl", "free.tltl") == ("incomparable", [["b", "a"]])


def test_exclusive_groups_of_a_source_apply_to_an_artefact(tltlc: Run, inside: Path) -> None:  # noqa: F811
    signals = "signal a: bool\nsignal b: bool\nsignal x in [0, 9]\n"

    def compare_both_ways(spec: str, source: str) -> list[dict[str, object]]:
        """Compare the artefact of the spec with the source, and the source with the artefact."""
        Path("of.tltl").write_text(spec, encoding="utf-8")
        Path("new.tltl").write_text(source, encoding="utf-8")
        assert tltlc("compile", "of.tltl", "-t", "json").status == 0
        sides = ("s.fspa.json", "new.tltl"), ("new.tltl", "s.fspa.json")
        return [json.loads(tltlc("diff", *pair, "--format", "json").out)["specs"][0] for pair in sides]

    exclusive = f"{signals}exclusive a, b\nspec s = !a\n"
    forward, backward = compare_both_ways(f"{signals}exclusive a, b\nspec s = b\n", exclusive)
    assert (forward["relation"], backward["relation"]) == ("looser", "stricter")
    assert forward["exclusive"] == [{"atoms": ["a", "b"], "in_a": False, "in_b": True}]
    assert backward["exclusive"] == [{"atoms": ["a", "b"], "in_a": True, "in_b": False}]
    judged_on = (
        "judged on traces in which at most one of these holds at a time:\n    `a` and `b` (exclusive only in B)\n"
    )
    assert judged_on in tltlc("diff", "s.fspa.json", "new.tltl").out

    # An artefact that has both atoms but no such group was compiled without it.
    forward, _ = compare_both_ways(f"{signals}spec s = b & (a | !a & X a)\n", exclusive)
    assert (forward["relation"], forward["exclusive"]) == ("incomparable", [])

    # Here the atom of that name is defined differently.
    of_x = "signal a: bool\nsignal x in [0, 9]\npredicate b = clamp(x - {}, -1, 1)\n"
    forward, _ = compare_both_ways(f"{of_x.format(5)}spec s = b\n", f"{of_x.format(6)}exclusive a, b\nspec s = !a\n")
    assert (forward["relation"], forward["exclusive"]) == ("incomparable", [])
    forward, _ = compare_both_ways(f"{of_x.format(6)}spec s = b\n", f"{of_x.format(6)}exclusive a, b\nspec s = !a\n")
    assert forward["relation"] == "looser"


def test_different_atoms_of_the_same_name_share_no_exclusive_group(tltlc: Run, inside: Path) -> None:  # noqa: F811
    text = "signal a: bool\nsignal x in [0, 9]\npredicate b = clamp(x - {}, -1, 1)\nexclusive a, b\nspec s = {}\n"
    Path("old.tltl").write_text(text.format(5, "b"), encoding="utf-8")
    for number, relation in ((5, "looser"), (6, "incomparable")):
        Path("new.tltl").write_text(text.format(number, "!a"), encoding="utf-8")
        (spec,) = json.loads(tltlc("diff", "old.tltl", "new.tltl", "--format", "json").out)["specs"]
        assert spec["relation"] == relation
    assert tltlc("diff", "old.tltl", "new.tltl", "--by-name").out.count("B is looser") == 1


def test_finite_and_infinite_specs_have_a_reason_in_place_of_a_relation(tltlc: Run, inside: Path) -> None:  # noqa: F811
    Path("ever.tltl").write_text("signal seen: bool\nspec hide { semantics infinite avoid seen }\n", encoding="utf-8")
    outcome = tltlc("diff", "hide.tltl", "ever.tltl", "--format", "json")
    (spec,) = json.loads(outcome.out)["specs"]
    assert (outcome.status, spec["relation"]) == (1, None)
    assert spec["reason"] == (
        "A and B are of different kinds: A is about traces that end, B is about traces that never end, so no trace "
        "belongs to both. To compare what they require, give both the same `semantics`."
    )
    assert spec["beginnings"] == {"relation": "equivalent", "only_a": None, "only_b": None}
    text = "signal seen: bool\nspec hide { semantics infinite avoid not seen }\n"
    Path("ever.tltl").write_text(text, encoding="utf-8")
    outcome = tltlc("diff", "hide.tltl", "ever.tltl", "--format", "json")
    (spec,) = json.loads(outcome.out)["specs"]
    assert spec["beginnings"] == {"relation": "incomparable", "only_a": [[]], "only_b": [["seen"]]}
    jsonschema.validate(json.loads(outcome.out), SCHEMA)
    (same,) = json.loads(tltlc("diff", "hide.tltl", "hide.tltl", "--format", "json").out)["specs"]
    assert (same["relation"], same["reason"]) == ("equivalent", None)


def test_a_spec_named_on_one_side_is_compared_on_both(tltlc: Run, inside: Path) -> None:  # noqa: F811
    Path("two.tltl").write_text("signal seen: bool\nspec show = F seen\nspec hide = G !seen\n", encoding="utf-8")
    assert tltlc("diff", "hide.tltl:hide", "two.tltl").status == 0
    assert tltlc("diff", "two.tltl", "hide.tltl:hide").status == 0
    # A file with a single spec needs no name.
    assert "show and hide\n  B accepts different traces than A" in tltlc("diff", "two.tltl:show", "hide.tltl").out
    assert tltlc("diff", "two.tltl", "hide.tltl").status == 1
    two = tltlc("diff", "hide.tltl", "two.tltl:nothing")
    assert (two.status, two.out) == (2, "")
    Path("three.tltl").write_text("signal seen: bool\nspec a = F seen\nspec b = G seen\n", encoding="utf-8")
    ambiguous = tltlc("diff", "three.tltl", "two.tltl:hide")
    assert ambiguous.status == 2 and "TLT0721" in ambiguous.err


def test_the_hint_names_specs_as_on_the_command_line() -> None:
    file_diff = FileDiff(STDIN_NAME, "b.tltl", (), ("one", "two"), ("other",))
    assert "name both, e.g. `-:one` and `b.tltl:other`" in text(file_diff)


def test_unreadable_files_are_reported(tltlc: Run, inside: Path) -> None:  # noqa: F811
    assert tltlc("diff", "hide.tltl", "gone.tltl").status == 3
    Path("broken.tltl").write_text("spec hide = G !seem\n", encoding="utf-8")
    broken = tltlc("diff", "hide.tltl", "broken.tltl")
    assert broken.status == 1 and "TLT0201" in broken.err and broken.out == ""
    assert tltlc("diff", "-", "-").status == 2


@pytest.mark.parametrize("names", [("cover_and_hide", "branching"), ("navigation", "navigation")])
def test_diff_costs_less_than_three_times_compiling_both(names: tuple[str, str]) -> None:
    sources = [SourceFile(name, (ROOT / f"examples/{name}.tltl").read_text(encoding="utf-8")) for name in names]

    def compile_both() -> None:
        for source in sources:
            compile_source(source)

    automata = [compile_source(source).automata for source in sources]

    def compile_and_compare() -> None:
        compile_both()
        text(diff_files(("a", automata[0]), ("b", automata[1]), one_each=True))

    compile_and_compare()  # Warm up: read the libraries.
    assert calls(compile_and_compare) < 3 * calls(compile_both)
