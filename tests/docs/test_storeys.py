"""The picture of the storeys is up to date with the import contracts; `make generate` draws it again."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

from docs_site.storeys import dot, layers_by_package

_SVG = "{http://www.w3.org/2000/svg}"
IMAGES = Path(__file__).parents[2] / "docs" / "images"


def test_the_source_of_the_picture_is_drawn_from_the_contracts() -> None:
    assert (IMAGES / "storeys.dot").read_text(encoding="utf-8") == dot()


def test_the_picture_has_the_boxes_and_arrows_of_its_source() -> None:
    root = ET.parse(IMAGES / "storeys.svg").getroot()
    kinds = {"node", "edge", "cluster"}
    drawn_elements = {
        (group.attrib["class"], title.text)
        for group in root.iter(f"{_SVG}g")
        if group.attrib["class"] in kinds and (title := group.find(f"{_SVG}title")) is not None
    }
    source = (IMAGES / "storeys.dot").read_text(encoding="utf-8").replace('"', "")
    nodes = set(re.findall(r"^\s*([\w.]+) \[label=", source, re.MULTILINE))
    edges = {"->".join(ends) for ends in re.findall(r"([\w.]+) -> ([\w.]+)", source)}
    clusters = set(re.findall(r"subgraph (cluster_[\w.]+)", source))
    assert drawn_elements == {
        *(("node", name) for name in nodes),
        *(("edge", name) for name in edges),
        *(("cluster", name) for name in clusters),
    }


def test_each_module_of_a_contract_has_a_box() -> None:
    source = dot().replace('"', "")
    for package, layers in layers_by_package().items():
        for layer in layers:
            for module in layer:
                assert f"\t{package}.{module} [label=" in source
