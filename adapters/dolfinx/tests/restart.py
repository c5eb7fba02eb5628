"""A test that is saved half way, or goes on from there:

    restart.py MATERIAL.toml FILE save|load|refused [OTHER.toml]

Prints P, A and u of each cell half way, by the cell's number, and the force on the top at the end.
"""
import os
import resource
import shutil
import sys
from types import SimpleNamespace
from unittest.mock import patch

import h5py
import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

import grainlaw
from grainlaw.dolfinx import Newton, Points, end_together, read_material

COMM = MPI.COMM_WORLD


def problem(material, divisions=3):
    domain = mesh.create_unit_square(COMM, divisions, divisions)
    V = fem.VectorFunctionSpace(domain, ("Lagrange", 2))
    top = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[1], 1))
    bottom = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[1], 0))
    moved = fem.Constant(domain, np.zeros(2))

    def move(load):
        moved.value = (2e-3 * load, -3e-3 * load)

    newton = Newton(Points(domain, material, degree=2), fem.Function(V),
                    [fem.dirichletbc(np.zeros(2), bottom, V), fem.dirichletbc(moved, top, V)], move,
                    lambda v: -100e3 * ufl.inner(ufl.FacetNormal(domain), v) * ufl.ds,
                    tolerance=1e-10)
    return newton, 2 * top + 1


def lines(newton):
    """P, A and u of the cells of all ranks, in hexadecimal."""
    points = newton.points
    answer = points.states.answer(grainlaw.Tangent.EXACT)
    kept = points._cells([newton.u, points.P, points.A]).unknowns
    count = len(points.cells)
    rows = np.concatenate([answer.P.reshape(count, 12), answer.A.reshape(count, 48), kept], axis=1)
    own = [f"{number} " + " ".join(value.hex() for value in row)
           for number, row in zip(points.cells.tolist(), rows.tolist())]
    return sorted(sum(COMM.allgather(own), []))


def refused(newton, path, status, words):
    before = lines(newton)
    try:
        newton.load(path)
    except grainlaw.Error as error:
        assert error.status == status and words in str(error), error
    else:
        raise AssertionError(f"{words}: not refused")
    assert lines(newton) == before


def cut(path):
    os.truncate(path, os.path.getsize(path) - 100)


def not_hdf5(path):
    with open(path, "r+b") as file:
        file.write(bytes(8))


def zeros(path):
    with h5py.File(path, "r+") as file:
        file["states"][...] = 0


def too_long(path):
    with h5py.File(path, "r+") as file:
        file["lengths"][...] = 2**40


def without(path):
    with h5py.File(path, "r+") as file:
        del file["starts"]


def unnamed(path):
    with h5py.File(path, "r+") as file:
        del file.attrs["format"]


def refuse(material, path, other):
    newton, _ = problem(material)
    with patch.dict(sys.modules, {"h5py": None}):
        refused(newton, path, grainlaw.Status.FILE_ERROR, "need h5py, which is not found")
    with patch.object(h5py, "get_config", lambda: SimpleNamespace(mpi=False)):
        refused(newton, path, grainlaw.Status.FILE_ERROR, "need an h5py with MPI")
    refused(newton, "nowhere.cells", grainlaw.Status.FILE_ERROR, "nowhere.cells")
    refused(problem(material, 2)[0], path, grainlaw.Status.BAD_ARGUMENT,
            "the checkpoint has 18 cells, expected 8")
    refused(problem(read_material(COMM, other))[0], path, grainlaw.Status.WRONG_MATERIAL, "of another material")
    with open(path, "rb") as file:
        saved = file.read()
    for damage, words in ((cut, "truncated file"), (not_hdf5, "file signature not found"), (zeros, "cell "),
                          (too_long, "the checkpoint's states are cut short"),
                          (without, "the checkpoint has no starts"),
                          (unnamed, "expected a checkpoint of cells")):
        damaged = f"{path}.damaged"
        if COMM.rank == 0:
            shutil.copy(path, damaged)
            damage(damaged)
        COMM.Barrier()
        refused(newton, damaged, grainlaw.Status.BAD_BYTES, words)
        COMM.Barrier()
        if COMM.rank == 0:
            os.unlink(damaged)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(saved) // 2, -1))
    try:
        newton.save(path)
    except grainlaw.Error as error:
        assert error.status == grainlaw.Status.FILE_ERROR and "File too large" in str(error), error
    else:
        raise AssertionError("a full disk: not told")
    with open(path, "rb") as file:
        assert file.read() == saved


def main(material_path, path, what, other=None):
    material = read_material(COMM, material_path)
    if what == "refused":
        refuse(material, path, other)
        return
    newton, top = problem(material)
    if what == "save":
        for load in (0, 0.25, 0.5):
            for _ in newton.to(load):
                pass
        newton.save(path)
    else:
        newton.load(path)
    half = lines(newton)
    for load in (0.75, 1):
        for _ in newton.to(load):
            pass
    force = newton.force(top)
    if COMM.rank == 0:
        print(*half, f"{force:.17g}", sep="\n")


if __name__ == "__main__":
    with end_together(COMM):
        main(*sys.argv[1:])
