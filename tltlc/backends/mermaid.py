"""The automaton as a Mermaid state diagram, which many wikis and code hosts draw in place: in pictures, runs of
states that count are folded.  Over infinite traces, the pairs that name an edge stand behind its guard.
"""

from __future__ import annotations

import re

from tltlc.automaton.fspa import Edge, Fspa, State
from tltlc.backends import Files, Options, Target
from tltlc.backends.drawing.folding import folded, span
from tltlc.backends.drawing.texts import Guards, label, visible, wrapped

TARGET = Target("mermaid", "a state diagram for Mermaid", (".mmd",))

LABEL_WIDTH = 40

CLASSES = """\
    classDef satisfied fill:#dcfce7,stroke:#15803d,stroke-width:4px,color:#0f172a
    classDef holding fill:#f0fdf4,stroke:#16a34a,stroke-width:4px,color:#0f172a
    classDef pending fill:#f8fafc,stroke:#475569,color:#0f172a
    classDef violated fill:#fef2f2,stroke:#dc2626,color:#0f172a"""
DASHED = "    classDef folded stroke-dasharray:6 4"

_PLAIN = frozenset(" (),.∞¬∧∨⇒⇔⊤⊥◇□○𝒰")


def emit(fspa: Fspa, options: Options) -> Files:
    """``NAME.mmd``: labels with their distances, guards, and a class for each verdict; folded states are dashed."""
    guards, drawing = Guards(fspa, options.notation), folded(fspa)
    lines = ["stateDiagram-v2", "    direction LR"]
    lines += [_state(drawing.folded.get(state.id, (state,)), options) for state in drawing.states]
    lines.append("    [*] --> s0")
    lines += [_edge(edge, guards.text(edge.guard.text)) for edge in drawing.edges]
    lines += [CLASSES, DASHED] if drawing.folded else [CLASSES]
    lines += [f"    class s{state.id} {state.verdict}" for state in drawing.states]
    lines += [f"    class s{state} folded" for state in drawing.folded]
    return {f"{fspa.name}.mmd": "\n".join([*lines, ""])}


def _state(run: tuple[State, ...], options: Options) -> str:
    """A state, or the inner states of a run in one."""
    ends = run[0], run[-1]
    distance = span(*("∞" if state.distance is None else str(state.distance) for state in ends))
    lines = wrapped(span(*(label(state.label, options.notation) for state in ends)), LABEL_WIDTH)
    if len(run) > 1:
        lines = [f"{len(run)} more like these:", *lines]
    body = "<br/>".join(map(_escaped, lines))
    return f'    state "{body}<br/>{_escaped(f"[{distance}]")}" as s{run[0].id}'


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
