"""Explanations agree with automata and formulas; those of the examples are golden files."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable
from pathlib import Path

import jsonschema
import pytest
from hypothesis import given

import tltlc as compiler
from tests.calls import calls
from tests.fuzzing import times
from tests.interfaces.cli.conftest import EXAMPLE, Outcome, inside, tltlc
from tests.logic.strategies import formulas
from tests.tools.witness.test_guided_search import TOWER, spec_of
from tests.unfolded import unfolded
from tltlc.automaton.compare import Letter
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.source import SourceFile
from tltlc.io.files import read_source
from tltlc.logic.formula import Formula
from tltlc.logic.oracle import all_traces, robustness_of_state
from tltlc.monitor.guards import holds
from tltlc.pipeline import compile_source, read_artefact
from tltlc.tools.explain.explanation import explain
from tltlc.tools.explain.sections import SectionTable, sections
from tltlc.tools.explain.text import text
from tltlc.tools.explain.values import json_values
from tltlc.tools.witness import blocks

__all__ = ["inside", "tltlc"]

Run = Callable[..., Outcome]

ROOT = Path(__file__).parents[3]
EXAMPLES = sorted((ROOT / "examples").glob("*.tltl"))
GOLDEN = Path(__file__).parent / "golden"
SCHEMA = json.loads((ROOT / "tltlc/tools/explain/explain.schema.json").read_text(encoding="utf-8"))
FORMULAS = formulas(atoms=("a", "b", "c"), max_leaves=5)


@pytest.mark.parametrize("golden", sorted(GOLDEN.iterdir()), ids=lambda golden: golden.stem)
def test_texts_of_the_examples_match_the_golden_files(golden: Path) -> None:
    compiled = compile_source(read_source(ROOT / "examples" / f"{golden.stem}.tltl"))
    explanation = "\n".join(text(explain(fspa)) for fspa in compiled.automata)
    if os.environ.get("UPDATE_GOLDEN") == "1":
        golden.write_text(explanation, encoding="utf-8")
    assert explanation == golden.read_text(encoding="utf-8")


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_no_line_is_too_long_or_ends_in_blanks(path: Path) -> None:
    lines = [line for fspa in compile_source(read_source(path)).automata for line in text(explain(fspa)).splitlines()]
    assert all(len(line) <= 100 and line == line.rstrip() for line in lines)


def test_the_examples_of_every_kind_of_game_have_golden_files() -> None:
    names = "branching cover_and_hide navigation patrol platformer puzzle racing robot_sorting"
    assert set(names.split()) <= {path.stem for path in GOLDEN.iterdir()}


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_artefact_is_explained_like_its_source(path: Path) -> None:
    for fspa in compile_source(read_source(path)).automata:
        assert explain(decoded(fspa)) == explain(fspa)


def decoded(fspa: Fspa) -> Fspa:
    """Write the automaton as an artefact, and read it."""
    artefact = emit("json", fspa)[f"{fspa.name}.fspa.json"]
    assert isinstance(artefact, str)
    return read_artefact(SourceFile("x.fspa.json", artefact))


def test_an_artefact_keeps_the_formula_if_names_contain_each_other() -> None:
    text_ = "signal x in [-9, 9]  signal y in [0, 9]  signal x1: bool  signal F1.x: bool\n"
    text_ += "spec s = F x > 1 & G(x + y > 1 -> x > 1.5) & (!x1 U F1.x) & F -x > 1"
    (fspa,) = compiler.compile_text(text_)
    assert isinstance(fspa.formula, Formula)
    assert decoded(fspa).formula is fspa.formula
    assert set(fspa.formula.atoms()) == {atom.name for atom in fspa.atoms}


@times(40)
@given(FORMULAS)
def test_formulas_of_guards_are_true_where_the_guards_are(formula: Formula) -> None:
    fspa = build(spec_from_formula(formula))
    names = [atom.name for atom in fspa.atoms]
    for edge in decoded(fspa).edges:
        guard = edge.guard.formula
        assert isinstance(guard, Formula)
        for number in range(2 ** len(names)):
            truth = {name: 1.0 if number >> place & 1 else -1.0 for place, name in enumerate(names)}
            is_true = robustness_of_state(guard, truth) > 0
            assert is_true == holds(edge.guard, [truth[name] for name in names])


@times(40)
@given(FORMULAS)
def test_states_edges_and_traces_of_an_explanation_match_the_automaton(formula: Formula) -> None:
    fspa = build(spec_from_formula(formula))
    explanation = explain(fspa)
    verdicts = {state.verdict for state in fspa.states}
    assert [(state.id, state.verdict, state.distance) for state in explanation.states] == [
        (state.id, state.verdict, state.distance) for state in fspa.states
    ]
    for state in explanation.states:
        assert bool(state.leads) == bool(state.distance)
        for lead in state.leads:
            assert (distance := explanation.states[lead.state].distance) is not None and distance <= (
                state.distance or 0
            )
            assert distance != state.distance or is_looser(fspa, state.id, lead.state)
    assert (explanation.succeed is None) == (verdicts == {"violated"})
    if explanation.fail is not None:
        assert explanation.states[explanation.fail.steps[-1].state].verdict == "violated"
    if explanation.succeed is not None:
        assert fspa.states[explanation.succeed.steps[-1].state].accepting
    jsonschema.validate({"specs": [json_values(explanation)]}, SCHEMA)


def is_looser(fspa: Fspa, source: int, target: int) -> bool:
    """Whether the state ``target`` accepts all short traces that ``source`` accepts."""
    traces = all_traces(tuple(atom.name for atom in fspa.atoms), 3)
    return all(is_accepted(fspa, target, trace) for trace in traces if is_accepted(fspa, source, trace))


def is_accepted(fspa: Fspa, state: int, letters: Iterable[Letter]) -> bool:
    for letter in letters:
        truth = blocks.letter_values(fspa, letter)
        state = next(edge.target for edge in fspa.edges_from(state) if holds(edge.guard, truth))
    return fspa.states[state].accepting


def test_single_goals_are_listed_before_goals_at_once() -> None:
    (fspa,) = compiler.compile_text("signal a: bool  signal b: bool  spec s { reach a  reach b }")
    assert [lead.when for lead in explain(fspa).states[0].leads] == ["b and not a", "a and not b", "a and b"]
    # An edge on which only time passes is not listed.
    (fspa,) = compiler.compile_text("signal a: bool  spec s = F[0,3] a")
    assert [lead.when for lead in explain(fspa).states[0].leads] == ["a"]


@pytest.mark.parametrize(
    ("formula", "rows"),
    [
        ("F[0,100] a & G !b", ["0", "1", "2, 4–100", "3", "101", "102"]),
        ("X X X X X X a", ["0", "1–4", "5", "6", "7", "8"]),
        ("F a", ["0", "1"]),
    ],
)
def test_counting_states_share_a_row(formula: str, rows: list[str]) -> None:
    with unfolded():
        (fspa,) = compiler.compile_text(f"signal a: bool  signal b: bool  spec s = {formula}")
    explanation = explain(fspa)
    (section,) = (candidate for candidate in sections(explanation) if candidate.heading == "States")
    (table,) = section.blocks
    assert isinstance(table, SectionTable)
    assert [row[0] for row in table.rows] == rows
    assert len(json_values(explanation)["states"]) == len(fspa.states)


def test_a_row_of_counting_states_names_the_steps_and_the_target() -> None:
    (fspa,) = compiler.compile_text("signal a: bool  signal b: bool  spec s { require G (b -> F[0,20] a) }")
    explanation = " ".join(text(explain(fspa)).split())
    assert explanation.count("18…1 steps.") == 1
    (fspa,) = compiler.compile_text("signal a: bool  spec s = X X X X X X a")
    row = "  1–4    pending    6…3    Have a after 5…2 steps.      anything (to the next)\n"
    assert row in text(explain(fspa))


def test_failures_are_listed_by_reason() -> None:
    (fspa,) = compiler.compile_text("signal a: bool  signal b: bool  spec s { keep a  avoid b  require F a }")
    failures = [(failure.when, failure.everywhere) for failure in explain(fspa).failures]
    assert failures == [("not a", True), ("b", True)]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_documents_of_the_examples_fit_the_schema(path: Path, tltlc: Run) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.validate(json.loads(tltlc("explain", path, "--format", "json").out), SCHEMA)


def test_json_and_markdown_have_the_goals_and_failures_of_the_example(tltlc: Run) -> None:
    document = json.loads(tltlc("explain", EXAMPLE, "--format", "json").out)
    (spec,) = document["specs"]
    assert spec["name"] == "cover_and_hide"
    assert spec["outline"]["goals"] == [
        [{"text": name, "together": False} for name in ("near(s1)", "near(s2)", "near(exit)")]
    ]
    assert spec["outline"]["throughout"] == ["keep alive"]
    assert spec["failures"] == [{"when": "not alive", "states": [0, 1, 3, 4], "everywhere": True}]
    assert [step["what"] for step in spec["fail"]["steps"]] == ["not alive"]
    markdown = tltlc("explain", EXAMPLE, "--format", "markdown").out
    assert markdown.startswith("# cover\\_and\\_hide\n\nButton 1,")
    assert "| 2 | violated | - | The spec is violated. |  |\n" in markdown


def test_a_file_is_explained_spec_by_spec(tltlc: Run, inside: Path) -> None:
    Path("two.tltl").write_text("signal a: bool\nspec one = F a\nspec two { keep a  judge at limit }\n")
    outcome = tltlc("explain", "two.tltl")
    assert outcome.out.startswith("one\n===\n") and "\n\ntwo\n===\n" in outcome.out
    assert tltlc("explain", "two.tltl:two").out.startswith("two\n===\n")
    assert "goes on until the game ends it" in outcome.out
    missing = tltlc("explain", "two.tltl:three")
    assert (missing.status, missing.out) == (2, "")
    assert "TLT0720" in missing.err


@pytest.mark.parametrize(
    ("clauses", "phrase"),
    [
        ("reach a & F b", "    1. a\n    2. now or later, b\n"),
        ("require F(a & b) & G(a -> F b)", "    - whenever a, reach b at that step or later\n"),
        ("require a U b", "  Do this:\n    - reach b, keeping a until then\n"),
        ("require F a | G !a", "There is none: every trace meets it."),
        ("require F a & G !a", "It cannot be met at all."),
        ("require F a & G !a", "The shortest way to succeed\n  There is none.\n"),
        ("reach a limit 1 steps", "The limit is 1 step."),
        ("semantics infinite keep a", "  1. not a (to state 1)\n  After that, whatever comes makes no difference.\n"),
        ("reach b reach a", "  Reach, in any order:\n    - b\n    - a\n"),
        ("semantics infinite require G F a", "  Again and again, for ever:\n    - reach a\n"),
    ],
)
def test_each_kind_of_clause_has_its_phrase_in_the_text(clauses: str, phrase: str) -> None:
    (fspa,) = compiler.compile_text(f"signal a: bool  signal b: bool  spec s {{ {clauses} }}")
    assert phrase in text(explain(fspa))


def test_a_search_without_a_result_does_not_say_that_the_spec_cannot_be_met() -> None:
    chain = "a then within 5 s b then within 5 s c then within 2 s (begins a) then within 5 s (times(b) > 3)"
    signals = " ".join(f"signal {name}: bool" for name in "abc")
    (fspa,) = compiler.compile_text(f"clock 60 Hz {signals} spec s {{ reach {chain} }}")
    said = text(explain(fspa))
    assert "A way to succeed\n  The search found none within its limit. There may still be one." in said
    assert "What breaks it\n  Nothing breaks it for good.\n" in said


def test_a_way_to_fail_is_found_where_something_must_come_several_times_first() -> None:
    signals = " ".join(f"signal {name}: bool" for name in ("back", "in_menu", "title"))
    clause = "keep times_within(back, 5 s) >= 3 and in_menu implies eventually within 1 s title"
    (fspa,) = compiler.compile_text(f"clock 10 Hz {signals} spec s {{ {clause} }}")
    fail = explain(fspa).fail
    assert fail is not None
    assert sum("not back" not in step.what and "back" in step.what for step in fail.steps) == 3
    assert fail.steps[-1].what == "not title"


def test_many_states_are_counted() -> None:
    (fspa,) = compiler.compile_text("signal a: bool  signal b: bool  spec x = (G[0,20] !a) & F b")
    assert "What breaks it\n  - a, in 41 of 44 states\n" in text(explain(fspa))


def test_only_declared_groups_are_said_to_exclude_each_other() -> None:
    signals = "signal hook: (attached, flying, idle)  signal a: bool  signal b: bool  exclusive a, b"
    clauses = "avoid hook is attached and a  reach hook is flying and not b"
    (fspa,) = compiler.compile_text(f"{signals} spec s {{ {clauses} }}")
    explanation = explain(fspa)
    assert set(map(frozenset, explanation.exclusive)) == {
        frozenset(("hook is attached", "hook is flying")),
        frozenset("ab"),
    }
    said = text(explanation)
    assert "At most one of these holds at a time:\n    - a, b\n\n" in said


@pytest.mark.parametrize("name", ["cover_and_hide", "navigation", "branching"])
def test_explaining_takes_less_than_three_times_the_calls_of_compiling(name: str) -> None:
    source = read_source(ROOT / "examples" / f"{name}.tltl")

    def compile_only() -> None:
        compile_source(source)

    def compile_and_explain() -> None:
        compilation = compile_source(source)
        for fspa in compilation.automata:
            text(explain(fspa))

    compile_and_explain()  # Warm up: read the libraries.
    assert calls(compile_and_explain) < 3 * calls(compile_only)


def test_values_that_are_remembered_are_listed_and_no_trace_is_called_the_shortest() -> None:
    (fspa,) = compiler.compile_text(
        "clock 10 Hz\nsignal seen: bool\nsignal hidden: bool\n"
        "spec s { keep times(seen) <= 1  reach time_holding(hidden) >= 0.5 s }"
    )
    explanation = explain(fspa)
    assert [(value.name, value.words, value.unit, value.maximum) for value in explanation.memory] == [
        ("times(seen)", "how often seen has begun", "", 3.0),
        ("time_holding(hidden)", "how long hidden has held", "steps", 10.0),
    ]
    assert explanation.succeed is not None
    assert [(step.times, step.what) for step in explanation.succeed.steps] == [(6, "hidden and not seen")]
    headings = [section.heading for section in sections(explanation)]
    assert headings[-2:] == ["A way to succeed", "A way to fail"]
    assert "What it remembers" in headings


def test_a_long_chain_is_a_numbered_list_and_no_sentence() -> None:
    signals = " ".join(f"signal {name}: bool" for name in "abcde")
    chain = "a then within 5 s b then within 3 s c then within 2 s d then e"
    (fspa,) = compiler.compile_text(f"clock 60 Hz {signals} spec s {{ reach {chain} }}")
    explanation = explain(fspa)
    goals = "a, then b within 5 s after a, then c within 3 s after b, then d within 2 s after c, then e"
    assert explanation.english == f"Reach {goals}."
    assert text(explanation).startswith(
        "s\n=\n\nWhat it asks for\n  Reach, in this order:\n"
        "    1. a\n    2. b within 5 s after a\n    3. c within 3 s after b\n    4. d within 2 s after c\n    5. e\n\n"
        "At the edges\n  - then e: any later step counts, also if it began before; `begins` asks for a beginning\n"
        "  - before its turn, a goal does not count, and breaks nothing\n"
        "  - within 5 s: up to and including the step 5 s later\n"
        "  - within 3 s: up to and including the step 3 s later\n"
        "  - within 2 s: up to and including the step 2 s later\n"
        "  - where play ends before that, what has not come counts as missed\n\n"
        "What it remembers\n"
        "  - the time since a (over every limit before the first)\n"
        "  - the time since a at an earlier step\n"
        "  - the time since b in time (over every limit before the first)\n"
    )


def test_example_traces_say_in_words_what_is_remembered() -> None:
    (fspa,) = compiler.compile_text("signal gold in [0, 9] spec s { keep gold >= previous(gold) }")
    fail = explain(fspa).fail
    assert fail is not None
    assert [step.what for step in fail.steps] == ["gold >= the previous gold", "gold < the previous gold"]


def test_a_short_chain_is_a_sentence_too() -> None:
    (fspa,) = compiler.compile_text("signal a: bool signal b: bool signal c: bool spec s { reach a then b then c }")
    assert text(explain(fspa)).startswith("s\n=\n  Reach a, then b, then c.\n")


def test_a_large_spec_is_explained_without_the_table_of_its_states() -> None:
    explanation = explain(spec_of(TOWER))
    (states,) = [section.blocks for section in sections(explanation) if section.heading == "States"]
    count = len(explanation.states)
    left_out = f"The table of the {count} states is left out, because it is long; `--format json` shows them."
    assert states == (left_out,)
    assert explanation.succeed is not None
    assert explanation.fail is not None
    assert len(text(explanation).splitlines()) < 200


@pytest.mark.parametrize(
    ("clause", "said"),
    [
        ("keep begins a implies b", "whether a held at the step before (not before the first step)"),
        ("keep n >= previous(n)", "the previous n (at the first step, the one of that step)"),
        (
            "keep n >= previous(n, 3 steps)",
            "the n 3 steps before (before that is reached, the one of the first step)",
        ),
        ("keep a implies time_since(b) <= 2 s", "the time since b (over every limit before the first)"),
        (
            "keep times_since(a, b) <= 2",
            "how often a has begun since b "
            "(before the first of these, since the first step; steps in a row count once)",
        ),
        (
            "keep n >= value_at(n, ends b)",
            "the n when b last ended (at the first step without it; before that, the one of the first step of all)",
        ),
        ("keep n >= value_at(n, b)", "the n when b last held (before that, the one of the first step)"),
    ],
)
def test_what_is_remembered_is_said_for_the_first_steps_too(clause: str, said: str) -> None:
    (fspa,) = compiler.compile_text(
        f"clock 10 Hz signal a: bool signal b: bool signal n in [0, 9] spec s {{ {clause} }}"
    )
    assert f"- {said}" in " ".join(text(explain(fspa)).split())


def test_a_rule_with_answers_says_that_what_is_due_at_the_end_is_missed() -> None:
    said = "What is still due at the last step counts as missed: its verdict is `pending`."
    for clause, is_due in (("a implies eventually within 2 s b", True), ("a implies always for 2 s b", False)):
        (fspa,) = compiler.compile_text(f"clock 10 Hz signal a: bool signal b: bool spec s {{ keep {clause} }}")
        assert (said in explain(fspa).ending) == is_due
