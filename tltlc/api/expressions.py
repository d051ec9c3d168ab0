"""What does an atom compute, and what is its value?

The expression of an atom is a tree of ``Const``, ``SignalValue``, ``ParamValue``, ``Op`` and
``When``. ``evaluate`` computes its value, ``nodes`` yields its nodes, and ``to_json`` converts it
to the JSON of artefacts.
"""

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
