"""The atoms of traces, from columns and from libraries."""

from __future__ import annotations

import pytest

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor.run import header
from tltlc.pipeline import compile_text
from tltlc.resolve.options import ResolveOptions
from tltlc.tools.mine.columns import MONITOR_COLUMNS, ColumnKind, columns, common_columns
from tltlc.tools.mine.trace_letters import TraceFile, consistent, read_traces
from tltlc.tools.mine.vocabulary import signal_declarations, vocabulary_of_columns, vocabulary_of_library

TRUTHS, SHARES, ROBUSTNESS, OTHER = ColumnKind

LIBRARY = """\
import spatial
entity exit
exclusive near(exit), near(s1)
signal health in [0, 1]
signal seen: bool
signal open(door: entity): bool
predicate hurt(by = 0.5) in [-1, 1] = by - health
spec careful = G health > 0.2
"""


def names(text: str, columns_of_traces: set[str]) -> list[str]:
    vocabulary = vocabulary_of_library(SourceFile("game.tltl", text), columns_of_traces, ResolveOptions())
    return [atom.name for atom in vocabulary.reader.atoms]


def test_columns_of_truth_values_are_atoms() -> None:
    kinds = columns(b"alive,health,near(s1)\ntrue,1,0\nfalse,0.5,1\n", "run.csv")
    assert kinds == {"alive": TRUTHS, "health": SHARES, "near(s1)": TRUTHS}
    vocabulary = vocabulary_of_columns(kinds)
    assert [atom.name for atom in vocabulary.reader.atoms] == ["alive", "near(s1)"]
    assert (vocabulary.left_out, vocabulary.misnamed) == (("health",), frozenset())


def test_json_lines_are_read_like_csv() -> None:
    kinds = columns(
        b'{"alive": true, "health": 0.5, "name": "x"}\n\n{"alive": 0, "health": 1, "late": true}\n', "run.csv"
    )
    assert kinds == {"alive": TRUTHS, "health": SHARES}
    assert columns(b'{"alive": true, "doors": [1], "name": "x"}\n', "run.csv") == {
        "alive": TRUTHS,
        "doors": OTHER,
        "name": OTHER,
    }


def test_only_columns_of_all_traces_count() -> None:
    assert common_columns([{"a": TRUTHS, "b": TRUTHS, "c": TRUTHS}, {"c": TRUTHS, "b": OTHER}]) == {
        "b": OTHER,
        "c": TRUTHS,
    }


def test_columns_of_robustness_values_are_atoms_above_0() -> None:
    first = b"near(s1),near(s2),alive,health,stick,speed\n"
    kinds = common_columns(
        [
            columns(first + b"-0.5,1,true,0.5,-1,-1\n0.25,1,false,1,1,1.5\n", "run.csv"),
            columns(first + b"0.5,0.5,1,0,0,0\n", "other.csv"),
        ]
    )
    assert [*kinds.values()] == [ROBUSTNESS, ROBUSTNESS, TRUTHS, SHARES, ROBUSTNESS, OTHER]
    vocabulary = vocabulary_of_columns(kinds)
    assert {atom.name for atom in vocabulary.reader.atoms} == {"near(s1) > 0", "near(s2) > 0", "alive", "stick > 0"}
    assert (vocabulary.robust, vocabulary.left_out) == (("near(s1)", "near(s2)", "stick"), ("health", "speed"))
    trace = TraceFile("run.csv", first + b"-0.5,1,true,0.5,0,-1\n0.25,0,false,1,0.01,1.5\n")
    ((read,), _) = read_traces([trace], vocabulary)
    assert read.letters == ({"near(s2) > 0", "alive"}, {"near(s1) > 0", "stick > 0"})
    assert names("signal x in [-1, 1]\nspec s = F x > 0", {"x"}) == ["x > 0"]


@pytest.mark.parametrize("value", ["-1.0000001", "nan", "inf", "", "x", "-1e400"])
def test_other_values_are_no_robustness(value: str) -> None:
    assert columns(f'a,b\n-0.5,"{value}"\n'.encode(), "run.csv") == {"a": ROBUSTNESS, "b": OTHER}


def test_all_atoms_of_a_monitor_are_robustness_values() -> None:
    (fspa,) = compile_text("signal x in [0, 1]\nsignal seen: bool\nspec s { reach x > 0 or seen }")
    assert header(fspa) == (*MONITOR_COLUMNS, *(atom.name for atom in fspa.atoms))
    row = ",".join((*MONITOR_COLUMNS, "alive", "seen", "speed"))
    kinds = common_columns([columns(f"{row}\n1,0,pending,0,-1,0.5,1,2\n".encode(), "run.csv")])
    assert [*kinds.values()] == [OTHER] * 5 + [ROBUSTNESS, ROBUSTNESS, OTHER]


@pytest.mark.parametrize("column", ["reach", "F", "2fast", "a b", "near(s1", "near()", "near(2)", "s1 > 2", ""])
def test_columns_that_cannot_name_an_atom_are_left_out(column: str) -> None:
    vocabulary = vocabulary_of_columns({"alive": TRUTHS, column: TRUTHS})
    assert [atom.name for atom in vocabulary.reader.atoms] == ["alive"]
    assert (vocabulary.left_out, vocabulary.misnamed) == ((column,), {column})


def test_signals_are_declared_once_with_the_entities_that_they_are_about() -> None:
    signals = [("near", ("s1", "s2")), ("near", ("s2", "s3")), ("alive", ())]
    expected = "entity s1, s2, s3\nsignal near(x1: entity, x2: entity): bool\nsignal alive: bool\n"
    assert signal_declarations(signals) == expected
    columns_of_traces = dict.fromkeys(("alive", "near(s1, s2)", "near(s2, s3)"), TRUTHS)
    assert vocabulary_of_columns(columns_of_traces).library.text == expected


def test_values_of_enums_are_atoms() -> None:
    text = "entity g1\nsignal mode(g: entity): (idle, alert)\nsignal phase: (day, night)\n"
    assert names(text, {"mode(g1)", "phase"}) == [
        "mode(g1) is idle",
        "mode(g1) is alert",
        "phase is day",
        "phase is night",
    ]


def test_a_duplicate_column_is_reported() -> None:
    kinds = columns(b"a,a\ntrue,false\n", "run.csv")
    assert kinds == {"a": TRUTHS}
    with pytest.raises(TltlError) as raised:
        read_traces([TraceFile("run.csv", b"a,a\ntrue,false\n")], vocabulary_of_columns(kinds))
    (diagnostic,) = raised.value.diagnostics
    assert (diagnostic.code, diagnostic.labels[0].message) == ("TLT0622", "two columns are called `a`")


@pytest.mark.parametrize(
    ("columns_of_traces", "title"),
    [
        (
            {"F": TRUTHS, "then": TRUTHS, "x y": TRUTHS, "speed": SHARES},
            "the columns `F`, `then` and `x y` contain only",
        ),
        ({"F": TRUTHS}, "the column `F` contains only"),
        ({"speed": OTHER}, "no column of the traces contains only"),
        ({}, "no column of the traces contains only"),
    ],
)
def test_the_error_says_why_there_is_no_atom(columns_of_traces: dict[str, ColumnKind], title: str) -> None:
    with pytest.raises(TltlError) as raised:
        vocabulary_of_columns(columns_of_traces)
    (diagnostic,) = raised.value.diagnostics
    assert diagnostic.code == "TLT0760" and diagnostic.title.startswith(title)


def test_columns_that_cannot_be_declared_together_are_left_out() -> None:
    vocabulary = vocabulary_of_columns(
        dict.fromkeys(("s1", "near(s1)", "at(a)", "at(a, b)", "to(a, b)", "a(c)", "b"), TRUTHS)
    )
    assert [atom.name for atom in vocabulary.reader.atoms] == ["s1", "at(a)", "b"]


def test_predicates_are_instantiated_with_the_entities_of_the_traces() -> None:
    columns_of_traces = {"distance(s1)", "distance(exit)", "distance(s2)", "health", "seen", "open(s2)"}
    atoms = names(LIBRARY.replace("near(s1)", "near(s3)").replace("entity exit", "entity exit, s3"), columns_of_traces)
    assert set(atoms) >= {"near(s1)", "near(exit)", "near(s2)", "hurt", "seen", "open(s2)", "health > 0.2"}
    assert not {"near(s3)", "open(exit)", "open(s1)"} & set(atoms)


def test_entities_of_the_traces_are_declared() -> None:
    text = LIBRARY.replace("exclusive near(exit), near(s1)\n", "")
    vocabulary = vocabulary_of_library(
        SourceFile("game.tltl", text), {"distance(s1)", "distance(s2)"}, ResolveOptions()
    )
    assert set(vocabulary.entities) == {"s1", "s2"}
    assert vocabulary.library.text.startswith(text)


@pytest.mark.parametrize("column", ["touch(s1,s2)", "touch (s1, s2)", " touch( s1 , s2 ) "])
def test_blanks_in_a_column_do_not_hide_its_entities(column: str) -> None:
    library = "signal health in [0, 1]\npredicate hurt(x: entity) = 0.5 - health\n"
    vocabulary = vocabulary_of_library(SourceFile("game.tltl", library), {"health", column}, ResolveOptions())
    assert vocabulary.entities == ("s1", "s2")


def test_a_library_with_errors_is_reported() -> None:
    with pytest.raises(TltlError) as raised:
        names("import nonsense\n", {"a"})
    assert raised.value.diagnostics[0].code == "TLT0010"


def test_traces_are_read_as_letters() -> None:
    text = (
        "signal health in [0, 1]\npredicate alive in [-1, 1] = health - 0.1\npredicate well in [-1, 1] = health - 0.9\n"
    )
    vocabulary = vocabulary_of_library(SourceFile("game.tltl", text), {"health"}, ResolveOptions())
    (trace,), notices = read_traces([TraceFile("run.csv", b"health\n0\n0.5\n1.5\n")], vocabulary)
    assert trace.letters == (frozenset(), frozenset({"alive"}), frozenset({"alive", "well"}))
    assert [(notice.code, notice.title[:17]) for notice in notices] == [("TLT0615", "`run.csv`, step 3")]


def test_a_repeated_sample_has_the_same_letter_in_every_trace() -> None:
    text = "signal health in [0, 1]\npredicate alive in [-1, 1] = health - 0.1\n"
    vocabulary = vocabulary_of_library(SourceFile("game.tltl", text), {"health"}, ResolveOptions())
    messages: list[str] = []
    files = [TraceFile(f"{name}.csv", b"health\n0\n0.5\n0\n0.5\n") for name in "ab"]
    traces, _ = read_traces(files, vocabulary, messages.append)
    assert [trace.letters for trace in traces] == [(frozenset(), frozenset({"alive"})) * 2] * 2
    assert messages == ["reading a.csv", "reading b.csv"]


def test_an_error_in_a_step_names_its_trace() -> None:
    text = "signal a: bool\nsignal b: bool\nexclusive a, b\n"
    vocabulary = vocabulary_of_library(SourceFile("game.tltl", text), {"a", "b"}, ResolveOptions())
    with pytest.raises(TltlError, match=r"`two.csv`, step 2: `a` and `b` hold at once"):
        read_traces([TraceFile("one.csv", b"a,b\n0,1\n"), TraceFile("two.csv", b"a,b\n0,1\n1,1\n")], vocabulary)


LIBRARY_WITH_MEMORY = """
signal seen: bool
signal hp in [0, 9]
signal unread in [0, 1]
predicate falling in [-1, 1] = clamp(previous(hp) - hp, -1, 1)
predicate fading in [-1, 1] = clamp(previous(unread) - hp, -1, 1)
spec s { keep times(seen) <= 1  keep seen implies once seen }
"""


def test_atoms_that_remember_the_trace_so_far_are_atoms_if_their_signals_are_columns() -> None:
    # A game may even record a column with the name of a count.
    columns_of_traces = {"seen", "hp", "times(seen)", "previous(hp)", "previous(unread)"}
    assert set(names(LIBRARY_WITH_MEMORY, columns_of_traces)) == {"seen", "falling", "times(seen) > 1", "once seen"}


def test_letters_have_the_atoms_that_remember_the_trace_so_far() -> None:
    vocabulary = vocabulary_of_library(SourceFile("game.tltl", LIBRARY_WITH_MEMORY), {"seen", "hp"}, ResolveOptions())
    data = b"seen,hp\n0,9\n1,9\n0,8\n1,8\n0,8\n"
    traces, _ = read_traces([TraceFile("run.csv", data), TraceFile("again.csv", data)], vocabulary)
    assert traces[0].letters == traces[1].letters
    assert [sorted(letter) for letter in traces[0].letters] == [
        [],
        ["once seen", "seen"],
        ["falling", "once seen"],
        ["once seen", "seen", "times(seen) > 1"],
        ["once seen", "times(seen) > 1"],
    ]
    changed = (*traces[0].letters[:1], frozenset(), *traces[0].letters[2:])
    assert [sorted(letter) for letter in consistent(changed, vocabulary.reader)] == [
        [],
        [],
        ["falling"],
        ["once seen", "seen"],
        ["once seen"],
    ]
