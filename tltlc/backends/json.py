"""The artefact: the automaton as JSON, which monitors, training and all other tools load."""

from __future__ import annotations

from typing import Any

from tltlc.artefact.encode import encode
from tltlc.artefact.json_layout import layout
from tltlc.artefact.size import check_size, least_size
from tltlc.artefact.validator import validate
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target

TARGET = Target("json", "the automaton as JSON, for every tool that loads one", (".fspa.json",))


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the artefact ``NAME.fspa.json``, where NAME is the name of the automaton.

    Raises:
        TltlError: TLT0004 the file would be too large to be read again; TLT0006 it would have too
            many values.
    """
    return {f"{fspa.name}.fspa.json": document_and_text(fspa)[1]}


def document_and_text(fspa: Fspa) -> tuple[dict[str, Any], str]:
    """Return the artefact of an automaton, checked against the schema, as JSON data and as the text of its file.

    Raises:
        TltlError: TLT0004 the file would be larger than :data:`tltlc.io.limits.ARTEFACT` allows;
            TLT0006 it would have more values than this limit allows.
        ValueError: the document does not fit the schema, which would be a bug of the compiler.
    """
    subject = f"the artefact of `{fspa.name}`"
    # Reject most automata that are too large already here, before any text is built.
    check_size(subject, *least_size(fspa))
    document = encode(fspa)
    validate(document)
    blocks: list[str] = []
    size = commas = 0
    for block in layout(document):
        blocks.append(block)
        size, commas = size + len(block.encode()), commas + block.count(",")
        check_size(subject, size, commas)
    return document, "".join(blocks)
