"""Compile expressions to Python source, for monitors that compute them many times a second.

The source computes the same values as :func:`tltlc.expression.evaluate.evaluate`, to the last bit,
and raises the same errors. It uses the names ``pow``, ``sqrt``, ``exp``, ``tanh`` of the module
``math``. It contains no name of a signal or param: the caller supplies a Python name for each.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Final, cast

from tltlc.expression.evaluate import MULTIPLIED_EXPONENTS
from tltlc.expression.tree import (
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    Op,
    ParamValue,
    SignalValue,
    StepLength,
    VariableKey,
    When,
    nodes,
    variable_key,
)

INDENT: Final = "    "

_MAX_DEPTH: Final = 40
"""The greatest depth of an expression in one function, since Python's parser limits the nesting of brackets."""

# Binding strengths of Python expressions: a higher number binds more tightly.
_CASES, _OR, _AND, _NOT, _COMPARISON, _SUM, _PRODUCT, _SIGN, _UNIT = range(9)


def compile_expressions(
    expressions: Sequence[Expression], signals: Sequence[VariableKey], params: Mapping[str, float]
) -> tuple[Callable[[Sequence[float]], float], ...]:
    """Return, for each expression, a function that computes its value from a sample.

    A sample is a sequence of floats: the values of ``signals``, in order. These are names of signals;
    for updates of registers, also the nodes that read anything else. ``params`` maps names to
    values, which are built into the functions. Values and errors are those of
    :func:`tltlc.expression.evaluate.evaluate`. A function reads only the signals of its expression,
    so that many signals do not make the source long.
    """
    positions = {name: index for index, name in enumerate(signals)}
    constants = {name: f"p{index}" for index, name in enumerate(params)}
    namespace: dict[str, object] = {name: getattr(math, name) for name in ("pow", "sqrt", "exp", "tanh")}
    namespace.update(zip(constants.values(), map(float, params.values()), strict=True))
    lines: list[str] = []
    for index, expression in enumerate(expressions):
        lines += _function(index, expression, positions, constants)
    exec(compile("\n".join([*lines, ""]), "<expressions>", "exec"), namespace)
    functions = [namespace[f"atom{index}"] for index in range(len(expressions))]
    return tuple(cast("Callable[[Sequence[float]], float]", function) for function in functions)


def _function(
    index: int, expression: Expression, positions: Mapping[VariableKey, int], constants: Mapping[str, str]
) -> Iterator[str]:
    """Yield the source lines of a function ``atomINDEX(sample)`` for an expression.

    The functions that it calls come first. ``positions`` maps signals to their indices in a sample, and
    ``constants`` maps params to Python variables.
    """
    variables = (node for node in nodes(expression) if isinstance(node, (SignalValue, AtomValue, Before, StepLength)))
    signals = {key: f"s{positions[key]}" for key in map(variable_key, variables)}
    params = {node.name: constants[node.name] for node in nodes(expression) if isinstance(node, ParamValue)}
    writer = PythonWriter(signals, params, f"_{index}_")
    body = writer.assignment("value", expression, INDENT)
    yield from writer.helpers
    yield f"def atom{index}(sample):"
    yield from (f"{INDENT}{variable} = sample[{positions[name]}]" for name, variable in signals.items())
    yield from body
    yield f"{INDENT}return value"


class PythonWriter:
    """Writes expressions as Python source.

    ``signals`` and ``params`` map names of signals and params to Python variables. An expression that
    is nested too deep for Python's parser is split: ``helpers`` collects the source of functions that
    compute its parts. The names that the writer makes up begin with ``prefix``: ``PREFIXpart0``,
    ``PREFIXpart1``, … for functions, and ``PREFIXbase``, ``PREFIXbase2``, … for the bases of powers.
    """

    def __init__(self, signals: Mapping[Any, str], params: Mapping[str, str], prefix: str) -> None:
        self._signals, self._params, self._prefix = signals, params, prefix
        self._count = self._powers = 0
        self.helpers: list[str] = []

    def assignment(self, name: str, expression: Expression, indent: str) -> list[str]:
        """Return the lines that assign the value of an expression to the variable ``name``.

        A ``when`` becomes an ``if`` statement. Each line begins with ``indent``.
        """
        return self._assignment(name, expression, indent, 0)

    def _assignment(self, name: str, expression: Expression, indent: str, depth: int) -> list[str]:
        if not isinstance(expression, When) or depth > 10:
            return [f"{indent}{name} = {self._text(expression, _CASES, 0)}"]
        lines: list[str] = []
        for position, (condition, value) in enumerate(expression.cases):
            lines.append(f"{indent}{'elif' if position else 'if'} {self._condition(condition, _CASES, 0)}:")
            lines += self._assignment(name, value, indent + INDENT, depth + 1)
        lines.append(f"{indent}else:")
        return lines + self._assignment(name, expression.otherwise, indent + INDENT, depth + 1)

    def _text(self, node: Expression, min_binding: int, depth: int) -> str:
        """Return the text of an expression, in brackets if it binds more loosely than ``min_binding``.

        ``depth`` is the number of operators around the expression.
        """
        if isinstance(node, Const):
            return _with_brackets(
                repr(float(node.value)), _SIGN if math.copysign(1, node.value) < 0 else _UNIT, min_binding
            )
        if isinstance(node, (SignalValue, AtomValue, Before, StepLength)):
            return self._signals[variable_key(node)]
        if isinstance(node, ParamValue):
            return self._params[node.name]
        if depth > _MAX_DEPTH:
            return self._helper_call(node)
        if isinstance(node, When):
            return _with_brackets(self._cases(node, depth + 1), _CASES, min_binding)
        text, binding = self._operation(node, depth + 1)
        return _with_brackets(text, binding, min_binding)

    def _operation(self, node: Op, depth: int) -> tuple[str, int]:
        left = node.args[0]
        if node.op in ("+", "-"):
            texts = [self._text(left, _SUM, depth), *(self._text(term, _PRODUCT, depth) for term in node.args[1:])]
            return f" {node.op} ".join(texts), _SUM
        if node.op in ("*", "/"):
            texts = [self._text(left, _PRODUCT, depth), *(self._text(factor, _SIGN, depth) for factor in node.args[1:])]
            return f" {node.op} ".join(texts), _PRODUCT
        if node.op == "neg":
            return f"-{self._text(left, _UNIT, depth)}", _SIGN
        if node.op == "^":
            return self._power(left, node.args[1], depth)
        texts = [self._text(argument, _CASES, depth) for argument in node.args]
        if node.op == "clamp":
            return f"min(max({texts[0]}, {texts[1]}), {texts[2]})", _UNIT
        return f"{node.op}({', '.join(texts)})", _UNIT

    def _power(self, base: Expression, exponent: Expression, depth: int) -> tuple[str, int]:
        factors = MULTIPLIED_EXPONENTS.get(exponent.value, 0) if isinstance(exponent, Const) else 0
        if not factors:
            return f"pow({self._text(base, _CASES, depth)}, {self._text(exponent, _CASES, depth)})", _UNIT
        if isinstance(base, (SignalValue, ParamValue, AtomValue, Before, StepLength)):
            return " * ".join([self._text(base, _UNIT, depth)] * factors), _PRODUCT
        # Nested powers need different variables, since the base of a power may contain another power.
        self._powers += 1
        name = f"{self._prefix}base{self._powers if self._powers > 1 else ''}"
        first = f"({name} := {self._text(base, _CASES, depth + 1)})"
        self._powers -= 1
        return " * ".join([first, *[name] * (factors - 1)]), _PRODUCT

    def _cases(self, node: When, depth: int) -> str:
        """Return a ``when`` as a chain of conditional expressions: ``a if x > 3 else b if … else c``."""
        cases = [
            f"{self._text(value, _OR, depth)} if {self._condition(condition, _OR, depth)} else "
            for condition, value in node.cases
        ]
        return "".join(cases) + self._text(node.otherwise, _CASES, depth)

    def _condition(self, node: Expression | Condition, min_binding: int, depth: int) -> str:
        assert isinstance(node, Condition), "and, or, not and cases take conditions"
        if depth > _MAX_DEPTH:
            return self._helper_call(node)
        if node.op in ("and", "or"):
            binding = _AND if node.op == "and" else _OR
            text = f" {node.op} ".join(self._condition(part, binding + 1, depth + 1) for part in node.args)
            return _with_brackets(text, binding, min_binding)
        if node.op == "not":
            return _with_brackets(f"not {self._condition(node.args[0], _NOT, depth + 1)}", _NOT, min_binding)
        left, right = (cast("Expression", side) for side in node.args)
        text = f"{self._text(left, _SUM, depth + 1)} {node.op} {self._text(right, _SUM, depth + 1)}"
        return _with_brackets(text, _COMPARISON, min_binding)

    def _helper_call(self, node: Expression | Condition) -> str:
        """Add a function that computes an expression or condition to ``helpers``, and return a call of it."""
        name = f"{self._prefix}part{self._count}"
        self._count += 1
        body = self._condition(node, _CASES, 0) if isinstance(node, Condition) else self._text(node, _CASES, 0)
        call = f"{name}({', '.join([*self._signals.values(), *self._params.values()])})"
        self.helpers.append(f"def {call}:\n{INDENT}return {body}")
        return call


def _with_brackets(text: str, binding: int, min_binding: int) -> str:
    return text if binding >= min_binding else f"({text})"
