"""Tables of results: a pandas DataFrame where pandas is there, else a dictionary of arrays."""

from __future__ import annotations

import csv
import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING, Union

import numpy as np

if TYPE_CHECKING:
    import pandas

    Table = Union[pandas.DataFrame, dict[str, np.ndarray]]


def frame(columns: dict[str, np.ndarray]) -> Table:
    """Columns as a table."""
    if importlib.util.find_spec("pandas") is None:
        return columns
    import pandas

    return pandas.DataFrame(columns)


def read(path: Path) -> dict[str, np.ndarray]:
    """The columns of a CSV file, numbers to the bit; an empty cell is NaN, or empty text."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        names = next(rows, [])
        cells = list(zip(*rows)) or [()] * len(names)
    return {name: column(values, name) for name, values in zip(names, cells)}


def column(values: tuple[str, ...], name: str = "") -> np.ndarray:
    """Cells as whole numbers, truth values, numbers or text: the first that all of them are."""
    filled = [v for v in values if v]
    # Python reads 3_1 as the number 31
    if name == "warnings" or any("_" in v or v.strip() != v for v in filled):
        return np.array(values, dtype=object)
    if filled and all(v in ("true", "false") for v in filled) and len(filled) == len(values):
        return np.array([v == "true" for v in values])
    for kind in (int, float):
        try:
            numbers = [kind(v) for v in filled]
        except ValueError:
            continue
        if kind is int and (len(filled) < len(values) or not filled):
            continue
        ready = iter(numbers)
        return np.array([next(ready) if v else np.nan for v in values])
    return np.array(values, dtype=object)
