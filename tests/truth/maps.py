"""Truths for src/studies/mds: the lowest losses that SciPy finds of one matrix of whole numbers.

    python3 maps.py > maps.csv

Dissimilarities are whole numbers by a rule, so that they are the same anywhere. Losses are made
small by SciPy's L-BFGS-B from random starts, disparities by SciPy's isotonic regression: after
sorting ties by distance (primary), or of the means of ties (secondary). On a line, where hardly a
start ends well, objects of the best maps are moved from place to place until none helps.
"""

import sys
from math import isqrt

import numpy as np
from scipy.optimize import isotonic_regression, minimize

N = 16


def place(n):
    return (7919 * n * n + 3 * n) % 1009


def dissimilarity(i, j):
    squares = sum((place(4 * i + a) - place(4 * j + a)) ** 2 for a in range(4))
    return max(1, (isqrt(squares) + (31 * i * i + 17 * j * j + 7 * i * j) % 301 - 150) // 60)


PAIRS = [(i, j) for i in range(N) for j in range(i + 1, N)]
I, J = (np.array(side) for side in zip(*PAIRS))
DELTA = np.array([dissimilarity(i, j) for i, j in PAIRS])
LEVELS, BLOCK, COUNT = np.unique(DELTA, return_inverse=True, return_counts=True)


def disparities(d, ties):
    if ties == "primary":
        order = np.lexsort((d, DELTA))
        fitted = np.empty_like(d)
        fitted[order] = isotonic_regression(d[order]).x
        return fitted
    means = np.bincount(BLOCK, d) / COUNT
    return isotonic_regression(means, weights=COUNT).x[BLOCK]


def square_of_loss(x, k, ties, loss):
    x = x.reshape(N, k)
    apart = x[I] - x[J]
    d = np.sum(apart**2, axis=1)
    if loss == "stress1":
        d = np.sqrt(d)
    whole = np.sum(d**2)
    off = d - disparities(d, ties)
    f = np.sum(off**2) / whole
    slope = 2 * (off - f * d) / whole
    factor = slope / np.maximum(d, 1e-300) if loss == "stress1" else 2 * slope
    push = factor[:, None] * apart
    gradient = np.zeros_like(x)
    np.add.at(gradient, I, push)
    np.add.at(gradient, J, -push)
    return f, gradient.ravel()


def descended(x, *case):
    x = np.asarray(x, float).ravel()
    how = {"maxiter": 2000, "ftol": 1e-15, "gtol": 1e-11}
    found = minimize(square_of_loss, x / np.std(x), case, "L-BFGS-B", True, options=how)
    return found.fun, found.x


def moved(best, *case):
    """On a line: any object in any other's place, as long as that helps."""
    while True:
        f, x = best
        order = np.argsort(x)
        for i in range(N):
            for to in range(N):
                rest = np.delete(order, np.where(order == i))
                ranks = np.empty(N)
                ranks[np.insert(rest, to, i)] = np.arange(N)
                # The same places, taken by the objects in their new order.
                tried = descended(np.sort(x)[ranks.astype(int)], *case)
                if tried[0] < best[0] - 1e-13:
                    best = tried
        if best[0] >= f:
            return best


random = np.random.default_rng(1)
print("dims,ties,loss,value")
for k, n_starts in [(1, 100), (2, 100), (3, 100)]:
    for ties in ["primary", "secondary"]:
        for loss in ["stress1", "sstress"]:
            case = (k, ties, loss)
            found = [descended(random.normal(size=N * k), *case) for _ in range(n_starts)]
            found.sort(key=lambda one: one[0])
            if k == 1:
                found = sorted((moved(one, *case) for one in found[:3]), key=lambda one: one[0])
            print(f"{k},{ties},{loss},{np.sqrt(found[0][0]):.12g}")
            sys.stdout.flush()
