"""``tltlc breaking``: changes since a revision or against a folder, and its formats."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, ROOT, Outcome, tltlc  # noqa: F401
from tests.interfaces.cli.test_loading import HEAVY, loaded_modules

Run = Callable[..., Outcome]

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="needs git")

LIBRARY = "signal health: ratio\npredicate alive in [-1, 1] = health\n"
SPEC = "import mine\nsignal door: bool\nspec leave {\n    reach door\n    keep alive\n}\n"
PROJECT = 'libraries = ["libs"]\n'


def git(*arguments: str) -> None:
    names = {f"GIT_{role}_{field}": "t@t" for role in ("AUTHOR", "COMMITTER") for field in ("NAME", "EMAIL")}
    environment = {**os.environ, **names, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    subprocess.run(["git", *arguments], check=True, capture_output=True, env=environment)


def write(**files: str) -> None:
    for path, text in files.items():
        file = Path(path.replace("__", "/") + (".toml" if path == "tltl" else ".tltl"))
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


def commit(tag: str) -> None:
    git("add", "-A")
    git("commit", "-qm", tag)
    git("tag", tag)


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make the current folder a repository. Its revision `v1` has a spec and a library that it
    imports."""
    monkeypatch.chdir(tmp_path)
    git("init", "-q", ".")
    write(specs__leave=SPEC, libs__mine=LIBRARY, tltl=PROJECT)
    commit("v1")
    return tmp_path


def codes(outcome: Outcome) -> list[str]:
    return [f"{diagnostic['severity']} {diagnostic['code']}" for diagnostic in json.loads(outcome.out)["diagnostics"]]


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


def test_shipped_specs_equal_themselves(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(ROOT)
    for folder in ("examples", "stdlib_predicates"):
        shutil.copytree(folder, tmp_path / folder, ignore=shutil.ignore_patterns("*.csv"))
    outcome = tltlc("breaking", "examples", "stdlib_predicates", "--against", tmp_path)
    assert (outcome.status, outcome.out) == (0, "")
    assert outcome.err.endswith("0 breaking, 0 changed, 0 compatible\n")


@pytest.mark.parametrize(
    ("library", "old", "new", "expected"),
    [
        ("core", "(x - threshold) / margin, -1", "(x - threshold) / margin / 2, -1", ["warning TLT0757"]),
        ("core", "tanh((x - y) / scale)", "tanh((y - x) / scale)", ["error TLT0757"]),
        ("core", "about(x, y, tolerance)", "about(x, y, tolerance = 1)", []),
        (
            "core",
            "(x, low, high) in [-1, 1] =\n    clamp(1",
            "(x, high, low) in [-1, 1] =\n    clamp(1",
            ["error TLT0759"],
        ),
        ("stealth", "threshold: ratio = 50 %", "threshold: ratio = 60 %", ["error TLT0757"]),
        ("stealth", "1 - time / deadline", "1 - 2 * time / deadline", ["error TLT0757"]),
        ("stealth", "min(2 * crouching - 1, 2 * grounded - 1)", "2 * crouching - 1", ["error TLT0757"]),
        (
            "stealth",
            "[-1, 1] = 1 - 2 * seen",
            "[-1, 1] = min(1 - 2 * seen, 1 - 2 * visible)",
            ["error TLT0754", "error TLT0757"],
        ),
        ("stealth", "signal time: time in [0 s, inf]", "signal time: time", ["note TLT0755"]),
        ("spatial", "= 20 m", "= 20.5 m", ["warning TLT0756", "warning TLT0757"]),
        ("spatial", "param level_size", "param size", None),
        (
            "spatial",
            "param level_size: length in [2 m, 10 km]",
            "param level_size: length in [3 m, 10 km]",
            ["error TLT0756"],
        ),
        ("spatial", "tolerance: angle = 30 deg", "tolerance: angle", ["error TLT0759"]),
    ],
)
def test_a_change_of_a_shipped_library_is_reported_by_its_severity(
    library: str,
    old: str,
    new: str,
    expected: list[str] | None,
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    before = (ROOT / f"stdlib_predicates/{library}.tltl").read_text(encoding="utf-8")
    after = before.replace(old, new)
    assert after != before
    if expected is None:
        after, expected = after.replace("= level_size", "= size"), ["error TLT0756"]
    write(old__mine=before, mine=after)
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == expected


def test_changed_declarations_of_a_library_are_reported(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    base = "signal a: bool\nsignal b: bool\nsignal c: bool\nexclusive a, c\n"
    plain = "import base\nlet d = a and b\n"

    def diagnostics(old: str, new: str) -> list[tuple[str, str]]:
        write(base=base, old__base=base, old__mine=old, mine=new)
        outcome = tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")
        return [(diagnostic["severity"], diagnostic["title"]) for diagnostic in json.loads(outcome.out)["diagnostics"]]

    with_rules = f"clock 20 Hz\n{plain}exclusive a, b\n"
    assert diagnostics(plain, with_rules) == [
        ("error", "`a` and `b` are now exclusive"),
        ("error", "specs are now sampled every 0.05 s (they were sampled without a clock)"),
    ]
    assert diagnostics(with_rules, plain) == [
        ("warning", "`a` and `b` are no longer exclusive"),
        ("error", "specs are now sampled without a clock (they were sampled every 0.05 s)"),
    ]
    assert diagnostics(with_rules, with_rules.replace("a, b", "b, a").replace("20 Hz", "50 ms")) == []
    # A group that a wider group implies is not reported.
    wide = f"{plain}exclusive a, b, c\n"
    narrow = wide.replace("a, b, c", "a, b")
    assert diagnostics(narrow, wide) == [("error", "`a`, `b` and `c` are now exclusive")]
    assert diagnostics(wide, narrow) == [("warning", "`a`, `b` and `c` are no longer exclusive")]
    assert diagnostics(wide, f"{narrow}exclusive b, c\nexclusive c, a\n") == []
    # The same holds for specs.
    spec = "spec s = F (a | b | c)\n"
    assert diagnostics(wide + spec, narrow + spec) == [("warning", "`a`, `b` and `c` are no longer exclusive in `s`")]
    assert diagnostics(narrow + spec, wide + spec) == [("error", "`a`, `b` and `c` are now exclusive in `s`")]
    # A declaration that was imported is reported for the file that declares it.
    assert diagnostics(plain, "let d = true\n") == [("error", f"the signal `{name}` is gone") for name in "abc"]
    Path("old/mine.tltl").unlink()
    assert tltlc("breaking", "mine.tltl", "--against", "old").err.endswith("0 breaking, 0 changed, 0 compatible\n")


def test_a_library_exports_what_it_imports(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    own = "signal noise: ratio\nparam most: ratio = 20 %\npredicate calm in [-1, 1] = clamp(most - noise, -1, 1)\n"
    write(old__mine=f"import base\n{own}", old__base="signal far: length in [0 m, 9 m]\nlet near = far < 3 m\n")
    # Declarations that move into an imported file still exist.
    write(mine="import base\nimport moved\n", moved=own, base=Path("old/base.tltl").read_text(encoding="utf-8"))
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == []
    write(mine=own)
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == ["error TLT0759"] * 2


def test_a_predicate_that_reads_more_signals_is_reported(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    signals = "signal a: bool\nsignal b: bool\nsignal c: bool\n"
    write(old__mine=f"{signals}predicate p = 2 * a - 1\n", mine=f"{signals}predicate p = 2 * min(a, b, c) - 1\n")
    (added_signals, _) = json.loads(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json").out)[
        "diagnostics"
    ]
    assert added_signals["title"] == "the predicate `p` now reads `b` and `c`"
    assert added_signals["help"] == "have the game supply them wherever the predicate is used"


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
