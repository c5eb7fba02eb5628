"""Materials: a file that says what the grains are, and their packing."""
from __future__ import annotations

import ctypes
import functools
import os
import tomllib
from collections.abc import Callable
from typing import Any

from .abi import Handle, c_text, check, library

AnyPath = str | os.PathLike[str]


class Material:
    """A material file and the packing it names, in equilibrium at F = I. Raises Error with the
    library's message, which names file, line, key and what was expected.

    Pickled as the text of the file and the directory of the packing: whoever loads it reads the
    packing again from there."""

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

    @property
    def description(self) -> dict[str, Any]:
        """The keys of the file, as tomllib reads them."""
        return tomllib.loads(self.text)

    def __repr__(self) -> str:
        return f"<Material of {'discs' if self.dimension == 2 else 'spheres'}, {self.directory}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _parse_again, (self.text, self.directory)

    def _create(self, function: Callable[..., int], *arguments: Any) -> None:
        message = ctypes.create_string_buffer(1024)

        def create(out: Any) -> int:
            status = function(*arguments, out, message, len(message))
            check(status, message.value.decode(errors="replace"))
            return status

        self._handle = Handle(create, library.grainlaw_material_destroy)
        self.dimension = library.grainlaw_material_dimension(self._handle)


@functools.lru_cache(maxsize=8)
def _parse_again(text: str, directory: str) -> Material:
    # Many states that are unpickled share one material, and its packing is made once.
    return Material.parse(text, directory)
