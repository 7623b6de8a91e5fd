"""Standing and running water on the relief: a dammed pond in a side valley, an oxbow beside the river, the brooks.

Dams and cut-off bends are written into the relief, so that all later steps see one surface.
"""
from dataclasses import dataclass

import numpy as np

from .drainage import catchment, distance_to, filled, receivers, spread_catchment
from .noise import blur, smoothstep
from .relief import HEIGHT, WIDTH, valley_axis, water_level


@dataclass
class Water:
    pond: np.ndarray              # masks on the relief's grid
    oxbow: np.ndarray
    brooks: list                  # polylines, downstream
    brook_distance: np.ndarray    # metres, to brooks
    pond_distance: np.ndarray
    above_water: np.ndarray       # metres above the brook, river or pond that the cell drains to
    wetness: np.ndarray           # topographic wetness index
    catchment: np.ndarray


def edges(shape):
    mask = np.zeros(shape, bool)
    mask[0, :] = mask[-1, :] = mask[:, 0] = mask[:, -1] = True
    return mask


def inside_map(relief, border=0.0):
    return ((relief.x > border) & (relief.x < WIDTH - border) & (relief.y > border) & (relief.y < HEIGHT - border))


def dam_a_pond(relief, log):
    """Raises a dam, 20 m high, across the side valley where it holds back most water; returns the pond's mask."""
    outlet = edges(relief.height.shape)
    level = filled(relief.height, outlet)
    receiver, _ = receivers(level, outlet, relief.cell)
    area = catchment(level, receiver, relief.cell)
    cols = relief.height.shape[1]
    places = (inside_map(relief, 350) & (area > 2.5e5) & (area < 1.5e6) & (relief.axis_distance > 330) &
              (relief.height < 620))
    best, best_score = None, 0.0
    for i in np.flatnonzero(places)[::7]:
        r, c = divmod(int(i), cols)
        # Where the brook comes from and goes to, 12 cells each way.
        down = int(i)
        for _ in range(12):
            down = int(receiver[down])
        dy, dx = down // cols - r, down % cols - c
        norm = np.hypot(dx, dy)
        if norm < 8:
            continue
        crest = relief.height[r, c] + 20.0
        rr, cc = np.mgrid[max(r - 90, 0):r + 90, max(c - 90, 0):c + 90]
        rr, cc = np.clip(rr, 0, relief.height.shape[0] - 1), np.clip(cc, 0, cols - 1)
        along, across = ((cc - c) * dx + (rr - r) * dy) / norm, ((cc - c) * dy - (rr - r) * dx) / norm
        low = relief.height[rr, cc] < crest
        behind = low & (along < 0) & (np.abs(across) < 40) & (along > -75)
        length = (low & (np.abs(along) < 0.7)).sum() * relief.cell
        cells = behind.sum()
        if length < 260 and cells / (length + 60) > best_score:
            best, best_score = (r, c, dx / norm, dy / norm), cells / (length + 60)
    r, c, ux, uy = best
    crest = relief.height[r, c] + 20.0
    rr, cc = np.indices(relief.height.shape)
    along, across = (cc - c) * ux + (rr - r) * uy, (cc - c) * uy - (rr - r) * ux
    near = (np.abs(across) * relief.cell < 150)
    # The dam's top is 6 m wide, its sides fall 1 in 2; the spillway lies 1.5 m under the top.
    bank = crest - np.maximum(np.abs(along) * relief.cell - 3, 0) / 2
    bank = np.where((np.abs(across + 6) * relief.cell < 9), np.minimum(bank, crest - 1.5), bank)
    relief.height = np.where(near & (bank > relief.height), bank, relief.height)
    flooded = filled(relief.height, outlet, rise=0.0)
    pond = (flooded - relief.height > 0.25) & (along < 0) & (np.hypot(along, across) < 130)
    log(f"pond at {relief.x[r, c]:.0f} {relief.y[r, c]:.0f}, {crest - 1.5:.0f} m, {pond.sum() * relief.cell**2 / 1e4:.1f} ha")
    return pond


def cut_an_oxbow(relief, log):
    """A cut-off bend where the floodplain is widest opposite the river."""
    best, best_room = None, 0.0
    for t in np.arange(500, WIDTH - 500, 20.0):
        for side in (-1, 1):
            width = relief.plain_width[0, int((t + relief.margin) / relief.cell)]
            centre = np.array([t, valley_axis(t) + side * (width - 62)])
            room = np.hypot(*(relief.river - centre).T).min() - 62
            if room > best_room:
                best, best_room = (centre, side), room
    if best is None or best_room < 4:
        log(f"no oxbow: room {best_room:.0f} m")
        return np.zeros(relief.height.shape, bool)
    centre, side = best
    dx, dy = relief.x - centre[0], relief.y - centre[1]
    radius, angle = np.hypot(dx * 0.82, dy), np.arctan2(side * dy, dx)
    half = 7.5 * np.sqrt(np.clip(1 - np.abs((angle - np.pi / 2) / 2.1) ** 3, 0, 1))
    depth = smoothstep(0, 4, half - np.abs(radius - 44))
    relief.height = relief.height - 1.7 * depth
    log(f"oxbow at {centre[0]:.0f} {centre[1]:.0f}, room {best_room:.0f} m")
    return (depth > 0.45) & (half > 2)


def brook_lines(relief, receiver, area, stop, least_m2):
    """Polylines along the receivers from every head, each down to a line that is there already or to other water."""
    cols = relief.height.shape[1]
    wet = (area > least_m2) & ~stop
    into = np.zeros(area.size, bool)
    into[receiver[wet.ravel()]] = True
    heads = np.flatnonzero(wet.ravel() & ~into)
    taken, lines = np.zeros(area.size, bool), []
    for head in heads[np.argsort(relief.height.ravel()[heads], kind="stable")]:
        chain, i = [int(head)], int(head)
        while not taken[i] and not stop.ravel()[i] and int(receiver[i]) != i:
            taken[i] = True
            i = int(receiver[i])
            chain.append(i)
        if len(chain) > 12:
            lines.append(np.array([(relief.x[k // cols, k % cols], relief.y[k // cols, k % cols]) for k in chain]))
    return lines


def smoothed(line, rounds):
    """Corners of the grid rounded; the ends stay."""
    for _ in range(rounds):
        line = np.concatenate([line[:1], (line[:-2] + 2 * line[1:-1] + line[2:]) / 4, line[-1:]])
    return line


def make(relief, log=print):
    pond = dam_a_pond(relief, log)
    oxbow = cut_an_oxbow(relief, log)
    outlet = edges(relief.height.shape)
    river = relief.river_distance < 7.5
    still = river | pond | oxbow

    def drain():
        level = filled(relief.height, outlet)
        receiver, _ = receivers(level, outlet, relief.cell)
        return level, receiver, catchment(level, receiver, relief.cell)

    level, receiver, area = drain()
    brooks = [smoothed(line, 5) for line in brook_lines(relief, receiver, area, river | pond, 1.0e5)]
    # Each brook has cut its bed a little.
    dense = np.concatenate([np.stack([np.interp(np.arange(0, len(b), 0.5), np.arange(len(b)), b[:, k]) for k in (0, 1)], axis=1)
                            for b in brooks])
    brook_distance, _ = distance_to(dense, relief.x, relief.y, 300)
    relief.height = relief.height - np.where(still, 0, 0.9 * (1 - smoothstep(1.5, 8, brook_distance)))
    level, receiver, area = drain()

    # Height above the water that a cell drains to, from the water upwards.
    base = (still | (brook_distance < 3.6)).ravel()
    surface = relief.height.ravel().copy()
    surface[river.ravel()] = relief.river_level.ravel()[river.ravel()]
    low, target = surface.tolist(), receiver.tolist()
    for i in np.argsort(level.ravel(), kind="stable").tolist():
        if not base[i] and target[i] != i:
            low[i] = low[target[i]]
    above = np.maximum(relief.height - np.array(low).reshape(level.shape), 0)
    gy, gx = np.gradient(blur(level, 1), relief.cell)
    spread = spread_catchment(level, relief.cell)
    wetness = np.log(spread / relief.cell / np.maximum(np.hypot(gx, gy), 0.01))
    points = np.stack([relief.x[pond], relief.y[pond]], axis=1)
    pond_distance, _ = distance_to(points[::3], relief.x, relief.y, 300)
    return Water(pond, oxbow, brooks, brook_distance, pond_distance, blur(above, 1), blur(wetness, 1), area)
