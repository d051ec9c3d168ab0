"""A trampoline: run recursive generators without growing Python's stack.

A recursive function is written as a generator. Instead of calling itself, it yields a new generator,
and :func:`run_to_result` sends it the result of that generator.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

from tltlc.logic.formula import Formula
from tltlc.resolve.problem import ResolutionError

FormulaGenerator = Generator[Any, Any, Any]
"""A recursive function as a generator: it yields the generator of each recursive call, receives the call's
result, and returns a formula.
"""


def run_to_result(generator: FormulaGenerator) -> Formula:
    """Run a generator and all generators that it yields, and return the formula that it returns.

    A ResolutionError is raised in each waiting generator in turn, as in a call stack. If none of them
    handles it, it is raised to the caller.
    """
    stack = [generator]
    result: Formula | None = None
    failure: ResolutionError | None = None
    while stack:
        try:
            child = stack[-1].throw(failure) if failure else stack[-1].send(result)
        except StopIteration as stop:
            stack.pop()
            result, failure = stop.value, None
        except ResolutionError as error:
            stack.pop()
            failure = error
        else:
            stack.append(child)
            result, failure = None, None
    if failure:
        raise failure
    assert result is not None
    return result
