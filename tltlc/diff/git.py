"""What a git repository held at a revision; nothing in the repository is changed."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

if TYPE_CHECKING:
    from subprocess import CompletedProcess

_OF_HOOKS: Final = {"GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX", "GIT_COMMON_DIR"}
_PLAIN_FILES: Final = (b"100644", b"100755")


def repository(folder: Path, revision: str) -> Path:
    """The top folder of the repository that a folder lies in; errors TLT0751 and TLT0730."""
    done = _git(folder, "rev-parse", "--show-toplevel")
    if done.returncode == 0:
        return Path(os.fsdecode(done.stdout).rstrip("\n"))
    if b"safe.directory" in done.stderr:
        title = f"git does not look into the repository of `{folder}`, which belongs to another user"
        raise _no_version(title, "allow it: `git config --global --add safe.directory FOLDER`")
    title = f"there is no folder `{revision}`, and this is no git repository in which it could be a revision"
    raise _no_version(title, "name a folder that is there, or go into the repository")


def commit(repository: Path, revision: str) -> str:
    """The commit that a revision names; error TLT0751 where it names none."""
    done = _run(repository, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    if done is None:
        raise _no_version(f"there is no revision and no folder `{revision}`", _way_out(repository, revision))
    return done.decode().strip()


def write_out(repository: Path, commit: str, is_wanted: Callable[[str], bool], folder: Path) -> None:
    """Write the plain files of a commit that are wanted, by their paths, into a folder.

    Links and submodules are left out.  Error TLT0751 where git does not give them.
    """
    files = [(name, path) for name, path in _files(repository, commit) if is_wanted(path)]
    contents = _run(repository, "cat-file", "--batch", given="".join(f"{name}\n" for name, _ in files).encode())
    start = 0
    for _, path in files:
        end = (contents or b"").find(b"\n", start)
        header = (contents or b"")[start:end].split()
        if contents is None or end < 0 or len(header) != 3:
            raise _no_version(f"git does not give `{path}` of that revision", "fetch it: `git fetch`")
        size = int(header[2])
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(contents[end + 1 : end + 1 + size])
        start = end + size + 2


def _files(repository: Path, commit: str) -> Iterator[tuple[str, str]]:
    """The plain files of a commit: the name of the contents, and the path."""
    listed = _run(repository, "ls-tree", "-r", "-z", "--full-tree", commit) or b""
    for line in listed.split(b"\0"):
        about, _, path = line.partition(b"\t")
        mode, _, name = about.partition(b" blob ")
        if mode in _PLAIN_FILES:
            yield name.decode(), os.fsdecode(path)


def _run(folder: Path, *arguments: str, given: bytes = b"") -> bytes | None:
    """What git prints, None where it fails; errors as of :func:`_git`."""
    done = _git(folder, *arguments, given=given)
    return done.stdout if done.returncode == 0 else None


def _git(folder: Path, *arguments: str, given: bytes = b"") -> CompletedProcess[bytes]:
    """What became of a git command in a folder; error TLT0730 where there is no git."""
    from subprocess import run

    # In a hook, git names the repository of the hook by these.
    environment = {name: value for name, value in os.environ.items() if name not in _OF_HOOKS}
    command = ["git", "-C", str(folder), *arguments]
    try:
        return run(command, input=given, capture_output=True, env={**environment, "LC_ALL": "C"}, check=False)
    except FileNotFoundError:
        title = "comparing with a revision needs `git`, which is not installed"
        way_out = "install git, or name a folder that holds the old files: `--against DIR`"
        raise TltlError([Diagnostic("TLT0730", title, help=way_out)]) from None


def _way_out(repository: Path, revision: str) -> str:
    from difflib import get_close_matches

    known = (_run(repository, "for-each-ref", "--format=%(refname:short)") or b"").decode(errors="replace").split()
    close = get_close_matches(revision, known, n=1)
    if close:
        return f"did you mean `{close[0]}`?"
    if (_run(repository, "rev-parse", "--is-shallow-repository") or b"").strip() == b"true":
        return "this clone is shallow: fetch the revision, e.g. `git fetch --unshallow`"
    return "`git log` and `git tag` list revisions"


def _no_version(title: str, way_out: str) -> TltlError:
    return TltlError([Diagnostic("TLT0751", title, help=way_out)])
