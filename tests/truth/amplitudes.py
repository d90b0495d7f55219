"""Amplitudes of one profile to 40 digits, for src/studies/rendering/known.rs.

Heights are whole numbers by a rule, so that they are exact in any arithmetic; everything after them
is computed with 60 digits by mpmath (python3 amplitudes.py).
"""

from mpmath import mp, mpf, cos, sin, sqrt, log, pi, power

mp.dps = 60
N, BINS = 1000, 500
heights_um = [mpf((7919 * i * i + 3 * i) % 1009) / 64 for i in range(N)]
cosines = [cos(2 * pi * i / N) for i in range(N)]
sines = [sin(2 * pi * i / N) for i in range(N)]
window = [mpf("0.54") - mpf("0.46") * c for c in cosines]
mean = sum(w * z for w, z in zip(window, heights_um)) / sum(window)
weighted = [w * (z - mean) for w, z in zip(window, heights_um)]
squares = sum(w * w for w in window)


def power_um2(k):
    re = sum(x * cosines[k * i % N] for i, x in enumerate(weighted))
    im = sum(x * sines[k * i % N] for i, x in enumerate(weighted))
    whole = 2 * (re * re + im * im) / (N * squares)
    return whole / 2 if k == BINS else whole


powers_um2 = [power_um2(k) for k in range(1, BINS + 1)]


def amplitude_um(speed_mm_per_s, carrier_hz):
    total = mpf(0)
    for k, p in enumerate(powers_um2, 1):
        hz = speed_mm_per_s * mpf("0.23") * k
        if hz < 1000:
            total += p * power(2, -log(hz / carrier_hz, 2) ** 2)
    return sqrt(2 * total)


for speed in ["0.5", "8", "20.25", "87.5", "120", "333.25", "1000"]:
    low, high = (amplitude_um(mpf(speed), carrier) for carrier in (40, 320))
    print(f"    ({speed}, [{mp.nstr(low, 20)}, {mp.nstr(high, 20)}]),")
