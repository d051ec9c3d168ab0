"""Make traces in which a spec is planted: random walks on its automaton that accept, fail or nearly accept."""

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
_USUAL_PROBABILITY: Final = 0.15
"""The probability that an atom holds at a sample, unless the spec needs another one."""
_CANDIDATES: Final = 4
_CONTINUES: Final = 0.7
_SHORTEST, _LONGEST = 8, 35


@dataclass(frozen=True)
class PlantedSpec:
    """A spec, given by its clauses, and for each atom the probability that it holds at a sample."""

    name: str
    clauses: tuple[str, ...]
    probabilities: Mapping[str, float]

    @property
    def source(self) -> str:
        signals = "".join(f"signal {atom}: bool\n" for atom in self.probabilities)
        return f"{signals}spec planted {{\n" + "".join(f"    {clause}\n" for clause in self.clauses) + "}\n"

    def automaton(self) -> Fspa:
        return compile_source(SourceFile("planted.tltl", self.source)).automata[0]


def paper_specs() -> tuple[PlantedSpec, ...]:
    """Return the paper's three plans, with atoms that are signals of type bool instead of predicates."""
    usual = dict.fromkeys(("s1", "s2", "exit"), _USUAL_PROBABILITY)
    ends = dict.fromkeys(("e_right", "e_left"), _USUAL_PROBABILITY) | dict.fromkeys(("open_right", "open_left"), 0.4)
    alive = {"alive": 0.985, "seen": 0.3}
    either = "((open_right and e_right) or (open_left and e_left))"
    return (
        PlantedSpec("navigation", ("reach s1 then s2 then exit",), {**usual, "seen": 0.3}),
        PlantedSpec("cover_and_hide", ("reach s1 then s2 then exit", "keep alive"), {**usual, **alive}),
        PlantedSpec(
            "branching",
            (f"reach s1 then s2 then s3 then {either}", "keep alive"),
            {**dict.fromkeys(("s1", "s2", "s3"), _USUAL_PROBABILITY), **ends, **alive},
        ),
    )


def random_spec(number: int) -> PlantedSpec:
    """Return a random spec; the same number gives the same spec."""
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
    probabilities = dict.fromkeys(ATOMS, _USUAL_PROBABILITY)
    probabilities[c] = {"sequence, keep": 0.98, "sequence, avoid": 0.03}.get(kind, _USUAL_PROBABILITY)
    return PlantedSpec(f"{number:02} {kind}", kinds[kind], probabilities)


def evidence(spec: PlantedSpec, traces: int, counterexamples: int, seed: int, noise: float = 0.0) -> Evidence:
    """Return traces that satisfy a spec and counterexamples that violate it; equal seeds give equal traces.

    Half of the counterexamples are walks that fail. The others are near misses: good traces with one
    change. ``noise`` is the share of the traces that is exchanged with as many counterexamples.
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
        near_miss = _changed_trace(random.choice(good), tuple(spec.probabilities), random)
        if near_miss and not walker.accepts(near_miss):
            bad.append(near_miss)
    wrong = round(noise * traces)
    good[:wrong], bad[:wrong] = bad[:wrong], good[:wrong]
    return Evidence(_labelled_traces("good", good), _labelled_traces("bad", bad))


def _labelled_traces(name: str, walks: Sequence[tuple[Letter, ...]]) -> tuple[LabelledTrace, ...]:
    return tuple(LabelledTrace(f"{name} {number}", walk) for number, walk in enumerate(walks, start=1))


class _Walker:
    """Walks on the automaton of a spec; caches the targets of letters."""

    def __init__(self, spec: PlantedSpec) -> None:
        self._probabilities = spec.probabilities
        self._fspa = spec.automaton()
        self._targets: dict[tuple[int, Letter], int] = {}

    def accepts(self, letters: Sequence[Letter]) -> bool:
        state = 0
        for letter in letters:
            state = self._target(state, letter)
        return self._fspa.states[state].accepting

    def walk(self, random: Random, *, steered: bool) -> tuple[Letter, ...]:
        """Return the letters of a random walk, which often ends soon after it has reached an accepting state.

        A ``steered`` walk often draws a few letters and takes the one that leads nearest to the goal.
        """
        state = 0
        letters: list[Letter] = []
        for number in range(random.randint(_SHORTEST, _LONGEST)):
            letter = self._draw_letter(state, random, steered=steered)
            state = self._target(state, letter)
            letters.append(letter)
            if self._fspa.states[state].accepting and number >= _SHORTEST and random.random() > _CONTINUES:
                break
        return tuple(letters)

    def _draw_letter(self, state: int, random: Random, *, steered: bool) -> Letter:
        count = _CANDIDATES if steered and random.random() < 0.5 else 1
        while True:
            letters = [self._letter(random) for _ in range(count)]
            best = min(letters, key=lambda letter: self._rank(state, letter))
            # A steered walk never enters a trap.
            if not steered or self._rank(state, best)[0] is False:
                return best

    def _letter(self, random: Random) -> Letter:
        return frozenset(atom for atom, probability in self._probabilities.items() if random.random() < probability)

    def _target(self, state: int, letter: Letter) -> int:
        target = self._targets.get((state, letter))
        if target is None:
            values = [1.0 if atom.name in letter else -1.0 for atom in self._fspa.atoms]
            edges = self._fspa.edges_from(state)
            target = self._targets[state, letter] = next(edge.target for edge in edges if holds(edge.guard, values))
        return target

    def _rank(self, state: int, letter: Letter) -> tuple[bool, int]:
        """Return the sort key of a letter: letters that lead nearer to the goal come first, those into traps last."""
        distance = self._fspa.states[self._target(state, letter)].distance
        return distance is None, distance or 0


def _changed_trace(letters: tuple[Letter, ...], atoms: Sequence[str], random: Random) -> tuple[Letter, ...]:
    """Change a trace once: cut it, remove an atom, flip an atom at one sample, or swap two samples."""
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
