"""Soils and what plants find in them: moisture, reaction and nutrients in the figures of Ellenberg's indicator values.

F (moisture) runs from 1, dry, to 12, under water; R (reaction) from 1, very acid, to 9, calcareous; N (nutrients) from 1,
very poor, to 9, over-rich. The fields are continuous, so that soils and plants grade into each other.
"""
from dataclasses import dataclass

import numpy as np

from .noise import blur, fractal, smoothstep
from .relief import warped

ALLUVIUM, LOESS, BROWN_EARTH, PODZOL, RENDZINA, PEAT, ROCK = range(1, 8)
SOILS = {  # name, colour on the map, reaction R, nutrients N, what the soil adds to moisture F
    ALLUVIUM: ("alluvium", (122, 160, 178), 6.8, 7.0, 0.3),
    LOESS: ("loess loam", (226, 196, 120), 6.6, 6.2, -0.15),
    BROWN_EARTH: ("brown earth", (166, 124, 82), 4.6, 5.0, 0.1),
    PODZOL: ("podzol on sandstone", (212, 170, 178), 2.8, 2.7, -0.35),
    RENDZINA: ("rendzina on limestone", (238, 226, 176), 8.0, 4.3, -1.0),
    PEAT: ("peat", (92, 64, 92), 2.0, 2.2, 3.0),
    ROCK: ("rock and scree", (150, 150, 150), 3.6, 2.2, -1.3),
}


@dataclass
class Ground:
    soil: np.ndarray
    moisture: np.ndarray
    reaction: np.ndarray
    nutrients: np.ndarray


def make(relief, water, seed, log=print):
    x, y, h, cell = relief.x, relief.y, relief.height, relief.cell
    gy, gx = np.gradient(blur(h, 1), cell)
    gy = -gy  # rows run southwards
    steep = np.hypot(gx, gy)
    slope = np.degrees(np.arctan(steep))
    southness = gy / np.sqrt(1 + steep**2)  # height rises to the north on a slope that faces south
    # Above the mean of the surroundings, near and far: positive on spurs and crests, negative in hollows.
    position = h - blur(h, 100 / cell)
    near_position = h - blur(h, 25 / cell)
    wx, wy = warped(x, y, seed)
    sandstone = smoothstep(210, 330, relief.axis_distance + 0.5 * (wy - y) + 60 * fractal(x, y, 300, 3, (seed, 71)))
    patch = lambda wavelength, key: fractal(x, y, wavelength, 4, (seed, key))

    # The soil with most reasons for it wins; the noise makes patches, the smooth reasons make gradual sequences.
    score = np.zeros((8,) + h.shape)
    score[BROWN_EARTH] = 0.50 + 0.12 * patch(180, 72)
    score[ALLUVIUM] = np.where(relief.plain, 2.0, 0) + 1.2 * (np.exp(-water.brook_distance / 7) * (slope < 9) * (h < 640))
    score[LOESS] = (1.15 * smoothstep(13, 5, slope) * smoothstep(560, 500, h + 14 * patch(300, 73)) *
                    (1 - 0.35 * smoothstep(2, 10, near_position)) + 0.16 * patch(220, 74))
    score[PODZOL] = sandstone * (0.14 + 0.42 * smoothstep(-8, 16, position) + 0.22 * smoothstep(560, 800, h) -
                                 0.30 * smoothstep(6.5, 8.5, water.wetness) + 0.34 * patch(240, 75))
    score[RENDZINA] = (1 - sandstone) * (0.12 + 0.35 * smoothstep(7, 17, slope) + 0.35 * smoothstep(-4, 8, position) +
                                         0.30 * patch(260, 76))
    flat_top = smoothstep(18, 10, slope) * smoothstep(735, 790, h + 22 * patch(260, 77))
    spring = smoothstep(8.3, 9.6, water.wetness) * smoothstep(14, 7, slope) * smoothstep(650, 720, h)
    inflow = smoothstep(95, 40, water.pond_distance) * smoothstep(9.0, 3.5, water.above_water) * smoothstep(16, 8, slope)
    score[PEAT] = (0.66 + 0.60 * patch(230, 78)) * flat_top + 0.75 * flat_top * smoothstep(5.4, 7.0, water.wetness) + spring + 1.4 * inflow
    tor = smoothstep(3.0, 5.5, near_position) * smoothstep(14, 24, slope)
    score[ROCK] = 1.4 * smoothstep(33, 38.5, slope + 3.5 * patch(90, 79)) + 0.9 * tor
    score[ROCK] = np.where(relief.plain, 0, score[ROCK])
    score = np.stack([blur(s, 1) if k else s for k, s in enumerate(score)])
    soil = np.argmax(score, axis=0).astype(np.uint8)

    # Chemistry: each soil's own, blurred over its border, better below and poorer above.
    def of_soil(column, over):
        table = np.zeros(8)
        for code, entry in SOILS.items():
            table[code] = entry[column]
        return blur(table[soil], over / cell)

    lime = 1 - blur(sandstone, 4)
    brown = blur((soil == BROWN_EARTH) | (soil == ROCK), 3)
    foot = smoothstep(6, -14, position) * smoothstep(0.02, 0.2, steep)  # hollows and foot slopes gain what crests lose
    reaction = of_soil(2, 22) + 2.2 * brown * lime + 0.8 * foot - 0.3 * (1 - lime) * smoothstep(600, 850, h) + 0.55 * patch(150, 80) + 0.6 * patch(34, 83)
    nutrients = of_soil(3, 22) + 0.8 * brown * lime + 1.3 * foot - 0.5 * smoothstep(-2, 10, position) + 0.5 * patch(130, 81) + 0.6 * patch(34, 84)

    # Moisture: what flows in, the reach of the ground water, the sun, the rain that comes with height, the soil.
    inflowing = 0.42 * (np.clip(water.wetness, 4.5, 11) - 6.2)
    ground_water = np.where(relief.plain, 2.9 * np.exp(-np.maximum(water.above_water - 0.6, 0) / 1.1), 0)
    margins = 2.0 * np.exp(-water.above_water / 2.5 - np.minimum(water.brook_distance, water.pond_distance) / 22)
    sun = 1.5 * np.clip(southness, -0.55, 0.55)
    rain = 1.0 * (h - 430) / 500
    exposed = 0.35 * np.clip(position / 15, -1, 1)
    moisture = (4.95 + inflowing + blur(ground_water, 2) + margins - sun + rain - exposed + of_soil(4, 10) +
                0.30 * patch(110, 82) + 0.45 * patch(20, 85))  # the last: mounds, stones and old roots
    wet = (relief.river_distance < 7) | water.pond | water.oxbow
    moisture = np.where(wet, 11.0, moisture)
    log("soils: " + ", ".join(f"{SOILS[k][0]} {100 * np.mean(soil == k):.0f} %" for k in SOILS))
    return Ground(soil, np.clip(moisture, 1.5, 11), np.clip(reaction, 1.5, 8.8), np.clip(nutrients, 1.2, 8.6))
