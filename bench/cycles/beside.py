#!/usr/bin/env python3
"""SilvaVis beside Blender's Cycles: the same models, plants, cameras and sun; one ray a pixel and one towards the sun.

bench/cycles/beside.py [--build build/release] [--work FOLDER] [--scenes unisb-3km,puget-20km] [--views 0,1,2]
    [--ways nested,levels,embree,cycles,deep,nested-opaque,opaque] [--check] [--runs 2] [--threads 2] [--triangles 160000]

Of Cycles' ways, `cycles` passes at most 8 holes of leaves, its default; what lies behind is black. `deep` passes 128, so that both
programs see the same; `opaque` and `nested-opaque` have leaves without holes. --check tells the share of pixels in which Cycles sees
something at another distance than the nested trees.

Prints Markdown; figures are the least of the runs. CPU seconds are user and system seconds of all threads, which other work on the
machine disturbs less than the wall clock (SilvaVis's build, mostly below a second, is by the wall clock). The pictures stay in the work folder as SCENE-VIEW-WAY.exr.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
CYCLES = ("cycles", "deep", "opaque")
VIEWS = ["bird's eye", "flight", "close"]
COLUMNS = [
    ("frame CPU s", "frame_cpu_s", 2),
    ("frame s", "frame_s", 2),
    ("build CPU s", "build_cpu_s", 2),
    ("all CPU s", "all_cpu_s", 1),
    ("peak MB", "peak_mb", 0),
]


def run_child(command, on_line=lambda line, pid: None):
    """Runs a command line by line; its output, CPU seconds and peak of memory in MB."""
    # Blender takes its Python's modules from where the path's first python3 is; that must be the system's.
    program = shutil.which(command[0]) or sys.exit(f"beside.py: error: {command[0]} is missing")
    child = subprocess.Popen(
        [str(word) for word in command],
        executable=program,
        env=os.environ | {"PATH": "/usr/bin:/bin"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    lines = []
    for line in child.stdout:
        on_line(line, child.pid)
        lines.append(line.rstrip("\n"))
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise RuntimeError(f"{command[0]} ended with {child.returncode}:\n" + "\n".join(lines[-15:]))
    return lines, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e6


def cpu_seconds_of(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Phases:
    """When Cycles began each of its phases, by the lines it prints: (CPU seconds, wall seconds)."""

    marks = [
        ("render", "in_cycles: render begins"),
        ("update", "| Updating Scene"),
        ("bvh", "| Updating Geometry BVH"),
        ("bvh end", "| Copying BVH to device"),
        ("sample", "| Sample 0/"),
        ("end", "| Finished"),
    ]

    def __init__(self):
        self.at = {}

    def __call__(self, line, pid):
        for name, text in self.marks:
            if name not in self.at and text in line:
                self.at[name] = (cpu_seconds_of(pid), time.monotonic())

    def between(self, first, last, clock=0):
        return self.at[last][clock] - self.at[first][clock]


def silva_figures(asked, ecosystem, view, way, picture):
    backend = "embree" if way == "embree" else "nested"
    lod = "auto" if way == "levels" else "off"
    lines, cpu_s, peak_mb = run_child(
        [asked.build / "bin/silva_frame", ecosystem, picture, "--view", view, "--backend", backend, "--lod", lod]
        + ["--threads", asked.threads, "--triangles", asked.triangles, "--runs", 1]
        + (["--opaque"] if way == "nested-opaque" else [])
    )
    figures = json.loads(lines[-1])
    return figures | {"all_cpu_s": cpu_s, "peak_mb": peak_mb}


def cycles_figures(asked, dumped, view, way, picture):
    phases = Phases()
    lines, cpu_s, peak_mb = run_child(
        ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", HERE / "in_cycles.py", "--", dumped, picture, "--view", view]
        + ["--threads", asked.threads, "--alpha", "off" if way == "opaque" else "on", "--ambient", asked.ambient]
        + ["--transparent", 128 if way == "deep" else 8],
        phases,
    )
    figures = json.loads(next(line for line in reversed(lines) if line.startswith("{")))
    return figures | {
        "frame_cpu_s": phases.between("sample", "end"),
        "frame_s": phases.between("sample", "end", 1),
        "sync_cpu_s": phases.between("render", "update"),
        "bvh_cpu_s": phases.between("bvh", "bvh end"),
        "build_cpu_s": phases.between("render", "sample"),
        "all_cpu_s": cpu_s,
        "peak_mb": peak_mb,
    }


def share_elsewhere(asked, ecosystem, view, way, picture):
    with tempfile.TemporaryDirectory() as folder:
        lines, _, _ = run_child(
            [asked.build / "bin/silva_frame", ecosystem, f"{folder}/check.exr", "--view", view, "--lod", "off"]
            + ["--triangles", asked.triangles, "--against", picture]
            + (["--opaque"] if way == "opaque" else [])
        )
    return json.loads(lines[-1])["share_elsewhere"]


def least(runs):
    return {key: min(run[key] for run in runs) for key in runs[0] if isinstance(runs[0][key], (int, float))}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=HERE.parents[1] / "build/release")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "silva-cycles")
    parser.add_argument("--scenes", default="unisb-3km,puget-20km")
    parser.add_argument("--views", default="0,1,2")
    parser.add_argument("--ways", default="nested,levels,embree,cycles,deep,nested-opaque,opaque")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--ambient", choices=["on", "off"], default="off")
    parser.add_argument("--runs", type=int, default=2)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--triangles", type=int, default=160000)
    asked = parser.parse_args()
    asked.work.mkdir(parents=True, exist_ok=True)
    print("| scene | plants | view | way | " + " | ".join(name for name, _, _ in COLUMNS) + " | sync, BVH CPU s | elsewhere |")
    print("|---" * (6 + len(COLUMNS)) + "|")
    for scene in asked.scenes.split(","):
        ecosystem, dumped = asked.work / f"{scene}.silva", asked.work / f"{scene}-{asked.triangles}"
        if not ecosystem.exists():
            run_child([asked.build / "bin/silvasim", "run", HERE.parent / f"scenes/{scene}.xml", "-o", ecosystem, "-q"])
        if not (dumped / "scene.json").exists():
            run_child([asked.build / "bin/scene_dump", ecosystem, dumped, "--triangles", asked.triangles])
        for view in (int(number) for number in asked.views.split(",")):
            for way in asked.ways.split(","):
                picture = asked.work / f"{scene}-{view}-{way}.exr"
                measure, source = (cycles_figures, dumped) if way in CYCLES else (silva_figures, ecosystem)
                figures = least([measure(asked, source, view, way, picture) for _ in range(asked.runs)])
                figures.setdefault("build_cpu_s", figures.get("build_s", 0))
                cells = [f"{figures[key]:.{digits}f}" for _, key, digits in COLUMNS]
                parts = f"{figures['sync_cpu_s']:.2f}, {figures['bvh_cpu_s']:.2f}" if "sync_cpu_s" in figures else ""
                check = asked.check and way in CYCLES
                elsewhere = f"{100 * share_elsewhere(asked, ecosystem, view, way, picture):.2f} %" if check else ""
                cells += [parts, elsewhere]
                print(f"| {scene} | {figures['plants']} | {VIEWS[view]} | {way} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, OSError) as error:
        sys.exit(f"beside.py: error: {error}")
