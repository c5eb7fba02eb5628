# mypy: allow-untyped-calls
"""What a ground of grainlaw.dolfinx_ground writes: curves, fields for ParaView, and packings.

    write_curve(ground, 50, ("settlement[m]", "force[N/m]"), lambda done: (0.1 * done, ground.force(foot, 1)),
                "run.csv")                     # goes through the stage
    write_fields(ground, "run.xdmf")           # displacement, shear strain, void ratio, with water its pressure
    write_packing(ground, (0.1, -0.6), "near.vtp")

All functions are calls of all ranks together, and raise on all.
"""
from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import ufl
from dolfinx import fem, io
from mpi4py import MPI

from .arrays import Array
from .dolfinx_ground import Ground
from .files import write_whole
from .material import AnyPath
from .names import Measure
from .ranks import together

_io: Any = io

__all__ = ["cell_means", "shear_strain", "write_curve", "write_fields", "write_packing"]


def shear_strain(ground: Ground) -> Array:
    """Of the points of this rank (n,): root of (F11 - F22)^2 + (F12 + F21)^2, in 3D twice that of the
    deviator of grad u [-]."""
    d = ground.dimension
    H = ground.points.values(ufl.grad(ground.displacement())).reshape(-1, d, d)
    strain = (H + H.transpose(0, 2, 1)) / 2
    strain -= np.einsum("pii->p", strain)[:, None, None] * np.eye(d) / d
    shear: Array = np.sqrt(2) * np.linalg.norm(strain, axis=(1, 2))
    return shear


def cell_means(ground: Ground, values: Array, name: str) -> Any:
    """A function, constant in each cell, of the means of values (n,) of the points of this rank."""
    function = fem.Function(fem.FunctionSpace(ground.domain, ("DG", 0)), name=name)
    owned = ground.domain.topology.index_map(ground.dimension).size_local
    function.x.array[:owned] = values.reshape(owned, -1).mean(axis=1) if owned else 0
    function.x.scatter_forward()
    return function


def write_curve(ground: Ground, steps: int, columns: Sequence[str],
                measure: Callable[[float], Sequence[float]], path: AnyPath) -> None:
    """Go through a stage in equal steps. The CSV file has, whole after each, a row of the start and of every
    step: what measure(fraction of the stage) gives, under its columns "name[unit]", the imbalance, iterations
    and cuts, and the processor time of all ranks so far. Rank 0 prints the same."""
    text = ",".join([*columns, "residual[-],iterations[-],cuts[-],core_time[s]"]) + "\n"
    for step in range(steps + 1):
        solves = cuts = 0
        for part in ground.to(step / steps):
            solves, cuts = part.solves, part.cuts
        values, left = measure(step / steps), ground.imbalance()
        core = ground.comm.allreduce(time.process_time())
        row = ",".join(f"{value:.15g}" for value in values)
        text += f"{row},{left:.3g},{solves},{cuts},{core:.1f}\n"
        if ground.comm.rank == 0:
            told = ", ".join(f"{column.split('[')[0]} {value:.9g}" for column, value in zip(columns, values))
            print(f"{told}, out of balance {left:.1e}, {solves} iterations, {cuts} cuts", flush=True)
            write_whole(path, text)


def write_fields(ground: Ground, path: AnyPath) -> None:
    """Write displacement [m], shear strain [-], void ratio [-] (0: in closed form), 1 where cells have not
    left, and with water its pressure [Pa], to an XDMF file and its HDF5 file."""
    points = ground.points
    voids = np.zeros(len(points.layer))
    voids[points.grains] = points.states.measure(Measure.VOID_RATIO)
    moved = fem.Function(fem.VectorFunctionSpace(ground.domain, ("Lagrange", 1)), name="displacement")
    moved.interpolate(ground.displacement())
    fields = [moved, cell_means(ground, shear_strain(ground), "shear_strain"),
              cell_means(ground, voids, "void_ratio"), cell_means(ground, 1.0 - points.gone, "there")]
    if ground.water is not None:
        fields.append(ground.pore_pressure())
        fields[-1].name = "pore_pressure"
    with _io.XDMFFile(ground.comm, str(path), "w") as file:
        file.write_mesh(ground.domain)
        for field in fields:
            file.write_function(field)


def write_packing(ground: Ground, place: Sequence[float], path: AnyPath) -> None:
    """Write particles and contacts of the point of grains that is nearest to a place at first [m], as
    States.write_vtk."""
    grains = ground.points.grains
    away = np.linalg.norm(ground.points.x[grains] - np.asarray(place, float), axis=1)
    nearest, rank = ground.comm.allreduce((float(away.min(initial=np.inf)), ground.comm.rank), MPI.MINLOC)
    with together(ground.comm):
        if ground.comm.rank == rank and np.isfinite(nearest):
            ground.points.states.write_vtk(path, int(away.argmin()))
