"""Times of the passes of overhead.pro, told at its end."""
import time

import numpy as np

_last = 0.0
_seconds = {}


def start():
    global _last
    _last = time.process_time()


def pass_done(name):
    _seconds[name] = time.process_time() - _last
    start()


def tables(law):
    run = law._run
    n = len(run.rows)
    cost = {name: 1e6 * seconds / n for name, seconds in _seconds.items()}
    answer = run.answer
    start()
    law._tables(np.tile(np.eye(2), (n, 1, 1)), answer.P, answer.A)
    make = 1e6 * (time.process_time() - _last) / n
    print(f"{n} points, us per point and pass: " + ", ".join(
        f"{name} {value:.1f}" for name, value in cost.items()) + f"; making the tables {make:.1f}")
    added = {name: value - cost["plain"] for name, value in cost.items()}
    total = added["collect"] + 4 * added["tangent"] + 4 * added["traction"] + make
    print(f"the adapter adds {added['empty']:.1f} us per Python[] call, and {total:.0f} us per "
          "point and Newton iteration (1 collect, 4 tangent, 2 traction, 2 stress)")
