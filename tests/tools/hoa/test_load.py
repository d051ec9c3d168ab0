from __future__ import annotations

import re
import tracemalloc
from collections.abc import Sequence
from pathlib import Path
from random import Random

import pytest
from hypothesis import given, settings

import tltlc
from tests.backends.strategies import automata, infinite_automata
from tests.tools.hoa.files import Automaton, Condition, Shape, some_automaton, written
from tltlc import backends
from tltlc.automaton.compare import are_equivalent
from tltlc.automaton.fspa import Fspa, Text
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.files import read_source
from tltlc.tools.hoa.load import ImportOptions, load

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*.tltl"))
SPECS = [spec for path in EXAMPLES for spec in tltlc.compile_file(path)]
EXAMPLE_OF = {spec.name: path for path in EXAMPLES for spec in tltlc.compile_file(path)}
PROPOSITIONS = SourceFile("p.tltl", "signal p0: bool\nsignal p1: bool\n")


def imported(text: str, library: SourceFile = PROPOSITIONS, options: ImportOptions | None = None) -> Fspa:
    fspa, _ = load(SourceFile("x.hoa", text), library, options or ImportOptions())
    return fspa


def library(fspa: Fspa) -> SourceFile:
    """Signals of the names of an automaton's atoms, and its groups of exclusive ones."""
    signals = [f"signal {atom.name}: number in [-1, 1]" for atom in fspa.atoms]
    predicates = [f"predicate {atom.name}_ = {atom.name}" for atom in fspa.atoms]
    groups = [f"exclusive {', '.join(f'{fspa.atoms[each].name}_' for each in group)}" for group in fspa.exclusive]
    return SourceFile("lib.tltl", "\n".join([*signals, *predicates, *groups, ""]))


def again(fspa: Fspa) -> Fspa:
    """The automaton written as HOA and read again."""
    text = backends.emit("hoa", fspa)[f"{fspa.name}.hoa"]
    assert isinstance(text, str)
    options = ImportOptions(atoms={atom.name: f"{atom.name}_" for atom in fspa.atoms})
    found = imported(text, library(fspa), options)
    # The same names, to be compared.
    names = {f"{atom.name}_": atom.name for atom in fspa.atoms}
    return replace(found, atoms=tuple(replace(atom, base=names[atom.name], arguments=()) for atom in found.atoms))


@settings(max_examples=80, deadline=None)
@given(automata())
def test_what_is_written_over_finite_traces_is_read_again(fspa: Fspa) -> None:
    found = again(fspa)
    assert found.semantics == "finite"
    assert are_equivalent(found, fspa)
    assert [replace(state, label=None) for state in found.states] == [
        replace(state, label=None) for state in fspa.states
    ]
    assert [(edge.source, edge.target) for edge in found.edges] == [(edge.source, edge.target) for edge in fspa.edges]
    assert (found.spec_size, found.judge) == (fspa.spec_size, fspa.judge)


@settings(max_examples=80, deadline=None)
@given(infinite_automata())
def test_what_is_written_over_infinite_traces_is_read_again(fspa: Fspa) -> None:
    found = again(fspa)
    assert found.semantics == "infinite"
    assert are_equivalent(found, fspa)
    assert [replace(state, label=None) for state in found.states] == [
        replace(state, label=None) for state in fspa.states
    ]
    assert len(found.acceptance) <= len(fspa.acceptance)
    assert (found.spec_size, found.judge) == (fspa.spec_size, fspa.judge)


def ascii_alone(fspa: Fspa) -> Fspa:
    def plain(text: Text) -> Text:
        return Text(text.ascii, "", "")

    states = tuple(replace(state, label=plain(state.label)) for state in fspa.states)
    return replace(fspa, formula=plain(fspa.formula), states=states)


@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: spec.name)
def test_what_is_written_of_an_example_is_read_again_whole(spec: Fspa) -> None:
    fspa, example = spec, EXAMPLE_OF[spec.name]
    text = backends.emit("hoa", fspa)[f"{fspa.name}.hoa"]
    assert isinstance(text, str)
    found = imported(text, read_source(example))
    # Comparisons have lost their units, so that a label with one is no formula any more.
    if any("<" in atom.name or ">" in atom.name for atom in fspa.atoms):
        fspa, found = ascii_alone(fspa), ascii_alone(found)
    for name in Fspa.__match_args__:
        if name not in ("doc", "tags"):
            assert (name, getattr(found, name)) == (name, getattr(fspa, name))


def _as_artefact(fspa: Fspa) -> Fspa:
    """Written and read, which checks all that is known of an artefact."""
    from tltlc.backends.json import read

    text = backends.emit("json", fspa)[f"{fspa.name}.fspa.json"]
    assert isinstance(text, str)
    return read(text, "x")


def accepts(fspa: Fspa, prefix: Sequence[int], cycle: Sequence[int]) -> bool:
    """Whether an automaton accepts a lasso; letters as of :mod:`tests.tools.hoa.files`."""
    marks = fspa.marks()
    place = {atom.name: index for index, atom in enumerate(fspa.atoms)}

    def taken(state: int, letter: int) -> int:
        holds = {place[f"p{atom}"]: bool(letter >> atom & 1) for atom in range(len(fspa.atoms))}
        (index,) = [
            index
            for index, edge in enumerate(fspa.edges)
            if edge.source == state and any(all(holds[a] == yes for a, yes in prime) for prime in edge.guard.primes)
        ]
        return index

    state = 0
    for letter in prefix:
        state = fspa.edges[taken(state, letter)].target
    seen: dict[int, int] = {}
    rounds: list[list[int]] = []
    while state not in seen:
        seen[state] = len(rounds)
        edges = []
        for letter in cycle:
            edges.append(taken(state, letter))
            state = fspa.edges[edges[-1]].target
        rounds.append(edges)
    met = {mark for edges in rounds[seen[state] :] for edge in edges for mark in marks[edge]}
    return any((pair, "inf") in met and (pair, "fin") not in met for pair in range(len(fspa.acceptance)))


def lassos(automaton: Automaton, chance: Random) -> list[tuple[list[int], list[int]]]:
    def word(least: int, most: int) -> list[int]:
        return [chance.randrange(2**automaton.atoms) for _ in range(chance.randint(least, most))]

    return [(word(0, 4), word(1, 6)) for _ in range(25)]


@pytest.mark.parametrize("seed", range(150))
def test_any_acceptance_and_any_style_is_read(seed: int) -> None:
    chance = Random(seed)
    automaton = some_automaton(chance)
    found = imported(written(automaton, chance))
    assert _as_artefact(found) == found
    for prefix, cycle in lassos(automaton, chance):
        assert accepts(found, prefix, cycle) == automaton.accepts(prefix, cycle)


@pytest.mark.parametrize("seed", range(10))
def test_states_that_are_not_reached_are_left_out(seed: int) -> None:
    text = re.sub("States:.*\n", "", written(some_automaton(Random(seed)), Random(seed)))
    assert imported(text.replace("--END--", 'State: 90 "unreached"\n--END--')) == imported(text)


def rabin(pairs: int) -> Condition:
    return ("or", *(("and", ("fin", 2 * pair), ("inf", 2 * pair + 1)) for pair in range(pairs)))


def streett(pairs: int) -> Condition:
    return ("and", *(("or", ("fin", 2 * pair), ("inf", 2 * pair + 1)) for pair in range(pairs)))


def parity(colours: int) -> Condition:
    """``parity max even``."""
    found: Condition = ("inf", 0)
    for colour in range(1, colours):
        found = ("and", ("fin", colour), found) if colour % 2 else ("or", ("inf", colour), found)
    return found


def generalized_rabin(pairs: int, infs: int) -> Condition:
    terms = []
    for pair in range(pairs):
        first = pair * (infs + 1)
        terms.append(("and", ("fin", first), *(("inf", first + 1 + place) for place in range(infs))))
    return ("or", *terms)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("condition", "sets", "largest"),
    [
        (("inf", 0), 1, 6),
        (("fin", 0), 1, 6),
        (rabin(3), 6, 6),
        (parity(6), 6, 6),
        (("and", ("inf", 0), ("inf", 1), ("inf", 2)), 3, 18),
        (streett(4), 8, 6 * 24),
        (generalized_rabin(4, 3), 16, 6 * 3**4),
    ],
    ids=["buchi", "co-buchi", "rabin", "parity", "generalized-buchi", "streett", "generalized-rabin"],
)
def test_named_acceptances_keep_the_states_as_far_as_they_can(
    condition: Condition, sets: int, largest: int, seed: int
) -> None:
    chance = Random(seed)
    automaton = some_automaton(chance, Shape(atoms=2, states=6, sets=sets, condition=condition))
    found = imported(written(automaton, chance))
    assert len(found.states) <= largest
    for prefix, cycle in lassos(automaton, chance):
        assert accepts(found, prefix, cycle) == automaton.accepts(prefix, cycle)


def test_a_state_that_becomes_several_is_counted() -> None:
    text = """HOA: v1 Start: 0 AP: 2 "p0" "p1" Acceptance: 2 Inf(0)&Inf(1)
    --BODY-- State: 0 "both" [0&!1] 0 {0} [!0&1] 0 {1} [!0&!1] 0 [0&1] 0 {0 1} --END--"""
    assert [state.label.ascii for state in imported(text).states] == ["both (1 of 2)", "both (2 of 2)"]


@pytest.mark.parametrize("name", ["a=b", "x==1", "", "X", "q > 2", "p0 p1"])
def test_any_name_can_be_given_a_predicate(name: str) -> None:
    text = f'HOA: v1 Start: 0 AP: 1 "{name}" Acceptance: 0 t --BODY-- State: 0 [0] 0 [!0] 0 --END--'
    key, _, value = f"{name}=p1".partition("=")
    assert [atom.name for atom in imported(text, options=ImportOptions({key: value})).atoms] == ["p1"]
    with pytest.raises(tltlc.TltlError) as error:
        imported(text)
    assert all(f'`--atom "{name}=…"`' in str(each.help) for each in error.value.diagnostics)


def test_a_library_in_error_is_told_and_nothing_else() -> None:
    text = 'HOA: v1 Start: 0 AP: 1 "a" Acceptance: 0 t --BODY-- State: 0 [0] 0 [!0] 0 --END--'
    with pytest.raises(tltlc.TltlError) as error:
        imported(text, SourceFile("lib.tltl", "signal a: boool\n"))
    assert {each.labels[0].source.name for each in error.value.diagnostics} == {"lib.tltl"}


def test_what_takes_too_much_work_is_refused() -> None:
    automaton = some_automaton(Random(1), Shape(atoms=2, states=6, sets=16, condition=generalized_rabin(4, 3)))
    with pytest.raises(tltlc.TltlError, match="is too large, or its acceptance"):
        imported(written(automaton, Random(1)), options=ImportOptions(work=300))
    with pytest.raises(tltlc.TltlError, match="needs more than 3 states"):
        imported(written(automaton, Random(1)), options=ImportOptions(state_budget=3))


def test_too_many_prime_implicants_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.automaton.guards.PRIME_LIMIT", 1)
    text = 'HOA: v1 Start: 0 AP: 2 "p0" "p1" Acceptance: 0 t --BODY-- State: 0 [0&!1 | !0&1] 0 [0&1 | !0&!1] 1'
    with pytest.raises(tltlc.TltlError, match="TLT0502"):
        imported(f"{text} State: 1 [t] 1 --END--")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Start: 99999999999999999999", "this number is too large"),
        ('Start: 0 Tltlc-semantics: "infinite"', 'the only value of this header is `"finite"`'),
        ("Start: 0 tltlc-judge: later", "this header says `goal` or `limit`"),
        ("Start: 0 tltlc-limit: 0", "this header says a number of steps"),
        ('Start: 0 AP: 15000 "p0"', "`AP:` says 15000, and 1 name follows"),
    ],
)
def test_headers_that_are_wrong(text: str, message: str) -> None:
    with pytest.raises(tltlc.TltlError, match=re.escape(message)):
        imported(f"HOA: v1 {text} Acceptance: 0 t --BODY-- State: 0 [t] 0 --END--")


@pytest.mark.slow
def test_letters_of_many_atoms_are_not_counted() -> None:
    names = " ".join(f'"p{place}"' for place in range(15_000))
    library = SourceFile("p.tltl", "\n".join(f"signal p{place}: bool" for place in range(15_000)))
    with pytest.raises(tltlc.TltlError, match=r"has 1 edge without labels, for 2\^15000 letters"):
        imported(f"HOA: v1 Start: 0 AP: 15000 {names} Acceptance: 0 t --BODY-- State: 0 0 --END--", library)


def test_every_terminal_has_words_for_messages() -> None:
    from tltlc.tools.hoa import reader

    patterns = [each.name for each in reader._parser().terminals if each.pattern.type == "re"]
    assert set(patterns) - {"__IGNORE_0"} <= set(reader._NAMES)


def test_the_messages_on_many_names_take_linear_memory_and_name_their_places() -> None:
    count = 3_000
    names = " ".join(f'"n{number}"' for number in range(count))
    head = f"HOA: v1\nStates: 1\nStart: 0\nAP: {count} {names}\nAcceptance: 1 Inf(0)\n"
    source = SourceFile("x.hoa", f"{head}--BODY--\nState: 0\n[t] 0 {{0}}\n--END--\n")
    tracemalloc.start()
    try:
        with pytest.raises(TltlError) as raised:
            load(source, PROPOSITIONS, ImportOptions())
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert most < 30_000_000
    labels = [message.labels[0] for message in raised.value.diagnostics]
    assert [label.source for label in labels] == [source] * count
    assert [source.slice(label.span) for label in labels] == [f"n{number}" for number in range(count)]
