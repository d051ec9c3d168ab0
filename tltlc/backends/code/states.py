"""The states of an automaton as Python functions: from the values of the atoms to the edge that is taken."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Edge, Fspa, Guard, Implicant
from tltlc.program.clauses import shorter
from tltlc.program.names import call, comment, literal, visible

INDENT = "    "


class StateWriter:
    """Writes one function per state; ``atoms`` are the Python names of the values of the atoms.

    With ``with_progress``, a function returns the progress of the step, too (lines 11 to 18 of Algorithm 1).
    """

    def __init__(self, fspa: Fspa, atoms: Sequence[str], with_progress: bool) -> None:
        self._fspa, self._atoms, self._with_progress = fspa, atoms, with_progress
        self._edges: list[list[Edge]] = [[] for _ in fspa.states]
        for edge in fspa.edges:
            self._edges[edge.source].append(edge)

    @property
    def result(self) -> str:
        """The type that the functions return."""
        return f"tuple[int, float, {'float, ' if self._with_progress else ''}str | None]"

    def function(self, state: int) -> str:
        """The function of a state, named ``_from_STATE``."""
        arguments = [f"{atom}: float" for atom in self._atoms]
        lines = [
            *call(f"def _from_{state}", arguments, f" -> {self.result}:"),
            *(f"{INDENT}{line}" for line in comment(self._fspa.states[state].label.ascii)),
        ]
        # One guard is true: the longest needs no test.
        edges = sorted(self._edges[state], key=lambda edge: (_size(edge.guard), edge.target))
        if len(edges) == 1:
            return "\n".join([*lines, *self._taken(edges[0], INDENT)])
        for edge in edges[:-1]:
            lines.append(f"{INDENT}if {self._truth(edge.guard)}:  # {visible(edge.guard.text)}")
            lines += self._taken(edge, INDENT * 2)
        lines.append(f"{INDENT}# {visible(edges[-1].guard.text)}")
        return "\n".join([*lines, *self._taken(edges[-1], INDENT)])

    def _taken(self, edge: Edge, indent: str) -> list[str]:
        """Lines that return what taking the edge means."""
        improving = [other for other in self._edges[edge.source] if self._improves(other)]
        lines: list[str] = []
        progress, limiting = self._base_progress(edge.target), "None"
        if edge.source == edge.target and improving:
            lines = self._nearest([prime for other in improving for prime in other.guard.primes])
            base = "" if progress == "0.0" else f"{progress} + "
            # A guard that is false has no robustness above 0, so there is nothing to cap.
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
        """The greatest of the primes' least literals, or what is the same with fewer literals, but for -0.

        Literals that all primes share are taken out.
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
        """Lines that find the most robust of the primes, the first of equals, and the first atom that bounds it."""
        lines: list[str] = []
        for position, prime in enumerate(primes):
            value = "other" if position else "nearest"
            least = self._fold("min", prime)
            found = self._bounding(prime, value)
            lines.append(f"{value} = {least}")
            if position:
                lines += ["if other > nearest:", f"{INDENT}nearest = other", f"{INDENT}limiting = {found}"]
            else:
                lines.append(f"limiting = {found}")
        return lines

    def _bounding(self, prime: Implicant, value: str) -> str:
        """The name of the first atom of the prime whose literal has that value."""
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
    """``max(a, b)``, ``a`` for one term and 1 for none (of no literals, ``min`` is 1)."""
    if not terms:
        return "1.0"
    return terms[0] if len(terms) == 1 else f"{function}({', '.join(terms)})"
