"""The whole page: its content, and that names cannot inject markup or scripts."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from functools import cache
from html.parser import HTMLParser
from typing import Any

import pytest

from tests.runtime.game.test_packing import unstepped
from tests.runtime.regression.handmade import PLAYED, changed, summaries
from tests.runtime.regression.page import samples
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.page.contents import NotRun, ReportedCase, SuiteReport
from tltl_runtime.regression.report.page.page import html_report
from tltl_runtime.regression.report.retraining_result import FinishedRetraining, RetrainingResult
from tltl_runtime.stealth.level import Box
from tltlc.automaton.fspa import Text
from tltlc.core.record import replace

EVIL = "</script><b onclick='x'>`$title`&amp;<!--"


class Page(HTMLParser):
    """A parsed page: its elements with attributes, its scripts and its texts."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: list[str] = []
        self.texts: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attributes)))
        if tag == "script":
            self.scripts.append("")

    def handle_data(self, data: str) -> None:
        if self.cdata_elem == "script":
            self.scripts[-1] += data
        else:
            self.texts.append(data)

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]

    @property
    def data(self) -> dict[str, Any]:
        data: dict[str, Any] = json.loads(self.scripts[0])
        return data


@cache
def page() -> Page:
    return Page(html_report(samples.suite()))


def test_each_case_has_a_row_and_a_section() -> None:
    suite = samples.suite()
    assert [case.report.verdict for case in suite.cases] == ["pass", "fail", "fail"]
    sections = [element for element in page().all("section") if "case" in (element["class"] or "")]
    assert [element["data-verdict"] for element in sections] == ["fail", "fail", "pass"], "failures come first"
    assert [element["id"] for element in sections] == ["cover_and_hide-v0", "broken-v0", "navigation-v0"]
    rows = [element for element in page().all("tr") if "data-verdict" in element]
    assert [element["data-verdict"] for element in rows] == ["fail", "fail", "pass"]
    for case in suite.cases:
        assert case.report.name in page().texts
        assert set(case.report.reasons[0].split("`")[:1]) <= set(page().texts)
    assert [text for text in page().texts if text.startswith("seed 7")] == [
        "seed 7 · probability that any certain fail or review is wrong, or any pass has too low a rate: at most 0.05 · "
        "tltlc 0.1 · python 3.11"
    ]


def test_the_result_in_a_sentence_comes_first() -> None:
    headings = [text.strip() for text in page().texts if text.strip()]
    title = headings.index("Regression report: sample")
    assert headings[title + 1] == (
        "1 of 3 levels can no longer be finished by its agent; 1 cannot be played; 1 plays as before."
    )


def test_versions_seeds_and_hashes_are_at_the_end() -> None:
    suite = samples.suite()
    case = replace(suite.cases[0], report=replace(suite.cases[0].report, played=PLAYED))
    text = html_report(replace(suite, cases=(case,)))
    body, end = text.split('<section class="provenance"')
    end = end.partition("</section>")[0]
    for fact in ("Actions sampled, as in training", "seed 7", "python 3.11", "a" * 12, "b" * 12, "c" * 12):
        assert fact in end and fact not in body
    assert end.count("<tr>") == 2 and "<code>aaaaaaaaaaaa</code>" in end


def test_the_reward_is_the_last_column_and_the_reason_the_first_after_the_verdict() -> None:
    heads = re.findall(r'<th scope="col"[^>]*>(\w+)</th>', html_report(samples.suite()))
    assert heads[:6] == ["Case", "Verdict", "Why", "Met", "Progress", "Reward"]


def test_a_new_failure_in_a_pass_is_marked() -> None:
    suite = samples.suite()
    finding = Finding("dies in 1 of 43 episodes; before: in 0 of 200", (0,), short="dies in 1 of 43 episodes")
    explanation = (replace(finding, text="dies in 1 of 43 episodes; before: in 0 of 200 episodes"),)
    report = replace(suite.cases[0].report, new_failures=(finding,), explanation=explanation)
    case = replace(suite.cases[0], report=report)
    text = html_report(replace(suite, cases=(case, *suite.cases[1:])))
    parsed = Page(text)
    marked = [element for _, element in parsed.elements if "data-new-failure" in element]
    assert [element["data-verdict"] for element in marked] == ["pass", "pass"], "the row and the section"
    assert parsed.texts.count("new failure") == 2
    (first,) = re.findall(r'<ul class="reasons">\n<li class="new">(.*?)</li>', text)
    assert first.startswith("new failure: dies in 1 of 43 episodes") and "#navigation-v0/0/" in first
    assert text.count("dies in 1 of 43 episodes") == 1, "the page says it once"
    assert any("1 plays as before, with a new failure" in part for part in parsed.texts)
    assert not any("data-new-failure" in element for _, element in page().elements)


def test_formulas_are_in_words_and_the_switch_shows_symbols() -> None:
    text = html_report(replace(samples.suite(), cases=samples.suite().cases[:1]))
    words, symbols = (
        re.findall(rf'<div class="{kind}">(<svg class="automaton".*?</svg>)</div>', text, re.DOTALL)
        for kind in ("in-words", "in-symbols")
    )
    assert len(words) == len(symbols) == 1
    assert "Reach near(exit)" in words[0] and "◇" not in words[0]
    assert "◇near(exit)" in symbols[0] and "Reach" not in symbols[0]
    (table,) = re.findall(r'<table class="counts-table">.*?</table>', text, re.DOTALL)
    assert '<span class="in-words">Reach near(exit).</span><span class="in-symbols">◇near(exit)</span>' in table
    parsed = Page(text)
    (case,) = parsed.data["cases"]
    assert "Reach near(exit)." in case["states"] and "◇near(exit)" in case["symbols"]
    switch = [element for element in parsed.all("input") if element.get("name") == "notation"]
    assert [(element["value"], "checked" in element) for element in switch] == [("english", True), ("unicode", False)]


def test_the_page_shows_the_clauses_as_they_were_written() -> None:
    suite = samples.suite()
    case = replace(suite.cases[0], clauses=("reach near(exit)", "keep abs(spin) <= 5"))
    texts = Page(html_report(replace(suite, cases=(case,)))).texts
    assert {"reach near(exit)", "keep abs(spin) <= 5"} <= set(texts)


def test_the_automaton_has_a_legend() -> None:
    (label, *_) = [element for element in page().all("ul") if element.get("aria-label") == "Legend of the automaton"]
    assert label["class"] == "legend states"
    texts = " ".join(page().texts)
    for words in ("start", "goal: the spec is met", "violation", "episodes that failed in it"):
        assert words in texts


def test_cases_that_were_not_run_have_a_row_and_a_section_with_the_reason() -> None:
    not_run = (NotRun("<a>", "the run was stopped"), NotRun("b", "no file concerns it", "review"))
    parsed = Page(html_report(replace(samples.suite(), not_run=not_run)))
    for kind in ("tr", "section"):
        assert [element["data-verdict"] for element in parsed.all(kind) if "data-verdict" in element][3:] == [
            "not run",
            "review",
        ]
    texts = [text.strip() for text in parsed.texts]
    assert [texts.count(text) for text in ("<a>", "the run was stopped", "b", "no file concerns it")] == [2] * 4
    assert texts.count("not run") == 1 + 2 + 2, "their number, rows and sections"
    assert texts.count("earlier: review") == 1 and texts.count("An earlier run gave it the verdict") == 1
    links = [element["href"] for element in parsed.all("a")]
    assert {f"#{element['id']}" for element in parsed.all("section") if "case" in (element["class"] or "")} <= set(
        links
    )
    assert "not run" not in page().texts


def test_every_link_has_a_target() -> None:
    ids = [attributes["id"] for _, attributes in page().elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    recorded = {
        case["slug"]: {episode["index"]: episode for episode in case["episodes"]} for case in page().data["cases"]
    }
    episodes = 0
    for link in page().all("a"):
        slug, *target = (link["href"] or "").removeprefix("#").split("/")
        assert slug in ids
        if target:
            episodes += 1
            index, step = map(int, target)
            assert 0 <= step < sum(count for _, count in recorded[slug][index]["state"])
    assert episodes > 0


def test_ids_of_cases_and_of_the_page_differ() -> None:
    case = samples.suite().cases[0]
    names = ["data", "only-findings", "a", "a-title", "title:a", "page:data"]
    cases = tuple(replace(case, report=replace(case.report, name=name)) for name in names)
    parsed = Page(html_report(SuiteReport("names", 0, 0.05, {}, cases)))
    ids = [attributes["id"] for _, attributes in parsed.elements if "id" in attributes]
    assert len(ids) == len(set(ids)) == 2 * len(names) + 3


def test_explanations_link_to_the_recorded_episodes() -> None:
    case = samples.suite().cases[1]
    mentioned = {index for finding in case.report.explanation for index in finding.episodes}
    linked = {
        int((element["href"] or "").split("/")[1])
        for element in page().all("a")
        if element.get("class") == "episode" and (element["href"] or "").startswith("#cover_and_hide-v0/")
    }
    assert linked == mentioned & set(case.episodes)
    assert mentioned - linked  # the third episode has no recording


def test_equal_sentences_link_to_their_own_episodes() -> None:
    case = samples.suite().cases[1]
    explanation = (Finding("it fails", (0,)), Finding("it fails", (1,)))
    report = replace(case.report, causes=("met in 0", "it fails"), explanation=explanation, edits=("it fails",))
    text = html_report(SuiteReport("equal", 0, 0.05, {}, (replace(case, report=report),)))
    lines = re.findall(r'<li class="(\w+)">it fails(.*?)</li>', text)
    assert [(kind, re.findall(r"#cover_and_hide-v0/(\d)/", line)) for kind, line in lines] == [
        ("finding", ["0"]),
        ("edit", []),
        ("finding", ["1"]),
        ("cause", []),
    ]


def test_nothing_is_loaded_from_outside() -> None:
    text = html_report(samples.suite())
    assert set(re.findall(r"[a-z]+://[^\s\"'<]+", text)) == {"http://www.w3.org/2000/svg"}  # a name, not an address
    assert not re.search(r"\bsrc=|@import|url\(|\beval\(|new Function", text)
    assert not any(name.startswith("on") for _, attributes in page().elements for name in attributes)
    assert [element["href"] for element in page().all("link")] == ["data:,"]


def test_the_content_security_policy_allows_only_the_own_script() -> None:
    (policy,) = [element["content"] or "" for element in page().all("meta") if "http-equiv" in element]
    digest = base64.b64encode(hashlib.sha256(page().scripts[1].encode()).digest()).decode()
    assert policy == (f"default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-{digest}'")


def test_names_are_escaped() -> None:
    case = samples.suite().cases[1]
    assert case.level is not None and case.fspa is not None
    level = replace(
        case.level,
        name=EVIL,
        solids=tuple(replace(solid, name=EVIL) for solid in case.level.solids),
        regions=tuple(replace(region, name=EVIL) for region in case.level.regions),
        enemies=tuple(replace(enemy, name=EVIL) for enemy in case.level.enemies),
    )
    state = case.fspa.states[0]
    label = Text(EVIL, EVIL, EVIL)
    fspa = replace(
        case.fspa,
        formula=label,
        states=(replace(state, label=label), *case.fspa.states[1:]),
        atoms=tuple(replace(atom, base=EVIL, arguments=()) for atom in case.fspa.atoms),
    )
    explained_episodes = tuple(replace(explained, by=(EVIL,)) for explained in case.report.episodes)
    report = replace(case.report, name=EVIL, level=EVIL, causes=(EVIL,), explanation=(), episodes=explained_episodes)
    evil = ReportedCase(report, level, fspa, case.episodes, case.before)
    text = html_report(SuiteReport(EVIL, 0, 0.05, {EVIL: EVIL}, (evil,)))
    plain = html_report(SuiteReport("s", 0, 0.05, {"v": "1"}, (case,)))
    parsed = Page(text)
    tags = [{name for name, _ in page.elements} for page in (parsed, Page(plain))]
    assert tags[0] - tags[1] <= {"code"} and "b" not in tags[0]
    assert len(parsed.scripts) == 2
    assert parsed.data["cases"][0]["states"][0] == EVIL
    assert parsed.data["cases"][0]["map"]["enemies"][0]["name"] == EVIL
    assert EVIL in parsed.texts
    assert not any(name.startswith("on") for _, attributes in parsed.elements for name in attributes)


def test_a_retraining_is_shown_with_its_curve() -> None:
    trained = FinishedRetraining("minutes", 4096, 60.0, 200_000, True, None)
    retrained = RetrainingResult(
        "no_way", f"no way found: {EVIL}", trained, figures_of(summaries(0, 2)), (0.0, 0.5), None, "a/p", None
    )
    suite = samples.suite()
    case = replace(suite.cases[0], report=replace(suite.cases[0].report, retrained=retrained), curve=b"a curve")
    parsed = Page(html_report(replace(suite, cases=(case, *suite.cases[1:]))))
    assert "".join(parsed.texts).count("no way found: </script><b onclick='x'>") == 1
    assert "policy: a/p" in parsed.texts
    (picture,) = parsed.all("img")
    assert picture["src"] == "data:image/png;base64," + base64.b64encode(b"a curve").decode()
    assert picture["alt"]
    assert not Page(html_report(suite)).all("img")


def test_the_outcome_of_a_retraining_is_in_the_table() -> None:
    trained = FinishedRetraining("minutes", 4096, 60.0, 200_000, True, None)
    retrained = RetrainingResult("no_way", "no", trained, figures_of(summaries(0, 2)), (0.0, 0.5), None, "a/p", None)
    suite = samples.suite()
    case = replace(suite.cases[1], report=replace(suite.cases[1].report, retrained=retrained))
    texts = Page(html_report(replace(suite, cases=(suite.cases[0], case)))).texts
    assert texts.count("retrained: no way found") == 1
    assert not any(text.startswith("retrained") for text in page().texts)


def test_the_confidence_intervals_are_explained_where_they_are_drawn() -> None:
    note = "The thin line on a bar is the 95 % interval of its share, as a guide; the verdicts use a wider one."
    assert page().texts.count(note) == 1
    without_figures = SuiteReport(
        "none", 0, 0.05, {}, tuple(case for case in samples.suite().cases if not case.report.figures)
    )
    assert without_figures.cases and note not in Page(html_report(without_figures)).texts


def test_pass_rates_are_shown_in_percent() -> None:
    suite = samples.suite()
    report = replace(
        suite.cases[1].report, figures=figures_of(summaries(121, 179)), baseline=figures_of(summaries(299, 1))
    )
    texts = Page(html_report(replace(suite, cases=(replace(suite.cases[1], report=report),)))).texts
    assert "121 of 300 · 40 %" in texts and "before 299 of 300 · 99 %" in texts


def test_the_note_of_a_suite_is_shown() -> None:
    assert "As planned." in Page(html_report(replace(samples.suite(), note="As planned."))).texts


def test_a_level_that_looks_different_from_the_baseline_has_a_second_map() -> None:
    def maps(case: ReportedCase) -> tuple[int, str]:
        text = html_report(SuiteReport("maps", 0, 0.05, {}, (case,)))
        return len([svg for svg in Page(text).all("svg") if (svg.get("class") or "").endswith(" map")]), text

    case = samples.suite().cases[1]
    assert case.level is not None and case.baseline_level is not None
    assert maps(case)[0] == 1 and "as it was" not in maps(case)[1]
    # The map shows neither the sight ranges of enemies nor the name of the variant.
    enemies = tuple(replace(enemy, kind=replace(enemy.kind, walk_speed=9.0)) for enemy in case.level.enemies)
    assert maps(replace(case, level=replace(case.level, enemies=enemies, variant="v7")))[0] == 1
    wide = replace(case.baseline_level, bounds=Box((-5.0, 0.0, -2.0), case.baseline_level.bounds.high))
    count, text = maps(replace(case, baseline_level=wide))
    assert count == 2 and "The level as it was when the baseline was recorded: cover_and_hide v0." in text
    (data,) = Page(text).data["cases"]
    first = [
        sum(unstepped(data[when]["trajectories"][0]["x"])[:1]) * data[when]["trajectories"][0]["unit"]
        for when in ("now", "before")
    ]
    assert first[1] - first[0] == pytest.approx(500, abs=100), "its trajectories are on its map"
    unknown = maps(replace(case, baseline_level=None))
    assert unknown[0] == 1 and "how it was then is no longer known" in unknown[1]
    assert "no longer known" not in maps(replace(case, baseline_level=None, before=()))[1]


def test_a_case_that_cannot_be_played_has_only_its_reasons() -> None:
    case = CaseReport("gone:v0", "gone", "v0", "fail", ("it cannot be played", "TLT0803: no `start`"))
    parsed = Page(html_report(SuiteReport("one", 0, 0.05, {}, (ReportedCase(case),), complete=False)))
    assert parsed.data["cases"] == []
    assert "it cannot be played" in parsed.texts
    assert any("report is incomplete" in text for text in parsed.texts)


def test_equal_reports_give_equal_pages() -> None:
    assert html_report(samples.suite()) == html_report(samples.suite())


@pytest.mark.parametrize("count", [1, pytest.param(9, marks=pytest.mark.slow)])
def test_a_page_of_nine_cases_is_smaller_than_seven_megabytes(count: int) -> None:
    """A page of one case is smaller than a ninth of that, although it has the style and the script, too."""
    long = samples.branching_that_takes_its_time()
    assert len(long.actions) == 600
    explained = samples.explained_of(0, long)
    explained_episodes = tuple(changed(explained, index=index) for index in range(200))
    reported = samples.reported("branching:v0", "pass", [long], [long])
    report = replace(reported.report, episodes=explained_episodes)
    episodes = dict.fromkeys(range(13), long)
    cases = tuple(
        ReportedCase(
            replace(report, name=f"case {number}"), reported.level, reported.fspa, episodes, explained_episodes
        )
        for number in range(count)
    )
    size = len(html_report(SuiteReport("nine", 0, 0.05, {}, cases)).encode())
    print(f"{count} cases, each of 200 episodes of 90 s and 13 recordings: {size / 1e6:.2f} MB")
    assert size < count * 7_000_000 / 9


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_both_colour_schemes_define_all_colours(scheme: str) -> None:
    text = html_report(SuiteReport("none", 0, 0.05, {}, ()))
    (light, dark) = re.findall(r":root \{([^}]*--paper[^}]*)\}", text)
    names = re.findall(r"(--[a-z]+):", light if scheme == "light" else dark)
    assert {"--paper", "--text", "--quiet", "--pass", "--review", "--fail", "--link"} <= set(names)
