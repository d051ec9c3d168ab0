"""Translate the expressions of predicates to statements of a program.

Three kinds of subexpressions get temporary variables:

- a ``when``, an expression that has the value of its first case whose condition is true: an ``if``
  before the expression assigns the value;
- an expression that is nested too deep for the parsers of some languages;
- the base of a power that is written as a product.

As in Python, later operands of ``and`` and ``or`` are computed only if they are needed. If a later
operand needs statements of its own, they are inside an ``if``.

``if`` statements are nested at most about :data:`_MOST_BRANCHES` deep, since Python allows 100
levels of indentation, and Lua 200 levels of blocks. A ``when`` that is nested deeper gets a
variable. Its value is computed before the whole expression, but only if all the conditions that
lead to it are true.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import reduce
from typing import Final, Union, overload

from tltlc.core.record import replace
from tltlc.expression import tree as source
from tltlc.expression.evaluate import MULTIPLIED_EXPONENTS
from tltlc.program.flags import Flags, Truths
from tltlc.program.operations import all_or_any, nesting_depth, operation
from tltlc.program.tree import (
    Assign,
    BinaryNumber,
    Bool,
    Choice,
    Compare,
    Declare,
    If,
    Not,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
    Type,
)

_DEEPEST: Final = 30
"""The greatest depth of an expression.

C# and GDScript compilers allow hundreds of levels, Lua 200.
"""

_MOST_BRANCHES: Final = 20
"""The greatest depth of ``if`` statements.

Two kinds of nesting are counted separately, and each may be this deep: ``when`` expressions inside
each other, and the ``else`` parts that hold later cases of one ``when``.
"""

_READ: Final = (source.SignalValue, source.AtomValue, source.Before, source.StepLength)
_ZERO: Final = source.Const(0.0)

_SourceNode = Union[source.Expression, source.Condition]


class _BranchPath:
    """The conditions that are all true where an expression is computed, as a linked list.

    ``condition`` is the last condition, and ``before`` has the others (None if there are none).
    ``variable`` is the variable of the program that says whether all these conditions are true. It
    is None until a statement needs it.
    """

    __slots__ = ("before", "condition", "variable")

    def __init__(self, before: _BranchPath | None, condition: source.Condition) -> None:
        self.before, self.condition = before, condition
        self.variable: ProgramVariable | None = None


def with_declaration(name: str, statements: Sequence[Statement], *, changes: bool = True) -> tuple[Statement, ...]:
    """Return ``statements``, changed so that they declare the variable ``name``.

    ``statements`` come from :meth:`ExpressionTranslator.assign`, which assigns a value to ``name``; or they declare
    it already, as those from :meth:`ExpressionTranslator.declare_flag` do.
    If the last statement assigns this value, a declaration with the value replaces it. Otherwise, a
    declaration without a value comes first. ``changes`` says whether the variable is assigned again
    later, for example when the value of an atom is clamped to [-1, 1].
    """
    if any(isinstance(statement, Declare) and statement.name == name for statement in statements):
        return tuple(statements)
    *before, last = statements
    if isinstance(last, Assign) and last.name == name:
        return (*before, Declare(name, "real", last.value, changes))
    return (Declare(name, "real", None, changes or _is_reassigned(name, statements)), *statements)


def _is_reassigned(name: str, statements: Sequence[Statement]) -> bool:
    """Whether the statements may assign a value to the variable ``name`` more than once."""
    for place, statement in enumerate(statements, start=1):
        if isinstance(statement, Assign) and statement.name == name and place < len(statements):
            return True
        if isinstance(statement, If):
            bodies = (*(body for _, body in statement.cases), statement.otherwise)
            if any(_is_reassigned(name, body) for body in bodies):
                return True
    return False


class ExpressionTranslator:
    """Translates expressions to statements.

    ``signals`` and ``params`` map the names of signals and parameters to variables. For updates of
    registers, ``signals`` also maps the names of registers, and the nodes that read anything else. The
    names of temporary variables are ``prefix`` and a number: ``t_1``, ``t_2``, and so on, with the
    prefix ``t_``. No two of them have the same name.

    ``flags`` are the atoms and registers that are only -1 or 1 (:mod:`tltlc.program.flags`), if there are any.
    Those in ``booleans`` have a variable that is true where they are 1; so may bool signals, which are 0 or 1.
    """

    def __init__(
        self,
        signals: Mapping[source.VariableKey, str],
        params: Mapping[str, str],
        prefix: str,
        flags: Flags | None = None,
        booleans: Collection[source.VariableKey] = (),
    ) -> None:
        self._signals, self._params, self._prefix = dict(signals), params, prefix
        self._flags, self._booleans = flags, booleans
        self._truths = None if flags is None else Truths(flags)
        self._count = 0

    def declare_flag(self, name: str, expression: source.Expression) -> list[Statement]:
        """Return statements that declare the Boolean ``name``: it is true where a flag, an expression, is 1."""
        assert self._truths is not None, "the expression is a flag"
        lines: list[Statement] = []
        test = self._test(self._truths.condition(expression), lines)
        return [*lines, Declare(name, "bool", test)]

    def assign(self, name: str, expression: source.Expression) -> list[Statement]:
        """Return statements that assign the value of an expression to the variable ``name``."""
        lines: list[Statement] = []
        if _branch_depth(expression) > _MOST_BRANCHES:
            expression = self._split(expression, lines, None, 0)
        if isinstance(expression, source.When):
            return [*lines, *self._cases(name, expression)]
        value = self._value(expression, lines)
        return [*lines, Assign(name, value)]

    def _cases(self, name: str, node: source.When, depth: int = 1) -> list[Statement]:
        """Return statements that assign the value of a ``when`` to the variable ``name``.

        A ``when`` has the value of its first case whose condition is true. The ``when`` becomes one
        ``if``, with a case for each of its cases. If the condition of a later case needs statements
        of its own, these are in the ``else``, followed by a further ``if`` for this case and the
        cases after it. ``depth`` is the number of ``if`` statements that are nested for this
        reason, from 1.
        """
        condition, value = node.cases[0]
        before: list[Statement] = []
        cases = [(self._test(condition, before), tuple(self.assign(name, value)))]
        for index, (condition_after, its_value) in enumerate(node.cases[1:], start=1):
            needed: list[Statement] = []
            test = self._test(condition_after, needed)
            if needed:
                rest = source.When(node.cases[index:], node.otherwise)
                if depth >= _MOST_BRANCHES:
                    return [*before, *self._sequential_cases(name, tuple(cases), rest)]
                return [*before, If(tuple(cases), tuple(self._cases(name, rest, depth + 1)))]
            cases.append((test, tuple(self.assign(name, its_value))))
        return [*before, If(tuple(cases), tuple(self.assign(name, node.otherwise)))]

    def _sequential_cases(
        self, name: str, first: tuple[tuple[ProgramExpression, tuple[Statement, ...]], ...], rest: source.When
    ) -> list[Statement]:
        """Return statements that assign the value of a ``when`` to ``name``, without nesting its cases.

        A ``when`` has the value of its first case whose condition is true. ``first`` are the first
        cases, as tests with their bodies, and ``rest`` has the cases after them. The first cases
        become one ``if``. Each later case becomes an ``if`` of its own. A temporary variable says
        whether no case before it was selected.
        """
        lines: list[Statement] = [Assign(name, Real(0.0))]
        open_ = ProgramVariable(self._declare("bool", lines, changes=True))
        lines.append(Assign(open_.name, Bool(True)))
        lines.append(If(tuple((test, (*body, Assign(open_.name, Bool(False)))) for test, body in first)))
        for condition, value in rest.cases:
            needed: list[Statement] = []
            test = self._test(condition, needed)
            taken = (*self.assign(name, value), Assign(open_.name, Bool(False)))
            lines.append(If(((open_, (*needed, If(((test, taken),)))),)))
        lines.append(If(((open_, tuple(self.assign(name, rest.otherwise))),)))
        return lines

    @overload
    def _split(
        self, node: source.Condition, lines: list[Statement], path: _BranchPath | None, depth: int
    ) -> source.Condition: ...

    @overload
    def _split(
        self, node: source.Expression, lines: list[Statement], path: _BranchPath | None, depth: int
    ) -> source.Expression: ...

    @overload
    def _split(
        self, node: _SourceNode, lines: list[Statement], path: _BranchPath | None, depth: int
    ) -> _SourceNode: ...

    def _split(self, node: _SourceNode, lines: list[Statement], path: _BranchPath | None, depth: int) -> _SourceNode:
        """Return the node with a variable for every ``when`` that is nested 20 deep (:data:`_MOST_BRANCHES`).

        A ``when`` is a conditional expression. The statements that compute these variables are
        appended to ``lines``. They run only if all conditions in ``path`` are true. ``depth`` is
        the number of ``when`` expressions around the node.
        """
        if isinstance(node, source.When):
            if depth == _MOST_BRANCHES:
                return self._compute_before(node, lines, path)
            cases: list[tuple[source.Condition, source.Expression]] = []
            for condition, value in node.cases:
                test = self._split(condition, lines, path, depth + 1)
                cases.append((test, self._split(value, lines, _BranchPath(path, test), depth + 1)))
                path = _BranchPath(path, source.Condition("not", (test,)))
            return source.When(tuple(cases), self._split(node.otherwise, lines, path, depth + 1))
        if isinstance(node, source.Condition) and node.op in ("and", "or"):
            parts: list[source.Condition] = []
            for part in node.args:
                assert isinstance(part, source.Condition), "and and or take conditions"
                parts.append(self._split(part, lines, path, depth))
                path = _BranchPath(path, parts[-1] if node.op == "and" else source.Condition("not", (parts[-1],)))
            return source.Condition(node.op, tuple(parts))
        if isinstance(node, (source.Op, source.Condition)):
            args = tuple(self._split(argument, lines, path, depth) for argument in node.args)
            return replace(node, args=args)
        return node

    def _compute_before(
        self, node: source.When, lines: list[Statement], path: _BranchPath | None
    ) -> source.SignalValue:
        self._count += 1
        name = f"{self._prefix}{self._count}"
        if path:
            test = self._holds(path, lines)
            lines.append(Declare(name, "real", Real(0.0), changes=True))
            lines.append(If(((test, tuple(self.assign(name, node))),)))
        else:
            lines += with_declaration(name, self.assign(name, node), changes=False)
        # The spaces in this name make it different from the names of all signals.
        stand_in = source.SignalValue(f"computed before: {name}")
        self._signals[stand_in.name] = name
        return stand_in

    def _holds(self, path: _BranchPath, lines: list[Statement]) -> ProgramVariable:
        """Return a variable that is true if all conditions of the path are true.

        The statements that compute it are appended to ``lines``. Paths share the variables of the
        conditions that they have in common, and each condition is computed only once.
        """
        new: list[_BranchPath] = []
        known: _BranchPath | None = path
        while known is not None and known.variable is None:
            new.append(known)
            known = known.before
        holds = known.variable if known is not None else None
        for part in reversed(new):
            needed: list[Statement] = []
            test = self._test(part.condition, needed)
            if holds is None:
                lines += needed
                name = self._declare("bool", lines)
                lines.append(Assign(name, test))
            else:
                name = self._declare("bool", lines, changes=True)
                lines.append(Assign(name, Bool(False)))
                lines.append(If(((holds, (*needed, Assign(name, test))),)))
            part.variable = holds = ProgramVariable(name)
        assert holds is not None, "a path has at least one condition"
        return holds

    # --- numbers ----------------------------------------------------------------------------------

    def _value(self, node: source.Expression, lines: list[Statement]) -> ProgramExpression:
        """Translate an expression; append to ``lines`` the statements that must run before the result."""
        if isinstance(node, source.Const):
            return Real(float(node.value))
        if isinstance(node, _READ):
            key = source.variable_key(node)
            variable = ProgramVariable(self._signals[key])
            if key not in self._booleans:
                return variable
            signal = isinstance(node, source.SignalValue) and self._flags is not None and key not in self._flags
            return Choice(variable, Real(1.0), Real(0.0 if signal else -1.0))
        if self._truths is not None and self._truths.splits(node):
            test = self._test(self._truths.condition(node), lines)
            return Choice(test, Real(1.0), Real(-1.0))
        if isinstance(node, source.ParamValue):
            return ProgramVariable(self._params[node.name])
        if isinstance(node, source.When):
            self._count += 1
            name = f"{self._prefix}{self._count}"
            branches = self._cases(name, node)
            lines += [Declare(name, "real", None, _is_reassigned(name, branches)), *branches]
            return ProgramVariable(name)
        if node.op == "^" and isinstance(exponent := node.args[1], source.Const):
            factors = MULTIPLIED_EXPONENTS.get(exponent.value)
            if factors:
                base = self._as_variable(self._argument(node.args[0], lines), lines)
                return reduce(lambda left, right: BinaryNumber("*", left, right), [base] * factors)
        return operation(node, [self._argument(argument, lines) for argument in node.args])

    def _argument(self, node: source.Expression, lines: list[Statement]) -> ProgramExpression:
        value = self._value(node, lines)
        return self._as_variable(value, lines) if nesting_depth(value) >= _DEEPEST else value

    # --- tests ------------------------------------------------------------------------------------

    def _test(self, node: _SourceNode, lines: list[Statement]) -> ProgramExpression:
        """Translate a condition to a test; append to ``lines`` the statements that must run before the test."""
        assert isinstance(node, source.Condition), "and, or, not and cases take conditions"
        if node.op == "not":
            return Not(self._part(node.args[0], lines))
        if node.op == "and" or node.op == "or":
            return self._join(node, lines)
        left, right = node.args
        assert not isinstance(left, source.Condition) and not isinstance(right, source.Condition)
        op = node.op
        if op == ">" and isinstance(left, _READ) and source.variable_key(left) in self._booleans and right == _ZERO:
            return ProgramVariable(self._signals[source.variable_key(left)])
        return Compare(op, self._argument(left, lines), self._argument(right, lines))

    def _part(self, node: _SourceNode, lines: list[Statement]) -> ProgramExpression:
        test = self._test(node, lines)
        if nesting_depth(test) < _DEEPEST:
            return test
        name = self._declare("bool", lines)
        lines.append(Assign(name, test))
        return ProgramVariable(name)

    def _join(self, node: source.Condition, lines: list[Statement]) -> ProgramExpression:
        """Translate an ``and`` or ``or`` to a test.

        The statements that must run before the test are appended to ``lines``. The statements that
        an operand needs run only if the operands before it do not decide the result.
        """
        tests: list[ProgramExpression] = []
        for part in node.args:
            needed: list[Statement] = []
            test = self._part(part, needed)
            if not tests:
                lines += needed
            elif needed:
                name = self._declare("bool", lines, changes=True)
                lines.append(Assign(name, all_or_any(node.op, tests)))
                undecided = ProgramVariable(name) if node.op == "and" else Not(ProgramVariable(name))
                lines.append(If(((undecided, (*needed, Assign(name, test))),)))
                tests, test = [], ProgramVariable(name)
            tests.append(test)
        return all_or_any(node.op, tests)

    # --- variables --------------------------------------------------------------------------------

    def _as_variable(self, value: ProgramExpression, lines: list[Statement]) -> ProgramExpression:
        """Return a variable or a number with this value, which can be used several times but is computed once.

        If the variable is new, its declaration is appended to ``lines``.
        """
        if isinstance(value, (ProgramVariable, Real)):
            return value
        self._count += 1
        name = f"{self._prefix}{self._count}"
        lines.append(Declare(name, "real", value))
        return ProgramVariable(name)

    def _declare(self, type_: Type, lines: list[Statement], changes: bool = False) -> str:
        self._count += 1
        name = f"{self._prefix}{self._count}"
        lines.append(Declare(name, type_, None, changes))
        return name


def _branch_depth(node: _SourceNode) -> int:
    """Return how deep ``when`` expressions (conditional expressions) are nested in a node; 0 for none."""
    if isinstance(node, source.When):
        inside = [*(part for case in node.cases for part in case), node.otherwise]
        return 1 + max(map(_branch_depth, inside))
    if isinstance(node, (source.Op, source.Condition)):
        return max(map(_branch_depth, node.args))
    return 0
