"""Arithmetic over signals and params."""

from tltlc.expression.evaluate import MULTIPLIED_EXPONENTS, evaluate
from tltlc.expression.json import to_json
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When, nodes

__all__ = [
    "MULTIPLIED_EXPONENTS",
    "Condition",
    "Const",
    "Expression",
    "Op",
    "ParamValue",
    "SignalValue",
    "When",
    "evaluate",
    "nodes",
    "to_json",
]
