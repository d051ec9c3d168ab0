"""Generate counterexamples if none were recorded: mutations of traces, most of which should be rejected.

Without counterexamples, all formulas that hold in the traces would have the same score. A spec that
captures what happens in the traces, and in which order, rejects traces that are cut short, reordered
or broken.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby, pairwise
from random import Random
from typing import Final

from tltlc.automaton.compare import Letter
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.witness.step_lengths import atoms_of

_SEED: Final = 1
_ROUNDS: Final = 10
"""The least number of rounds. Each round mutates one trace in each of the ways in :func:`with_mutants`.

If there are fewer traces than rounds, traces are mutated more than once.
"""

Letters = tuple[Letter, ...]
Run = tuple[Letter, int]
"""A letter, and the number of consecutive samples that have it."""


def _unchanged(letters: Letters) -> Letters:
    return letters


def with_mutants(traces: Sequence[LabelledTrace], consistent: Callable[[Letters], Letters] = _unchanged) -> Evidence:
    """Return evidence with these traces, and with counterexamples that are generated from them.

    ``consistent`` corrects the atoms that follow from others. A trace is mutated in these ways:

    - it is cut before the last sample at which an atom becomes true;
    - its runs of equal samples are shuffled;
    - two of these runs are swapped;
    - an atom that holds at some of its samples never holds;
    - an atom that holds at every sample of all traces fails at one sample;
    - one of its runs takes longer, by the length of the trace;
    - an atom that comes and goes comes again, as often as it comes in any trace.

    A mutation that equals a trace is left out. The counterexamples are the same in every run, and do
    not depend on the order of ``traces``.
    """
    random = Random(_SEED)
    good = {trace.letters for trace in traces}
    throughout = _throughout(traces)
    most = _most_rises(traces)
    mutants: dict[Letters, LabelledTrace] = {}
    ordered = sorted(traces, key=lambda trace: ([sorted(letter) for letter in trace.letters], trace.name))
    for number in range(max(len(ordered), _ROUNDS)):
        trace = ordered[number % len(ordered)]
        for kind, mutant in _mutants(trace.letters, throughout, most, number, random):
            letters = consistent(mutant)
            if letters and letters not in good and letters not in mutants:
                mutants[letters] = LabelledTrace(f"{trace.name}, {kind}", letters)
    return Evidence(tuple(traces), tuple(mutants.values()), made_up=True)


def _throughout(traces: Sequence[LabelledTrace]) -> list[str]:
    """Return the atoms that hold at every sample of every trace, sorted."""
    return sorted(frozenset.intersection(*(atoms_of(letter) for trace in traces for letter in trace.letters)))


def _mutants(
    letters: Letters, throughout: Sequence[str], most: Mapping[str, int], number: int, random: Random
) -> Iterator[tuple[str, Letters]]:
    yield "cut short", letters[: _last_rise(letters)]
    runs: list[Run] = [(letter, len(list(group))) for letter, group in groupby(letters)]
    yield "in another order", _samples(random.sample(runs, len(runs)))
    if len(runs) > 1:
        first, second = random.sample(range(len(runs)), 2)
        swapped = list(runs)
        swapped[first], swapped[second] = runs[second], runs[first]
        yield "with two stretches swapped", _samples(swapped)
    passing = sorted({name for letter in letters for name in atoms_of(letter)}.difference(throughout))
    if passing:
        name = passing[number % len(passing)]
        yield f"without {name}", tuple(letter - {name} for letter in letters)
    if throughout:
        name, place = throughout[number % len(throughout)], random.randrange(len(letters))
        broken = (*letters[:place], letters[place] - {name}, *letters[place + 1 :])
        yield f"with {name} broken", broken
    place = random.randrange(len(runs))
    letter, times = runs[place]
    yield "with a longer stretch", _samples([*runs[:place], (letter, times + len(letters)), *runs[place + 1 :]])
    if passing:
        name = passing[number % len(passing)]
        last = max(place for place, letter in enumerate(letters) if name in letter)
        again = (letters[last] - {name}, letters[last]) * most[name]
        yield f"with {name} again", (*letters[: last + 1], *again, *letters[last + 1 :])


def _most_rises(traces: Sequence[LabelledTrace]) -> dict[str, int]:
    """Return the most times that each atom begins to hold in a trace."""
    most: dict[str, int] = {}
    for trace in traces:
        letters = [frozenset(), *map(atoms_of, trace.letters)]
        rises = Counter(name for before, letter in pairwise(letters) for name in letter - before)
        most |= {name: max(number, most.get(name, 0)) for name, number in rises.items()}
    return most


def _samples(runs: Sequence[Run]) -> Letters:
    return tuple(letter for letter, times in runs for _ in range(times))


def _last_rise(letters: Sequence[Letter]) -> int:
    """Return the index of the last sample at which an atom becomes true; 0 if no atom does."""
    rises = [place for place in range(1, len(letters)) if atoms_of(letters[place]) - letters[place - 1]]
    return rises[-1] if rises else 0
