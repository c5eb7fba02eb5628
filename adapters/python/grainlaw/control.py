"""What a path prescribes at a state, component by component, and its derivative."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import Array


@dataclass(frozen=True)
class Condition:
    """What one component is led to, linearly from its value at the start of the step. F of the
    same component is found where a stress is prescribed."""

    #: F [-]; P, sigma, mean (tr sigma / d) [Pa]; difference: of sigma from another component;
    #: stresses: the sum of components of sigma by their weights
    kind: str = "F"
    value: float = 0.0    #: at the end
    added: bool = True    #: value is added to the start; by default F stays as it is
    other: int = 0        #: of a difference: the component that it is from
    weights: Sequence[tuple[int, float]] = ()   #: of stresses: components with what they count [-]

    @property
    def stress(self) -> bool:
        """Whether F of the component is found."""
        return self.kind != "F"


@dataclass(frozen=True)
class Segment:
    """A step: conditions row by row, 11, 12, 21, 22; of spheres 11 to 33."""

    conditions: Sequence[Condition]
    follows: Sequence[int] = ()   #: axes whose stretches keep det F, by one factor
    volume: float = 1.0           #: det F to keep

    @property
    def mixed(self) -> bool:
        """Whether stresses are prescribed."""
        return any(condition.stress for condition in self.conditions)


def cauchy(P: Array, F: Array) -> Array:
    """Cauchy stress P F^T / det F (d, d) [Pa]."""
    result: Array = P @ F.T / np.linalg.det(F)
    return result


def cauchy_tangent(P: Array, A: Array, F: Array) -> Array:
    """Its derivative with respect to F (d, d, d, d) [Pa]."""
    sigma = cauchy(P, F)
    change = np.einsum("iJkL,jJ->ijkL", A, F) + np.einsum("iL,jk->ijkL", P, np.eye(len(F)))
    result: Array = (change / np.linalg.det(F)
                     - np.einsum("ij,Lk->ijkL", sigma, np.linalg.inv(F)))
    return result


def controlled(conditions: Sequence[Condition], F: Array, P: Array,
               A: Array) -> tuple[Array, Array]:
    """What is prescribed, by component (d*d,), and its derivative with respect to F (d*d, d*d)."""
    d = len(F)
    diagonal = [(d + 1) * i for i in range(d)]
    sigma, spatial = cauchy(P, F).ravel(), cauchy_tangent(P, A, F).reshape(d * d, d * d)
    piola, material = P.ravel(), A.reshape(d * d, d * d)
    value, derivative = F.ravel().copy(), np.eye(d * d)
    for k, condition in enumerate(conditions):
        if condition.kind == "P":
            value[k], derivative[k] = piola[k], material[k]
        elif condition.kind == "sigma":
            value[k], derivative[k] = sigma[k], spatial[k]
        elif condition.kind == "mean":
            value[k], derivative[k] = sigma[diagonal].mean(), spatial[diagonal].mean(axis=0)
        elif condition.kind == "difference":
            value[k] = sigma[k] - sigma[condition.other]
            derivative[k] = spatial[k] - spatial[condition.other]
        elif condition.kind == "stresses":
            value[k] = sum(weight * sigma[j] for j, weight in condition.weights)
            derivative[k] = sum(weight * spatial[j] for j, weight in condition.weights)
    return value, derivative


def solve(matrix: Array, right: Array) -> Array:
    """matrix^-1 right, by elimination with the largest pivots. Rows that the others imply, as of
    sigma21 beside sigma12, are left out, and the unknowns that are left without one stay 0."""
    n = len(right)
    work = np.column_stack([matrix, right])
    columns, rank, largest = np.arange(n), 0, 0.0
    for k in range(n):
        rest = np.abs(work[k:, k:n])
        i, j = divmod(int(np.argmax(rest)), n - k)
        pivot = float(rest[i, j])
        largest = max(largest, pivot)
        if not pivot > n * np.finfo(float).eps * largest:
            break
        work[[k, k + i]] = work[[k + i, k]]
        work[:, [k, k + j]] = work[:, [k + j, k]]
        columns[[k, k + j]] = columns[[k + j, k]]
        work[k + 1:] -= np.outer(work[k + 1:, k] / work[k, k], work[k])
        rank = k + 1
    result = np.zeros(n)
    for k in reversed(range(rank)):
        after = work[k, k + 1:rank] @ result[columns[k + 1:rank]]
        result[columns[k]] = (work[k, n] - after) / work[k, k]
    return result


def with_volume(F: Array, follows: Sequence[int], volume: float) -> Array:
    """F with the stretches that follow multiplied by one factor, so that det F is the volume. F at
    which none is stays as it comes out: it is refused when it is evaluated."""
    F = F.copy()
    for _ in range(100):
        ratio = volume / np.linalg.det(F)
        if not ratio > 0 or abs(ratio - 1) <= 4e-16:
            break
        for i in follows:
            F[i, i] *= ratio**(1 / len(follows))
    return F


def follow_volume(derivative: Array, F: Array, follows: Sequence[int]) -> None:
    """Rows of the stretches that follow: of the first of them det F, of the others the difference
    from the first, over their values."""
    d, first = len(F), follows[0]
    for i in follows:
        row = derivative[(d + 1) * i]
        row[:] = 0
        if i == first:
            row[:] = np.linalg.inv(F).T.ravel()
        else:
            row[(d + 1) * i], row[(d + 1) * first] = 1 / F[i, i], -1 / F[first, first]
