"""The guide to builds: its script fails if something is wrong, and its other commands exist."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

import pytest

from tests.docs.blocks import DOCS, blocks
from tests.docs.sessions import Shell

PAGE = DOCS / "guides" / "builds.md"
BLOCKS = blocks(PAGE)
SPEC = """import stealth
entity vault, exit

spec heist {
    limit 400 steps
    reach near(vault) then near(exit)
    keep alive
}

test "both" for heist {
    step near(vault), alive
    step near(exit), alive
    expect holding
}
"""

pytestmark = [
    pytest.mark.skipif(os.name == "nt", reason="the page speaks to a POSIX shell"),
    pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed"),
]


@pytest.fixture
def project(tmp_path: Path) -> Shell:
    """A git repository with a valid spec on the branch `main`."""
    shell = Shell(tmp_path)
    (tmp_path / "specs").mkdir()
    (tmp_path / "specs" / "heist.tltl").write_text(SPEC)
    script = next(block.text for block in BLOCKS if block.text.startswith("# check_specs.sh\n"))
    (tmp_path / "check_specs.sh").write_text(script)
    author = "-c user.name=A -c user.email=a@example.org -c commit.gpgsign=false"
    shell.run(
        f"git init -q . && git symbolic-ref HEAD refs/heads/main && git add specs && git {author} commit -q -m one"
    )
    return shell


def status(shell: Shell, command: str) -> tuple[int, str]:
    printed = shell.run(command)
    return int(shell.run("echo $?")), printed


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("", "", "0 breaking, 0 changed, 0 compatible"),
        ("    keep", "  keep", "1 file would change"),
        ("near(exit)\n", "neer(exit)\n", "error[TLT0201]"),
        ("entity vault, exit", "entity vault, exit, alley", "warning[TLT0421]"),
        ("expect holding", "expect pending", "error[TLT0640]"),
        ("400 steps", "300 steps", "error[TLT0758]"),
    ],
)
def test_the_script_fails_if_something_is_wrong(project: Shell, before: str, after: str, message: str) -> None:
    path = project.folder / "specs" / "heist.tltl"
    path.write_text(SPEC.replace(before, after, 1))
    exit_status, printed = status(project, "sh check_specs.sh")
    assert (exit_status, message in printed) == (int(bool(before)), True), printed


def test_the_commands_of_the_workflow_run(project: Shell) -> None:
    workflow = next(block.text for block in BLOCKS if block.text.startswith("# .github"))
    commands = re.findall(r"- run: (tltlc .*)", workflow)
    assert len(commands) == 5
    for command in commands:
        here = command.replace("origin/${{ github.base_ref }}", "main").replace('"$GITHUB_STEP_SUMMARY"', "summary.md")
        assert status(project, here)[0] == 0, command
    assert "Reach near(vault), then near(exit)" in (project.folder / "summary.md").read_text()


def test_the_commands_of_the_hooks_run(project: Shell) -> None:
    hooks = next(block.text for block in BLOCKS if block.text.startswith("repos:"))
    entries = re.findall(r"entry: ([^,]+),", hooks)
    assert len(entries) == 2
    for entry in entries:
        assert status(project, f"{entry} specs/heist.tltl")[0] == 0


def test_recorded_play_and_generated_files_are_checked(project: Shell) -> None:
    record, generate = [block.text for block in BLOCKS if block.kind == "sh"][1:]
    folder = project.folder
    (folder / "specs" / "first_level.tltl").write_text(SPEC)
    (folder / "traces").mkdir()
    (folder / "traces" / "one.csv").write_text("distance(vault),distance(exit),health\n0,9,1\n9,0,1\n")
    assert status(project, record)[0] == 0
    (folder / "traces" / "none.csv").write_text("distance(vault),distance(exit),health\n9,0,1\n")
    assert status(project, record)[0] == 1
    commands = generate.replace(",svg", "")
    assert status(project, f"set -e\n{commands.splitlines()[0]}\ngit add generated\n{commands}")[0] == 0
    (folder / "specs" / "first_level.tltl").write_text(SPEC.replace("400", "500"))
    assert status(project, f"set -e\n{commands}")[0] == 1
