"""Launches followed by diffrax, for `bench_sweep`: needs jax, diffrax and the mechanics of this package."""

import importlib
import json
import os
import resource
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from tippetop.mechanics.friction import ViscousFriction
from tippetop.mechanics.motion import sliding_rates
from tippetop.mechanics.shape import EccentricSphere
from tippetop.mechanics.state import SlidingState
from tippetop.mechanics.top import Kind

jax: Any = importlib.import_module("jax")
diffrax: Any = importlib.import_module("diffrax")
KIND = Kind(EccentricSphere, ViscousFriction, 1, 1)


def rates(_: Any, y: Any, numbers: Any) -> Any:
    state = SlidingState(
        (y[0], y[1], y[2]), (y[3], y[4], y[5]), (y[6], y[7]), (0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    )
    rate = sliding_rates(state, KIND.top(tuple(numbers)))
    return jax.numpy.stack([*rate.axis, *rate.momentum, *rate.velocity])


def solver(end: float, tolerance: float) -> Any:
    """All launches at once, compiled."""

    def one(y: Any, numbers: Any) -> Any:
        return diffrax.diffeqsolve(
            diffrax.ODETerm(rates),
            diffrax.Dopri8(),
            0.0,
            end,
            None,
            y,
            numbers,
            saveat=diffrax.SaveAt(t1=True),
            stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
            max_steps=None,
        ).ys[0]

    return jax.jit(jax.vmap(one))


def main() -> None:
    jax.config.update("jax_enable_x64", True)
    job = json.loads(Path(sys.argv[2]).read_text())
    given = np.load(os.environ["TIPPETOP_STARTS"])
    chosen = np.searchsorted(given["spins"], np.array(job["spins"]))
    rows, numbers = given["rows"][:, chosen].T, given["numbers"][:, chosen].T
    solve = solver(float(given["end"]), job["tolerance"])
    solve(rows, numbers).block_until_ready()
    time.sleep(max(0.0, job["start"] - time.time()))
    clock, used = time.perf_counter(), sum(os.times()[:2])
    y = np.asarray(solve(rows, numbers).block_until_ready()).T
    clock, used = time.perf_counter() - clock, sum(os.times()[:2]) - used
    found = np.arctan2(np.hypot(y[0], y[1]), y[2])
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({"found": found.tolist(), "clock": clock, "used": used, "memory": memory}))


if __name__ == "__main__":
    main()
