#!/usr/bin/env python3
"""Writes plate.msh, the mesh of a square plate with a round hole in its middle, for `Sample/Mesh file` (Gmsh's format 2.2).

    python3 examples/plate-with-hole/mesh.py

Lengths in mm. Rays run from the hole to the sides, AROUND of them at equal angles and among these the four to the
corners; along a ray each element is GROWTH times as long as the one before it.
"""

import math
import os

SIDE = 500.0
RADIUS = 50.0
AROUND = 24  # a multiple of 8, so that rays meet corners and axes
OUTWARD = 9
GROWTH = 1.18


def node(ray, ring):
    """x, y: on the hole for ring 0, on the sides for ring OUTWARD."""
    angle = 2.0 * math.pi * ray / AROUND
    cosine, sine = math.cos(angle), math.sin(angle)
    to_side = 0.5 * SIDE / max(abs(cosine), abs(sine))
    share = (GROWTH**ring - 1.0) / (GROWTH**OUTWARD - 1.0)
    distance = RADIUS + share * (to_side - RADIUS)
    return 0.5 * SIDE + distance * cosine, 0.5 * SIDE + distance * sine


def side(first, second):
    """Number of the physical group of an outer edge."""
    for group, (axis, place) in enumerate(((0, 0.0), (0, SIDE), (1, 0.0), (1, SIDE)), start=1):
        if all(abs(end[axis] - place) < 1e-6 for end in (first, second)):
            return group
    raise ValueError(f"the edge from {first} to {second} lies on no side")


def main():
    number = lambda ray, ring: ring * AROUND + ray % AROUND + 1
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "5"]
    lines += [f'1 {k} "{name}"' for k, name in enumerate(("left", "right", "bottom", "top"), start=1)]
    lines += ['2 5 "rock"', "$EndPhysicalNames", "$Nodes", str(AROUND * (OUTWARD + 1))]
    for ring in range(OUTWARD + 1):
        for ray in range(AROUND):
            x, y = node(ray, ring)
            lines.append(f"{number(ray, ring)} {x:.6f} {y:.6f} 0")
    elements = [
        f"1 2 {group} {group} {number(ray, OUTWARD)} {number(ray + 1, OUTWARD)}"
        for ray in range(AROUND)
        for group in [side(node(ray, OUTWARD), node(ray + 1, OUTWARD))]
    ]
    elements += [
        f"3 2 5 5 {number(ray, ring)} {number(ray, ring + 1)} {number(ray + 1, ring + 1)} {number(ray + 1, ring)}"
        for ring in range(OUTWARD)
        for ray in range(AROUND)
    ]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{k} {element}" for k, element in enumerate(elements, start=1)]
    lines.append("$EndElements")
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "plate.msh"), "w", encoding="ascii") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
