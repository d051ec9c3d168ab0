"""What holds for every test."""

from __future__ import annotations

import os
import shutil
import signal
import tempfile
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

# How long an example takes, or how long it takes to draw, says more of what else the machine does than of the code.
settings.register_profile("any", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("fuzz", settings.get_profile("any"), print_blob=True)
# The same examples in every run, so that a change is judged by what it changes; `make fuzz` draws others.
settings.register_profile("tests", settings.get_profile("any"), derandomize=True)
settings.load_profile("tests")

LEFT_OUT = (
    *("NO_COLOR", "FORCE_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "COLUMNS", "LINES", "TLTLC_DEBUG", "GITHUB_WORKSPACE"),
    *("RAY_ADDRESS", "WORLD_SIZE", "RANK", "LOCAL_RANK", "MASTER_ADDR", "MASTER_PORT", "OMP_NUM_THREADS"),
    *("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_OBJECT_DIRECTORY", "PYTHONWARNINGS", "PYTHONOPTIMIZE"),
)
"""Variables by which the programs would behave otherwise than the tests expect."""

HANDLERS: dict[signal.Signals, Any] = {
    getattr(signal, name): handler
    for name, handler in [
        ("SIGINT", signal.default_int_handler),
        ("SIGTERM", signal.SIG_DFL),
        ("SIGHUP", signal.SIG_DFL),
    ]
    if hasattr(signal, name)
}
"""The handlers that Python has at its start; processes that tests start inherit them."""

_answers = tempfile.mkdtemp(prefix="tltlc-tests-")


def pytest_configure() -> None:
    """Leave nothing of the person's environment to the tests and to the processes that they start."""
    for name in LEFT_OUT:
        os.environ.pop(name, None)
    os.environ.update(GIT_CONFIG_GLOBAL=os.devnull, GIT_CONFIG_NOSYSTEM="1")
    # Not even the answers that earlier runs, and tests beside this one, remember.
    os.environ["TLTLC_CACHE_DIR"] = _answers
    # Every process that is started in the background of a shell ignores Ctrl-C, and under `nohup` SIGHUP.
    for number, handler in HANDLERS.items():
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, handler)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown() -> Iterator[None]:
    """Report a test, or an import, that leaves another handler behind: a later test would end the whole process."""
    yield
    changed = [number for number, handler in HANDLERS.items() if signal.getsignal(number) != handler]
    for number in changed:
        signal.signal(number, HANDLERS[number])
    assert not changed, f"the handlers of these signals were changed: {', '.join(number.name for number in changed)}"


def pytest_unconfigure() -> None:
    shutil.rmtree(_answers, ignore_errors=True)
