"""Traces with a spec planted in them: random walks on its automaton, good ones, failed ones and near misses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Final

from tltlc.automaton.compare import Letter
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.monitor.guards import holds
from tltlc.pipeline import compile_source
from tltlc.tools.mine.evidence import Evidence, LabelledTrace

ATOMS: Final = tuple(f"p{number}" for number in range(8))
_OFTEN: Final = 0.15
"""How likely an atom holds at a sample, unless the spec wants otherwise."""
_CANDIDATES: Final = 4
_GOES_ON: Final = 0.7
_SHORTEST, _LONGEST = 8, 35


@dataclass(frozen=True)
class Planted:
    """A spec as its clauses, and how likely each of the atoms holds at a sample."""

    name: str
    clauses: tuple[str, ...]
    likely: Mapping[str, float]

    @property
    def source(self) -> str:
        signals = "".join(f"signal {atom}: bool\n" for atom in self.likely)
        return f"{signals}spec planted {{\n" + "".join(f"    {clause}\n" for clause in self.clauses) + "}\n"

    def automaton(self) -> Fspa:
        return compile_source(SourceFile("planted.tltl", self.source)).automata[0]


def of_the_paper() -> tuple[Planted, ...]:
    """The paper's three plans over free atoms."""
    usual = dict.fromkeys(("s1", "s2", "exit"), _OFTEN)
    ends = dict.fromkeys(("e_right", "e_left"), _OFTEN) | dict.fromkeys(("open_right", "open_left"), 0.4)
    alive = {"alive": 0.985, "seen": 0.3}
    either = "((open_right and e_right) or (open_left and e_left))"
    return (
        Planted("navigation", ("reach s1 then s2 then exit",), {**usual, "seen": 0.3}),
        Planted("cover_and_hide", ("reach s1 then s2 then exit", "keep alive"), {**usual, **alive}),
        Planted(
            "branching",
            (f"reach s1 then s2 then s3 then {either}", "keep alive"),
            {**dict.fromkeys(("s1", "s2", "s3"), _OFTEN), **ends, **alive},
        ),
    )


def planted(number: int) -> Planted:
    """A random spec, the same one for the same number."""
    random = Random(number)
    a, b, c, *others = random.sample(ATOMS, len(ATOMS))
    steps = random.sample((a, b, *others), random.randint(2, 6))
    reach = "reach " + " then ".join(steps)
    kinds = {
        "sequence": (reach,),
        "sequence, keep": (reach, f"keep {c}"),
        "sequence, avoid": (reach, f"avoid {c}"),
        "response": (f"reach {c}", f"require always ({a} implies eventually {b})"),
        "bounded response": (f"require always ({a} implies eventually within 3 steps {b})",),
        "precedence": (f"reach {c}", f"require (not {b}) weak_until {a}"),
        "until": (f"require (not {b}) until {a}",),
        "choice": (f"reach {a} then ({b} or {c})",),
        "invariant": (f"reach {c}", f"keep {a} implies {b}"),
        "two sequences": (f"reach {a} then {b}", f"reach {c} then {others[0]}"),
    }
    kind = list(kinds)[number % len(kinds)]
    likely = dict.fromkeys(ATOMS, _OFTEN)
    likely[c] = {"sequence, keep": 0.98, "sequence, avoid": 0.03}.get(kind, _OFTEN)
    return Planted(f"{number:02} {kind}", kinds[kind], likely)


def evidence(spec: Planted, traces: int, counterexamples: int, seed: int, noise: float = 0.0) -> Evidence:
    """So many traces that satisfy the spec and such that violate it; the same ones for the same seed.

    Half of the counterexamples are walks that fail, the others near misses: good traces with one change.  ``noise`` is
    the share of the traces that changes sides with as many counterexamples.
    """
    walker, random = _Walker(spec), Random(seed)
    good: list[tuple[Letter, ...]] = []
    while len(good) < traces:
        walk = walker.walk(random, steered=True)
        if walker.accepts(walk):
            good.append(walk)
    bad: list[tuple[Letter, ...]] = []
    for _ in range(50 * counterexamples):
        if len(bad) < counterexamples // 2:
            walk = walker.walk(random, steered=False)
            if not walker.accepts(walk):
                bad.append(walk)
    while len(bad) < counterexamples:
        missed = _changed(random.choice(good), tuple(spec.likely), random)
        if missed and not walker.accepts(missed):
            bad.append(missed)
    wrong = round(noise * traces)
    good[:wrong], bad[:wrong] = bad[:wrong], good[:wrong]
    return Evidence(_recorded("good", good), _recorded("bad", bad))


def _recorded(name: str, walks: Sequence[tuple[Letter, ...]]) -> tuple[LabelledTrace, ...]:
    return tuple(LabelledTrace(f"{name} {number}", walk) for number, walk in enumerate(walks, start=1))


class _Walker:
    """Walks on the automaton of a spec; remembers where letters lead."""

    def __init__(self, spec: Planted) -> None:
        self._likely = spec.likely
        self._fspa = spec.automaton()
        self._known: dict[tuple[int, Letter], int] = {}

    def accepts(self, letters: Sequence[Letter]) -> bool:
        state = 0
        for letter in letters:
            state = self._target(state, letter)
        return self._fspa.states[state].accepting

    def walk(self, random: Random, *, steered: bool) -> tuple[Letter, ...]:
        """Random letters; half of those of a steered walk are the best of a few.  It ends soon after the goal."""
        state = 0
        letters: list[Letter] = []
        for number in range(random.randint(_SHORTEST, _LONGEST)):
            letter = self._drawn(state, random, steered=steered)
            state = self._target(state, letter)
            letters.append(letter)
            if self._fspa.states[state].accepting and number >= _SHORTEST and random.random() > _GOES_ON:
                break
        return tuple(letters)

    def _drawn(self, state: int, random: Random, *, steered: bool) -> Letter:
        several = _CANDIDATES if steered and random.random() < 0.5 else 1
        while True:
            drawn = [self._letter(random) for _ in range(several)]
            best = min(drawn, key=lambda each: self._rank(state, each))
            # A steered walk never falls into a trap by chance alone.
            if not steered or self._rank(state, best)[0] is False:
                return best

    def _letter(self, random: Random) -> Letter:
        return frozenset(atom for atom, likely in self._likely.items() if random.random() < likely)

    def _target(self, state: int, letter: Letter) -> int:
        found = self._known.get((state, letter))
        if found is None:
            values = [1.0 if atom.name in letter else -1.0 for atom in self._fspa.atoms]
            edges = self._fspa.edges_from(state)
            found = self._known[state, letter] = next(edge.target for edge in edges if holds(edge.guard, values))
        return found

    def _rank(self, state: int, letter: Letter) -> tuple[bool, int]:
        """Nearer to the goal before farther, traps last."""
        distance = self._fspa.states[self._target(state, letter)].distance
        return distance is None, distance or 0


def _changed(letters: tuple[Letter, ...], atoms: Sequence[str], random: Random) -> tuple[Letter, ...]:
    """A trace with one change: cut, without an atom, with one atom at one sample turned, with two samples swapped."""
    here, there, atom = random.randrange(len(letters)), random.randrange(len(letters)), random.choice(atoms)
    changed = list(letters)
    match random.randrange(4):
        case 0:
            changed = changed[:here]
        case 1:
            changed = [letter - {atom} for letter in changed]
        case 2:
            changed[here] = changed[here] ^ {atom}
        case _:
            changed[here], changed[there] = changed[there], changed[here]
    return tuple(changed)
