"""Automata survive export to HOA and import, and HOA files in any style can be imported."""

from __future__ import annotations

import re
import tracemalloc
from collections.abc import Sequence
from pathlib import Path
from random import Random

import pytest
from hypothesis import given

import tltlc
from tests.backends.strategies import automata, infinite_automata
from tests.fuzzing import times
from tests.tools.hoa.files import Automaton, Condition, Shape, hoa_text, random_automaton
from tltlc import backends
from tltlc.automaton.compare import are_equivalent
from tltlc.automaton.fspa import Fspa, Text
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.files import read_source
from tltlc.logic.formula import Formula
from tltlc.tools.hoa.load import ImportOptions, load

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*.tltl"))
PROPOSITIONS = SourceFile("p.tltl", "signal p0: bool\nsignal p1: bool\n")


def import_text(text: str, library: SourceFile = PROPOSITIONS, options: ImportOptions | None = None) -> Fspa:
    fspa, _ = load(SourceFile("x.hoa", text), library, options or ImportOptions())
    return fspa


def library(fspa: Fspa) -> SourceFile:
    """Return a library with a predicate for each atom of the automaton, and its exclusive groups."""
    signals = [f"signal {atom.name}: number in [-1, 1]" for atom in fspa.atoms]
    predicates = [f"predicate {atom.name}_ = {atom.name}" for atom in fspa.atoms]
    groups = [f"exclusive {', '.join(f'{fspa.atoms[index].name}_' for index in group)}" for group in fspa.exclusive]
    return SourceFile("lib.tltl", "\n".join([*signals, *predicates, *groups, ""]))


def reimport(fspa: Fspa) -> Fspa:
    """Write an automaton as HOA, and read it back."""
    text = backends.emit("hoa", fspa)[f"{fspa.name}.hoa"]
    assert isinstance(text, str)
    options = ImportOptions(atoms={atom.name: f"{atom.name}_" for atom in fspa.atoms})
    automaton = import_text(text, library(fspa), options)
    # Restore the names of the atoms, so that the automata can be compared.
    names = {f"{atom.name}_": atom.name for atom in fspa.atoms}
    return replace(
        automaton, atoms=tuple(replace(atom, base=names[atom.name], arguments=()) for atom in automaton.atoms)
    )


@times(30)
@given(automata())
def test_a_finite_automaton_survives_export_and_import(fspa: Fspa) -> None:
    reimported = reimport(fspa)
    assert reimported.semantics == "finite"
    assert are_equivalent(reimported, fspa)
    assert [replace(state, label=None) for state in reimported.states] == [
        replace(state, label=None) for state in fspa.states
    ]
    assert [(edge.source, edge.target) for edge in reimported.edges] == [
        (edge.source, edge.target) for edge in fspa.edges
    ]
    assert (reimported.spec_size, reimported.judge) == (fspa.spec_size, fspa.judge)


@times(30)
@given(infinite_automata())
def test_an_infinite_automaton_survives_export_and_import(fspa: Fspa) -> None:
    reimported = reimport(fspa)
    assert reimported.semantics == "infinite"
    assert are_equivalent(reimported, fspa)
    assert [replace(state, label=None) for state in reimported.states] == [
        replace(state, label=None) for state in fspa.states
    ]
    assert len(reimported.acceptance) <= len(fspa.acceptance)
    assert (reimported.spec_size, reimported.judge) == (fspa.spec_size, fspa.judge)


def with_ascii_labels(fspa: Fspa) -> Fspa:
    def plain(label: Formula | Text) -> Text:
        return Text(str(label), "", "")

    states = tuple(replace(state, label=plain(state.label)) for state in fspa.states)
    return replace(fspa, formula=plain(fspa.formula), states=states)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_an_example_survives_export_and_import(example: Path) -> None:
    specs = tltlc.compile_file(example)
    assert specs
    for spec in specs:
        if not spec.registers:  # The names of timers are no formulas that can be read again.
            _check_export_and_import(spec, example)


def _check_export_and_import(fspa: Fspa, example: Path) -> None:
    text = backends.emit("hoa", fspa)[f"{fspa.name}.hoa"]
    assert isinstance(text, str)
    reimported = import_text(text, read_source(example))
    # The format knows no clauses.
    fspa = replace(fspa, clauses=(), edges=tuple(replace(edge, broken=()) for edge in fspa.edges))
    # The file names comparisons without their units, so a label with a comparison can no longer be parsed as
    # a formula.
    if any("<" in atom.name or ">" in atom.name for atom in fspa.atoms):
        fspa, reimported = with_ascii_labels(fspa), with_ascii_labels(reimported)
    for name in Fspa.__match_args__:
        if name not in ("doc", "tags"):
            assert (name, getattr(reimported, name)) == (name, getattr(fspa, name))


def _as_artefact(fspa: Fspa) -> Fspa:
    """Write an automaton as an artefact, and read it back. Reading checks the invariants."""
    from tltlc.artefact.decode import read

    text = backends.emit("json", fspa)[f"{fspa.name}.fspa.json"]
    assert isinstance(text, str)
    return read(SourceFile("x", text))


def accepts(fspa: Fspa, prefix: Sequence[int], cycle: Sequence[int]) -> bool:
    """Whether an automaton accepts a lasso; letters are as in :mod:`tests.tools.hoa.files`."""
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
    first_round: dict[int, int] = {}
    rounds: list[list[int]] = []
    while state not in first_round:
        first_round[state] = len(rounds)
        edges = []
        for letter in cycle:
            edges.append(taken(state, letter))
            state = fspa.edges[edges[-1]].target
        rounds.append(edges)
    met = {mark for edges in rounds[first_round[state] :] for edge in edges for mark in marks[edge]}
    return any((pair, "inf") in met and (pair, "fin") not in met for pair in range(len(fspa.acceptance)))


def lassos(automaton: Automaton, chance: Random) -> list[tuple[list[int], list[int]]]:
    def word(least: int, most: int) -> list[int]:
        return [chance.randrange(2**automaton.atoms) for _ in range(chance.randint(least, most))]

    return [(word(0, 4), word(1, 6)) for _ in range(25)]


@pytest.mark.parametrize("seed", range(150))
def test_any_acceptance_and_any_style_can_be_imported(seed: int) -> None:
    chance = Random(seed)
    automaton = random_automaton(chance)
    fspa = import_text(hoa_text(automaton, chance))
    assert _as_artefact(fspa) == fspa
    for prefix, cycle in lassos(automaton, chance):
        assert accepts(fspa, prefix, cycle) == automaton.accepts(prefix, cycle)


@pytest.mark.parametrize("seed", range(10))
def test_unreachable_states_are_left_out(seed: int) -> None:
    text = re.sub("States:.*\n", "", hoa_text(random_automaton(Random(seed)), Random(seed)))
    assert import_text(text.replace("--END--", 'State: 90 "unreached"\n--END--')) == import_text(text)


def rabin(pairs: int) -> Condition:
    return ("or", *(("and", ("fin", 2 * pair), ("inf", 2 * pair + 1)) for pair in range(pairs)))


def streett(pairs: int) -> Condition:
    return ("and", *(("or", ("fin", 2 * pair), ("inf", 2 * pair + 1)) for pair in range(pairs)))


def parity(colours: int) -> Condition:
    """Return the acceptance condition ``parity max even``."""
    condition: Condition = ("inf", 0)
    for colour in range(1, colours):
        condition = ("and", ("fin", colour), condition) if colour % 2 else ("or", ("inf", colour), condition)
    return condition


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
def test_named_acceptances_bound_the_number_of_states(condition: Condition, sets: int, largest: int, seed: int) -> None:
    chance = Random(seed)
    automaton = random_automaton(chance, Shape(atoms=2, states=6, sets=sets, condition=condition))
    fspa = import_text(hoa_text(automaton, chance))
    assert len(fspa.states) <= largest
    for prefix, cycle in lassos(automaton, chance):
        assert accepts(fspa, prefix, cycle) == automaton.accepts(prefix, cycle)


def test_copies_of_a_state_are_numbered() -> None:
    text = """HOA: v1 Start: 0 AP: 2 "p0" "p1" Acceptance: 2 Inf(0)&Inf(1)
    --BODY-- State: 0 "both" [0&!1] 0 {0} [!0&1] 0 {1} [!0&!1] 0 [0&1] 0 {0 1} --END--"""
    assert [str(state.label) for state in import_text(text).states] == ["both (1 of 2)", "both (2 of 2)"]


@pytest.mark.parametrize("name", ["a=b", "x==1", "", "X", "q > 2", "p0 p1"])
def test_an_atom_of_any_name_can_be_mapped_to_a_predicate(name: str) -> None:
    text = f'HOA: v1 Start: 0 AP: 1 "{name}" Acceptance: 0 t --BODY-- State: 0 [0] 0 [!0] 0 --END--'
    key, _, value = f"{name}=p1".partition("=")
    assert [atom.name for atom in import_text(text, options=ImportOptions({key: value})).atoms] == ["p1"]
    with pytest.raises(tltlc.TltlError) as error:
        import_text(text)
    assert all(f'`--atom "{name}=…"`' in str(diagnostic.help) for diagnostic in error.value.diagnostics)


def test_only_errors_of_the_library_are_reported_if_it_has_any() -> None:
    text = 'HOA: v1 Start: 0 AP: 1 "a" Acceptance: 0 t --BODY-- State: 0 [0] 0 [!0] 0 --END--'
    with pytest.raises(tltlc.TltlError) as error:
        import_text(text, SourceFile("lib.tltl", "signal a: boool\n"))
    assert {diagnostic.labels[0].source.name for diagnostic in error.value.diagnostics} == {"lib.tltl"}


def test_automata_over_the_limits_are_rejected() -> None:
    automaton = random_automaton(Random(1), Shape(atoms=2, states=6, sets=16, condition=generalized_rabin(4, 3)))
    with pytest.raises(tltlc.TltlError, match="is too large, or its acceptance"):
        import_text(hoa_text(automaton, Random(1)), options=ImportOptions(work=300))
    with pytest.raises(tltlc.TltlError, match="needs more than 3 states"):
        import_text(hoa_text(automaton, Random(1)), options=ImportOptions(state_budget=3))


def test_too_many_prime_implicants_are_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.automaton.guards.PRIME_LIMIT", 1)
    text = 'HOA: v1 Start: 0 AP: 2 "p0" "p1" Acceptance: 0 t --BODY-- State: 0 [0&!1 | !0&1] 0 [0&1 | !0&!1] 1'
    with pytest.raises(tltlc.TltlError, match="TLT0502"):
        import_text(f"{text} State: 1 [t] 1 --END--")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Start: 99999999999999999999", "this number is too large"),
        ('Start: 0 Tltlc-semantics: "infinite"', 'the only value of this header is `"finite"`'),
        ("Start: 0 tltlc-judge: later", "this header must be `goal` or `limit`"),
        ("Start: 0 tltlc-limit: 0", "this header must be a number of steps"),
        ('Start: 0 AP: 15000 "p0"', "`AP:` says 15000, but 1 name follows"),
    ],
)
def test_wrong_headers_are_reported(text: str, message: str) -> None:
    with pytest.raises(tltlc.TltlError, match=re.escape(message)):
        import_text(f"HOA: v1 {text} Acceptance: 0 t --BODY-- State: 0 [t] 0 --END--")


@pytest.mark.slow
def test_letters_of_many_atoms_are_not_enumerated() -> None:
    names = " ".join(f'"p{place}"' for place in range(15_000))
    library = SourceFile("p.tltl", "\n".join(f"signal p{place}: bool" for place in range(15_000)))
    with pytest.raises(tltlc.TltlError, match=r"has 1 edge without labels, but there are 2\^15000 letters"):
        import_text(f"HOA: v1 Start: 0 AP: 15000 {names} Acceptance: 0 t --BODY-- State: 0 0 --END--", library)


def test_every_terminal_has_a_name_for_messages() -> None:
    from tltlc.tools.hoa import reader

    patterns = [terminal.name for terminal in reader._parser().terminals if terminal.pattern.type == "re"]
    assert set(patterns) - {"__IGNORE_0"} <= set(reader._NAMES)


def test_errors_for_many_names_take_linear_memory_and_point_at_each_name() -> None:
    count = 3_000
    names = " ".join(f'"n{number}"' for number in range(count))
    head = f"HOA: v1\nStates: 1\nStart: 0\nAP: {count} {names}\nAcceptance: 1 Inf(0)\n"
    source = SourceFile("x.hoa", f"{head}--BODY--\nState: 0\n[t] 0 {{0}}\n--END--\n")
    tracemalloc.start()
    try:
        with pytest.raises(TltlError) as raised:
            load(source, PROPOSITIONS, ImportOptions())
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 30_000_000
    labels = [message.labels[0] for message in raised.value.diagnostics]
    assert [label.source for label in labels] == [source] * count
    assert [source.slice(label.span) for label in labels] == [f"n{number}" for number in range(count)]
