"""The session in the guide: each call in it gives the answer that the guide shows."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import anyio

from tests.docs.blocks import DOCS
from tests.docs.sessions import matches
from tests.interfaces.mcp.client import connected, text

PAGE = DOCS / "guides" / "coding-agents.md"
PART = re.compile(
    r"^```(?P<kind>|json|text)\n(?P<text>.*?)^```$|^<!-- in (?P<file>\S+): (?P<old>\S+) => (?P<new>\S+) -->$",
    re.DOTALL | re.MULTILINE,
)


def test_the_calls_of_the_guide_give_the_shown_answers(tmp_path: Path) -> None:
    compared = 0

    async def session() -> None:
        nonlocal compared
        answer: Any = None
        async with connected(tmp_path) as agent:
            for part in PART.finditer(PAGE.read_text(encoding="utf-8")):
                if part["file"]:
                    path = tmp_path / part["file"]
                    path.write_text(path.read_text(encoding="utf-8").replace(part["old"], part["new"], 1))
                elif not part["kind"]:
                    (tmp_path / "leave.tltl").write_text(part["text"], encoding="utf-8")
                elif part["kind"] == "text":
                    assert matches(text(answer).rstrip("\n") + "\n", part["text"]), text(answer)
                    compared += 1
                elif "name" in (shown := json.loads(part["text"])):
                    answer = await agent.call(shown["name"], **shown["arguments"])
                elif "edits" in shown:
                    assert answer.structured_content["diagnostics"][0]["fixes"] == [shown]
                    compared += 1

    anyio.run(session)
    assert compared == 6
