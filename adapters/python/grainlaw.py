"""grainlaw for Python: numpy arrays over the C ABI.

Conventions are those of grainlaw.h: F[i, J] = dx_i/dX_J, P in Pa with tension positive,
A[i, J, k, L] = dP_iJ/dF_kL, SI units. d is the dimension of the material.

    material = grainlaw.Material("sand.toml")
    points = grainlaw.States(material, 240)
    answer = points.evaluate(F, grainlaw.Tangent.EXACT)     # F: (240, d, d)
    if answer.ok:
        points.commit()                                     # answer.P, answer.A
    else:
        points.revert()                 # and retry with answer.step_ratio of the step

A status < 0 raises Error and leaves what is committed as it was; a recoverable one (> 0) is an
answer. The library is $GRAINLAW_LIBRARY, or the one this file was installed with, or the one the
dynamic loader finds.
"""
import ctypes
import os
from dataclasses import dataclass

import numpy as np

from grainlaw_library import Error, Handle, c_text, check, library, status_text, version
from grainlaw_names import Measure, Report, Status, Tangent

__all__ = ["Error", "Evaluation", "Material", "Measure", "State", "States", "Status", "Tangent",
           "status_text", "version"]

# grainlaw_report for numpy, its text as one string.
_fields = np.dtype(Report).fields
_report = np.dtype({
    "names": list(_fields),
    "formats": [kind.str if kind.subdtype is None else f"S{kind.itemsize}"
                for kind, _ in _fields.values()],
    "offsets": [offset for _, offset in _fields.values()],
    "itemsize": ctypes.sizeof(Report)})


class Material:
    """A material file and the packing it names, in equilibrium at F = I. Raises Error with the
    library's message, which names file, line, key and what was expected."""

    def __init__(self, path):
        self._create(library.grainlaw_material_load, c_text(path))

    @classmethod
    def parse(cls, text, base_directory="."):
        """The same from TOML text; relative paths in it start at base_directory."""
        material = cls.__new__(cls)
        material._create(library.grainlaw_material_parse, c_text(text), c_text(base_directory))
        return material

    def _create(self, function, *arguments):
        message = ctypes.create_string_buffer(1024)

        def create(out):
            status = function(*arguments, out, message, len(message))
            check(status, message.value.decode(errors="replace"))
            return status

        self._handle = Handle(create, library.grainlaw_material_destroy)
        self.dimension = library.grainlaw_material_dimension(self._handle)


@dataclass
class Evaluation:
    """What an evaluation of n points came to. Rows of points that failed are NaN."""

    P: np.ndarray        #: (n, d, d) first Piola-Kirchhoff stress [Pa]
    A: np.ndarray        #: (n, d, d, d, d) tangent [Pa], or None when none was asked for
    status: np.ndarray   #: (n,) Status as numbers
    reports: np.ndarray  #: (n,) fields of grainlaw_report by name, e.g. reports["sliding"]

    @property
    def ok(self):
        return not self.status.any()

    @property
    def failed(self):
        """Numbers of the points that failed."""
        return np.flatnonzero(self.status)

    @property
    def step_ratio(self):
        """Smallest factor on the step that a failed point suggests; 1 when all are well."""
        ratios = np.atleast_1d(self.reports)["step_ratio"]
        return float(np.min(ratios[self.failed], initial=1.0))

    @property
    def message(self):
        """The first failed point, or "" """
        failed = self.failed
        return _point_message(failed[0], self.status, self.reports) if failed.size else ""


def _point_message(point, status, reports):
    code = int(np.atleast_1d(status)[point])
    detail = np.atleast_1d(reports)["message"][point].decode(errors="replace")
    return f"point {point}: {status_text(code)}" + (f" ({detail})" if detail else "")


class States:
    """Integration points of one material, evaluated together. F, P, A and measures have the number
    of the point as their first axis."""

    def __init__(self, material, count):
        if not isinstance(material, Material):
            raise Error(Status.BAD_HANDLE, f"expected a Material, got {type(material).__name__}")
        if not isinstance(count, (int, np.integer)) or count < 1:
            raise Error(Status.BAD_ARGUMENT, f"expected a number of points >= 1, got {count!r}")
        self.dimension = material.dimension
        self._adopt([Handle(library.grainlaw_state_create, library.grainlaw_state_destroy,
                             material._handle) for _ in range(count)], trial=False)

    def _adopt(self, handles, trial):
        self._handles = handles
        self._array = (ctypes.c_void_p * len(handles))(*(h._as_parameter_.value for h in handles))
        self._trial = trial

    def __len__(self):
        return len(self._handles)

    def _cloned(self):
        return [Handle(library.grainlaw_state_clone, library.grainlaw_state_destroy, handle)
                for handle in self._handles]

    def clone(self):
        """An independent copy, committed and trial."""
        copy = self.__class__.__new__(self.__class__)
        copy.dimension = self.dimension
        copy._adopt(self._cloned(), self._trial)
        return copy

    def evaluate(self, F, tangent=None, threads=0):
        """Evaluation of all points at F (n, d, d), with a Tangent or without, on so many threads
        (0: OMP_NUM_THREADS or all processors). Raises Error for arrays of another shape or type and where
        a point's status is < 0."""
        n, d = len(self), self.dimension
        F = _numbers(F, (n, d, d))
        want = 0 if tangent is None else int(tangent)
        P = np.full((n, d, d), np.nan)
        A = np.full((n, d, d, d, d), np.nan) if want else None
        status = np.zeros(n, np.intc)
        reports = np.zeros(n, _report)
        reports["size"] = _report.itemsize
        self._trial = False
        result = library.grainlaw_evaluate_batch(
            n, self._array, F.ctypes.data, want, P.ctypes.data, A.ctypes.data if want else None,
            status.ctypes.data, reports.ctypes.data, threads)
        if result < 0:
            if (status == result).all() and not (reports["message"] != b"").any():
                raise Error(result)  # of the whole call
            point = int(np.flatnonzero(status == result)[0])
            raise Error(result, _point_message(point, status, reports), point)
        self._trial = result == Status.OK
        return Evaluation(P, A, status, reports)

    def commit(self):
        """Make the trial the committed state: of all points or, when one has none, of none."""
        if not self._trial:
            raise Error(Status.NO_TRIAL)
        for handle in self._handles:
            check(library.grainlaw_commit(handle))
        self._trial = False

    def revert(self):
        """Drop the trial, if any."""
        self._trial = False
        for handle in self._handles:
            check(library.grainlaw_revert(handle))

    def save(self):
        """The committed states as a list of bytes."""
        return [_save(handle) for handle in self._handles]

    def load(self, saved):
        """Replace the committed states by saved ones: all of them or, on an Error, none."""
        if len(saved) != len(self):
            raise Error(Status.BAD_BYTES, f"{len(saved)} saved states for {len(self)} points")
        handles = self._cloned()
        for point, (handle, data) in enumerate(zip(handles, saved)):
            data = bytes(data)
            status = library.grainlaw_state_load(handle, data, len(data))
            check(status, f"point {point}: {status_text(status)}")
        self._adopt(handles, trial=False)

    def measure(self, what):
        """A Measure of the trial, or of the committed state where there is no trial:
        (n,), (n, d, d) or (n, components), in the unit that grainlaw.h gives."""
        count = ctypes.c_size_t()
        check(library.grainlaw_state_measure(self._handles[0], what, None, ctypes.byref(count)))
        values = np.empty((len(self), count.value))
        for handle, row in zip(self._handles, values):
            check(library.grainlaw_state_measure(handle, what, row.ctypes.data,
                                                   ctypes.byref(count)))
        square = (self.dimension, self.dimension)
        shape = () if count.value == 1 else square if count.value == np.prod(square) else (-1,)
        return values.reshape(len(self), *shape)

    def write_vtk(self, path, point=0):
        """Particles and force chains of a point as a .vtp file for ParaView."""
        self._write(library.grainlaw_state_write_vtk, path, point)

    def write_packing(self, prefix, point=0):
        """A point as a packing that a material file can read."""
        self._write(library.grainlaw_state_write_packing, prefix, point)

    def _write(self, function, path, point):
        if not 0 <= point < len(self):
            raise Error(Status.BAD_ARGUMENT, f"point {point} is none of 0 to {len(self) - 1}")
        status = function(self._handles[point], c_text(path))
        check(status, f"{os.fspath(path)}: {status_text(status)}")


class State(States):
    """One integration point: the same without the first axis; save gives bytes."""

    def __init__(self, material):
        super().__init__(material, 1)

    def evaluate(self, F, tangent=None):
        d = self.dimension
        answer = super().evaluate(_numbers(F, (d, d))[None], tangent, threads=1)
        A = None if answer.A is None else answer.A[0]
        return Evaluation(answer.P[0], A, answer.status[0], answer.reports[0])

    def save(self):
        return super().save()[0]

    def load(self, saved):
        super().load([saved])

    def measure(self, what):
        return super().measure(what)[0]


def _save(handle):
    size = ctypes.c_size_t()
    check(library.grainlaw_state_save(handle, None, ctypes.byref(size)))
    data = ctypes.create_string_buffer(size.value)
    check(library.grainlaw_state_save(handle, data, ctypes.byref(size)))
    return data.raw[:size.value]


def _numbers(F, shape):
    try:
        array = np.asarray(F)
    except ValueError as error:
        raise Error(Status.BAD_ARGUMENT, f"F is no array: {error}") from None
    if array.dtype.kind not in "iuf":
        raise Error(Status.BAD_ARGUMENT, f"F holds {array.dtype}, expected real numbers")
    if array.shape != shape:
        raise Error(Status.BAD_ARGUMENT, f"F has the shape {array.shape}, expected {shape}")
    return np.ascontiguousarray(array, dtype=float)
