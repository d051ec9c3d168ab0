"""Generate counterexamples if none were recorded: mutated traces that are most likely wrong.

Without counterexamples, every formula that holds is as good as any other. A spec that captures what
happened in the traces, and in which order, rejects them once they are cut short, reordered, or
broken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from random import Random
from typing import Final

from tltlc.automaton.compare import Letter
from tltlc.tools.mine.evidence import Evidence, LabelledTrace

_SEED: Final = 1
_ROUNDS: Final = 10
"""The least number of mutation rounds: if there are few traces, each is mutated several times."""

Run = tuple[Letter, int]
"""A letter and the number of samples in a row at which it holds."""


def with_mutants(traces: Sequence[LabelledTrace]) -> Evidence:
    """Return the traces with generated counterexamples, the same ones for any order of the traces.

    Each trace is mutated in these ways: it is cut before the last sample at which an atom becomes
    true; its stretches of equal samples are reordered; two of them are swapped; an atom that held
    somewhere never holds; an atom that holds throughout all traces fails once.
    """
    random = Random(_SEED)
    good = {trace.letters for trace in traces}
    throughout = _throughout(traces)
    mutants: dict[tuple[Letter, ...], LabelledTrace] = {}
    ordered = sorted(traces, key=lambda trace: ([sorted(letter) for letter in trace.letters], trace.name))
    for number in range(max(len(ordered), _ROUNDS)):
        trace = ordered[number % len(ordered)]
        for kind, letters in _mutants(trace.letters, throughout, number, random):
            if letters and letters not in good and letters not in mutants:
                mutants[letters] = LabelledTrace(f"{trace.name}, {kind}", letters)
    return Evidence(tuple(traces), tuple(mutants.values()), made_up=True)


def _throughout(traces: Sequence[LabelledTrace]) -> list[str]:
    """Return the atoms that hold at every sample of every trace."""
    every = frozenset.intersection(*(letter for trace in traces for letter in trace.letters))
    return sorted(every)


def _mutants(
    letters: tuple[Letter, ...], throughout: Sequence[str], number: int, random: Random
) -> Iterator[tuple[str, tuple[Letter, ...]]]:
    yield "cut short", letters[: _last_rise(letters)]
    runs: list[Run] = [(letter, len(list(group))) for letter, group in groupby(letters)]
    yield "in another order", _samples(random.sample(runs, len(runs)))
    if len(runs) > 1:
        one, other = random.sample(range(len(runs)), 2)
        swapped = list(runs)
        swapped[one], swapped[other] = runs[other], runs[one]
        yield "with two stretches swapped", _samples(swapped)
    passing = sorted({name for letter in letters for name in letter}.difference(throughout))
    if passing:
        name = passing[number % len(passing)]
        yield f"without {name}", tuple(letter - {name} for letter in letters)
    if throughout:
        name, place = throughout[number % len(throughout)], random.randrange(len(letters))
        broken = (*letters[:place], letters[place] - {name}, *letters[place + 1 :])
        yield f"with {name} broken", broken


def _samples(runs: Sequence[Run]) -> tuple[Letter, ...]:
    return tuple(letter for letter, times in runs for _ in range(times))


def _last_rise(letters: Sequence[Letter]) -> int:
    """Return the last sample at which an atom becomes true; 0 if there is none."""
    rises = [place for place in range(1, len(letters)) if letters[place] - letters[place - 1]]
    return rises[-1] if rises else 0
