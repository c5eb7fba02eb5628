"""States of the cells of a mesh in one HDF5 file, which any number of ranks writes and reads, found by
the cells' numbers in the input mesh. Needs mpi4py and h5py, on several ranks one with MPI (Debian:
python3-h5py-mpi).

The file: attributes of the root "format" (a text), "version", "points" of a cell, "fingerprint" of the
material, "load"; datasets "unknowns" (cells, k), "lengths" (cells, points), which are those of the bytes
of each point (0: it has no state), "starts" (cells,), where those of a cell begin in "states" (bytes,).
"""
from __future__ import annotations

import contextlib
import itertools
import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from mpi4py import MPI

from .abi import Error, bad_argument
from .arrays import Array
from .material import AnyPath
from .names import Status
from .points import States
from .ranks import together

_FORMAT, _VERSION = "grainlaw states of cells", 2


@dataclass
class Cells:
    """The points of the cells that a rank owns, and the unknowns at these cells."""

    comm: MPI.Intracomm
    states: States                   #: by cell, points_per_cell of each
    numbers: npt.NDArray[np.int64]   #: (n,) of the cells in the whole mesh, from 0
    total: int                       #: cells of the whole mesh
    points_per_cell: int
    unknowns: Array                  #: (n, k) values that belong to these cells, k on all ranks
    state: npt.NDArray[np.int64]     #: (n, points_per_cell) number of each point's state; -1: it has none

    def save(self, path: AnyPath, load: float = 0.0) -> None:
        """Write the committed states of all ranks to one file, with the load that they belong to. The
        file is the old one or the whole new one; on an Error, raised on all ranks, the old one."""
        comm = self.comm
        lengths = np.array([self._lengths(k) for k in range(len(self.numbers))],
                           np.uint64).reshape(-1, self.points_per_cell)
        sizes = lengths.sum(axis=1)
        starts = (comm.exscan(int(sizes.sum())) or 0) + np.cumsum(sizes) - sizes
        every, width = comm.allreduce(int(sizes.sum())), self.unknowns.shape[1]
        new = comm.bcast(f"{os.path.realpath(path)}.{os.getpid()}.new", root=0)
        try:
            _reserve(comm, new, every + 8 * self.total * (width + self.points_per_cell + 1) + 8192)
            with _opened(comm, new, "w") as file:
                self._head(file, load)
                unknowns = file.create_dataset("unknowns", (self.total, width), "<f8")
                table = file.create_dataset("lengths", (self.total, self.points_per_cell), "<u8")
                begins = file.create_dataset("starts", (self.total,), "<u8")
                states = file.create_dataset("states", (every,), "u1")
                with together(comm):
                    for k, number in enumerate(self.numbers.tolist()):
                        start = int(starts[k])
                        _write(begins, number, start)
                        _write(table, number, lengths[k])
                        _write(unknowns, number, self.unknowns[k])
                        data = np.frombuffer(b"".join(self._saved(k)), np.uint8)
                        _write(states, slice(start, start + data.size), data)
            with together(comm):
                if comm.rank == 0:
                    os.replace(new, path)
        except Exception:
            if comm.rank == 0:
                with contextlib.suppress(OSError):
                    os.unlink(new)
            raise

    def load(self, path: AnyPath) -> float:
        """Replace the committed states and `unknowns` by those of a file, on all ranks or, on an Error,
        on none. The load that they belong to."""
        fresh = self.states.clone()   # of all materials
        unknowns = np.empty_like(self.unknowns)
        with _opened(self.comm, os.fspath(path), "r") as file, together(self.comm):
            load = self._check(file)
            for k, number in enumerate(self.numbers.tolist()):
                try:
                    unknowns[k] = _read(file, "unknowns", number)
                    lengths = _read(file, "lengths", number)
                    if not np.array_equal(lengths > 0, self.state[k] >= 0):
                        raise ValueError("its points are of other layers")
                    ends = list(itertools.accumulate(lengths[lengths > 0].tolist()))
                    start = int(_read(file, "starts", number))
                    data = _read(file, "states", slice(start, start + sum(ends[-1:]))).tobytes()
                    saved = [data[begin:end] for begin, end in zip([0, *ends], ends)]
                    fresh.load_some(self._points(k), saved)
                except (Error, OSError, ValueError) as error:
                    status = getattr(error, "status", Status.BAD_BYTES)
                    text = getattr(error, "message", str(error))
                    raise Error(status, f"{path}, cell {number}: {text}") from None
        everything = np.arange(len(fresh))
        self.states.clone_some(everything, fresh, everything)
        self.unknowns[:] = unknowns
        return load

    def _points(self, k: int) -> npt.NDArray[np.int64]:
        here: npt.NDArray[np.int64] = self.state[k][self.state[k] >= 0]
        return here

    def _saved(self, k: int) -> list[bytes]:
        return self.states.save_some(self._points(k))

    def _lengths(self, k: int) -> npt.NDArray[np.uint64]:
        lengths = np.zeros(self.points_per_cell, np.uint64)
        lengths[self.state[k] >= 0] = [len(point) for point in self._saved(k)]
        return lengths

    def _head(self, file: Any, load: float) -> None:
        file.attrs["format"], file.attrs["version"], file.attrs["load"] = _FORMAT, _VERSION, load
        file.attrs["points"] = self.points_per_cell
        file.attrs["fingerprint"] = np.uint64(self.states.material.fingerprint)

    def _check(self, file: Any) -> float:
        head = file.attrs
        if head.get("format") != _FORMAT:
            raise Error(Status.BAD_BYTES, f"{file.filename}: expected a checkpoint of cells")
        if head["version"] != _VERSION:
            raise Error(Status.WRONG_VERSION, f"version {head['version']}, expected {_VERSION}")
        if head["fingerprint"] != self.states.material.fingerprint:
            raise Error(Status.WRONG_MATERIAL, "the checkpoint is of another material")
        cells, unknowns = file["unknowns"].shape
        for what, found, expected in (("cells", cells, self.total),
                                      ("points in a cell", head["points"], self.points_per_cell),
                                      ("unknowns at a cell", unknowns, self.unknowns.shape[1])):
            if found != expected:
                raise bad_argument(f"the checkpoint has {found} {what}, expected {expected}")
        return float(head["load"])


@contextlib.contextmanager
def _opened(comm: MPI.Intracomm, path: str, mode: str) -> Iterator[Any]:
    """A file that all ranks open and close together."""
    with together(comm):
        h5py, ways = _library(comm)
        try:
            file = h5py.File(path, mode, **ways)
        except OSError as error:
            there = mode == "r" and os.path.isfile(path)
            raise Error(Status.BAD_BYTES if there else Status.FILE_ERROR, f"{path}: {error}") from None
    try:
        yield file
    finally:
        with together(comm):
            file.close()


def _library(comm: MPI.Intracomm) -> tuple[Any, dict[str, Any]]:
    """h5py, and how it opens a file."""
    try:
        import h5py
    except ImportError:
        raise Error(Status.FILE_ERROR, "checkpoints need h5py, which is not found (Debian: "
                    "python3-h5py-mpi)") from None
    if comm.size == 1:
        return h5py, {}
    if not h5py.get_config().mpi:
        raise Error(Status.FILE_ERROR, "checkpoints of several ranks need an h5py with MPI (Debian: "
                    "python3-h5py-mpi, and H5PY_ALWAYS_USE_MPI=1 where mpirun is not Open MPI's)")
    return h5py, {"driver": "mpio", "comm": comm}


def _reserve(comm: MPI.Intracomm, path: str, size: int) -> None:
    """Tell a disk that is too full before HDF5 begins: it crashes as it closes what it cannot write."""
    with together(comm):
        if comm.rank == 0:
            try:
                with open(path, "wb") as file:
                    os.posix_fallocate(file.fileno(), 0, size)
            except OSError as error:
                raise Error(Status.FILE_ERROR, f"{path}: {error.strerror}") from None


def _write(dataset: Any, where: int | slice, data: Any) -> None:
    dataset[where] = data


def _read(file: Any, name: str, where: int | slice) -> Any:
    if name not in file:
        raise Error(Status.BAD_BYTES, f"the checkpoint has no {name}")
    if isinstance(where, slice) and where.stop > len(file[name]):
        raise Error(Status.BAD_BYTES, f"the checkpoint's {name} are cut short")
    return file[name][where]
