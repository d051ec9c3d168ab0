"""The session of one editor: its documents and analyses, and the notifications to the editor."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Final

from lsprotocol import types
from pygls.exceptions import FeatureRequestError
from pygls.lsp.server import LanguageServer

from tltlc import __version__
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.tree import SpecDecl
from tltlc.interfaces.lsp.diagnostics import project_file_diagnostic, protocol_diagnostic
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.paths import location_at, location_of
from tltlc.interfaces.lsp.positions import UTF_16
from tltlc.interfaces.lsp.previous_diagnostics import previous_diagnostics
from tltlc.interfaces.lsp.protocol import LOG, Protocol
from tltlc.interfaces.lsp.queue import Queue
from tltlc.interfaces.lsp.slow_analysis import DocumentAnalysis, Request
from tltlc.interfaces.lsp.worker import AnalysisWorker
from tltlc.interfaces.lsp.workspace import Workspace

if TYPE_CHECKING:
    from pygls.server import ServerErrors

SOON_S: Final = 0.01
"""Seconds from a change until its quick diagnostics are sent. They also cover the changes in between."""
LATER_S: Final = 0.4
"""Seconds without a change until the slow analysis, which builds the automata, is scheduled."""


class EditorSession(LanguageServer):
    """The session of one editor: its open texts, their analyses and timers."""

    def __init__(self) -> None:
        # Editors count lines in different ways, so they must send the whole text.
        full = types.TextDocumentSyncKind.Full
        super().__init__("tltlc", __version__, text_document_sync_kind=full, protocol_cls=Protocol)
        self.texts = Workspace()
        self.worker = AnalysisWorker()
        self.queue = Queue(self._analyse_now, self.worker.abandon)
        self.was_shut_down = False
        self._analyses: dict[str, tuple[Document, DocumentAnalysis]] = {}
        self._timers: dict[tuple[str, str], asyncio.TimerHandle] = {}
        self._imported_uris: dict[str, list[str]] = {}
        self._project_files: dict[str, SourceFile] = {}
        self._project_diagnostics: dict[str, tuple[Diagnostic, ...]] = {}

    @property
    def encoding(self) -> str:
        """The encoding in whose units columns are counted, as agreed with the editor, such as ``utf-16``."""
        agreed = self.server_capabilities.position_encoding
        return str(getattr(agreed, "value", agreed) or UTF_16)

    def analysis(self, document: Document) -> DocumentAnalysis | None:
        """Return the analysis of a document; None if its current text has not been analysed."""
        analysed_document, analysis = self._analyses.get(location_of(document.source), (None, None))
        return analysis if analysed_document is document else None

    def last_analysis(self, document: Document) -> DocumentAnalysis | None:
        """Return the last analysis of a document, perhaps of an earlier text; None if there is none."""
        _, analysis = self._analyses.get(location_of(document.source), (None, None))
        return analysis

    def workspace_edit(self, edits: Mapping[str, list[types.TextEdit]]) -> types.WorkspaceEdit:
        """Convert the edits of each document, by URI, to a workspace edit.

        If the editor supports versions, each edit names the version of the document that it is for.
        """
        workspace = self.client_capabilities.workspace
        if not (workspace and workspace.workspace_edit and workspace.workspace_edit.document_changes):
            return types.WorkspaceEdit(changes=dict(edits))
        changes = [
            types.TextDocumentEdit(
                types.OptionalVersionedTextDocumentIdentifier(uri, self.texts.version(uri)), [*text_edits]
            )
            for uri, text_edits in edits.items()
        ]
        return types.WorkspaceEdit(document_changes=[*changes])

    def report_server_error(self, error: Exception, source: ServerErrors) -> None:
        """Log an error in the handling of a message.

        Errors in requests are not logged, because pygls sends them to the editor as answers.
        """
        if source is not FeatureRequestError:
            LOG.error("a message was not understood: %s", error)

    # --- changes ------------------------------------------------------------------------------

    def on_change(self, uris: Iterable[str]) -> None:
        """Schedule new diagnostics for documents that have changed, or whose imported files have changed."""
        for uri in uris:
            self.queue.drop(uri)
            self._schedule("now", uri, SOON_S, self._publish, restart=False)
            self._schedule("later", uri, LATER_S, self._schedule_analysis, restart=True)

    def on_use_change(self, uris: Iterable[str]) -> None:
        """Schedule new analyses of the open documents among ``uris``, after a change in a file that imports them.

        That file may have begun or ceased to use one of their declarations, which changes the
        warnings about unused declarations.
        """
        for uri in uris:
            if self.texts.is_open(uri):
                self._schedule("again", uri, LATER_S, self._schedule_reanalysis, restart=True)

    def on_close(self, uri: str) -> None:
        """Handle the closing of a document: forget its analysis, and clear its diagnostics."""
        self.queue.drop(uri)
        self._analyses.pop(location_at(uri), None)
        for task in ("now", "later", "again"):
            timer = self._timers.pop((task, uri), None)
            if timer is not None:
                timer.cancel()
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, []))
        # The file on disk replaces the closed text, and may use other names of its imports.
        self.on_use_change(dict.fromkeys([*self._imported_uris.pop(uri, []), *self.texts.open_imports(uri)]))

    def shut_down(self) -> None:
        """Cancel all timers and analyses, so that the editor gets no further notifications."""
        self.was_shut_down = True
        for timer in self._timers.values():
            timer.cancel()
        self.queue.clear()

    def _schedule(self, task: str, uri: str, delay_s: float, then: Callable[[str], None], *, restart: bool) -> None:
        key = (task, uri)
        timer = self._timers.get(key)
        if timer is not None:
            if not restart:
                return
            timer.cancel()

        def run() -> None:
            self._timers.pop(key, None)
            then(uri)

        self._timers[key] = asyncio.get_running_loop().call_later(delay_s, run)

    def _publish(self, uri: str) -> None:
        """Send the current diagnostics of an open document and of its project file to the editor."""
        document = self.texts.document(uri) if self.texts.is_open(uri) else None
        if document is None:
            return
        analysed_document, analysis = self._analyses.get(location_of(document.source), (document, None))
        if analysis is None:
            diagnostics = document.diagnostics
        elif analysed_document is document:
            diagnostics = analysis.diagnostics
        else:
            diagnostics = (*document.diagnostics, *previous_diagnostics(analysed_document, analysis, document))
        protocol_diagnostics = [
            protocol_diagnostic(diagnostic, document, self.encoding, self.texts.uri) for diagnostic in diagnostics
        ]
        version = self.texts.version(uri)
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, protocol_diagnostics, version))
        self._publish_project(document)

    def _publish_project(self, document: Document) -> None:
        """Send the diagnostics of a document's project file to the editor, if they have changed.

        If diagnostics of other project files were sent before, bring these up to date, too.
        """
        errors = self.texts.project(document.source)[1]
        files = {label.source.name: label.source for diagnostic in errors for label in diagnostic.labels}
        self._project_files |= dict(sorted(files.items()))
        for name, source in self._project_files.items():
            project_errors = self.texts.project(source)[1]
            own = tuple(
                diagnostic
                for diagnostic in project_errors
                if diagnostic.labels and diagnostic.labels[0].source.name == name
            )
            if self._project_diagnostics.get(name, ()) != own:
                self._project_diagnostics[name] = own
                protocol_diagnostics = [project_file_diagnostic(diagnostic, self.encoding) for diagnostic in own]
                self.text_document_publish_diagnostics(
                    types.PublishDiagnosticsParams(self.texts.uri(source), protocol_diagnostics)
                )

    # --- automata -----------------------------------------------------------------------------

    def _schedule_analysis(self, uri: str) -> None:
        """Schedule the analysis of a document, and of the open documents that it imports.

        The imported documents are analysed again, because their warnings about unused declarations
        depend on this document.
        """
        before, self._imported_uris[uri] = self._imported_uris.get(uri, []), self.texts.open_imports(uri)
        self.on_use_change(dict.fromkeys([*before, *self._imported_uris[uri]]))
        self.queue.put(uri)

    def _schedule_reanalysis(self, uri: str) -> None:
        document = self.texts.document(uri)
        # In a file without specs, the linter never calls a name unused, whatever other files use.
        if document is not None and any(
            isinstance(declaration, SpecDecl) for declaration in document.module.declarations
        ):
            self.queue.put(uri, again=True)

    async def analysis_of(self, uri: str) -> DocumentAnalysis | None:
        """Return the analysis of a document's current text; run the analysis if there is none.

        Return None if the document is missing, has errors or changes meanwhile, or if the analysis
        takes too long.
        """
        document = self.texts.document(uri)
        return (self.analysis(document) if document else None) or await self.queue.answer(uri)

    async def _analyse_now(self, uri: str, again: bool) -> DocumentAnalysis | None:
        """Return the analysis of a document; if the result is new, also send its diagnostics to the editor.

        If the current text was analysed before, return that analysis, except with ``again``. Return
        None if the document is missing, has errors or changes meanwhile, or if the analysis is
        stopped.
        """
        document = self.texts.document(uri)
        if document is None or not document.is_clean:
            return None
        previous = self.analysis(document)
        if previous is not None and not again:
            return previous
        project = document.project
        request = Request(document.source, project.libraries, dict(project.lint), self.texts.texts())
        analysis = await self.worker.analyse(request)
        if analysis is None or self.texts.document(uri) is not document:
            return None
        self._analyses[location_of(document.source)] = (document, analysis)
        if analysis == previous:
            return analysis
        self._publish(uri)
        self._refresh_editor()
        return analysis

    def _refresh_editor(self) -> None:
        """Ask the editor to request code lenses and inlay hints again.

        Lenses show numbers of the analysis, and hints may depend on other files.
        """
        workspace = self.client_capabilities.workspace or types.WorkspaceClientCapabilities()
        if workspace.code_lens and workspace.code_lens.refresh_support:
            self.workspace_code_lens_refresh(None)
        if workspace.inlay_hint and workspace.inlay_hint.refresh_support:
            self.workspace_inlay_hint_refresh(None)
