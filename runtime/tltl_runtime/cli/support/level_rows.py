"""What ``tltlc list levels`` lists."""

from __future__ import annotations

from collections.abc import Iterator

from tltl_runtime.stealth.levels.file import changes, level_names, load_level, variants


def rows() -> Iterator[dict[str, str]]:
    """The variants of the levels that come with the package: what a level is, and what the others change in it."""
    for name in level_names():
        for variant in variants(name):
            doc = " ".join(changes(name, variant)) or load_level(name, variant).doc
            yield {"name": name, "variant": variant, "doc": " ".join(doc.split())}
