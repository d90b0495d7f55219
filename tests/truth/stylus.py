"""Truths for src/studies/stylus: heights of a stylus on a flat wall and on a sine, to 16 digits.

    python3 stylus.py > stylus.csv

A mass that a hand presses down, above a spring and a damper that never pull. Between two changes of
the contact the motion has a closed form; each change is found by mpmath with 40 digits, after a
search with doubles in steps that no change fits between. Columns: every 4 ms, mm.
"""

from mpmath import mp, mpf, mpc, sqrt, exp, cos, sin, findroot, nstr

mp.dps = 40
MASS, PUSH, DAMPING = mpf("0.075"), mpf(1), mpf("0.1")
# Five waves in 2048 points of 0.005 mm, at 50 mm/s.
TURN = 2 * mp.pi * 50 * 5 / (2048 * mpf("0.005"))
EVERY, N = mpf("0.004"), 25


class Wall:
    def __init__(self, stiffness, high):
        self.k, self.high = mpf(stiffness), mpf(high)
        self.b = 2 * DAMPING * sqrt(self.k * MASS)
        self.alpha = self.b / (2 * MASS)
        self.omega = sqrt(self.k / MASS - self.alpha**2)
        spring = self.k + mpc(0, 1) * TURN * self.b
        self.led = spring * self.high / (spring - MASS * TURN**2)

    def surface(self, t):
        return self.high * sin(TURN * t), self.high * TURN * cos(TURN * t)

    def lasting(self, t):
        """Where it ends up while it is pressed, and how fast that moves."""
        z = self.led * exp(mpc(0, 1) * TURN * t)
        return z.imag - PUSH / self.k, (mpc(0, 1) * TURN * z).imag

    def motion(self, start, t):
        at, is_pressed, z, v = start
        s = t - at
        if not is_pressed:
            fall = PUSH / MASS
            return z + v * s - fall * s * s / 2, v - fall * s
        (z0, v0), (z1, v1) = self.lasting(at), self.lasting(t)
        y, w = z - z0, v - v0
        e, c, q = exp(-self.alpha * s), cos(self.omega * s), sin(self.omega * s)
        turn = (w + self.alpha * y) / self.omega
        return (
            z1 + e * (y * c + turn * q),
            v1 + e * (w * c - (self.alpha * turn + self.omega * y) * q),
        )

    def left(self, start, t):
        """Of what is pressed the force, else the depth: what ends where it changes its sign."""
        (z, v), (h, rise) = self.motion(start, t), self.surface(t)
        depth = h - z
        force = self.k * depth + self.b * (rise - v)
        return depth, force

    def steps(self, start, end):
        """Ends of steps that are short beside every motion that is still there."""
        t = start[0]
        while t < end:
            rings = self.alpha * (t - start[0]) < 50
            step = 0.02 / self.omega if rings else mpf("1e-5")
            t = min(t + min(step, mpf("1e-5")), end)
            yield t

    def heights(self, start, ends):
        """Heights at times, mm."""
        found = []
        at, is_pressed, _, _ = start
        last = ends[-1]
        while True:
            changed = None
            before = at
            is_deep = not is_pressed and self.left(start, at)[0] > mpf("1e-25")
            for t in self.steps(start, last):
                depth, force = self.left(start, t)
                if is_pressed:
                    is_over, which = force < 0, 1
                elif is_deep:
                    is_over, which = depth < 0 or force > 0, 0 if depth < 0 else 1
                else:
                    is_over, which = depth > 0, 0
                if is_over:
                    place = lambda t: self.left(start, t)[which]
                    low = before if before > at else at + (t - at) * mpf("1e-9")
                    changed = findroot(place, (low, t), solver="anderson", tol=mpf("1e-60"),
                                       verify=False)
                    break
                before = t
            upto = changed if changed is not None else last
            while len(found) < len(ends) and ends[len(found)] <= upto:
                found.append(1000 * self.motion(start, ends[len(found)])[0])
            if changed is None:
                return found
            z, v = self.motion(start, changed)
            at = changed
            is_pressed = (not is_pressed) and which == (1 if is_deep else 0)
            start = (at, is_pressed, z, v)


print("surface,stiffness_n_per_m," + ",".join(f"z_{n}_mm" for n in range(1, N + 1)))
for surface, high in [("flat", 0), ("sine", mpf("50e-6"))]:
    for stiffness in ["1e1", "1e3", "1e5", "1e7", "1e9"]:
        wall = Wall(stiffness, high)
        z0 = mpf("0.002") if surface == "flat" else -PUSH / wall.k
        start = (mpf(0), surface == "sine", z0, mpf(0))
        heights = wall.heights(start, [EVERY * n for n in range(1, N + 1)])
        print(f"{surface},{stiffness}," + ",".join(nstr(z, 17) for z in heights))
