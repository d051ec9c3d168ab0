"""The states of an automaton as Python functions: they pick the edge taken from the values of the atoms."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Edge, Fspa, Guard, Implicant
from tltlc.program.clauses import shorter
from tltlc.program.names import call, comment, literal, visible

INDENT = "    "


class StateWriter:
    """Writes one function per state; ``atoms`` are the Python names of the values of the atoms.

    With ``with_progress``, a function also returns the progress of the step (lines 11 to 18 of
    Algorithm 1).
    """

    def __init__(self, fspa: Fspa, atoms: Sequence[str], with_progress: bool) -> None:
        self._fspa, self._atoms, self._with_progress = fspa, atoms, with_progress
        self._edges: list[list[Edge]] = [[] for _ in fspa.states]
        for edge in fspa.edges:
            self._edges[edge.source].append(edge)

    @property
    def result(self) -> str:
        """The return type of the functions."""
        return f"tuple[int, float, {'float, ' if self._with_progress else ''}str | None]"

    def function(self, state: int) -> str:
        """Return the function of a state, named ``_from_STATE``."""
        arguments = [f"{atom}: float" for atom in self._atoms]
        lines = [
            *call(f"def _from_{state}", arguments, f" -> {self.result}:"),
            *(f"{INDENT}{line}" for line in comment(self._fspa.states[state].label.ascii)),
        ]
        # Exactly one guard is true, so the longest needs no test.
        edges = sorted(self._edges[state], key=lambda edge: (_size(edge.guard), edge.target))
        if len(edges) == 1:
            return "\n".join([*lines, *self._taken(edges[0], INDENT)])
        for edge in edges[:-1]:
            lines.append(f"{INDENT}if {self._truth(edge.guard)}:  # {visible(edge.guard.text)}")
            lines += self._taken(edge, INDENT * 2)
        lines.append(f"{INDENT}# {visible(edges[-1].guard.text)}")
        return "\n".join([*lines, *self._taken(edges[-1], INDENT)])

    def _taken(self, edge: Edge, indent: str) -> list[str]:
        """Return the lines that run when an edge is taken."""
        improving = [candidate for candidate in self._edges[edge.source] if self._improves(candidate)]
        lines: list[str] = []
        progress, limiting = self._base_progress(edge.target), "None"
        if edge.source == edge.target and improving:
            lines = self._nearest([prime for candidate in improving for prime in candidate.guard.primes])
            base = "" if progress == "0.0" else f"{progress} + "
            # The improving guards are false, so their robustness is at most 0 and needs no cap.
            progress, limiting = f"{base}(1.0 + nearest) / {self._fspa.spec_size}", "limiting"
        values = [str(edge.target), self._robustness(edge.guard.primes)]
        values += [progress, limiting] if self._with_progress else [limiting]
        return [f"{indent}{line}" for line in (*lines, f"return {', '.join(values)}")]

    def _improves(self, edge: Edge) -> bool:
        before, after = self._fspa.states[edge.source].distance, self._fspa.states[edge.target].distance
        return before is not None and after is not None and after < before

    def _base_progress(self, state: int) -> str:
        distance, size = self._fspa.states[state].distance, self._fspa.spec_size
        if distance is None or (size and distance == size):
            return "0.0"
        return f"{size - distance} / {size}" if distance else "1.0"

    def _truth(self, guard: Guard) -> str:
        tests = [
            " and ".join(f"{self._atoms[atom]} {'>' if polarity else '<='} 0.0" for atom, polarity in prime) or "True"
            for prime in guard.primes
        ]
        if len(tests) > 1:
            tests = [f"({test})" if " and " in test else test for test in tests]
        return " or ".join(tests)

    def _robustness(self, primes: Sequence[Implicant]) -> str:
        """Return the maximum over primes of the least literal, or an equal expression with fewer
        literals (except for -0).

        Literals that all primes share are factored out.
        """
        shared = [literal_ for literal_ in primes[0] if all(literal_ in prime for prime in primes)]
        rest = [[literal_ for literal_ in prime if literal_ not in shared] for prime in primes]
        terms = [self._value(*literal_) for literal_ in shared]
        if not all(rest):
            return _call("min", terms)
        clauses = shorter(rest)
        if clauses is None:
            return _call("min", [*terms, _call("max", [self._fold("min", prime) for prime in rest])])
        return _call("min", [*terms, *(self._fold("max", clause) for clause in clauses)])

    def _nearest(self, primes: Sequence[Implicant]) -> list[str]:
        """Return lines that find the most robust prime (the first of equals) and the first atom that bounds it."""
        lines: list[str] = []
        for position, prime in enumerate(primes):
            value = "other" if position else "nearest"
            least = self._fold("min", prime)
            bounding = self._bounding(prime, value)
            lines.append(f"{value} = {least}")
            if position:
                lines += ["if other > nearest:", f"{INDENT}nearest = other", f"{INDENT}limiting = {bounding}"]
            else:
                lines.append(f"limiting = {bounding}")
        return lines

    def _bounding(self, prime: Implicant, value: str) -> str:
        """Return the name of the first atom of the prime whose literal has the given value."""
        tests = [
            f"{literal(self._fspa.atoms[atom].name)} if {self._value(atom, polarity)} == {value} else "
            for atom, polarity in prime[:-1]
        ]
        return "".join(tests) + literal(self._fspa.atoms[prime[-1][0]].name)

    def _fold(self, function: str, literals: Sequence[tuple[int, bool]]) -> str:
        return _call(function, [self._value(*literal_) for literal_ in literals])

    def _value(self, atom: int, polarity: bool) -> str:
        return self._atoms[atom] if polarity else f"-{self._atoms[atom]}"


def _size(guard: Guard) -> int:
    return sum(map(len, guard.primes))


def _call(function: str, terms: Sequence[str]) -> str:
    """Return ``max(a, b)``; one term alone stays as it is, and no terms give 1 (the ``min`` of no literals)."""
    if not terms:
        return "1.0"
    return terms[0] if len(terms) == 1 else f"{function}({', '.join(terms)})"
