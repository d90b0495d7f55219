"""Truths for src/studies/statistics: distribution tails, fits and posteriors, to twenty digits.

    python3 statistics.py > statistics.csv

Computed by mpmath 1.4 with 50 digits (QUEST+ with 25) from the very doubles that the study gives;
the posterior of a psychometric function by Gauss-Legendre quadrature. `condition` is the relative
condition number: by how much the result moves, in parts of itself, when an input moves by a part
of itself; of fits the ratio of the largest to the smallest eigenvalue of the information.
"""

import numpy as np
from mpmath import (mp, mpf, beta, betainc, diff, eigsy, erfc, exp, findroot, log, lu_solve,
                    matrix, nstr, pi, quad, sqrt)

mp.dps = 50
ROOT2 = sqrt(mpf(2))


def normal_lower(z):
    return erfc(-z / ROOT2) / 2


def normal_density(z):
    return exp(-z * z / 2) / sqrt(2 * pi)


def t_upper(t, df):
    return betainc(df / 2, mpf(1) / 2, 0, df / (df + t * t), regularized=True) / 2


def f_upper(f, d1, d2):
    return betainc(d2 / 2, d1 / 2, 0, d2 / (d2 + d1 * f), regularized=True)


def binomial_at_least(k, n, p):
    return betainc(k, n - k + 1, 0, p, regularized=True)


def row(what, case, args, value, condition):
    a, b, c = (list(args) + [None] * 3)[:3]
    cells = ["" if x is None else repr(float(x)) for x in (a, b, c)]
    quoted = f'"{case}"' if "," in case else case
    print(",".join([what, quoted, *cells, nstr(value, 20), nstr(condition, 6)]))


def condition(f, x, value):
    return abs(x * diff(f, x) / value)


print("what,case,a,b,c,value,condition")
for z in [-0.5, -2.0, -6.0, -12.0, -20.0, -30.0, -37.0]:
    x = mpf(z)
    value = normal_lower(x)
    row("normal tail", f"z {z:g}", [z], value, abs(x * normal_density(x) / value))
for p in [0.4, 0.025, 1e-6, 1e-12, 1e-50, 1e-150, 1e-300]:
    x = mpf(p)
    guess = -sqrt(-2 * log(x)) if p < 0.1 else mpf(-0.25)
    z = findroot(lambda z: log(normal_lower(z)) - log(x), guess)
    row("normal quantile", f"p {p:g}", [p], z, abs(x / (z * normal_density(z))))
for tail, df in [(0.025, 7.0), (1e-6, 7.0), (1e-12, 3.0), (1e-12, 200.0), (1e-100, 5.0),
                 (0.1, 1e6)]:
    x, n = mpf(tail), mpf(df)
    low, high = mpf(0), mpf(1)
    while t_upper(high, n) > x:
        high *= 2
    for _ in range(220):
        middle = (low + high) / 2
        low, high = (middle, high) if t_upper(middle, n) > x else (low, middle)
    slope = diff(lambda t: t_upper(t, n), low)
    row("t quantile", f"tail {tail:g}, df {df:g}", [tail, df], low, abs(x / (low * slope)))
for f, d1, d2 in [(1.0, 3.0, 30.0), (30.0, 3.0, 30.0), (1e4, 2.0, 77.0), (3e3, 15.0, 105.0),
                  (1e8, 15.0, 77.0), (1e-8, 4.0, 12.0)]:
    x, a, b = mpf(f), mpf(d1), mpf(d2)
    value = f_upper(x, a, b)
    row("F tail", f"F {f:g}, df {d1:g} and {d2:g}", [f, d1, d2], value,
        condition(lambda x: f_upper(x, a, b), x, value))
# Equal degrees of freedom at 1: one half, by symmetry.
half = mpf(50000)
row("F tail", "F 1, df 1e5 and 1e5", [1.0, 1e5, 1e5], mpf(1) / 2,
    2 / (beta(half, half) * mpf(2) ** (2 * half)))
for k, n, p in [(30, 80, 0.25), (70, 80, 0.25), (80, 80, 0.25), (384, 384, 0.25), (600, 1000, 0.5),
                (1000, 1000, 0.5)]:
    x = mpf(p)
    value = binomial_at_least(mpf(k), mpf(n), x)
    row("binomial tail", f"{k} of {n} at {p:g}", [k, n, p], value,
        condition(lambda x: binomial_at_least(mpf(k), mpf(n), x), x, value))


# Choices of one item among several: (chosen, among, how often); Newton's method to 50 digits.
def fitted(n, choices):
    values = matrix(n, 1)
    for _ in range(200):
        gradient, information = matrix(n, 1), matrix(n, n)
        for chosen, among, times in choices:
            weights = [exp(values[i]) for i in among]
            shares = [w / sum(weights) for w in weights]
            gradient[chosen] += times
            for i, p in zip(among, shares):
                gradient[i] -= times * p
                for j, q in zip(among, shares):
                    information[i, j] += times * ((p if i == j else 0) - p * q)
        # The sum of all values is none of the data's business.
        fixed = information + matrix([[mpf(1)] * n] * n)
        step = lu_solve(fixed, gradient)
        scale = max(abs(s) for s in step)
        values += step * min(mpf(1), 1 / scale if scale else mpf(1))
        if scale < mpf(10) ** -40:
            break
    assert scale < mpf(10) ** -40
    eigenvalues = sorted(eigsy(information, eigvals_only=True))[1:]
    return values, eigenvalues[-1] / eigenvalues[0]


def pairs(n, wins):
    return [(i, (i, j), wins(i, j)) for i in range(n) for j in range(n) if i != j and wins(i, j)]


BRADLEY_TERRY = {
    "8 items, even": (8, lambda i, j: 3 + (7 * i + 5 * j) % 11),
    "16 in a chain, 9 to 1": (16, lambda i, j: {1: 9, -1: 1}.get(j - i, 0)),
    "8 items, once in 10⁶ otherwise": (8, lambda i, j: 1000000 if i < j else 1),
}
for case, (n, wins) in BRADLEY_TERRY.items():
    values, ratio = fitted(n, pairs(n, wins))
    for item in range(n):
        row("Bradley-Terry", case, [item], values[item], ratio)


def ranking(n, r):
    return sorted(range(n), key=lambda i: ((3 * i + 5 * r * r + i * r) % 13, i))


for case, n, n_rankings in [("6 items, 20 rankings", 6, 20), ("12 items, 60 rankings", 12, 60)]:
    choices = []
    for r in range(n_rankings):
        best_first = ranking(n, r)
        for place in range(n - 1):
            choices.append((best_first[place], tuple(best_first[place:]), 1))
    values, ratio = fitted(n, choices)
    for item in range(n):
        row("Plackett-Luce", case, [item], values[item], ratio)


# Gumbel function of the study: F = 1/2 at the threshold, a width from 5 to 95 %.
LOW, HIGH = log(-log(mpf("0.95"))), log(-log(mpf("0.05")))
MIDDLE = log(log(mpf(2)))


def gumbel(z):
    return 1 - exp(-exp(MIDDLE + (HIGH - LOW) * z))


# QUEST+: the posterior mean of the threshold, uniform from -20 to 20 dB, width 10, lapses 2 %.
ANSWERS = [(x, (3 * n + x // 4) % 4 != 0 if x > -4 else n % 3 == 0)
           for n, x in enumerate([12, 8, 4, 0, -4, 0, 4, 2, -2, 6, -6, 2, 0, 4, -4, 2] * 2)]


def likelihood(threshold):
    value = mpf(1)
    for x, is_right in ANSWERS:
        share = gumbel((x - threshold) / 10)
        p = mpf(1) / 3 + (1 - mpf(1) / 3 - mpf("0.02")) * share
        value *= p if is_right else 1 - p
    return value


mp.dps = 25
places = [mpf(x) for x in range(-20, 21, 4)]
mass = quad(likelihood, places)
mean = quad(lambda t: t * likelihood(t), places) / mass
sd = sqrt(quad(lambda t: (t - mean) ** 2 * likelihood(t), places) / mass)
row("QUEST+ mean", "32 answers", [sd], mean, sd / abs(mean))

# A fit: the median of the threshold's posterior. Widths are log-normal about 10 dB with a standard
# deviation of 0.5, no farther than exp(1.6) from it; lapse rates exponential with mean 0.02 up to
# 0.12; thresholds flat.
nodes, weights = np.polynomial.legendre.leggauss(40)
ln_widths, lapses = 1.6 * nodes, 0.06 * (nodes + 1)
width_weights = weights * np.exp(-0.5 * (ln_widths / 0.5) ** 2)
lapse_weights = weights * np.exp(-lapses / 0.02)
PLACES = [float(MIDDLE), float(HIGH - LOW)]


def fit_mass(thresholds, blocks, largest):
    widths = 10 * np.exp(ln_widths)
    log_likelihood = 0
    for x, n, right in blocks:
        z = (x - thresholds[:, None, None]) / widths[None, :, None]
        share = -np.expm1(-np.exp(PLACES[0] + PLACES[1] * z))
        lapse = lapses[None, None, :]
        p = 1 / 3 + (1 - 1 / 3 - lapse) * share
        log_likelihood = log_likelihood + right * np.log(p) + (n - right) * np.log(1 - p)
    both = np.exp(log_likelihood - largest) * width_weights[None, :, None]
    both *= lapse_weights[None, None, :]
    return both.sum(axis=(1, 2))


FITS = {
    "5 × 20 answers": [(-12, 20, 7), (-6, 20, 9), (0, 20, 13), (6, 20, 18), (12, 20, 20)],
    "5 × 400 answers": [(-12, 400, 140), (-6, 400, 172), (0, 400, 262), (6, 400, 370),
                        (12, 400, 392)],
    "none of 10, then all": [(-6, 10, 0), (6, 10, 10)],
}
for case, blocks in FITS.items():
    # The study's grid has no threshold beyond the stimuli by more than this; nor has the truth.
    low, high = blocks[0][0], blocks[-1][0]
    beyond = max(10.0, 0.5 * (high - low))
    edges = np.linspace(low - beyond, high + beyond, 1601)
    middles, step = 0.5 * (edges[1:] + edges[:-1]), edges[1] - edges[0]
    # Every answer as likely as its share is more than any function makes of them.
    largest = sum(sum(k * np.log(k / n) for k in (right, n - right) if k) for _, n, right in blocks)
    parts = np.array_split(middles, 16)
    mass = np.concatenate([fit_mass(part, blocks, largest) for part in parts])
    mass /= mass.sum()
    below = np.concatenate([[0], np.cumsum(mass)])
    median = np.interp(0.5, below, edges)
    mean = (mass * middles).sum()
    sd = np.sqrt((mass * (middles - mean) ** 2).sum())
    row("psychometric fit", case, [sd], mpf(float(median)), sd / abs(median))
