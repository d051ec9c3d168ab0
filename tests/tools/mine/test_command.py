"""``tltlc mine`` on the command line: its output, its source file, and its messages."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from benchmarks.mine_traces import PlantedSpec, evidence
from tests.interfaces.cli.conftest import ROOT, Outcome
from tests.interfaces.cli.test_loading import HEAVY, loaded_modules
from tltlc.automaton.compare import are_equivalent
from tltlc.pipeline import CompileOptions, compile_file
from tltlc.tools.fmt import format_text
from tltlc.tools.mine.evidence import LabelledTrace

SPEC = PlantedSpec(
    "heist",
    ("reach near(s1) then near(s2) then near(exit)", "keep alive"),
    {"near(s1)": 0.1, "near(s2)": 0.1, "near(exit)": 0.1, "alive": 0.985, "seen": 0.3},
)
SCHEMA = json.loads((ROOT / "tltlc/tools/mine/mine.schema.json").read_text(encoding="utf-8"))
DECLARATIONS = """\
signal alive: bool
signal seen: bool
entity s1, s2, exit
signal near(place: entity): bool
"""

Run = Callable[..., Outcome]


class PlantedWithEntities(PlantedSpec):
    """A planted spec whose source declares the predicates with arguments."""

    @property
    def source(self) -> str:
        clauses = "".join(f"    {clause}\n" for clause in self.clauses)
        return f"{DECLARATIONS}spec planted {{\n{clauses}}}\n"


@pytest.fixture
def recorded(inside: Path) -> Path:
    """Write traces of a planted spec to the subfolders `good` and `bad`, and return the folder."""
    planted = evidence(PlantedWithEntities(SPEC.name, SPEC.clauses, SPEC.probabilities), 12, 24, seed=4)
    for folder, traces in (("good", planted.traces), ("bad", planted.counterexamples)):
        (inside / folder).mkdir()
        for number, trace in enumerate(traces):
            (inside / folder / f"run_{number:02}.csv").write_text(_csv(trace))
    return inside


def _csv(trace: LabelledTrace) -> str:
    rows = [",".join(["time", *SPEC.probabilities])]
    for number, letter in enumerate(trace.letters):
        rows.append(",".join([f"{number / 10}", *(str(name in letter).lower() for name in SPEC.probabilities)]))
    return "\n".join(rows) + "\n"


def proposals(outcome: Outcome) -> list[dict[str, Any]]:
    document = json.loads(outcome.out)
    jsonschema.validate(document, SCHEMA)
    all_proposals: list[dict[str, Any]] = document["proposals"]
    return all_proposals


def test_the_text_output_matches_the_golden_file(tltlc: Run, recorded: Path) -> None:
    outcome = tltlc("mine", "good", "--against", "bad", "--top", "2")
    assert outcome.status == 0
    assert (
        outcome.err
        == "columns left out because they are not atoms: time (`--predicates LIB` computes atoms from numbers)\n"
    )
    expected = Path(__file__).with_name("expected.txt")
    assert outcome.out == expected.read_text(encoding="utf-8")
    assert max(map(len, outcome.out.splitlines())) <= 100


def test_the_first_proposal_of_the_json_document_is_the_planted_spec(tltlc: Run, recorded: Path) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    outcome = tltlc("mine", "good", "--against", "bad", "--json")
    document = json.loads(outcome.out)
    assert {key: document[key] for key in ("traces", "counterexamples", "made_up", "complete")} == {
        "traces": 12,
        "counterexamples": 24,
        "made_up": False,
        "complete": True,
    }
    first = proposals(outcome)[0]
    assert first["rank"] == 1
    assert first["clauses"] == list(SPEC.clauses)
    assert first["formula"] == "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive"
    assert (first["support"], first["separation"], first["atoms"]) == (1.0, 1.0, 4)
    assert first["score"] == pytest.approx(0.96)
    assert first["not_satisfied"] == first["not_violated"] == []
    assert all(proposal["not_violated"] for proposal in proposals(outcome)[1:])


def test_the_result_does_not_depend_on_the_order_of_files(tltlc: Run, recorded: Path) -> None:
    outcome = tltlc("mine", "good", "--against", "bad", "--json")
    files = sorted(str(path) for path in Path("good").iterdir())
    reversed_outcome = tltlc("mine", *files[::-1], "--against", "bad", "--json")
    assert [proposal["clauses"] for proposal in proposals(reversed_outcome)] == [
        proposal["clauses"] for proposal in proposals(outcome)
    ]


def test_the_source_file_compiles_and_its_tests_pass(tltlc: Run, recorded: Path) -> None:
    outcome = tltlc("mine", "good", "--against", "bad", "-o", "mined.tltl")
    assert outcome.err.endswith("wrote mined.tltl\n")
    text = Path("mined.tltl").read_text(encoding="utf-8")
    assert format_text(text) == text
    assert tltlc("test", "mined.tltl").status == 0
    assert tltlc("check", "mined.tltl").status == 0
    Path("planted.tltl").write_text(f"{DECLARATIONS}spec planted {{ {' '.join(SPEC.clauses)} }}\n")
    (planted,) = compile_file("planted.tltl")
    (mined,) = compile_file("mined.tltl", CompileOptions(specs=("mined_1",)))
    assert are_equivalent(planted, mined)


@pytest.mark.parametrize(
    ("predicates", "declarations"),
    [
        (None, "entity s1\nsignal at(x1: entity): bool\n"),
        ("stealth", "import stealth\n\nentity s1\n"),
        ("game.tltl", 'import "game.tltl"\n\nentity s1\n'),
    ],
)
def test_the_source_file_declares_what_it_uses(
    tltlc: Run, inside: Path, predicates: str | None, declarations: str
) -> None:
    Path("game.tltl").write_text("import stealth\n")
    header = "distance(s1),distance(s2),at(s1),at(s2),idle\n"
    Path("good.csv").write_text(header + "0.5,9,1,0,0\n9,9,0,0,1\n")
    Path("bad.csv").write_text(header + "9,9,0,0,0\n9,9,0,0,1\n")
    library = ["--predicates", predicates] if predicates else []
    tltlc("mine", "good.csv", "--against", "bad.csv", "--top", "1", "-o", "mined.tltl", *library)
    text = Path("mined.tltl").read_text(encoding="utf-8")
    assert "s2" not in text and "idle" not in text
    assert declarations in text
    assert tltlc("lint", "mined.tltl").status == 0
    assert tltlc("test", "mined.tltl").status == 0


def test_traces_on_both_sides_are_reported_once(tltlc: Run, recorded: Path) -> None:
    first, second = (str(Path(f"good/run_0{number}.csv")) for number in (0, 1))
    outcome = tltlc("mine", "good", "--against", "good")
    assert outcome.err.count("TLT0762") == 1
    title = (
        f"12 of 12 counterexamples have the same atoms as a trace at every step (`{first}`, for example), so no spec"
    )
    assert title in outcome.err
    outcome = tltlc("mine", "good", "--against", "bad", "--against", first)
    assert f"TLT0762]: `{first}` is both a trace and a counterexample, so no spec can tell the two apart" in outcome.err
    copies = [Path("bad/a.csv"), Path("bad/b.csv")]
    for path, source in zip(copies, (first, second), strict=True):
        path.write_text(Path(source).read_text())
    outcome = tltlc("mine", "good", "--against", "bad")
    title = "2 of 26 counterexamples have the same atoms as a trace at every step "
    title += f"(`{copies[0]}` and `{first}`, for example)"
    assert title in outcome.err and outcome.err.count("TLT0762") == 1


def test_atoms_are_computed_by_predicates_of_a_library_file(tltlc: Run, inside: Path) -> None:
    Path("lib").mkdir()
    Path("lib/game.tltl").write_text("import stealth\nentity s1\n")
    Path("build").mkdir()
    good = "distance(s1),distance(exit),health\n9,9,1\n0.5,9,1\n9,0.5,1\n"
    Path("good.csv").write_text(good)
    Path("bad.csv").write_text(good.replace("0.5,9,1", "0.5,9,0"))
    Path("worse.csv").write_text("distance(s1),distance(exit),health\n9,9,1\n9,0.5,1\n0.5,9,1\n")
    Path("short.csv").write_text("distance(s1),distance(exit),health\n9,9,1\n0.5,9,1\n9,9,1\n")
    against = [part for name in ("bad", "worse", "short") for part in ("--against", f"{name}.csv")]
    outcome = tltlc("mine", "good.csv", *against, "--predicates", "lib/game.tltl", "-o", "build/mined.tltl", "--json")
    assert outcome.status == 0
    assert proposals(outcome)[0]["clauses"] == ["reach near(s1) then near(exit)", "keep alive"]
    text = Path("build/mined.tltl").read_text(encoding="utf-8")
    assert 'import "../lib/game.tltl"\n\nentity exit\n' in text
    assert tltlc("test", "build/mined.tltl").status == 0


def test_a_shipped_library_can_be_given_by_name(tltlc: Run, inside: Path) -> None:
    Path("good.csv").write_text("distance(s1),health\n9,1\n0.5,1\n")
    Path("bad.csv").write_text("distance(s1),health\n9,1\n9,1\n")
    outcome = tltlc("mine", "good.csv", "--against", "bad.csv", "--predicates", "stealth", "-o", "mined.tltl", "--json")
    assert proposals(outcome)[0]["clauses"] == ["reach near(s1)"]
    assert "\nimport stealth\n\nentity s1\n" in Path("mined.tltl").read_text(encoding="utf-8")
    assert tltlc("test", "mined.tltl").status == 0
    outcome = tltlc("mine", "good.csv", "--predicates", "stelth")
    assert outcome.status == 1
    assert "error[TLT0010]: there is no library `stelth`" in outcome.err


def test_mined_specs_have_no_limit(tltlc: Run, recorded: Path) -> None:
    tltlc("mine", "good", "--against", "bad", "-o", "mined.tltl")
    text = Path("mined.tltl").read_text(encoding="utf-8")
    longest = max(len(path.read_text().splitlines()) - 1 for path in Path("good").iterdir())
    assert f"\n// Set limits yourself: the longest of the traces takes {longest} steps.\n" in text
    assert all(fspa.limit_steps is None for fspa in compile_file("mined.tltl"))


def test_a_library_is_not_overwritten(tltlc: Run, recorded: Path) -> None:
    Path("lib.tltl").write_text("signal alive: bool\n")
    outcome = tltlc("mine", "good", "--against", "bad", "--predicates", "lib.tltl", "-o", "lib.tltl")
    assert outcome.status == 2
    assert "would be overwritten" in outcome.err
    assert Path("lib.tltl").read_text() == "signal alive: bool\n"


def test_counterexamples_are_made_up_if_none_are_given(tltlc: Run, recorded: Path) -> None:
    outcome = tltlc("mine", "good")
    assert outcome.status == 0
    assert "made-up counterexamples" in outcome.out
    assert "so made-up ones are used: " in outcome.out


@pytest.mark.parametrize("example", ["navigation", "cover_and_hide", "racing"])
def test_the_plan_of_an_example_is_found_in_its_trace(tltlc: Run, inside: Path, example: str) -> None:
    path = ROOT / "examples" / example
    outcome = tltlc("mine", f"{path}.csv", "--predicates", f"{path}.tltl", "--json")
    reach_clause = next(line.strip() for line in path.with_suffix(".tltl").read_text().splitlines() if "reach" in line)
    order = [step.strip() for step in reach_clause.removeprefix("reach ").split(" then ")]
    clauses = " ".join(proposals(outcome)[0]["clauses"])
    assert [clauses.index(step) for step in order] == sorted(clauses.index(step) for step in order)


def test_all_names_after_against_are_counterexamples(tltlc: Run, recorded: Path) -> None:
    good, bad = ([str(path) for path in sorted(Path(folder).iterdir())] for folder in ("good", "bad"))
    expected = tltlc("mine", "good", "--against", "bad", "--json")
    for arguments in (
        [*good, "--against", *bad, "--json"],
        ["--json", "--against", *bad, "--", *good],
        [*good, "--against", bad[0], "--json", "--against", *bad[1:]],
        ["--against", *bad, "--json", *good],
    ):
        outcome = tltlc("mine", *arguments)
        assert outcome.out == expected.out
        assert f"counterexamples: `{bad[0]}`, `{bad[1]}`, `{bad[2]}` and 21 more\n" in outcome.err
    assert "counterexamples:" not in tltlc("mine", *good, "--against=bad").err
    document = json.loads(tltlc("mine", "--against=bad", *good[:2], "--json").out)
    assert (document["traces"], document["counterexamples"]) == (2, 24)


def test_against_leaves_a_trace_for_the_command(tltlc: Run, recorded: Path) -> None:
    outcome = tltlc("mine", "--against", "bad", "good")
    assert (outcome.status, outcome.out) == (2, "")
    assert "there are no TRACES: --against takes all names after it. Write the TRACES before --against" in outcome.err
    for arguments in (["good", "--against"], ["good", "--against", "--top", "3"], ["good", "--against", "--", "bad"]):
        outcome = tltlc("mine", *arguments)
        assert (outcome.status, outcome.out) == (2, "")
        assert "option '--against' requires an argument" in outcome.err
    assert "missing argument 'TRACES...'" in tltlc("mine", "--top", "3").err


def test_one_trace_may_be_standard_input(process: Run, recorded: Path) -> None:
    text = Path("good/run_00.csv").read_bytes()
    outcome = process("mine", "-", "--against", "bad", "--json", stdin=text)
    assert outcome.status == 0
    assert json.loads(outcome.out)["traces"] == 1
    for twice in (("-", "-"), ("-", "--against", "-")):
        assert process("mine", *twice, stdin=text).status == 2


def test_a_folder_without_traces_is_reported(tltlc: Run, inside: Path) -> None:
    Path("empty").mkdir()
    Path("empty/.hidden.csv").write_text("a\ntrue\n")
    outcome = tltlc("mine", "empty")
    assert outcome.status == 3
    assert "the folder `empty` contains no trace" in outcome.err


def test_traces_in_which_nothing_holds_give_no_proposal(tltlc: Run, inside: Path) -> None:
    Path("run.csv").write_text("a,b\nfalse,false\n")
    outcome = tltlc("mine", "run.csv", "--json")
    assert outcome.status == 1
    assert "TLT0761" in outcome.err
    assert proposals(outcome) == []


def test_no_heavy_module_is_imported(recorded: Path) -> None:
    assert not loaded_modules("mine", "good", "--against", "bad", folder=recorded) & HEAVY


def test_a_column_missing_in_one_trace_is_reported(tltlc: Run, recorded: Path) -> None:
    path = Path("good/run_00.csv")
    path.write_text(path.read_text().replace("seen", "noticed"))
    outcome = tltlc("mine", "good", "--against", "bad")
    assert outcome.status == 0
    assert f"warning[TLT0763]: `{path}` lacks the column `seen`, so it is left out\n" in outcome.err
    assert "columns left out because they are not atoms: time, noticed (" in outcome.err


def test_what_a_monitor_says_of_atoms_is_mined(tltlc: Run, inside: Path) -> None:
    Path("game.tltl").write_text(
        "entity key, exit\nsignal distance(e: entity): length in [0 m, 20 m]\nsignal seen: bool\n"
        "predicate near(e: entity) in [-1, 1] = clamp(1 - distance(e) / 10 m, -1, 1)\n"
        "spec s { reach near(key) then near(exit) avoid seen }\n"
    )
    rows = {
        "good_1": "15,15,0 5,15,0 15,12,0 15,3,0",
        "good_2": "15,2,0 15,15,0 2,15,0 9,9,0 14,12,0 15,1,0",
        "bad_seen": "15,15,0 2,15,1 15,1,0",
        "bad_order": "15,3,0 15,15,0 5,15,0 15,12,0",
    }
    for name, lines in rows.items():
        trace = "\n".join(["distance(key),distance(exit),seen", *lines.split(), ""])
        Path("trace.csv").write_text(trace)
        document = json.loads(tltlc("monitor", "game.tltl", "trace.csv", "--json").out)
        header = document["rows"][0]["atoms"]
        atoms = [",".join(map(repr, row["atoms"].values())) for row in document["rows"]]
        Path(f"{name}.csv").write_text("\n".join([",".join(header), *atoms, ""]))
    outcome = tltlc(
        "mine", "good_1.csv", "good_2.csv", "--against", "bad_seen.csv", "bad_order.csv", "-o", "mined.tltl"
    )
    assert outcome.err.splitlines()[1] == (
        "columns of robustness values: near(key), near(exit), seen (an atom holds where its value is above 0)"
    )
    assert "reach (near(key) > 0) then (near(exit) > 0)\n         avoid seen > 0\n" in outcome.out
    text = Path("mined.tltl").read_text(encoding="utf-8")
    assert "signal near(x1: entity) in [-1, 1]\nsignal seen in [-1, 1]\n" in text
    assert tltlc("test", "mined.tltl").status == 0


def test_values_outside_the_range_of_robustness_in_one_trace_are_reported(tltlc: Run, inside: Path) -> None:
    for number, low in enumerate((-1, -0.5, -7)):
        Path(f"{number}.csv").write_text(f"alive,near\n0,{low}\n1,0.5\n")
    outcome = tltlc("mine", "0.csv", "1.csv", "2.csv")
    assert outcome.err == (
        "warning[TLT0763]: `near` has values outside [-1, 1] in `2.csv`, so it is left out\n"
        "  help: write robustness values there, too, or compute atoms from numbers with `--predicates LIB`\n"
    )


def test_columns_that_cannot_name_an_atom_are_reported(tltlc: Run, inside: Path) -> None:
    Path("run.csv").write_text("seen,x,the door\nfalse,1.5,false\ntrue,2.5,true\n")
    outcome = tltlc("mine", "run.csv")
    assert (outcome.status, outcome.err) == (
        0,
        "columns left out because they are not atoms: x (`--predicates LIB` computes atoms from numbers)\n"
        "columns left out because no atom can have such a name: the door "
        "(atoms have names like `seen` or `at(key)`)\n",
    )


def test_a_library_is_named_as_on_the_command_line(tltlc: Run, inside: Path) -> None:
    Path("run.csv").write_text("x\n1.5\n")
    outcome = tltlc("mine", "run.csv", "--predicates", "stealth")
    assert outcome.status == 1
    assert "no predicate of `stealth` can be computed from the columns of the traces" in outcome.err


@pytest.mark.parametrize("text", ["", "alive,seen\n"])
def test_an_empty_trace_is_reported(tltlc: Run, recorded: Path, text: str) -> None:
    Path("bad/empty.csv").write_text(text)
    outcome = tltlc("mine", "good", "--against", "bad")
    assert outcome.status == 1
    assert f"error[TLT0620]: the trace `{Path('bad/empty.csv')}` contains no sample" in outcome.err


def test_a_missing_trace_is_reported(tltlc: Run, inside: Path) -> None:
    assert tltlc("mine", "nowhere.csv").status == 3


def test_an_invalid_line_is_reported_with_its_number(tltlc: Run, inside: Path) -> None:
    Path("run.csv").write_text("alive,seen\ntrue,false\ntrue\n")
    outcome = tltlc("mine", "run.csv")
    assert outcome.status == 1
    assert "TLT0622" in outcome.err
    assert "run.csv:3" in outcome.err


def test_the_search_stops_at_the_time_limit(tltlc: Run, recorded: Path) -> None:
    outcome = tltlc("mine", "good", "--against", "bad", "--time", "0", "--json")
    assert "time is up" in outcome.err
    assert json.loads(outcome.out)["complete"] is False


def test_an_interrupt_prints_the_best_proposals_so_far(
    tltlc: Run,
    recorded: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from tltlc.tools.mine.search import SpecSearch

    original_run = SpecSearch.run

    def interrupted_run(self: SpecSearch) -> Iterator[str]:
        for stage in original_run(self):
            yield stage
            if stage == "conjunctions" and len(self.ranking()[0]) > 1:
                raise KeyboardInterrupt

    monkeypatch.setattr(SpecSearch, "run", interrupted_run)
    outcome = tltlc("mine", "good", "--against", "bad", "--json")
    assert outcome.status == 130
    assert "interrupted" in outcome.err
    assert proposals(outcome)[0]["clauses"] == list(SPEC.clauses)


@pytest.mark.parametrize("folder", ['p"q', "p\nq", "p\rq", os.fsdecode(b"p\xff")])
@pytest.mark.parametrize("output", ["mined.tltl", "-"])
def test_a_library_that_cannot_be_imported_is_rejected_before_the_search(
    folder: str, output: str, recorded: Path, tltlc: Run
) -> None:
    (recorded / folder).mkdir()
    (recorded / folder / "c.tltl").write_text("signal seen: bool\n")
    outcome = tltlc("mine", "good", "--predicates", f"{folder}/c.tltl", "-o", output)
    assert (outcome.status, outcome.out) == (2, "")
    assert "because its path contains a quote or a line break: rename it" in outcome.err
    assert not (recorded / "mined.tltl").exists()
