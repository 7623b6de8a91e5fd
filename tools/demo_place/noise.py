"""Gradient noise on a grid, and the small filters that the other modules share.

Everything is keyed by a seed: the same seed gives the same arrays.
"""
import numpy as np


def gradient_noise(x, y, seed):
    """Perlin's gradient noise at the points (x, y), about -0.7 to 0.7; lattice cells have side 1."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, 2 * np.pi, 4096)
    shuffle = rng.permutation(4096)
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    u, v = x - column, y - row

    def corner(dx, dy):
        a = angle[shuffle[(column + dx + shuffle[(row + dy) & 4095]) & 4095]]
        return np.cos(a) * (u - dx) + np.sin(a) * (v - dy)

    # Quintic weights have continuous curvature, so no lattice lines show in a hillshade.
    su, sv = u * u * u * (u * (6 * u - 15) + 10), v * v * v * (v * (6 * v - 15) + 10)
    south = corner(0, 0) * (1 - su) + corner(1, 0) * su
    north = corner(0, 1) * (1 - su) + corner(1, 1) * su
    return south * (1 - sv) + north * sv


def fractal(x, y, wavelength, octaves, seed, gain=0.5):
    """Sum of octaves, about -1 to 1. Each octave is turned, so that lattice directions do not add up."""
    total, amplitude, scale = 0.0, 1.0, 1.0 / wavelength
    for octave in range(octaves):
        turn = 0.7 + 1.1 * octave
        px, py = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
        total = total + amplitude * gradient_noise(px * scale, py * scale, (seed, octave))
        amplitude, scale = amplitude * gain, scale * 2.03
    return total * 1.4 * (1 - gain) / (1 - gain**octaves) / 0.7


def ridged(x, y, wavelength, octaves, seed):
    """Ridged multifractal (Musgrave), 0 to 1: sharp crests, and detail only where it is high already."""
    total, weight, amplitude, scale, norm = 0.0, 1.0, 1.0, 1.0 / wavelength, 0.0
    for octave in range(octaves):
        turn = 0.4 + 1.3 * octave
        px, py = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
        crest = 1 - np.abs(gradient_noise(px * scale, py * scale, (seed, octave))) / 0.7
        crest = np.clip(crest, 0, 1) ** 2
        total = total + amplitude * crest * weight
        weight = np.clip(2 * crest, 0, 1)
        norm += amplitude
        amplitude, scale = amplitude * 0.5, scale * 2.03
    return total / norm


def smoothstep(low, high, value):
    t = np.clip((value - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def blur(grid, radius_cells):
    """Three box filters in a row: close to a Gauss of that standard deviation, at any radius."""
    half = max(1, int(round(radius_cells)))
    out = np.asarray(grid, dtype=np.float64)
    for axis in (0, 1):
        for _ in range(3):
            padding = [(half + 1, half) if a == axis else (0, 0) for a in (0, 1)]
            summed = np.cumsum(np.pad(out, padding, mode="edge"), axis=axis)
            width, n = 2 * half + 1, out.shape[axis]
            out = (np.take(summed, range(width, width + n), axis=axis) - np.take(summed, range(n), axis=axis)) / width
    return out


def doubled(grid):
    """The grid at half its cell size, by quadratic B-splines."""
    for axis in (0, 1):
        padded = np.pad(grid, [(1, 1) if a == axis else (0, 0) for a in (0, 1)], mode="edge")
        n = grid.shape[axis]
        before, here, after = (np.take(padded, range(i, i + n), axis=axis) for i in (0, 1, 2))
        pairs = np.stack([0.25 * before + 0.75 * here, 0.75 * here + 0.25 * after], axis=axis + 1)
        shape = list(grid.shape)
        shape[axis] *= 2
        grid = pairs.reshape(shape)
    return grid
