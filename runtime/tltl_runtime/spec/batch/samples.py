"""Compute the values of atoms from the signals of N environments; check and clamp the values.

The values of registers, in which the monitors remember the traces so far, go in and come out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

import torch
from numpy.typing import ArrayLike
from torch import Tensor

from tltl_runtime.spec.batch.computations import Computation, computations_of, constants, rows_of
from tltl_runtime.spec.batch.expressions import TensorExpressions
from tltl_runtime.spec.batch.float_formats import counts_up_to, fits, narrow
from tltlc.api import Diagnostic, Fspa, MonitorError, expressions, monitors

_NAMED = 5
"""An error message names at most this many environments."""


class BatchSampleValues(NamedTuple):
    """The values of the atoms at a sample, [atoms, N], in [-1, 1], and of the registers after it, [registers, N]."""

    atoms: Tensor
    registers: Tensor


class BatchSamples:
    """Computes the values of the atoms, shape [atoms, N], from the signals of N environments.

    Signals are clamped to their ranges, and atoms to [-1, 1]. ``clamped`` counts the clamped values by
    the name of the signal or atom. The value of an atom counts only if it is more than 1e-9 outside
    [-1, 1]. If values are not ``checked``, they are clamped without counts or errors.

    If a number of the automaton is too large or too small for ``dtype``, atoms are computed in
    float64. ``names`` is the order of the signals in a tensor. ``initial`` are the values of the
    registers before the first sample, [registers, N].
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
        counters = [each.high for each in fspa.registers if each.unit == "steps" or each.kind == "times"]
        # Times that are sums of many short steps need double precision, too.
        is_exact = (
            not fspa.clock_varies
            and fits(constants(fspa, values), dtype)
            and all(high is not None and counts_up_to(high, dtype) for high in counters)
        )
        self._dtype = dtype = dtype if is_exact else torch.float64
        self._values = values
        self._computations = computations_of(fspa)
        before = [expressions.Before(register.name) for register in fspa.registers]
        length = [expressions.StepLength()] if before and fspa.clock_varies else []
        self._before: tuple[expressions.VariableKey, ...] = (*before, *length)
        self._program = TensorExpressions(
            [each.expression for each in self._computations],
            self._keys(self.names),
            values,
            device,
            dtype,
            [each.key for each in self._computations] if fspa.registers else (),
        )
        self._atom_rows, self._register_rows = (
            torch.tensor(rows_of(self._computations, is_atom), dtype=torch.int64, device=device)
            for is_atom in (True, False)
        )
        starts = torch.tensor([register.initial for register in fspa.registers], dtype=dtype, device=device)
        self.initial = starts[:, None].expand(-1, count).contiguous()
        # An open end of a range counts as the greatest finite number, so that only infinite values are clamped to it.
        most = torch.finfo(dtype).max
        low = [0.0 if s.type == "bool" else -most if s.low is None else s.low for s in fspa.signals]
        high = [1.0 if s.type == "bool" else most if s.high is None else s.high for s in fspa.signals]
        self._ranges = tuple(zip(low, high, strict=True))
        self._low = torch.tensor(low, dtype=dtype, device=device)[:, None]
        self._high = torch.tensor(high, dtype=dtype, device=device)[:, None]
        self._bools = [row for row, signal in enumerate(fspa.signals) if signal.type == "bool"]

    def values(
        self,
        signals: Mapping[str, ArrayLike | Tensor] | ArrayLike | Tensor,
        registers: Tensor,
        dt: ArrayLike | Tensor | None = None,
    ) -> BatchSampleValues:
        """Return the values of the atoms at a sample, and of the registers after it.

        ``signals`` maps names to arrays [N], or is one array [N, signals] in the order of ``names``.
        Names that no atom uses are ignored. ``registers``, [registers, N], are the values of the
        registers before the sample. If the clock varies, ``dt`` is the time since the sample before, in
        seconds, [N] or one number for all. A value of an atom that is converted from float64 to a
        smaller ``dtype`` keeps its sign: it does not become 0.

        Raises:
            MonitorError: TLT0611, signals are missing; TLT0612, a signal has no finite value, or a
                Boolean signal is neither 0 nor 1; TLT0613, an atom or a register has no value; TLT0619,
                ``dt`` is missing, wrong, or there although the clock is fixed. The message names the
                environments. If not ``checked``, only TLT0611 is raised, and TLT0619 for a ``dt`` that is
                missing or too much.
            ValueError: an array has another shape.
        """
        lengths = self._lengths(dt)
        columns = self._columns(signals)
        if not self._checked:
            columns = torch.clamp(columns, self._low, self._high)
            values, _ = self._program.run(self._with_registers(columns, registers, lengths))
            atoms, after = self._split(values)
            return BatchSampleValues(narrow(torch.clamp(atoms, -1.0, 1.0), self._result_dtype), after)
        if self.names and not self._in_range(columns):
            given, columns = columns, torch.clamp(columns, self._low, self._high)
            self._check_signals(given, columns)
        for row in self._bools:
            self._check_truth(row, columns[row])
        values, failures = self._program.run(self._with_registers(columns, registers, lengths))
        atoms, after = self._split(values)
        if not self._fspa.atoms:
            return BatchSampleValues(atoms.to(self._result_dtype), after)
        failed = any(bool(mask.any()) for mask in failures if mask is not None)
        if failed or not (float(atoms.amin()) >= -1.0 and float(atoms.amax()) <= 1.0 and _are_finite(after)):
            self._check_values(columns, registers, lengths, values, failures)
            atoms = torch.clamp(atoms, -1.0, 1.0)
        return BatchSampleValues(narrow(atoms, self._result_dtype), after)

    def from_atoms(self, given: Tensor, registers: Tensor, dt: ArrayLike | Tensor | None = None) -> BatchSampleValues:
        """Return the values of all atoms and registers, from the atoms that do not follow from others, [given, N].

        ``registers`` are the values of the registers before the sample, and ``dt`` is that of
        :meth:`values`. Registers that read signals keep their value.
        """
        lengths = self._lengths(dt)
        if not self._fspa.registers:
            return BatchSampleValues(given, registers)
        program, computations = self._atom_program
        values, _ = program.run(self._with_registers(given.to(self._dtype), registers, lengths))
        atoms, after = registers.new_empty((len(self._fspa.atoms), self._count)), registers.clone()
        atoms[list(monitors.given_atoms(self._fspa))] = given.to(self._dtype)
        for each, value in zip(computations, values, strict=True):
            (atoms if each.is_atom else after)[each.index] = value
        return BatchSampleValues(narrow(torch.clamp(atoms, -1.0, 1.0), self._result_dtype), after)

    @cached_property
    def _atom_program(self) -> tuple[TensorExpressions, list[Computation]]:
        """The program of :meth:`from_atoms`, and what it computes."""
        fspa, given, following = self._fspa, monitors.given_atoms(self._fspa), monitors.registers_from_atoms(self._fspa)
        computations = [
            each
            for each in self._computations
            if (each.index not in given if each.is_atom else fspa.registers[each.index].name in following)
        ]
        rows = self._keys([expressions.AtomValue(fspa.atoms[index].name) for index in given])
        program = TensorExpressions(
            [each.expression for each in computations],
            rows,
            self._values,
            self._device,
            self._dtype,
            [each.key for each in computations],
        )
        return program, computations

    def _keys(self, signals: Sequence[expressions.VariableKey]) -> tuple[expressions.VariableKey, ...]:
        """Return the keys of what a program reads: these ``signals``, and the registers before the sample."""
        return (*signals, *self._before)

    def _with_registers(self, columns: Tensor, registers: Tensor, lengths: Tensor | None) -> Tensor:
        if not self._before:
            return columns
        return torch.cat([columns, registers] if lengths is None else [columns, registers, lengths])

    def _lengths(self, dt: ArrayLike | Tensor | None) -> Tensor | None:
        """Return the lengths of the steps of all environments, [1, N]; None if the clock does not vary.

        ``dt`` and the errors are those of :meth:`values`.
        """
        if dt is None and not self._fspa.clock_varies:
            return None
        if dt is None or not self._fspa.clock_varies:
            # The error is that of the monitor for one automaton.
            monitors.Samples(self._fspa, self._params, []).step_length(None if dt is None else 0.0, "this step")
        assert dt is not None, "the line above raised an error"
        lengths = torch.as_tensor(dt, dtype=self._dtype, device=self._device)
        if lengths.shape not in ((), (self._count,)):
            raise ValueError(f"`dt` must be one number or have the shape {(self._count,)}, not {tuple(lengths.shape)}")
        lengths = lengths.expand(self._count)
        wrong = ~((lengths >= 0.0) & torch.isfinite(lengths)) if self._checked else None
        if wrong is not None and bool(wrong.any()):
            indices = _indices(wrong)
            text = monitors.number_text(float(lengths[indices[0]]))
            title = f"its time since the sample before is {text}, not a number of seconds"
            raise _error("TLT0619", f"{_environments(indices)}: {title}")
        return lengths[None]

    def _split(self, values: Tensor) -> tuple[Tensor, Tensor]:
        """Split the values that the program computes: those of atoms and those of registers, each in order."""
        if not self._before:
            return values, self.initial
        return values.index_select(0, self._atom_rows), values.index_select(0, self._register_rows)

    def _columns(self, signals: Mapping[str, ArrayLike | Tensor] | ArrayLike | Tensor) -> Tensor:
        """Return the values of the signals that the atoms use, shape [signals, N], with contiguous rows.

        ``signals`` and the errors are those of :meth:`values`.
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

    def _check_values(
        self,
        columns: Tensor,
        registers: Tensor,
        lengths: Tensor | None,
        values: Tensor,
        failures: Sequence[Tensor | None],
    ) -> None:
        """Raise an error for the first atom or register without a value, and count the atoms that are clamped.

        ``values`` and ``failures`` are the results of the program for the signals ``columns``, the
        ``registers`` before the sample and the ``lengths`` of the steps.
        """
        unusable = ~torch.isfinite(values)
        for row, failed in enumerate(failures):
            wrong = unusable[row] if failed is None else unusable[row] | failed
            if bool(wrong.any()):
                raise self._value_error(self._computations[row], _indices(wrong), columns, registers, lengths)
        outside = ((values - torch.clamp(values, -1.0, 1.0)).abs() > monitors.ROUNDING).sum(1).tolist()
        for each, count in zip(self._computations, outside, strict=True):
            if count and each.is_atom:
                name = self._fspa.atoms[each.index].name
                self.clamped[name] = self.clamped.get(name, 0) + int(count)

    def _value_error(
        self,
        computation: Computation,
        indices: Sequence[int],
        columns: Tensor,
        registers: Tensor,
        lengths: Tensor | None,
    ) -> MonitorError:
        """Return the error that says why an atom or a register has no value in the environments ``indices``.

        ``columns`` are the values of the signals, [signals, N], ``registers`` those of the registers before
        the sample, and ``lengths`` the lengths of the steps. The error is that of the monitor for one
        automaton, in the first of these environments.
        """
        first = indices[0]
        sample = dict(zip(self.names, columns[:, first].tolist(), strict=True))
        if lengths is not None:
            sample[monitors.STEP_LENGTH] = float(lengths[0, first])
        try:
            samples = monitors.Samples(self._fspa, self._params, [])
            samples.values(sample, registers[:, first].tolist(), _environments(indices))
        except MonitorError as error:
            return error
        kind, parts = ("atom", self._fspa.atoms) if computation.is_atom else ("register", self._fspa.registers)
        title = f"the {kind} `{parts[computation.index].name}` is too large to compute"
        return _error("TLT0613", f"{_environments(indices)}: {title}")


def _are_finite(registers: Tensor) -> bool:
    """Whether all values are finite; without registers, nothing waits for the device."""
    return not registers.shape[0] or bool(torch.isfinite(registers).all())


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
