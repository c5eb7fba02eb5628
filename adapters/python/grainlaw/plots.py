"""Pictures by matplotlib, where it is installed."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .particles import Records
    from .result import Result

WIDEST = 4.0   # line of the largest normal force [points]


def _figure(**options: Any) -> Any:
    try:
        from matplotlib.figure import Figure  # type: ignore[import]
    except ImportError:
        raise ImportError("plot() needs matplotlib (Debian: apt-get install "
                          "python3-matplotlib)") from None
    return Figure(layout="constrained", **options)


def history(result: Result, shear: bool | None) -> Any:
    """Stress, void ratio and coordination number over the strain."""
    figure = _figure(figsize=(6, 7))
    if shear is None:
        shear = bool(np.ptp(result.shear_strain) > np.ptp(result.axial_strain))
    over = result.shear_strain if shear else result.axial_strain
    stress, volume, contacts = figure.subplots(3, 1, sharex=True)
    if shear:
        stress.plot(over, result.shear_stress / 1e3, label="shear stress")
    else:
        stress.plot(over, result.axial_stress / 1e3, label="axial stress")
        stress.plot(over, result.lateral_stress / 1e3, label="lateral stress")
    stress.plot(over, result.mean_pressure / 1e3, label="mean pressure")
    stress.set_ylabel("stress [kPa]")
    stress.legend()
    volume.plot(over, result.void_ratio)
    volume.set_ylabel("void ratio [-]")
    contacts.plot(over, result.coordination_no_rattlers)
    contacts.set_ylabel("coordination, no rattlers [-]")
    contacts.set_xlabel("shear strain [-]" if shear else "axial strain [-]")
    return figure


def packing(particles: Records, contacts: Records) -> Any:
    """Particles and force chains: a bar joins two centres, its width goes with the normal force. Of
    spheres, which are seen along axis 2, the contacts that carry more than the mean."""
    figure = _figure(figsize=(6, 6))
    from matplotlib.collections import LineCollection, PatchCollection  # type: ignore[import]
    from matplotlib.patches import Circle  # type: ignore[import]
    seen = [0, particles["position"].shape[1] - 1]
    axes = figure.subplots()
    axes.set_aspect("equal")
    centre, radius = particles["position"][:, seen], particles["radius"]
    circles = [Circle(place, size) for place, size in zip(centre, radius)]
    axes.add_collection(PatchCollection(circles, facecolor="none", edgecolor="0.7", linewidth=0.5))
    force = np.abs(contacts["normal_force"])
    if len(seen) < particles["position"].shape[1] and len(contacts):
        contacts, force = contacts[force > force.mean()], force[force > force.mean()]
    start = centre[contacts["i"]]
    chains = np.stack([start, start + contacts["branch"][:, seen]], axis=1)
    widths = WIDEST * force / force.max(initial=np.finfo(float).tiny)
    axes.add_collection(LineCollection(chains, linewidths=widths, color="C3"))
    axes.autoscale_view()
    axes.set_xlabel(f"x{seen[0] + 1} [m]")
    axes.set_ylabel(f"x{seen[1] + 1} [m]")
    return figure
