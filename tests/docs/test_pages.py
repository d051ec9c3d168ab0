"""The pages name only files, tests, fields and columns that exist, and name all of them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import tltlc
from tests.docs.blocks import DOCS, ROOT, blocks
from tltlc.backends import emit
from tltlc.interfaces.cli import exits
from tltlc.monitor import Step
from tltlc.monitor.run import header

PAGES = sorted([*DOCS.rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"])
LINK = re.compile(r"\]\(([^)\s]+)\)")
TEST_FILE = re.compile(r"`(tests/[\w/]+\.py)`(?:\s*\(((?:`test_\w+`,?\s*)+)\))?")


def anchors(page: Path) -> set[str]:
    heads = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\s-]", "", head.lower()).replace(" ", "-") for head in heads}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_have_targets(page: Path) -> None:
    for link in LINK.findall(page.read_text(encoding="utf-8")):
        if link.startswith("https://"):
            continue
        target, _, anchor = link.partition("#")
        path = (page.parent / target).resolve() if target else page
        assert path.exists(), link
        if anchor:
            assert anchor in anchors(path), link


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_named_tests_exist(page: Path) -> None:
    for file, names in TEST_FILE.findall(page.read_text(encoding="utf-8")):
        source = (ROOT / file).read_text(encoding="utf-8")
        for name in re.findall(r"`(\w+)`", names):
            assert f"\ndef {name}(" in source, f"{file}: {name}"


def test_decisions_are_numbered_and_have_the_same_headings() -> None:
    pages = sorted((DOCS / "adr").glob("[0-9]*.md"))
    assert [int(page.name[:4]) for page in pages] == list(range(1, len(pages) + 1))
    required = ["Status", "Context", "Decision", "Consequences"]
    for number, page in enumerate(pages, 1):
        text = page.read_text(encoding="utf-8")
        assert text.startswith(f"# {number}. "), page.name
        heads = re.findall(r"^## (.*)$", text, re.MULTILINE)
        assert heads in (required, [*required, "Alternatives considered"]), page.name


def test_the_index_lists_every_decision() -> None:
    index = (DOCS / "adr" / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| \[(.*)\]\((.*)\) \| \w.*\. \|$", index, re.MULTILINE)
    pages = sorted((DOCS / "adr").glob("[0-9]*.md"))
    titles = [page.read_text(encoding="utf-8").splitlines()[0] for page in pages]
    assert [(f"# {number}. {title}", name) for number, title, name in rows] == [
        (title, page.name) for title, page in zip(titles, pages, strict=True)
    ]


@pytest.mark.parametrize(
    "claim, file, remark",
    [
        ("Truth decides", "progress_and_reward.py", "whose guard is true"),
        ("The paper evaluates the formula as it is written", "guards.py", "from the guard's formula"),
        ("r is capped at 0", "progress_and_reward.py", "is at most 0"),
        ("If S is 0", "tables.py", "The paper divides"),
        ("A trap has none", "progress_and_reward.py", "a trap has the progress 0"),
        ("Judging at the limit", "progress_and_reward.py", "judged at its limit"),
        ("notices the end one step later", "progress_and_reward.py", "not one step later"),
        ("It is the signed distance", "reward_modes/sparse.py", "robustness of the formula"),
        ("Edges into a trap", "reward_modes/edge.py", "left out"),
    ],
)
def test_a_deviation_from_the_paper_is_marked_on_the_page_and_in_the_code(claim: str, file: str, remark: str) -> None:
    page = " ".join((DOCS / "semantics.md").read_text(encoding="utf-8").split())
    assert re.search(rf"▲[^▲]*{re.escape(claim)}", page)
    code = (ROOT / "tltlc" / "monitor" / file).read_text(encoding="utf-8")
    assert re.search(rf"▲[^▲\n]*{re.escape(remark)}", code)


def test_no_other_code_deviates() -> None:
    marked = {path.name for path in (ROOT / "tltlc").rglob("*.py") if "▲" in path.read_text(encoding="utf-8")}
    assert marked == {"progress_and_reward.py", "guards.py", "tables.py", "sparse.py", "edge.py"}


ARTEFACT = (DOCS / "artefact.md").read_text(encoding="utf-8")
_FENCED = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
SPEC = """import stealth
clock 20 Hz
entity s1, s2
exclusive near(s1), near(s2)
/// Doc.
spec s { level one limit 10 s tag quick reach near(s1) then near(s2) keep alive }
"""


def keys(value: Any) -> Iterator[str]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield key
            yield from keys(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from keys(inner)


def test_every_field_of_the_artefact_is_documented() -> None:
    schema = json.loads((ROOT / "tltlc/artefact/fspa.schema.json").read_text())
    expression = schema["definitions"]["expression"]["properties"]
    operators = {*expression["op"]["enum"], *schema["definitions"]["condition"]["properties"]["op"]["enum"]}
    (fspa,) = tltlc.compile_text(SPEC)
    (text,) = emit("json", fspa).values()
    fields = {*keys(json.loads(text)), *schema["properties"], *schema["properties"]["spec"]["properties"]}
    documented = set(re.findall(r"[\w+*/^<>=-]+", " ".join(re.findall(r"`([^`]+)`", _FENCED.sub("", ARTEFACT)))))
    documented |= {part for name in documented for part in name.split(".")}
    assert fields | operators <= documented


def test_the_excerpt_of_an_artefact_is_that_of_the_tutorial() -> None:
    source = next(block.text for block in blocks(DOCS / "tutorial.md") if block.file == "boss.tltl")
    (fspa,) = tltlc.compile_text(source)
    (text,) = emit("json", fspa).values()
    artefact = json.loads(text)
    (excerpt,) = (block for block in blocks(DOCS / "artefact.md") if block.kind == "json")
    shown = json.loads(excerpt.text.replace("{…}", "{}"))
    assert shown["states"] == [{**state, "label": {}} for state in artefact["states"]]
    assert shown["initial"] == artefact["initial"]
    assert all(edge in artefact["edges"] for edge in shown["edges"])


def test_the_program_with_a_monitor_prints_the_shown_output(capsys: pytest.CaptureFixture[str]) -> None:
    program, printed = next(pair for pair in pairwise(blocks(DOCS / "artefact.md")) if pair[0].kind == "python")
    exec(program.text, {})
    assert capsys.readouterr().out == printed.text


def test_the_fields_of_a_step_are_documented() -> None:
    table = ARTEFACT[ARTEFACT.index("| field of `Step` |") :].split("\n\n")[0]
    assert re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE) == list(Step._fields)


def test_the_columns_are_documented() -> None:
    (fspa,) = tltlc.compile_text(SPEC)
    assert f"\n    {','.join(header(fspa)[:5])}\n" in ARTEFACT
    (generated,) = emit("python", fspa).values()
    match = re.search(r'"(step,[\w,]+)"', str(generated))
    assert match
    assert f"\n    {match[1]}\n" in ARTEFACT


def test_the_exit_statuses_are_documented() -> None:
    page = (DOCS / "commands.md").read_text(encoding="utf-8")
    documented = re.findall(r"^\| ([\d, ]+) \|", page[page.index("## Exit statuses") :], re.MULTILINE)
    used = {value for name, value in vars(exits).items() if name.isupper() and isinstance(value, int)}
    assert {int(number) for cell in documented for number in cell.split(",")} == used


def test_excerpts_in_the_contributing_guide_are_in_the_sources() -> None:
    page = ROOT / "CONTRIBUTING.md"
    sources = [ROOT / name for name in re.findall(r"`((?:tltlc|tests)/[\w/.]+\.(?:py|txt))`", page.read_text("utf-8"))]
    texts = [source.read_text("utf-8") for source in sources]
    excerpts = [block for block in blocks(page) if block.kind in ("python", "js")]
    assert len(excerpts) >= 3
    for excerpt in excerpts:
        assert any(excerpt.text in text for text in texts), f"line {excerpt.line} of CONTRIBUTING.md is out of date"


def test_the_places_that_the_contributing_guide_names_exist() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    table = text[text.index("## Where is … made?") : text.index("## Adding things")]
    places = re.findall(r"`((?:tltlc|tltl_runtime)/[\w/]+\.py)`: `(\w+)`", table)
    assert len(places) >= 30
    for file, name in places:
        path = (ROOT if file.startswith("tltlc/") else ROOT / "runtime") / file
        source = path.read_text(encoding="utf-8")
        assert re.search(rf"^(?:def {name}|class {name}|{name})\b", source, re.MULTILINE), f"{file}: {name}"


def test_the_contributing_guide_lists_every_folder_of_the_code() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for folder in ("tltlc", "runtime/tltl_runtime", "runtime/tltl_runtime/stealth"):
        head = f"| in `{folder.removeprefix('runtime/')}/` | contains |"
        table = text[text.index(head) :].split("\n\n")[0]
        named = {name for row in table.splitlines()[2:] for name in re.findall(r"`(\w+)`", row.split("|")[1])}
        there = {path.name for path in (ROOT / folder).iterdir() if path.is_dir() and any(path.glob("*.*"))}
        modules = {path.stem for path in (ROOT / folder).glob("*.py")}
        assert there - {"__pycache__", "stdlib"} <= named <= there | modules, folder
