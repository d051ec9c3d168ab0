"""The meaning of formulas, computed slowly from the definitions.

The definitions are in ``docs/semantics.md``, "Truth and robustness of atoms" and "Traces". Tests
compare all faster code with this module.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import chain, combinations, product

from tltlc.logic.formula import Formula, bound_of


def holds(formula: Formula, trace: Sequence[Collection[str]], position: int = 0) -> bool:
    """Whether the formula holds at ``position`` of a finite trace.

    A sample of the trace is the collection of the names of the atoms that hold at it. Raises
    ValueError if the trace is empty or has no such position.
    """
    if not 0 <= position < len(trace):
        raise ValueError(f"a trace of {len(trace)} samples has no position {position}")
    values: dict[Formula, list[bool]] = {}
    for node in formula.bottom_up():
        operands = [values[argument] for argument in node.args]
        values[node] = [_holds_at(node, operands, trace, i) for i in range(len(trace))]
    return values[formula][position]


def robustness_of_state(formula: Formula, values: Mapping[str, float]) -> float:
    """Return the robustness, in [-1, 1], of a formula without temporal operators at one sample.

    ``values`` maps each atom to a value in [-1, 1]. ``true`` is 1, ``false`` is -1, an atom is its
    value, ``not`` is the negative, ``and`` the minimum, and ``or`` the maximum
    (Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, section III). ``a -> b`` is read as
    ``!a | b``, and ``a <-> b`` as ``(!a | b) & (a | !b)``. Raises ValueError at a temporal operator.
    """
    results: dict[Formula, float] = {}
    for node in formula.bottom_up():
        operands = [results[argument] for argument in node.args]
        results[node] = values[node.name] if node.op == "atom" else _robustness(node, operands)
    return results[formula]


def all_traces(atoms: Sequence[str], max_length: int) -> Iterator[tuple[frozenset[str], ...]]:
    """Yield every trace of 1 to ``max_length`` samples over the given atoms, shorter traces first."""
    samples = [
        frozenset(chosen) for chosen in chain.from_iterable(combinations(atoms, k) for k in range(len(atoms) + 1))
    ]
    for length in range(1, max_length + 1):
        yield from product(samples, repeat=length)


def _holds_at(node: Formula, operands: list[list[bool]], trace: Sequence[Collection[str]], i: int) -> bool:
    """Whether ``node`` holds at position ``i``, given the truth values of its operands at every position."""
    n = len(trace)
    a = operands[0] if operands else []
    b = operands[1] if len(operands) > 1 else []
    match node.op:
        case "true":
            return True
        case "false":
            return False
        case "atom":
            return node.name in trace[i]
        case "not":
            return not a[i]
        case "and":
            return all(operand[i] for operand in operands)
        case "or":
            return any(operand[i] for operand in operands)
        case "implies":
            return not a[i] or b[i]
        case "iff":
            return a[i] == b[i]
        case "X":
            return i + 1 < n and a[i + 1]
        case "N":
            return i + 1 >= n or a[i + 1]
        case "F":
            return any(a[j] for j in range(i, n))
        case "G":
            return all(a[j] for j in range(i, n))
        case "U":
            return any(b[j] and all(a[k] for k in range(i, j)) for j in range(i, n))
        case "W":
            return all(a[j] or any(b[k] for k in range(i, j + 1)) for j in range(i, n))
        case "R":
            return all(b[j] or any(a[k] for k in range(i, j)) for j in range(i, n))
        case "M":
            return any(a[j] and all(b[k] for k in range(i, j + 1)) for j in range(i, n))
        case "F[]" | "G[]":
            bound = bound_of(node)
            assert bound is not None, "a bounded operator"
            window = a[i + bound.low : i + bound.high + 1]
            return any(window) if node.op == "F[]" else all(window)


def _robustness(node: Formula, operands: list[float]) -> float:
    match node.op:
        case "true":
            return 1.0
        case "false":
            return -1.0
        case "not":
            return -operands[0]
        case "and":
            return min(operands)
        case "or":
            return max(operands)
        case "implies":
            return max(-operands[0], operands[1])
        case "iff":
            return min(max(-operands[0], operands[1]), max(operands[0], -operands[1]))
        case _:
            raise ValueError(f"{node} is about more than one state")
