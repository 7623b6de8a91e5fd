"""What people made of the place: a village on dry ground by a brook's mouth, meadows, fields on the loess, roads."""
from dataclasses import dataclass
import heapq

import numpy as np

from .drainage import NEIGHBOURS, distance_to
from .ground import ALLUVIUM, LOESS
from .noise import blur, fractal, smoothstep
from .relief import HEIGHT, WIDTH
from .water import inside_map, smoothed

VILLAGE, MEADOW, FIELD = 1, 2, 3
NAMES = {VILLAGE: "village", MEADOW: "meadow", FIELD: "field"}


@dataclass
class LandUse:
    codes: np.ndarray   # 0 is forest land
    roads: list         # (class, polyline)


def cheapest_path(relief, cost_extra, start, goal, easy_grade=0.055, factor=4):
    """Way from start to goal on a grid of 20 m that would rather go round than climb."""
    def coarse(grid):
        r, c = grid.shape[0] // factor, grid.shape[1] // factor
        return grid[:r * factor, :c * factor].reshape(r, factor, c, factor).mean(axis=(1, 3))

    height, extra = coarse(relief.height), coarse(cost_extra)
    cell, (rows, cols) = relief.cell * factor, height.shape
    index = lambda p: (int((HEIGHT + relief.margin - p[1]) / cell) * cols + int((p[0] + relief.margin) / cell))
    h, e, goal, start = height.ravel().tolist(), extra.ravel().tolist(), index(goal), index(start)
    # Knight's moves beside the eight neighbours: more directions, fewer corners.
    moves = [(dr, dc, s) for dr, dc, s in NEIGHBOURS]
    moves += [(a, b, 5**0.5) for a in (-2, -1, 1, 2) for b in (-2, -1, 1, 2) if abs(a) != abs(b)]
    best, came, heap = {start: 0.0}, {}, [(0.0, start)]
    while heap:
        cost, i = heapq.heappop(heap)
        if i == goal:
            break
        if cost > best[i]:
            continue
        r, c = divmod(i, cols)
        for dr, dc, step in moves:
            rr, cc = r + dr, c + dc
            if 0 <= rr < rows and 0 <= cc < cols:
                j = rr * cols + cc
                grade = abs(h[j] - h[i]) / (step * cell)
                new = cost + step * cell * (1 + (grade / easy_grade) ** 2 + 0.5 * (e[i] + e[j]))
                if new < best.get(j, 1e30):
                    best[j], came[j] = new, i
                    heapq.heappush(heap, (new, j))
    chain = [goal]
    while chain[-1] != start:
        chain.append(came[chain[-1]])
    r, c = np.divmod(np.array(chain[::-1]), cols)
    points = np.stack([(c + 0.5) * cell - relief.margin, HEIGHT + relief.margin - (r + 0.5) * cell], axis=1)
    step = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    even = np.arange(0, step[-1], 8.0)
    return smoothed(np.stack([np.interp(even, step, points[:, k]) for k in (0, 1)], axis=1), 30)


def village_site(relief, water, ground, slope):
    """Dry, gentle ground near a brook and the plain, in the western half."""
    suits = (smoothstep(9, 3, slope) * smoothstep(2.0, 5.0, water.above_water) * smoothstep(320, 180, np.abs(relief.axis_distance)) *
             (ground.soil == LOESS) * inside_map(relief, 500) * smoothstep(160, 60, water.brook_distance))
    suits = blur(suits, 60 / relief.cell)
    return np.unravel_index(np.argmax(suits), suits.shape)


def make(relief, water, ground, seed, log=print):
    x, y, cell = relief.x, relief.y, relief.cell
    gy, gx = np.gradient(blur(relief.height, 2), cell)
    slope = np.degrees(np.arctan(np.hypot(gx, gy)))
    r, c = village_site(relief, water, ground, slope)
    centre = (x[r, c], y[r, c])
    away = np.hypot(x - centre[0], y - centre[1])
    wet = (relief.river_distance < 7) | water.pond | water.oxbow

    # Roads keep out of the wet plain, save where they must cross.
    extra = np.where(relief.plain, 3.0, 0) + np.where(wet, 10.0, 0) + np.where(water.brook_distance < 6, 1.5, 0)
    west, east = ((relief.margin * s + t, y[np.argmin(np.abs(relief.axis_distance[:, 0] - 150)), 0]) for s, t in ((-0.9, 0), (0.9, WIDTH)))
    east = (east[0], y[np.argmin(np.abs(relief.axis_distance[:, -1] - 190)), 0])
    pond_middle = (x[water.pond].mean() - 90, y[water.pond].mean() - 60)
    high = inside_map(relief, 300) & (y > HEIGHT - 700)
    summit = np.unravel_index(np.argmax(np.where(high, relief.height - 0.02 * away, 0)), high.shape)
    south = (centre[0] + 650, 130.0)
    roads = [("road", cheapest_path(relief, extra, west, centre)), ("road", cheapest_path(relief, extra, centre, east)),
             ("track", cheapest_path(relief, extra * 0.5, centre, south, 0.10)),
             ("track", cheapest_path(relief, extra * 0.5, centre, pond_middle, 0.10)),
             ("track", cheapest_path(relief, extra * 0.5, pond_middle, (x[summit], y[summit]), 0.11))]
    # Houses gather along the roads by the village green.
    near_road, _ = distance_to(np.concatenate([line for _, line in roads[:3]]), x, y, 300)
    built = smoothstep(270, 120, away) * smoothstep(95, 35, near_road) * (slope < 12) * ~relief.plain
    village = blur(built + 0.6 * smoothstep(130, 60, away), 3) + 0.12 * fractal(x, y, 60, 2, (seed, 91)) > 0.5

    patch = lambda wavelength, key: fractal(x, y, wavelength, 3, (seed, key))
    plain = blur(relief.plain, 3)
    bank_wood = 26 + 16 * patch(140, 92)   # trees keep the banks
    meadow = ((plain > 0.6) & (relief.river_distance > bank_wood) & (water.brook_distance > 14) & (water.above_water > 0.7) &
              (patch(420, 93) > -0.22) & ~blurred_near(water.oxbow, 24, cell))
    meadow |= ((blur(ground.soil == LOESS, 3) > 0.5) & (slope < 13) & (away < 620 + 200 * patch(300, 94)) & (patch(260, 95) > 0.05) &
               (water.brook_distance > 16))
    field = ((blur(ground.soil == LOESS, 3) > 0.6) & (slope < 8.5) & (plain < 0.3) & (patch(380, 96) > -0.12) &
             (water.brook_distance > 22))
    codes = np.zeros(x.shape, np.uint8)
    for mask, code in ((meadow, MEADOW), (field, FIELD), (village, VILLAGE)):
        codes[blur(mask & ~wet, 2) > 0.5] = code
    codes[wet] = 0
    log("land use: " + ", ".join(f"{NAMES[k]} {100 * np.mean(codes == k):.1f} %" for k in NAMES) + f"; village at {centre}")
    return LandUse(codes, roads)


def blurred_near(mask, reach, cell):
    return blur(mask, reach / cell / 2) > 0.02
