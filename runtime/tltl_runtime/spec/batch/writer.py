"""Write torch code that computes expressions for N environments at once.

In the code, a column is a tensor of shape [N] that has a value for each environment.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from operator import add, ge, gt, le, lt, mul
from typing import Final, cast

from tltlc.api import expressions, record

_COMPARISONS: Final[dict[str, Callable[[float, float], bool]]] = {"<": lt, "<=": le, ">": gt, ">=": ge}
_FAILURES: Final = (ZeroDivisionError, OverflowError, ValueError)


@record
class TensorTerm:
    """The value of an expression in the written code.

    ``name`` is the name of the tensor that has the value, or the text of a constant. ``constant`` is
    the value of the constant, a number or a truth value; None for a tensor. ``fails`` is the name of
    a mask tensor: it says in which environments the expression has no value, for example because of
    a division by 0. It is None if the expression always has a value.
    """

    name: str
    constant: float | None = None
    fails: str | None = None


@record
class TensorLine:
    """A line of code: ``name = code``, which assigns a tensor.

    ``operands`` are the names in ``code`` that earlier lines assign.
    """

    name: str
    code: str
    operands: tuple[str, ...]


class TensorWriter:
    """Writes lines of code that compute expressions. Each line assigns a tensor to a new name.

    ``signals`` are the names of the signals, or the keys of whatever else the expressions read, and
    ``params`` the values of the params in the expressions. Whoever runs the code supplies what it uses:
    the variable ``columns``, where ``columns[i]`` has the values of the i-th signal in the N
    environments; functions of torch by their names, such as ``clamp``; and the constants. When all
    lines are written, the attribute ``constants`` has a number for each name that the code uses for a
    zero-dimensional tensor. Equal right-hand sides are written only once.
    """

    def __init__(self, signals: Sequence[expressions.VariableKey], params: Mapping[str, float]) -> None:
        self._columns = {name: index for index, name in enumerate(signals)}
        self._computed: dict[expressions.VariableKey, TensorTerm] = {}
        self._params = params
        self._lines: dict[str, TensorLine] = {}
        self._line_names: set[str] = set()
        self.constants: dict[str, float] = {}

    @property
    def lines(self) -> tuple[TensorLine, ...]:
        """The lines written so far, in order."""
        return tuple(self._lines.values())

    def constant_column(self, constant: float) -> str:
        """Write a line that assigns a column with ``constant`` for each environment; return its name."""
        return self._line("{}.expand(columns.shape[1])", self._constant_tensor(constant))

    def define(self, key: expressions.VariableKey, term: TensorTerm) -> None:
        """Let expressions that are written later read the value of a term; that of an atom is clamped to [-1, 1].

        Where the term has no value, the failure counts only for the term itself.
        """
        if isinstance(key, expressions.AtomValue):
            term = self._extreme("min", self._extreme("max", term, self._constant(-1.0)), self._constant(1.0))
        self._computed[key] = TensorTerm(term.name, term.constant)

    def number(self, node: expressions.Expression) -> TensorTerm:
        """Write the lines that compute a numeric expression, and return the term for its value."""
        if isinstance(node, expressions.Const):
            return self._constant(node.value)
        if isinstance(node, expressions.ParamValue):
            return self._constant(self._params[node.name])
        if isinstance(
            node, (expressions.SignalValue, expressions.AtomValue, expressions.Before, expressions.StepLength)
        ):
            key = expressions.variable_key(node)
            known = self._computed.get(key)
            return known or TensorTerm(self._line(f"columns[{self._columns[key]}]"))
        if isinstance(node, expressions.When):
            return self._when(node)
        args = [self.number(argument) for argument in node.args]
        fails = self._any_of([term.fails for term in args])
        if all(term.constant is not None for term in args):
            return self._fold_constants(node, args, fails)
        return self._operation(node, args, fails)

    def _operation(self, node: expressions.Op, args: list[TensorTerm], fails: str | None) -> TensorTerm:
        if node.op in ("+", "*"):
            compute = add if node.op == "+" else mul
            total = args[0]
            for term in args[1:]:
                if total.constant is not None and term.constant is not None:
                    total = self._constant(compute(total.constant, term.constant))
                else:
                    total = TensorTerm(self._infix(self._operand(total), node.op, self._operand(term)))
            return TensorTerm(total.name, None, fails)
        if node.op in ("min", "max"):
            best = args[0]
            for term in args[1:]:
                best = self._extreme(node.op, best, term)
            return TensorTerm(best.name, best.constant, fails)
        if node.op == "clamp":
            value, low, high = args
            if value.constant is None and low.constant is not None and high.constant is not None:
                return TensorTerm(self._line("clamp({}, {}, {})", value.name, low.name, high.name), None, fails)
            return TensorTerm(self._extreme("min", self._extreme("max", value, low), high).name, None, fails)
        if node.op == "^":
            return self._power(node, args, fails)
        if node.op == "/":
            top, bottom = (self._operand(term) for term in args)
            if args[1].constant is None:
                own_failure: str | None = self._infix(bottom, "==", "0.0")
            else:
                own_failure = self._everywhere() if args[1].constant == 0.0 else None
            return TensorTerm(self._infix(top, "/", bottom), None, self._any_of([fails, own_failure]))
        if node.op == "-":
            return TensorTerm(self._infix(self._operand(args[0]), "-", self._operand(args[1])), None, fails)
        inner = args[0].name
        if node.op == "neg":
            return TensorTerm(self._line("-{}", inner), None, fails)
        result = self._line(f"{node.op}({{}})", inner)
        if node.op == "sqrt":
            fails = self._any_of([fails, self._infix(inner, "<", "0.0")])
        elif node.op == "exp":
            fails = self._any_of([fails, self._line("isinf({}) & isfinite({})", result, inner)])
        return TensorTerm(result, None, fails)

    def _power(self, node: expressions.Op, args: list[TensorTerm], fails: str | None) -> TensorTerm:
        base, exponent = args
        factors = (
            expressions.MULTIPLIED_EXPONENTS.get(node.args[1].value, 0)
            if isinstance(node.args[1], expressions.Const)
            else 0
        )
        if factors:
            square = self._infix(base.name, "*", base.name)
            return TensorTerm(square if factors == 2 else self._infix(square, "*", base.name), None, fails)
        left, right = self._operand(base), self._operand(exponent)
        result = self._line("pow({}, {})", left, right)
        own_failure = self._line("isfinite({}) & isfinite({}) & ~isfinite({})", left, right, result)
        return TensorTerm(result, None, self._any_of([fails, own_failure]))

    def _extreme(self, op: str, first: TensorTerm, second: TensorTerm) -> TensorTerm:
        """Write the ``min`` or the ``max`` of two terms, and return the term for the result.

        Of two equal values, such as 0 and -0, the result is the first, as in Python.
        """
        if first.constant is not None and second.constant is not None:
            return self._constant((min if op == "min" else max)(first.constant, second.constant))
        if second.constant is not None:
            form = "clamp({}, max={})" if op == "min" else "clamp({}, min={})"
            return TensorTerm(self._line(form, first.name, second.name))
        first_name, second_name = self._operand(first), self._operand(second)
        is_beyond = self._infix(second_name, "<" if op == "min" else ">", first_name)
        return TensorTerm(self._line("where({}, {}, {})", is_beyond, second_name, first_name))

    def _when(self, node: expressions.When) -> TensorTerm:
        result = self.number(node.otherwise)
        for condition, value in reversed(node.cases):
            test = self._condition(condition)
            if test.constant is not None and test.fails is None:
                result = self.number(value) if test.constant else result
                continue
            case = self.number(value)
            taken = self._truth(test)
            otherwise_fails = self._both(self._line("~{}", taken), result.fails) if result.fails else None
            fails = self._any_of([test.fails, self._both(taken, case.fails), otherwise_fails])
            value_line = self._line("where({}, {}, {})", taken, self._operand(case), self._operand(result))
            result = TensorTerm(value_line, None, fails)
        return result

    def _condition(self, node: expressions.Expression | expressions.Condition) -> TensorTerm:
        assert isinstance(node, expressions.Condition), "and, or, not and cases take conditions"
        if node.op == "not":
            inner = self._condition(node.args[0])
            if inner.constant is not None:
                return TensorTerm(inner.name, float(not inner.constant), inner.fails)
            return TensorTerm(self._line("~{}", inner.name), None, inner.fails)
        if node.op in ("and", "or"):
            return self._connective(node)
        left, right = (self.number(cast("expressions.Expression", side)) for side in node.args)
        fails = self._any_of([left.fails, right.fails])
        if left.constant is not None and right.constant is not None:
            return TensorTerm("", float(_COMPARISONS[node.op](left.constant, right.constant)), fails)
        return TensorTerm(self._infix(self._operand(left), node.op, self._operand(right)), None, fails)

    def _connective(self, node: expressions.Condition) -> TensorTerm:
        """Write a condition with ``and`` or ``or``, and return the term for its truth value.

        In Python, a part is not evaluated if an earlier part decides the result. So a failure of a
        part counts only in environments where the parts before it do not decide the result. To
        compute this, the parts are written from the last to the first.
        """
        sign = "&" if node.op == "and" else "|"
        result = self._condition(node.args[-1])
        for part in reversed(node.args[:-1]):
            first = self._condition(part)
            truth, rest = self._truth(first), self._truth(result)
            undecided = truth if node.op == "and" else self._line("~{}", truth)
            fails = self._any_of([first.fails, self._both(undecided, result.fails)])
            result = TensorTerm(self._infix(truth, sign, rest), None, fails)
        return result

    def _fold_constants(self, node: expressions.Op, args: list[TensorTerm], fails: str | None) -> TensorTerm:
        """Compute an operation on constants now, and return the result as a constant term.

        ``args`` are the terms of the operands, and ``fails`` is their mask. If the operation has no
        value, the result is NaN and fails in all environments.
        """
        # The evaluator multiplies only where the exponent is a literal of the spec. A computed constant exponent must
        # stay a power, so it is not passed on as a literal.
        parts = tuple(expressions.Const(term.constant if term.constant is not None else math.nan) for term in args)
        if (
            node.op == "^"
            and not isinstance(node.args[1], expressions.Const)
            and parts[1].value in expressions.MULTIPLIED_EXPONENTS
        ):
            try:
                return TensorTerm(*self._literal(math.pow(parts[0].value, parts[1].value)), fails)
            except _FAILURES:
                return TensorTerm(*self._literal(math.nan), self._everywhere())
        try:
            return TensorTerm(*self._literal(expressions.evaluate(expressions.Op(node.op, parts), {}, {})), fails)
        except _FAILURES:
            return TensorTerm(*self._literal(math.nan), self._everywhere())

    def _constant(self, value: float) -> TensorTerm:
        return TensorTerm(*self._literal(value))

    def _literal(self, value: float) -> tuple[str, float]:
        text = repr(float(value))
        if not math.isfinite(value):
            return f"float('{text}')", value
        return (f"({text})" if text.startswith("-") else text), value

    def _operand(self, term: TensorTerm) -> str:
        """Return the name of a tensor with the value of a term.

        A constant gets a tensor, too: torch is slower with Python numbers, and divides by them less
        exactly.
        """
        return term.name if term.constant is None else self._constant_tensor(term.constant)

    def _constant_tensor(self, constant: float) -> str:
        for name, value in self.constants.items():
            if repr(value) == repr(constant):
                return name
        name = f"k{len(self.constants)}"
        self.constants[name] = constant
        return name

    def _truth(self, term: TensorTerm) -> str:
        if term.constant is None:
            return term.name
        everywhere = self._everywhere()
        return everywhere if term.constant else self._line("~{}", everywhere)

    def _everywhere(self) -> str:
        return self._line("columns.new_ones((columns.shape[1],)) > 0.0")

    def _both(self, mask: str, other: str | None) -> str | None:
        return None if other is None else self._infix(mask, "&", other)

    def _any_of(self, masks: Sequence[str | None]) -> str | None:
        names = list(dict.fromkeys(mask for mask in masks if mask is not None))
        return reduce(lambda left, right: self._infix(left, "|", right), names) if names else None

    def _infix(self, left: str, op: str, right: str) -> str:
        return self._line(f"{{}} {op} {{}}", left, right)

    def _line(self, form: str, *operands: str) -> str:
        """Write a line that assigns an expression to a new name, and return the name.

        The expression is ``form``, in which each ``{}`` is replaced by one of ``operands``: names of
        tensors or texts of constants. If an earlier line has this expression, return its name instead.
        """
        code = form.format(*operands)
        line = self._lines.get(code)
        if line is None:
            used = tuple(operand for operand in operands if operand in self._line_names)
            line = self._lines[code] = TensorLine(f"t{len(self._lines)}", code, used)
            self._line_names.add(line.name)
        return line.name
