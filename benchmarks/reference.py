"""The reference corpus: formulas over finite traces with cross-checked sizes and the peers' recorded times."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

TABLE = Path(__file__).with_name("reference.tsv")


@dataclass(frozen=True, slots=True)
class Reference:
    """A formula (``X`` strong, ``WX`` weak next), its size, and times in milliseconds recorded on one other machine.

    ``states`` is None if the automaton is too large to check explicitly. A time is None if the tool
    failed or ran out of time, or if only its wall time was recorded.
    """

    name: str
    family: str
    formula: str
    states: int | None
    spot_ms: float | None
    mona_ms: float | None


def references() -> list[Reference]:
    """Return all formulas, in the order of the file."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return [
            Reference(
                name=row["name"],
                family=row["family"],
                formula=row["formula"],
                states=int(row["states"]) if row["states"] else None,
                spot_ms=_number(row["spot_2_14_ms_in_process"]),
                mona_ms=_number(row["mona_1_4_cpu_ms"]),
            )
            for row in csv.DictReader(file, delimiter="\t")
        ]


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
