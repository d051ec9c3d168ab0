"""Find the ranges of atoms and registers at every sample, by induction over the samples of a trace.

The registers before the first sample have their initial values. If all registers are in certain
ranges before a sample, and the sample leaves each of them in its range, then they always are. The
ranges that a spec declares for its registers are tried first. A range that a sample may leave is
given up: its register may then have any finite value, since the monitor checks that it is finite.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from tltlc.core.record import record
from tltlc.program.bounds import ValueRange, prove_ranges, range_between
from tltlc.program.tree import Statement
from tltlc.program.used_names import variables_read
from tltlc.resolve.spec import Register

_ANY = range_between(None, None)
_ATOM = ValueRange(-1.0, 1.0)
"""The range of atoms and flags."""


@record
class RegisterVariables:
    """The variables of a register in a program: its value after a sample (``now``), and that before it."""

    register: Register
    now: str
    before: str


@record
class ProvedStatements:
    """Statements that assign a variable, and the range of its value; None if the value may be NaN."""

    statements: tuple[Statement, ...]
    range: ValueRange | None

    @property
    def is_finite(self) -> bool:
        """Whether it is proved that the value is a finite number."""
        return self.lies_in(_ANY.low, _ANY.high)

    def lies_in(self, low: float, high: float) -> bool:
        """Whether it is proved that the value is a number from ``low`` to ``high``."""
        return self.range is not None and low <= self.range.low and self.range.high <= high


def prove_sample(
    computations: Mapping[str, Sequence[Statement]],
    registers: Sequence[RegisterVariables],
    known: Mapping[str, ValueRange],
    flags: Collection[str] = (),
) -> dict[str, ProvedStatements]:
    """Replace ``divide`` by ``/`` where the divisor is never 0, and find the ranges of atoms and registers.

    Also drop the maximum of a register where the register never exceeds it.

    ``computations`` maps the variables of atoms and registers to the statements that assign them, in
    the order in which a monitor computes them. ``known`` has the ranges of signals and params. The
    monitor clamps each atom to [-1, 1], and ends a step in which a register is not finite. ``flags`` are the
    variables that are Booleans: they are true where the atom or register is 1, and false where it is -1.
    """
    before = {each.before: _claimed(each.register) for each in registers}
    while True:
        proved = _one_sample(computations, {each.now for each in registers}, {**known, **before}, flags)
        left = [each.before for each in registers if not _stays(proved[each.now], before[each.before])]
        if not left:
            return proved
        before |= dict.fromkeys(left, _ANY)


def proved_ranges(
    proved: Mapping[str, ProvedStatements], atoms: Collection[str], registers: Sequence[RegisterVariables]
) -> dict[str, ValueRange]:
    """Return the ranges of atoms, and of registers before and after a sample, by variable; those that are known."""
    ranges = {name: _common(proved[name].range, _ATOM) for name in atoms}
    for each in registers:
        ranges[each.now] = now = _common(proved[each.now].range, _ANY)
        # Before the first sample, a register has its initial value.
        initial = each.register.initial
        ranges[each.before] = ValueRange(min(now.low, initial), max(now.high, initial))
    return ranges


def _one_sample(
    computations: Mapping[str, Sequence[Statement]],
    registers: set[str],
    known: Mapping[str, ValueRange],
    flags: Collection[str],
) -> dict[str, ProvedStatements]:
    """Return the statements and ranges of one sample, before which the variables are in the ``known`` ranges."""
    ranges = dict(known)
    proved: dict[str, ProvedStatements] = {}
    for name, statements in computations.items():
        read = variables_read(statements) & ranges.keys()
        proved[name] = ProvedStatements(
            *prove_ranges(name, statements, {variable: ranges[variable] for variable in read}, registers)
        )
        if name in flags:
            # No number is read from the Boolean itself.
            proved[name] = ProvedStatements(proved[name].statements, _ATOM)
            continue
        checked = _ANY if name in registers else _ATOM
        ranges[name] = _common(proved[name].range, checked)
    return proved


def _claimed(register: Register) -> ValueRange:
    """Return the range that is declared for a register, or that of all numbers if it does not begin in it."""
    declared = range_between(register.low, register.high)
    return declared if declared.low <= register.initial <= declared.high else _ANY


def _stays(proved: ProvedStatements, claimed: ValueRange) -> bool:
    return claimed == _ANY or proved.lies_in(claimed.low, claimed.high)


def _common(range_: ValueRange | None, checked: ValueRange) -> ValueRange:
    """Return the range of a value after the monitor has checked that it is in ``checked``, or brought it there."""
    if range_ is None:
        return checked
    return ValueRange(*(min(max(end, checked.low), checked.high) for end in (range_.low, range_.high)))
