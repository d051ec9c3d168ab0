"""The texts that are open in the editor, and the source files in its folders."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterator

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.paths import is_below, location_at, location_of, source_at, uri_of
from tltlc.io.access_log import access_log
from tltlc.io.files import is_file, may_be_file, read_source, unsaved_texts, walk
from tltlc.io.limits import WORKSPACE, WORKSPACE_PARSED
from tltlc.io.project import Project, project_for
from tltlc.io.spec_file import STDIN
from tltlc.resolve.imports import standard_library


class Workspace:
    """The texts that are open in the editor, and the source files in its folders.

    A :class:`Document` is made for a text or file when it is first needed, and then cached.

    ``folders`` are the paths of the folders that the editor shows.
    """

    def __init__(self) -> None:
        self.folders: list[str] = []
        self._open: dict[str, tuple[str, int | None, SourceFile]] = {}
        self._documents: dict[str, Document] = {}

    # --- notifications ------------------------------------------------------------------------

    def put(self, uri: str, version: int | None, text: str) -> list[str]:
        """Record the new or changed text of an open document.

        Return the URIs of the open documents that the change affects, first ``uri`` itself.
        """
        location = location_at(uri)
        self._open[location] = (uri, version, source_at(uri, text))
        return [uri, *self._forget(location)]

    def close(self, uri: str) -> list[str]:
        """Forget the text of a closed document, so that the file on disk counts again.

        Return the URIs of the open documents that this affects.
        """
        location = location_at(uri)
        self._open.pop(location, None)
        return self._forget(location)

    def refresh(self) -> list[str]:
        """Drop the cached documents that depend on a file that has changed on disk.

        Return the URIs of the dropped documents that are open.
        """
        return self._drop([location for location, document in self._documents.items() if not document.is_current()])

    # --- documents ----------------------------------------------------------------------------

    def document(self, uri: str) -> Document | None:
        """Return the document with this URI: the open text, or else the file; None if there is neither."""
        return self.document_at(location_at(uri))

    def document_at(self, location: str) -> Document | None:
        """Return the document at a location: the text that is open in the editor, or else the file on disk.

        Return None if there is neither, or if the file cannot be read. The location is an absolute
        path, or the URI of a text that is not a file.
        """
        opened = self._open.get(location)
        document = self._documents.get(location)
        # The editor reports changes of open texts; closed files may change without notice.
        if document is not None and (opened is not None or document.is_current()):
            return document
        with access_log() as notes:
            # Reading a named pipe would block the server until its other end is opened.
            if opened is None and not is_file(location):
                return None
            try:
                source = opened[2] if opened else read_source(location)
            except TltlError:
                return None
            project, _ = self.project(source)
        document = self._documents[location] = Document(source, project, self.texts(), notes)
        return document

    def version(self, uri: str) -> int | None:
        """Return the version of an open document; None if it is not open or has no version."""
        opened = self._open.get(location_at(uri))
        return opened[1] if opened else None

    def uri(self, source: SourceFile) -> str:
        """Return the URI of a file; if the file is open, the URI that the editor uses."""
        opened = self._open.get(location_of(source))
        return opened[0] if opened else uri_of(source)

    def is_open(self, uri: str) -> bool:
        """Whether a document is open in the editor."""
        return location_at(uri) in self._open

    def open_uris(self) -> list[str]:
        """Return the URIs of the open documents."""
        return [uri for uri, _, _ in self._open.values()]

    def open_imports(self, uri: str) -> list[str]:
        """Return the URIs of the other open documents that a document imports, also indirectly."""
        document = self.document(uri)
        locations = document.reads - {location_of(document.source)} if document else ()
        return [self._open[location][0] for location in sorted(locations) if location in self._open]

    def texts(self) -> dict[str, str]:
        """Return the texts of the open documents, by location."""
        return {location: source.text for location, (_, _, source) in self._open.items()}

    def project(self, source: SourceFile) -> tuple[Project, tuple[Diagnostic, ...]]:
        """Return the settings of a file's project, and the errors of the project file, the nearest ``tltl.toml``.

        If the project file has errors, return the default settings.
        """
        try:
            with unsaved_texts(self.texts()):
                return project_for(STDIN if source.kind == "text" else location_of(source)), ()
        except TltlError as error:
            return Project(), error.diagnostics

    def is_own(self, source: SourceFile) -> bool:
        """Whether a file belongs to the workspace: it is open, or in a folder of :attr:`folders`.

        The standard library belongs to the workspace only if it is in one of these folders.
        """
        if source.kind == "text":
            return True
        path = location_of(source)
        if is_below(path, str(standard_library().absolute())) and not self._is_in_folders(
            str(standard_library().absolute())
        ):
            return False
        return path in self._open or self._is_in_folders(path)

    def all(self) -> Iterator[Document]:
        """Yield the documents of the workspace: the open ones, and the source files in its folders.

        Raises:
            TltlError: TLT0004, the folders are too large to search.
        """
        size = 0
        for location in self._locations():
            document = self.document_at(location)
            if document is not None:
                size += len(document.source.text)
                if size > WORKSPACE.size:
                    raise _too_large(f"{WORKSPACE.size >> 20} MiB of sources")
                yield document

    async def parse(self, is_needed: Callable[[str], bool]) -> None:
        """Parse the documents for whose texts ``is_needed`` is true, and cache their names for later requests.

        Between two documents, other tasks of the event loop may run, such as requests.

        Raises:
            TltlError: TLT0004, there is too much to search or to parse.
        """
        size = 0
        for document in self.all():
            await asyncio.sleep(0)
            if is_needed(document.source.text):
                size += len(document.source.text)
                if size > WORKSPACE_PARSED.size:
                    raise _too_large(f"{WORKSPACE_PARSED.size >> 20} MiB of sources that may matter here")
                _ = document.names

    def _locations(self) -> list[str]:
        locations = dict.fromkeys(self._open)
        count = 0
        for folder in self.folders:
            for place, folders, files in walk(folder):
                count += len(folders) + len(files)
                if count > (WORKSPACE.values or 0):
                    raise _too_large(f"{WORKSPACE.values:,} files and folders")
                folders[:] = sorted(name for name in folders if not name.startswith(".") and name != "node_modules")
                paths = [os.path.join(place, file) for file in sorted(files) if _is_source(file)]  # noqa: PTH118
                locations.update(dict.fromkeys(filter(may_be_file, paths)))
        return [*locations]

    def _is_in_folders(self, path: str) -> bool:
        return any(is_below(path, folder) for folder in self.folders)

    def _forget(self, location: str) -> list[str]:
        """Drop the cached document at ``location``, and the documents that depend on it.

        Return the URIs of the dependent documents that are open.
        """
        self._documents.pop(location, None)
        return self._drop(
            [
                dependent
                for dependent, document in self._documents.items()
                if document.depends_on(location) or _is_project(location)
            ]
        )

    def _drop(self, locations: list[str]) -> list[str]:
        for location in locations:
            del self._documents[location]
        return [self._open[location][0] for location in locations if location in self._open]


def _is_source(file: str) -> bool:
    return file.endswith(".tltl") and not file.startswith(".")


def _too_large(content: str) -> TltlError:
    title = f"the folders in the editor contain more than {content}"
    return TltlError([Diagnostic("TLT0004", title, help="open a smaller folder in the editor")])


def _is_project(location: str) -> bool:
    return os.path.isabs(location) and os.path.basename(location) == "tltl.toml"  # noqa: PTH117, PTH119
