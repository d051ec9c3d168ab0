"""Convert expressions to the JSON of an artefact (the file of a compiled automaton), and back."""

from __future__ import annotations

from typing import Any

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
    When,
)


def to_json(expression: Expression | Condition) -> dict[str, Any]:
    """Return the JSON object of an expression: ``{"op": "+", "args": […]}``, ``{"signal": "health"}``, …"""
    if isinstance(expression, Const):
        return {"const": expression.value}
    if isinstance(expression, SignalValue):
        return {"signal": expression.name}
    if isinstance(expression, ParamValue):
        return {"param": expression.name}
    if isinstance(expression, AtomValue):
        return {"atom": expression.name}
    if isinstance(expression, Before):
        return {"before": expression.name}
    if isinstance(expression, StepLength):
        return {"step_length": "s"}
    if isinstance(expression, When):
        cases = [[to_json(condition), to_json(value)] for condition, value in expression.cases]
        return {"when": cases, "otherwise": to_json(expression.otherwise)}
    return {"op": expression.op, "args": [to_json(argument) for argument in expression.args]}


def from_json(node: dict[str, Any]) -> Expression:
    """Return the expression that a JSON object from :func:`to_json` stands for.

    The object must match the schema of artefacts: this function does not check it.
    """
    if "const" in node:
        return Const(float(node["const"]))
    if "signal" in node:
        return SignalValue(node["signal"])
    if "param" in node:
        return ParamValue(node["param"])
    if "atom" in node:
        return AtomValue(node["atom"])
    if "before" in node:
        return Before(node["before"])
    if "step_length" in node:
        return StepLength()
    if "when" in node:
        cases = tuple((_condition(condition), from_json(value)) for condition, value in node["when"])
        return When(cases, from_json(node["otherwise"]))
    return Op(node["op"], tuple(from_json(argument) for argument in node["args"]))


def _condition(node: dict[str, Any]) -> Condition:
    if node["op"] in ("and", "or", "not"):
        return Condition(node["op"], tuple(_condition(argument) for argument in node["args"]))
    return Condition(node["op"], tuple(from_json(argument) for argument in node["args"]))
