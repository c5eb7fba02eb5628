"""Materials: a file that says what the grains are, and their packing."""
from __future__ import annotations

import ctypes
import functools
import os
import tomllib
from collections.abc import Callable
from typing import Any

from .abi import Handle, as_bytes, c_text, check, library, saved_by

AnyPath = str | os.PathLike[str]


class Material:
    """A material file and the packing it names, in equilibrium at F = I. Raises Error with the
    library's message, which names file, line, key and what was expected.

    Pickled with its packing in equilibrium: whoever loads it needs no file."""

    dimension: int   #: 2 (discs) or 3 (spheres)
    text: str        #: of the file
    directory: str   #: where relative paths in it start

    def __init__(self, path: AnyPath) -> None:
        self._create(library.grainlaw_material_load, c_text(path))
        with open(path, encoding="utf-8") as file:
            self.text = file.read()
        self.directory = os.path.dirname(os.path.abspath(path))

    @classmethod
    def parse(cls, text: str, base_directory: AnyPath = ".") -> Material:
        """The same from TOML text; relative paths in it start at base_directory."""
        material = cls.__new__(cls)
        material._create(library.grainlaw_material_parse, c_text(text), c_text(base_directory))
        material.text, material.directory = text, os.path.abspath(base_directory)
        return material

    @classmethod
    def load_saved(cls, saved: bytes | bytearray | memoryview, text: str = "",
                   directory: AnyPath = ".") -> Material:
        """The material of the bytes of save(), without its files and without another relaxation.
        text and directory are those of the file, where they are known. A checksum tells damage;
        bytes of unknown origin are not for this call."""
        data = as_bytes(saved, "a saved material")
        material = cls.__new__(cls)
        material._create(lambda out, *rest: library.grainlaw_material_load_saved(
            data, len(data), out, *rest))
        material.text, material.directory = text, os.path.abspath(directory)
        return material

    def save(self) -> bytes:
        """The material with its packing in equilibrium as bytes, for other processes."""
        return saved_by(library.grainlaw_material_save, self._handle)

    @property
    def fingerprint(self) -> int:
        """A number that two materials share if their saved bytes are the same: what ranks compare."""
        found = ctypes.c_ulonglong()
        check(library.grainlaw_material_fingerprint(self._handle, ctypes.byref(found)))
        return found.value

    @property
    def description(self) -> dict[str, Any]:
        """The keys of the file, as tomllib reads them."""
        return tomllib.loads(self.text)

    def __repr__(self) -> str:
        return f"<Material of {'discs' if self.dimension == 2 else 'spheres'}, {self.directory}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _load_again, (self.save(), self.text, self.directory)

    def _create(self, function: Callable[..., int], *arguments: Any) -> None:
        message = ctypes.create_string_buffer(1024)

        def create(out: Any) -> int:
            status = function(*arguments, out, message, len(message))
            check(status, message.value.decode(errors="replace"))
            return status

        self._handle = Handle(create, library.grainlaw_material_destroy)
        self.dimension = library.grainlaw_material_dimension(self._handle)


@functools.lru_cache(maxsize=8)
def _load_again(saved: bytes, text: str, directory: str) -> Material:
    # Many states that are unpickled share one material.
    return Material.load_saved(saved, text, directory)
