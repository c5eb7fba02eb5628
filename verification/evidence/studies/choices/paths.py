"""Packings led along one path, compression at constant volume, and how far stresses lie from a reference."""
import dataclasses
import pathlib
import time

import numpy as np

import grainlaw
from grainlaw import Tangent

DATA = pathlib.Path(__file__).resolve().parents[4] / "tests/data"
NUDGE = 1e-6   # of F, at first: paths that differ by it tell how far answers lie apart that nothing chooses between

# Strains of the looks at a stress, and the increments of the reference up to the last of them.
RANGES = {"to 1 %": ((0.002, 0.004, 0.006, 0.008, 0.01), 2.5e-5), "1 to 6 %": ((0.02, 0.03, 0.04, 0.05, 0.06), 1e-4)}


def material_of(kind, solver="", boundary="periodic-cell", contact=None):
    """The packing of tests/data that YADE made, with other keys."""
    name, young, thickness = {"discs": ("rve400", 6e8, "thickness = 0.1\n"), "spheres": ("spheres500", 1e8, "")}[kind]
    contact = contact or f'{{ law = "frictional", young = {young}, ratio = 0.8, friction = 0.5463024898437905 }}'
    forces = "" if "hertz" in contact else f', contacts = "{name}_contacts.csv"'  # those of the linear law
    return grainlaw.Material.parse(f"""dimension = {2 if kind == "discs" else 3}
{thickness}packing = {{ particles = "{name}_particles.csv"{forces}, cell = "{name}_cell.csv" }}
contact = {contact}
boundary = {{ type = "{boundary}" }}
solver = {{ {solver} }}
""", DATA)


def deformation(strain, dimension):
    F = np.eye(dimension) * (1 - strain) ** (-1 / (dimension - 1))
    F[-1, -1] = 1 - strain
    return F


@dataclasses.dataclass
class Led:
    """Cauchy stresses [Pa] at the looks of every range, and CPU time of a percent of strain there [s]."""
    stress: dict
    seconds: dict


def lead(material, increment, nudge=0.0, tangent=None, ranges=tuple(RANGES), finest=None):
    """Along the ranges; where an increment fails, they end there. `finest`: the increments of the reference instead."""
    state, led, at = grainlaw.State(material), Led({}, {}), 0.0
    for name in ranges:
        looks, fine = RANGES[name]
        stresses, begin, start = [], time.process_time(), at
        for look in looks:
            steps = max(1, round((look - at) / (fine if finest else increment)))
            for strain in np.linspace(at, look, steps + 1)[1:]:
                F = deformation(strain, state.dimension)
                F[0, 0] += nudge if strain < 0.002 or at == 0 and steps == 1 else 0
                found = state.evaluate(F, tangent)
                if not found.ok:
                    return led
                state.commit()
            at = look
            stresses.append(found.P @ F.T / np.linalg.det(F))
        led.stress[name] = np.array(stresses)
        led.seconds[name] = (time.process_time() - begin) / (100 * (at - start))
    return led


@dataclasses.dataclass
class Reference:
    """Paths that differ by nudges: their mean, and how far one of them lies from it, over the largest stress [-]."""
    mean: dict
    spread: dict
    copies: int
    seconds: float


def reference_of(material, copies, ranges=tuple(RANGES)):
    led = [lead(material, 0, NUDGE * k, ranges=ranges, finest=True) for k in range(copies)]
    mean, spread = {}, {}
    for name in ranges:
        paths = np.array([one.stress[name] for one in led if name in one.stress])
        if len(paths) > 1:
            mean[name] = paths.mean(axis=0)
            spread[name] = distance(paths, mean[name])
    seconds = np.mean([sum(one.seconds.values()) / len(one.seconds) for one in led if one.seconds])
    return Reference(mean, spread, copies, float(seconds))


def distance(paths, mean):
    """Root mean square of the distances of stresses from these, over the largest of these [-]."""
    apart = np.linalg.norm(paths - mean, axis=(-2, -1))
    return float(np.sqrt(np.mean(apart**2)) / np.linalg.norm(mean, axis=(-2, -1)).max())
