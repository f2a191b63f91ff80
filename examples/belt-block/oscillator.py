"""The block as one mass: m x'' + c x' + k x = N mu(s) sign(s), s = V(t) - x', sticking where friction at rest can hold it.

Usage: python3 oscillator.py V [EPSILON]    (regularised by phi_epsilon if EPSILON is given)
Prints the cycle it settles in, and some values from the start, at the time of case.toml. Needs numpy and scipy.
"""

import sys

import numpy as np
from scipy.integrate import solve_ivp

M, C, K, N = 1.0, 15.0, 100.0, 10.0
STATIC, KINETIC, DECAY = 0.5, 0.3, 50.0
RAMP = 0.02


def mu(s):
    return KINETIC + (STATIC - KINETIC) * np.exp(-DECAY * abs(s))


def exact(v_belt, end):
    """Arrays t, x, v; stick and slip follow each other at events located to rounding."""
    belt = lambda t: v_belt * min(t / RAMP, 1.0)
    gain = lambda t: v_belt / RAMP if t < RAMP else 0.0
    t, x, v, stick, out = 0.0, 0.0, 0.0, True, []
    while t < end:
        limit = RAMP if t < RAMP else end
        if stick:
            # the mass rides on the belt until the force it needs is more than static friction gives
            need = lambda t, y: M * gain(t) + C * belt(t) + K * y[0] - STATIC * N
            need.terminal, need.direction = True, 1
            run = solve_ivp(lambda t, y: [belt(t)], (t, limit), [x], events=need, rtol=1e-11, atol=1e-13, max_step=1e-3)
            ts, xs = run.t, run.y[0]
            vs = np.array([belt(q) for q in ts])
            stick = run.status != 1
        else:
            def slide(t, y):
                return [y[1], (N * mu(belt(t) - y[1]) - C * y[1] - K * y[0]) / M]
            caught = lambda t, y: belt(t) - y[1] + (1e-12 if t < t0 + 1e-6 else 0.0)
            t0 = t
            caught.terminal, caught.direction = True, -1
            # a push of 1e-9 m/s off the unstable point at which slip begins
            run = solve_ivp(slide, (t, end), [x, v - 1e-9], events=caught, rtol=1e-10, atol=1e-13, max_step=1e-3)
            ts, (xs, vs) = run.t, run.y
            stick = run.status == 1
        out.append(np.array([ts, xs, vs]))
        t, x, v = ts[-1], xs[-1], vs[-1]
    return np.hstack(out)


def regularised(v_belt, epsilon, end):
    def phi(s):
        r = min(abs(s) / epsilon, 1.0)
        return np.sign(s) * (2.0 - r) * r

    def f(t, y):
        s = v_belt * min(t / RAMP, 1.0) - y[1]
        return [y[1], (N * mu(s) * phi(s) - C * y[1] - K * y[0]) / M]

    run = solve_ivp(f, (0, end), [0.0, 0.0], method="Radau", rtol=1e-8, atol=1e-11, max_step=2e-3)
    return np.array([run.t, *run.y])


def cycle(t, x, v, start):
    """Range of x, period, lowest v and highest spring force after `start`."""
    keep = t >= start
    t, x, v = t[keep], x[keep], v[keep]
    middle = 0.5 * (x.max() + x.min())
    down = np.nonzero((x[:-1] > middle) & (x[1:] <= middle))[0]
    times = t[down] + (x[down] - middle) / (x[down] - x[down + 1]) * (t[down + 1] - t[down])
    period = np.diff(times).mean() if len(times) > 1 else float("nan")
    return x.max() - x.min(), period, v.min(), K * x.max()


if __name__ == "__main__":
    speed = float(sys.argv[1])
    epsilon = float(sys.argv[2]) if len(sys.argv) > 2 else None
    end = 0.06 / speed + 8.0
    t, x, v = regularised(speed, epsilon, end) if epsilon else exact(speed, end)
    swing, period, low, force = cycle(t, x, v, 0.05 / speed + 1.0)
    print(f"V {speed}: range {swing * 1e3:.4f} mm, period {period:.5f} s, lowest velocity {low:.6f} m/s, spring {force:.4f} N")
    print(f"  first largest x {x[t < 0.05 / speed].max() if speed < 0.045 else x.max():.7f}")
    for at in (1, 2, 3, 4, 5):
        print(f"  time {1 + at}: x {np.interp(at, t, x):.7f}, v {np.interp(at, t, v):.6f}")
