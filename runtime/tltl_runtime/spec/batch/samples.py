"""Compute the values of atoms from the signals of N environments; check and clamp the values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import torch
from numpy.typing import ArrayLike
from torch import Tensor

from tltl_runtime.spec.batch.expressions import TensorExpressions
from tltl_runtime.spec.batch.float_formats import fits, narrow
from tltlc.api import Diagnostic, Fspa, MonitorError, expressions, monitors

_NAMED = 5
"""An error message names at most this many environments."""


class BatchSamples:
    """Computes the values of the atoms, shape [atoms, N], from the signals of N environments.

    Signals are clamped to their ranges, and atoms to [-1, 1]. ``clamped`` counts the clamped values by
    the name of the signal or atom. The value of an atom counts only if it is more than 1e-9 outside
    [-1, 1]. If values are not ``checked``, they are clamped without counts or errors.

    If a number of the automaton is too large or too small for ``dtype``, atoms are computed in
    float64. ``names`` is the order of the signals in a tensor.
    """

    def __init__(
        self,
        fspa: Fspa,
        count: int,
        params: Mapping[str, float] | None,
        device: torch.device,
        dtype: torch.dtype,
        checked: bool,
    ) -> None:
        self._fspa, self._count, self._params, self._device = fspa, count, params, device
        self._checked = checked
        self.names = tuple(signal.name for signal in fspa.signals)
        self.clamped: dict[str, int] = {}
        values = monitors.param_values(fspa.params, params or {})
        self._result_dtype = dtype
        self._dtype = dtype = dtype if fits(_constants(fspa, values), dtype) else torch.float64
        self._program = TensorExpressions([atom.expression for atom in fspa.atoms], self.names, values, device, dtype)
        # An open end of a range counts as the greatest finite number, so that only infinite values are clamped to it.
        most = torch.finfo(dtype).max
        low = [0.0 if s.type == "bool" else -most if s.low is None else s.low for s in fspa.signals]
        high = [1.0 if s.type == "bool" else most if s.high is None else s.high for s in fspa.signals]
        self._ranges = tuple(zip(low, high, strict=True))
        self._low = torch.tensor(low, dtype=dtype, device=device)[:, None]
        self._high = torch.tensor(high, dtype=dtype, device=device)[:, None]
        self._bools = [row for row, signal in enumerate(fspa.signals) if signal.type == "bool"]

    def atom_values(self, signals: Mapping[str, ArrayLike | Tensor] | ArrayLike | Tensor) -> Tensor:
        """Return the values of the atoms, each in [-1, 1], shape [atoms, N].

        ``signals`` maps names to arrays [N], or is one array [N, signals] in the order of ``names``.
        Names that no atom uses are ignored. A value that is converted from float64 to a smaller
        ``dtype`` keeps its sign: it does not become 0.

        Raises:
            MonitorError: TLT0611, signals are missing; TLT0612, a signal has no finite value, or a
                Boolean signal is neither 0 nor 1; TLT0613, an atom has no value. The message names
                the environments. If not ``checked``, only TLT0611 is raised.
            ValueError: an array has another shape.
        """
        columns = self._columns(signals)
        if not self._checked:
            values, _ = self._program.run(torch.clamp(columns, self._low, self._high))
            return narrow(torch.clamp(values, -1.0, 1.0), self._result_dtype)
        if self.names and not self._in_range(columns):
            given, columns = columns, torch.clamp(columns, self._low, self._high)
            self._check_signals(given, columns)
        for row in self._bools:
            self._check_truth(row, columns[row])
        values, failures = self._program.run(columns)
        if not self._fspa.atoms:
            return values.to(self._result_dtype)
        failed = any(bool(mask.any()) for mask in failures if mask is not None)
        if failed or not (float(values.amin()) >= -1.0 and float(values.amax()) <= 1.0):
            raw, values = values, torch.clamp(values, -1.0, 1.0)
            self._check_atoms(columns, raw, values, failures)
        return narrow(values, self._result_dtype)

    def _columns(self, signals: Mapping[str, ArrayLike | Tensor] | ArrayLike | Tensor) -> Tensor:
        """Return the values of the signals that the atoms use, shape [signals, N], with contiguous rows.

        ``signals`` and the errors are those of :meth:`atom_values`.
        """
        if not isinstance(signals, Mapping):
            given = torch.as_tensor(signals)
            if given.shape != (self._count, len(self.names)):
                raise ValueError(
                    f"the signals must have the shape {(self._count, len(self.names))}, not {tuple(given.shape)}"
                )
            columns = given.t()
            if columns.is_contiguous():
                return columns.to(self._device, self._dtype)
            # This is twice as fast as `contiguous`.
            contiguous = torch.empty(columns.shape, dtype=self._dtype, device=self._device)
            contiguous.t().copy_(given)
            return contiguous
        missing = [name for name in self.names if name not in signals]
        if missing:
            raise _error("TLT0611", f"no value for {monitors.name_list(missing)}")
        if not self.names:
            return torch.empty((0, self._count), dtype=self._dtype, device=self._device)
        rows = [torch.as_tensor(signals[name], dtype=self._dtype, device=self._device) for name in self.names]
        for name, row in zip(self.names, rows, strict=True):
            if row.shape != (self._count,):
                raise ValueError(f"the signal `{name}` must have the shape {(self._count,)}, not {tuple(row.shape)}")
        return torch.stack(rows)

    def _in_range(self, columns: Tensor) -> bool:
        """Whether all signals are in their ranges, so that none has to be clamped.

        False if a value is NaN: both extremes of its row are then NaN, and the comparison fails.
        """
        extremes = zip(columns.amin(1).tolist(), columns.amax(1).tolist(), self._ranges, strict=True)
        return all(least >= low and greatest <= high for least, greatest, (low, high) in extremes)

    def _check_signals(self, given: Tensor, columns: Tensor) -> None:
        finite = torch.isfinite(given)
        for row, name in enumerate(self.names):
            if not bool(finite[row].all()):
                indices = _indices(~finite[row])
                value = float(given[row, indices[0]])
                raise _error(
                    "TLT0612", f"{_environments(indices)}: the signal `{name}` is {value}, not a finite number"
                )
        for row in self._bools:
            self._check_truth(row, given[row])
        for row, changed in enumerate((given != columns).sum(1).tolist()):
            if changed:
                self.clamped[self.names[row]] = self.clamped.get(self.names[row], 0) + int(changed)

    def _check_truth(self, row: int, column: Tensor) -> None:
        wrong = (column != 0.0) & (column != 1.0)
        if bool(wrong.any()):
            indices = _indices(wrong)
            value = monitors.number_text(float(column[indices[0]]))
            raise _error(
                "TLT0612", f"{_environments(indices)}: the signal `{self.names[row]}` is {value}, not true or false"
            )

    def _check_atoms(self, columns: Tensor, raw: Tensor, values: Tensor, failures: Sequence[Tensor | None]) -> None:
        unusable = ~torch.isfinite(raw)
        for row, failed in enumerate(failures):
            wrong = unusable[row] if failed is None else unusable[row] | failed
            if bool(wrong.any()):
                raise self._atom_error(row, _indices(wrong), columns)
        for row, outside in enumerate(((raw - values).abs() > monitors.ROUNDING).sum(1).tolist()):
            if outside:
                name = self._fspa.atoms[row].name
                self.clamped[name] = self.clamped.get(name, 0) + int(outside)

    def _atom_error(self, row: int, indices: Sequence[int], columns: Tensor) -> MonitorError:
        """Return the error that says why an atom has no value in the environments ``indices``.

        ``row`` is the index of the atom, and ``columns`` are the values of the signals, [signals, N].
        The error is that of the monitor for one automaton, in the first of these environments.
        """
        sample = dict(zip(self.names, columns[:, indices[0]].tolist(), strict=True))
        try:
            monitors.Samples(self._fspa, self._params, []).atom_values(sample, _environments(indices))
        except MonitorError as error:
            return error
        title = f"the atom `{self._fspa.atoms[row].name}` is too large to compute"
        return _error("TLT0613", f"{_environments(indices)}: {title}")


def _constants(fspa: Fspa, params: Mapping[str, float]) -> Iterator[float]:
    """Yield all numbers that are used to compute atoms, except the values of signals.

    They are the constants in expressions, the ends of the signals' ranges, and the values of the
    params.
    """
    for atom in fspa.atoms:
        yield from (node.value for node in expressions.nodes(atom.expression) if isinstance(node, expressions.Const))
    for signal in fspa.signals:
        yield from (end for end in (signal.low, signal.high) if end is not None)
    yield from params.values()


def check_exclusive(fspa: Fspa, truth: Tensor) -> None:
    """Check that no two atoms of an ``exclusive`` declaration hold at once in an environment.

    ``truth``, bool [atoms, N], says which atoms hold.

    Raises:
        MonitorError: TLT0614, two such atoms hold at once. The message names the environments.
    """
    for group in fspa.exclusive:
        truths = truth[list(group)]
        wrong = truths.sum(0) > 1
        if bool(wrong.any()):
            indices = _indices(wrong)
            names = [fspa.atoms[atom].name for atom in group]
            holding = [name for name, holds in zip(names, truths[:, indices[0]].tolist(), strict=True) if holds]
            both = monitors.name_list(holding)
            text = f"{_environments(indices)}: {both} hold at once, against `exclusive {', '.join(names)}`"
            raise _error("TLT0614", text)


def _indices(mask: Tensor) -> list[int]:
    return [int(index) for index in mask.nonzero()[:, 0].tolist()]


def _environments(indices: Sequence[int]) -> str:
    """Return a text such as ``environment 3`` or ``environments 0, 1, 2, 3, 4 and 12 more``."""
    if len(indices) == 1:
        return f"environment {indices[0]}"
    left_out = len(indices) - _NAMED
    first, last = (indices[:_NAMED], f"{left_out} more") if left_out > 0 else (indices[:-1], str(indices[-1]))
    return f"environments {', '.join(map(str, first))} and {last}"


def _error(code: str, text: str) -> MonitorError:
    return MonitorError([Diagnostic(code, text, help=monitors.SUGGESTIONS[code])])
