"""Choose the tests of ``make quick``, a subset that takes at most a minute.

A quick test starts no process, needs no compiler of another language, no physics and no training,
and is no property test. All rules are here: no test marks itself. ``pytest -m quick`` reads a file
only if it may contain quick tests. If a test in it is about to start a process all the same, the
test is skipped.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from threading import current_thread, main_thread

import pytest
from hypothesis import is_hypothesis_test

QUICK = "quick"
TESTS = Path(__file__).parent

FOLDERS = ("benchmarks", "editors", "runtime", "tools/conformance")
"""Folders without quick tests.

Their tests compare with peers, start editors, play and train, or build foreign monitors.
"""

LARGE = (
    "automaton/infinite/test_reference.py",
    "automaton/infinite/test_readback.py",
    "automaton/test_bounds.py",
    "automaton/test_budgets.py",
    "automaton/test_corpus.py",
    "automaton/test_labels.py",
    "backends/test_json.py",
    "backends/test_counting_states.py",
    "grammar/test_english.py",
    "grammar/test_fuzz.py",
    "grammar/test_one_reading.py",
    "grammar/test_random_readings.py",
    "interfaces/cli/test_fuzz.py",
    "interfaces/lsp/test_actions.py",
    "interfaces/lsp/test_fuzz.py",
    "interfaces/lsp/test_references.py",
    "logic/test_english.py",
    "resolve/test_predicate_checks.py",
    "resolve/test_deep_arithmetic.py",
    "resolve/test_formulas.py",
    "tools/fmt/test_command.py",
    "tools/lint/rules/test_lasting_goal.py",
    "tools/lint/test_offers.py",
    "tools/lint/test_run.py",
    "tools/mine/test_command.py",
    "tools/mine/test_limits.py",
)
"""Files without quick tests, because they compute for seconds: large formulas, whole corpora."""

STARTS_PROCESSES = re.compile(
    r"\b(subprocess|multiprocessing|os\.fork|chromium|diff\.repository|docs\.sessions|lsp\.client|mcp\.client|playground\.(browser_page|test_server))\b"
)
"""Words in files that start processes. A file with such a word has no quick tests."""

FIXTURES = frozenset({"client", "process"})
"""Fixtures that start processes. A test that uses one of them is not quick."""

NEW_PROCESS = frozenset({"os.exec", "os.fork", "os.forkpty", "os.posix_spawn", "os.system", "subprocess.Popen"})
"""The audit events by which Python reports that a process starts."""


def is_chosen(config: pytest.Config) -> bool:
    """Whether pytest was started with ``-m quick``."""
    return bool(config.option.markexpr == QUICK)


@cache
def has_quick_tests(path: Path) -> bool:
    """Whether a file or folder may contain quick tests.

    The function does not import the file, so that nothing is loaded for it.
    """
    if not path.is_relative_to(TESTS):
        return True
    name = path.relative_to(TESTS).as_posix()
    if any(name == folder or name.startswith(f"{folder}/") for folder in FOLDERS) or name in LARGE:
        return False
    if not path.name.startswith("test_"):
        return path.is_dir()
    return not STARTS_PROCESSES.search(path.read_text(encoding="utf-8"))


def is_quick(item: pytest.Item) -> bool:
    """Whether a test is quick. Its file, its fixtures and its marks decide."""
    if not has_quick_tests(item.path) or any(item.iter_markers("slow")):
        return False
    if is_hypothesis_test(getattr(item, "obj", None)):
        return False
    return FIXTURES.isdisjoint(getattr(item, "fixturenames", ()))


class SkipProcesses:
    """A plugin that skips each test that is about to start a process.

    For example, a few tests of commands draw a picture, and a process computes its layout. If a
    second thread starts the process, the plugin cannot skip the test: then it raises an error.
    """

    def __init__(self) -> None:
        self._test_runs = False
        sys.addaudithook(self._audit)

    def _audit(self, event: str, _: object) -> None:
        if self._test_runs and event in NEW_PROCESS:
            if current_thread() is main_thread():
                pytest.skip("starts a process, so it is not quick")
            raise RuntimeError("a quick test starts a process: a rule in tests/quick.py must leave out its file")

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self) -> Iterator[None]:
        self._test_runs = True
        try:
            return (yield)
        finally:
            self._test_runs = False
