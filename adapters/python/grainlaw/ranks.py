"""Ranks of MPI as one program: what one of them raises ends or is told on all. Needs mpi4py."""
from __future__ import annotations

import contextlib
import sys
import time
import traceback
from collections.abc import Iterator

from mpi4py import MPI

from .abi import Error, StepError
from .material import AnyPath, Material
from .names import Status

PATIENCE = 5.0   # how long a rank with an error waits for the others to tell the same [s]


@contextlib.contextmanager
def together(comm: MPI.Intracomm) -> Iterator[None]:
    """A block of all ranks, without calls among them inside: where some raise an exception, all raise
    Error with the text of the lowest of them; one rank alone raises what it was."""
    raised: Exception | None = None
    try:
        yield
    except Exception as error:
        if comm.size == 1:
            raise
        raised = error
    first = comm.allreduce(comm.size if raised is None else comm.rank, MPI.MIN)
    if first < comm.size:
        told = int(getattr(raised, "status", Status.FILE_ERROR)), _text(raised)
        status, text = comm.bcast(told, root=first)
        raise Error(status, f"rank {first}: {text}") from raised


@contextlib.contextmanager
def end_together(comm: MPI.Intracomm) -> Iterator[None]:
    """The whole program of a rank: where it raises, the job ends with status 1. An error of grainlaw that
    is told on all ranks is printed once; any other by its rank, which aborts the job."""
    try:
        yield
    except Exception as error:
        everywhere, deadline = comm.Ibarrier(), time.monotonic() + PATIENCE
        while not (arrived := everywhere.Test()) and time.monotonic() < deadline:
            time.sleep(0.01)
        known = isinstance(error, (Error, StepError))
        if arrived and known:
            if comm.rank == 0:
                print(f"grainlaw: {error}", file=sys.stderr, flush=True)
            sys.exit(1)
        if comm.size == 1:
            raise
        if known:
            print(f"grainlaw: rank {comm.rank}: {error}", file=sys.stderr, flush=True)
        else:
            traceback.print_exception(error)
        comm.Abort(1)


def read_material(comm: MPI.Intracomm, path: AnyPath) -> Material:
    """The material of a file, read and brought to equilibrium by rank 0, and handed to the others. Raises
    Error on all ranks."""
    material = None
    with together(comm):
        if comm.rank == 0:
            material = Material(path)
    return comm.bcast(material, root=0)   # type: ignore[no-any-return]


def check_same(comm: MPI.Intracomm, material: Material) -> None:
    """Raises Error on all ranks where the materials of two ranks differ."""
    mine = material.fingerprint
    expected = comm.bcast(mine, root=0)
    with together(comm):
        if mine != expected:
            raise Error(Status.WRONG_MATERIAL, f"the material has fingerprint {mine:x}, expected that "
                        f"of rank 0, {expected:x}: all ranks need one file and packing")


def _text(error: Exception | None) -> str:
    return error.message if isinstance(error, Error) else f"{type(error).__name__}: {error}"
