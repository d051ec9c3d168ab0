from __future__ import annotations

import importlib
import subprocess
import sys

import pytest

from tests.fixtures import cover_and_hide
from tltlc import backends
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError


@pytest.mark.parametrize("name", backends.targets())
def test_every_target_emits_the_files_that_it_names(name: str) -> None:
    target = backends.target(name)
    assert target.name == name
    files = backends.emit(name, cover_and_hide())
    assert sorted(files) == sorted(target.file_names("cover_and_hide"))


def test_the_default_targets_exist() -> None:
    assert set(backends.DEFAULT_TARGETS) <= set(backends.targets())


@pytest.mark.parametrize("name", backends.targets())
def test_output_is_the_same_for_the_same_input(name: str) -> None:
    assert backends.emit(name, cover_and_hide()) == backends.emit(name, cover_and_hide())


@pytest.mark.parametrize(
    ("name", "suggestion"), [("jsn", "did you mean `json`?"), ("cobol", "there are: "), ("", "there are")]
)
def test_an_unknown_target_is_an_error_with_a_suggestion(name: str, suggestion: str) -> None:
    with pytest.raises(TltlError) as caught:
        backends.emit(name, cover_and_hide())
    (error,) = caught.value.diagnostics
    assert error.code == "TLT0710"
    assert suggestion in (error.help or "")


@pytest.mark.parametrize("name", ["artefact", "drawing", "json.decoder", "..pipeline", "os"])
def test_only_targets_can_be_loaded_by_name(name: str) -> None:
    with pytest.raises(TltlError):
        backends.emit(name, cover_and_hide())


@pytest.mark.parametrize("name", ["../../evil", "a b", "a.b", "", "naïve"])
def test_a_name_that_is_no_plain_file_name_is_rejected(name: str) -> None:
    with pytest.raises(ValueError, match="plain name"):
        backends.emit("dot", replace(cover_and_hide(), name=name))


def test_the_default_targets_load_no_heavy_library() -> None:
    program = (
        "import sys\nfrom tltlc import backends\n"
        "for name in ('json', 'dot'): backends.target(name)\n"
        "print(*sorted({module.partition('.')[0] for module in sys.modules}))"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    heavy = {"sympy", "networkx", "graphviz", "pygraphviz", "jsonschema", "fastjsonschema", "rich", "numpy", "decimal"}
    assert not heavy & set(result.stdout.split())


def test_targets_are_modules_of_the_package() -> None:
    for name in backends.targets():
        assert hasattr(importlib.import_module(f"tltlc.backends.{name}"), "emit")
