"""Compute the values of the atoms from the game's signals: check and clamp signals, evaluate predicates.

The values of registers, the memory of the trace so far, go in and come out: nothing here remembers
a sample.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from copy import copy
from math import inf, isfinite
from typing import Final, NamedTuple, SupportsFloat

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import given_atoms, registers_from_atoms, schedule
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.expression.python import compile_expressions
from tltlc.expression.tree import AtomValue, Before, StepLength, VariableKey
from tltlc.monitor.errors import MISSING_BOOLS, SUGGESTIONS, MonitorError, sample_error, sample_place
from tltlc.resolve.computed_atoms import Computed, computed
from tltlc.resolve.spec import Param, Signal

ROUNDING: Final = 1e-9
"""How far rounding may take the value of an atom outside [-1, 1] without a warning."""


STEP_LENGTH: Final = "length of the step"
"""The key of a sample under which it has its time since the sample before, in seconds; no signal has this name."""


class SampleValues(NamedTuple):
    """The values of the atoms at a sample, each in [-1, 1], and of the registers after it, in order."""

    atoms: tuple[float, ...]
    registers: tuple[float, ...]


class Samples:
    """Computes the values of the atoms of an automaton from samples of its signals.

    ``initial`` are the values of the registers before the first sample, and ``given`` the indices of
    the atoms that do not follow from others.

    ``params`` maps names of params to values that replace the default ones. A warning about a
    clamped value is appended to ``notices``, at most one for each signal or atom. If they are ``sparse``,
    samples have only the events that happened: a missing bool counts as false.
    """

    def __init__(
        self, fspa: Fspa, params: Mapping[str, float] | None, notices: list[Diagnostic], *, sparse: bool = False
    ) -> None:
        self._fspa, self._notices, self._sparse = fspa, notices, sparse
        self._names = tuple(signal.name for signal in fspa.signals)
        self._noticed: set[tuple[str, str]] = set()
        self.initial = tuple(register.initial for register in fspa.registers)
        self._order = schedule(fspa)
        self.given = given_atoms(fspa)
        self._from_atoms = registers_from_atoms(fspa)
        self._computed_from: dict[frozenset[str], Computed] = {}
        registers = [register.name for register in fspa.registers]
        atoms = [AtomValue(atom.name) for atom in fspa.atoms] if registers else []
        length = (StepLength(),) if fspa.clock_varies else ()
        variables: tuple[VariableKey, ...] = (*self._names, *registers, *map(Before, registers), *atoms, *length)
        values = param_values(fspa.params, params or {})
        compiled = compile_expressions(
            [*(atom.expression for atom in fspa.atoms), *(register.update for register in fspa.registers)],
            variables,
            values,
        )
        self._atoms: tuple[Callable[[Sequence[float]], float], ...] = compiled[: len(fspa.atoms)]
        self._updates: tuple[Callable[[Sequence[float]], float], ...] = compiled[len(fspa.atoms) :]

    def another(self, notices: list[Diagnostic]) -> Samples:
        """Return samples of the same automaton and params, which share the compiled expressions.

        Their warnings are appended to ``notices``.
        """
        new = copy(self)
        new._notices, new._noticed = notices, set()
        return new

    def atom_values(self, signals: Mapping[str, SupportsFloat | str], when: int | str) -> tuple[float, ...]:
        """Return the values of the atoms at a sample of an automaton without registers, each in [-1, 1].

        ``when`` and the errors are those of :meth:`values`.
        """
        assert not self._updates, "with registers, the values depend on the samples before"
        return self._values(signals, (), (), when).atoms

    def of_trace(
        self, trace: Sequence[Mapping[str, SupportsFloat]], steps: range | None = None
    ) -> Iterator[SampleValues]:
        """Yield the values at the samples of a trace with the indices ``steps``, by default at all.

        ``trace`` begins with the first sample, which registers need. ``steps`` has no gaps. Without
        registers, only the samples in ``steps`` are read. Raises the errors of :meth:`values`.
        """
        steps = range(len(trace)) if steps is None else steps
        registers = self.initial
        for index in range(0 if self._updates else steps.start, steps.stop):
            sample = self.values(trace[index], registers, index + 1)
            registers = sample.registers
            if index >= steps.start:
                yield sample

    def values(
        self, signals: Mapping[str, SupportsFloat | str], registers: Sequence[float], when: int | str
    ) -> SampleValues:
        """Return the values of the atoms at a sample, and of the registers after it.

        ``registers`` are the values of the registers before the sample. If the clock varies, the sample
        has its length under :data:`STEP_LENGTH`. ``when`` says in messages which sample it is: its
        number, from 1, or a phrase.

        Raises:
            MonitorError: TLT0611 signals are missing, TLT0612 a signal has no finite value, TLT0613
                an atom has no value, TLT0619 the length of the step is wrong.
        """
        return self._values(signals, registers, self.step_length(signals.get(STEP_LENGTH), when), when)

    def _values(
        self,
        signals: Mapping[str, SupportsFloat | str],
        registers: Sequence[float],
        dt_s: tuple[float, ...],
        when: int | str,
    ) -> SampleValues:
        missing = [name for name in self._names if name not in signals]
        if missing:
            signals = self._completed(signals, missing, when)
        sample = [
            self._signal_value(signal, name, signals[name], when)
            for signal, name in zip(self._fspa.signals, self._names, strict=True)
        ]
        if self._updates:
            return self._with_registers(sample, registers, dt_s, when)
        values = [self._atom_value(index, sample, when) for index in range(len(self._atoms))]
        return SampleValues(
            tuple(self._clamped_atom_value(index, value, when) for index, value in enumerate(values)), ()
        )

    def _completed(
        self, signals: Mapping[str, SupportsFloat | str], missing: Sequence[str], when: int | str
    ) -> Mapping[str, SupportsFloat | str]:
        """Return the signals with false for each of those that are missing; raise TLT0611 unless that is allowed."""
        bools = {signal.name for signal in self._fspa.signals if signal.type == "bool"}
        needed = [name for name in missing if not (self._sparse and name in bools)]
        if needed:
            advice = MISSING_BOOLS if bools.issuperset(needed) else None
            raise sample_error("TLT0611", when, f"no value for {name_list(needed)}", advice)
        return {**dict.fromkeys(missing, 0.0), **signals}

    def step_length(self, given: SupportsFloat | str | None, when: int | str) -> tuple[float, ...]:
        """Return the length of a step in seconds if the clock varies, else nothing.

        Raises MonitorError (TLT0619) if the clock varies and ``given`` is no finite number of at least 0,
        or if it is a number although the clock does not vary.
        """
        if not self._fspa.clock_varies:
            if given is not None:
                advice = "leave it out, or write `clock varies` in the spec"
                raise sample_error("TLT0619", when, "it has a length, but the clock of the spec does not vary", advice)
            return ()
        if given is None:
            raise sample_error("TLT0619", when, "its time since the sample before is missing, and the clock varies")
        try:
            value = float(given) if hasattr(given, "__float__") and not getattr(given, "ndim", 0) else None
        except OverflowError:
            value = inf
        if value is None or not 0.0 <= value < inf:
            text = f"{given!r:.40}" if value is None else number_text(value)
            raise sample_error("TLT0619", when, f"its time since the sample before is {text}, not a number of seconds")
        return (value,)

    def from_atoms(
        self, given: Sequence[float], registers: Sequence[float], dt_s: tuple[float, ...], when: int | str
    ) -> SampleValues:
        """Return the values of all atoms and registers, from the values of the atoms that do not follow from others.

        ``given`` has a value for each of :func:`tltlc.automaton.memory.given_atoms`, in order, and
        ``dt_s`` is a result of :meth:`step_length`.
        Registers that read signals keep their value.
        """
        if not self._updates:
            return SampleValues(tuple(given), ())
        return self._with_registers(
            [0.0] * len(self._names), registers, dt_s, when, dict(zip(self.given, given, strict=True))
        )

    def of_test(
        self,
        numbers: Mapping[str, float],
        holds: Collection[str],
        registers: Sequence[float],
        dt_s: tuple[float, ...],
        when: int | str,
    ) -> SampleValues:
        """Return the values of all atoms and registers at a step of a test.

        ``numbers`` has the values of some signals. Atoms that depend on no other number are computed, as are
        those that follow from other atoms. Of the rest, those named in ``holds`` are 1, and all others -1.
        ``dt_s`` is a result of :meth:`step_length`; ``when`` and the errors are those of :meth:`values`.
        """
        fspa = self._fspa
        set_names = frozenset(numbers)
        if set_names not in self._computed_from:
            self._computed_from[set_names] = computed(set_names, fspa.atoms, fspa.registers, fspa.signals)
        computable = self._computed_from[set_names]
        names = {index: fspa.atoms[index].name for index in self.given}
        given = {index: 1.0 if name in holds else -1.0 for index, name in names.items() if name not in computable.atoms}
        sample = [numbers.get(name, float(name in holds)) for name in self._names]
        return self._with_registers(sample, registers, dt_s, when, given, computable.registers)

    def _with_registers(
        self,
        sample: Sequence[float],
        before: Sequence[float],
        dt_s: tuple[float, ...],
        when: int | str,
        given: Mapping[int, float] | None = None,
        updated: Collection[str] = (),
    ) -> SampleValues:
        """Return the values of atoms and registers at a sample, with the values of the atoms in ``given``.

        With ``given``, registers keep their value unless they follow from atoms or are named in ``updated``.
        """
        signals, count = len(self._names), len(self._updates)
        known = [*sample, *before, *before, *[0.0] * len(self._atoms), *dt_s]
        for step in self._order:
            index = step.index
            if step.kind == "atom":
                if given is not None and index in given:
                    known[signals + 2 * count + index] = given[index]
                else:
                    value = self._atom_value(index, known, when)
                    known[signals + 2 * count + index] = self._clamped_atom_value(index, value, when)
            elif given is None or (name := self._fspa.registers[index].name) in self._from_atoms or name in updated:
                known[signals + index] = self._register_value(index, known, when)
        atoms = known[signals + 2 * count : len(known) - len(dt_s)]
        return SampleValues(tuple(atoms), tuple(known[signals : signals + count]))

    def _register_value(self, index: int, known: Sequence[float], when: int | str) -> float:
        name = self._fspa.registers[index].name
        value = self._computed(self._updates[index], known, "register", name, when)
        if not isfinite(value):
            raise sample_error("TLT0613", when, f"the register `{name}` is too large to compute")
        return value

    def _signal_value(self, signal: Signal, name: str, given: SupportsFloat | str, when: int | str) -> float:
        """Return the value of a signal as a number, clamped to its range.

        Adds a warning to the notices the first time that a value of this signal is outside the
        range. ``name`` is ``signal.name``. Raises MonitorError (TLT0612) if the value is not a
        finite number, or if the value of a bool is neither 0 nor 1.
        """
        value = finite_signal_value(signal, given, when)
        low, high = signal.low, signal.high
        if signal.type == "bool":
            if value not in (0.0, 1.0):
                raise sample_error("TLT0612", when, f"the signal `{name}` is {number_text(value)}, not true or false")
            return value
        nearest = low if low is not None and value < low else high if high is not None and value > high else value
        if nearest != value and ("TLT0615", name) not in self._noticed:
            text = f"the signal `{name}` is {number_text(value)}, outside {range_text(low, high)}"
            self._notice("TLT0615", name, when, f"{text}: it counts as {number_text(nearest)}")
        return nearest

    def _atom_value(self, index: int, sample: Sequence[float], when: int | str) -> float:
        return self._computed(self._atoms[index], sample, "atom", self._fspa.atoms[index].name, when)

    def _computed(
        self,
        function: Callable[[Sequence[float]], float],
        sample: Sequence[float],
        kind: str,
        name: str,
        when: int | str,
    ) -> float:
        try:
            return function(sample)
        except ZeroDivisionError:
            problem = "divides by zero"
        except OverflowError:
            problem = "is too large to compute"
        except ValueError:
            problem = "takes a root or power that does not exist"
        raise sample_error("TLT0613", when, f"the {kind} `{name}` {problem}")

    def _clamped_atom_value(self, index: int, value: float, when: int | str) -> float:
        if -1.0 <= value <= 1.0:
            return value
        name = self._fspa.atoms[index].name
        if not isfinite(value):
            raise sample_error("TLT0613", when, f"the atom `{name}` is too large to compute")
        nearest = 1.0 if value > 0.0 else -1.0
        if abs(value - nearest) > ROUNDING:
            text = f"the atom `{name}` is {number_text(value)}, outside [-1, 1]"
            self._notice("TLT0616", name, when, f"{text}: it counts as {number_text(nearest)}")
        return nearest

    def _notice(self, code: str, name: str, when: int | str, text: str) -> None:
        if (code, name) not in self._noticed:
            self._noticed.add((code, name))
            self._notices.append(Diagnostic(code, f"{sample_place(when)}: {text}", (), SUGGESTIONS[code], "warning"))


def param_values(params: Sequence[Param], given: Mapping[str, float]) -> dict[str, float]:
    """Return the value of every param: the value in ``given``, or its default.

    Raises:
        MonitorError: TLT0308 there is no param with a given name, or the value is not a finite
            number; TLT0307 the value is outside the range of the param, or is not
            whole although the param is an int.
    """
    param_by_name = {param.name: param for param in params}
    for name, value in given.items():
        if name not in param_by_name:
            advice = (
                f"there are: {name_list(list(param_by_name))}"
                if param_by_name
                else "its atoms use no params: leave it out"
            )
            raise _param_error("TLT0308", f"there is no param `{name}` to set", advice)
        if isinstance(value, str) or not hasattr(value, "__float__"):
            raise _param_error("TLT0308", f"the value given for the param `{name}` is not a number")
        low, high = param_by_name[name].low, param_by_name[name].high
        if not isfinite(value):
            raise _param_error("TLT0308", f"the param `{name}` cannot be {number_text(value)}")
        if param_by_name[name].type == "int" and not float(value).is_integer():
            title = f"the param `{name}` cannot be {number_text(value)}: it is an int"
            raise _param_error("TLT0307", title, "give a whole number in its range")
        if (low is not None and value < low) or (high is not None and value > high):
            title = f"the param `{name}` cannot be {number_text(value)}: its range is {range_text(low, high)}"
            raise _param_error("TLT0307", title)
    return {name: float(given.get(name, param.value)) for name, param in param_by_name.items()}


def _param_error(code: str, title: str, advice: str = "give a number in its range, in SI units") -> MonitorError:
    return MonitorError([Diagnostic(code, title, help=advice)])


def number_text(value: float) -> str:
    """Return a number as text for a message, such as ``0.1`` or ``3``, without rounding."""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def range_text(low: float | None, high: float | None) -> str:
    """Return a range as text, for example ``[0, inf]``."""
    return f"[{'-inf' if low is None else number_text(low)}, {'inf' if high is None else number_text(high)}]"


def name_list(names: Sequence[str]) -> str:
    """Return one or more names in backticks, as a list with commas and ``and`` before the last name."""
    quoted = [f"`{name}`" for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"


def finite_signal_value(signal: Signal, given: SupportsFloat | str, when: int | str) -> float:
    """Return the value of a signal as a finite number; for an enum, ``given`` may be the name of a value.

    ``when`` says in messages which sample it is: its number, from 1, or a phrase.

    Raises:
        MonitorError: TLT0612 the value is not a finite number, or the enum has no value of this name.
    """
    value = given if type(given) is float else _as_float(signal, given, when)
    if not isfinite(value):
        raise sample_error("TLT0612", when, f"the signal `{signal.name}` is {value}, not a finite number")
    return value


def _as_float(signal: Signal, given: SupportsFloat | str, when: int | str) -> float:
    if getattr(given, "ndim", 0):
        raise sample_error("TLT0612", when, f"the signal `{signal.name}` is an array, not a number")
    if isinstance(given, str) and signal.values:
        return _value_of_name(signal, given, when)
    if isinstance(given, str) or not hasattr(given, "__float__"):
        raise sample_error("TLT0612", when, f"the signal `{signal.name}` is not a number")
    try:
        return float(given)
    except OverflowError:
        raise sample_error("TLT0612", when, f"the signal `{signal.name}` is too large for a number") from None


def _value_of_name(signal: Signal, name: str, when: int | str) -> float:
    if name not in signal.values:
        raise sample_error(
            "TLT0612", when, f"the signal `{signal.name}` has no value `{name:.40}`", values_advice(signal)
        )
    return float(signal.values.index(name))


def values_advice(signal: Signal) -> str:
    """Return the advice for an enum that has an unknown value."""
    return f"its values are {name_list(signal.values)}, or the numbers from 0 to {len(signal.values) - 1}"
