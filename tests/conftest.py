"""Settings and checks for all tests."""

from __future__ import annotations

import argparse
import gc
import os
import shutil
import signal
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from zlib import crc32

import pytest
from hypothesis import HealthCheck, settings

from tests import quick

# The time of an example, and of drawing it, depends more on the load of the machine than on the code.
settings.register_profile("any", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("fuzz", settings.get_profile("any"), max_examples=500, print_blob=True)
# Draw the same examples in every run, so that a new failure comes from a change of the code; `make fuzz` draws others,
# and more of them.
settings.register_profile("tests", settings.get_profile("any"), max_examples=50, derandomize=True)
settings.load_profile("tests")

LEFT_OUT = (
    *("NO_COLOR", "FORCE_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "COLUMNS", "LINES", "TLTLC_DEBUG", "GITHUB_WORKSPACE"),
    *("RAY_ADDRESS", "WORLD_SIZE", "RANK", "LOCAL_RANK", "MASTER_ADDR", "MASTER_PORT", "OMP_NUM_THREADS"),
    *("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_OBJECT_DIRECTORY", "PYTHONWARNINGS", "PYTHONOPTIMIZE"),
)
"""Environment variables that are removed, because they change what the tests expect."""

HANDLERS: dict[signal.Signals, Any] = {
    getattr(signal, name): handler
    for name, handler in [
        ("SIGINT", signal.default_int_handler),
        ("SIGTERM", signal.SIG_DFL),
        ("SIGHUP", signal.SIG_DFL),
    ]
    if hasattr(signal, name)
}
"""The signal handlers with which Python starts; processes that the tests start inherit them."""

_cache = tempfile.mkdtemp(prefix="tltlc-tests-")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add ``--part 2/4``, with which only one of four parts of the tests runs."""
    parser.addoption("--part", type=_part, default=(1, 1), metavar="I/N", help="run part I of N parts of the tests")


def _part(text: str) -> tuple[int, int]:
    number, count = map(int, text.split("/"))
    if not 1 <= number <= count:
        raise argparse.ArgumentTypeError(f"part {number} of {count} parts")
    return number, count


def pytest_configure(config: pytest.Config) -> None:
    """Isolate the tests, and the processes that they start, from the user's environment."""
    for name in LEFT_OUT:
        os.environ.pop(name, None)
    os.environ.update(GIT_CONFIG_GLOBAL=os.devnull, GIT_CONFIG_NOSYSTEM="1")
    # The workers of pytest-xdist inherit the folder of the process that starts them.
    os.environ.setdefault("TLTLC_TESTS_SHARED", _cache)
    os.environ.update(
        # Use a new cache: results of earlier runs, and of tests in other processes, must not be used.
        TLTLC_CACHE_DIR=_cache,
        # Ray would start its workers with niceness 15: beside busy processes, they then take minutes to start.
        RAY_worker_niceness="0",
    )
    # A process in the background of a shell ignores Ctrl-C, and one under `nohup` ignores SIGHUP.
    for number, handler in HANDLERS.items():
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, handler)
    if quick.is_chosen(config):
        config.pluginmanager.register(quick.SkipProcesses())


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out files and folders without quick tests if pytest runs with ``-m quick``.

    Otherwise let pytest decide.
    """
    return True if quick.is_chosen(config) and not quick.has_quick_tests(collection_path) else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the tests of other parts, and mark the quick tests, before pytest selects tests by their marks."""
    number, count = config.getoption("--part")
    # Cases of one test often take equally long, so they are spread over all parts.
    others = [item for item in items if crc32(item.nodeid.encode()) % count != number - 1]
    if others:
        config.hook.pytest_deselected(items=others)
        left_out = {*others}
        items[:] = [item for item in items if item not in left_out]
    for item in items:
        if quick.is_quick(item):
            item.add_marker(quick.QUICK)


def pytest_collection_finish() -> None:
    """Keep the garbage collector from visiting what lives until the end, and from running often.

    These are modules and tests. With Python's thresholds, the collector takes about 6 % of the time of the tests.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown() -> Iterator[None]:
    """Fail if a test or an import has changed a signal handler.

    With another handler, a signal in a later test could end the whole process.
    """
    yield
    changed = [number for number, handler in HANDLERS.items() if signal.getsignal(number) != handler]
    for number in changed:
        signal.signal(number, HANDLERS[number])
    assert not changed, f"the handlers of these signals were changed: {', '.join(number.name for number in changed)}"


def pytest_unconfigure() -> None:
    shutil.rmtree(_cache, ignore_errors=True)
