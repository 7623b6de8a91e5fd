"""The relief: an old upland surface, a main valley with a meandering river, and what running water has cut since.

Coordinates are metres from the place's south-west corner. The land is made with a margin on all sides, so that ridges and
catchments do not end at the map's edge; the margin is cut off at the end.
"""
from dataclasses import dataclass

import numpy as np

from .drainage import catchment, distance_to, filled, receivers
from .noise import blur, doubled, fractal, ridged, smoothstep

WIDTH, HEIGHT = 4000, 3000


@dataclass
class Relief:
    """Arrays over the grid with its margin; rows run from north to south."""
    x: np.ndarray
    y: np.ndarray
    height: np.ndarray
    cell: float
    margin: float
    river: np.ndarray          # points of the centre line, downstream
    river_distance: np.ndarray
    river_level: np.ndarray    # of the water in the nearest reach
    plain_width: np.ndarray    # half width of the floodplain beside the cell
    axis_distance: np.ndarray  # from the valley's axis, negative south of it
    plain: np.ndarray          # the floodplain


def grid(cell, margin):
    x = np.arange(-margin + cell / 2, WIDTH + margin, cell)
    y = np.arange(HEIGHT + margin - cell / 2, -margin, -cell)
    return np.meshgrid(x, y)


def valley_axis(x):
    """Northing of the main valley's axis."""
    return 820 + 0.08 * (x - 2000) + 165 * np.sin(2 * np.pi * x / 3700 + 0.5) + 60 * np.sin(2 * np.pi * x / 1630 + 2.1)


def water_level(x):
    """The river falls from east to west by 6 m in a kilometre of valley."""
    return 412 + 0.0062 * x


def half_plain(x, seed):
    """Half the floodplain's width."""
    return 118 + 52 * fractal(x, 0 * x + 17.3, 900, 2, (seed, 31))


def river_line(seed, margin):
    """Centre line of a meandering river, from east to west, a point about every 4 m."""
    t = np.arange(WIDTH + margin + 100, -margin - 100, -3.0)
    tangent = np.gradient(valley_axis(t), t)
    norm = np.hypot(1, tangent)
    wavelength = 300 + 150 * fractal(t, 0 * t + 5.1, 600, 2, (seed, 21))
    phase = np.cumsum(2 * np.pi * 3.0 / wavelength)
    room = half_plain(t, seed) - 28
    swing = room * np.clip(0.58 + 0.75 * fractal(t, 0 * t + 9.7, 520, 2, (seed, 22)), 0.15, 1)
    # Second harmonics lean the bends downstream and swell them, as in the sine-generated curve.
    across = swing * np.sin(phase)
    along = 0.27 * swing * np.sin(2 * phase)
    x, y = t + (along - across * tangent) / norm, valley_axis(t) + (along * tangent + across) / norm
    step = np.concatenate([[0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    even = np.arange(0, step[-1], 4.0)
    return np.stack([np.interp(even, step, x), np.interp(even, step, y)], axis=1)


def warped(x, y, seed):
    """The place bent by noise, so that no boundary follows a formula's line."""
    return x + 300 * fractal(x, y, 1700, 3, (seed, 41)), y + 300 * fractal(x, y, 1700, 3, (seed, 42))


def first_surface(x, y, seed):
    """A gentle land that leads the first brooks: hills of all sizes on a slope down to the valley."""
    wx, wy = warped(x, y, seed)
    d = wy - valley_axis(wx)
    slope = np.where(d > 0, 0.16 * d, -0.10 * d)
    return water_level(x) + 6 + slope + 90 * ridged(wx, wy, 1500, 5, (seed, 43)) * smoothstep(0, 500, np.abs(d))


def uplift(x, y, seed):
    """Metres a unit of time: a high block in the north, low hills in the south."""
    wx, wy = warped(x, y, seed)
    d = wy - valley_axis(wx)
    rise = np.where(d > 0, 0.9 + 3.9 * smoothstep(180, 1500, d), 0.8 + 1.5 * smoothstep(200, 900, -d))
    return rise * (1 + 0.45 * fractal(x, y, 1100, 3, (seed, 45)))


def softness(x, y, height, axis_distance, seed):
    """How readily the rock wears: beds of sandstone in the north, limestone over marl in the south."""
    bed = height + 30 * fractal(x, y, 800, 3, (seed, 51)) + 0.04 * x
    north = 1.0 - 0.35 * smoothstep(0.55, 0.95, np.sin(bed / 23.0))
    south = 1.25 - 0.75 * smoothstep(505, 535, bed)
    cracks = 1.6 ** (1.3 * fractal(x, y, 420, 3, (seed, 52)))
    return np.where(axis_distance > 0, north, south) * cracks


def eroded(height, fixed, soft, lift, cell, time, steps, rng, creep):
    """Stream power with n = 1 solved downstream first (Braun and Willett 2013), and soil creep on the slopes."""
    exponent, dt, steepest_slope = 0.42, time / steps, 0.90
    for _ in range(steps):
        height = np.where(fixed, height, height + lift * dt)
        level = filled(height, fixed)
        receiver, length = receivers(level, fixed, cell, rng, 0.35)
        area = catchment(level, receiver, cell)
        factor = (0.24 * soft * area**exponent).ravel() * dt / length
        h, target, f = level.ravel().tolist(), receiver.tolist(), factor.tolist()
        steepest = (length * steepest_slope).tolist()
        for i in np.argsort(level.ravel(), kind="stable").tolist():
            j = target[i]
            if j != i:
                low = h[j]
                new = (h[i] + f[i] * low) / (1 + f[i])
                h[i] = new if new - low < steepest[i] else low + steepest[i]
        height = np.where(fixed, height, np.array(h).reshape(height.shape))
        rounds = max(1, int(np.ceil(creep * dt / (cell * cell) / 0.2)))
        for _ in range(rounds):
            p = np.pad(height, 1, mode="edge")
            bend = p[:-2, 1:-1] + p[2:, 1:-1] + p[1:-1, :-2] + p[1:-1, 2:] - 4 * height
            height = np.where(fixed, height, height + creep * dt / rounds / (cell * cell) * bend)
    return height


def flattened(height, from_m=690.0, room_m=300.0):
    """Rounds the summits to the remains of an old plain, as on many a Central European upland."""
    over = np.maximum(height - from_m, 0)
    return np.where(over > 0, from_m + room_m * (1 - np.exp(-over / room_m)), height)


def floodplain(x, y, distance, axis_distance, seed):
    """Height of the valley floor: a plain that falls gently to the river, with faint old channels."""
    bank = water_level(x) + 1.1
    swales = 0.35 * fractal(x, y, 90, 3, (seed, 61))
    return bank + 0.004 * np.minimum(distance, 300) + 0.5 * smoothstep(60, 220, np.abs(axis_distance)) + swales * smoothstep(12, 40, distance)


def make(seed, log=print, stages=((20, 200, 70), (10, 5, 4), (5, 1.0, 3)), creep=(240.0, 170.0, 80.0)):
    rng = np.random.default_rng((seed, 1))
    height, margin = None, 500
    line = river_line(seed, margin)
    # The river's own surface falls all the way, also where a bend leads back up the valley.
    surface = np.minimum.accumulate(water_level(line[:, 0])) - 1e-4 * np.arange(len(line))
    for (cell, time, steps), slope_creep in zip(stages, creep):
        x, y = grid(cell, margin)
        distance, nearest = distance_to(line, x, y, 420)
        axis_distance = y - valley_axis(x)
        width = half_plain(x, seed)
        plain = np.abs(axis_distance) < width + 26 * fractal(x, y, 260, 3, (seed, 62))
        plain_height = floodplain(x, y, distance, axis_distance, seed)
        if height is None:
            height = first_surface(x, y, seed)
            height = np.where(plain, plain_height, np.maximum(height, plain_height + 1))
            # Neighbouring valleys outside the map take their share, so that the crests lie on it.
            height[0, :], height[-1, :] = 620 + 60 * fractal(x[0], y[0], 900, 2, (seed, 46)), 470
        else:
            height = doubled(flattened(height) if cell == 10 else height)
            if cell == 5:
                height = height + 0.9 * fractal(x, y, 45, 3, (seed, 63)) * smoothstep(8, 120, height - plain_height)
        height = np.where(plain, plain_height, height)
        fixed = plain.copy()
        fixed[0, :] = fixed[-1, :] = True
        soft = softness(x, y, height, axis_distance, seed)
        height = eroded(height, fixed, soft, uplift(x, y, seed), cell, time, steps, rng, slope_creep)
        log(f"relief at {cell} m: {height.min():.0f} to {height.max():.0f} m")

    # Let slope wash round the foot of the slopes.
    foot = blur(plain.astype(float), 20 / cell)
    height = height + (blur(height, 14 / cell) - height) * np.clip(4 * foot * (1 - foot), 0, 1)
    # Cut the channel, 13 m wide and 1.6 m deep under its banks.
    level = np.where(nearest >= 0, surface[nearest], water_level(x))
    bank = smoothstep(4.0, 10.0, distance)
    height = np.where(distance < 12, (level - 0.6) * (1 - bank) + height * bank, height)
    return Relief(x, y, height, cell, margin, line, distance, level, width, axis_distance, plain)
