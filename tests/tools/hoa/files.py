"""Random automata, and their HOA files in different styles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from random import Random
from typing import Any

Condition = tuple[Any, ...]
"""``("fin", set)`` or ``("inf", set)``, each with an optional ``"outside"``; ``("and", …)``,
``("or", …)`` or ``("t",)``."""
Letter = int
"""Bit i is set if atom i holds."""


@dataclass
class Automaton:
    """An automaton with acceptance sets on edges and states.

    ``moves`` has, for each state and letter, the target and the acceptance sets of the edge.
    ``of_states`` has the acceptance sets of each state.
    """

    atoms: int
    sets: int
    condition: Condition
    moves: list[list[tuple[int, frozenset[int]]]]
    of_states: list[frozenset[int]]

    def accepts(self, prefix: Sequence[Letter], cycle: Sequence[Letter]) -> bool:
        """Whether the run on ``prefix`` followed by ``cycle`` for ever is accepted."""
        state = 0
        for letter in prefix:
            state, _ = self.moves[state][letter]
        first_round: dict[int, int] = {}
        rounds: list[list[frozenset[int]]] = []
        while state not in first_round:
            first_round[state] = len(rounds)
            round_sets: list[frozenset[int]] = []
            for letter in cycle:
                target, sets = self.moves[state][letter]
                round_sets.append(sets | self.of_states[state])
                state = target
            rounds.append(round_sets)
        taken = [sets for round_sets in rounds[first_round[state] :] for sets in round_sets]
        return self._holds(self.condition, taken)

    def _holds(self, condition: Condition, taken: list[frozenset[int]]) -> bool:
        op, *rest = condition
        if op == "t":
            return True
        if op in ("and", "or"):
            return (all if op == "and" else any)(self._holds(part, taken) for part in rest)
        number, outside = rest[0], rest[1:] == ["outside"]
        met = any((number in sets) != outside for sets in taken)
        return bool(met == (op == "inf"))


@dataclass
class Shape:
    """The numbers of atoms, states and sets of a random automaton, and its acceptance condition."""

    atoms: int
    states: int
    sets: int
    condition: Condition


def random_automaton(chance: Random, shape: Shape | None = None) -> Automaton:
    """Return a deterministic, complete automaton. Without a shape, its size and condition are random."""
    atoms, states, sets = chance.randint(0, 2), chance.randint(1, 5), chance.randint(0, 3)
    if shape is not None:
        atoms, states, sets = shape.atoms, shape.states, shape.sets

    def random_sets(likely: float) -> frozenset[int]:
        return frozenset(number for number in range(sets) if chance.random() < likely)

    def condition(depth: int) -> Condition:
        if not sets or chance.random() < 0.05:
            return ("t",)
        if not depth or chance.random() < 0.3:
            kind = chance.choice(("fin", "inf"))
            return (kind, chance.randrange(sets), *(["outside"] if chance.random() < 0.3 else []))
        return (chance.choice(("and", "or")), *(condition(depth - 1) for _ in range(chance.randint(2, 3))))

    of_edges, of_states = chance.choice(((0.3, 0.0), (0.0, 0.4), (0.2, 0.2)))
    moves = [[(chance.randrange(states), random_sets(of_edges)) for _ in range(2**atoms)] for _ in range(states)]
    return Automaton(
        atoms, sets, shape.condition if shape else condition(2), moves, [random_sets(of_states) for _ in range(states)]
    )


def hoa_text(automaton: Automaton, chance: Random) -> str:
    """Return the text of a HOA file of the automaton, in a random style."""
    lines = ["HOA: v1", *([f"States: {len(automaton.moves)}"] if chance.random() < 0.7 else []), "Start: 0"]
    lines.append(" ".join([f"AP: {automaton.atoms}", *(f'"p{atom}"' for atom in range(automaton.atoms))]))
    if automaton.atoms:
        lines += ["Alias: @first 0", "Alias: @not-first !@first"]
    lines.append(f"Acceptance: {automaton.sets} {_condition(automaton.condition)}")
    lines += ['tool: "some" "1.0"', "properties: deterministic", "owner: me 3 t", "--BODY-- /* the /* body */ */"]
    for state, moves in enumerate(automaton.moves):
        one_target = len(set(moves)) == 1 and chance.random() < 0.5
        label = "[t] " if one_target else ""
        name = f' "q\\"{state}\\""' if chance.random() < 0.5 else ""
        lines.append(f"State: {label}{state}{name}{_sets(automaton.of_states[state])}")
        if one_target:
            lines.append(f"{moves[0][0]}{_sets(moves[0][1])}")
        elif chance.random() < 0.4:
            lines += [f"{target}{_sets(sets)}" for target, sets in moves]
        else:
            lines += _labelled_edges(automaton, moves, chance)
    return "\n".join([*lines, "--END--", ""])


def _labelled_edges(automaton: Automaton, moves: list[tuple[int, frozenset[int]]], chance: Random) -> list[str]:
    """Return an edge for each letter, or one edge for all letters with the same move."""
    groups: dict[Any, list[int]] = {}
    together = chance.random() < 0.5
    for letter, move in enumerate(moves):
        groups.setdefault(move if together else (move, letter), []).append(letter)
    return [
        f"[{' | '.join(_letter(letter, automaton.atoms) for letter in letters)}]"
        f" {moves[letters[0]][0]}{_sets(moves[letters[0]][1])}"
        for letters in groups.values()
    ]


def _letter(letter: int, atoms: int) -> str:
    names = [
        "@first" if letter & 1 else "@not-first",
        *(f"{'' if letter >> i & 1 else '!'}{i}" for i in range(1, atoms)),
    ]
    return "&".join(names[:atoms]) or "t"


def _sets(sets: frozenset[int]) -> str:
    return f" {{{' '.join(map(str, sorted(sets)))}}}" if sets else ""


def _condition(condition: Condition) -> str:
    op, *rest = condition
    if op == "t":
        return "t"
    if op in ("and", "or"):
        return f"({(' & ' if op == 'and' else '|').join(map(_condition, rest))})"
    return f"{op.capitalize()}({'!' if rest[1:] else ''}{rest[0]})"
