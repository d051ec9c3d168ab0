"""The page as a whole: what is in it, and that nothing can come into it from outside."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from functools import cache
from html.parser import HTMLParser
from typing import Any

import pytest

from tests.runtime.regression.made import several
from tests.runtime.regression.page import samples
from tests.runtime.regression.page.test_packing import unstepped
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.page.contents import NotRun, ReportedCase, SuiteReport
from tltl_runtime.regression.report.page.page import html_report
from tltl_runtime.regression.retrain.retrained import Retrained, Trained
from tltl_runtime.stealth.level import Box
from tltlc.core.record import replace

EVIL = "</script><b onclick='x'>`$title`&amp;<!--"


class Page(HTMLParser):
    """The elements of a page with their attributes, and the texts of its scripts."""

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
        found: dict[str, Any] = json.loads(self.scripts[0])
        return found


@cache
def page() -> Page:
    return Page(html_report(samples.suite()))


def test_there_is_a_row_and_a_section_for_each_case() -> None:
    suite = samples.suite()
    sections = [each for each in page().all("section") if "case" in (each["class"] or "")]
    assert [each["data-verdict"] for each in sections] == [case.report.verdict for case in suite.cases]
    rows = [each for each in page().all("tr") if "data-verdict" in each]
    assert [each["data-verdict"] for each in rows] == [case.report.verdict for case in suite.cases]
    for case in suite.cases:
        assert case.report.name in page().texts
        assert set(case.report.reasons[0].split("`")[:1]) <= set(page().texts)
    assert [text for text in page().texts if text.startswith("seed 7")] == [
        "seed 7 · probability that any certain fail or review is wrong, or any pass has too low a rate: at most 0.05 · "
        "tltlc 0.1 · python 3.11"
    ]


def test_cases_that_were_not_run_have_a_row_and_a_section_that_say_why() -> None:
    not_run = (NotRun("<a>", "the run was stopped"), NotRun("b", "no file concerns it", "review"))
    found = Page(html_report(replace(samples.suite(), not_run=not_run)))
    for kind in ("tr", "section"):
        assert [each["data-verdict"] for each in found.all(kind) if "data-verdict" in each][3:] == ["not run", "review"]
    texts = [text.strip() for text in found.texts]
    assert [texts.count(said) for said in ("<a>", "the run was stopped", "b", "no file concerns it")] == [2] * 4
    assert texts.count("not run") == 1 + 2 + 2, "their number, rows and sections"
    assert texts.count("earlier: review") == 1 and texts.count("An earlier run said") == 1
    links = [each["href"] for each in found.all("a")]
    assert {f"#{each['id']}" for each in found.all("section") if "case" in (each["class"] or "")} <= set(links)
    assert "not run" not in page().texts


def test_every_link_leads_to_something() -> None:
    ids = [attributes["id"] for _, attributes in page().elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    recorded = {case["slug"]: {each["index"]: each for each in case["episodes"]} for case in page().data["cases"]}
    episodes = 0
    for each in page().all("a"):
        slug, *where = (each["href"] or "").removeprefix("#").split("/")
        assert slug in ids
        if where:
            episodes += 1
            index, step = map(int, where)
            assert 0 <= step < sum(count for _, count in recorded[slug][index]["state"])
    assert episodes > 0


def test_names_of_cases_are_not_those_of_the_page() -> None:
    case = samples.suite().cases[0]
    names = ["data", "only-findings", "a", "a-title", "title:a", "page:data"]
    cases = tuple(replace(case, report=replace(case.report, name=name)) for name in names)
    found = Page(html_report(SuiteReport("names", 0, 0.05, {}, cases)))
    ids = [attributes["id"] for _, attributes in found.elements if "id" in attributes]
    assert len(ids) == len(set(ids)) == 2 * len(names) + 2


def test_explanations_link_to_the_recorded_ones_of_their_episodes() -> None:
    case = samples.suite().cases[1]
    spoken_of = {index for finding in case.report.explanation for index in finding.episodes}
    there = {
        int((each["href"] or "").split("/")[1])
        for each in page().all("a")
        if each.get("class") == "episode" and (each["href"] or "").startswith("#cover_and_hide-v0/")
    }
    assert there == spoken_of & set(case.episodes)
    assert spoken_of - there  # of the third one there is no recording


def test_equal_sentences_link_to_their_own_episodes() -> None:
    case = samples.suite().cases[1]
    told = (Finding("it fails", (0,)), Finding("it fails", (1,)))
    report = replace(case.report, causes=("met in 0", "it fails"), explanation=told, edits=("it fails",))
    text = html_report(SuiteReport("equal", 0, 0.05, {}, (replace(case, report=report),)))
    lines = re.findall(r"<li>it fails(.*?)</li>", text)
    assert [re.findall(r"#cover_and_hide-v0/(\d)/", line) for line in lines] == [[], ["0"], ["1"], []]


def test_nothing_is_loaded_from_outside() -> None:
    text = html_report(samples.suite())
    assert set(re.findall(r"[a-z]+://[^\s\"'<]+", text)) == {"http://www.w3.org/2000/svg"}  # a name, not an address
    assert not re.search(r"\bsrc=|@import|url\(|\beval\(|new Function", text)
    assert not any(name.startswith("on") for _, attributes in page().elements for name in attributes)
    assert [each["href"] for each in page().all("link")] == ["data:,"]


def test_the_policy_of_the_page_knows_its_script_alone() -> None:
    (policy,) = [each["content"] or "" for each in page().all("meta") if "http-equiv" in each]
    digest = base64.b64encode(hashlib.sha256(page().scripts[1].encode()).digest()).decode()
    assert policy == (f"default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-{digest}'")


def test_names_bring_no_markup_into_the_page() -> None:
    case = samples.suite().cases[1]
    assert case.level is not None and case.fspa is not None
    level = replace(
        case.level,
        name=EVIL,
        solids=tuple(replace(each, name=EVIL) for each in case.level.solids),
        regions=tuple(replace(each, name=EVIL) for each in case.level.regions),
        enemies=tuple(replace(each, name=EVIL) for each in case.level.enemies),
    )
    state = case.fspa.states[0]
    label = replace(state.label, english=EVIL, unicode=EVIL)
    fspa = replace(
        case.fspa,
        formula=replace(case.fspa.formula, english=EVIL),
        states=(replace(state, label=label), *case.fspa.states[1:]),
        atoms=tuple(replace(each, name=EVIL) for each in case.fspa.atoms),
    )
    accounts = tuple(replace(each, by=(EVIL,)) for each in case.report.accounts)
    report = replace(case.report, name=EVIL, level=EVIL, causes=(EVIL,), explanation=(), accounts=accounts)
    evil = ReportedCase(report, level, fspa, case.episodes, case.before)
    text = html_report(SuiteReport(EVIL, 0, 0.05, {EVIL: EVIL}, (evil,)))
    plain = html_report(SuiteReport("s", 0, 0.05, {"v": "1"}, (case,)))
    found = Page(text)
    tags = [{name for name, _ in each.elements} for each in (found, Page(plain))]
    assert tags[0] - tags[1] <= {"code"} and "b" not in tags[0]
    assert len(found.scripts) == 2
    assert found.data["cases"][0]["states"][0] == EVIL
    assert found.data["cases"][0]["map"]["enemies"][0]["name"] == EVIL
    assert EVIL in found.texts
    assert not any(name.startswith("on") for _, attributes in found.elements for name in attributes)


def test_a_training_is_told_with_its_curve() -> None:
    trained = Trained("minutes", 4096, 60.0, 200_000, True, None)
    told = Retrained(
        "no_way", f"no way found: {EVIL}", trained, figures_of(several(0, 2)), (0.0, 0.5), None, "a/p", None
    )
    suite = samples.suite()
    case = replace(suite.cases[0], report=replace(suite.cases[0].report, retrained=told), curve=b"a curve")
    shown = Page(html_report(replace(suite, cases=(case, *suite.cases[1:]))))
    assert "".join(shown.texts).count("no way found: </script><b onclick='x'>") == 1
    assert "policy: a/p" in shown.texts
    (picture,) = shown.all("img")
    assert picture["src"] == "data:image/png;base64," + base64.b64encode(b"a curve").decode()
    assert picture["alt"]
    assert not Page(html_report(suite)).all("img")


def test_outcomes_of_trainings_stand_below_their_verdicts() -> None:
    trained = Trained("minutes", 4096, 60.0, 200_000, True, None)
    told = Retrained("no_way", "no", trained, figures_of(several(0, 2)), (0.0, 0.5), None, "a/p", None)
    suite = samples.suite()
    case = replace(suite.cases[1], report=replace(suite.cases[1].report, retrained=told))
    texts = Page(html_report(replace(suite, cases=(suite.cases[0], case)))).texts
    assert texts.count("trained anew: no way found") == 1
    assert not any(text.startswith("trained anew") for text in page().texts)


def test_whiskers_are_told_of_where_there_are_any() -> None:
    said = "The thin line on a bar is the 95 % interval of its share, for reading; verdicts are by a wider one."
    assert page().texts.count(said) == 1
    none = SuiteReport("none", 0, 0.05, {}, tuple(case for case in samples.suite().cases if not case.report.figures))
    assert none.cases and said not in Page(html_report(none)).texts


def test_pass_rates_are_told_in_percent() -> None:
    suite = samples.suite()
    report = replace(suite.cases[1].report, figures=figures_of(several(121, 179)), baseline=figures_of(several(299, 1)))
    texts = Page(html_report(replace(suite, cases=(replace(suite.cases[1], report=report),)))).texts
    assert "121 of 300 · 40 %" in texts and "before 299 of 300 · 99 %" in texts


def test_what_is_to_be_known_first_is_told() -> None:
    assert "As planned." in Page(html_report(replace(samples.suite(), note="As planned."))).texts


def test_there_is_a_second_map_where_the_level_of_the_baseline_looks_otherwise() -> None:
    def maps(case: ReportedCase) -> tuple[int, str]:
        text = html_report(SuiteReport("maps", 0, 0.05, {}, (case,)))
        return len([each for each in Page(text).all("svg") if (each["class"] or "").endswith(" map")]), text

    case = samples.suite().cases[1]
    assert case.level is not None and case.designed is not None
    assert maps(case)[0] == 1 and "as it was" not in maps(case)[1]
    # Who sees how far is on no map, nor is what the variant is called.
    kinds = tuple(replace(each, kind=replace(each.kind, walk_speed=9.0)) for each in case.level.enemies)
    assert maps(replace(case, level=replace(case.level, enemies=kinds, variant="v7")))[0] == 1
    wide = replace(case.designed, bounds=Box((-5.0, 0.0, -2.0), case.designed.bounds.high))
    count, text = maps(replace(case, designed=wide))
    assert count == 2 and "The level as it was when the baseline was recorded: cover_and_hide v0." in text
    (data,) = Page(text).data["cases"]
    first = [
        sum(unstepped(data[when]["ways"][0]["x"])[:1]) * data[when]["ways"][0]["unit"] for when in ("now", "before")
    ]
    assert first[1] - first[0] == pytest.approx(500, abs=100), "its ways are on its map"
    unknown = maps(replace(case, designed=None))
    assert unknown[0] == 1 and "what it was then is not known any more" in unknown[1]
    assert "not known any more" not in maps(replace(case, designed=None, before=()))[1]


def test_a_case_that_cannot_be_played_has_its_reasons_alone() -> None:
    case = CaseReport("gone:v0", "gone", "v0", "fail", ("it cannot be played", "TLT0803: no `start`"))
    found = Page(html_report(SuiteReport("one", 0, 0.05, {}, (ReportedCase(case),), complete=False)))
    assert found.data["cases"] == []
    assert "it cannot be played" in found.texts
    assert any("run was stopped" in text for text in found.texts)


def test_equal_reports_give_equal_pages() -> None:
    assert html_report(samples.suite()) == html_report(samples.suite())


def test_a_page_of_nine_cases_is_below_seven_megabytes() -> None:
    long = samples.branching_that_takes_its_time()
    assert len(long.actions) == 600
    account = samples.account_of(0, long)
    accounts = tuple(replace(account, index=index) for index in range(200))
    one = samples.reported("branching:v0", "pass", [long], [long])
    report = replace(one.report, accounts=accounts)
    episodes = dict.fromkeys(range(13), long)
    cases = tuple(
        ReportedCase(replace(report, name=f"case {number}"), one.level, one.fspa, episodes, accounts)
        for number in range(9)
    )
    size = len(html_report(SuiteReport("nine", 0, 0.05, {}, cases)).encode())
    print(f"nine cases, each of 200 episodes of 90 s and 13 recordings: {size / 1e6:.2f} MB")
    assert size < 7_000_000


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_colours_are_named_for_both_schemes(scheme: str) -> None:
    text = html_report(SuiteReport("none", 0, 0.05, {}, ()))
    (light, dark) = re.findall(r":root \{([^}]*--paper[^}]*)\}", text)
    names = re.findall(r"(--[a-z]+):", light if scheme == "light" else dark)
    assert {"--paper", "--text", "--quiet", "--pass", "--review", "--fail", "--link"} <= set(names)
