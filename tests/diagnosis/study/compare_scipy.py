#!/usr/bin/python3
"""The fit of one cause by SciPy's least_squares, to set beside crane's own (bench_fit: the same data, model, bounds and
start values). Opt-in: apt-get install python3-scipy.

    /usr/bin/python3 tests/diagnosis/study/compare_scipy.py      # prints time, parameters and rms
    build/release/bin/bench_fit                                  # ours

A free pendulum of point mass 1 kg and length 0.1531 m with friction of its pivot, phi'' = -g/L sin(phi) - (b phi' +
c tanh(phi'/0.01)) / (m L^2), measured by the University of Washington (../measured/SOURCE.md): b, c and the start are free.
"""
import csv
import math
import pathlib
import time

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

GRAVITY, LENGTH, MASS, SMOOTHING = 9.81, 0.1531, 1.0, 0.01
INERTIA = MASS * LENGTH**2
REPEATS = 5


def measured():
    file = pathlib.Path(__file__).parent.parent / "measured" / "uw_pendulum_id1.csv"
    with open(file, newline="") as text:
        rows = [(float(r["t_s"]), float(r["theta_rad"]) - math.pi) for r in csv.DictReader(text)]
    return numpy.array(rows).T


def slope(_, y, viscous, coulomb):
    torque = viscous * y[1] + coulomb * math.tanh(y[1] / SMOOTHING)
    return [y[1], -GRAVITY / LENGTH * math.sin(y[0]) - torque / INERTIA]


def simulated(p, t):
    """p: angle and speed at the start, friction over the inertia."""
    return solve_ivp(slope, (t[0], t[-1]), p[:2], t_eval=t, args=(p[2] * INERTIA, p[3] * INERTIA), method="LSODA",
                     rtol=1e-6, atol=1e-8).y[0]


def main():
    t, phi = measured()
    start = [phi[0], (phi[1] - phi[0]) / (t[1] - t[0]), 0.02, 0.005]
    bounds = [-numpy.inf, -numpy.inf, 0, 0], [numpy.inf, numpy.inf, 10, 1]
    times = []
    for _ in range(REPEATS):
        begin = time.process_time()
        # A smaller step than a thousandth is lost in the integrator's tolerance: the fit then ends anywhere.
        fit = least_squares(lambda p: simulated(p, t) - phi, start, bounds=bounds, diff_step=1e-3)
        times.append(time.process_time() - begin)
    b, c, rms = fit.x[2] * INERTIA, fit.x[3] * INERTIA, numpy.sqrt(2 * fit.cost / len(t))
    print(f"{1e3 * sorted(times)[REPEATS // 2]:.0f} ms of processor time (median of {REPEATS}), {fit.nfev} rounds; "
          f"b = {b:.3e} N m s/rad, c = {c:.3e} N m, rms {1e3 * rms:.1f} mrad")


if __name__ == "__main__":
    main()
