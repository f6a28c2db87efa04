#!/usr/bin/env python3
"""Markdown table of the slider drags that `dolp-bench window` measured. Usage: window_table.py RESULT.json"""
import json
import sys

HEADER = ("drag", "slider", "band", "fresh curves / s", "longest gap, s", "final curve after, s",
          "frames, ms: median / worst")


def row(drag):
    return [drag["scene"], f"`{drag['key']}`", "yes" if drag["is_band"] else "no", f"{drag['fresh_curves_per_s']:.0f}",
            f"{drag['longest_gap_s']:.2f}", f"{drag['final_s']:.2f}",
            f"{drag['frame_ms_median']:.0f} / {drag['frame_ms_max']:.0f}"]


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        drags = json.load(file)["drags"]
    print("| " + " | ".join(HEADER) + " |\n" + "|---" * len(HEADER) + "|")
    for drag in drags:
        print("| " + " | ".join(row(drag)) + " |")


if __name__ == "__main__":
    main()
