"""Evaluate formulas on infinite traces that repeat a cycle, directly from the definitions of the operators.

This is slow. Tests compare the automata of this package with it.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from tltlc.logic.formula import Formula


def holds_on_lasso(formula: Formula, prefix: Sequence[Collection[str]], cycle: Sequence[Collection[str]]) -> bool:
    """Whether a formula holds on ``prefix`` followed by infinitely many repetitions of ``cycle``.

    A sample is the collection of the names of the atoms that hold at it. ``N`` means the same as
    ``X``, since every sample has a next one. Raises ValueError if the cycle is empty.
    """
    if not cycle:
        raise ValueError("the cycle is empty")
    trace = [*prefix, *cycle]
    following = [*range(1, len(trace)), len(prefix)]
    values: dict[Formula, list[bool]] = {}
    for node in formula.bottom_up():
        values[node] = _values(node, [values[argument] for argument in node.args], trace, following)
    return values[formula][0]


def _values(
    node: Formula, operands: list[list[bool]], trace: Sequence[Collection[str]], following: Sequence[int]
) -> list[bool]:
    """Return the truth value of a formula at each sample of ``trace``, given the values of its operands there.

    ``following[i]`` is the index of the sample after sample ``i``.
    """
    count = len(trace)
    a = operands[0] if operands else []
    b = operands[1] if len(operands) > 1 else []
    match node.op:
        case "true" | "false":
            return [node.op == "true"] * count
        case "atom":
            return [node.name in sample for sample in trace]
        case "not":
            return [not x for x in a]
        case "and":
            return [all(values) for values in zip(*operands, strict=True)]
        case "or":
            return [any(values) for values in zip(*operands, strict=True)]
        case "implies":
            return [not x or y for x, y in zip(a, b, strict=True)]
        case "iff":
            return [x == y for x, y in zip(a, b, strict=True)]
        case "X" | "N":
            return [a[place] for place in following]
    yes = [True] * count
    match node.op:
        case "F":
            return _fixed_point(yes, a, following, least=True)
        case "G":
            return _fixed_point(a, [False] * count, following, least=False)
        case "U" | "W":
            return _fixed_point(a, b, following, least=node.op == "U")
        case "R" | "M":
            both = [x and y for x, y in zip(a, b, strict=True)]
            return _fixed_point(b, both, following, least=node.op == "M")
    raise ValueError(f"an unknown operator: {node.op}")


def _fixed_point(go_on: list[bool], ends: list[bool], following: Sequence[int], *, least: bool) -> list[bool]:
    """Return the least or greatest solution ``v`` of ``v = ends | go_on & X v``, with a truth value for each sample.

    ``X v`` is the value of ``v`` at the next sample; ``following[i]`` is the index of the sample
    after sample ``i``.
    """
    values = [not least] * len(ends)
    # Each round gives at least one more sample its final value.
    for _ in range(len(ends) + 1):
        for place in reversed(range(len(ends))):
            values[place] = ends[place] or (go_on[place] and values[following[place]])
    return values
