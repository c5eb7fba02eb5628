"""Series of tests: small strains one after the other, and one test over densities and pressures."""
from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from . import plots
from .arguments import number, several
from .arrays import Array
from .course import Loops
from .material import Material
from .points import State
from .result import Result


class Stiffness:
    """Secant modulus and damping of closed loops of shear at constant volume, as resonant columns and
    bender elements measure them (Hardin & Drnevich 1972).

    strain   (n,) amplitude of the shear strain [-]
    modulus  (n,) G, shear stress over strain between the ends of the loop [Pa]
    damping  (n,) D, work lost in the loop / (4 pi G strain^2 / 2) [-]
    results  of each amplitude
    """

    def __init__(self, results: Sequence[Result], strains: Sequence[float], steps: int) -> None:
        self.results = list(results)
        self.strain: Array = np.array(strains, dtype=float)
        found = [_closed_loop(result, amplitude, steps)
                 for result, amplitude in zip(results, strains)]
        self.modulus: Array = np.array([modulus for modulus, _ in found])
        self.damping: Array = np.array([damping for _, damping in found])

    def plot(self) -> Any:
        """Modulus and damping over the logarithm of strain, a figure of matplotlib."""
        return plots.stiffness(self.strain, self.modulus, self.damping)


def _closed_loop(result: Result, amplitude: float, steps: int) -> tuple[float, float]:
    """The second loop begins and ends at minus the amplitude."""
    first, last = 3 * steps, 7 * steps
    if len(result) <= last:
        raise ValueError(f"the loop of strain {amplitude:.3g} ended first: {result.ended}")
    stress, strain = result.shear_stress[first:last + 1], result.shear_strain[first:last + 1]
    low, high = 0.5 * float(stress[0] + stress[-1]), float(stress[2 * steps])
    modulus = (high - low) / (2 * amplitude)
    lost = float(np.sum(0.5 * (stress[1:] + stress[:-1]) * np.diff(strain)))
    return modulus, lost / (2 * math.pi * modulus * amplitude**2)


def amplitudes(strains: Sequence[float]) -> list[float]:
    """Checked strains of loops."""
    found = [number("strain", strain)
             for strain in several("strains", strains, "several amplitudes, as (1e-6, 1e-4)")]
    if not found or not all(0 < strain < 0.1 for strain in found):
        raise ValueError(f"strains {strains!r}: expected amplitudes above 0 and below 0.1, as 1e-5")
    return found


def loops_of(start: State, strains: Sequence[float], steps: int,
             shear: Callable[..., Result]) -> Stiffness:
    """Each amplitude on a copy of the state."""
    wanted = amplitudes(strains)
    results = [shear(copy.copy(start), strain, strain / steps, loops=Loops(2, strain=strain))
               for strain in wanted]
    return Stiffness(results, wanted, steps)


class Batch:
    """One test of several packings, each from several pressures.

        sands = {"dense": dense, "loose": loose}
        batch = Batch(drained, sands, [50e3, 100e3], strain=0.1)
        batch["dense", 50e3].void_ratio
        batch.plot().savefig("batch.png")

    test(material, consolidation=pressure, **how) is called for each: any test of this module that has
    `consolidation` [Pa].
    """

    results: dict[tuple[str, float], Result]   #: by name and pressure [Pa]

    def __init__(self, test: Callable[..., Result], materials: Mapping[str, Material],
                 pressures: Sequence[float], **how: Any) -> None:
        if not isinstance(materials, Mapping):
            raise TypeError(f"materials {materials!r}: expected them by name, as {{'dense': sand}}")
        pressures = several("pressures", pressures, "several, as [50e3, 100e3]")
        if not materials or not pressures:
            raise ValueError(f"{len(materials)} packings and {len(pressures)} pressures: expected "
                             "one or more of each")
        self.results = {(name, float(pressure)): test(material, consolidation=pressure, **how)
                        for name, material in materials.items() for pressure in pressures}

    def __getitem__(self, key: tuple[str, float]) -> Result:
        return self.results[key]

    def __len__(self) -> int:
        return len(self.results)

    def plot(self, shear: bool | None = None) -> Any:
        """q over strain, q over mean pressure, void ratio over strain and over mean pressure: a curve a
        test, a colour a packing, a figure of matplotlib."""
        return plots.batch({key: result.columns() for key, result in self.results.items()}, shear)
