"""The rows of ``tltlc list levels``."""

from __future__ import annotations

from collections.abc import Iterator

from tltl_runtime.stealth.levels.file import changes, level_names, load_level, variants


def rows() -> Iterator[dict[str, str]]:
    """Yield a row for each variant of each level of the package.

    The value of ``doc`` is what the overlays of the variant change or, without overlays, what the
    level is about.
    """
    for name in level_names():
        for variant in variants(name):
            doc = " ".join(changes(name, variant)) or load_level(name, variant).doc
            yield {"name": name, "variant": variant, "doc": " ".join(doc.split())}
