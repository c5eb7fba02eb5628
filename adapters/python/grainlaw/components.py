"""Conditions by the names of components, as in a [[segment]] of a scene: F11, dF12, P22, sigma11."""
from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from .arguments import number
from .control import Condition

KINDS = {"F": ("F", False), "dF": ("F", True), "P": ("P", False), "sigma": ("sigma", False)}


def read_conditions(d: int, components: Mapping[str, float | str], isochoric: bool,
                    mean_pressure: float | None,
                    tension: bool) -> tuple[list[Condition], Sequence[int]]:
    """Conditions row by row, and the axes whose stretches keep det F. Raises TypeError for what is
    no component, ValueError for what cannot be meant, as tension of contacts that bear none."""
    conditions = [Condition() for _ in range(d * d)]
    given: dict[int, str] = {}
    for name, value in components.items():
        found = re.fullmatch(rf"(F|dF|P|sigma)([1-{d}])([1-{d}])", name)
        if not found:
            raise TypeError(f"{name} is no condition; expected F, dF, P or sigma with two of the "
                            f"axes 1 to {d}, as F{d}{d} or sigma11")
        k = d * (int(found[2]) - 1) + int(found[3]) - 1
        if k in given:
            raise ValueError(f"{name} is a second condition beside {given[k]}")
        given[k] = name
        conditions[k] = _condition(name, value, *KINDS[found[1]], d, mean_pressure)
        if (k % (d + 1) == 0 and conditions[k].kind in ("P", "sigma") and not tension
                and conditions[k].value > 0):
            raise ValueError(f"{name} is {value}, which is tension; expected a number <= 0, as contacts "
                             "without bonds carry none")
        if (k % (d + 1) == 0 and conditions[k].kind == "F"
                and 1 * conditions[k].added + conditions[k].value <= 0.5):
            raise ValueError(f"{name} is {value}; expected a stretch: 1 undeformed, 0.99 after 1 % "
                             "of compression; dF adds to what was reached")
    free = sum(condition.kind == "mean" for condition in conditions)
    if mean_pressure is not None and free != 1:
        raise ValueError(f"{free} components of F are \"free\" beside mean_pressure; expected one, "
                         "which is found: F11=\"free\"")
    follows = [i for i in range(d) if isochoric and (d + 1) * i not in given]
    if isochoric and not follows:
        raise ValueError("isochoric, and all of the diagonal of F has a condition; expected one "
                         "without, which follows det F")
    _check_differences(conditions, d)
    return conditions, follows


def _check_differences(conditions: Sequence[Condition], d: int) -> None:
    """Each difference has to bind two stresses that those before it leave apart: what is bound twice
    leaves F of a component without a condition. sigma is symmetric, so sigma21 is sigma12."""
    def name(k: int) -> str:
        return f"sigma{k // d + 1}{k % d + 1}"

    group = [min(k, d * (k % d) + k // d) for k in range(d * d)]
    for k, condition in enumerate(conditions):
        if condition.kind != "difference":
            continue
        one, other = group[k], group[condition.other]
        if one == other:
            raise ValueError(f"{name(k)} is \"{name(condition.other)}\", which it is already by another "
                             "condition or as sigma is symmetric; expected one condition for each F "
                             "that is found")
        group = [one if of == other else of for of in group]


def _condition(name: str, value: float | str, kind: str, added: bool, d: int,
               mean_pressure: float | None) -> Condition:
    if not isinstance(value, str):
        return Condition(kind, number(name, value), added)
    if kind == "F" and not added and value == "free" and mean_pressure is not None:
        return Condition("mean", -mean_pressure, False)
    other = re.fullmatch(rf"sigma([1-{d}])([1-{d}])", value)
    if kind != "sigma" or not other or value == name:
        raise ValueError(f"{name} is {value!r}; expected a number, of sigma the name of another "
                         "stress, of F \"free\" beside mean_pressure")
    return Condition("difference", 0.0, False, d * (int(other[1]) - 1) + int(other[2]) - 1)
