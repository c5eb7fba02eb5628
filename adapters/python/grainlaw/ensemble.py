"""The same test of several packings: their mean, and how far they spread."""
from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import plots
from .arguments import several
from .arrays import Array
from .result import Result


class Ensemble:
    """Mean and standard deviation of results, row by row, over those that have the row.

        sand = [grainlaw.Material.parse(text.replace("seed = 1", f"seed = {k}")) for k in range(1, 7)]
        ensemble = grainlaw.laboratory.Ensemble(drained(one, strain=0.05) for one in sand)
        ensemble.mean["axial_stress"], ensemble.deviation["axial_stress"]
        ensemble.plot().savefig("drained.png")
    """

    results: list[Result]
    runs: npt.NDArray[np.intp]    #: (n,) results that have the row
    mean: dict[str, Array]        #: (n,) by the names of Result.columns()
    deviation: dict[str, Array]   #: (n,) standard deviation, of the draws; 0 of one result

    def __init__(self, results: Iterable[Result]) -> None:
        self.results = several("results", results, "several results of a test")
        for one in self.results:
            if not isinstance(one, Result):
                raise TypeError(f"results hold {one!r}: expected results of a test")
        tables = [one.columns() for one in self.results]
        if len(tables) < 2 or any(table.keys() != tables[0].keys() for table in tables):
            raise ValueError(f"{len(tables)} results: expected two or more, all of discs or all of "
                             "spheres")
        rows = np.arange(max(map(len, self.results)))
        there = np.array([rows < len(one) for one in self.results])
        self.runs = there.sum(axis=0)
        self.mean, self.deviation = {}, {}
        for name in tables[0]:
            values = np.zeros(there.shape)
            values[there] = np.concatenate([table[name] for table in tables])
            mean = values.sum(axis=0) / self.runs
            squares = (np.where(there, values - mean, 0.0)**2).sum(axis=0)
            self.mean[name] = mean
            self.deviation[name] = np.sqrt(squares / np.maximum(self.runs - 1, 1))

    def __len__(self) -> int:
        return len(self.runs)

    def __repr__(self) -> str:
        return f"<Ensemble of {len(self.results)} results, {self.runs[-1]} of them to the last row>"

    def columns(self) -> dict[str, Array]:
        """A table for numpy.savetxt or a data frame: runs, then of every column its mean by its name
        and its standard deviation as sd_NAME."""
        table: dict[str, Array] = {"runs": self.runs.astype(float)}
        for name, mean in self.mean.items():
            table |= {name: mean, f"sd_{name}": self.deviation[name]}
        return table

    def plot(self, shear: bool | None = None, kind: str = "history") -> Any:
        """As Result.plot, of the means: a history in a band of one standard deviation to either side, a
        path with the results as thin lines."""
        members = [one.columns() for one in self.results]
        return plots.draw(kind, self.mean, shear, self.deviation, members)
