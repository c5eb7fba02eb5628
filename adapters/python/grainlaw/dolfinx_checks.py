"""Layers of a ground of grainlaw.dolfinx_ground, and its checks. What is wrong raises ValueError, on all ranks
of a mesh."""
from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from mpi4py import MPI

from .arguments import number as real
from .arrays import Array
from .dolfinx import Elastic
from .material import AnyPath


class Layer(NamedTuple):
    bottom: float              #: height of its lower side [m]
    material: AnyPath | Elastic   #: a file, or a closed form, whose density is that of the whole
    solid: float               #: density of the grains [kg/m3]


def check_layers(domain: Any, surface: float, layers: Sequence[Layer], gravity: float) -> None:
    """What is wrong with layers."""
    if isinstance(layers, Layer) or not layers or not all(isinstance(layer, Layer) for layer in layers):
        raise ValueError(f"layers {layers!r}: expected a list of one Layer(bottom, material, solid) or more")
    tops = [surface] + [layer.bottom for layer in layers[:-1]]
    for number, (top, layer) in enumerate(zip(tops, layers)):
        if not real(f"layer {number}: bottom", layer.bottom) < top:
            raise ValueError(f"layer {number} from {top} m down to {layer.bottom} m, expected a depth above 0")
        if not real(f"layer {number}: density", layer.solid) > 0:
            raise ValueError(f"layer {number}: the density is {layer.solid} kg/m3, expected above 0")
        if not layer.material:
            raise ValueError(f"layer {number} has no material")
        if not isinstance(layer.material, (str, bytes, os.PathLike, Elastic)):
            raise ValueError(f"layer {number}: material {layer.material!r}, expected a file or an Elastic")
        if isinstance(layer.material, Elastic) and not (
                layer.material.young > 0 and -1 < layer.material.poisson < 0.5):
            raise ValueError(f"layer {number} of modulus {layer.material.young} Pa and Poisson ratio "
                             f"{layer.material.poisson}, expected above 0, and between -1 and 0.5")
    heights = domain.geometry.x[:, domain.topology.dim - 1]
    low, high = (domain.comm.allreduce(bound, op) for bound, op in (
        (heights.min(initial=np.inf), MPI.MIN), (heights.max(initial=-np.inf), MPI.MAX)))
    if low < layers[-1].bottom - 1e-9 or high > surface + 1e-9:
        raise ValueError(f"the mesh reaches from {low} to {high} m, expected within {layers[-1].bottom} and "
                         f"{surface} m: no material")
    if not gravity > 0:
        raise ValueError(f"gravity is {gravity} m/s2, expected above 0")


def check_pores(layers: Sequence[Layer]) -> None:
    for number, layer in enumerate(layers):
        if isinstance(layer.material, Elastic):
            raise ValueError(f"layer {number}, in closed form, has no pores: with water it may not be")


class Parts:
    """The parts of a mesh that hang together, by its unknowns.

    cells    global numbers of the unknowns of the cells of this rank (n, k)
    places   of the unknowns that this rank owns (n, d) [m]"""

    def __init__(self, comm: MPI.Intracomm, cells: npt.NDArray[np.int64], places: Array) -> None:
        self.comm = comm
        everywhere = comm.allgather((cells, places))
        cells, self._places = (np.concatenate([each[k] for each in everywhere]) for k in range(2))
        self._part = np.arange(len(self._places))
        while True:   # the smallest number of an unknown of each part
            smallest, former = self._part[cells].min(axis=1), self._part.copy()
            np.minimum.at(self._part, cells.ravel(), np.repeat(smallest, cells.shape[1]))
            if np.array_equal(self._part, former):
                break
        self._there = np.unique(self._part[cells])

    def check(self, has: npt.NDArray[np.bool_], text: str) -> None:
        """Raise ValueError with the place of a part none of whose unknowns is among those that this rank
        owns (n,), and the like of other ranks."""
        every = np.concatenate(self.comm.allgather(has))
        lacking = np.setdiff1d(self._there, self._part[every])
        if lacking.size:
            raise ValueError(text.format(place(self._places[lacking[0]])))


def tell_first(comm: MPI.Intracomm, wrong: npt.NDArray[np.bool_], text: Callable[[int], str]) -> None:
    """Raise ValueError on all ranks with the text of the first unknown that is wrong."""
    own = np.flatnonzero(wrong)
    texts = [told for told in comm.allgather(text(int(own[0])) if own.size else "") if told]
    if texts:
        raise ValueError(texts[0])


def place(x: Array) -> str:
    return "(" + ", ".join(f"{round(value, 12) + 0:g}" for value in x) + ") m"
