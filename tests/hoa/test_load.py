from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tltlc
from tests.backends.strategies import automata, infinite_automata
from tests.hoa.files import Automaton, some_automaton, written
from tltlc import backends
from tltlc.automaton.fspa import Fspa
from tltlc.comparison import are_equivalent
from tltlc.files import read_source
from tltlc.hoa.load import ImportOptions, load
from tltlc.record import replace
from tltlc.source import SourceFile

EXAMPLE = Path(__file__).parents[2] / "examples" / "cover_and_hide.tltl"
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
    return replace(found, atoms=tuple(replace(atom, name=names[atom.name]) for atom in found.atoms))


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
    assert found.spec_size == fspa.spec_size


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


def test_labels_of_our_own_are_read_in_all_notations() -> None:
    (fspa,) = tltlc.compile_file(EXAMPLE)
    text = backends.emit("hoa", fspa)["cover_and_hide.hoa"]
    assert isinstance(text, str)
    found = imported(text, read_source(EXAMPLE), ImportOptions(level=fspa.level, limit_steps=fspa.limit_steps))
    for name in Fspa.__match_args__:
        if name != "doc":
            assert (name, getattr(found, name)) == (name, getattr(fspa, name))


def _as_artefact(fspa: Fspa) -> Fspa:
    """Written and read, which checks all that is known of an artefact."""
    from tltlc.backends.json import read

    text = backends.emit("json", fspa)[f"{fspa.name}.fspa.json"]
    assert isinstance(text, str)
    return read(text, "x")


def accepts(fspa: Fspa, prefix: Sequence[int], cycle: Sequence[int]) -> bool:
    """Whether an automaton accepts a lasso; letters as of :mod:`tests.hoa.files`."""
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


@settings(max_examples=25, deadline=None)
@given(st.randoms(use_true_random=False))
def test_a_file_does_not_have_to_name_all_states(chance: Random) -> None:
    automaton = some_automaton(chance)
    text = written(automaton, chance).replace("--END--", 'State: 90 "unreached"\n--END--')
    if "States:" not in text:
        assert len(imported(text).states) == len(imported(text.replace('State: 90 "unreached"\n', "")).states)
