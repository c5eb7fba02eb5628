#!/usr/bin/env python3
"""Friction angles of one packing on the paths of a smooth wall, and the bounds that follow from them: of Ka and Kp (Rankine) and
of the pressure under a strip footing over the surcharge beside it, without weight (Prandtl, Reissner; below it with Davis' angle
of a sand that does not dilate).

  strength.py MATERIAL.toml [kPa ...]

The packing is led to each vertical stress without lateral strain; then it is stretched (active) or compressed (passive)
across, while the vertical stress stays. The peak is the largest angle of a test, the critical one the mean of all tests beyond
half of their strain. Each stress counts as much as it is, as depths do in the force on a wall."""
import sys
import warnings

import numpy as np

import grainlaw
from grainlaw import laboratory

WAYS = {"active": 0.06, "passive": -0.12}     # lateral strain [-]
STEP = 5e-4      # viscous_rate of materials with drag


def angles(stress):
    """Of mobilised friction [degrees], of the stresses of a test."""
    half = (stress[:, 0, 0] - stress[:, 1, 1]) / 2
    shear = (stress[:, 0, 1] + stress[:, 1, 0]) / 2
    return np.degrees(np.arcsin(np.hypot(half, shear) / -np.trace(stress, axis1=1, axis2=2) * 2))


def led(material, vertical, strain):
    state = grainlaw.State(material)
    state.consolidate(-vertical / 2 * np.eye(2))
    first = state.consolidate(-vertical * np.eye(2), route="k0")
    test = laboratory.path(state, round(abs(strain) / STEP), dF11=strain, sigma22=-vertical, tolerance=1e-6)
    return first[0, 0] / first[1, 1], angles(test.sigma)


def K(phi):
    """Rankine's passive coefficient of a friction angle [degrees]; the active one is 1 over it."""
    return np.tan(np.radians(45 + phi / 2)) ** 2


def Nq(phi):
    return np.exp(np.pi * np.tan(np.radians(phi))) * K(phi)


def main():
    warnings.simplefilter("ignore")           # what drag carries is told by every test
    material = grainlaw.Material(sys.argv[1])
    stresses = [float(text) for text in sys.argv[2:] or [10]]
    peaks, ends = {way: [] for way in WAYS}, []
    for kilopascals in stresses:
        for way, strain in WAYS.items():
            K0, phi = led(material, 1e3 * kilopascals, strain)
            peaks[way].append(phi.max())
            ends.append(phi[len(phi) // 2:].mean())
            print(f"{kilopascals:g} kPa, {way}: K0 {K0:.3f}, friction angle {phi.max():.1f} at the peak, "
                  f"{ends[-1]:.1f} at the end")
    critical, peak = np.mean(ends), np.mean(sum(peaks.values(), []))
    davis = np.degrees(np.arctan(np.sin(np.radians(critical))))
    active = np.average(1 / K(np.array(peaks["active"])), weights=stresses)
    passive = np.average(K(np.array(peaks["passive"])), weights=stresses)
    print(f"critical angle {critical:.1f}, from {min(ends):.1f} to {max(ends):.1f}; peak {peak:.1f}")
    print(f"Ka from {active:.3f} (peak) to {1 / K(critical):.3f} (critical)")
    print(f"Kp from {K(critical):.3f} (critical) to {passive:.3f} (peak)")
    print(f"Nq from {Nq(davis):.1f} (critical, Davis) to {Nq(peak):.1f} (peak)")


if __name__ == "__main__":
    main()
