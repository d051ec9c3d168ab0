"""Run a command line that handles signals in this process, and interrupt it at a chosen moment."""

from __future__ import annotations

import signal
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tltlc.interfaces.cli.interrupts import REQUESTS, end_on_signals

Run = Callable[..., Outcome]


@pytest.fixture
def with_signals(tltlc: Run) -> Run:  # noqa: F811
    """Return a function that runs a command line in this process.

    The command line handles signals as it does in a process of its own. Afterwards the function
    restores the handlers of this process.
    """

    def run(*arguments: str | Path) -> Outcome:
        handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, *REQUESTS)}
        try:
            with end_on_signals():
                return tltlc(*arguments)
        finally:
            for number, handler in handlers.items():
                signal.signal(number, handler)

    return run


@pytest.fixture
def interrupted(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> Run:  # noqa: F811
    """Return a function that runs ``tltlc train`` and interrupts it.

    The interrupt comes before the environments of the training start.
    """

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    def run(*arguments: str | Path) -> Outcome:
        with monkeypatch.context() as patch:
            patch.setattr("tltl_runtime.training.run.train.make_environments", stop)
            outcome = tltlc("train", *arguments)
        assert outcome.status == 130, outcome.err
        return outcome

    return run


def signal_at_call(patch: pytest.MonkeyPatch, owner: type, name: str, number: int, call: int = 2) -> None:
    """Send a signal to this process when a method is called for the ``call``-th time.

    The signal comes before that call does anything. ``owner`` is the class of the method ``name``.
    """
    method, calls = getattr(owner, name), count(1)

    def interrupted(*arguments: Any, **options: Any) -> Any:
        if next(calls) == call:
            signal.raise_signal(number)
        return method(*arguments, **options)

    patch.setattr(owner, name, interrupted)
