#!/usr/bin/env python3
"""Makes the demo place under data/: an invented submontane valley of 4 km by 3 km, with waters, soils and land use.

A developer runs it when the place shall change; users get the files. It needs Python 3, numpy and GDAL's Python, takes
about two minutes, and gives the same files for the same seed and library versions.

    tools/make_demo_place.py [--seed 9] [--out data]
"""
import argparse
from pathlib import Path

from demo_place import ground, landuse, relief, water, write


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=9)
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parent.parent / "data")
    options = parser.parse_args()
    land = relief.make(options.seed)
    waters = water.make(land)
    soils = ground.make(land, waters, options.seed)
    use = landuse.make(land, waters, soils, options.seed)
    options.out.mkdir(parents=True, exist_ok=True)
    write.write(options.out, land, waters, soils, use)


if __name__ == "__main__":
    main()
