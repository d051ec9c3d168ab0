"""The rows of ``tltlc list levels``."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from tltl_runtime.game.level_name import parse_variant
from tltl_runtime.game.registry import STEALTH, game_named, shipped_levels


def rows(_add: Callable[..., object]) -> Iterator[dict[str, str]]:
    """Yield a row for each variant of each level of the package.

    ``doc`` says what the variant changes in the level. For a variant without changes, it says what the
    level is about.
    """
    level_files = game_named(STEALTH).level_files
    for name in shipped_levels():
        for variant in level_files.variants(name):
            doc = level_files.description(name, parse_variant(variant))
            yield {"name": name, "variant": variant, "doc": " ".join(doc.split())}
