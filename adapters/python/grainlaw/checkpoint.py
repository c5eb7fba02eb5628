"""States of the cells of a mesh in one file, which any number of ranks writes and reads: a record for
each cell, found by its number in the input mesh. Needs mpi4py.

The file, little endian: "GRAINCEL", u32 version 1, u32 points of a cell, u64 cells, u64 fingerprint of
the material, u64 unknowns of a cell, f64 load; for each cell u64 start and u64 length of its record;
records: u64 length of each point's bytes (0: it has no state), f64 unknowns, the points' bytes.
"""
from __future__ import annotations

import contextlib
import os
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from mpi4py import MPI

from .abi import Error, bad_argument
from .arrays import Array
from .material import AnyPath
from .names import Status
from .points import States
from .ranks import together

_MAGIC, _VERSION = b"GRAINCEL", 1
_HEAD = struct.Struct("<8sIIQQQd")
_ENTRY = np.dtype("<u8")


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
        sizes = np.array([len(self._record(k)) for k in range(len(self.numbers))], np.int64)
        before = comm.exscan(int(sizes.sum())) or 0
        starts = _entry(self.total) + before + np.cumsum(sizes) - sizes
        new = comm.bcast(f"{os.path.realpath(path)}.{os.getpid()}.new", root=0)
        try:
            with _opened(comm, new, MPI.MODE_CREATE | MPI.MODE_WRONLY) as file:
                with together(comm):
                    if comm.rank == 0:
                        _write(file, 0, self._head(load))
                    for k, (start, size) in enumerate(zip(starts.tolist(), sizes.tolist())):
                        entry = np.array([start, size], _ENTRY).tobytes()
                        _write(file, _entry(int(self.numbers[k])), entry)
                        _write(file, start, self._record(k))
                file.Sync()
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
        with _opened(self.comm, os.fspath(path), MPI.MODE_RDONLY) as file, together(self.comm):
            size = file.Get_size()
            load = self._check(_read(file, 0, _HEAD.size, size))
            for k, number in enumerate(self.numbers.tolist()):
                start, length = np.frombuffer(
                    _read(file, _entry(number), 2 * _ENTRY.itemsize, size), _ENTRY).tolist()
                try:
                    saved, unknowns[k] = self._parts(k, _read(file, start, length, size))
                    fresh.load_some(self._points(k), saved)
                except (Error, ValueError) as error:
                    status = getattr(error, "status", Status.BAD_BYTES)
                    raise Error(status, f"{path}, cell {number}: {error}") from None
        everything = np.arange(len(fresh))
        self.states.clone_some(everything, fresh, everything)
        self.unknowns[:] = unknowns
        return load

    def _points(self, k: int) -> npt.NDArray[np.int64]:
        here: npt.NDArray[np.int64] = self.state[k][self.state[k] >= 0]
        return here

    def _record(self, k: int) -> bytes:
        points = self.states.save_some(self._points(k))
        lengths = np.zeros(self.points_per_cell, _ENTRY)
        lengths[self.state[k] >= 0] = [len(point) for point in points]
        return b"".join([lengths.tobytes(), self.unknowns[k].astype("<f8").tobytes(), *points])

    def _parts(self, k: int, record: bytes) -> tuple[Sequence[bytes], Array]:
        lengths = np.frombuffer(record, _ENTRY, self.points_per_cell)
        if not np.array_equal(lengths > 0, self.state[k] >= 0):
            raise ValueError("its points are of other layers")
        unknowns = np.frombuffer(record, "<f8", self.unknowns.shape[1], lengths.nbytes)
        ends = lengths.nbytes + unknowns.nbytes + np.cumsum(lengths)
        return [record[end - length:end] for end, length in
                zip(ends.tolist(), lengths.tolist()) if length], unknowns

    def _head(self, load: float) -> bytes:
        return _HEAD.pack(_MAGIC, _VERSION, self.points_per_cell, self.total,
                          self.states.material.fingerprint, self.unknowns.shape[1], load)

    def _check(self, head: bytes) -> float:
        magic, version, points, cells, fingerprint, unknowns, load = _HEAD.unpack(head)
        if magic != _MAGIC:
            raise Error(Status.BAD_BYTES, "expected a checkpoint of cells")
        if version != _VERSION:
            raise Error(Status.WRONG_VERSION, f"version {version}, expected {_VERSION}")
        if fingerprint != self.states.material.fingerprint:
            raise Error(Status.WRONG_MATERIAL, "the checkpoint is of another material")
        for what, found, expected in (("cells", cells, self.total),
                                      ("points in a cell", points, self.points_per_cell),
                                      ("unknowns at a cell", unknowns, self.unknowns.shape[1])):
            if found != expected:
                raise bad_argument(f"the checkpoint has {found} {what}, expected {expected}")
        return float(load)


@contextlib.contextmanager
def _opened(comm: MPI.Intracomm, path: str, mode: int) -> Iterator[MPI.File]:
    """A file that all ranks open and close together."""
    file = MPI.FILE_NULL
    with together(comm):
        try:
            file = MPI.File.Open(comm, path, mode)
        except MPI.Exception as error:
            raise Error(Status.FILE_ERROR, f"{path}: {error}") from None
    try:
        yield file
    finally:
        file.Close()


def _entry(number: int) -> int:
    """Where the file tells start and length of a cell's record."""
    return _HEAD.size + 2 * _ENTRY.itemsize * number


def _write(file: MPI.File, start: int, data: bytes) -> None:
    status = MPI.Status()
    file.Write_at(start, data, status)
    if status.Get_count(MPI.BYTE) != len(data):
        raise Error(Status.FILE_ERROR, "the disk is full")


def _read(file: MPI.File, start: int, length: int, size: int) -> bytearray:
    if start + length > size:
        raise Error(Status.BAD_BYTES, "the checkpoint is cut short")
    data = bytearray(length)
    file.Read_at(start, data)
    return data
