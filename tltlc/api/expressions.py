"""What does an atom compute, and what is its value?

The expression of an atom is a tree of ``Const``, ``SignalValue``, ``ParamValue``, ``Op`` and
``When``. The update of a register, in which a monitor remembers the trace so far, may also have
``AtomValue``, ``Before`` and ``StepLength``; a ``VariableKey`` names what an expression reads, and
``variable_key`` returns it. ``evaluate`` computes a value, ``nodes`` yields the nodes of an
expression, and ``to_json`` converts it to the JSON of artefacts.
"""

from tltlc.expression.evaluate import MULTIPLIED_EXPONENTS, evaluate
from tltlc.expression.json import to_json
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

__all__ = [
    "MULTIPLIED_EXPONENTS",
    "AtomValue",
    "Before",
    "Condition",
    "Const",
    "Expression",
    "Op",
    "ParamValue",
    "SignalValue",
    "StepLength",
    "VariableKey",
    "When",
    "evaluate",
    "nodes",
    "to_json",
    "variable_key",
]
