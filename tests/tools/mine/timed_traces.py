"""Generated traces with a known rule about times or counts, and traces without one."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from tltlc.automaton.compare import Letter
from tltlc.core.record import replace
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.mutants import with_mutants

CLOCK_S = 0.1
OTHERS = ("p", "q", "r")
_BEGINS, _STAYS = 0.1, 0.6

Tracks = dict[str, list[bool]]
"""The truth of each atom at each sample of a trace."""
Rule = Callable[[Random, int], Tracks]
"""Returns the atoms `a` and `b` of a trace with at most this many samples, such that a rule holds."""


def answers(shortest: int, longest: int) -> Rule:
    """Each a is followed by a b after ``shortest`` to ``longest`` steps."""

    def rule(random: Random, length: int) -> Tracks:
        tracks = _never(length, "a", "b")
        place = random.randint(0, 20)
        while place + longest < length:
            tracks["a"][place] = True
            place += random.randint(shortest, longest)
            tracks["b"][place] = True
            place += random.randint(1, 30)
        return tracks

    return rule


def once_in_time(shortest: int, longest: int) -> Rule:
    """The first a is followed by a b after ``shortest`` to ``longest`` steps, and then no further b comes."""

    def rule(random: Random, length: int) -> Tracks:
        tracks = _never(length, "a", "b")
        place = random.randint(0, length - longest - 1)
        tracks["a"][place] = True
        tracks["b"][place + random.randint(shortest, longest)] = True
        for later in range(place + longest + 1, length):
            tracks["a"][later] = random.random() < 0.02
        return tracks

    return rule


def counted(most: int) -> Rule:
    """a comes at most ``most`` times, early in the trace; b comes at random."""

    def rule(random: Random, length: int) -> Tracks:
        tracks = _never(length, "a")
        place = 0
        for _ in range(random.randint(most - 1, most)):
            place += random.randint(2, 10)
            tracks["a"][place] = True
        return tracks | _walk(random, length, "b")

    return rule


def held(shortest: int, longest: int) -> Rule:
    """a holds for ``shortest`` to ``longest`` samples at a time; b holds at random."""

    def rule(random: Random, length: int) -> Tracks:
        tracks = _never(length, "a")
        place = random.randint(1, 10)
        while place < length:
            samples = random.randint(shortest, longest)
            for sample in range(place, min(place + samples, length)):
                tracks["a"][sample] = True
            place += samples + random.randint(1, 30)
        return tracks | _walk(random, length, "b")

    return rule


def stays(shortest: int, longest: int) -> Rule:
    """a holds once for ``shortest`` to ``longest`` samples, and else for short times at random; so does b."""

    def rule(random: Random, length: int) -> Tracks:
        tracks = _walk(random, length, "a", "b")
        samples = random.randint(shortest, longest)
        place = random.randint(0, length - samples)
        tracks["a"][place : place + samples] = [True] * samples
        return tracks

    return rule


def at_random(random: Random, length: int) -> Tracks:
    """a and b begin and end at random, independently of each other."""
    return _walk(random, length, "a", "b")


def in_order(random: Random, length: int) -> Tracks:
    """a comes at random, then b comes at random after the first a."""
    tracks = _never(length, "a", "b")
    for place in range(length):
        tracks["b"][place] = any(tracks["a"]) and random.random() < 0.05
        tracks["a"][place] = random.random() < 0.05
    return tracks


def timed_evidence(rule: Rule, seed: int, traces: int = 30, shortest: int = 60, longest: int = 150) -> Evidence:
    """Return traces with the atoms of a rule and other atoms at random, and made-up counterexamples."""
    random = Random(seed)
    recorded = []
    for number in range(traces):
        length = random.randint(shortest, longest)
        recorded.append(LabelledTrace(f"t{number}", letters(rule(random, length) | _walk(random, length, *OTHERS))))
    return replace(with_mutants(recorded), clock_s=CLOCK_S)


def letters(tracks: Tracks) -> tuple[Letter, ...]:
    """Return the letters of a trace."""
    return tuple(
        frozenset(name for name, holds in zip(tracks, sample, strict=True) if holds)
        for sample in zip(*tracks.values(), strict=True)
    )


def _never(length: int, *names: str) -> Tracks:
    return {name: [False] * length for name in names}


def _walk(random: Random, length: int, *names: str) -> Tracks:
    tracks = _never(length, *names)
    for track in tracks.values():
        holds = False
        for place in range(length):
            holds = random.random() < (_STAYS if holds else _BEGINS)
            track[place] = holds
    return tracks
