"""What a git repository held at a revision.

Nothing is written into the repository, save objects that a partial clone lacks: git fetches them where it is told to.
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

_OF_HOOKS: Final = {"GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX", "GIT_COMMON_DIR"}
_PLAIN_FILES: Final = (b"100644", b"100755")
_LINK: Final = b"120000"
_NO_TARGET: Final = (b"symlink", b"dangling", b"loop", b"notdir")
"""What git prints for a path that leads nowhere, or out of the repository; a size and a text of that size follow."""

_HASH: Final = re.compile("[0-9a-f]{40,64}")
_MOST_NAMES: Final = 1000
_LONGEST_NAME: Final = 200
"""Branches and tags that a misspelt revision is compared with: so many, and so many characters each."""


@record
class _File:
    """A file of a revision: the name of its content in git, and its path.  A link's content is where it leads."""

    name: str
    path: str
    is_link: bool = False


def repository(folder: Path) -> Path | None:
    """The top folder of the repository that a folder lies in; None where it lies in none.

    Raises TltlError: TLT0751, git cannot use the repository, or it holds no files of now; TLT0730, there is no git.
    """
    done = _git(folder, "rev-parse", "--show-toplevel")
    if done.returncode == 0:
        return Path(os.fsdecode(done.stdout.removesuffix(b"\n")))
    if b"safe.directory" in done.stderr:
        title = f"git does not look into the repository of `{folder}`, which belongs to another user"
        raise no_version(title, "allow it: `git config --global --add safe.directory FOLDER`")
    if b"work tree" in done.stderr:
        raise no_version(f"`{folder}` belongs to git itself, and holds no files of now", "go into a clone with files")
    marked = next((place for place in (folder, *folder.parents) if exists(place / ".git")), None)
    if marked is not None:
        title = f"git cannot use the repository of `{marked}`"
        raise no_version(title, f"check that you may read `{marked / '.git'}`: `git status` there tells what is wrong")
    return None


def commit(repository: Path, revision: str) -> str:
    """The commit that a revision names; error TLT0751 where it names none."""
    name = _object(repository, f"{revision}^{{commit}}")
    if name is not None:
        return name
    if _object(repository, revision) is not None:
        raise no_version(f"`{revision}` names something in git that is no commit", "name the commit that holds it")
    raise no_version(f"there is no revision and no folder `{revision}`", _way_out(repository, revision))


def _object(repository: Path, name: str) -> str | None:
    """The hash of what a name stands for in git; None where it stands for nothing, like ``^HEAD``."""
    done = (_run(repository, "rev-parse", "--verify", "--quiet", "--end-of-options", name) or b"").decode().strip()
    return done if _HASH.fullmatch(done) else None


def write_out(repository: Path, commit: str, revision: str, is_wanted: Callable[[str], bool], folder: Path) -> None:
    """Write the files of a commit that are wanted into a folder, each at its path.

    A link to a file becomes a copy of that file as it was in the commit.  Links to folders, to nothing, and out of the
    repository are left out.  ``revision`` is what messages call the commit.

    Raises:
        TltlError: TLT0751, git does not give the files; TLT0764, they are more than :data:`tltlc.io.limits.REVISION`
        and
            the rows below it allow; TLT0009, a path cannot be a file below the folder; TLT0005, the system refuses to
            write.
    """
    listed = _wanted(_files(repository, commit, revision), is_wanted, revision)
    files = [file for file in listed if not file.is_link]
    files += _followed(repository, commit, [file.path for file in listed if file.is_link])
    _check_sizes(repository, files, revision)
    unpack(folder, _contents(repository, files, revision), _archive(revision))


def _archive(revision: str) -> Archive:
    return Archive(
        f"the revision `{revision}`",
        damaged="use another revision: `git fsck` names the damaged tree, which `git add` does not make",
        elsewhere="run this on Linux, or name a revision in which the file has another name",
    )


def _wanted(files: Iterable[_File], is_wanted: Callable[[str], bool], revision: str) -> list[_File]:
    """The files that are wanted; errors: TLT0764, they are too many; TLT0009, a path is too long."""
    wanted: list[_File] = []
    for file in files:
        if is_wanted(file.path):
            check_extent(file.path, _archive(revision))
            wanted.append(file)
        if len(wanted) > (REVISION.values or 0):
            raise _too_large(revision, f"more than {REVISION.values:,} specs and artefacts")
    return wanted


def _files(repository: Path, commit: str, revision: str) -> Iterator[_File]:
    """The plain files and the links of a commit, as git lists them; the caller may stop before the end.

    Raises TltlError: TLT0751, git cannot list them all; TLT0764, they are too many.
    """
    from subprocess import DEVNULL, PIPE, Popen

    # With folders (-t): nested trees without any file would keep git busy without a word.
    command = ["git", "-C", str(repository), "ls-tree", "-r", "-t", "-z", "--full-tree", commit]
    with Popen(command, stdin=DEVNULL, stdout=PIPE, stderr=DEVNULL, env=_environment()) as git:
        assert git.stdout is not None
        try:
            yield from _listed(git.stdout, revision)
        except BaseException:
            git.kill()
            raise
        if git.wait() != 0:
            raise_if_interrupted(git.returncode)
            raise no_version(f"git cannot list the files of the revision `{revision}`", "repair it: `git fsck`")


def _listed(stream: IO[bytes], revision: str) -> Iterator[_File]:
    """The plain files and the links in what ``git ls-tree -r -t -z`` prints; error TLT0764 if that is too much."""
    for line in _lines(stream, revision):
        about, _, path = line.partition(b"\t")
        mode, kind, name = about.split()
        if (mode in _PLAIN_FILES or mode == _LINK) and kind == b"blob":
            yield _File(name.decode(), os.fsdecode(path), is_link=mode == _LINK)


def _lines(stream: IO[bytes], revision: str) -> Iterator[bytes]:
    """The texts in front of each NUL, in time that grows with their bytes; error TLT0764 if they are too many."""
    size = count = 0
    begun: list[bytes] = []
    while block := stream.read(1 << 16):
        size += len(block)
        if size > REVISION_PATHS.size:
            raise _too_large(revision, f"paths of more than {REVISION_PATHS.size >> 20} MiB")
        first, *others = block.split(b"\0")
        begun.append(first)
        if sum(map(len, begun)) > REVISION_PATH.size:
            raise _too_large(revision, f"a path of more than {REVISION_PATH.size >> 20} MiB")
        if others:
            lines = (b"".join(begun), *others[:-1])
            begun = [others[-1]]
            count += len(lines)
            if count > (REVISION_PATHS.values or 0):
                raise _too_large(revision, f"more than {REVISION_PATHS.values:,} paths")
            yield from lines


def _followed(repository: Path, commit: str, links: Iterable[str]) -> Iterator[_File]:
    """The files that links of a commit lead to within it, each at the path of its link."""
    # git reads one path a line.
    named = [path for path in links if "\n" not in path]
    if not named:
        return
    given = b"".join(os.fsencode(f"{commit}:{path}\n") for path in named)
    printed = _run(
        repository, "cat-file", "--batch-check=%(objecttype) %(objectname)", "--follow-symlinks", given=given
    )
    stream = io.BytesIO(printed or b"")
    for path in named:
        kind, _, name = stream.readline().removesuffix(b"\n").partition(b" ")
        if kind == b"blob":
            yield _File(name.decode(), path)
        elif kind in _NO_TARGET:
            stream.read(int(name) + 1)


def _check_sizes(repository: Path, files: Sequence[_File], revision: str) -> None:
    """Error TLT0751 where git lacks the content of a file, TLT0764 where they are too large together."""
    given = "".join(f"{file.name}\n" for file in files).encode()
    lines = (_run(repository, "cat-file", "--batch-check=%(objectsize)", given=given) or b"").splitlines()
    for file, line in zip(files, lines, strict=False):
        if not line.isdigit():
            raise _not_given(file, revision)
    if len(lines) < len(files):
        raise _not_given(files[len(lines)], revision)
    if sum(map(int, lines)) > REVISION.size:
        raise _too_large(revision, f"more than {REVISION.size >> 20} MiB of specs and artefacts")


def _contents(repository: Path, files: Sequence[_File], revision: str) -> Iterator[tuple[str, bytes]]:
    """The path and the content of each file; error TLT0751 where git does not give one."""
    given = "".join(f"{file.name}\n" for file in files).encode()
    contents = _run(repository, "cat-file", "--batch", given=given) or b""
    start = 0
    for file in files:
        end = contents.find(b"\n", start)
        header = contents[start:end].split()
        if end < 0 or len(header) != 3:
            raise _not_given(file, revision)
        size = int(header[2])
        yield file.path, contents[end + 1 : end + 1 + size]
        start = end + size + 2


def _not_given(file: _File, revision: str) -> TltlError:
    title = f"git does not give `{file.path}` of the revision `{revision}`"
    return no_version(title, "fetch it, or take it from another clone: `git fsck` tells if it is missing or damaged")


def _run(folder: Path, *arguments: str, given: bytes = b"") -> bytes | None:
    """What git prints, None where it fails; errors as of :func:`_git`."""
    done = _git(folder, *arguments, given=given)
    return done.stdout if done.returncode == 0 else None


def _git(folder: Path, *arguments: str, given: bytes = b"") -> CompletedProcess[bytes]:
    """The end of a git command in a folder.

    Raises:
        TltlError: TLT0730, there is no git.
        KeyboardInterrupt: a signal has ended git.
    """
    from subprocess import run

    command = ["git", "-C", str(folder), *arguments]
    try:
        done = run(command, input=given, capture_output=True, env=_environment(), check=False)
    except FileNotFoundError:
        title = "comparing with a revision needs `git`, which is not installed"
        way_out = "install git, or name a folder that holds the old files: `--against DIR`"
        raise TltlError([Diagnostic("TLT0730", title, help=way_out)]) from None
    raise_if_interrupted(done.returncode)
    return done


def _environment() -> dict[str, str]:
    """The environment for git: without the names by which a hook's git points at the repository of the hook."""
    return {name: value for name, value in os.environ.items() if name not in _OF_HOOKS} | {"LC_ALL": "C"}


def _way_out(repository: Path, revision: str) -> str:
    from difflib import get_close_matches

    listed = _run(repository, "for-each-ref", f"--count={_MOST_NAMES}", "--format=%(refname:short)") or b""
    known = [name for name in listed.decode(errors="replace").split() if len(name) <= _LONGEST_NAME]
    close = get_close_matches(revision, known, n=1)
    if close:
        return f"did you mean `{close[0]}`?"
    if (_run(repository, "rev-parse", "--is-shallow-repository") or b"").strip() == b"true":
        return "this clone is shallow: fetch the revision, e.g. `git fetch --unshallow`"
    return "`git log` and `git tag` list revisions"


def _too_large(revision: str, what: str) -> TltlError:
    help_ = "take out the part to compare, and name its folder: `--against DIR`"
    return TltlError([Diagnostic("TLT0764", f"the revision `{revision}` holds {what}", help=help_)])


def no_version(title: str, way_out: str) -> TltlError:
    """TLT0751: there are no files as they were."""
    return TltlError([Diagnostic("TLT0751", title, help=way_out)])
