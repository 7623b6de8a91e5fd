"""Where water runs: depressions, receivers, catchments. Rows run from north to south."""
import heapq

import numpy as np

NEIGHBOURS = [(-1, 0, 1.0), (1, 0, 1.0), (0, -1, 1.0), (0, 1, 1.0),
              (-1, -1, 2**0.5), (-1, 1, 2**0.5), (1, -1, 2**0.5), (1, 1, 2**0.5)]


def filled(height, outlet, rise=1e-4):
    """Priority flood (Barnes et al. 2014): every cell gets a way down to an outlet, rising by `rise` at each step."""
    rows, cols = height.shape
    level = height.ravel().tolist()
    done = outlet.ravel().copy()
    heap = [(level[i], i) for i in np.flatnonzero(done).tolist()]
    heapq.heapify(heap)
    done = done.tolist()
    push, pop = heapq.heappush, heapq.heappop
    while heap:
        h, i = pop(heap)
        r, c = divmod(i, cols)
        floor = h + rise
        for dr, dc, _ in NEIGHBOURS:
            rr, cc = r + dr, c + dc
            if 0 <= rr < rows and 0 <= cc < cols:
                j = rr * cols + cc
                if not done[j]:
                    done[j] = True
                    if level[j] < floor:
                        level[j] = floor
                    push(heap, (level[j], j))
    return np.array(level).reshape(rows, cols)


def receivers(level, outlet, cell, rng=None, scatter=0.0):
    """Index of the neighbour that each cell drains to, and the distance. Outlets drain to themselves.

    `scatter` makes the choice of the steepest neighbour a little random, which keeps channels off the grid's directions.
    """
    rows, cols = level.shape
    padded = np.pad(level, 1, constant_values=np.inf)
    best = np.zeros(level.shape)
    receiver = np.arange(rows * cols).reshape(rows, cols)
    length = np.full(level.shape, cell)
    for dr, dc, step in NEIGHBOURS:
        drop = (level - padded[1 + dr:1 + dr + rows, 1 + dc:1 + dc + cols]) / (step * cell)
        choice = drop * (1 + scatter * rng.uniform(-1, 1, level.shape)) if scatter else drop
        better = (drop > 0) & (choice > best)
        best = np.where(better, choice, best)
        receiver = np.where(better, np.arange(rows * cols).reshape(rows, cols) + dr * cols + dc, receiver)
        length = np.where(better, step * cell, length)
    receiver = np.where(outlet, np.arange(rows * cols).reshape(rows, cols), receiver)
    return receiver.ravel(), length.ravel()


def catchment(level, receiver, cell):
    """Square metres that drain through each cell, by single flow."""
    area = [cell * cell] * level.size
    target = receiver.tolist()
    for i in np.argsort(-level.ravel(), kind="stable").tolist():
        j = target[i]
        if j != i:
            area[j] += area[i]
    return np.array(area).reshape(level.shape)


def spread_catchment(level, cell):
    """Square metres that drain through each cell when water parts among all lower neighbours (Quinn et al. 1991)."""
    rows, cols = level.shape
    padded = np.pad(level, 1, constant_values=np.inf)
    shares = []
    for dr, dc, step in NEIGHBOURS:
        drop = np.maximum(level - padded[1 + dr:1 + dr + rows, 1 + dc:1 + dc + cols], 0) / (step * cell)
        shares.append(drop**1.1 * (1.0 if step == 1 else 0.7))
    total = sum(shares)
    shares = [np.where(total > 0, s / np.where(total > 0, total, 1), 0).ravel() for s in shares]
    offsets = [dr * cols + dc for dr, dc, _ in NEIGHBOURS]
    area = np.full(level.size + 2 * cols + 4, cell * cell)
    # Cells of falling height in bunches: inside a bunch the order is kept by the loop.
    order = np.argsort(-level.ravel(), kind="stable").tolist()
    area, table = area.tolist(), np.stack(shares, axis=1).tolist()
    for i in order:
        a = area[i]
        row = table[i]
        for k in range(8):
            s = row[k]
            if s:
                area[i + offsets[k]] += a * s
    return np.array(area[:level.size]).reshape(rows, cols)


def distance_to(points, x, y, reach):
    """Distance from each grid point to the nearest of the points, and which one; `reach` and -1 where all are farther."""
    cell = abs(x[0, 1] - x[0, 0])
    distance, nearest = np.full(x.shape, float(reach)), np.full(x.shape, -1)
    for k, (px, py) in enumerate(points):
        c0, c1 = (int((px + s * reach - x[0, 0]) / cell) for s in (-1, 1))
        r0, r1 = (int((y[0, 0] - py - s * reach) / cell) for s in (1, -1))
        window = np.s_[max(r0, 0):max(r1 + 1, 0), max(c0, 0):max(c1 + 1, 0)]
        d = np.hypot(x[window] - px, y[window] - py)
        closer = d < distance[window]
        distance[window] = np.where(closer, d, distance[window])
        nearest[window] = np.where(closer, k, nearest[window])
    return distance, nearest
