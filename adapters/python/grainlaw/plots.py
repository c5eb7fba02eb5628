"""Pictures by matplotlib, where it is installed."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from .arrays import Array, Records

Columns = Mapping[str, Array]

KINDS = ("history", "p-q", "e-log-p", "stress-path")
KILO = 1e-3    # Pa in kPa
SAME = 1e-4    # range over size of what a test holds [-]
WIDEST = 4.0   # line of the largest normal force [points]


def _figure(**options: Any) -> Any:
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise ImportError("plot() needs matplotlib (Debian: apt-get install "
                          "python3-matplotlib)") from None
    return Figure(layout="constrained", **options)


def draw(kind: str, columns: Columns, shear: bool | None, spread: Columns | None = None,
         members: Sequence[Columns] = ()) -> Any:
    """A picture of a test by its kind, from its columns. Of an ensemble they are the means: a history
    has a band of the spread, the standard deviation, to either side, a path its members as thin lines.
    """
    if kind not in KINDS:
        raise ValueError(f"kind {kind!r}: expected one of {', '.join(KINDS)}")
    if shear is None:
        shear = bool(np.ptp(columns["shear_strain"]) > np.ptp(columns["axial_strain"]))
    if kind == "history":
        return _history(columns, shear, spread or {})
    return _path(kind, columns, shear, members)


def stiffness(strain: Array, modulus: Array, damping: Array) -> Any:
    """Secant modulus and damping over the strain."""
    figure = _figure(figsize=(6, 6))
    stiff, lossy = figure.subplots(2, 1, sharex=True)
    stiff.semilogx(strain, KILO**2 * modulus, "o-")
    stiff.set_ylabel("secant shear modulus [MPa]")
    stiff.set_ylim(bottom=0)
    lossy.semilogx(strain, damping, "o-")
    lossy.set_ylabel("damping [-]")
    lossy.set_xlabel("amplitude of shear strain [-]")
    return figure


def batch(members: Mapping[tuple[str, float], Columns], shear: bool | None) -> Any:
    """Tests by packing and pressure: a colour a packing, a line style a pressure."""
    figure = _figure(figsize=(9, 7))
    (stress, path), (volume, compression) = figure.subplots(2, 2, sharex="col", sharey="row")
    names = list(dict.fromkeys(name for name, _ in members))
    pressures = list(dict.fromkeys(pressure for _, pressure in members))
    for (name, pressure), columns in members.items():
        sheared = (np.ptp(columns["shear_strain"]) > np.ptp(columns["axial_strain"])
                   if shear is None else shear)
        style = {"color": f"C{names.index(name)}",
                 "linestyle": ("-", "--", "-.", ":")[pressures.index(pressure) % 4]}
        strain = columns["shear_strain" if sheared else "axial_strain"]
        q = KILO * columns["shear_stress" if sheared else "deviatoric_stress"]
        p, e = KILO * columns["mean_pressure"], columns["void_ratio"]
        stress.plot(strain, q, label=f"{name}, {KILO * pressure:g} kPa", **style)
        path.plot(p, q, **style)
        volume.plot(strain, e, **style)
        compression.plot(p, e, **style)
    stress.set_ylabel("q, or shear stress [kPa]")
    stress.legend()
    volume.set_ylabel("void ratio [-]")
    volume.set_xlabel("strain [-]")
    compression.set_xlabel("mean pressure p [kPa]")
    return figure


def _history(columns: Columns, shear: bool, spread: Columns) -> Any:
    figure = _figure(figsize=(6, 7))
    over = columns["shear_strain" if shear else "axial_strain"]
    stress, volume, contacts = figure.subplots(3, 1, sharex=True)
    names = ["shear_stress"] if shear else ["axial_stress", "lateral_stress"]
    for name in [*names, "mean_pressure"]:
        _curve(stress, over, columns, name, spread, KILO, label=name.replace("_", " "))
    stress.set_ylabel("stress [kPa]")
    stress.legend()
    _curve(volume, over, columns, "void_ratio", spread)
    if "void_ratio" not in spread:
        _room(columns["void_ratio"], volume.set_ylim)
    volume.set_ylabel("void ratio [-]")
    _curve(contacts, over, columns, "coordination_no_rattlers", spread)
    contacts.set_ylabel("coordination, no rattlers [-]")
    contacts.set_xlabel("shear strain [-]" if shear else "axial strain [-]")
    return figure


def _path(kind: str, columns: Columns, shear: bool, members: Sequence[Columns]) -> Any:
    """p-q, e-log-p, or stress-path: axial over lateral stress, of a shear the shear stress over the
    normal stress on its planes."""
    figure = _figure(figsize=(6, 5))
    axes = figure.subplots()
    over, name, scale = "mean_pressure", "shear_stress" if shear else "deviatoric_stress", KILO
    below = "mean pressure p [kPa]"
    beside = "shear stress [kPa]" if shear else "deviatoric stress q [kPa]"
    if kind == "e-log-p":
        name, beside, scale = "void_ratio", "void ratio e [-]", 1.0
        axes.set_xscale("log", nonpositive="mask")
        _plain_numbers(axes.xaxis)
    elif kind == "stress-path":
        over, below = ("axial_stress", "normal stress [kPa]") if shear else (
            "lateral_stress", "lateral stress [kPa]")
        if not shear:
            name, beside = "axial_stress", "axial stress [kPa]"
    for one in members:
        axes.plot(KILO * one[over], scale * one[name], color="0.75", linewidth=0.8)
    x = KILO * columns[over]
    axes.plot(x, scale * columns[name])
    axes.plot(x[:1], scale * columns[name][:1], "o", label="start")
    _room(x, axes.set_xlim)
    _room(scale * columns[name], axes.set_ylim)
    axes.set_xlabel(below)
    axes.set_ylabel(beside)
    axes.legend()
    return figure


def _room(values: Array, set_limits: Callable[[float, float], Any]) -> None:
    """Around what a test holds to the tolerance: a scale of rounding errors tells nothing."""
    size = float(abs(values).max())
    if np.ptp(values) < SAME * size:
        set_limits(values.min() - 0.1 * size, values.max() + 0.1 * size)


def _plain_numbers(axis: Any) -> None:
    """200, not 2 x 10^2, on a logarithmic axis."""
    from matplotlib.ticker import ScalarFormatter
    axis.set_major_formatter(ScalarFormatter())
    axis.set_minor_formatter(ScalarFormatter())


def _curve(axes: Any, over: Array, columns: Columns, name: str, spread: Columns, scale: float = 1.0,
           **options: Any) -> None:
    mean = scale * columns[name]
    line, = axes.plot(over, mean, **options)
    if name in spread:
        width = scale * spread[name]
        axes.fill_between(over, mean - width, mean + width, color=line.get_color(), alpha=0.2,
                          linewidth=0)


def packing(particles: Records, contacts: Records) -> Any:
    """Particles and force chains: a bar joins two centres, its width goes with the normal force. Of
    spheres, which are seen along axis 2, the contacts that carry more than the mean."""
    figure = _figure(figsize=(6, 6))
    from matplotlib.collections import LineCollection, PatchCollection
    from matplotlib.patches import Circle
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
