"""The drawing of the automaton with the counts of the episodes."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable
from itertools import pairwise
from xml.etree import ElementTree

import pytest

from tests.runtime.regression.page import samples
from tests.unfolded import unfolded
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.report.page.automaton import counts_table, draw_automaton, picture
from tltl_runtime.regression.report.page.traffic import Traffic, traffic
from tltl_runtime.stealth.recordings.episode import Episode
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends.drawing.picture_content import folded_drawing


def explained_episodes(episodes: tuple[Episode, ...]) -> list[ExplainedEpisode]:
    return [samples.explained_of(index, episode) for index, episode in enumerate(episodes)]


@pytest.fixture(scope="module")
def fspa() -> Fspa:
    return samples.cover_and_hide_failed()[0].fspa


@pytest.fixture(scope="module")
def now() -> Traffic:
    return traffic(explained_episodes(samples.cover_and_hide_failed()))


@pytest.fixture(scope="module")
def before() -> Traffic:
    return traffic(explained_episodes(samples.cover_and_hide_met()))


@pytest.fixture(scope="module")
def root(fspa: Fspa, now: Traffic, before: Traffic) -> ElementTree.Element:
    drawing = draw_automaton(fspa)
    assert drawing.svg is not None and drawing.notes == ()
    return ElementTree.fromstring(picture(fspa, drawing.svg, now, before))


def test_each_state_shows_its_counts(root: ElementTree.Element, fspa: Fspa, now: Traffic, before: Traffic) -> None:
    groups = {element.get("data-states"): element for element in root.iter("g") if element.get("data-states")}
    assert groups.keys() == {str(state.id) for state in fspa.states}
    for state in fspa.states:
        group = groups[str(state.id)]
        assert [element.text for element in group.findall("g[@class='badge name']/text")] == [f"state {state.id}"]
        for when, counts in (("now", now), ("before", before)):
            badges = group.find(f"g[@class='counts {when}']")
            assert badges is not None
            texts = [element.text for element in badges.iter("text")]
            failed = counts.failed.get(state.id, 0)
            assert texts == [str(counts.visited.get(state.id, 0)), *([f"{failed} failed"] if failed else [])]
        title = group.find("title")
        assert title is not None and title.text is not None
        assert f"visited by {now.visited.get(state.id, 0)} of {now.episodes} episodes" in title.text
    assert any(now.failed.values())


def test_edges_are_thicker_the_more_episodes_took_them(root: ElementTree.Element, now: Traffic) -> None:
    took = Counter(edge for edges in now.edges for edge in edges)
    widths = {}
    for element in root.iter("g"):
        title = element.findtext("title") or ""
        if title.startswith("From state"):
            ends = tuple(int(word) for word in title.partition(";")[0].split() if word.isdigit())
            styles = dict(part.split(": ") for part in (element.get("style") or "").split("; "))
            widths[ends] = float(styles["--took-now"])
            assert ("untaken-now" in (element.get("class") or "")) == (ends not in took)
    assert widths.keys() >= took.keys()
    ordered = sorted(widths, key=lambda ends: took.get(ends, 0))
    assert all(widths[one] <= widths[other] for one, other in pairwise(ordered))
    assert widths[ordered[-1]] > widths[ordered[0]]


def test_the_picture_has_no_ids_and_no_links(root: ElementTree.Element) -> None:
    assert root.tag == "svg" and root.get("role") == "img"
    assert not any(element.get("id") for element in root.iter())
    assert {element.tag for element in root.iter()} <= {
        "svg",
        "g",
        "title",
        "path",
        "polygon",
        "ellipse",
        "text",
        "rect",
    }
    assert not any("href" in key for element in root.iter() for key in element.attrib)


@pytest.mark.slow
@pytest.mark.parametrize("episodes", [samples.navigation, samples.cover_and_hide_met, samples.branching])
def test_state_names_do_not_cover_distances(episodes: Callable[[], tuple[Episode, ...]]) -> None:
    fspa, empty = episodes()[0].fspa, traffic([])
    svg = draw_automaton(fspa).svg
    assert svg is not None
    checked = 0
    for group in ElementTree.fromstring(picture(fspa, svg, empty, empty)).iter("g"):
        if group.get("data-states"):
            outline, *_, mark = group.iter("path")
            assert mark.get("stroke") == "none", "the distance"
            (name,) = group.findall("g[@class='badge name']/rect")
            x, y, width, height = (float(name.get(key, "nan")) for key in ("x", "y", "width", "height"))
            mark_left, mark_top, _, _ = extent(mark)
            left, top, right, _ = extent(outline)
            assert x + width <= mark_left or y + height <= mark_top
            assert left - 5 <= x and x + width <= right + 5 and y + height >= top - 5, "it is at its state"
            checked += 1
    assert checked == len(fspa.states)


def test_nodes_are_drawn_after_edges(root: ElementTree.Element) -> None:
    kinds = [(element.get("class") or "").split()[0] for graph in root for element in graph if element.get("class")]
    assert kinds == sorted(kinds) and {"edge", "node"} <= set(kinds)


def extent(path: ElementTree.Element) -> tuple[float, float, float, float]:
    numbers = [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", path.get("d") or "")]
    return min(numbers[::2]), min(numbers[1::2]), max(numbers[::2]), max(numbers[1::2])


def test_a_folded_run_of_states_is_one_group() -> None:
    (fspa,) = compile_text("clock 1 Hz  signal seen: bool  spec wait = F[0,9] seen")
    empty = traffic([])
    # Four episodes leave the run of states 2 to 9, each from a different state, to state 1.
    took = tuple(
        frozenset({(0, 2), *((state, state + 1) for state in range(2, last)), (last, 1)}) for last in range(2, 6)
    )
    counts = Traffic(5, {0: 5, 1: 5, 2: 4, 3: 3, 4: 2, 5: 1}, {}, (*took, frozenset({(0, 1)})))
    drawing = draw_automaton(fspa)
    assert drawing.svg is not None
    root = ElementTree.fromstring(picture(fspa, drawing.svg, counts, empty))
    groups = [(element.get("data-states") or "").split() for element in root.iter("g") if element.get("data-states")]
    assert sorted(int(state) for group in groups for state in group) == [state.id for state in fspa.states]
    (folded,) = [group for group in groups if len(group) > 1]
    texts = {
        (element.get("data-states") or "").split()[0]: [
            text.text for text in element.findall("g[@class='counts now']//text")
        ]
        for element in root.iter("g")
        if element.get("data-states")
    }
    assert texts[folded[0]][0] == "4"
    titles = [title.text or "" for title in root.iter("title")]
    (leaving,) = (title for title in titles if title.startswith("From state 2 to state 1;"))
    assert "; now: taken by 4 of 5 episodes" in leaving


def test_a_folded_run_counts_episodes_that_enter_at_any_of_its_states() -> None:
    with unfolded():
        (fspa,) = compile_text("clock 1 Hz  signal a: bool  signal b: bool  spec both = F[0,9] a & F[0,9] b")
    # The states in which one of the two atoms has not been true yet.
    inner = {state.id for state in folded_drawing(fspa).folded[4]}
    entering = [(edge.source, edge.target) for edge in fspa.edges if edge.source not in inner and edge.target in inner]
    assert len({target for _, target in entering}) == len(entering) == 7
    took = tuple(frozenset({edge}) for edge in entering)
    counts = Traffic(len(took), Counter(target for _, target in entering), {}, took)
    drawing = draw_automaton(fspa)
    assert drawing.svg is not None
    root = ElementTree.fromstring(picture(fspa, drawing.svg, counts, traffic([])))
    (group,) = (element for element in root.iter("g") if (element.get("data-states") or "").startswith("4 "))
    assert f"now: visited by {len(took)} of {len(took)} episodes" in (group.findtext("title") or "")


def test_an_edge_between_two_folded_runs_is_counted_at_the_drawn_edge() -> None:
    with unfolded():
        (fspa,) = compile_text("clock 1 Hz  signal a: bool  signal b: bool  spec both = F[0,9] a & F[0,9] b")
    folded = folded_drawing(fspa).folded
    ends = {run[-1].id: first for first, run in folded.items()}
    # The edges of the last states of the runs: beyond the own end, beyond the end of another run, to success.
    last_edges = [(edge.source, edge.target) for edge in fspa.edges if edge.source in ends]
    drawn_ends = {(edge.source, edge.target) for edge in folded_drawing(fspa).edges}
    crossing = [edge for edge in last_edges if (ends[edge[0]], edge[1]) not in drawn_ends]
    assert len(crossing) == 2
    drawing = draw_automaton(fspa)
    assert drawing.svg is not None
    for edge in crossing:
        counts = Traffic(1, {}, {}, (frozenset({edge}),))
        root = ElementTree.fromstring(picture(fspa, drawing.svg, counts, counts))
        titles = [title.text or "" for title in root.iter("title")]
        (taken,) = (title for title in titles if "taken by 1 of 1" in title)
        source, target = (int(word) for word in taken.partition(";")[0].split() if word.isdigit())
        assert source == ends[edge[0]] and target in folded and target != source


def test_a_layout_that_takes_too_long_gives_a_note(fspa: Fspa, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.regression.report.page.automaton._LAYOUT_LIMIT_S", 0.0)
    drawing = draw_automaton(fspa)
    assert drawing.svg is None
    assert drawing.notes == (f"The automaton with {len(fspa.states)} states is too tangled to be drawn in time.",)


def test_the_table_has_the_same_numbers(fspa: Fspa, now: Traffic, before: Traffic) -> None:
    table = ElementTree.fromstring(counts_table(fspa, now, before))
    # A label is there twice: in words, then in symbols.
    rows = [[next(cell.itertext()) for cell in row] for row in table.iter("tr")][1:]
    assert len(rows) == len(fspa.states)
    for state, row in zip(fspa.states, rows, strict=True):
        assert row[:2] == [str(state.id), label_text(fspa, state.id)]
        assert row[2] == f"{now.visited.get(state.id, 0)} of {now.episodes}"
        assert row[3] == f"{now.failed.get(state.id, 0)} of {now.episodes}"
        assert row[4] == f"{before.visited.get(state.id, 0)} of {before.episodes}"
