"""What the server knows of one editor's session, and what it says unasked."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Final

from lsprotocol import types
from pygls.exceptions import FeatureRequestError
from pygls.lsp.server import LanguageServer

from tltlc import __version__
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.tree import SpecDecl
from tltlc.interfaces.lsp.analysed_text import Document
from tltlc.interfaces.lsp.analysis import Analysis, Request
from tltlc.interfaces.lsp.diagnostics import remark, remark_on_project
from tltlc.interfaces.lsp.paths import name_of, path_of
from tltlc.interfaces.lsp.positions import UTF_16
from tltlc.interfaces.lsp.previous_diagnostics import kept
from tltlc.interfaces.lsp.protocol import LOG, Protocol
from tltlc.interfaces.lsp.queue import Queue
from tltlc.interfaces.lsp.worker import Worker
from tltlc.interfaces.lsp.workspace import Workspace

if TYPE_CHECKING:
    from pygls.server import ServerErrors

SOON_S: Final = 0.01
"""Seconds from a change to what is said at once: changes that come together are looked at together."""
LATER_S: Final = 0.4
"""Seconds without a change after which automata are built."""


class Server(LanguageServer):
    """The state of one editor's session."""

    def __init__(self) -> None:
        # Editors count the lines of a text in their own way, so it is sent as a whole.
        full = types.TextDocumentSyncKind.Full
        super().__init__("tltlc", __version__, text_document_sync_kind=full, protocol_cls=Protocol)
        self.texts = Workspace()
        self.worker = Worker()
        self.queue = Queue(self._analyse_now, self.worker.abandon)
        self.was_shut_down = False
        self._analyses: dict[str, tuple[Document, Analysis]] = {}
        self._timers: dict[tuple[str, str], asyncio.TimerHandle] = {}
        self._imported: dict[str, list[str]] = {}
        self._said_of_project: dict[str, tuple[Diagnostic, ...]] = {}

    @property
    def encoding(self) -> str:
        """How columns are counted, as was agreed upon."""
        agreed = self.server_capabilities.position_encoding
        return str(getattr(agreed, "value", agreed) or UTF_16)

    def analysis(self, document: Document) -> Analysis | None:
        """What is known of the automata of a document, if that is up to date."""
        made_of, found = self._analyses.get(document.source.name, (None, None))
        return found if made_of is document else None

    def last_analysis(self, document: Document) -> Analysis | None:
        """What was last known of the automata of a document, which may have changed since."""
        _, found = self._analyses.get(document.source.name, (None, None))
        return found

    def workspace_edit(self, edits: Mapping[str, list[types.TextEdit]]) -> types.WorkspaceEdit:
        """Edits by URIs; where the editor can tell versions apart, for those alone that they were made for."""
        workspace = self.client_capabilities.workspace
        if not (workspace and workspace.workspace_edit and workspace.workspace_edit.document_changes):
            return types.WorkspaceEdit(changes=dict(edits))
        changes = [
            types.TextDocumentEdit(types.OptionalVersionedTextDocumentIdentifier(uri, self.texts.version(uri)), [*own])
            for uri, own in edits.items()
        ]
        return types.WorkspaceEdit(document_changes=[*changes])

    def report_server_error(self, error: Exception, source: ServerErrors) -> None:
        """Log what a message has led to, and show the user nothing: requests are answered with their errors anyway."""
        if source is not FeatureRequestError:
            LOG.error("a message was not understood: %s", error)

    # --- changes ------------------------------------------------------------------------------

    def changed(self, uris: Iterable[str]) -> None:
        """These documents have other texts, or import what has."""
        for uri in uris:
            self.queue.drop(uri)
            self._at("now", uri, SOON_S, self._publish, restart=False)
            self._at("later", uri, LATER_S, self._analyse, restart=True)

    def used_otherwise(self, uris: Iterable[str]) -> None:
        """Files that may import these documents have changed: other names of theirs may be unused."""
        for uri in uris:
            if self.texts.is_open(uri):
                self._at("again", uri, LATER_S, self._analyse_again, restart=True)

    def closed(self, uri: str) -> None:
        """Nothing more is said of a document."""
        self.queue.drop(uri)
        self._analyses.pop(name_of(uri), None)
        for what in ("now", "later", "again"):
            timer = self._timers.pop((what, uri), None)
            if timer is not None:
                timer.cancel()
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, []))
        # Its file counts again, which may use other names.
        self.used_otherwise(dict.fromkeys([*self._imported.pop(uri, []), *self.texts.imported(uri)]))

    def shut_down(self) -> None:
        """Nothing more is said of anything."""
        self.was_shut_down = True
        for timer in self._timers.values():
            timer.cancel()
        self.queue.clear()

    def _at(self, what: str, uri: str, delay_s: float, then: Callable[[str], None], *, restart: bool) -> None:
        key = (what, uri)
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
        """Say what there is to say of a document by now."""
        document = self.texts.document(uri) if self.texts.is_open(uri) else None
        if document is None:
            return
        made_of, found = self._analyses.get(document.source.name, (document, None))
        if found is None:
            said = document.said
        elif made_of is document:
            said = found.said
        else:
            said = (*document.said, *kept(made_of, found, document))
        remarks = [remark(each, document, self.encoding, self.texts.uri) for each in said]
        version = self.texts.version(uri)
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, remarks, version))
        self._publish_project(document)

    def _publish_project(self, document: Document) -> None:
        """What is wrong with the project file, at that file; also with those that were wrong before."""
        found = self.texts.project(document.source.name)[1]
        places = {label.source.name for each in found for label in each.labels}
        for name in dict.fromkeys([*self._said_of_project, *sorted(places)]):
            there = self.texts.project(path_of(name))[1]
            own = tuple(each for each in there if each.labels and each.labels[0].source.name == name)
            if self._said_of_project.get(name, ()) != own:
                self._said_of_project[name] = own
                remarks = [remark_on_project(each, self.encoding) for each in own]
                self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(self.texts.uri(name), remarks))

    # --- automata -----------------------------------------------------------------------------

    def _analyse(self, uri: str) -> None:
        """Have the automata of a document built; what it imports may have names now that nothing uses, or none."""
        before, self._imported[uri] = self._imported.get(uri, []), self.texts.imported(uri)
        self.used_otherwise(dict.fromkeys([*before, *self._imported[uri]]))
        self.queue.put(uri)

    def _analyse_again(self, uri: str) -> None:
        document = self.texts.document(uri)
        # Of a file without specs, everything may be used elsewhere.
        if document is not None and any(isinstance(each, SpecDecl) for each in document.module.declarations):
            self.queue.put(uri, again=True)

    async def analysis_of(self, uri: str) -> Analysis | None:
        """What is found of a document, built if need be; None where it is not there, broken or changing."""
        document = self.texts.document(uri)
        return (self.analysis(document) if document else None) or await self.queue.answer(uri)

    async def _analyse_now(self, uri: str, again: bool) -> Analysis | None:
        """Build the automata of a document and say what is found; None where it is not there, broken or changing."""
        document = self.texts.document(uri)
        if document is None or not document.is_clean:
            return None
        known = self.analysis(document)
        if known is not None and not again:
            return known
        project = document.project
        request = Request(document.source, project.libraries, dict(project.lint), self.texts.texts())
        found = await self.worker.analyse(request)
        if found is None or self.texts.document(uri) is not document:
            return None
        self._analyses[document.source.name] = (document, found)
        if found == known:
            return found
        self._publish(uri)
        self._ask_to_look_again()
        return found

    def _ask_to_look_again(self) -> None:
        """Lenses are made of an analysis, and hints may be made of another file."""
        workspace = self.client_capabilities.workspace or types.WorkspaceClientCapabilities()
        if workspace.code_lens and workspace.code_lens.refresh_support:
            self.workspace_code_lens_refresh(None)
        if workspace.inlay_hint and workspace.inlay_hint.refresh_support:
            self.workspace_inlay_hint_refresh(None)
