"""docs/regression.md matches the code: every key, every field, every number."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import get_args

import pytest

from tests.docs.blocks import DOCS, blocks
from tests.runtime.regression.handmade import ROOM, case, some_episodes, suite, summaries
from tltl_runtime.cli.support import game_starter
from tltl_runtime.evaluation.figures import Figures, figures_of
from tltl_runtime.policies.shipped import shipped_policies
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.junit import junit
from tltl_runtime.regression.report.report_json import FORMAT, VERSION, document
from tltl_runtime.regression.report.retraining_result import (
    BestFailedEpisode,
    FinishedRetraining,
    Outcome,
    RetrainingResult,
)
from tltl_runtime.regression.suite import suite as suite_module
from tltl_runtime.regression.suite import thresholds, trace_case
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, MOST_EPISODES, read_suite
from tltl_runtime.regression.suite.thresholds import Thresholds
from tltl_runtime.regression.verdict import confidence
from tltl_runtime.regression.verdict.confidence import rate_interval

PAGE = (DOCS / "regression.md").read_text(encoding="utf-8")


def rows(heading: str) -> dict[str, str]:
    """The rows of the table whose first column has this heading, by the names in the first cell."""
    tables = re.findall(rf"^\| {heading} \|.*\n\|[-|]+\|\n((?:\|.*\n)+)", PAGE, re.MULTILINE)
    assert tables, heading
    cells = {}
    for line in "".join(tables).splitlines():
        first, rest = line.strip("| ").split(" | ", 1)
        cells |= dict.fromkeys(re.findall(r"`\[*([\w.]+)\]*`", first), rest)
    return cells


def test_the_page_lists_exactly_the_keys_of_a_suite() -> None:
    modules = (suite_module, thresholds, trace_case)
    source = "".join(Path(str(module.__file__)).read_text(encoding="utf-8") for module in modules)
    read = set(re.findall(r"(?:table|found)\.(?:number|whole|text|names|tables?)\(\"(\w+)\"", source))
    read |= set(re.findall(r"\b_(?:text|paths)\(table, (?:folder, )?\"(\w+)\"", source))
    read |= set(Thresholds.__match_args__)
    documented = {*rows("key"), *rows("key of a case"), *rows("key of thresholds")}
    assert {name.rpartition(".")[2] for name in documented} == read


def test_the_page_has_the_defaults() -> None:
    documented = rows("key of thresholds")
    assert {name: float(rest.rpartition("|")[2]) for name, rest in documented.items()} == {
        name: getattr(Thresholds(), name) for name in Thresholds.__match_args__
    }
    assert rows("key")["episodes"].endswith(f"| {MOST_EPISODES}")
    assert f"in [{LEAST_EPISODES}, 10000]" in rows("key")["episodes"]
    assert f"at least {LEAST_EPISODES} episodes, and at most {MOST_EPISODES}" in " ".join(PAGE.split())


def test_the_suites_on_the_page_are_valid(tmp_path: Path) -> None:
    files = [
        "vault.toml",
        "vault.tltl",
        "edits/crates_moved.toml",
    ]
    for name in files:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(ROOM, encoding="utf-8")
    for name, text in game_starter.files("python")[0].items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    for folder in ("training/vault", "agent"):
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
        shutil.copy(shipped_policies()["cover_and_hide"], tmp_path / folder / "policy.safetensors")
    texts = [block.text for block in blocks(DOCS / "regression.md") if block.kind == "toml"]
    (tmp_path / "metroid.tltl").write_text("signal a: bool\nspec fetch { reach a }\n", encoding="utf-8")
    for name in ("v1", "v2"):
        (tmp_path / "traces" / name).mkdir(parents=True)
    counts = []
    for text in texts:
        (tmp_path / "game.toml").write_text(text, encoding="utf-8")
        counts.append(len(read_suite(tmp_path / "game.toml").cases))
    assert counts == [1, 2, 1]


def test_the_page_lists_exactly_the_fields_of_the_report() -> None:
    report = CaseReport("a", "a", "v0", "pass", (), figures=figures_of(summaries(2)), episodes=tuple(some_episodes(1)))
    report_document = document(suite(case("a")), [report], complete=True)
    assert set(rows("field")) - {"tltl"} == set(report_document)
    (case_document,) = report_document["cases"]
    assert set(rows("field of a case")) == set(case_document)
    assert (FORMAT, VERSION) == ("tltl-regression", 1)
    assert f"| `{FORMAT}`, {VERSION} |" in PAGE
    retraining_fields = (
        *RetrainingResult.__match_args__,
        *FinishedRetraining.__match_args__,
        *BestFailedEpisode.__match_args__,
    )
    for name in (*Figures.__match_args__, *case_document["accounts"][0], *retraining_fields, *get_args(Outcome)):
        assert f"`{name}`" in PAGE
    json.dumps(report_document, allow_nan=False)


def test_the_page_lists_the_properties() -> None:
    trained = FinishedRetraining("met", 1, 1.0, 0, True, None)
    new = RetrainingResult(
        "learned", "", trained, figures_of(summaries(2)), (0.0, 1.0), None, "retrained/a/policy", None
    )
    figures = figures_of(summaries(2))
    report = CaseReport("CASE", "a", "v0", "pass", (), figures=figures, baseline=figures, retrained=new)
    names = set(re.findall(r'name="(CASE\.\w+)"', junit(suite(case("CASE")), [report])))
    documented = set(re.findall(r"`(CASE\.\w+)`", PAGE))
    assert documented <= names
    assert {name for name in names if "baseline" not in name} <= documented


def test_the_page_has_the_numbers_of_episodes() -> None:
    def least(cases: int) -> int:
        return next(count for count in range(25, 99) if rate_interval(count, 0, 0.05 / cases)[0] >= 0.85)

    text = " ".join(PAGE.split())
    in_one, in_nine, in_thirty = map(least, (1, 9, 30))
    assert f"after {in_one} episodes in a suite of one case, after {in_nine} in one of nine" in text
    assert f"and after {in_thirty} in one of thirty" in text
    most = max(failed for failed in range(99) if rate_interval(300 - failed, failed, 0.05 / 9)[0] >= 0.85)
    assert f"in a suite of nine cases, {most} may fail" in text


def test_the_page_has_the_shares_of_the_bets() -> None:
    *first, last = (f"{share:g}" for share in confidence._SHARES)
    assert f"for c = {', '.join(first)} and {last}. " in " ".join(PAGE.split())
    assert f"1/{confidence._POINTS} · Σ" in PAGE


def test_the_page_lists_every_option() -> None:
    from tltl_runtime.cli.regress import command

    options = {option for parameter in command.params for option in parameter.opts if option.startswith("--")}
    documented = set(re.findall(r"--[a-z-]+", PAGE))
    assert options - {"--workers", "--output", "--help"} <= documented
    (text,) = (block.text for block in blocks(DOCS / "regression.md") if block.kind == "yaml")
    (run,) = re.findall(r"- run: (tltlc regress .*)", text)
    # The options of git are inside `$(…)`.
    assert set(re.findall(r"--[a-z]+", re.sub(r"\$\(.*?\)", "", run))) <= options


@pytest.mark.parametrize("verdict", ["pass", "review", "fail"])
def test_the_page_lists_the_verdicts(verdict: str) -> None:
    assert rows("verdict")[verdict]
