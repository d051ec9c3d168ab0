"""The files as they were: in a git revision, or in another folder."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.files import is_dir, is_file, reading_error
from tltlc.io.temporary import temporary_folder
from tltlc.tools.diff import git

if TYPE_CHECKING:
    from collections.abc import Iterable

SOURCE_ENDINGS: Final = (".tltl", ".fspa.json")
_PROJECT: Final = "tltl.toml"


@record
class Tree:
    """Files of old below ``root``, beside those of now below ``here``; messages call ``root/x`` ``{shown}x``."""

    root: Path
    here: Path
    shown: str
    is_revision: bool

    def at(self, path: str) -> str | None:
        """Where the old file, or folder, of a path of now is; None where there is none.

        In a folder it lies at the same place or higher: ``OLD/specs/x.tltl`` or ``OLD/x.tltl`` for ``specs/x.tltl``.
        Raises TltlError, TLT0001, where the system does not tell whether it is there.
        """
        inside = _inside(path, self.here)
        if inside is None and self.is_revision:
            return None
        parts = inside.parts if inside is not None else Path(path).absolute().parts[1:]
        is_there = is_dir if is_dir(path) else is_file
        candidates = (self.root.joinpath(*parts[first:]) for first in range(1 if self.is_revision else len(parts) + 1))
        return next((str(each) for each in candidates if _is_told(each) and is_there(each)), None)

    def libraries(self, folders: Iterable[Path]) -> tuple[Path, ...]:
        """Folders of libraries as they were; where they were not, as they are."""
        return tuple(Path(self.at(str(folder)) or folder) for folder in folders)

    def holds(self, path: Path) -> bool:
        """Whether a path lies in the tree itself."""
        return _inside(str(path), self.root) is not None

    def placed(self, found: Iterable[Diagnostic], path: str, before: str | None) -> tuple[Diagnostic, ...]:
        """Messages that point at files of old, at the same files of now: services know no others.

        ``before`` is the old file of ``path``.
        """
        return tuple(
            replace(each, labels=tuple(self._placed(label, path, before) for label in each.labels)) for each in found
        )

    def _placed(self, label: Label, path: str, before: str | None) -> Label:
        name = label.source.name
        if not name.startswith(f"{self.root}{os.sep}"):
            return label
        now = path if name == before else os.path.relpath(self.here / Path(name).relative_to(self.root))
        where = f"{name}:{label.source.position(label.span.start)[0]}"
        message = f"{label.message} ({where})" if label.message else f"in {where}"
        if not is_file(now):
            return Label(SourceFile(now, label.source.text), label.span, message)
        return Label(SourceFile(now, ""), Span(0, 0), message)

    def renamed(self, found: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
        """Messages on files of old, with the names that those have for their readers."""
        before = f"{self.root}{os.sep}"

        def text(of: str) -> str:
            return of.replace(before, self.shown)

        def label(of: Label) -> Label:
            return replace(of, source=SourceFile(text(of.source.name), of.source.text), message=text(of.message))

        return tuple(
            replace(
                each,
                title=text(each.title),
                labels=tuple(map(label, each.labels)),
                help=each.help and text(each.help),
            )
            for each in found
        )


@contextmanager
def earlier(against: str, paths: Collection[str]) -> Iterator[Tree]:
    """The tree in which the old files of ``paths`` are: the folder of that name, or else a git revision.

    That revision is one of the repository in which the first path lies; its specs, artefacts and project files are
    put into a folder that is gone at the end.

    Errors: TLT0751 neither a folder nor a revision, TLT0730 git is not installed, TLT0005 no temporary folder.
    """
    if is_dir(against):
        yield Tree(Path(against), Path.cwd(), os.path.join(against, ""), is_revision=False)  # noqa: PTH118 (with a slash)
        return
    repository, commit = _revision(against, _folder(next(iter(paths))))
    named = {_inside_of(repository, path) for path in paths}

    def is_wanted(path: str) -> bool:
        return path.endswith(SOURCE_ENDINGS) or path.rpartition("/")[2] == _PROJECT or path in named

    with temporary_folder() as root:
        git.write_out(repository, commit, against, is_wanted, root)
        yield Tree(root, repository, f"{against}:", is_revision=True)


def _revision(name: str, folder: Path) -> tuple[Path, str]:
    """The repository of a folder, and the commit of a revision in it; error TLT0751 where there is none."""
    repository = git.repository(folder)
    if repository is not None:
        try:
            return repository, git.commit(repository, name)
        except TltlError:
            if not is_file(name):
                raise
    if is_file(name):
        raise git.no_version(
            f"`{name}` is a file, and neither a folder nor a revision", "name the folder in which it lies"
        )
    title = f"there is no folder `{name}`, and `{folder}` lies in no git repository in which it could be a revision"
    raise git.no_version(title, "name a folder that is there, or a file of the repository")


def _is_told(path: Path) -> bool:
    """True; raises TltlError, TLT0001, where we may not even know if there is something at a path."""
    try:
        os.stat(path)  # noqa: PTH116
    except PermissionError as error:
        raise reading_error(str(path), error) from None
    except (OSError, ValueError):
        pass
    return True


def _inside_of(repository: Path, path: str) -> str:
    """A path, relative to the repository, as git has it; error TLT0751 where it lies outside."""
    inside = _inside(path, repository)
    if inside is None:
        title = f"`{path}` does not lie in the repository `{repository}`"
        raise TltlError([Diagnostic("TLT0751", title, help="name files of one repository in one run")])
    return inside.as_posix()


def _inside(path: str, folder: Path) -> Path | None:
    """A path, relative to a folder; None if it lies outside.

    A link to a file stands for itself: in another revision it may lead elsewhere.  A link from outside stands for what
    it leads to, and so does a link to a folder, which revisions are read without.
    """
    parent, name = os.path.split(os.path.abspath(path))  # noqa: PTH100
    places = [os.path.realpath(path)]
    if not is_dir(path):
        places.insert(0, os.path.join(os.path.realpath(parent), name))  # noqa: PTH118
    top = os.path.realpath(folder)
    return next((Path(place).relative_to(top) for place in places if Path(place).is_relative_to(top)), None)


def _folder(path: str) -> Path:
    """The nearest folder above a path, or at it, that is there."""
    place = Path(os.path.realpath(path))
    return next(each for each in (place, *place.parents) if each.is_dir())
