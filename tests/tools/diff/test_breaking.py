"""``tltlc breaking``: changes since a revision or against a folder, and its formats."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, ROOT, tltlc  # noqa: F401
from tests.interfaces.cli.test_loading import HEAVY, loaded_modules
from tests.tools.diff.repository import LIBRARY, SPEC, Run, _repository, codes, commit, git, needs_git, write  # noqa: F401


@needs_git
def test_unchanged_files_break_nothing(repository: Path, tltlc: Run) -> None:  # noqa: F811
    outcome = tltlc("breaking", "specs/leave.tltl", "libs/mine.tltl", "--against", "v1")
    assert (outcome.status, outcome.out) == (0, "")
    assert outcome.err == (
        "specs/leave.tltl: no changes that others notice\n"
        "libs/mine.tltl: no changes that others notice\n"
        "0 breaking, 0 changed, 0 compatible\n"
    )


@needs_git
def test_old_files_import_the_old_libraries(repository: Path, tltlc: Run) -> None:  # noqa: F811
    write(libs__mine=LIBRARY.replace("= health", "= health - 10 %"))
    outcome = tltlc("breaking", "specs", "--against", "v1", "--format", "json")
    assert (outcome.status, codes(outcome)) == (1, ["error TLT0757"])
    (diagnostic,) = json.loads(outcome.out)["diagnostics"]
    assert diagnostic["title"] == "the atom `alive` is judged differently"
    assert "at health = 0.1, it is now 0 (it does not hold) and was 0.1 (it holds)" in diagnostic["help"]
    assert diagnostic["labels"][0]["file"] == "specs/leave.tltl"
    assert codes(tltlc("breaking", ".", "--against", "v1", "--format", "json")) == ["error TLT0757"] * 2


@needs_git
def test_the_repository_is_the_one_that_holds_the_file(
    repository: Path,
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(repository / "specs")
    write(leave=SPEC.replace("keep alive", "avoid not alive\n    avoid door"))
    assert codes(tltlc("breaking", "leave.tltl", "--against", "HEAD", "--format", "json")) == ["error TLT0753"]
    monkeypatch.chdir("/")
    path = repository / "specs/leave.tltl"
    assert codes(tltlc("breaking", path, "--against", "v1", "--format", "json")) == ["error TLT0753"]
    outside = tltlc("breaking", path, ROOT / "examples/patrol.tltl", "--against", "v1")
    assert outside.status == 3
    assert "patrol.tltl` is not in the repository" in outside.err


@needs_git
def test_removed_and_added_specs_are_reported(repository: Path, tltlc: Run) -> None:  # noqa: F811
    Path("specs/leave.tltl").unlink()
    write(specs__enter="signal door: bool\nspec enter = F !door\n")
    outcome = tltlc("breaking", "specs", "--against", "v1")
    assert outcome.status == 1
    assert "error[TLT0752]: the spec `leave` is gone\n  v1:specs/leave.tltl:3:6\n" in outcome.err
    assert "note[TLT0752]: the spec `enter` is new\n  specs/enter.tltl:2:6\n" in outcome.err
    assert tltlc("breaking", "specs/leave.tltl", "--against", "v1").status == 1
    neither = tltlc("breaking", "specs/nothing.tltl", "--against", "v1")
    assert neither.status == 3 and "TLT0001" in neither.err
    empty = repository / "empty"
    empty.mkdir()
    assert tltlc("breaking", "empty", "--against", "v1").status == 2


@needs_git
def test_a_spec_that_moved_to_another_file_is_not_breaking(repository: Path, tltlc: Run) -> None:  # noqa: F811
    Path("specs/leave.tltl").rename("specs/leave_2.tltl")
    outcome = tltlc("breaking", "specs", "--against", "v1")
    title = "note[TLT0752]: the spec `leave` has moved here from `v1:specs/leave.tltl`\n  specs/leave_2.tltl:3:6\n"
    assert (outcome.status, outcome.err.count("TLT0752"), title in outcome.err) == (0, 1, True)
    assert outcome.err.endswith("\n0 breaking, 0 changed, 1 compatible\n")
    write(specs__leave_2=SPEC.replace("keep alive", "keep alive\n    limit 9 steps"))
    outcome_with_limit = tltlc("breaking", "specs", "libs", "--against", "v1", "--format", "json")
    assert codes(outcome_with_limit) == ["note TLT0752", "error TLT0758"]
    # Without the other files, the spec counts as gone.
    assert codes(tltlc("breaking", "specs/leave.tltl", "--against", "v1", "--format", "json")) == ["error TLT0752"]


@needs_git
def test_a_renamed_spec_is_breaking(repository: Path, tltlc: Run) -> None:  # noqa: F811
    for file in ("leave", "moved"):
        Path("specs/leave.tltl").unlink(missing_ok=True)
        other = SPEC.replace("spec leave", "spec escape") + "spec other = F !door\n"
        write(**{f"specs__{file}": other.replace("keep alive", "keep not not alive")})
        outcome = tltlc("breaking", "specs", "--against", "v1", "--format", "json")
        assert codes(outcome) == ["error TLT0752", "note TLT0752"]
        first, second = (diagnostic["title"] for diagnostic in json.loads(outcome.out)["diagnostics"])
        assert (first, second) == ("the spec `leave` is now called `escape`", "the spec `other` is new")


@needs_git
def test_a_renamed_artefact_is_breaking(repository: Path, tltlc: Run) -> None:  # noqa: F811
    tltlc("compile", "specs/leave.tltl", "-t", "json", "-o", "build")
    commit("v2")
    Path("build/leave.fspa.json").rename("build/other.fspa.json")
    outcome = tltlc("breaking", "build", "--against", "v2", "--format", "json")
    assert codes(outcome) == ["error TLT0752", "note TLT0752"]


@needs_git
def test_annotations_for_services_point_into_the_current_files(repository: Path, tltlc: Run) -> None:  # noqa: F811
    write(specs__leave="signal door: bool\nspec enter = F !door\n")
    (gone, _) = tltlc("breaking", "specs", "--against", "v1", "--format", "github").out.splitlines()
    assert gone.startswith("::error file=specs/leave.tltl,line=1,")
    assert "it was here (v1:specs/leave.tltl:3)" in gone
    Path("specs/leave.tltl").unlink()
    (gone,) = tltlc("breaking", "specs/leave.tltl", "--against", "v1", "--format", "github").out.splitlines()
    assert gone.startswith("::error file=specs/leave.tltl,line=3,")
    (run,) = json.loads(tltlc("breaking", "specs/leave.tltl", "--against", "v1", "--format", "sarif").out)["runs"]
    (location,) = run["results"][0]["locations"]
    assert location["physicalLocation"]["artifactLocation"]["uri"] == "specs/leave.tltl"
    # An error in the old file itself is reported at the new file, with the old position in the text.
    write(specs__leave=SPEC.replace("door", "dor", 1))
    commit("v2")
    write(specs__leave=SPEC)
    (wrong,) = tltlc("breaking", "specs", "--against", "v2", "--format", "github").out.splitlines()
    assert wrong.startswith("::error file=specs/leave.tltl,line=1,")
    assert "(v2:specs/leave.tltl:4)" in wrong


@needs_git
def test_errors_in_the_old_file_name_the_revision(repository: Path, tltlc: Run) -> None:  # noqa: F811
    write(specs__leave=SPEC.replace("door", "dor", 1))
    commit("v2")
    write(specs__leave=SPEC)
    outcome = tltlc("breaking", "specs", "--against", "v2")
    assert outcome.status == 1
    assert "error[TLT0201]: no predicate `door` here\n  v2:specs/leave.tltl:4:11\n" in outcome.err
    assert "tltlc-" not in outcome.err


@needs_git
def test_old_files_import_from_the_old_library_folders_of_the_command_line(repository: Path, tltlc: Run) -> None:  # noqa: F811
    write(more__loud="signal noise: ratio\nlet loud = noise > 50 %\n", specs__hush="import loud\nspec hush = G !loud\n")
    commit("v2")
    write(more__loud="signal noise: ratio\nlet loud = noise > 40 %\n")
    outcome = tltlc("breaking", "specs/hush.tltl", "--against", "v2", "--library", "more", "--format", "json")
    assert codes(outcome) == ["error TLT0753"]


@needs_git
def test_changed_artefacts_are_compared(repository: Path, tltlc: Run) -> None:  # noqa: F811
    assert tltlc("compile", "specs/leave.tltl", "-t", "json", "-o", "build").status == 0
    commit("v2")
    write(specs__leave=SPEC.replace("keep alive", "keep alive\n    limit 9 steps"))
    assert tltlc("compile", "specs/leave.tltl", "-t", "json", "-o", "build").status == 0
    outcome = tltlc("breaking", "build", "--against", "v2", "--format", "json")
    assert codes(outcome) == ["error TLT0758"]
    (label,) = json.loads(outcome.out)["diagnostics"][0]["labels"]
    assert label["file"] == "build/leave.fspa.json"
    line = Path(label["file"]).read_text(encoding="utf-8").splitlines()[label["start"]["line"] - 1]
    assert '"leave"' in line[label["start"]["column"] - 1 :]


@needs_git
def test_an_unknown_revision_is_reported(repository: Path, tltlc: Run) -> None:  # noqa: F811
    for name, suggestion in (("v11", "did you mean `v1`?"), ("nonsense", "`git log` and `git tag` list revisions")):
        outcome = tltlc("breaking", "specs", "--against", name)
        assert (outcome.status, outcome.out) == (3, "")
        expected = f"error[TLT0751]: there is no revision and no folder `{name}`\n  help: {suggestion}\n"
        assert outcome.err == expected
    assert tltlc("breaking", "specs", "--against", "--output=x").status == 3


@needs_git
def test_a_missing_revision_in_a_shallow_clone_suggests_fetching(
    repository: Path,
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    write(specs__leave=SPEC.replace("reach door", "require door"))
    commit("second")
    git("clone", "-q", "--depth", "1", repository.as_uri(), "shallow")
    monkeypatch.chdir("shallow")
    outcome = tltlc("breaking", "specs", "--against", "HEAD~1")
    assert outcome.status == 3
    assert "help: this clone is shallow: fetch the revision, e.g. `git fetch --unshallow`" in outcome.err


@needs_git
def test_a_file_outside_a_repository_is_reported(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    write(leave="signal door: bool\nspec leave = F door\n")
    outcome = tltlc("breaking", "leave.tltl", "--against", "v1")
    assert outcome.status == 3
    assert outcome.err == (
        f"error[TLT0751]: there is no folder `v1`, and it cannot be a revision, because `{tmp_path}` is not in a git "
        "repository\n  help: name a folder that exists, or a file in a git repository\n"
    )


@needs_git
def test_a_repository_of_another_user_suggests_safe_directory(
    repository: Path,
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.setenv("GIT_CONFIG_NOSYSTEM", "1")
    outcome = tltlc("breaking", "specs", "--against", "v1")
    assert outcome.status == 3
    assert outcome.err.endswith("`git config --global --add safe.directory FOLDER`, where FOLDER is its top folder\n")


@needs_git
def test_git_variables_of_a_hook_are_ignored(repository: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.setenv("GIT_DIR", ".git")
    monkeypatch.setenv("GIT_INDEX_FILE", ".git/index")
    assert tltlc("breaking", "specs", "--against", "HEAD").status == 0


def test_missing_git_is_reported(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    write(leave="signal door: bool\nspec leave = F door\n")
    outcome = tltlc("breaking", "leave.tltl", "--against", "v1")
    assert outcome.status == 4
    assert outcome.err == (
        "error[TLT0730]: comparing with a revision needs `git`, which is not installed\n"
        "  help: install git, or name a folder that contains the old files: `--against DIR`\n"
    )


def test_renamed_atoms_are_reported(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    old = "signal noise: ratio\nparam most: ratio = 20 %\nspec hush = G calm\n"
    old += "predicate calm in [-1, 1] = when noise < most: 1  otherwise: -1\n"
    write(old__hush=old, hush=old.replace("calm", "quiet").replace("= 20 %", "in [0, 1] = 20 %"))
    outcome = tltlc("breaking", "hush.tltl", "--against", "old", "--format", "json")
    (diagnostic,) = json.loads(outcome.out)["diagnostics"]
    assert (outcome.status, diagnostic["severity"], diagnostic["title"]) == (0, "note", "`calm` is now called `quiet`")
    write(hush=old.replace("most", "greatest"))
    assert codes(tltlc("breaking", "hush.tltl", "--against", "old", "--format", "json")) == ["error TLT0756"]
    write(hush=old.replace("calm", "quiet").replace("1  otherwise: -1", "-1  otherwise: 1"))
    assert "error TLT0753" in codes(tltlc("breaking", "hush.tltl", "--against", "old", "--format", "json"))


HURT = """signal health in [0, 1]
signal armour in [0, 1]
param low in [0, 1] = 0.2
predicate alive in [-1, 1] = health - low
predicate strong in [-1, 1] = min(health, armour) - low
spec live = G (alive & strong)
spec win = F strong
"""


IN_PLACE = "the signal `hp` must now be supplied to `live` and `win` in place of `health`"


@pytest.mark.parametrize(
    ("changes", "titles"),
    [
        ({"health": "hp"}, [IN_PLACE]),
        # A param may be renamed at the same time.
        ({"health": "hp", "low": "least"}, [IN_PLACE, "the param `low` is now called `least`"]),
        # A changed range, and a predicate that changed in another way too, are reported as well.
        (
            {"health in [0, 1]": "health in [0, 0.9]", "health": "hp"},
            [IN_PLACE, "the range of the signal `hp` is now [0, 0.9] (it was [0, 1])"],
        ),
        ({"= health": "= health / 2", "health": "hp"}, [IN_PLACE, "the atom `alive` is judged differently"]),
        # A signal that replaces two others is not a rename of both.
        (
            {"min(health, armour)": "min(hp, hp)", "health": "hp"},
            [
                "the signal `hp` must now be supplied to `live` in place of `health`",
                "the signal `armour` is no longer read by `live` and `win`",
                "the signal `health` is no longer read by `win`",
                "the signal `hp` must now be supplied to `win`",
                "the atom `strong` is judged differently",
            ],
        ),
        # Both signals still exist, so this is not a rename.
        ({"= health": "= armour"}, ["the atom `alive` is judged differently"]),
    ],
)
def test_renamed_signals_are_breaking(
    changes: dict[str, str],
    titles: list[str],
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    text = HURT
    for old, new in changes.items():
        text = text.replace(old, new)
    write(old__live=HURT, live=text)
    outcome = tltlc("breaking", "live.tltl", "--against", "old", "--format", "json")
    assert [diagnostic["title"] for diagnostic in json.loads(outcome.out)["diagnostics"]] == titles
    assert outcome.status == 1


def test_an_old_folder_is_compared(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    write(new__leave="signal door: bool\nspec leave = G door\n", old__leave="signal door: bool\nspec leave = F door\n")
    for path, against in (("new", "old"), ("new/leave.tltl", "old"), (tmp_path / "new", tmp_path / "old")):
        assert codes(tltlc("breaking", path, "--against", against, "--format", "json")) == [
            "error TLT0753",
            "error TLT0758",
        ]
    monkeypatch.chdir("new")
    assert tltlc("breaking", "leave.tltl", "--against", "../old").status == 1
    assert tltlc("breaking", ".", "--against", "../old/").status == 1
    # An old folder inside the new one is not part of it.
    shutil.copytree("../old", "earlier")
    assert "earlier" not in tltlc("breaking", ".", "--against", "earlier").err


def test_github_and_sarif_have_the_changed_place(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    write(new__leave="signal door: bool\nspec leave = G door\n", old__leave="signal door: bool\nspec leave = F door\n")
    outcome = tltlc("breaking", "new", "--against", "old", "--format", "github")
    assert outcome.out.startswith("::error file=new/leave.tltl,line=2,")
    (run,) = json.loads(tltlc("breaking", "new", "--against", "old", "--format", "sarif").out)["runs"]
    assert [result["ruleId"] for result in run["results"]] == ["TLT0753", "TLT0758"]


@pytest.mark.parametrize("arguments", [["-", "--against", "x"], ["a.tltl:b", "--against", "x"], ["a.tltl"]])
def test_wrong_usage_is_rejected(
    arguments: list[str],
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert tltlc("breaking", *arguments).status == 2


def test_no_heavy_module_is_imported(tmp_path: Path) -> None:
    (tmp_path / "old").mkdir()
    shutil.copy(EXAMPLE, tmp_path / "old")
    loaded_modules("check", EXAMPLE, folder=tmp_path)
    assert not loaded_modules("diff", EXAMPLE, EXAMPLE, folder=tmp_path) & HEAVY
    assert not loaded_modules("breaking", EXAMPLE, "--against", "old", folder=tmp_path) & HEAVY


@pytest.mark.parametrize(
    ("values", "severity"),
    [
        ("(idle, alert, chase)", "error"),
        ("(alert, idle)", "error"),
        ("(idle, alert, asleep)", "note"),
    ],
)
def test_other_values_of_an_enum_break_a_game_unless_each_keeps_its_number(
    values: str,
    severity: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    tltlc: Run,  # noqa: F811
) -> None:
    monkeypatch.chdir(tmp_path)
    text = "signal mode: {}\nspec s = F mode is alert\n"
    old = "(idle, calm, alert)" if values == "(idle, alert, chase)" else "(idle, alert)"
    write(old__s=text.format(old), s=text.format(values))
    outcome = tltlc("breaking", "s.tltl", "--against", "old", "--format", "json")
    found = [item for item in json.loads(outcome.out)["diagnostics"] if item["code"] == "TLT0755"]
    assert [item["severity"] for item in found] == [severity]
    assert found[0]["title"] == f"the signal `mode` is now {values} (it was {old})"
