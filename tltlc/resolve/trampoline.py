"""Recursion without Python's stack: generators that yield the generators they wait for."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

from tltlc.logic.formula import Formula
from tltlc.resolve.problem import ResolutionError

Steps = Generator[Any, Any, Any]
"""Yields the generators it waits for and is sent their results; returns a formula."""


def run(steps: Steps) -> Formula:
    """Return the result of a generator.

    A ResolutionError passes through all generators that wait for the one that raises it.
    """
    stack = [steps]
    result: Formula | None = None
    failure: ResolutionError | None = None
    while stack:
        try:
            child = stack[-1].throw(failure) if failure else stack[-1].send(result)
        except StopIteration as finished:
            stack.pop()
            result, failure = finished.value, None
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
