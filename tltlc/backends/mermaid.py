"""The automaton as a Mermaid state diagram, which many wikis and code hosts draw in place."""

from __future__ import annotations

import re

from tltlc.automaton.fspa import Edge, Fspa, State
from tltlc.backends import Files, Options, Target
from tltlc.backends.drawing.texts import Guards, label, visible, wrapped

TARGET = Target("mermaid", "a state diagram for Mermaid", (".mmd",))

LABEL_WIDTH = 40

CLASSES = """\
    classDef satisfied fill:#dcfce7,stroke:#15803d,stroke-width:4px,color:#0f172a
    classDef holding fill:#f0fdf4,stroke:#16a34a,stroke-width:4px,color:#0f172a
    classDef pending fill:#f8fafc,stroke:#475569,color:#0f172a
    classDef violated fill:#fef2f2,stroke:#dc2626,color:#0f172a"""

_PLAIN = frozenset(" (),.∞¬∧∨⇒⇔⊤⊥◇□○𝒰")


def emit(fspa: Fspa, options: Options) -> Files:
    """``NAME.mmd``: labels with their distances, guards, and a class for each verdict."""
    guards = Guards(fspa, options.notation)
    lines = ["stateDiagram-v2", "    direction LR"]
    lines += [_state(state, label(state.label, options.notation)) for state in fspa.states]
    lines.append("    [*] --> s0")
    lines += [_edge(edge, guards.text(edge.guard.text)) for edge in fspa.edges]
    lines.append(CLASSES)
    lines += [f"    class s{state.id} {state.verdict}" for state in fspa.states]
    return {f"{fspa.name}.mmd": "\n".join([*lines, ""])}


def _state(state: State, text: str) -> str:
    distance = "∞" if state.distance is None else str(state.distance)
    body = "<br/>".join(map(_escaped, wrapped(text, LABEL_WIDTH)))
    return f'    state "{body}<br/>{_escaped(f"[{distance}]")}" as s{state.id}'


def _edge(edge: Edge, text: str) -> str:
    return f"    s{edge.source} --> s{edge.target}: {'<br/>'.join(map(_escaped, wrapped(text, LABEL_WIDTH)))}"


def _escaped(text: str) -> str:
    """Text with everything but letters, digits and a few marks as Mermaid's ``#38;``, so that nothing in it counts."""
    escaped = "".join(
        character if character.isalnum() or character in _PLAIN else f"#{ord(character)};"
        for character in visible(text)
    )
    # Mermaid takes any line with `direction LR` in it for that statement.
    return re.sub("direction", lambda match: f"#{ord(match.group()[0])};{match.group()[1:]}", escaped, flags=re.I)
