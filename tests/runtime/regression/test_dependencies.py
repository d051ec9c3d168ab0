"""The selection of the cases that depend on changed files."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.runtime.regression.handmade import ROOM
from tltl_runtime.policies.shipped import shipped_policy
from tltl_runtime.regression.suite.dependencies import dependencies, select
from tltl_runtime.regression.suite.suite import SHIPPED, Suite, read_suite
from tltl_runtime.stealth.levels.default_spec import LEVELS
from tltl_runtime.stealth.levels.file import load_level

SUITE = """[[case]]
level = "levels/vault.toml"
policy = "trained"

[[case]]
level = "levels/vault.toml"
variant = "v1"
policy = "trained"

[[case]]
level = "navigation"

[[case]]
level = "branching"
overlay = ["guard_alert", "edits/wide.toml"]
spec = "plans.tltl:careful"
"""
VAULT = """spec = "vault.tltl:unseen"
[variants]
v0 = []
v1 = ["wide"]
[[use]]
asset = "crates"
at = [5.0, 5.0, 0.0]
"""
BOTH, ALL = [0, 1], [0, 1, 2, 3]


@pytest.fixture(name="suite")
def _suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Suite:
    files = {
        "game/game.toml": SUITE,
        "game/levels/vault.toml": VAULT + ROOM,
        "game/levels/vault.tltl": 'import stealth\nimport "plans/parts.tltl"\nspec unseen = F alive\n',
        "game/levels/plans/parts.tltl": "import spatial\n",
        "game/levels/assets/crates.toml": 'doc = "Crates."\ntype = "part"\n',
        "game/levels/overlays/wide.toml": 'doc = "More."\n',
        "game/edits/wide.toml": "",
        "game/plans.tltl": "import own\nspec careful = F alive\n",
        "game/own.tltl": "signal alive: bool\n",
        "game/trained/metrics.jsonl": "",
        "README.md": "",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    shutil.copy(shipped_policy("navigation") or "", tmp_path / "game" / "trained" / "policy.safetensors")
    monkeypatch.chdir(tmp_path)
    return read_suite(Path("game/game.toml"))


def concerned(suite: Suite, *names: str) -> list[int]:
    selection = select(suite, names)
    assert sorted([*selection.cases, *selection.left_out], key=suite.cases.index) == list(suite.cases)
    return [suite.cases.index(case) for case in selection.cases]


@pytest.mark.parametrize(
    ("name", "cases"),
    [
        ("game/levels/vault.toml", BOTH),
        ("levels/vault.toml", BOTH),
        ("vault.toml", BOTH),
        ("vault", BOTH),
        ("game/levels/assets/crates.toml", BOTH),
        # The package has an asset of the same name, which `branching` uses.
        ("assets/crates", [0, 1, 3]),
        ("crates", [0, 1, 3]),
        ("game/levels/overlays/wide.toml", [1]),
        ("overlays/wide.toml", [1]),
        ("game/edits/wide.toml", [3]),
        ("wide", [1, 3]),
        # `vault` and `branching` have an enemy of the kind `guard`; the overlay `guard_alert` has another name.
        ("guard", [0, 1, 3]),
        ("guard_alert.toml", [3]),
        ("navigation.toml", [2]),
        ("corridor", [2]),
        ("corridor_shut", []),
        ("game/levels/plans/parts.tltl", BOTH),
        ("vault.tltl", BOTH),
        ("game/plans.tltl", [3]),
        ("own.tltl", [3]),
        ("stealth.tltl", [0, 1, 3]),
        ("game/trained/policy.safetensors", BOTH),
        ("game/trained", BOTH),
        ("game/trained/metrics.jsonl", []),
        ("branching.safetensors", [3]),
        ("game/game.toml", ALL),
        ("game.baseline.json", ALL),
        ("game/levels", BOTH),
        (".", ALL),
        ("README.md", []),
        ("levels/README.md", []),
        ("ault.toml", []),
        ("other/levels/vault.toml", []),
        ("", []),
    ],
)
def test_a_name_selects_the_cases_that_depend_on_it(suite: Suite, name: str, cases: list[int]) -> None:
    assert concerned(suite, *filter(None, [name])) == cases
    assert select(suite, [name]).unknown == (() if cases else (name,)) or not name


def test_paths_are_relative_to_the_working_directory_or_the_checkout(
    suite: Suite, monkeypatch: pytest.MonkeyPatch
) -> None:
    absolute_suite = read_suite(suite.path.absolute())
    monkeypatch.chdir("game/levels")
    assert concerned(absolute_suite, "vault.toml") == concerned(absolute_suite, "../levels/./vault.toml") == BOTH
    assert concerned(absolute_suite, "../edits/wide.toml") == [3]
    assert concerned(absolute_suite, str(absolute_suite.path)) == ALL
    # `git diff --name-only` lists paths relative to the top of the checkout.
    assert concerned(absolute_suite, "game/levels/assets/crates.toml") == BOTH


@pytest.mark.parametrize(
    ("name", "quoted"),
    [
        ("wächter", '"game/levels/assets/w\\303\\244chter.toml"'),
        ('a "b"', '"game/levels/assets/a \\"b\\".toml"'),
        ("a\tb", '"game/levels/assets/a\\tb.toml"'),
        ("plain", '"game/levels/assets/plain.toml"'),
    ],
)
@pytest.mark.skipif(os.name == "nt", reason="no such names there")
def test_names_quoted_by_git_are_understood(suite: Suite, name: str, quoted: str) -> None:
    Path("game/levels/assets/crates.toml").rename(f"game/levels/assets/{name}.toml")
    text = (VAULT + ROOM).replace('"crates"', json.dumps(name, ensure_ascii=False))
    Path("game/levels/vault.toml").write_text(text, encoding="utf-8")
    assert concerned(suite, quoted) == BOTH
    assert select(suite, [quoted[1:]]).unknown == (quoted[1:],), "quotes come in pairs"


def test_the_output_of_git_for_a_renamed_asset_is_understood(suite: Suite) -> None:
    def git(*words: str) -> list[str]:
        names = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
        return subprocess.run(["git", *names, *words], check=True, capture_output=True, text=True).stdout.splitlines()

    if shutil.which("git") is None:
        pytest.skip("git is not installed")
    git("init", "--quiet")
    git("add", ".")
    git("commit", "--quiet", "--message", "All.")
    git("mv", "game/levels/assets/crates.toml", "game/levels/assets/kisten_für_alle.toml")
    changed = git("-c", "core.quotePath=off", "diff", "--no-renames", "--name-only", "HEAD")
    assert changed == ["game/levels/assets/crates.toml", "game/levels/assets/kisten_für_alle.toml"]
    assert concerned(suite, *changed) == BOTH
    assert concerned(suite, *git("diff", "--no-renames", "--name-only", "HEAD")) == BOTH


def test_specs_depend_on_their_project_file(suite: Suite) -> None:
    """A project file that would be created closer to a spec counts, too."""
    assert concerned(suite, "game/tltl.toml") == [0, 1, 3]
    assert concerned(suite, "tltl.toml") == ALL
    assert concerned(suite, "game/levels/tltl.toml") == BOTH
    Path("game/tltl.toml").write_text("", encoding="utf-8")
    assert concerned(suite, "game/tltl.toml") == [0, 1, 3]
    assert concerned(suite, str(Path("tltl.toml").absolute())) == []


def test_a_name_may_have_dots(suite: Suite) -> None:
    Path("game/levels/assets/crates.toml").rename("game/levels/assets/crates.v2.toml")
    text = (VAULT + ROOM).replace('"crates"', '"crates.v2"')
    Path("game/levels/vault.toml").write_text(text, encoding="utf-8")
    assert concerned(suite, "assets/crates.v2") == concerned(suite, "assets/crates.v2.toml") == BOTH


def test_several_names_select_all_cases_and_unknown_names_are_listed(suite: Suite) -> None:
    selection = select(suite, ["navigation.toml", "README.md", "src/game.py", "vault", "README.md"])
    assert [suite.cases.index(case) for case in selection.cases] == [0, 1, 2]
    assert [case.name for case in selection.left_out] == ["branching:v0+guard_alert+wide"]
    assert selection.unknown == ("README.md", "src/game.py")


def test_a_link_counts_by_its_own_name_and_by_its_target(suite: Suite) -> None:
    asset = Path("game/levels/assets/crates.toml")
    Path("lib").mkdir()
    asset.rename("lib/hard_crates.toml")
    asset.symlink_to(Path("lib/hard_crates.toml").resolve())
    checkout = Path.cwd().name
    for name in (f"{checkout}/game/levels/assets/crates.toml", "lib/hard_crates.toml", "hard_crates"):
        assert concerned(suite, name) == BOTH, name


def test_a_file_that_would_take_precedence_counts(suite: Suite) -> None:
    """Deleting or creating an asset beside a level changes which asset the level uses."""
    Path("game/levels/assets/crates.toml").unlink()
    assert concerned(suite, "game/levels/assets/crates.toml") == BOTH
    assert concerned(suite, "game/levels/assets/guard.toml") == BOTH
    Path("game/levels/assets/guard.toml").write_text("", encoding="utf-8")
    assert str(LEVELS / "assets" / "guard.toml") not in map(str, dependencies(suite, suite.cases[0]))
    Path("game/levels/plans/parts.tltl").unlink()
    assert concerned(suite, "game/levels/plans/parts.tltl") == BOTH


@pytest.mark.parametrize(
    "damage",
    [
        "[[use]\n",  # no TOML
        "use = 3\nenemy = 'guard'\nvariants = 7\n",
    ],
)
def test_a_broken_level_depends_on_the_files_that_can_be_read_from_it(suite: Suite, damage: str) -> None:
    Path("game/levels/vault.toml").write_text(damage + VAULT + ROOM, encoding="utf-8")
    assert concerned(suite, "game/levels/vault.toml") == BOTH
    assert concerned(suite, "crates", "guard") == [*BOTH, 3]
    assert concerned(suite, "vault.tltl") == BOTH
    Path("game/levels/vault.toml").unlink()
    assert concerned(suite, "game/levels/vault.toml") == BOTH


def test_a_broken_spec_still_counts(suite: Suite) -> None:
    Path("game/plans.tltl").write_text("import own\nspec careful = ((\n", encoding="utf-8")
    assert concerned(suite, "own.tltl") == [3]
    Path("game/plans.tltl").write_bytes(b"\0")
    assert concerned(suite, "plans.tltl") == [3]


def test_circular_imports_end(suite: Suite) -> None:
    Path("game/own.tltl").write_text('import "plans.tltl"\n', encoding="utf-8")
    assert concerned(suite, "own.tltl") == [3]


def test_the_libraries_of_a_project_count(suite: Suite) -> None:
    Path("game/tltl.toml").write_text('libraries = ["shared"]\n', encoding="utf-8")
    Path("game/shared").mkdir()
    Path("game/own.tltl").rename("game/shared/own.tltl")
    assert concerned(suite, "game/shared/own.tltl") == [3]
    assert concerned(suite, "game/own.tltl") == [3], "it would be taken first"


def test_a_shipped_case_depends_on_all_files_of_its_level() -> None:
    suite = read_suite(SHIPPED)
    for case in suite.cases:
        paths = dependencies(suite, case)
        for name, _ in load_level(case.level, case.variant).files:
            assert (LEVELS / name).resolve() in paths
        assert shipped_policy(case.level) in paths
    names = [suite.cases[index].name for index in concerned(suite, "guard_thorough")]
    assert names == ["cover_and_hide:v2", "branching:v2"]
