"""The shared library behind grainlaw.py: where it is, its functions, its handles and errors."""
import ctypes
import os

from grainlaw_names import ABI, VERSION, Report, Status, Summary


class Error(Exception):
    """A call the library, or this module before it, refused: status (Status), message, and the
    number of the point where it was one point of several, else None."""

    def __init__(self, status, message="", point=None):
        self.point = point
        known = status in Status._value2member_map_  # a later library may have more
        self.status = Status(status) if known else int(status)
        self.message = message or status_text(status)
        super().__init__(f"{self.message} [{self.status.name if known else status}]")


def _open():
    file = f"libgrainlaw.so.{ABI}"
    chosen = os.environ.get("GRAINLAW_LIBRARY")
    beside = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", file)
    path = chosen or (beside if os.path.exists(beside) else file)
    try:
        library = ctypes.CDLL(path)
        _declare(library)
    except (OSError, AttributeError) as error:
        hint = "GRAINLAW_LIBRARY says so" if chosen else "set GRAINLAW_LIBRARY to its path"
        raise ImportError(f"the grainlaw library cannot be loaded: {error} ({hint})") from None
    found = library.grainlaw_version().decode()
    # The library knows the structs of earlier headers, not those of later ones.
    small = any(_size(default) < ctypes.sizeof(ours) for default, ours in
                ((library.grainlaw_report_default, Report),
                 (library.grainlaw_summary_default, Summary)))
    if found.split(".")[0] != str(ABI) or small:
        raise ImportError(f"{path} is grainlaw {found}; this module was made for {VERSION}")
    return library


def _declare(library):
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    text, out = ctypes.c_char_p, ctypes.POINTER(ctypes.c_void_p)
    count = ctypes.POINTER(size)
    functions = {
        "status_text": (text, ctypes.c_int),
        "version": (text,),
        "material_load": (ctypes.c_int, text, out, text, size),
        "material_parse": (ctypes.c_int, text, text, out, text, size),
        "material_dimension": (ctypes.c_int, pointer),
        "material_destroy": (None, pointer),
        "points_create": (ctypes.c_int, pointer, size, out),
        "points_clone": (ctypes.c_int, pointer, out),
        "points_destroy": (None, pointer),
        "points_size": (size, pointer),
        "points_state": (pointer, pointer, size),
        "points_evaluate": (ctypes.c_int, pointer, pointer, ctypes.c_uint, pointer, pointer,
                            pointer, pointer, ctypes.c_int, ctypes.POINTER(Summary)),
        "points_commit": (ctypes.c_int, pointer),
        "points_revert": (ctypes.c_int, pointer),
        "points_set_time_step": (ctypes.c_int, pointer, ctypes.c_double),
        "points_save": (ctypes.c_int, pointer, pointer, count),
        "points_load": (ctypes.c_int, pointer, pointer, size, text, size),
        "points_measure": (ctypes.c_int, pointer, ctypes.c_int, pointer, count),
        "state_write_vtk": (ctypes.c_int, pointer, text),
        "state_write_packing": (ctypes.c_int, pointer, text),
    }
    for name, (result, *arguments) in functions.items():
        function = getattr(library, f"grainlaw_{name}")
        function.restype, function.argtypes = result, arguments


def _size(default):
    # Returned by value: room for the struct of any later version.
    class Any(ctypes.Structure):
        _fields_ = [("size", ctypes.c_size_t), ("rest", ctypes.c_char * 65536)]

    default.restype = Any
    return default().size


library = _open()


def status_text(status):
    """English text of a status."""
    return library.grainlaw_status_text(status).decode()


def version():
    """Version of the library in use, "major.minor.patch"."""
    return library.grainlaw_version().decode()


def check(status, message=""):
    if status != Status.OK:
        raise Error(status, message)


def c_text(value):
    encoded = os.fsencode(value)
    if b"\0" in encoded:
        raise Error(Status.BAD_ARGUMENT, f"a text for the library holds a zero byte: {value!r}")
    return encoded


class Handle:
    """Owner of one C handle."""

    def __init__(self, create, destroy, *arguments):
        self._as_parameter_ = ctypes.c_void_p()
        self._destroy = destroy
        check(create(*arguments, ctypes.byref(self._as_parameter_)))

    def __del__(self):
        self._destroy(self._as_parameter_)
