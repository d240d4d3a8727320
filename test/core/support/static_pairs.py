#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes test/data/reference/static_pairs.csv from static_pairs.json beside it, number for number: JSON is a nuisance in C."""
import json
import pathlib

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "data" / "reference"
HEADER = """\
# The pairs of static_pairs.json, one a row; its provenance and licence stand in ../README.md.
# Made by: python3 test/core/support/static_pairs.py
# id,kind,method,ref and for a and b: type,n,n numbers (box: full sizes; cyl: radius, height; sph: radius; poly: vertices),
# 12 numbers of the 3x4 pose by rows. ref is the signed distance as printed there.
"""


def body(shape):
    numbers = shape["p"]
    if shape["t"] == "poly":
        numbers = [x for vertex in numbers for x in vertex]
    pose = [x for row in shape["X"] for x in row]
    return [shape["t"], str(len(numbers))] + [repr(float(x)) for x in numbers + pose]


def main():
    pairs = json.loads((FOLDER / "static_pairs.json").read_text())
    rows = []
    for pair in pairs:
        method = pair["method"].split()[0]
        rows.append(",".join([pair["id"], pair["kind"], method, str(pair["ref"])] + body(pair["a"]) + body(pair["b"])))
    (FOLDER / "static_pairs.csv").write_text(HEADER + "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
