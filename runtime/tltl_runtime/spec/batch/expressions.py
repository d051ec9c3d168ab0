"""Compile expressions to torch code that evaluates them in N environments at once.

Equal subexpressions are computed only once. The values equal those of
:func:`tltlc.expression.evaluate.evaluate`. In an environment in which that function raises an error,
the value here is arbitrary, and the environment is marked as failed. An error in one case of a
``when`` expression counts only in the environments that take this case.

On a CPU in float64 the values are equal to the last bit, except for the sign of zeros, and except
for ``exp``, ``tanh``, ``sqrt`` and powers other than 2 and 3. Torch rounds these differently from
the C library: the relative difference is less than 1e-12.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

import torch
from torch import Tensor

from tltl_runtime.spec.batch.writer import TensorLine, TensorTerm, TensorWriter
from tltlc.api import expressions


class TensorExpressions:
    """Expressions, compiled to one Python function that evaluates all of them in N environments.

    The function takes the values of the signals, a tensor [signals, N]; ``signals`` are the names of
    its rows, or the keys of whatever else the expressions read. ``params`` are the values of the params
    in the expressions, in SI units. ``keys``, if there are any, has a key for each expression, by which
    later expressions read its value. ``source`` is the Python source text of the function.
    """

    def __init__(
        self,
        expressions: Sequence[expressions.Expression],
        signals: Sequence[expressions.VariableKey],
        params: Mapping[str, float],
        device: torch.device,
        dtype: torch.dtype,
        keys: Sequence[expressions.VariableKey] = (),
    ) -> None:
        writer = TensorWriter(signals, params)
        terms: list[TensorTerm] = []
        for index, expression in enumerate(expressions):
            terms.append(writer.number(expression))
            if keys:
                writer.define(keys[index], terms[-1])
        values = [term.name if term.constant is None else writer.constant_column(term.constant) for term in terms]
        failures = [term.fails for term in terms]
        self.source = "\n".join(
            [
                "def values(columns):",
                *(f"    {line}" for line in _release_tensors(writer.lines, {*values, *map(str, failures)})),
                f"    return ({', '.join([*values, ''])}), ({', '.join([*map(str, failures), ''])})",
            ]
        )
        names = ("abs", "clamp", "exp", "isfinite", "isinf", "pow", "sqrt", "tanh", "where")
        space: dict[str, Any] = {name: getattr(torch, name) for name in names}
        for name, constant in writer.constants.items():
            space[name] = torch.tensor(constant, dtype=dtype, device=device)
        exec(compile(self.source, "<expressions>", "exec"), space)
        self._function: Callable[[Tensor], tuple[tuple[Tensor, ...], tuple[Tensor | None, ...]]] = space["values"]

    def run(self, columns: Tensor) -> tuple[Tensor, tuple[Tensor | None, ...]]:
        """Return the values of the expressions, [expressions, N], and a mask for each expression.

        The mask, bool [N], says in which environments the expression has no value, for example
        because of a division by 0. It is None for an expression that always has a value. ``columns``
        are the values of the signals, [signals, N].
        """
        values, failures = self._function(columns)
        if not values:
            return columns.new_empty((0, columns.shape[1])), ()
        return torch.stack(values), failures


def _release_tensors(lines: Sequence[TensorLine], outputs: Collection[str]) -> list[str]:
    """Return the code of ``lines``, with a ``del`` for each tensor after its last use.

    So torch can reuse the memory of these tensors. The tensors named in ``outputs`` are kept.
    """
    seen: set[str] = set()
    lines_with_releases: list[str] = []
    for line in reversed(lines):
        names = {name for name in (line.name, *line.operands) if name not in outputs} - seen
        lines_with_releases += [f"del {', '.join(sorted(names))}"] if names else []
        lines_with_releases.append(f"{line.name} = {line.code}")
        seen |= names
    return lines_with_releases[::-1]
