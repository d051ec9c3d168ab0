"""Access earlier versions of files, in a git revision or in another folder."""

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
class EarlierTree:
    """A folder ``root`` with earlier versions of the files below the folder ``current_root``.

    In messages, the file ``root/x`` is called ``{prefix}x``, such as ``HEAD:x``. ``is_revision`` is
    true if the files come from a git revision, and false if ``root`` is a folder that the user named.
    """

    root: Path
    current_root: Path
    prefix: str
    is_revision: bool

    def old_path(self, path: str) -> str | None:
        """Return the path of the earlier version of the file or folder at ``path``; None if there is none.

        In a revision, the earlier version has the same path. In a folder, the first parts of the path
        may be missing: the earlier version of ``specs/x.tltl`` is ``OLD/specs/x.tltl`` or
        ``OLD/x.tltl``. Error TLT0001 if permissions hide whether a path exists.
        """
        inside = _relative_path(path, self.current_root)
        if inside is None and self.is_revision:
            return None
        parts = inside.parts if inside is not None else Path(path).absolute().parts[1:]
        is_there = is_dir if is_dir(path) else is_file
        candidates = (self.root.joinpath(*parts[first:]) for first in range(1 if self.is_revision else len(parts) + 1))
        return next(
            (str(candidate) for candidate in candidates if _is_accessible(candidate) and is_there(candidate)), None
        )

    def old_libraries(self, folders: Iterable[Path]) -> tuple[Path, ...]:
        """Return the earlier version of each library folder, or the folder itself if it has no earlier version."""
        return tuple(Path(self.old_path(str(folder)) or folder) for folder in folders)

    def contains(self, path: Path) -> bool:
        """Whether a path is inside the tree."""
        return _relative_path(str(path), self.root) is not None

    def with_current_labels(
        self, diagnostics: Iterable[Diagnostic], path: str, before: str | None
    ) -> tuple[Diagnostic, ...]:
        """Return the diagnostics with labels that point into current files, not into earlier versions.

        Tools that know only the current files need this, such as the review page of a pull request.
        The message of such a label names the place in the earlier version. ``before`` is the path of
        the earlier version of ``path``, or None.
        """
        return tuple(
            replace(
                diagnostic, labels=tuple(self._with_current_file(label, path, before) for label in diagnostic.labels)
            )
            for diagnostic in diagnostics
        )

    def _with_current_file(self, label: Label, path: str, before: str | None) -> Label:
        name = label.source.name
        if not name.startswith(f"{self.root}{os.sep}"):
            return label
        now = path if name == before else os.path.relpath(self.current_root / Path(name).relative_to(self.root))
        where = f"{name}:{label.source.position(label.span.start)[0]}"
        message = f"{label.message} ({where})" if label.message else f"in {where}"
        if not is_file(now):
            return Label(SourceFile(now, label.source.text), label.span, message)
        return Label(SourceFile(now, ""), Span(0, 0), message)

    def with_display_names(self, diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
        """Return the diagnostics, in which each earlier file ``root/x`` is called ``{prefix}x``."""
        root = f"{self.root}{os.sep}"

        def text(original: str) -> str:
            return original.replace(root, self.prefix)

        def label(original: Label) -> Label:
            source = SourceFile(text(original.source.name), original.source.text, original.source.kind)
            return replace(original, source=source, message=text(original.message))

        return tuple(
            replace(
                diagnostic,
                title=text(diagnostic.title),
                labels=tuple(map(label, diagnostic.labels)),
                help=diagnostic.help and text(diagnostic.help),
            )
            for diagnostic in diagnostics
        )


@contextmanager
def earlier_files(against: str, paths: Collection[str]) -> Iterator[EarlierTree]:
    """Yield the tree with the earlier versions of ``paths``.

    ``against`` names a folder or, if there is no such folder, a git revision. The revision is looked
    up in the repository of the first path. Its specs, artefacts (compiled specs) and project files
    are written to a temporary folder, which is removed at the end.

    Errors: TLT0751 if ``against`` is neither a folder nor a revision, TLT0730 if git is not
    installed, TLT0005 if there is no temporary folder.
    """
    if is_dir(against):
        yield EarlierTree(Path(against), Path.cwd(), os.path.join(against, ""), is_revision=False)  # noqa: PTH118 (with a slash)
        return
    repository, commit = _revision(against, _nearest_folder(next(iter(paths))))
    inside_paths = {_path_in_repository(repository, path) for path in paths}

    def is_wanted(path: str) -> bool:
        return path.endswith(SOURCE_ENDINGS) or path.rpartition("/")[2] == _PROJECT or path in inside_paths

    with temporary_folder() as root:
        git.write_out(repository, commit, against, is_wanted, root)
        yield EarlierTree(root, repository, f"{against}:", is_revision=True)


def _revision(name: str, folder: Path) -> tuple[Path, str]:
    """Return the repository of a folder, and the commit of the revision ``name`` in it.

    Error TLT0751 if the folder is in no repository, or if the repository has no such revision.
    """
    repository = git.repository(folder)
    if repository is not None:
        try:
            return repository, git.commit(repository, name)
        except TltlError:
            if not is_file(name):
                raise
    if is_file(name):
        raise git.no_version(f"`{name}` is a file, not a folder or a revision", "name the folder that contains it")
    title = f"there is no folder `{name}`, and it cannot be a revision, because `{folder}` is not in a git repository"
    raise git.no_version(title, "name a folder that exists, or a file in a git repository")


def _is_accessible(path: Path) -> bool:
    """Raise TLT0001 if permissions hide whether a path exists; otherwise return True."""
    try:
        os.stat(path)  # noqa: PTH116
    except PermissionError as error:
        raise reading_error(str(path), error) from None
    except (OSError, ValueError):
        pass
    return True


def _path_in_repository(repository: Path, path: str) -> str:
    """Return a path relative to the repository, as git writes it.

    Error TLT0751 if the path is outside the repository.
    """
    inside = _relative_path(path, repository)
    if inside is None:
        title = f"`{path}` is not in the repository `{repository}`"
        raise TltlError([Diagnostic("TLT0751", title, help="name only files of one repository in one run")])
    return inside.as_posix()


def _relative_path(path: str, folder: Path) -> Path | None:
    """Return a path relative to a folder, or None if the path is outside the folder.

    Links are resolved first, with one exception: a link to a file is kept if the link itself is in
    the folder, because it may have another target in another revision. Links to folders are always
    resolved, because revisions are written without them.
    """
    parent, name = os.path.split(os.path.abspath(path))  # noqa: PTH100
    places = [os.path.realpath(path)]
    if not is_dir(path):
        places.insert(0, os.path.join(os.path.realpath(parent), name))  # noqa: PTH118
    top = os.path.realpath(folder)
    return next((Path(place).relative_to(top) for place in places if Path(place).is_relative_to(top)), None)


def _nearest_folder(path: str) -> Path:
    """Return the path itself if it is a folder that exists, else the nearest folder above it."""
    place = Path(os.path.realpath(path))
    return next(folder for folder in (place, *place.parents) if folder.is_dir())
