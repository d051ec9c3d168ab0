"""The report on a suite as one self-contained HTML file."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from markupsafe import Markup

from tltl_runtime.game.palette import state_colour
from tltl_runtime.regression.report.page.automaton import AutomatonPicture, draw_automaton
from tltl_runtime.regression.report.page.case_data import case_data
from tltl_runtime.regression.report.page.case_section import case_section, not_run_section
from tltl_runtime.regression.report.page.contents import SuiteReport, maps_of
from tltl_runtime.regression.report.page.render import render
from tltl_runtime.regression.report.page.summary import provenance, summary
from tltl_runtime.regression.report.suite_summary import worst_first
from tltl_runtime.regression.suite.slugs import slugs
from tltl_runtime.support.markup import script_json
from tltlc.api import Fspa

_FOLDER: Final = Path(__file__).parent
_SCRIPTS: Final = ("packing.js", "level_map.js", "player.js", "report.js")


def html_report(suite: SuiteReport) -> str:
    """Render the page: verdicts, and for each case its automaton, map, curves and recordings.

    Equal reports give equal pages, unless the layout of an automaton hits its time limit.
    """
    names = slugs([*(case.report.name for case in suite.cases), *(case.name for case in suite.not_run)])
    pairs = list(zip(suite.cases, names, strict=False))
    not_run = zip(suite.not_run, names[len(pairs) :], strict=True)
    # Variants of a level share their spec, so lay out each automaton once.
    automata = {case.fspa: None for case in suite.cases}
    pictures: dict[Fspa | None, AutomatonPicture] = {
        fspa: draw_automaton(fspa) for fspa in automata if fspa is not None
    }
    maps = dict.fromkeys(filter(None, map(maps_of, suite.cases)))
    colours = {name: colour for drawn in maps for name, colour in drawn.colours().items()}
    script = "\n".join(_file_text(name) for name in _SCRIPTS)
    return render(
        "report.html",
        suite=suite.suite,
        digest=_digest(script),
        style=Markup(_style(colours)),
        has_maps=bool(maps),
        summary=summary(suite, names),
        sections=[
            *(
                case_section(case, slug, pictures.get(case.fspa))
                for _, (case, slug) in worst_first([(case.report, (case, slug)) for case, slug in pairs])
            ),
            *(not_run_section(case, slug) for case, slug in not_run),
        ],
        provenance=provenance(suite),
        data=script_json(_data([case_data(case, slug) for case, slug in pairs])),
        script=Markup(script),
    )


def _style(colours: Mapping[str, str]) -> str:
    style = _file_text("report.css")
    if not colours:
        return style
    properties = " ".join(f"--map-{name}: {colour};" for name, colour in colours.items())
    return f":root {{ {properties} }}\n{style}"


def _data(cases: list[dict[str, Any] | None]) -> dict[str, Any]:
    drawn_cases = [case for case in cases if case is not None]
    if not drawn_cases:
        return {"colours": [], "cases": []}
    states = max(len(case["states"]) for case in drawn_cases)
    return {"colours": list(map(state_colour, range(states))), "cases": drawn_cases}


def _file_text(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8").strip()


def _digest(script: str) -> str:
    """Return the SHA-256 of the page's script, in base64, for the page's content security policy.

    With this hash in the policy, a browser runs this script and no other. The hashed text includes
    the line feeds before and after the script.
    """
    return base64.b64encode(hashlib.sha256(f"\n{script}\n".encode()).digest()).decode()
