"""Counterexamples where none were recorded: traces that a mutation has made wrong, most likely.

Without something to tell apart every formula that holds is as good as another.  A spec that fits the traces because of
what happened in them, and in that order, rejects them once they are cut short, put in another order, or broken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from random import Random
from typing import Final

from tltlc.automaton.compare import Letter
from tltlc.tools.mine.evidence import Evidence, Recorded

_SEED: Final = 1
_ROUNDS: Final = 10
"""At least so many times a trace is mutated: few traces several times each."""

Run = tuple[Letter, int]
"""A letter and at how many samples in a row it stands."""


def with_mutants(traces: Sequence[Recorded]) -> Evidence:
    """The traces with made-up counterexamples: the same ones each time, in whatever order the traces come.

    Of each trace: one that ends before an atom came to hold for the last time; one with its stretches of equal samples
    in another order, and one with two of them swapped; one in which an atom never holds that did; and one in which an
    atom that holds throughout all traces does not, once.
    """
    random = Random(_SEED)
    good = {trace.letters for trace in traces}
    kept = _throughout(traces)
    found: dict[tuple[Letter, ...], Recorded] = {}
    ordered = sorted(traces, key=lambda trace: ([sorted(letter) for letter in trace.letters], trace.name))
    for number in range(max(len(ordered), _ROUNDS)):
        trace = ordered[number % len(ordered)]
        for kind, letters in _mutants(trace.letters, kept, number, random):
            if letters and letters not in good and letters not in found:
                found[letters] = Recorded(f"{trace.name}, {kind}", letters)
    return Evidence(tuple(traces), tuple(found.values()), made_up=True)


def _throughout(traces: Sequence[Recorded]) -> list[str]:
    """The atoms that hold at every sample of every trace."""
    every = frozenset.intersection(*(letter for trace in traces for letter in trace.letters))
    return sorted(every)


def _mutants(
    letters: tuple[Letter, ...], kept: Sequence[str], number: int, random: Random
) -> Iterator[tuple[str, tuple[Letter, ...]]]:
    yield "cut short", letters[: _last_rise(letters)]
    runs: list[Run] = [(letter, len(list(group))) for letter, group in groupby(letters)]
    yield "in another order", _samples(random.sample(runs, len(runs)))
    if len(runs) > 1:
        one, other = random.sample(range(len(runs)), 2)
        swapped = list(runs)
        swapped[one], swapped[other] = runs[other], runs[one]
        yield "with two stretches swapped", _samples(swapped)
    passing = sorted({name for letter in letters for name in letter}.difference(kept))
    if passing:
        name = passing[number % len(passing)]
        yield f"without {name}", tuple(letter - {name} for letter in letters)
    if kept:
        name, place = kept[number % len(kept)], random.randrange(len(letters))
        broken = (*letters[:place], letters[place] - {name}, *letters[place + 1 :])
        yield f"with {name} broken", broken


def _samples(runs: Sequence[Run]) -> tuple[Letter, ...]:
    return tuple(letter for letter, times in runs for _ in range(times))


def _last_rise(letters: Sequence[Letter]) -> int:
    """The last sample at which an atom holds that did not hold at the one before; 0 where there is none."""
    rises = [place for place in range(1, len(letters)) if letters[place] - letters[place - 1]]
    return rises[-1] if rises else 0
