"""Draw the storeys of the code from the import contracts: ``python -m docs_site.storeys FOLDER``.

Writes ``storeys.dot`` and ``storeys.svg``.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from tltlc.backends.drawing.layout import CHILD

_PROJECT: Final = Path(__file__).parent.parent / "pyproject.toml"

_SIDE_BY_SIDE: Final = " : "
"""Separates the modules of one layer, which do not import each other."""

_COMPILER: Final = "tltlc"
_STOREYS: Final = {"api": "façade", "interfaces": "interfaces", "tools": "tools"}
"""The frame around a layer of the compiler. The other layers are in the frame of the spine."""
_SPINE: Final = "spine"
_COLOURS: Final = {"façade": "#ede9fe", "interfaces": "#dbeafe", "tools": "#dcfce7", _SPINE: "#fef3c7"}
_OTHER: Final = "#f1f5f9"
"""The colour of modules that are not in the compiler's frame."""

_GRAPH: Final = {"rankdir": "TB", "fontname": "Helvetica", "fontsize": "13", "nodesep": "0.2", "ranksep": "0.2"}
_NODE: Final = {"shape": "box", "style": "filled,rounded", "fontname": "Helvetica", "fontsize": "12", "height": "0.3"}
_EDGE: Final = {"color": "#475569", "arrowsize": "0.6"}

Layers = list[list[str]]
"""Layers of modules, the highest first; a module may import those of lower layers."""


def main() -> None:
    """Write the picture and its source to the folder that the first argument names."""
    folder = Path(sys.argv[1])
    source = dot()
    command = [sys.executable, str(CHILD), "svg", "dot"]
    picture = subprocess.run(command, input=source.encode(), capture_output=True, check=True).stdout
    (folder / "storeys.dot").write_text(source, encoding="utf-8")
    (folder / "storeys.svg").write_bytes(picture)


def dot() -> str:
    """Return the picture in the DOT language: a frame for each package that has layers."""
    from graphviz import Digraph

    picture = Digraph("storeys", graph_attr=_GRAPH, node_attr=_NODE, edge_attr=_EDGE)
    for package, layers in layers_by_package().items():
        with _frame(picture, package, package) as frame:
            _draw_modules(frame, package, layers)
            _draw_arrows(frame, package, layers)
    return str(picture.source)


def layers_by_package() -> dict[str, Layers]:
    """Return the layers of each package, from the import contracts of the project file."""
    return {package: layers for contract in _contracts() for package, layers in _layers_of(contract)}


def _contracts() -> list[Mapping[str, Any]]:
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    project = tomllib.loads(_PROJECT.read_text(encoding="utf-8"))
    contracts: list[Mapping[str, Any]] = project["tool"]["importlinter"]["contracts"]
    return contracts


def _layers_of(contract: Mapping[str, Any]) -> Iterator[tuple[str, Layers]]:
    if contract["type"] == "layers":
        layers = [layer.split(_SIDE_BY_SIDE) for layer in contract["layers"]]
        yield from ((package, layers) for package in contract["containers"])


def _frame(picture: Any, name: str, label: str) -> Any:
    attributes = {"label": label, "color": "#94a3b8", "style": "rounded"}
    return picture.subgraph(name=f"cluster_{name}", graph_attr=attributes)


def _draw_modules(frame: Any, package: str, layers: Layers) -> None:
    """Draw each module as a box. In the compiler, put the modules of each storey in a frame."""
    modules = [module for layer in layers for module in layer]
    if package != _COMPILER:
        for module in modules:
            frame.node(f"{package}.{module}", label=module, fillcolor=_OTHER)
        return
    for storey, colour in _COLOURS.items():
        with _frame(frame, f"{package}_{storey}", storey) as inner:
            for module in modules:
                if _STOREYS.get(module, _SPINE) == storey:
                    inner.node(f"{package}.{module}", label=module, fillcolor=colour)


def _draw_arrows(frame: Any, package: str, layers: Layers) -> None:
    """Draw an arrow from each module to each module of the layer below."""
    for layer, below in pairwise(layers):
        for module in layer:
            for lower in below:
                frame.edge(f"{package}.{module}", f"{package}.{lower}")


if __name__ == "__main__":
    main()
