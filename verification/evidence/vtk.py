"""Packings and meshes that runs left for ParaView."""
import base64
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as tree

import numpy as np

sys.dont_write_bytecode = True


def arrays(path):
    """All arrays of a file by name; rows of several components."""
    found = {}
    for entry in tree.parse(path).getroot().iter("DataArray"):
        kind = {"Float64": np.float64, "Int32": np.int32, "Int64": np.int64, "UInt8": np.uint8}[entry.get("type")]
        if entry.get("format") == "binary":
            values = np.frombuffer(base64.b64decode(entry.text.strip())[8:], kind)
        else:
            values = np.array(entry.text.split(), dtype=kind)
        components = int(entry.get("NumberOfComponents", 1))
        found.setdefault(entry.get("Name"), values.reshape(-1, components) if components > 1 else values)
    return found


class Packing:
    """position, radius, rotation of particles; first, second, branch, force, tangential, moment, bonded of contacts. Those of a
    frame, without images: the second is the particle at the end of the branch."""

    def __init__(self, path):
        raw = arrays(path)
        n = int(np.count_nonzero(raw["radius"]))
        self.position, self.radius, self.rotation = raw["points"][:n, :2], raw["radius"][:n], raw["rotation"][:n]
        # Behind the particles stand the ends of contacts; lines lead there from their first particle.
        lines = len(raw["points"]) - n
        self.first = np.array(tree.parse(path).getroot().find(".//Lines/DataArray[@Name='connectivity']").text.split(), int)[0::2]
        self.branch = raw["points"][n:, :2] - self.position[self.first]
        ends = raw["points"][n:, :2]
        nearest = ((ends[:, None, :] - self.position[None]) ** 2).sum(axis=2).argmin(axis=1) if lines * n < 2e6 else None
        self.second = nearest
        self.force, self.tangential, self.moment, self.bonded = (raw[name][n:n + lines] for name in (
            "normal_force", "tangential_force", "moment", "bonded"))


def draw(picture, panels, *options):
    """Packings side by side, by report/draw_packings; nothing where one is missing. panels: pairs of title and file."""
    if all(path and pathlib.Path(path).exists() for _, path in panels):
        drawer = pathlib.Path(__file__).resolve().parent / "report/draw_packings"
        subprocess.run([sys.executable, drawer, picture, *options, *(f"{title}={path}" for title, path in panels)], check=True)


def series(results, stem, extension="vtp"):
    """Files of a series by their step, ascending."""
    pattern = re.compile(re.escape(stem) + r"_(\d+)[.]" + extension)
    found = {int(match[1]): path for path in pathlib.Path(results).iterdir() if (match := pattern.fullmatch(path.name))}
    return dict(sorted(found.items()))
