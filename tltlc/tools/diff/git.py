"""Read files from a git repository at a revision.

Nothing is written into the repository, with one exception: in a partial clone, git may fetch the
objects that are missing.
"""

from __future__ import annotations

import io
import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.archive import Archive, check_extent, unpack
from tltlc.io.child_interrupts import raise_if_interrupted
from tltlc.io.files import exists
from tltlc.io.limits import REVISION, REVISION_PATH, REVISION_PATHS

if TYPE_CHECKING:
    from subprocess import CompletedProcess

_HOOK_VARIABLES: Final = {"GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX", "GIT_COMMON_DIR"}
_PLAIN_FILES: Final = (b"100644", b"100755")
_LINK: Final = b"120000"
_NO_TARGET: Final = (b"symlink", b"dangling", b"loop", b"notdir")
"""What ``git cat-file`` prints for a link that leads nowhere or out of the repository.

It then prints a size in bytes, and a text of that size.
"""

_HASH: Final = re.compile("[0-9a-f]{40,64}")
_MOST_NAMES: Final = 1000
"""A misspelt revision is compared with at most this many branches and tags."""
_LONGEST_NAME: Final = 200
"""Branches and tags with more characters are left out of this comparison."""


@record
class _File:
    """A file of a revision: the git hash of its content (``name``), and its path.

    The content of a symbolic link is the path of its target.
    """

    name: str
    path: str
    is_link: bool = False


def repository(folder: Path) -> Path | None:
    """Return the top folder of the git repository that contains ``folder``; None if there is no repository.

    Raises:
        TltlError: TLT0751, git cannot use the repository, or it has no working files;
            TLT0730, git is not installed.
    """
    completed = _git(folder, "rev-parse", "--show-toplevel")
    if completed.returncode == 0:
        return Path(os.fsdecode(completed.stdout.removesuffix(b"\n")))
    if b"safe.directory" in completed.stderr:
        title = f"git refuses to read the repository of `{folder}`, because it belongs to another user"
        help_ = "allow it: `git config --global --add safe.directory FOLDER`, where FOLDER is its top folder"
        raise no_version(title, help_)
    if b"work tree" in completed.stderr:
        title = f"`{folder}` belongs to git itself, and contains no checked-out files"
        raise no_version(title, "use a clone that has checked-out files")
    git_folder = next((place for place in (folder, *folder.parents) if exists(place / ".git")), None)
    if git_folder is not None:
        title = f"git cannot use the repository of `{git_folder}`"
        raise no_version(
            title,
            f"check that you may read `{git_folder / '.git'}`; `git -C {git_folder} status` says what is wrong",
        )
    return None


def commit(repository: Path, revision: str) -> str:
    """Return the hash of the commit that a revision such as ``HEAD~2`` names.

    Error TLT0751 if there is no such commit.
    """
    name = _object_hash(repository, f"{revision}^{{commit}}")
    if name is not None:
        return name
    if _object_hash(repository, revision) is not None:
        raise no_version(f"`{revision}` exists in git, but is not a commit", "name the commit that contains it")
    raise no_version(f"there is no revision and no folder `{revision}`", _revision_help(repository, revision))


def _object_hash(repository: Path, name: str) -> str | None:
    """Return the hash of the git object with this name; None if no object has it.

    A name such as ``^HEAD``, which does not stand for a single object, also gives None.
    """
    output = (_run(repository, "rev-parse", "--verify", "--quiet", "--end-of-options", name) or b"").decode().strip()
    return output if _HASH.fullmatch(output) else None


def write_out(repository: Path, commit: str, revision: str, is_wanted: Callable[[str], bool], folder: Path) -> None:
    """Write files of a commit into a folder, each at its path in the repository.

    ``is_wanted`` says, given the path of a file, whether to write it. A link to a file becomes a copy
    of that file as it was in the commit. Links to folders, to nothing and out of the repository are
    left out. Messages call the commit ``revision``.

    Raises:
        TltlError: TLT0751, git does not provide the files; TLT0764, they exceed
            a limit on revisions in :mod:`tltlc.io.limits`; TLT0009, a path cannot be
            a file below the folder; TLT0005, the system refuses to write.
    """
    wanted_files = _wanted_files(_files(repository, commit, revision), is_wanted, revision)
    files = [file for file in wanted_files if not file.is_link]
    files += _link_targets(repository, commit, [file.path for file in wanted_files if file.is_link])
    _check_sizes(repository, files, revision)
    unpack(folder, _contents(repository, files, revision), _archive(revision))


def _archive(revision: str) -> Archive:
    return Archive(
        f"the revision `{revision}`",
        damaged_help="use another revision: `git fsck` names the damaged tree (`git add` never makes such a tree)",
        elsewhere_help="run this on Linux, or name a revision in which the file has another name",
    )


def _wanted_files(files: Iterable[_File], is_wanted: Callable[[str], bool], revision: str) -> list[_File]:
    """Return the files for whose path ``is_wanted`` returns true.

    Errors: TLT0764 if there are too many of these files, TLT0009 if the path of one is too long.
    """
    wanted: list[_File] = []
    for file in files:
        if is_wanted(file.path):
            check_extent(file.path, _archive(revision))
            wanted.append(file)
        if len(wanted) > (REVISION.values or 0):
            raise _too_large(revision, f"more than {REVISION.values:,} specs and artefacts")
    return wanted


def _files(repository: Path, commit: str, revision: str) -> Iterator[_File]:
    """Yield the plain files and links of a commit, as git lists them.

    The caller may stop before the end.

    Raises:
        TltlError: TLT0751, git cannot list all files; TLT0764, there are too many.
    """
    from subprocess import DEVNULL, PIPE, Popen

    # List folders, too (-t). Otherwise, nested trees without files would keep git busy without output.
    command = ["git", "-C", str(repository), "ls-tree", "-r", "-t", "-z", "--full-tree", commit]
    with Popen(command, stdin=DEVNULL, stdout=PIPE, stderr=DEVNULL, env=_environment()) as git:
        assert git.stdout is not None
        try:
            yield from _parse_listing(git.stdout, revision)
        except BaseException:
            git.kill()
            raise
        if git.wait() != 0:
            raise_if_interrupted(git.returncode)
            raise no_version(
                f"git cannot list the files of the revision `{revision}`", "check the repository: `git fsck`"
            )


def _parse_listing(stream: IO[bytes], revision: str) -> Iterator[_File]:
    """Yield the plain files and links in the output of ``git ls-tree -r -t -z``.

    Error TLT0764 if the output is too long.
    """
    for line in _lines(stream, revision):
        attributes, _, path = line.partition(b"\t")
        mode, kind, name = attributes.split()
        if (mode in _PLAIN_FILES or mode == _LINK) and kind == b"blob":
            yield _File(name.decode(), os.fsdecode(path), is_link=mode == _LINK)


def _lines(stream: IO[bytes], revision: str) -> Iterator[bytes]:
    """Yield the lines of a stream in which each line ends with NUL, without the NUL.

    Takes linear time. Error TLT0764 if there are too many lines, or if they are too long.
    """
    size = count = 0
    partial: list[bytes] = []
    while block := stream.read(1 << 16):
        size += len(block)
        if size > REVISION_PATHS.size:
            raise _too_large(revision, f"paths of more than {REVISION_PATHS.size >> 20} MiB")
        first, *rest = block.split(b"\0")
        partial.append(first)
        if sum(map(len, partial)) > REVISION_PATH.size:
            raise _too_large(revision, f"a path of more than {REVISION_PATH.size >> 20} MiB")
        if rest:
            lines = (b"".join(partial), *rest[:-1])
            partial = [rest[-1]]
            count += len(lines)
            if count > (REVISION_PATHS.values or 0):
                raise _too_large(revision, f"more than {REVISION_PATHS.values:,} paths")
            yield from lines


def _link_targets(repository: Path, commit: str, links: Iterable[str]) -> Iterator[_File]:
    """Yield a file for each link: with the path of the link, and the content of the file to which it leads.

    ``links`` are the paths of the links. Links that lead to no file in the commit are left out.
    """
    # git reads one path from each line, so a path with a line feed cannot be looked up.
    paths = [path for path in links if "\n" not in path]
    if not paths:
        return
    request = b"".join(os.fsencode(f"{commit}:{path}\n") for path in paths)
    output = _run(
        repository, "cat-file", "--batch-check=%(objecttype) %(objectname)", "--follow-symlinks", stdin=request
    )
    stream = io.BytesIO(output or b"")
    for path in paths:
        kind, _, name = stream.readline().removesuffix(b"\n").partition(b" ")
        if kind == b"blob":
            yield _File(name.decode(), path)
        elif kind in _NO_TARGET:
            stream.read(int(name) + 1)


def _check_sizes(repository: Path, files: Sequence[_File], revision: str) -> None:
    """Check that the repository has the contents of the files, and that they are not too large.

    Errors: TLT0751 if git lacks the content of a file, TLT0764 if the total size is too large.
    """
    request = "".join(f"{file.name}\n" for file in files).encode()
    lines = (_run(repository, "cat-file", "--batch-check=%(objectsize)", stdin=request) or b"").splitlines()
    for file, line in zip(files, lines, strict=False):
        if not line.isdigit():
            raise _missing_content(file, revision)
    if len(lines) < len(files):
        raise _missing_content(files[len(lines)], revision)
    if sum(map(int, lines)) > REVISION.size:
        raise _too_large(revision, f"more than {REVISION.size >> 20} MiB of specs and artefacts")


def _contents(repository: Path, files: Sequence[_File], revision: str) -> Iterator[tuple[str, bytes]]:
    """Yield the path and the content of each file. Error TLT0751 if git does not have a content."""
    request = "".join(f"{file.name}\n" for file in files).encode()
    contents = _run(repository, "cat-file", "--batch", stdin=request) or b""
    start = 0
    for file in files:
        end = contents.find(b"\n", start)
        header = contents[start:end].split()
        if end < 0 or len(header) != 3:
            raise _missing_content(file, revision)
        size = int(header[2])
        yield file.path, contents[end + 1 : end + 1 + size]
        start = end + size + 2


def _missing_content(file: _File, revision: str) -> TltlError:
    title = f"git cannot provide `{file.path}` of the revision `{revision}`"
    help_ = "fetch it, or take it from another clone: `git fsck` says whether it is missing or damaged"
    return no_version(title, help_)


def _run(folder: Path, *arguments: str, stdin: bytes = b"") -> bytes | None:
    """Return the output of a git command, or None if git exits with an error.

    Error TLT0730 if git is not installed.
    """
    completed = _git(folder, *arguments, stdin=stdin)
    return completed.stdout if completed.returncode == 0 else None


def _git(folder: Path, *arguments: str, stdin: bytes = b"") -> CompletedProcess[bytes]:
    """Run a git command in a folder and return the completed process.

    Raises:
        TltlError: TLT0730, git is not installed.
        KeyboardInterrupt: a signal ended git.
    """
    from subprocess import run

    command = ["git", "-C", str(folder), *arguments]
    try:
        completed = run(command, input=stdin, capture_output=True, env=_environment(), check=False)
    except FileNotFoundError:
        title = "comparing with a revision needs `git`, which is not installed"
        help_ = "install git, or name a folder that contains the old files: `--against DIR`"
        raise TltlError([Diagnostic("TLT0730", title, help=help_)]) from None
    raise_if_interrupted(completed.returncode)
    return completed


def _environment() -> dict[str, str]:
    """Return the environment variables for a git process.

    They are those of this process, with two changes: git writes messages in English, and the
    variables with which a git hook names its own repository are left out.
    """
    return {name: value for name, value in os.environ.items() if name not in _HOOK_VARIABLES} | {"LC_ALL": "C"}


def _revision_help(repository: Path, revision: str) -> str:
    """Return a help text for a revision that does not exist: ``did you mean `main`?``."""
    from difflib import get_close_matches

    output = _run(repository, "for-each-ref", f"--count={_MOST_NAMES}", "--format=%(refname:short)") or b""
    names = [name for name in output.decode(errors="replace").split() if len(name) <= _LONGEST_NAME]
    matches = get_close_matches(revision, names, n=1)
    if matches:
        return f"did you mean `{matches[0]}`?"
    if (_run(repository, "rev-parse", "--is-shallow-repository") or b"").strip() == b"true":
        return "this clone is shallow: fetch the revision, e.g. `git fetch --unshallow`"
    return "`git log` and `git tag` list revisions"


def _too_large(revision: str, contents: str) -> TltlError:
    help_ = "check out the part to compare, and name its folder: `--against DIR`"
    return TltlError([Diagnostic("TLT0764", f"the revision `{revision}` contains {contents}", help=help_)])


def no_version(title: str, help_: str) -> TltlError:
    """Return the error TLT0751, that no earlier version is available, with this title and help."""
    return TltlError([Diagnostic("TLT0751", title, help=help_)])
