"""Compute how robustly guards hold, and which edges automata take, for N environments at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import torch
from torch import Tensor

from tltl_runtime.spec.batch.samples import check_exclusive
from tltlc.api import Fspa, Implicant

Primes = tuple[Implicant, ...]

_LETTER_ATOMS: Final = 12
_LETTER_CELLS: Final = 1 << 22
"""The lookup table of edges is built only for at most this many atoms and cells.

The table has a cell for each state and each letter (a truth value for each atom).
"""


class PrimeSets:
    """K sets of prime implicants (primes, for short), and their robustness for N environments.

    The robustness of a set is the greatest robustness of its primes, or ``empty`` if it has no
    primes. The robustness of a prime is the least value of its literals, or 1 if it has none. In the
    methods, ``values`` are the values of the ``atoms``, shape [atoms, N]. A ``choice``, int64 [N], has
    the index of the set to use in each environment.
    """

    def __init__(self, sets: Sequence[Primes], atoms: int, device: torch.device, empty: float) -> None:
        self._atoms, self._empty = atoms, empty
        self._distinct = list(dict.fromkeys(sets))
        numbers = {primes: number for number, primes in enumerate(self._distinct)}
        self._rows = torch.tensor([numbers[primes] for primes in sets], dtype=torch.int64, device=device)
        primes = {prime for chosen in self._distinct for prime in chosen}
        self._depth = max((len(chosen) for chosen in self._distinct), default=1) or 1
        self._width = max((len(prime) for prime in primes), default=1) or 1
        self._negates = any(not polarity for prime in primes for _, polarity in prime)
        # A gather costs about as much as four passes over a column, so few operations are cheaper without one.
        operations = sum(map(len, primes)) + sum(map(len, self._distinct))
        self._dense = operations <= 4 * self._depth * self._width + 8
        self._literals = self._table(self._literal_rows).to(device)
        self._limiting = self._table(self._limiting_atoms).to(device)

    def all_robustness(self, values: Tensor) -> Tensor:
        """Return the robustness of every set, shape [K, N]."""
        return self._distinct_robustness(values).index_select(0, self._rows)

    def robustness_of(self, choice: Tensor, values: Tensor) -> Tensor:
        """Return the robustness of the chosen set in each environment, shape [N]."""
        rows = self._rows.index_select(0, choice)
        if self._dense:
            robustness = self._distinct_robustness(values)
            return robustness[0] if len(self._distinct) == 1 else robustness.gather(0, rows[None])[0]
        return self._literals_of(rows, values).amin(1).amax(0)

    def bounding_atom(self, choice: Tensor, values: Tensor) -> Tensor:
        """Return the index of the atom that decides the robustness of the chosen set, int64 [N].

        It is the atom of the least literal in the most robust prime of the set; on ties, the first.
        The index is -1 if the set has no primes, or if this prime has no literals.
        """
        rows = self._rows.index_select(0, choice)
        literals = self._literals_of(rows, values)
        best = literals.amin(1).argmax(0)
        least = literals.argmin(1).gather(0, best[None])[0]
        atoms = self._limiting.index_select(1, rows)
        return atoms.gather(0, (best * self._width + least)[None])[0]

    def _distinct_robustness(self, values: Tensor) -> Tensor:
        """Return the robustness of each distinct set, [distinct, N]: equal sets have one row.

        A prime that several sets share is computed only once, too.
        """
        negated = -values if self._negates else values
        robustness_of: dict[Implicant, Tensor] = {}
        results = []
        for primes in self._distinct:
            best: Tensor | None = None
            for prime in primes:
                if prime not in robustness_of:
                    robustness_of[prime] = _least(
                        [(values if polarity else negated)[atom] for atom, polarity in prime], values
                    )
                best = robustness_of[prime] if best is None else torch.maximum(best, robustness_of[prime])
            results.append(values.new_full((values.shape[1],), self._empty) if best is None else best)
        return torch.stack(results) if results else values.new_empty((0, values.shape[1]))

    def _literals_of(self, rows: Tensor, values: Tensor) -> Tensor:
        """Return the values of all literals of the set of each environment, [primes, literals, N].

        ``rows``, [N], has the index of this set among the distinct sets.
        """
        ones, empty = (values.new_full((1, values.shape[1]), constant) for constant in (1.0, self._empty))
        signed = torch.cat([values, -values, ones, empty])
        literals = signed.gather(0, self._literals.index_select(1, rows))
        return literals.view(self._depth, self._width, values.shape[1])

    def _table(self, cells: Callable[[Primes], list[int]]) -> Tensor:
        """Return a table with a column for each distinct set, int64 [primes * literals, distinct].

        ``cells`` returns the numbers in the column of a set.
        """
        rows = [cells(primes) for primes in self._distinct]
        return torch.tensor(rows, dtype=torch.int64).view(len(rows), self._depth * self._width).t().contiguous()

    def _literal_rows(self, primes: Primes) -> list[int]:
        """Return, for each literal of a set, the row in which :meth:`_literals_of` finds its value.

        That method stacks these rows: the values of the atoms, the negated values, a row of 1 (for
        a prime without literals), and a row of ``empty`` (for a set without primes).

        The result has the same length for all sets: shorter sets are padded with their first prime,
        shorter primes with their first literal. This changes no minimum or maximum.
        """
        if not primes:
            return [2 * self._atoms + 1] * (self._depth * self._width)
        rows: list[int] = []
        for prime in (*primes, *[primes[0]] * (self._depth - len(primes))):
            row = [atom if polarity else self._atoms + atom for atom, polarity in prime] or [2 * self._atoms]
            rows += row + row[:1] * (self._width - len(row))
        return rows

    def _limiting_atoms(self, primes: Primes) -> list[int]:
        rows = self._literal_rows(primes)
        return [row % self._atoms if row < 2 * self._atoms else -1 for row in rows]


class Transitions:
    """Finds the edges that N automata take.

    Exactly one of the edges from a state, self-loops included, has a true guard, unless atoms that
    the spec declares ``exclusive`` hold at once. If ``checked``, that is an error; otherwise, the
    automaton takes an arbitrary edge from the state.
    """

    def __init__(self, fspa: Fspa, device: torch.device, checked: bool) -> None:
        self._checked = checked
        self._fspa = fspa
        self._atoms = len(fspa.atoms)
        self._letters = 1 << self._atoms
        fits = self._atoms <= _LETTER_ATOMS and len(fspa.states) * self._letters <= _LETTER_CELLS
        self._table = self._edge_table().to(device) if fits else None
        self._leaving = None if fits else self._leaving_table().to(device)
        self._guards = None if fits else PrimeSets([e.guard.primes for e in fspa.edges], self._atoms, device, -1.0)

    def edge(self, state: Tensor, truth: Tensor) -> Tensor:
        """Return the indices of the edges that the N automata take, int64 [N].

        ``state``, int64 [N], has the current states. ``truth``, bool [atoms, N], says which atoms hold.

        Raises:
            MonitorError: TLT0614, exclusive atoms hold at once; only if ``checked``.
        """
        if self._table is None:
            if self._checked:
                check_exclusive(self._fspa, truth)
            return self._by_primes(state, truth)
        # Adding bytes is four times as fast as adding wide integers.
        bits = truth.view(torch.uint8) if self._atoms <= 8 else truth.to(torch.int16)
        letter = bits[0] if self._atoms else torch.zeros_like(state)
        for atom in range(1, self._atoms):
            letter = torch.add(letter, bits[atom], alpha=1 << atom)
        cell = torch.add(letter.to(torch.int64), state, alpha=self._letters)
        edge = self._table.index_select(0, cell)
        if self._checked and self._fspa.exclusive and int(edge.amin()) < 0:
            check_exclusive(self._fspa, truth)
        return edge

    def _by_primes(self, state: Tensor, truth: Tensor) -> Tensor:
        assert self._leaving is not None and self._guards is not None
        signs = truth.float() * 2.0 - 1.0
        leaving = self._leaving.index_select(1, state)
        taken = leaving[0]
        for edge in leaving[1:]:
            taken = torch.where(self._guards.robustness_of(edge, signs) > 0.0, edge, taken)
        return taken

    def _leaving_table(self) -> Tensor:
        """Return the edges from each state as columns of a table, int64 [most edges, states].

        If a state has fewer edges than others, its first edge fills the remaining cells.
        """
        leaving: list[list[int]] = [[] for _ in self._fspa.states]
        for number, edge in enumerate(self._fspa.edges):
            leaving[edge.source].append(number)
        most = max(map(len, leaving))
        return torch.tensor([row + row[:1] * (most - len(row)) for row in leaving], dtype=torch.int64).t().contiguous()

    def _edge_table(self) -> Tensor:
        """Return the index of the edge for each state and letter, int64 [states * letters].

        Bit i of a letter says whether atom i holds. If ``checked``, the index is -1 for letters in
        which exclusive atoms hold at once.
        """
        letters = torch.arange(self._letters)
        table = torch.zeros((len(self._fspa.states), self._letters), dtype=torch.int64)
        for number, edge in reversed(list(enumerate(self._fspa.edges))):
            table[edge.source] = number
        for number, edge in enumerate(self._fspa.edges):
            for prime in edge.guard.primes:
                mask = sum(1 << atom for atom, _ in prime)
                bits = sum(1 << atom for atom, polarity in prime if polarity)
                table[edge.source][(letters & mask) == bits] = number
        for group in self._fspa.exclusive if self._checked else ():
            held = sum(((letters >> atom) & 1 for atom in group), torch.zeros_like(letters))
            table[:, held > 1] = -1
        return table.view(-1)


def _least(literals: Sequence[Tensor], values: Tensor) -> Tensor:
    if not literals:
        return values.new_ones((values.shape[1],))
    least = literals[0]
    for literal in literals[1:]:
        least = torch.minimum(least, literal)
    return least
