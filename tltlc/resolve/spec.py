"""The records of a resolved specification, in which every name, type and unit is known.

They do not contain parts of the syntax tree, only spans in the source text for messages.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from tltlc.core.names import ComparisonName, full_name
from tltlc.core.record import EMPTY, record
from tltlc.core.source import SourceFile, Span
from tltlc.expression.tree import Expression
from tltlc.logic.formula import Formula

ValueType = Literal["number", "ratio", "length", "time", "speed", "angle", "int", "bool"]
JudgeMode = Literal["goal", "limit"]


@record
class Signal:
    """A number that the game supplies at each step, in SI units.

    ``low`` or ``high`` is None where the range is open. ``arguments`` are the entities (objects of
    the level) that the signal is about. ``values`` are the names of the values of an enum: 0, 1, 2
    in order; the type is then ``int``.
    """

    base: str
    type: ValueType
    low: float | None
    high: float | None
    doc: str = ""
    arguments: tuple[str, ...] = ()
    values: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The full name: ``distance(s1)`` for the base ``distance`` with the argument ``s1``."""
        return full_name(self.base, self.arguments)


@record
class Param:
    """A constant, in SI units, that may be overridden within its range when the automaton is loaded."""

    name: str
    type: ValueType
    value: float
    low: float | None
    high: float | None
    doc: str = ""


@record
class Timer:
    """What an atom that takes the place of a bound knows beside its name.

    ``later`` says for each goal of a chain but the first whether it must come at a later sample than the
    goal before it.
    """

    later: tuple[bool, ...] = ()


@record
class Atom:
    """An atom: it is true at a sample where its expression, whose value lies in [-1, 1], is above 0.

    ``near(s1)`` has the base ``near`` and the argument ``s1``. An atom that is a comparison, such as
    ``x > 3``, has its text as its base and no arguments. ``timer`` is not None for the atoms that
    take the place of a bound, such as ``late(5 s, alarm, hidden)``.
    """

    base: str
    expression: Expression
    doc: str = ""
    arguments: tuple[str, ...] = ()
    timer: Timer | None = None

    @property
    def name(self) -> str:
        """The full name: ``near(s1)`` for the base ``near`` with the argument ``s1``."""
        return full_name(self.base, self.arguments)

    @property
    def opposite(self) -> str | None:
        """The comparison that holds where the atom does not: ``x <= 3`` for ``x > 3``; None for other atoms."""
        return self.base.opposite if isinstance(self.base, ComparisonName) else None


RegisterKind = Literal[
    "once",
    "historically",
    "since",
    "previously",
    "times",
    "time_since",
    "time_holding",
    "times_since",
    "total_time",
    "total_time_since",
    "times_within",
    "begun",
    "previous",
    "initial",
    "highest",
    "lowest",
    "highest_since",
    "lowest_since",
    "value_at",
    "samples",
    "elapsed",
    "run",
    "age",
    "due",
    "waiting",
    "breach",
    "last",
    "first",
]


@record
class Register:
    """A number that a monitor keeps from sample to sample: a function of the trace so far.

    - ``kind`` says which function. A register of kind ``last`` keeps a value for the next sample, and
      one of kind ``first`` is 1 until the first sample has been taken.
    - ``unit`` is ``steps`` or an SI unit; empty for plain numbers, counts and robustness.
    - ``low`` and ``high`` bound the value; None where there is no bound. ``initial`` is the value
      before the first sample.
    - ``update`` is the value at a sample. It may read signals, params, atoms, registers that come
      earlier in the list, and the values of all registers before the sample.

    No signal has the name of a register.
    """

    name: str
    kind: RegisterKind
    unit: str
    low: float | None
    high: float | None
    initial: float
    update: Expression


@record
class Bound:
    """A bound of a temporal operator: its upper end, in samples, and its place in the text.

    ``operator`` is the word of the operator, and ``op`` says which one it is, as in the syntax tree. If
    not ``words``, the bound is in brackets.
    """

    samples: int
    source: SourceFile
    span: Span
    operator: str
    op: str
    words: bool


@record
class Conjunct:
    """One conjunct of a spec's formula, with the place of its clause, so that errors can show the clause.

    ``text`` is the clause on one line, with operators as words and without comments: ``avoid on_lava``. It does
    not depend on how the source is laid out. It is empty for a formula that stands in no source.

    ``bounds`` are the bounds that were expanded in the clause. ``unbounded`` is the formula with
    ``F p`` for ``F[0,3] p`` and ``G p`` for ``G[0,3] p``; None if it equals ``formula``. It decides
    whether an episode is judged at its goal or at its limit (docs/adr/0009).
    """

    formula: Formula
    source: SourceFile
    span: Span
    text: str = ""
    bounds: tuple[Bound, ...] = ()
    unbounded: Formula | None = None


@record
class Spec:
    """A specification from which an automaton can be built.

    ``parts`` are the conjuncts of ``formula``. ``atoms`` are the atoms of the formula in order of
    appearance, then those that only registers read, then those that occur only in ``exclusive``.
    ``exclusive`` has groups of indices into
    ``atoms``: no two atoms of a group hold at the same sample. ``signals`` and ``params`` are those
    that the atoms use, in order of first use. ``registers`` are the memory that the atoms read, each
    after the registers that its update reads at the same sample. ``judge`` says whether an episode is judged when it
    reaches its goal or at its limit; None if no clause says so. ``clock_s`` is the time between two
    samples in seconds, or None if no clock is declared. ``clock_varies`` says that each sample brings its
    own time since the sample before; then ``clock_s`` is None.
    """

    name: str
    doc: str
    formula: Formula
    parts: tuple[Conjunct, ...]
    atoms: tuple[Atom, ...]
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]
    exclusive: tuple[tuple[int, ...], ...]
    level: str | None
    limit_steps: int | None
    judge: JudgeMode | None
    semantics: Literal["finite", "infinite"]
    tags: tuple[str, ...]
    clock_s: float | None
    source: SourceFile
    name_span: Span
    registers: tuple[Register, ...] = ()
    clock_varies: bool = False


@record
class Vocabulary:
    """A list of atoms that belong to no formula, with the signals and params that they use.

    ``atoms`` are the requested atoms in order, then those that only registers read, then those that
    occur only in ``exclusive``. The other fields are as in :class:`Spec`.
    """

    atoms: tuple[Atom, ...]
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]
    exclusive: tuple[tuple[int, ...], ...]
    clock_s: float | None
    registers: tuple[Register, ...] = ()
    clock_varies: bool = False


@record
class RepeatedSample:
    """A ``step`` of a test: a sample, repeated ``times`` times.

    ``numbers`` maps the names of signals that the test sets to their values, in SI units. Atoms that
    depend on no other number are computed. Of the rest, those named in ``holds`` are true at the sample,
    and all others are false. ``dt_s`` is the time of each sample since the sample before, in seconds,
    where the clock varies.
    """

    times: int
    holds: frozenset[str]
    numbers: Mapping[str, float] = EMPTY
    dt_s: float = 0.0


@record
class Expect:
    """An ``expect`` of a test: what must be true after the steps before it.

    ``kind`` says what is compared with ``value``: the ``verdict`` (``"pending"``), the ``progress`` (a
    number from 0 to 1), or the label of the ``state`` (``"F a"``). ``comparison`` is one of
    ``< <= > >=`` for progress, else None.
    """

    kind: Literal["verdict", "progress", "state"]
    value: str | float
    comparison: str | None
    source: SourceFile
    span: Span


@record
class Test:
    """A ``test`` block: samples, and what must be true after them, in the order of the text.

    ``spec`` is the name of the spec that is tested.
    """

    title: str
    spec: str
    items: tuple[RepeatedSample | Expect, ...]
    source: SourceFile
    span: Span


@record
class ResolvedFile:
    """A resolved file: its own specs and tests, in order.

    ``exclusive`` has all atoms, and all groups of atoms, that the file and its imports declare
    ``exclusive``, even if no spec uses them.
    """

    specs: tuple[Spec, ...]
    tests: tuple[Test, ...]
    exclusive: Vocabulary = Vocabulary((), (), (), (), None)
