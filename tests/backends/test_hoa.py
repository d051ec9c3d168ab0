from __future__ import annotations

import itertools
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.automaton.letters import Letter, holds, letters, named
from tests.backends.hoa_reader import Hoa, read
from tests.backends.strategies import EXCLUSIVE, automata, hostile_automata, hostile_texts
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tltlc import __version__, backends, compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Edge, Fspa, Guard, Pair, Text
from tltlc.automaton.infinite.build import build_infinite
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.automaton.transitions import TransitionDiagrams
from tltlc.backends import hoa
from tltlc.backends.drawing.texts import escape_invisible
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import Limit
from tltlc.logic import oracle
from tltlc.logic.formula import FALSE
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import Session
from tltlc.resolve.spec import Spec

INFINITE = """
signal a: bool
signal b: bool
signal alive: bool
/// If a comes again and again, b does, too.
spec fair { semantics infinite  require (G F a -> G F b) and G alive }
"""


def hoa_text(fspa: Fspa) -> str:
    text = backends.emit("hoa", fspa)[f"{fspa.name}.hoa"]
    assert isinstance(text, str)
    return text


def check(fspa: Fspa) -> Hoa:
    """Assert that the file is valid and agrees with the automaton letter by letter; return the parsed file."""
    text = hoa_text(fspa)
    parsed = read(text)
    infinite = fspa.semantics == "infinite"
    assert text.startswith("HOA: v1\n")
    assert all(escape_invisible(line) == line for line in text.split("\n"))
    assert parsed.starts == [0]
    assert parsed.atoms == [atom.name for atom in fspa.atoms]
    assert [parsed.states[state.id].name for state in fspa.states] == [str(state.label) for state in fspa.states]
    assert parsed.count == len(parsed.states) == len(fspa.states)
    assert parsed.strings["name:"] == [fspa.name]
    assert parsed.strings["tool:"] == ["tltlc", __version__]
    # The only own header that begins with a capital, and so must be understood, states the semantics.
    capital = {name: values for name, values in parsed.strings.items() if name[0].isupper()}
    assert capital == ({} if infinite else {"Tltlc-semantics:": ["finite"]})
    pairs = range(len(fspa.acceptance))
    terms = [f"Fin({2 * pair})&Inf({2 * pair + 1})" for pair in pairs]
    canonical = {0: "f", 1: "".join(terms)}.get(len(terms), "|".join(f"({term})" for term in terms))
    expected = (f"Rabin {len(terms)}", 2 * len(terms), canonical) if infinite else ("Buchi", 1, "Inf(0)")
    assert (parsed.acceptance_name, parsed.sets, parsed.acceptance) == expected
    same_letters(fspa, parsed)
    return parsed


def same_letters(fspa: Fspa, parsed: Hoa) -> None:
    """Assert that each letter has the same target and marks in both, and that impossible letters have no edge."""
    infinite, allowed = fspa.semantics == "infinite", set(letters(fspa))
    all_letters = list(itertools.product((False, True), repeat=len(fspa.atoms)))
    sets = [frozenset[int]() for _ in fspa.edges]
    for index, pair in enumerate(fspa.acceptance):
        for number, edges in ((2 * index, pair.fin), (2 * index + 1, pair.inf)):
            for position in edges:
                sets[position] |= {number}
    for state in fspa.states:
        hoa_state = parsed.states[state.id]
        leaving = [(edge, marks) for edge, marks in zip(fspa.edges, sets, strict=True) if edge.source == state.id]
        assert len(hoa_state.edges) == len(leaving)
        assert hoa_state.sets == ({0} if not infinite and state.accepting else set())
        for letter in all_letters:
            expected = [(edge.target, marks | hoa_state.sets) for edge, marks in leaving if holds(edge, letter)]
            assert parsed.edges_taken(state.id, letter) == (expected if letter in allowed else [])
            assert len(expected) == 1 or letter not in allowed
    complete = ["complete"] if len(all_letters) == len(allowed) else []
    marks = "trans-acc" if infinite else "state-acc"
    assert parsed.properties == ["trans-labels", "explicit-labels", marks, "deterministic", *complete]


@st.composite
def specs(draw: st.DrawFn, semantics: str, most: int) -> Spec:
    """Specs of random formulas, some with exclusive atoms."""
    formula = draw(formulas(max_leaves=most))
    groups = draw(st.lists(st.sampled_from(EXCLUSIVE), max_size=2, unique=True))
    fitting = [group for group in groups if set(group) <= set(formula.atoms())]
    return replace(spec_from_formula(formula, exclusive=fitting), semantics=semantics)


def words(fspa: Fspa, least: int = 0) -> st.SearchStrategy[list[Letter]]:
    return st.lists(st.sampled_from(letters(fspa)), min_size=least, max_size=4)


def test_an_automaton_over_infinite_traces_has_marks_on_edges() -> None:
    (fspa,) = compile_text(INFINITE)
    assert hoa_text(fspa) == (
        "HOA: v1\n"
        f'tool: "tltlc" "{__version__}"\n'
        'name: "fair"\n'
        "/* If a comes again and again, b does, too. */\n"
        "States: 2\n"
        "Start: 0\n"
        'AP: 3 "a" "b" "alive"\n'
        "acc-name: Rabin 2\n"
        "Acceptance: 4 (Fin(0)&Inf(1))|(Fin(2)&Inf(3))\n"
        'tltlc-formula: "(G F a -> G F b) & G alive"\n'
        "tltlc-judge: limit\n"
        "properties: trans-labels explicit-labels trans-acc deterministic complete\n"
        "--BODY--\n"
        'State: 0 "(G F a -> G F b) & G alive"\n'
        "[1 & 2] 0 {1}\n"
        "[0 & !1 & 2] 0 {2}\n"
        "[!0 & !1 & 2] 0 {3}\n"
        "[!2] 1\n"
        'State: 1 "false"\n'
        "[t] 1\n"
        "--END--\n"
    )
    check(fspa)


def test_an_automaton_over_finite_traces_has_marks_on_states() -> None:
    text = hoa_text(cover_and_hide())
    assert "Alias: @allowed !(0&1) & !(0&2) & !(1&2)\n" in text
    assert "acc-name: Buchi\nAcceptance: 1 Inf(0)\n" in text
    assert "properties: trans-labels explicit-labels state-acc deterministic\n" in text
    assert 'Tltlc-semantics: "finite"\n/* A finite trace is accepted if its run ends ' in text
    assert 'State: 4 "G alive" {0}\n[@allowed & !3] 2\n[@allowed & 3] 4\n--END--\n' in text
    check(cover_and_hide())


@times(25)
@given(specs("infinite", 5), st.data())
def test_over_infinite_traces_the_file_accepts_the_lassos_of_the_formula(spec: Spec, data: st.DataObject) -> None:
    fspa = build_infinite(spec)
    parsed = check(fspa)
    for _ in range(10):
        prefix, cycle = data.draw(words(fspa)), data.draw(words(fspa, 1))
        expected = holds_on_lasso(spec.formula, named(fspa, prefix), named(fspa, cycle))
        assert parsed.accepts_lasso(prefix, cycle) == expected


@times(25)
@given(specs("finite", 6), st.data())
def test_over_finite_traces_the_last_state_accepts_the_traces_of_the_formula(spec: Spec, data: st.DataObject) -> None:
    fspa = build(spec)
    parsed = check(fspa)
    for _ in range(10):
        trace = data.draw(words(fspa, 1))
        last = parsed.run(trace)
        assert last is not None
        assert (parsed.states[last].sets == {0}) == oracle.holds(spec.formula, named(fspa, trace))


@pytest.mark.parametrize(
    ("formula", "name", "acceptance"),
    [("a and not a", "Rabin 0", "f"), ("a or not a", "Rabin 1", "Fin(0)&Inf(1)")],
)
def test_unsatisfiable_and_valid_formulas_have_this_acceptance(formula: str, name: str, acceptance: str) -> None:
    (fspa,) = compile_text(f"signal a: bool spec constant {{ semantics infinite  require {formula} }}")
    parsed = check(fspa)
    assert (parsed.acceptance_name, parsed.acceptance) == (name, acceptance)


def test_a_trace_with_an_impossible_letter_is_rejected() -> None:
    (fspa,) = compile_text(
        "signal a: bool signal b: bool exclusive a, b spec one { semantics infinite  require G F a or G F b }"
    )
    parsed = check(fspa)
    both, first = (True, True), (True, False)
    assert parsed.accepts_lasso([], [first])
    assert not parsed.accepts_lasso([both], [first])
    assert not parsed.accepts_lasso([first], [both, first])


def test_an_edge_can_be_in_many_sets() -> None:
    (fspa,) = compile_text("signal a: bool spec again { semantics infinite  require G F a }")
    fspa = replace(fspa, acceptance=(Pair((), (1,)), Pair((0,), (1,)), Pair((1, 1), (0,))))
    # A set that contains an edge twice is written once.
    assert "[!0] 0 {2 5}\n[0] 0 {1 3 4}\n" in hoa_text(fspa)
    check(fspa)


def test_labels_come_from_the_primes_not_from_the_text() -> None:
    fspa = cover_and_hide()
    text = Text("t] 0 [t", "t] 0 [t", "t] 0 [t")
    misleading = replace(fspa, edges=tuple(replace(edge, guard=Guard(text, edge.guard.primes)) for edge in fspa.edges))
    assert hoa_text(misleading) == hoa_text(fspa)


@settings(max_examples=40, deadline=None)
@given(automata())
def test_a_guard_too_large_for_a_short_label_is_the_sum_of_its_primes(fspa: Fspa) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hoa, "TransitionDiagrams", lambda: TransitionDiagrams(steps=0))
        parsed = read(hoa_text(replace(fspa, exclusive=())))
    for state, letter in itertools.product(fspa.states, itertools.product((False, True), repeat=len(fspa.atoms))):
        expected = [edge.target for edge in fspa.edges_from(state.id) if holds(edge, letter)]
        assert [target for target, _ in parsed.edges_taken(state.id, letter)] == expected


def test_an_edge_that_no_letter_takes_has_a_false_label() -> None:
    fspa = cover_and_hide()
    at = [(edge.source, edge.target) for edge in fspa.edges].index((2, 2))
    edges = (*fspa.edges[:at], Edge(2, 0, Guard(FALSE, ())), *fspa.edges[at:])
    assert "[@allowed & f] 0\n[@allowed] 2\n" in hoa_text(replace(fspa, edges=edges))
    assert "[f] 0\n[t] 2\n" in hoa_text(replace(fspa, edges=edges, exclusive=()))


@times(40)
@given(hostile_automata(), hostile_texts, st.booleans())
def test_hostile_texts_stay_texts(fspa: Fspa, doc: str, infinite: bool) -> None:
    if infinite:
        fspa = replace(fspa, semantics="infinite", acceptance=(Pair((0,), (11,)),))
    parsed = check(replace(fspa, doc=doc))
    assert len(parsed.comments) == 1 + (not infinite) + bool(doc.strip())


def test_invisible_characters_are_escaped_as_in_c() -> None:
    names = ["\ud800", "\\ud800", "\U000e0001", "\u200b\n"]
    pairs = zip(cover_and_hide().atoms, names, strict=True)
    atoms = tuple(replace(atom, base=name, arguments=()) for atom, name in pairs)
    fspa = replace(cover_and_hide(), atoms=atoms, doc="\ud800")
    assert r'AP: 4 "\ud800" "\\ud800" "\U000e0001" "\u200b\u000a"' in hoa_text(fspa)
    hoa_text(fspa).encode()
    check(fspa)


@pytest.mark.parametrize(
    "doc", ["*/", "/*", "/*/", "*/*", "**/", "//**", "/" * 9 + "*" * 9 + "/", "a*\n/b", "*/ --END-- /*", "*", "/", '"']
)
def test_a_comment_ends_where_it_should(doc: str) -> None:
    comment, *rest = check(replace(cover_and_hide(), doc=doc)).comments
    assert len(rest) == 2
    assert comment[2:-2].split() and not {"/*", "*/"} & {comment[2:-2][at : at + 2] for at in range(len(comment))}
    assert "".join(comment[2:-2].split()) == "".join(doc.split())


GOOD = """HOA: v1 /* nested /* comments */ */ States: 2 Start: 0 name: "it \\" stays"
AP: 2 "a" "b" Alias: @x !(0&1) | f acc-name: Rabin 1 Acceptance: 2 Fin(0)&Inf(1) properties: deterministic
--BODY-- State: 0 "q" [@x & !0] 0 {0} [!(@x & !0)] 1 State: 1 {1} [t] 1 --END--"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("--END--", ""),
        ("--END--", "--END-- more"),
        ("HOA: v1", "HOA: v2"),
        ("Acceptance: 2 Fin(0)&Inf(1)", ""),
        ("Start: 0", "Start: 2"),
        ("Start: 0", "Start: 00"),
        ("States: 2", "States: 3"),
        ("States: 2", "States: 2 States: 2"),
        ("AP: 2", "AP: 3"),
        ('"b"', '"a"'),
        ("[@x & !0]", "[@y & !0]"),
        ("[@x & !0]", "[@x & !2]"),
        ("[@x & !0]", "[@x & -> 0]"),
        ("[@x & !0]", "@x & !0"),
        ("{0}", "{2}"),
        ("{0}", "{0"),
        ("] 1 State", "] 7 State"),
        ("State: 1", "State: 0"),
        ('\\" stays', '" stays'),
        ("comments */ */", "comments */"),
        ("nested /*", "nested"),
        ("Inf(1)", "Inf(1"),
        ("Inf(1)", "Sup(1)"),
    ],
)
def test_the_reader_is_strict(old: str, new: str) -> None:
    read(GOOD)
    assert old in GOOD
    with pytest.raises((ValueError, KeyError)):
        read(GOOD.replace(old, new, 1))


def test_the_reader_decides_lassos() -> None:
    parsed = read(GOOD)
    assert parsed.accepts_lasso([(True, True)], [(False, False)])
    assert not parsed.accepts_lasso([], [(False, False)])
    assert parsed.strings["name:"] == ['it " stays']
    assert parsed.run([(False, True)]) == 0


def test_a_file_that_could_not_be_imported_again_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    (text,) = backends.emit("hoa", cover_and_hide()).values()
    assert isinstance(text, str)
    monkeypatch.setattr("tltlc.artefact.size.ARTEFACT", Limit(len(text.encode())))
    assert backends.emit("hoa", cover_and_hide()) == {"cover_and_hide.hoa": text}
    monkeypatch.setattr("tltlc.artefact.size.ARTEFACT", Limit(len(text.encode()) - 1))
    with pytest.raises(TltlError) as caught:
        backends.emit("hoa", cover_and_hide())
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["TLT0004"]


@pytest.mark.parametrize(
    "clause",
    [
        "keep times(a) <= 2",
        "keep a implies once b",
        "keep x >= previous(x)",
        # Without its timer this spec would be too large, too; shorter bounds alone would not help.
        "keep begins a implies eventually within 1000000 steps b",
    ],
)
def test_a_spec_with_other_memory_is_refused(clause: str) -> None:
    session = Session(
        SourceFile("s.tltl", f"signal a: bool\nsignal b: bool\nsignal x in [0, 1]\nspec s {{ {clause} }}")
    )
    for options in (backends.Options(), backends.Options(without_timers=session.without_timers)):
        with pytest.raises(TltlError) as caught:
            backends.emit("hoa", session.automata[0], options)
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.code == "TLT0713"
        assert diagnostic.help == "leave out the target `hoa`, or state the rule without this memory"


TIMED = "clock 16 Hz\nsignal p: bool\nsignal q: bool\nspec timed { keep p implies eventually within 5 s q }"


def test_states_take_the_place_of_timers() -> None:
    session = Session(SourceFile("timed.tltl", TIMED))
    (fspa,) = session.automata
    assert fspa.registers
    text = backends.emit("hoa", fspa, backends.Options(without_timers=session.without_timers))["timed.hoa"]
    parsed = read(str(text))
    assert parsed.atoms == ["p", "q"]
    assert len(parsed.states) > 80
    random, accepted = Random(1), set()
    for _ in range(100):
        monitor, state, share = Monitor(fspa), 0, random.choice((0.003, 0.02, 0.1))
        for _ in range(300):
            letter = (random.random() < 0.05, random.random() < share)
            ((state, _),) = parsed.edges_taken(state, letter)
            is_accepted = monitor.step({"p": float(letter[0]), "q": float(letter[1])}).accepting
            assert (parsed.states[state].sets == {0}) == is_accepted
            accepted.add(is_accepted)
    assert accepted == {False, True}


def test_timers_of_other_specs_stay() -> None:
    session = Session(SourceFile("timed.tltl", f"{TIMED}\nspec huge {{ keep p implies eventually within 3 h q }}"))
    fspa, _ = session.automata
    assert not session.without_timers("timed").registers
    text = backends.emit("hoa", fspa, backends.Options(without_timers=session.without_timers))["timed.hoa"]
    assert len(read(str(text)).states) > 80


@pytest.mark.parametrize(
    ("clause", "help_"),
    [
        ("keep a implies eventually within 5 s b", hoa.FIXED_CLOCK),
        ("reach a then within 5 s b", hoa.FIXED_CLOCK),
        ("reach always for 3 s b", hoa.FIXED_CLOCK),
        ("require always for 3 s b", hoa.FIXED_CLOCK),
        # Without a bound, a fixed clock would not help.
        ("keep time_holding(b) <= 3 s", hoa.OTHER_MEMORY),
    ],
)
def test_times_on_a_clock_that_varies_are_refused(clause: str, help_: str) -> None:
    text = f"clock varies\nsignal a: bool\nsignal b: bool\nspec s {{ {clause} }}"
    session = Session(SourceFile("s.tltl", text))
    for options in (backends.Options(), backends.Options(without_timers=session.without_timers)):
        with pytest.raises(TltlError) as caught:
            backends.emit("hoa", session.automata[0], options)
        (diagnostic,) = caught.value.diagnostics
        assert (diagnostic.code, diagnostic.help) == ("TLT0713", help_)


def test_an_artefact_with_timers_is_refused() -> None:
    (fspa,) = compile_text(TIMED)
    with pytest.raises(TltlError) as caught:
        backends.emit("hoa", fspa)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0713"
    assert diagnostic.help == "compile the .tltl file: then states take the place of timers"
