"""What scripts of FEMxDEM do, in small."""
import os
import unittest

import numpy as np
from esys.escript import Function, FunctionOnBoundary, Solution, interpolate, whereZero
from esys.escript.linearPDEs import LinearPDE
from esys.finley import Brick, Rectangle

import grainlaw

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "../../..")
DISCS = os.path.join(ROOT, "adapters/biaxial/material.toml")
SPHERES = os.path.join(ROOT, "adapters/freefem/tests/spheres.toml")
PRESSURE = 1e5   # Pa


def rectangle(nx, ny, order=2):
    """1 m by 1 m."""
    return Rectangle(l0=1, l1=1, n0=nx, n1=ny, order=order, integrationOrder=2)


def brick(n):
    return Brick(l0=1, l1=1, l2=1, n0=n, n1=n, n2=n, order=2, integrationOrder=2)


def count(domain):
    return Function(domain).getX().getNumberOfDataPoints()


def rows(data):
    return np.array(data.toListOfTuples())


def biaxial(domain, strain, pressure=PRESSURE):
    """Smooth ends, the lower one held in the middle or at its corner; the sides pressed."""
    x, bx = domain.getX(), FunctionOnBoundary(domain).getX()
    middle = 0.5 if any(a == 0.5 for a, _ in x.toListOfTuples()) else 0.0
    mask = (whereZero(x[1]) * [0, 1] + whereZero(x[1] - 1) * [0, 1]
            + whereZero(x[1]) * whereZero(x[0] - middle) * [1, 1])
    sides = whereZero(bx[0]) * [pressure, 0] + whereZero(bx[0] - 1) * [-pressure, 0]
    return mask, whereZero(x[1] - 1) * [0, -strain], sides


def rough(domain, strain):
    """Ends that hold, sides pressed."""
    x, bx = domain.getX(), FunctionOnBoundary(domain).getX()
    mask = (whereZero(x[2]) + whereZero(x[2] - 1)) * [1, 1, 1]
    sides = ((whereZero(bx[0]) - whereZero(bx[0] - 1)) * [PRESSURE, 0, 0]
             + (whereZero(bx[1]) - whereZero(bx[1] - 1)) * [0, PRESSURE, 0])
    return mask, whereZero(x[2] - 1) * [0, 0, -strain], sides


def unbalanced(domain, stress, sides, mask):
    """Largest force on the free unknowns over that on the held ones."""
    pde = LinearPDE(domain, numEquations=domain.getDim(), numSolutions=domain.getDim())
    pde.setValue(X=-stress, y=sides)
    force = rows(pde.getRightHandSide())
    free = rows(interpolate(mask, Solution(domain))) == 0
    return np.abs(force[free]).max() / np.abs(force[~free]).max()


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.discs, cls.spheres = grainlaw.Material(DISCS), grainlaw.Material(SPHERES)
