"""``tltlc breaking``: the old files are those of a revision or folder, with their own imports; its formats."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, ROOT, Outcome, tltlc  # noqa: F401
from tests.interfaces.cli.test_loading import HEAVY, loaded

Run = Callable[..., Outcome]

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="needs git")

LIBRARY = "signal health: ratio\npredicate alive in [-1, 1] = health\n"
SPEC = "import mine\nsignal door: bool\nspec leave {\n    reach door\n    keep alive\n}\n"
PROJECT = 'libraries = ["libs"]\n'


def git(*arguments: str) -> None:
    names = {f"GIT_{who}_{what}": "t@t" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
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
    """A repository whose revision `v1` holds a spec that imports a library of its project; the current folder."""
    monkeypatch.chdir(tmp_path)
    git("init", "-q", ".")
    write(specs__leave=SPEC, libs__mine=LIBRARY, tltl=PROJECT)
    commit("v1")
    return tmp_path


def codes(done: Outcome) -> list[str]:
    return [f"{each['severity']} {each['code']}" for each in json.loads(done.out)["diagnostics"]]


@needs_git
def test_nothing_has_changed(repository: Path, tltlc: Run) -> None:  # noqa: F811
    done = tltlc("breaking", "specs/leave.tltl", "libs/mine.tltl", "--against", "v1")
    assert (done.status, done.out) == (0, "")
    assert done.err == (
        "specs/leave.tltl: nothing has changed that others notice\n"
        "libs/mine.tltl: nothing has changed that others notice\n"
        "0 breaking, 0 changed, 0 compatible\n"
    )


@needs_git
def test_imports_of_the_old_files_are_the_old_ones(repository: Path, tltlc: Run) -> None:  # noqa: F811
    write(libs__mine=LIBRARY.replace("= health", "= health - 10 %"))
    done = tltlc("breaking", "specs", "--against", "v1", "--format", "json")
    assert (done.status, codes(done)) == (1, ["error TLT0757"])
    (found,) = json.loads(done.out)["diagnostics"]
    assert found["title"] == "the atom `alive` is judged otherwise"
    assert "at health = 0.1 it is 0 (it does not hold), and was 0.1 (it holds)" in found["help"]
    assert found["labels"][0]["file"] == "specs/leave.tltl"
    assert codes(tltlc("breaking", ".", "--against", "v1", "--format", "json")) == ["error TLT0757"] * 2


@needs_git
def test_it_finds_the_repository_of_the_file(
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
    elsewhere = tltlc("breaking", path, ROOT / "examples/patrol.tltl", "--against", "v1")
    assert elsewhere.status == 3
    assert "patrol.tltl` does not lie in the repository" in elsewhere.err


@needs_git
def test_files_that_are_gone_or_new(repository: Path, tltlc: Run) -> None:  # noqa: F811
    Path("specs/leave.tltl").unlink()
    write(specs__enter="signal door: bool\nspec enter = F !door\n")
    done = tltlc("breaking", "specs", "--against", "v1")
    assert done.status == 1
    assert "error[TLT0752]: the spec `leave` is gone\n  v1:specs/leave.tltl:3:6\n" in done.err
    assert "note[TLT0752]: the spec `enter` is new\n  specs/enter.tltl:2:6\n" in done.err
    assert tltlc("breaking", "specs/leave.tltl", "--against", "v1").status == 1
    neither = tltlc("breaking", "specs/nothing.tltl", "--against", "v1")
    assert neither.status == 3 and "TLT0001" in neither.err
    empty = repository / "empty"
    empty.mkdir()
    assert tltlc("breaking", "empty", "--against", "v1").status == 2


@needs_git
def test_a_spec_that_has_moved_to_another_file(repository: Path, tltlc: Run) -> None:  # noqa: F811
    Path("specs/leave.tltl").rename("specs/leave_2.tltl")
    done = tltlc("breaking", "specs", "--against", "v1")
    title = "note[TLT0752]: the spec `leave` has moved here from `v1:specs/leave.tltl`\n  specs/leave_2.tltl:3:6\n"
    assert (done.status, done.err.count("TLT0752"), title in done.err) == (0, 1, True)
    assert done.err.endswith("\n0 breaking, 0 changed, 1 compatible\n")
    write(specs__leave_2=SPEC.replace("keep alive", "keep alive\n    limit 9 steps"))
    found = tltlc("breaking", "specs", "libs", "--against", "v1", "--format", "json")
    assert codes(found) == ["note TLT0752", "error TLT0758"]
    # One that was not asked about may be anywhere.
    assert codes(tltlc("breaking", "specs/leave.tltl", "--against", "v1", "--format", "json")) == ["error TLT0752"]


@needs_git
def test_a_spec_that_is_called_otherwise(repository: Path, tltlc: Run) -> None:  # noqa: F811
    for file in ("leave", "moved"):
        Path("specs/leave.tltl").unlink(missing_ok=True)
        other = SPEC.replace("spec leave", "spec escape") + "spec other = F !door\n"
        write(**{f"specs__{file}": other.replace("keep alive", "keep not not alive")})
        found = tltlc("breaking", "specs", "--against", "v1", "--format", "json")
        assert codes(found) == ["error TLT0752", "note TLT0752"]
        first, second = (each["title"] for each in json.loads(found.out)["diagnostics"])
        assert (first, second) == ("the spec `leave` is called `escape` now", "the spec `other` is new")


@needs_git
def test_artefacts_do_not_move(repository: Path, tltlc: Run) -> None:  # noqa: F811
    tltlc("compile", "specs/leave.tltl", "-t", "json", "-o", "build")
    commit("v2")
    Path("build/leave.fspa.json").rename("build/other.fspa.json")
    found = tltlc("breaking", "build", "--against", "v2", "--format", "json")
    assert codes(found) == ["error TLT0752", "note TLT0752"]


@needs_git
def test_services_are_told_paths_that_they_know(repository: Path, tltlc: Run) -> None:  # noqa: F811
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
    # An error of the old file itself is found in it.
    write(specs__leave=SPEC.replace("door", "dor", 1))
    commit("v2")
    write(specs__leave=SPEC)
    (wrong,) = tltlc("breaking", "specs", "--against", "v2", "--format", "github").out.splitlines()
    assert wrong.startswith("::error file=specs/leave.tltl,line=1,")
    assert "(v2:specs/leave.tltl:4)" in wrong


@needs_git
def test_errors_of_the_old_file_are_said_of_the_revision(repository: Path, tltlc: Run) -> None:  # noqa: F811
    write(specs__leave=SPEC.replace("door", "dor", 1))
    commit("v2")
    write(specs__leave=SPEC)
    done = tltlc("breaking", "specs", "--against", "v2")
    assert done.status == 1
    assert "error[TLT0201]: no predicate `door` here\n  v2:specs/leave.tltl:4:11\n" in done.err
    assert "tltlc-" not in done.err


@needs_git
def test_libraries_named_on_the_command_line_are_the_old_ones(repository: Path, tltlc: Run) -> None:  # noqa: F811
    write(more__loud="signal noise: ratio\nlet loud = noise > 50 %\n", specs__hush="import loud\nspec hush = G !loud\n")
    commit("v2")
    write(more__loud="signal noise: ratio\nlet loud = noise > 40 %\n")
    done = tltlc("breaking", "specs/hush.tltl", "--against", "v2", "--library", "more", "--format", "json")
    assert codes(done) == ["error TLT0753"]


@needs_git
def test_artefacts(repository: Path, tltlc: Run) -> None:  # noqa: F811
    assert tltlc("compile", "specs/leave.tltl", "-t", "json", "-o", "build").status == 0
    commit("v2")
    write(specs__leave=SPEC.replace("keep alive", "keep alive\n    limit 9 steps"))
    assert tltlc("compile", "specs/leave.tltl", "-t", "json", "-o", "build").status == 0
    done = tltlc("breaking", "build", "--against", "v2", "--format", "json")
    assert codes(done) == ["error TLT0758"]
    (label,) = json.loads(done.out)["diagnostics"][0]["labels"]
    assert label["file"] == "build/leave.fspa.json"
    line = Path(label["file"]).read_text(encoding="utf-8").splitlines()[label["start"]["line"] - 1]
    assert '"leave"' in line[label["start"]["column"] - 1 :]


@needs_git
def test_what_is_no_revision(repository: Path, tltlc: Run) -> None:  # noqa: F811
    for name, way_out in (("v11", "did you mean `v1`?"), ("nonsense", "`git log` and `git tag` list revisions")):
        done = tltlc("breaking", "specs", "--against", name)
        assert (done.status, done.out) == (3, "")
        expected = f"error[TLT0751]: there is no revision and no folder `{name}`\n  help: {way_out}\n"
        assert done.err == expected
    assert tltlc("breaking", "specs", "--against", "--output=x").status == 3


@needs_git
def test_a_shallow_clone(repository: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    write(specs__leave=SPEC.replace("reach door", "require door"))
    commit("second")
    git("clone", "-q", "--depth", "1", repository.as_uri(), "shallow")
    monkeypatch.chdir("shallow")
    done = tltlc("breaking", "specs", "--against", "HEAD~1")
    assert done.status == 3
    assert "help: this clone is shallow: fetch the revision, e.g. `git fetch --unshallow`" in done.err


@needs_git
def test_no_repository(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    write(leave="signal door: bool\nspec leave = F door\n")
    done = tltlc("breaking", "leave.tltl", "--against", "v1")
    assert done.status == 3
    assert done.err == (
        f"error[TLT0751]: there is no folder `v1`, and `{tmp_path}` lies in no git repository in which it could be a "
        "revision\n  help: name a folder that is there, or a file of the repository\n"
    )


@needs_git
def test_a_repository_of_another_user(repository: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.setenv("GIT_CONFIG_NOSYSTEM", "1")
    done = tltlc("breaking", "specs", "--against", "v1")
    assert done.status == 3
    assert done.err.endswith("help: allow it: `git config --global --add safe.directory FOLDER`\n")


@needs_git
def test_in_a_hook(repository: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.setenv("GIT_DIR", ".git")
    monkeypatch.setenv("GIT_INDEX_FILE", ".git/index")
    assert tltlc("breaking", "specs", "--against", "HEAD").status == 0


def test_no_git(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    write(leave="signal door: bool\nspec leave = F door\n")
    done = tltlc("breaking", "leave.tltl", "--against", "v1")
    assert done.status == 4
    assert done.err == (
        "error[TLT0730]: comparing with a revision needs `git`, which is not installed\n"
        "  help: install git, or name a folder that holds the old files: `--against DIR`\n"
    )


def test_atoms_that_are_called_otherwise(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    old = "signal noise: ratio\nparam most: ratio = 20 %\nspec hush = G calm\n"
    old += "predicate calm in [-1, 1] = when noise < most: 1  otherwise: -1\n"
    write(old__hush=old, hush=old.replace("calm", "quiet").replace("= 20 %", "in [0, 1] = 20 %"))
    done = tltlc("breaking", "hush.tltl", "--against", "old", "--format", "json")
    (called,) = json.loads(done.out)["diagnostics"]
    assert (done.status, called["severity"], called["title"]) == (0, "note", "`calm` is called `quiet` now")
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


IN_PLACE = "the signal `hp` must be supplied now in place of `health`, to `live` and `win`"


@pytest.mark.parametrize(
    ("changes", "titles"),
    [
        ({"health": "hp"}, [IN_PLACE]),
        # Also where a param is called otherwise.
        ({"health": "hp", "low": "least"}, [IN_PLACE, "the param `low` is called `least` now"]),
        # Another range is said besides, and so is a predicate that is another one.
        (
            {"health in [0, 1]": "health in [0, 0.9]", "health": "hp"},
            [IN_PLACE, "the signal `hp` has the range [0, 0.9] now, and had [0, 1]"],
        ),
        ({"= health": "= health / 2", "health": "hp"}, [IN_PLACE, "the atom `alive` is judged otherwise"]),
        # One that takes the place of two is no other name of both.
        (
            {"min(health, armour)": "min(hp, hp)", "health": "hp"},
            [
                "the signal `hp` must be supplied now in place of `health`, to `live`",
                "the signal `armour` is no longer read, by `live` and `win`",
                "the signal `health` is no longer read, by `win`",
                "the signal `hp` must be supplied now, to `win`",
                "the atom `strong` is judged otherwise",
            ],
        ),
        # Both are still there.
        ({"= health": "= armour"}, ["the atom `alive` is judged otherwise"]),
    ],
)
def test_signals_that_are_called_otherwise(
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
    done = tltlc("breaking", "live.tltl", "--against", "old", "--format", "json")
    assert [each["title"] for each in json.loads(done.out)["diagnostics"]] == titles
    assert done.status == 1


def test_a_folder_beside(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
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
    # An old folder in the new one is no part of it.
    shutil.copytree("../old", "before")
    assert "before" not in tltlc("breaking", ".", "--against", "before").err


def test_the_formats(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    write(new__leave="signal door: bool\nspec leave = G door\n", old__leave="signal door: bool\nspec leave = F door\n")
    done = tltlc("breaking", "new", "--against", "old", "--format", "github")
    assert done.out.startswith("::error file=new/leave.tltl,line=2,")
    (run,) = json.loads(tltlc("breaking", "new", "--against", "old", "--format", "sarif").out)["runs"]
    assert [each["ruleId"] for each in run["results"]] == ["TLT0753", "TLT0758"]


def test_the_shipped_specs_against_themselves(tmp_path: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(ROOT)
    for folder in ("examples", "stdlib_predicates"):
        shutil.copytree(folder, tmp_path / folder, ignore=shutil.ignore_patterns("*.csv"))
    done = tltlc("breaking", "examples", "stdlib_predicates", "--against", tmp_path)
    assert (done.status, done.out) == (0, "")
    assert done.err.endswith("0 breaking, 0 changed, 0 compatible\n")


@pytest.mark.parametrize(
    ("library", "old", "new", "found"),
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
def test_a_library_that_has_changed(
    library: str,
    old: str,
    new: str,
    found: list[str] | None,
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    before = (ROOT / f"stdlib_predicates/{library}.tltl").read_text(encoding="utf-8")
    after = before.replace(old, new)
    assert after != before
    if found is None:
        after, found = after.replace("= level_size", "= size"), ["error TLT0756"]
    write(old__mine=before, mine=after)
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == found


def test_what_a_library_says_of_all_specs(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    base = "signal a: bool\nsignal b: bool\nsignal c: bool\nexclusive a, c\n"
    plain = "import base\nlet d = a and b\n"

    def said(old: str, new: str) -> list[tuple[str, str]]:
        write(base=base, old__base=base, old__mine=old, mine=new)
        done = tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")
        return [(each["severity"], each["title"]) for each in json.loads(done.out)["diagnostics"]]

    ruled = f"clock 20 Hz\n{plain}exclusive a, b\n"
    assert said(plain, ruled) == [
        ("error", "`a` and `b` are exclusive now"),
        ("error", "specs are sampled every 0.05 s now, and were sampled by no clock"),
    ]
    assert said(ruled, plain) == [
        ("warning", "`a` and `b` are no longer exclusive"),
        ("error", "specs are sampled by no clock now, and were sampled every 0.05 s"),
    ]
    assert said(ruled, ruled.replace("a, b", "b, a").replace("20 Hz", "50 ms")) == []
    # What a wider group says already is no news.
    wide = f"{plain}exclusive a, b, c\n"
    narrow = wide.replace("a, b, c", "a, b")
    assert said(narrow, wide) == [("error", "`a`, `b` and `c` are exclusive now")]
    assert said(wide, narrow) == [("warning", "`a`, `b` and `c` are no longer exclusive")]
    assert said(wide, f"{narrow}exclusive b, c\nexclusive c, a\n") == []
    # So it is in specs.
    spec = "spec s = F (a | b | c)\n"
    assert said(wide + spec, narrow + spec) == [("warning", "`a`, `b` and `c` are no longer exclusive in `s`")]
    assert said(narrow + spec, wide + spec) == [("error", "`a`, `b` and `c` are exclusive in `s` now")]
    # Of what is imported, the file that declares it tells.
    assert said(plain, "let d = true\n") == [("error", f"the signal `{name}` is gone") for name in "abc"]
    Path("old/mine.tltl").unlink()
    assert tltlc("breaking", "mine.tltl", "--against", "old").err.endswith("0 breaking, 0 changed, 0 compatible\n")


def test_a_library_offers_what_it_imports(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    own = "signal noise: ratio\nparam most: ratio = 20 %\npredicate calm in [-1, 1] = clamp(most - noise, -1, 1)\n"
    write(old__mine=f"import base\n{own}", old__base="signal far: length in [0 m, 9 m]\nlet near = far < 3 m\n")
    # Declarations that move into a file that is imported are still there.
    write(mine="import base\nimport moved\n", moved=own, base=Path("old/base.tltl").read_text(encoding="utf-8"))
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == []
    write(mine=own)
    assert codes(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json")) == ["error TLT0759"] * 2


def test_signals_that_a_predicate_reads_now(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    signals = "signal a: bool\nsignal b: bool\nsignal c: bool\n"
    write(old__mine=f"{signals}predicate p = 2 * a - 1\n", mine=f"{signals}predicate p = 2 * min(a, b, c) - 1\n")
    (reads, _) = json.loads(tltlc("breaking", "mine.tltl", "--against", "old", "--format", "json").out)["diagnostics"]
    assert reads["title"] == "the predicate `p` reads `b` and `c` now"
    assert reads["help"] == "have the game supply them wherever the predicate is used"


@pytest.mark.parametrize("arguments", [["-", "--against", "x"], ["a.tltl:b", "--against", "x"], ["a.tltl"]])
def test_wrong_usage(arguments: list[str], tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    assert tltlc("breaking", *arguments).status == 2


def test_nothing_heavy_is_loaded(tmp_path: Path) -> None:
    (tmp_path / "old").mkdir()
    shutil.copy(EXAMPLE, tmp_path / "old")
    loaded("check", EXAMPLE, folder=tmp_path)
    assert not loaded("diff", EXAMPLE, EXAMPLE, folder=tmp_path) & HEAVY
    assert not loaded("breaking", EXAMPLE, "--against", "old", folder=tmp_path) & HEAVY
