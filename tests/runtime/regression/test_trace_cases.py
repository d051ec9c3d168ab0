"""Cases of recorded traces: verdicts, sentences, reports and errors, without a game."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.waiting import HANG_S
from tltl_runtime.cli.support.trace_options import spec_label
from tltl_runtime.regression.explain.explain import findings
from tltl_runtime.regression.report.trace_curves import example_curves
from tltl_runtime.regression.suite.suite import read_suite
from tltl_runtime.regression.suite.trace_case import TraceCase
from tltl_runtime.regression.verdict.judged_traces import judge_traces
from tltlc.diagnostics.diagnostic import TltlError

Run = Callable[..., Outcome]

SPEC = """clock 10 Hz
signal on_lava: bool
signal has_key: bool
signal at_exit: bool

spec fetch { reach has_key then at_exit  avoid on_lava }
"""

WON = ["000", "010", "011"]
BURNT = ["000", "100", "110", "011"]
SHORT = ["000", "010"]


def write_traces(folder: Path, *kinds: tuple[int, Sequence[str]]) -> Path:
    """Write traces into a new folder. Each kind is a count and the rows of a trace; a row has a digit per signal."""
    folder.mkdir(parents=True)
    rows = [rows for count, rows in kinds for _ in range(count)]
    for number, trace in enumerate(rows):
        lines = [f"{step / 10:.1f},{','.join(digits)}" for step, digits in enumerate(trace)]
        text = "\n".join(["time,on_lava,has_key,at_exit", *lines]) + "\n"
        (folder / f"{number:03}.csv").write_text(text, encoding="utf-8")
    return folder


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder, as the current one, with a spec, traces of an old build, and traces of a new build in which the
    lava burns players."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "fetch.tltl").write_text(SPEC, encoding="utf-8")
    write_traces(tmp_path / "old", (95, WON), (5, SHORT))
    write_traces(tmp_path / "new", (30, WON), (65, BURNT), (5, SHORT))
    return tmp_path


def regress(tltlc: Run, *words: str) -> Outcome:  # noqa: F811
    return tltlc("regress", "--spec", "fetch.tltl", *words)


def cases(outcome: Outcome) -> str:
    """The printed lines of the cases, without the sentence above them."""
    return outcome.out.partition("\n")[2]


def test_equal_traces_pass(tltlc: Run, here: Path) -> None:  # noqa: F811
    result = regress(tltlc, "--baseline", "old", "--now", "old")
    assert result.status == 0
    assert result.out == (
        "The set of traces is as before\n"
        "fetch  pass     95 of 100   95%  progress  0.975 ( 0.975)  reward  0.975 ( 0.975)\n"
        "1 case: 1 pass\n"
    )
    assert "wrote regression/fetch/report.html" in result.err


def test_a_broken_build_fails_and_the_clause_is_named(tltlc: Run, here: Path) -> None:  # noqa: F811
    result = regress(tltlc, "--baseline", "old", "--now", "new")
    assert result.status == 1
    sentence, first, *reasons, last = result.out.splitlines()
    assert sentence == "70 of 100 traces do not meet the spec; before: 5 of 100"
    assert first.startswith("fetch  fail     30 of 100")
    assert last == "1 case: 1 fail"
    assert "    met in 30 of 100 traces (30%), before in 95 of 100 (95%): certainly in less than 50%" in reasons
    (burnt,) = (reason for reason in reasons if reason.startswith("    breaks"))
    assert burnt == reasons[0]
    assert burnt.strip().startswith(
        "breaks `avoid on_lava` at step 2 (0.1 s) in 65 of 100 traces (65%); before: in 0 of 100 traces; "
    )
    (short,) = (reason for reason in reasons if "ends before" in reason)
    assert short.strip().startswith(
        "ends before `reach has_key then at_exit` is met in 5 of 100 traces (5%); before: in 5 of 100 traces (5%)"
    )


def test_the_sentence_counts_the_traces_that_break_the_spec(tltlc: Run, here: Path) -> None:  # noqa: F811
    write_traces(here / "clean", (30, WON))
    write_traces(here / "burnt", (10, WON), (20, BURNT))
    result = regress(tltlc, "--baseline", "clean", "--now", "burnt")
    sentence, first, *_ = result.out.splitlines()
    assert sentence == "20 of 30 traces break the spec; before: none"
    assert first.startswith("fetch  review   10 of 30")
    assert "    `burnt/010.csv`: breaks `avoid on_lava` at step 2 of 4 (0.1 s)\n" in result.out
    assert result.out.count("`: breaks") == 5 and "\n    and 15 more\n" in result.out


@pytest.mark.parametrize("passes", [False, True])
def test_traces_that_break_different_rules_are_named_with_rule_and_step(
    passes: bool,
    tltlc: Run,  # noqa: F811
    here: Path,
) -> None:
    count = 198 if passes else 28
    write_traces(here / "clean", (count + 2, WON))
    write_traces(here / "mixed", (count, WON), (1, BURNT), (1, SHORT))
    files = ("--junit", "report.xml", "--github")
    result = regress(tltlc, "--baseline", "clean", "--now", "mixed", *files)
    assert cases(result).startswith("fetch  pass " if passes else "fetch  review ")
    lines = [
        f"`mixed/{count:03}.csv`: breaks `avoid on_lava` at step 2 of 4 (0.1 s)",
        f"`mixed/{count + 1:03}.csv`: `reach has_key then at_exit` is not met after 2 steps",
    ]
    printed, _, annotation = result.out.partition("\n::")
    assert [line.strip() for line in printed.splitlines() if line.startswith("    `")] == lines
    assert "%0A".join(lines) in annotation
    texts = [element.text or "" for element in ET.parse(here / "report.xml").getroot().iter()]
    assert any("\n".join(lines) in text for text in texts)


def test_fewer_than_25_traces_need_a_review(tltlc: Run, here: Path) -> None:  # noqa: F811
    write_traces(here / "few", (24, WON))
    result = regress(tltlc, "--baseline", "old", "--now", "few")
    assert result.status == 1
    assert cases(result).startswith("fetch  review   24 of 24")
    assert "    only 24 traces: a verdict needs 25\n" in result.out
    result = regress(tltlc, "--baseline", "few", "--now", "old")
    assert "    only 24 traces in the baseline: a verdict needs 25\n" in result.out


def test_a_trace_that_cannot_be_judged_needs_a_review(tltlc: Run, here: Path) -> None:  # noqa: F811
    (here / "old" / "bad.csv").write_text("time,on_lava,has_key\n0.0,0,0\n", encoding="utf-8")
    result = regress(tltlc, "--baseline", "old", "--now", "old")
    assert cases(result).startswith("fetch  review   95 of 100")
    assert result.out.startswith("5 of 100 traces do not meet the spec; before: 5 of 100; 1 cannot be judged\n")
    assert "1 of 101 traces cannot be judged: first `old/bad.csv` (old/bad.csv:1: TLT0" in result.out
    assert "1 of 101 traces of the baseline cannot be judged" in result.out


@pytest.mark.parametrize(("baseline", "now"), [("old", "bad"), ("bad", "old")])
def test_without_a_trace_that_can_be_judged_a_review_is_needed(
    baseline: str,
    now: str,
    tltlc: Run,  # noqa: F811
    here: Path,
) -> None:
    (here / "bad").mkdir()
    (here / "bad" / "bad.csv").write_text("time\n0.0\n", encoding="utf-8")
    result = regress(tltlc, "--baseline", baseline, "--now", now)
    assert (result.status, cases(result).splitlines()[0]) == (1, "fetch  review")
    assert "1 of 1 traces" in result.out


def test_a_folder_of_a_suite_without_a_trace_fails(tltlc: Run, here: Path) -> None:  # noqa: F811
    (here / "empty").mkdir()
    suite_file(here, '[[case]]\nspec = "fetch.tltl"\ntraces = "empty"\nbaseline = "old"\n')
    result = tltlc("regress", "suite.toml")
    assert result.status == 1
    assert "TLT0001, the folder `empty` contains no trace" in result.out


@pytest.mark.parametrize(("burnt", "unread", "verdict"), [(30, 100, "review"), (60, 2, "fail")])
def test_traces_that_cannot_be_judged_may_meet_the_spec(
    burnt: int,
    unread: int,
    verdict: str,
    tltlc: Run,  # noqa: F811
    here: Path,
) -> None:
    """A fail stands only if it is one even with all of these traces counted as met."""
    folder = write_traces(here / "hidden", (burnt, BURNT))
    for number in range(unread):
        (folder / f"unread{number}.csv").write_text("time\n0.0\n", encoding="utf-8")
    result = regress(tltlc, "--baseline", "old", "--now", "hidden", "--json", "report.json")
    assert cases(result).startswith(f"fetch  {verdict} ")
    (case,) = json.loads((here / "report.json").read_text(encoding="utf-8"))["cases"]
    assert case["certain"] == (verdict == "fail")
    assert case["rate_interval"][1] > unread / (burnt + unread)
    if verdict == "review":
        assert case["headline"].startswith("100 of 130 traces cannot be judged")


def test_files_that_are_no_traces_are_named(tltlc: Run, here: Path) -> None:  # noqa: F811
    (here / "old" / "notes.txt").write_text("played by Ana\n", encoding="utf-8")
    result = regress(tltlc, "--baseline", "old", "--now", "new")
    assert "fetch: not traces, by their names: old/notes.txt\n" in result.err


def test_warnings_of_traces_are_counted(tltlc: Run, here: Path) -> None:  # noqa: F811
    spec = SPEC.replace("spec fetch {", "signal heat in [0, 1]\nspec fetch { keep heat > 0.1")
    (here / "fetch.tltl").write_text(spec, encoding="utf-8")
    header = "time,on_lava,has_key,at_exit,heat"
    folder = here / "hot"
    folder.mkdir()
    for number in range(30):
        rows = [f"{step / 10:.1f},{','.join(digits)},{1.5 if number < 2 else 1}" for step, digits in enumerate(WON)]
        (folder / f"{number:03}.csv").write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    result = regress(tltlc, "--baseline", "hot", "--now", "hot", "--json", "report.json")
    (case,) = json.loads((here / "report.json").read_text(encoding="utf-8"))["cases"]
    assert cases(result).startswith("fetch  pass")
    assert any(
        reason.startswith("2 of 30 traces have warnings: first `hot/000.csv` (TLT0") for reason in case["reasons"]
    )


def test_json_lines_are_judged(tltlc: Run, here: Path) -> None:  # noqa: F811
    folder = here / "lines"
    folder.mkdir()
    for number in range(30):
        rows = [
            {"time": step / 10, "on_lava": int(lava), "has_key": int(key), "at_exit": int(at_exit)}
            for step, (lava, key, at_exit) in enumerate(WON)
        ]
        (folder / f"{number:03}.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    assert cases(regress(tltlc, "--baseline", "old", "--now", "lines")).startswith("fetch  pass     30 of 30")


def test_the_thresholds_can_be_set(tltlc: Run, here: Path) -> None:  # noqa: F811
    words = ("--baseline", "new", "--now", "new")
    assert cases(regress(tltlc, *words)).startswith("fetch  fail ")
    assert cases(regress(tltlc, *words, "--pass-rate", "0.15", "--fail-rate", "0.1")).startswith("fetch  pass ")
    rejected = regress(tltlc, *words, "--pass-rate", "0.3")
    message = "--fail-rate is 0.5, above --pass-rate, 0.3: give --fail-rate a value of at most 0.3"
    assert (rejected.status, message in " ".join(rejected.err.split())) == (2, True), rejected.err


def test_a_trace_ends_at_the_goal_unless_it_is_judged_as_a_whole(tltlc: Run, here: Path) -> None:  # noqa: F811
    write_traces(here / "longer", (40, [*WON, "100"]))
    words = ("--baseline", "longer", "--now", "longer")
    assert cases(regress(tltlc, *words)).startswith("fetch  pass     40 of 40")
    assert cases(regress(tltlc, *words, "--judged-as", "traces")).startswith("fetch  fail      0 of 40")


def test_a_trace_that_takes_longer_than_the_limit_fails(tltlc: Run, here: Path) -> None:  # noqa: F811
    (here / "fetch.tltl").write_text(SPEC.replace("avoid", "limit 2 steps  avoid"), encoding="utf-8")
    result = regress(tltlc, "--baseline", "old", "--now", "old")
    assert cases(result).startswith("fetch  fail      0 of 100")
    assert "reaches the limit before `reach has_key then at_exit` is met in 100 of 100 traces" in result.out


def test_earlier_failures_at_another_stage_are_not_denied(tltlc: Run, here: Path) -> None:  # noqa: F811
    """In both builds, as many players burn; in the new one, they have the key already."""
    write_traces(here / "early", (70, WON), (30, ["000", "100"]))
    write_traces(here / "late", (70, WON), (30, ["000", "010", "110"]))
    result = regress(tltlc, "--baseline", "early", "--now", "late")
    (burnt,) = (line.strip() for line in result.out.splitlines() if line.startswith("    breaks"))
    assert burnt.startswith(
        "breaks `avoid on_lava` at step 3 (0.2 s) before it makes `at_exit` true in 30 of 100 traces (30%); "
    )


@pytest.mark.parametrize(
    ("words", "code", "status"),
    [
        (("--baseline", "old", "--now", "gone"), "TLT0001", 3),
        (("--baseline", "gone", "--now", "old"), "TLT0001", 3),
        (("--baseline", "old", "--now", "empty"), "TLT0001", 3),
        (("--spec", "gone.tltl", "--baseline", "old", "--now", "old"), "TLT0001", 3),
        (("--spec", "fetch.tltl:gone", "--baseline", "old", "--now", "old"), "TLT0720", 2),
    ],
)
def test_a_name_that_does_not_exist_is_an_error_and_no_verdict(
    words: Sequence[str],
    code: str,
    status: int,
    tltlc: Run,  # noqa: F811
    here: Path,
) -> None:
    (here / "empty").mkdir()
    result = regress(tltlc, *words)
    assert (result.status, result.out, code in result.err) == (status, "", True), result.err
    assert not (here / "regression").exists()


def test_all_traces_are_compared_whatever_their_order(here: Path) -> None:
    """Recordings have no seeds in common, so the first of them are no pairs."""
    write_traces(here / "sorted", (95, SHORT), (205, WON))
    case = TraceCase("it", "fetch.tltl", ("old",), ("sorted",))
    judged = judge_traces(case, 0.05, 1, lambda *_: None)
    assert judged.judgement is not None
    assert [change.figure for change in judged.judgement.changes] == ["progress"]
    assert judged.judgement.changes[0].before == pytest.approx((95 * 0.5 + 205) / 300, abs=0.05)


def test_the_reports_have_the_same_verdict(tltlc: Run, here: Path) -> None:  # noqa: F811
    files = ("--json", "report.json", "--junit", "report.xml", "--html", "report.html", "--github")
    result = regress(tltlc, "--baseline", "old", "--now", "new", *files)
    sentence, annotation = (line for line in result.out.splitlines() if line.startswith("::"))
    assert sentence == "::notice title=fetch::70 of 100 traces do not meet the spec; before: 5 of 100"
    assert annotation.startswith(
        "::error file=fetch.tltl,title=fetch%3A fail::breaks `avoid on_lava` at step 2 (0.1 s)"
    )
    assert "met in 30 of 100 traces" in annotation
    document = json.loads((here / "report.json").read_text(encoding="utf-8"))
    (case,) = document["cases"]
    assert (case["verdict"], case["spec"], case["episodes"], case["pass_rate"]) == ("fail", "fetch", 100, 0.3)
    assert case["traces"]["now"]["names"][:2] == ["new/000.csv", "new/001.csv"]
    assert case["accounts"][30]["by"] == ["avoid on_lava"]
    (failure,) = ET.parse(here / "report.xml").getroot().iter("failure")
    assert str(failure.get("message")).startswith(
        "fail: breaks `avoid on_lava` at step 2 (0.1 s) in 65 of 100 traces (65%)"
    )
    page = (here / "report.html").read_text(encoding="utf-8")
    assert "100 recorded traces of new · compared with 100 recorded traces of old · spec fetch" in page
    assert page.count('<figure class="trace"') == 7
    assert "<title>on_lava holds at step 2</title>" in page
    assert page.count('class="stay violated') == 3
    assert "On the map" not in page


def suite_file(here: Path, text: str) -> Path:
    (here / "suite.toml").write_text(text, encoding="utf-8")
    return here / "suite.toml"


SUITE = """
[[case]]
name = "lava"
spec = "fetch.tltl:fetch"
traces = "new"
baseline = ["old"]
thresholds = { pass_rate = 0.9 }

[[case]]
spec = "fetch.tltl"
traces = ["old"]
baseline = "old"
judged_as = "traces"
thresholds = { pass_rate = 0.8 }
"""


def test_the_default_name_is_that_of_the_folder_or_file(here: Path) -> None:
    for name in ("1.2.3", "1.2.4"):
        write_traces(here / "v" / name, (1, WON))
    rows = [f'[[case]]\nspec = "fetch.tltl"\nbaseline = "old"\ntraces = "{name}"\n' for name in NAMED]
    assert [case.name for case in read_suite(suite_file(here, "".join(rows))).cases] == list(NAMED.values())


NAMED = {"v/1.2.3": "1.2.3", "v/1.2.4": "1.2.4", "old/000.csv": "000"}


@pytest.mark.parametrize(
    ("spec", "label"),
    [("a b.v1.tltl", "a b.v1"), ("x/fetch.tltl:fast", "fast"), ("fetch.fspa.json", "fetch"), (".tltl", "spec")],
)
def test_the_case_is_called_after_the_spec(spec: str, label: str) -> None:
    assert spec_label(spec) == label


def test_a_long_trace_has_a_small_picture(tltlc: Run, here: Path) -> None:  # noqa: F811
    folder = write_traces(here / "long", (1, ["000", "001"] * 20_000))
    for number in range(1, 26):
        (folder / f"{number:03}.csv").write_text((here / "old" / "000.csv").read_text(encoding="utf-8"))
    regress(tltlc, "--baseline", "old", "--now", "long", "--html", "report.html")
    page = (here / "report.html").read_text(encoding="utf-8")
    assert "long/000.csv" in page
    assert len(page) < 500_000


def test_a_trace_that_changes_after_the_judgement_is_not_drawn(here: Path) -> None:
    judged = judge_traces(TraceCase("it", "fetch.tltl", ("new",), ("old",)), 0.05, 1, lambda *_: None)
    explanation = findings(None, judged.fspa, judged.now.episodes, judged.before.episodes)
    drawn = example_curves(judged, explanation)
    assert {"new/000.csv", "new/030.csv"} <= {curves.name for curves in drawn.values()}
    (here / "new" / "030.csv").write_text((here / "new" / "000.csv").read_text(encoding="utf-8"))
    (here / "new" / "031.csv").unlink()
    left = {curves.name for curves in example_curves(judged, explanation).values()}
    assert left == {curves.name for curves in drawn.values()} - {"new/030.csv", "new/031.csv"}


def test_no_baseline_is_recorded_for_traces(tltlc: Run, here: Path) -> None:  # noqa: F811
    suite_file(here, SUITE)
    result = tltlc("baseline", "suite.toml")
    assert (result.status, result.err) == (0, "nothing to record: the baselines of the suite are recorded traces\n")
    assert not (here / "suite.baseline.json").exists()


def test_a_suite_lists_traces(tltlc: Run, here: Path) -> None:  # noqa: F811
    suite = suite_file(here, SUITE)
    first, second = read_suite(suite).cases
    assert isinstance(first, TraceCase)
    assert isinstance(second, TraceCase)
    assert (first.name, first.thresholds.pass_rate, first.as_episodes) == ("lava", 0.9, True)
    assert (second.name, second.as_episodes) == ("old", False)
    result = tltlc("regress", "suite.toml")
    assert [line.split()[:2] for line in result.out.splitlines() if line[0] != " "][1:3] == [
        ["lava", "fail"],
        ["old", "pass"],
    ]
    for name in ("new/003.csv", "new/removed.csv", "new"):
        changed = tltlc("regress", "suite.toml", "--changed", name)
        assert cases(changed).startswith("lava  fail"), name
        assert "left out, because it depends on none of the named files: old" in changed.err


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        ('[[case]]\nspec = "fetch.tltl"\ntraces = "new"\n', "TLT0803", "`[[case]]` has `traces`, but lacks `baseline`"),
        ('[[case]]\ntraces = "new"\nbaseline = "old"\n', "TLT0803", "`[[case]]` lacks `spec`"),
        (
            '[[case]]\nspec = "fetch.tltl"\ntraces = "newer"\nbaseline = "old"\n',
            "TLT0805",
            "there is no file or folder `newer`",
        ),
        ('[[case]]\nspec = "f.tltl"\ntraces = "new"\nbaseline = "old"\n', "TLT0805", "there is no spec `f.tltl`"),
        (
            '[[case]]\nspec = "fetch.tltl"\ntraces = "new"\nbaseline = "old"\nlevel = "navigation"\n',
            "TLT0802",
            "`[[case]]` has no key `level`",
        ),
        (
            '[[case]]\nspec = "fetch.tltl"\ntraces = []\nbaseline = "old"\n',
            "TLT0803",
            "`traces`",
        ),
        (
            '[[case]]\nspec = "fetch.tltl"\ntraces = "new"\nbaseline = ["old", ""]\n',
            "TLT0803",
            "`baseline`",
        ),
        (
            '[[case]]\nspec = "fetch.tltl:gone"\ntraces = "new"\nbaseline = "old"\n',
            "TLT0720",
            "gone",
        ),
    ],
)
def test_errors_of_a_suite(text: str, code: str, message: str, here: Path) -> None:
    with pytest.raises(TltlError) as caught:
        read_suite(suite_file(here, text))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == code
    assert message in diagnostic.title


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--spec", "fetch.tltl", "--now", "new"), "--spec needs --baseline"),
        (("--spec", "fetch.tltl", "--baseline", "old"), "--spec needs --now"),
        (("--now", "new"), "--now works only with --spec"),
        (("--pass-rate", "0.5"), "--pass-rate works only with --spec"),
        (("--judged-as", "traces"), "in a suite, write it as a key of the case"),
        (
            ("suite.toml", "--spec", "fetch.tltl", "--now", "new", "--baseline", "old"),
            "leave out `suite.toml`; put several traces into one folder",
        ),
        (("--spec", "fetch.tltl", "--now", "new", "--baseline", "old", "--retrain"), "leave out --retrain"),
        (("--spec", "fetch.tltl", "--now", "new", "--baseline", "old", "--fresh"), "leave out --fresh"),
        (("--spec", "", "--now", "new", "--baseline", "old"), "--spec is empty"),
        (("--spec", "fetch.tltl", "--now", "", "--baseline", "old"), "it is empty"),
        (("suite.toml", "--baseline", "old"), "--baseline has no effect"),
        (("suite.toml", "--retrain"), "--retrain has no effect"),
    ],
)
def test_options_that_do_not_fit_together(words: Sequence[str], message: str, tltlc: Run, here: Path) -> None:  # noqa: F811
    suite_file(here, SUITE)
    result = tltlc("regress", *words)
    assert (result.status, message in result.err) == (2, True), result.err


def test_traces_are_judged_without_a_game(here: Path) -> None:
    """Neither the game's physics nor its pictures are needed, nor what trains."""
    hidden = ["pybullet", "torch", "rsl_rl", "pygame", "matplotlib", "imageio_ffmpeg"]
    program = (
        f"import sys; sys.modules.update(dict.fromkeys({hidden})); from tltlc.interfaces.cli.main import main; "
        "main('regress --spec fetch.tltl --baseline old --now old'.split())"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=here, capture_output=True, text=True, timeout=HANG_S, check=False
    )
    assert (done.returncode, done.stderr.splitlines()) == (
        0,
        ["fetch: 200 traces are judged", "fetch: pass", "wrote regression/fetch/report.html: open it in a browser"],
    )
