"""The rules that choose the tests of ``make quick``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests import quick


def test_the_listed_folders_and_files_exist() -> None:
    assert all((quick.TESTS / folder).is_dir() for folder in quick.FOLDERS)
    assert all((quick.TESTS / file).is_file() for file in quick.LARGE)


@pytest.mark.parametrize(
    "path", [*quick.FOLDERS, *quick.LARGE, "runtime/training/test_train.py", "test_quick.py", "backends/test_c.py"]
)
def test_folders_and_files_that_start_processes_are_left_out(path: str) -> None:
    assert not quick.has_quick_tests(quick.TESTS / path)


@pytest.mark.parametrize("path", ["", "tools", "automaton/test_guards.py", "interfaces/cli/test_compile.py"])
def test_other_folders_and_files_are_read(path: str) -> None:
    assert quick.has_quick_tests(quick.TESTS / path)


def test_a_test_that_starts_a_process_is_skipped_and_a_thread_cannot_start_one(tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text(
        "from tests.quick import SkipProcesses\n"
        "def pytest_configure(config):\n    config.pluginmanager.register(SkipProcesses())\n",
        encoding="utf-8",
    )
    (tmp_path / "test_it.py").write_text(
        "import subprocess, sys\nfrom concurrent.futures import ThreadPoolExecutor\n"
        "def start():\n    subprocess.run([sys.executable, '-c', ''])\n"
        "def test_starts():\n    start()\n"
        "def test_starts_in_a_thread():\n    ThreadPoolExecutor().submit(start).result()\n"
        "def test_starts_nothing():\n    pass\n",
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-c", "/dev/null", "--rootdir", "."]
    process = subprocess.run(
        [*command, "test_it.py"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(quick.TESTS.parent), "PYTEST_ADDOPTS": ""},
        capture_output=True,
        text=True,
    )
    assert "1 failed, 1 passed, 1 skipped" in process.stdout, process.stdout
    assert "a quick test starts a process" in process.stdout
