"""The tables that one run of resolution fills: declared signals and params, atoms in use, counted work."""

from __future__ import annotations

from itertools import islice
from typing import Any, Final

from tltlc.core.names import full_name
from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import Expression, nodes
from tltlc.grammar.tree import CallExpr, Expr, NameExpr
from tltlc.grammar.walk import parts
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula, atom
from tltlc.resolve.problem import Log, ResolutionError, problem
from tltlc.resolve.registers import RegisterDraft
from tltlc.resolve.spec import Atom, Bound, Param, Signal, Timer, ValueType

LARGEST_EXPANSION = 100_000
"""The most nodes in the tree of a formula after its bounds, quantifiers and lets are expanded."""
MOST_EXPANSIONS = 50_000
"""The most times that lets and quantifiers may be expanded in one run of resolution."""


@record
class SignalInfo:
    """The declaration of a signal.

    If the signal has parameters, the declaration stands for many signals: one for each choice of
    entities (objects of the level) as arguments.
    """

    name: str
    parameters: tuple[str, ...]
    type: ValueType
    low: float | None
    high: float | None
    doc: str
    has_range: bool
    """Whether the range is written in the declaration, not taken from the type."""
    place: Label
    values: tuple[str, ...] = ()
    """The names of the values of an enum; empty for other signals."""

    def signal_of(self, entities: tuple[str, ...]) -> Signal:
        """Return the signal of this declaration that has these entities as its arguments."""
        return Signal(self.name, self.type, self.low, self.high, self.doc, entities, self.values)


@record
class Instance:
    """A predicate with its arguments, recorded so that its range and continuity will be checked.

    ``expression`` is the value of the predicate, and ``low`` and ``high`` are its declared range. In
    ``expression``, the names of parameters replace entities (objects of the level): ``near(s1)`` and
    ``near(s2)`` share one check. ``source`` and ``span`` are the place of the declaration.
    """

    name: str
    expression: Expression
    low: float
    high: float
    source: SourceFile
    span: Span
    use: Label | None = None
    """The place of a use that passes numbers, as in ``near(s1, close = 3 m)``; None if no numbers are passed.

    What the check finds depends on these numbers.
    """


class Context:
    """The tables that fill up while a program is resolved.

    - ``log`` collects the diagnostics.
    - ``signal_infos`` and ``params`` have the declared signals and params, by name.
    - ``clock_s`` is the time between two samples in seconds, None without a clock or if it varies;
      ``clock_varies`` says so. ``clock_failed`` is true if a declaration of a clock is in error.
    - ``registers`` has the memory that any formula or predicate asked for, by name, each register
      after those that it reads at the same sample. ``signals`` has a signal in place of each, so that
      its range is known. ``recalls`` counts the functions of the past around the current expression, and
      ``levels`` the operators around them.
    - ``signals`` and ``atoms`` have those in use, by full name, such as ``near(s1)``.
    - ``instances`` has the predicates to be checked.
    - ``values`` caches the values of signals, predicates, lets (named formulas), calls and
      comparisons.
    - ``expanding`` maps the identity of a declaration to its name, for each let or predicate that is
      being expanded, outermost first.
    - ``broken`` has the identities of the declarations whose error has been reported.
    - ``values_of_signals`` maps the atoms that compare a signal with one value, such as ``phase == 2``
      and ``mode(g1) is alert``, to the name of the signal.
    - ``bounds`` has the bounds resolved so far, and ``bound_of`` the latest bound of each bounded
      operator.
    - ``expansions`` counts the expansions of lets and quantifiers so far.
    - ``limit_text`` is the limit of the current spec as written, if it is a time, for advice.
    - ``unfolded`` has the names of the specs in which no timer replaces a bound.

    The identity of an object is its ``id()``. A key of ``instances`` or ``values`` contains the
    identity of a declaration or expression, and the values of its parameters or local names.
    """

    __slots__ = (
        "_arithmetic",
        "_names",
        "_sizes",
        "atoms",
        "bound_of",
        "bounds",
        "broken",
        "clock_failed",
        "clock_s",
        "clock_varies",
        "expanding",
        "expansions",
        "instances",
        "levels",
        "limit_text",
        "log",
        "params",
        "recalls",
        "registers",
        "signal_infos",
        "signals",
        "unfolded",
        "values",
        "values_of_signals",
    )

    def __init__(self, *, unfolded: tuple[str, ...] = ()) -> None:
        self.unfolded = unfolded
        self.log = Log()
        self.signal_infos: dict[str, SignalInfo] = {}
        self.params: dict[str, Param] = {}
        self.clock_s: float | None = None
        self.clock_varies = False
        self.clock_failed = False
        self.signals: dict[str, Signal] = {}
        self.atoms: dict[str, Atom] = {}
        self.registers: dict[str, RegisterDraft] = {}
        self.recalls = self.levels = 0
        self.limit_text = ""
        self.values_of_signals: dict[str, str] = {}
        self.bounds: list[Bound] = []
        self.bound_of: dict[Formula, Bound] = {}
        self.instances: dict[tuple[int, Any], Instance] = {}
        self.expanding: dict[int, str] = {}
        self.broken: set[int] = set()
        self.expansions = 0
        self.values: dict[Any, Any] = {}
        self._arithmetic = 0
        self._names: dict[int, tuple[str, ...]] = {}
        self._sizes: dict[Formula, int] = {}

    def signal(self, info: SignalInfo, entities: tuple[str, ...], source: SourceFile, span: Span) -> Signal:
        """Return the signal with these entities as its arguments, and record that it is used.

        Raises ResolutionError (TLT0216) if a register has its name.
        """
        signal = info.signal_of(entities)
        if signal.name in self.registers:
            raise _same_name_error(signal.name, source, span)
        return self.signals.setdefault(signal.name, signal)

    def register(
        self, draft: RegisterDraft, source: SourceFile, span: Span, replaces: RegisterDraft | None = None
    ) -> None:
        """Record a register that an atom or another register reads.

        ``replaces`` is the register of this name that this one replaces, since it remembers more.
        Raises ResolutionError if a signal, or a register with another meaning, has its name (TLT0216), or
        if the arithmetic of all atoms and registers together is too large (TLT0315).
        """
        known = self.signals.get(draft.name)
        if known is not None and known.arguments:
            raise _same_name_error(draft.name, source, span)
        if replaces is not None and self.registers.get(draft.name) == replaces:
            del self.registers[draft.name]
        if draft.name not in self.registers:
            self._arithmetic += self.count_arithmetic(draft.update, source, span, self._arithmetic)
        if self.registers.setdefault(draft.name, draft) != draft:
            title = f"`{draft.name}` would stand for two different numbers"
            raise problem("TLT0216", title, source, span, advice=_RENAME)
        # The check of a definition with placeholders may have left a signal of this name without a range.
        self.signals[draft.name] = Signal(draft.name, "number", draft.low, draft.high)

    def atom(
        self,
        base: str,
        expression: Expression,
        doc: str,
        source: SourceFile,
        span: Span,
        arguments: tuple[str, ...] = (),
        timer: Timer | None = None,
    ) -> Formula:
        """Return the atom with this base name and these arguments, and record it.

        Raises ResolutionError if the name already belongs to another expression (TLT0216), or if
        the arithmetic of all atoms together is too large (TLT0315).
        """
        name = full_name(base, arguments)
        if name not in self.atoms:
            self._arithmetic += self.count_arithmetic(expression, source, span, self._arithmetic)
        known = self.atoms.setdefault(name, Atom(base, expression, doc, arguments, timer))
        if known.expression != expression:
            raise problem(
                "TLT0216",
                f"two different predicates would both become the atom `{name}`",
                source,
                span,
                advice="rename one of them: names of atoms must differ in the compiled automaton",
            )
        return atom(name)

    def count_arithmetic(self, expression: Expression, source: SourceFile, span: Span, counted_before: int = 0) -> int:
        """Return the number of nodes of an expression.

        Raises ResolutionError (TLT0315) if this number plus ``counted_before``, the number of nodes of
        earlier atoms and registers, exceeds the limit for all of them.
        """
        left = WORK["arithmetic of all atoms"] - counted_before
        size = sum(1 for _ in islice(nodes(expression), left + 1))
        if size > left:
            raise problem(
                "TLT0315",
                f"the arithmetic of all atoms has more than {WORK['arithmetic of all atoms']:,} parts",
                source,
                span,
                "after each predicate is replaced by its arithmetic",
                advice="nest predicates less often, or let the game compute the value",
            )
        return size

    def recursion_error(self, declaration: int, source: SourceFile, span: Span) -> ResolutionError:
        """Return the error for a ``let`` or predicate whose definition uses itself, directly or through others.

        Mark all definitions of the cycle as reported. ``declaration`` is the identity of the ``let`` or
        predicate, a key of ``expanding``. The error has no diagnostic if the cycle was already reported.
        """
        active = list(self.expanding)
        cycle = active[active.index(declaration) :]
        names = [self.expanding[key] for key in (*cycle, declaration)]
        if self.broken.intersection(cycle):
            return ResolutionError(None)
        self.broken.update(cycle)
        return problem(
            "TLT0207",
            f"`{names[0]}` is defined in terms of itself: " + " -> ".join(names),
            source,
            span,
            advice="a definition cannot use itself, directly or through others",
        )

    def names_in(self, expr: Expr) -> tuple[str, ...]:
        """Return the distinct names in an expression, such as those of signals and parameters, in order."""
        names = self._names.get(id(expr))
        if names is None:
            unique = dict.fromkeys(part.name for part in parts(expr) if isinstance(part, (NameExpr, CallExpr)))
            names = self._names[id(expr)] = tuple(unique)
        return names

    def tree_size(self, formula: Formula) -> int:
        """Return the number of nodes of a formula; a part that occurs several times counts each time."""
        if formula in self._sizes:
            return self._sizes[formula]
        stack = [formula]
        while stack:
            node = stack[-1]
            missing = [child for child in node.args if child not in self._sizes]
            if missing:
                stack.extend(missing)
            else:
                self._sizes[node] = 1 + sum(self._sizes[child] for child in node.args)
                stack.pop()
        return self._sizes[formula]

    def check_size(
        self, formula: Formula, subject: str, source: SourceFile, span: Span, *, is_bound: bool = False
    ) -> Formula:
        """Return the formula unchanged; raise ResolutionError (TLT0315) if it has too many nodes.

        In the error, ``subject`` names what was expanded, such as "the let `escape`". If ``is_bound``,
        the advice of the error is about the bound of a temporal operator.
        """
        if self.tree_size(formula) > LARGEST_EXPANSION:
            raise expansion_error(subject, source, span, is_bound=is_bound)
        return formula


_SMALLER_BOUND: Final = (
    "choose a smaller bound or a slower clock, or ask about the past, as in `time_holding(p) >= 60 s`"
)
_FEWER_USES: Final = "its size multiplies with each use inside another: nest fewer of them"
_FEWER_EXPANSIONS: Final = "each one inside another multiplies their number: nest fewer of them"


_RENAME: Final = "two signals or predicates of different files have the same name: rename one of them"


def _same_name_error(name: str, source: SourceFile, span: Span) -> ResolutionError:
    base = name.split("(")[0]
    title = f"`{name}` is both a value of the signal `{base}` and of the function `{base}`"
    return problem("TLT0216", title, source, span, advice=f"rename the signal `{base}`")


def expansion_error(subject: str, source: SourceFile, span: Span, *, is_bound: bool = False) -> ResolutionError:
    """Return the error for a formula that is too large after expansion.

    ``subject`` names the bound, ``let``, quantifier or parameter that was expanded. If ``is_bound``, the
    advice of the error is about the bound of a temporal operator.
    """
    return problem(
        "TLT0315",
        f"{subject} expands to more than {LARGEST_EXPANSION:,} parts",
        source,
        span,
        advice=_SMALLER_BOUND if is_bound else _FEWER_USES,
    )


def too_many_expansions_error(source: SourceFile, span: Span) -> ResolutionError:
    """Return the error for a program with more than MOST_EXPANSIONS uses of ``let`` definitions and quantifiers."""
    return problem(
        "TLT0315",
        f"the uses of `let`, `all` and `any` expand more than {MOST_EXPANSIONS:,} times",
        source,
        span,
        advice=_FEWER_EXPANSIONS,
    )
