"""Programs that import documented names from where these were before still run."""

from __future__ import annotations

import importlib
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import tltlc
from tltlc.tools.fmt import format_text

MOVED = {
    "tltlc.comparison:are_equivalent": "tltlc.automaton.compare",
    "tltlc.comparison:is_included": "tltlc.automaton.compare",
    "tltlc.comparison:separating": "tltlc.automaton.compare",
    "tltlc.fmt:format_text": "tltlc.tools.fmt",
    "tltlc.monitor.reward:RewardOptions": "tltlc.monitor.progress_and_reward",
    "tltlc.playground:view": "tltlc.interfaces.playground",
    "tltlc.rabin.work:OutOfWork": "tltlc.automaton.work",
    "tltl_runtime.batch:BatchMonitor": "tltl_runtime.spec.batch",
    "tltl_runtime.stealth.episodes.cause:cause": "tltl_runtime.stealth.recordings.cause",
    "tltl_runtime.stealth.episodes.file:read_episode": "tltl_runtime.stealth.recordings.file",
    "tltl_runtime.stealth.episodes.file:write_episode": "tltl_runtime.stealth.recordings.file",
    "tltl_runtime.stealth.recording:RecordEpisode": "tltl_runtime.stealth.episode_recorder",
    "tltl_runtime.training.gail:__doc__": "tltl_runtime.training.imitation.gail",
}


@pytest.mark.parametrize("old", MOVED)
def test_an_old_name_is_the_same_object(old: str) -> None:
    module, name = old.split(":")
    if module.startswith("tltl_runtime"):
        pytest.importorskip("torch")
        pytest.importorskip("gymnasium")
    assert getattr(import_module(module), name) is getattr(import_module(MOVED[old]), name)


def test_a_folder_that_an_update_left_behind_is_not_taken_for_a_module(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "fmt" / "__pycache__").mkdir(parents=True)
    monkeypatch.setattr(tltlc, "__path__", [*tltlc.__path__, str(tmp_path)])
    monkeypatch.delitem(sys.modules, "tltlc.fmt", raising=False)
    importlib.invalidate_caches()
    assert import_module("tltlc.fmt").format_text is format_text


def test_a_module_with_an_old_name_loads_on_first_import() -> None:
    code = "import sys, tltlc; print(sorted(name for name in sys.modules if name.startswith('tltlc')))"
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert printed == "['tltlc']\n"


def test_other_modules_are_still_missing() -> None:
    with pytest.raises(ModuleNotFoundError):
        import_module("tltlc.rabins")
    with pytest.raises(ImportError, match="nothing"):
        exec("from tltlc.comparison import nothing")


def test_an_old_name_never_loads_a_second_copy_of_a_module() -> None:
    with pytest.raises(ModuleNotFoundError, match="is not a package"):
        import_module("tltlc.fmt.page")
