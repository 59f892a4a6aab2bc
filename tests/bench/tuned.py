#!/usr/bin/env python3
"""`tests/bench/tuned.py DIR`: what `airlight tune` found against a sweep of the same settings.

DIR has the sweep's runs.jsonl and what tune wrote for each error as ERROR.json. Of each error, by the sweep's own figures: the
quickest setting that reaches it, tune's setting, and the paper's grid, 512 × 2048 × 512; times are over the baseline's.
"""
import json
import pathlib
import sys

PAPER = "vsv:alpha=512:theta=2048:phi=512"

folder = pathlib.Path(sys.argv[1])
runs = {}
for line in (folder / "runs.jsonl").read_text().splitlines():
    run = json.loads(line)
    runs[run["volume"]] = {
        "error": run["error"]["airlight_same_surface"]["rrmse"],
        "ratio": run["timing"]["ratio"]["median"] or run["frame_ms"] / run["timing"]["baseline"]["frame_ms"],
        "bytes": sum(run["bytes"].values()),
    }


def text(volume):
    run = runs[volume]
    return f"{volume} {100 * run['error']:.2f} % × {run['ratio']:.2f} {run['bytes'] / 2**20:.1f} MiB"


print(f"{folder.name}: {len(runs)} settings; the paper's grid: {text(PAPER)}")
for file in sorted(folder.glob("0.*.json"), reverse=True):
    goal = float(file.stem)
    tuned = json.loads(file.read_text())
    reached = [volume for volume, run in runs.items() if run["error"] <= goal]
    print(f"  {100 * goal:g} %")
    if reached:
        print(f"    best:  {text(min(reached, key=lambda volume: runs[volume]['ratio']))}")
    print(f"    tuned: {text(tuned['volume'])}, said {100 * tuned['error']:.2f} %, {100 * tuned['confidence']:.0f} % sure,"
          f" met: {tuned['met']}; {tuned['tried']['frames']} frames, {100 * tuned['tried']['truth_share']:.1f} % of the truth")
