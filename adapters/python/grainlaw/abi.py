"""The C ABI: where the shared library is, its functions, its handles and errors."""
from __future__ import annotations

import ctypes
import os
import threading
from collections.abc import Callable
from typing import Any

from .arguments import LARGEST_INT, whole
from .names import (ABI, VERSION, Consolidation, MarchOptions, Part, Report, Status,
                    Summary)


# grainlaw_reduce: context, values, how many, grainlaw_op.
REDUCE = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.POINTER(ctypes.c_double), ctypes.c_int,
                          ctypes.c_int)


class Error(Exception):
    """A call the library, or this module before it, refused: status (Status), message, and the
    number of the point where it was one point of several, else None."""

    status: Status | int
    message: str
    point: int | None

    def __init__(self, status: int, message: str = "", point: int | None = None) -> None:
        self.point = point
        known = status in Status._value2member_map_  # a later library may have more
        self.status = Status(status) if known else int(status)
        self.message = message or status_text(status)
        name = self.status.name if isinstance(self.status, Status) else status
        super().__init__(f"{self.message} [{name}]")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (int(self.status), self.message, self.point)


class _Raised(threading.local):
    """What a callback raised in a call of the library that this thread has not left."""
    error: BaseException | None = None


_raised = _Raised()


def callback(function: Callable[..., None]) -> Callable[..., None]:
    """A function that the library calls. What it raises is raised by the call of the library, once that
    is over; it is not called again before."""
    def call(*arguments: Any) -> None:
        if _raised.error is None:
            try:
                function(*arguments)
            except BaseException as error:   # ctypes would print it and go on
                _raised.error = error
    return call


def _raise_of_callback(result: Any, _function: Any, _arguments: Any) -> Any:
    error, _raised.error = _raised.error, None
    if error is not None:
        raise error
    return result


class StepError(Exception):
    """A load step that failed in its smallest part too. status is that of the last evaluation."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = status


def _open() -> ctypes.CDLL:
    file = f"libgrainlaw.so.{ABI}"
    here = os.path.dirname(os.path.abspath(__file__))
    chosen = os.environ.get("GRAINLAW_LIBRARY")
    # In the package, as pip installs it, or three above, as CMake does.
    near = [os.path.join(here, file), os.path.join(here, "..", "..", "..", file)]
    path = chosen or next((one for one in near if os.path.exists(one)), file)
    try:
        library = ctypes.CDLL(path, use_errno=True)
        _declare(library)
    except (OSError, AttributeError) as error:
        hint = "GRAINLAW_LIBRARY says so" if chosen else "set GRAINLAW_LIBRARY to its path"
        raise ImportError(f"the grainlaw library cannot be loaded: {error} ({hint})") from None
    found = library.grainlaw_version().decode()
    # The library knows the structs of earlier headers, not those of later ones.
    small = any(_size(default) < ctypes.sizeof(ours) for default, ours in
                ((library.grainlaw_report_default, Report),
                 (library.grainlaw_summary_default, Summary),
                 (library.grainlaw_part_default, Part),
                 (library.grainlaw_march_options_default, MarchOptions),
                 (library.grainlaw_consolidation_default, Consolidation)))
    if found.split(".")[0] != str(ABI) or small:
        raise ImportError(f"{path} is grainlaw {found}; this module was made for {VERSION}")
    return library


def _declare(library: ctypes.CDLL) -> None:
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    text, out = ctypes.c_char_p, ctypes.POINTER(ctypes.c_void_p)
    count = ctypes.POINTER(size)
    functions: dict[str, tuple[Any, ...]] = {
        "status_text": (text, ctypes.c_int),
        "version": (text,),
        "material_load": (ctypes.c_int, text, out, text, size),
        "material_parse": (ctypes.c_int, text, text, out, text, size),
        "material_save": (ctypes.c_int, pointer, pointer, count),
        "material_load_saved": (ctypes.c_int, text, size, out, text, size),
        "material_fingerprint": (ctypes.c_int, pointer, ctypes.POINTER(ctypes.c_ulonglong)),
        "material_dimension": (ctypes.c_int, pointer),
        "material_destroy": (None, pointer),
        "points_create": (ctypes.c_int, pointer, size, out),
        "points_clone": (ctypes.c_int, pointer, out),
        "points_destroy": (None, pointer),
        "points_size": (size, pointer),
        "points_state": (pointer, pointer, size),
        "points_evaluate": (ctypes.c_int, pointer, pointer, ctypes.c_uint, pointer, pointer,
                            pointer, pointer, ctypes.c_int, ctypes.POINTER(Summary)),
        "points_evaluate_some": (ctypes.c_int, pointer, size, pointer, pointer, size, ctypes.c_uint,
                                 pointer, size, pointer, size, pointer, pointer, ctypes.c_int,
                                 ctypes.POINTER(Summary)),
        "points_answer": (ctypes.c_int, pointer, ctypes.c_uint, pointer, pointer, ctypes.c_int,
                          ctypes.POINTER(Summary)),
        "points_consolidate": (ctypes.c_int, pointer, size, pointer, pointer,
                               ctypes.POINTER(Consolidation), pointer, pointer, ctypes.c_int,
                               ctypes.POINTER(Summary)),
        "points_cost": (ctypes.c_int, pointer, pointer),
        "points_save_some": (ctypes.c_int, pointer, size, pointer, pointer, pointer),
        "points_load_some": (ctypes.c_int, pointer, size, pointer, text, pointer, text, size),
        "points_resize": (ctypes.c_int, pointer, size, pointer),
        "points_clone_some": (ctypes.c_int, pointer, size, pointer, pointer, pointer),
        "points_share": (ctypes.c_int, pointer, ctypes.c_int, REDUCE, pointer),
        "points_agree": (ctypes.c_int, pointer, ctypes.c_int, text, size),
        "points_commit": (ctypes.c_int, pointer),
        "points_revert": (ctypes.c_int, pointer),
        "points_set_time_step": (ctypes.c_int, pointer, ctypes.c_double),
        "points_save": (ctypes.c_int, pointer, pointer, count),
        "points_load": (ctypes.c_int, pointer, pointer, size, text, size),
        "state_save": (ctypes.c_int, pointer, pointer, count),
        "points_measure": (ctypes.c_int, pointer, ctypes.c_int, pointer, count),
        "march_create": (ctypes.c_int, ctypes.POINTER(MarchOptions), pointer, out),
        "march_destroy": (None, pointer),
        "march_begin": (ctypes.c_int, pointer, ctypes.c_double, ctypes.c_double),
        "march_next": (ctypes.c_int, pointer, ctypes.POINTER(Part)),
        "march_share": (ctypes.c_double, pointer, ctypes.c_double),
        "march_tell": (ctypes.c_int, pointer, ctypes.c_int, ctypes.POINTER(Summary),
                       ctypes.c_double, ctypes.c_double, ctypes.c_double),
        "march_cut": (ctypes.c_double, ctypes.c_double),
        "table_create": (ctypes.c_int, pointer, out),
        "table_destroy": (None, pointer),
        "table_size": (size, pointer),
        "table_evaluate": (ctypes.c_int, pointer, ctypes.c_longlong, ctypes.c_longlong,
                           ctypes.POINTER(ctypes.c_double), pointer, pointer, ctypes.c_double,
                           ctypes.c_uint, pointer, pointer, pointer),
        "table_measure": (ctypes.c_int, pointer, ctypes.c_longlong, ctypes.c_longlong, ctypes.c_int,
                          pointer, count),
        "table_forget": (ctypes.c_int, pointer, ctypes.c_longlong, ctypes.c_longlong),
        "table_save": (ctypes.c_int, pointer, pointer, count),
        "table_load": (ctypes.c_int, pointer, text, size, text, size),
        "state_particles": (ctypes.c_int, pointer, pointer, size, count),
        "state_contacts": (ctypes.c_int, pointer, pointer, size, count),
        "state_write_vtk": (ctypes.c_int, pointer, text),
        "state_write_packing": (ctypes.c_int, pointer, text),
    }
    for name, (result, *arguments) in functions.items():
        function = getattr(library, f"grainlaw_{name}")
        function.restype, function.argtypes = result, arguments
        if result is not None:
            function.errcheck = _raise_of_callback


class _Any(ctypes.Structure):
    """Returned by value: room for the struct of any later version."""
    _fields_ = [("size", ctypes.c_size_t), ("rest", ctypes.c_char * 65536)]


def _size(default: Any) -> int:
    default.restype = _Any
    return int(default().size)


library = _open()


def status_text(status: int) -> str:
    """English text of a status."""
    number = whole("status", status, -LARGEST_INT - 1, LARGEST_INT, bad_argument)
    text: bytes = library.grainlaw_status_text(number)
    return text.decode()


def version() -> str:
    """Version of the library in use, "major.minor.patch"."""
    text: bytes = library.grainlaw_version()
    return text.decode()


def bad_argument(message: str) -> Error:
    """What a call is refused with before the library is asked."""
    return Error(Status.BAD_ARGUMENT, message)


def check(status: int, message: str = "") -> None:
    """Raises Error for a status that is not OK."""
    if status != Status.OK:
        raise Error(status, message)


def c_text(value: str | os.PathLike[str]) -> bytes:
    """As the library takes paths and texts."""
    encoded = os.fsencode(value)
    if b"\0" in encoded:
        raise bad_argument(f"a text for the library holds a zero byte: {value!r}")
    return encoded


def saved_by(function: Callable[..., int], handle: Any) -> bytes:
    """Bytes of a function like grainlaw_state_save."""
    size = ctypes.c_size_t()
    check(function(handle, None, ctypes.byref(size)))
    data = ctypes.create_string_buffer(size.value)
    check(function(handle, data, ctypes.byref(size)))
    return data.raw


def load_by(function: Callable[..., int], *arguments: Any) -> None:
    """A call that ends with a buffer for the reason; raises Error with it."""
    message = ctypes.create_string_buffer(1024)
    status = function(*arguments, message, len(message))
    check(status, message.value.decode(errors="replace"))


def as_bytes(saved: Any, what: str) -> bytes:
    """Saved bytes of any type that holds bytes."""
    try:
        return bytes(memoryview(saved))
    except TypeError:
        raise bad_argument(f"expected {what} as bytes, got {type(saved).__name__}") from None


class Handle:
    """Owner of one C handle."""

    def __init__(self, create: Callable[..., int], destroy: Callable[..., None],
                 *arguments: Any) -> None:
        self._as_parameter_ = ctypes.c_void_p()
        self._destroy = destroy
        check(create(*arguments, ctypes.byref(self._as_parameter_)))

    def __del__(self) -> None:
        self._destroy(self._as_parameter_)
