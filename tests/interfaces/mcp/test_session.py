"""An agent finds, explains and mends a wrong spec, as a coding agent does."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import anyio
import pytest
from jsonschema import Draft202012Validator

from tests.interfaces.mcp.client import SPEC, connected, mended, text
from tltlc.interfaces.mcp.server import INSTRUCTIONS

TOOLS = ["check", "explain", "witness", "monitor", "test", "diff", "regress"]


@pytest.mark.parametrize("mode", ["auto", "legacy"])
def test_the_tools_are_listed_with_schemas(tmp_path: Path, mode: Literal["auto", "legacy"]) -> None:
    async def session() -> None:
        async with connected(tmp_path, mode) as agent:
            assert list(agent.tools) == TOOLS
            for tool in agent.tools.values():
                assert tool.annotations is not None
                assert tool.annotations.read_only_hint == (tool.name != "regress")
                assert tool.output_schema is not None
                Draft202012Validator.check_schema(tool.input_schema)
                Draft202012Validator.check_schema(tool.output_schema)
            assert (await agent.document("check", text=SPEC))["ok"]

    anyio.run(session)


def test_a_wrong_spec_is_found_explained_and_mended(tmp_path: Path) -> None:
    path = tmp_path / "leave.tltl"
    wrong = SPEC.replace("reach has_key", "reach haskey")
    path.write_text(wrong, encoding="utf-8")

    async def session() -> None:
        async with connected(tmp_path) as agent:
            # The check finds the mistake and offers a fix.
            found = await agent.document("check", path="leave.tltl")
            assert not found["ok"]
            (error,) = found["diagnostics"]
            assert (error["code"], error["severity"]) == ("TLT0201", "error")
            assert (error["labels"][0]["file"], error["labels"][0]["start"]["line"]) == ("leave.tltl", 8)
            page = await agent.document("explain", code=error["code"])
            assert page["page"].startswith("# TLT0201")
            fix = error["fixes"][0]
            assert fix["applicability"] == "maybe"

            # With its edits, the spec is clean; the text stands for the file until it is written.
            right = mended(wrong, fix)
            assert right == SPEC
            checked = await agent.document("check", path="leave.tltl", text=right)
            assert checked == {
                "ok": True,
                "files": [{"file": "leave.tltl", "specs": ["leave"]}],
                "diagnostics": [],
                "left_out": 0,
            }
            path.write_text(right, encoding="utf-8")

            # The explanation says what the spec asks for.
            result = await agent.call("explain", path="leave.tltl")
            (explained,) = result.structured_content["specs"]
            assert [goal["text"] for goal in explained["outline"]["goals"][0]] == ["has_key", "distance < 2"]
            assert "has_key" in text(result)

            # Of the witnesses, one is accepted and one is rejected, and the tests made of them pass.
            traces = (await agent.document("witness", path="leave.tltl"))["traces"]
            assert [trace["kind"] for trace in traces] == ["accepting", "rejecting"]
            for trace in traces:
                judged = await agent.document("monitor", path="leave.tltl", trace_text=trace["csv"])
                assert judged["traces"][0]["accepted"] == (trace["kind"] == "accepting")
            with_tests = right + "".join(trace["test"] for trace in traces)
            tested = await agent.document("test", text=with_tests)
            assert (tested["passed"], tested["failed"]) == (3, 0)

            # A trace that fails: the answer says at which step which clause failed.
            rows = [
                {"distance": 50, "has_key": False, "seen": False},
                {"distance": 30, "has_key": True, "seen": False},
                {"distance": 20, "has_key": True, "seen": True},
                {"distance": 1, "has_key": True, "seen": False},
            ]
            result = await agent.call("monitor", path="leave.tltl", rows=rows, from_step=3, to_step=3)
            judged = result.structured_content
            (trace,) = judged["traces"]
            assert (trace["accepted"], trace["verdict"]) == (False, "violated")
            cause = {name: trace["cause"][name] for name in ("kind", "step", "clauses", "atoms")}
            assert cause == {"kind": "broken", "step": 3, "clauses": ["avoid seen"], "atoms": ["seen"]}
            (row,) = judged["rows"]
            assert (row["step"], row["verdict"], row["atoms"]["seen"] > 0) == (3, "violated", True)
            assert "breaks `avoid seen` at step 3" in text(result)
            # It is the failure of `tltlc monitor --json`, with the atom, the line, and what remained.
            assert judged["failure"] == {
                "failed_step": 3,
                "failed_clause": "avoid seen",
                "failed_atom": "seen",
                "clause": 2,
                "file": "leave.tltl",
                "line": 9,
                "atoms": {"seen": 1.0},
                "unmet": "Reach distance < 2, and avoid seen throughout.",
                "asked_since": None,
            }
            details = ["leave.tltl:9: avoid seen", "at step 3: seen is true"]
            assert all(line in text(result).splitlines() for line in details)
            assert "what remained before: Reach distance < 2, and avoid seen throughout" in text(result)

            # What a change of the spec means.
            looser = right.replace("    avoid seen\n", "")
            compared = await agent.document("diff", a={"path": "leave.tltl"}, b={"text": looser})
            (pair,) = compared["diff"]["specs"]
            assert pair["relation"] == "looser"
            assert any("seen" in letter for letter in pair["only_b"])

            # A test that fails says so.
            failing = right.replace("expect pending", "expect violated")
            tested = await agent.document("test", text=failing)
            assert (tested["passed"], tested["failed"]) == (0, 1)
            assert tested["diagnostics"][0]["labels"][0]["start"]["line"] == 14

    anyio.run(session)
    assert list(tmp_path.iterdir()) == [path]


def test_the_settings_of_the_project_and_of_the_call_count(tmp_path: Path) -> None:
    (tmp_path / "library").mkdir()
    (tmp_path / "library" / "game.tltl").write_text("signal coins: int in [0, 9]\n", encoding="utf-8")
    (tmp_path / "specs").mkdir()
    text = "import game\nparam most: int in [0, 9] = 3\nspec rich { reach coins > most }\n"
    (tmp_path / "specs" / "rich.tltl").write_text(text, encoding="utf-8")

    async def session() -> None:
        async with connected(tmp_path) as agent:
            assert not (await agent.document("check", path="specs"))["ok"]
            assert (await agent.document("check", path="specs", libraries=["library"]))["ok"]
            (tmp_path / "specs" / "tltl.toml").write_text('libraries = ["../library"]\n', encoding="utf-8")
            checked = await agent.document("check", path="specs")
            assert checked["files"] == [{"file": str(Path("specs", "rich.tltl")), "specs": ["rich"]}]
            rows: list[dict[str, Any]] = [{"coins": 5}]
            for most, accepted in (("3", True), (7, False)):
                judged = await agent.document("monitor", path="specs/rich.tltl:rich", rows=rows, params={"most": most})
                assert judged["accepted"] == accepted

    anyio.run(session)


def test_values_of_enums_are_told_by_name_and_are_numbers_in_the_document(tmp_path: Path) -> None:
    async def session() -> None:
        async with connected(tmp_path) as agent:
            spec = "signal mode: (calm, alert)\nspec s { avoid mode is calm and previously (mode is alert) }\n"
            rows = [{"mode": "alert"}, {"mode": "calm"}]
            result = await agent.call("monitor", text=spec, rows=rows, from_step=2)
            assert "at step 2: mode is calm, mode was alert at the step before" in text(result).splitlines()
            (line,) = (line for line in text(result).splitlines() if line.startswith("step 2: "))
            assert line.endswith("; mode is calm yes, previously (mode is alert) yes, mode is alert no")
            judged = result.structured_content
            assert judged is not None
            assert judged["failure"]["atoms"] == {"mode is calm": 1.0, "previously (mode is alert)": 1.0}

    anyio.run(session)


def test_traces_in_files_are_judged_together(tmp_path: Path) -> None:
    (tmp_path / "leave.tltl").write_text(SPEC, encoding="utf-8")
    (tmp_path / "runs").mkdir()
    header = "distance,has_key,seen\n"
    for name, rows in (("good", "9,1,0\n1,1,0\n"), ("seen", "9,1,0\n1,1,1\n"), ("short", "9,1,0\n")):
        (tmp_path / "runs" / f"{name}.csv").write_text(header + rows, encoding="utf-8")

    async def session() -> None:
        async with connected(tmp_path) as agent:
            judged = await agent.document("monitor", path="leave.tltl", traces=["runs"])
            assert (judged["total"], judged["accepted"]) == (3, 1)
            kinds = {Path(trace["trace"]).stem: trace["cause"] and trace["cause"]["kind"] for trace in judged["traces"]}
            assert kinds == {"good": None, "seen": "broken", "short": "unfinished"}
            assert sum(cause["count"] for cause in judged["causes"]) == 2
            assert judged["failure"] is None
            for name, step in (("seen", 2), ("short", None), ("good", None)):
                judged = await agent.document("monitor", path="leave.tltl", traces=[f"runs/{name}.csv"])
                assert (judged["failure"] and judged["failure"]["failed_step"]) == step

    anyio.run(session)


def test_the_example_in_the_instructions_compiles(tmp_path: Path) -> None:
    """The instructions of the server teach an agent the language."""
    example = "".join(line[2:] for line in INSTRUCTIONS.splitlines(keepends=True) if line.startswith("  "))

    async def session() -> None:
        async with connected(tmp_path) as agent:
            assert agent.client.instructions == INSTRUCTIONS
            checked = await agent.document("check", text=example)
            assert checked["files"][0]["specs"] == ["leave"]
            assert checked["diagnostics"] == []
            assert (await agent.document("test", text=example))["passed"] == 1

    anyio.run(session)
