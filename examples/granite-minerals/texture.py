#!/usr/bin/env python3
"""Draws texture.png: a thin section of a granite, as a segmented picture has it.

Crystals grow from random points, each at its own speed and, of biotite, as flakes; noise makes their boundaries rough. The
shares are those of minerals.csv, to a crystal.
"""

import numpy
from matplotlib import image

PIXEL = 0.05  # mm
WIDTH, HEIGHT = 400, 800
COLOURS = {"quartz": (0xB8, 0xC4, 0xD0), "plagioclase": (0xF0, 0xE4, 0xD4), "K-feldspar": (0xE0, 0xA8, 0x90),
           "biotite": (0x50, 0x50, 0x50)}
SHARES = {"quartz": 0.22, "plagioclase": 0.47, "K-feldspar": 0.20, "biotite": 0.11}
SIZES = {"quartz": 2.5, "plagioclase": 3.0, "K-feldspar": 4.0, "biotite": 2.0}  # mm

random = numpy.random.Generator(numpy.random.PCG64(1))
rows, columns = numpy.mgrid[0:HEIGHT, 0:WIDTH] * PIXEL
area = WIDTH * HEIGHT * PIXEL**2
rough = sum(
    random.uniform(0.03, 0.06) * numpy.sin(2 * numpy.pi * (columns * a + rows * b) + phase)
    for a, b, phase in random.uniform([-2, -2, 0], [2, 2, 2 * numpy.pi], size=(24, 3))
)
least = numpy.full((HEIGHT, WIDTH), numpy.inf)
colour = numpy.zeros((HEIGHT, WIDTH, 3), dtype=numpy.uint8)
for name, share in SHARES.items():
    for _ in range(round(share * area / (numpy.pi / 4 * SIZES[name] ** 2))):
        x, y = random.uniform([0, 0], [WIDTH * PIXEL, HEIGHT * PIXEL])
        angle, stretch = random.uniform(0, numpy.pi), 3.0 if name == "biotite" else 1.4
        along = (columns - x) * numpy.cos(angle) + (rows - y) * numpy.sin(angle)
        across = (rows - y) * numpy.cos(angle) - (columns - x) * numpy.sin(angle)
        distance = numpy.hypot(along / stretch**0.5, across * stretch**0.5) / SIZES[name] + 0.25 * rough
        nearer = distance < least
        least[nearer] = distance[nearer]
        colour[nearer] = COLOURS[name]
image.imsave("texture.png", colour)
for name, rgb in COLOURS.items():
    print(f"{name}: {100 * (colour == rgb).all(axis=2).mean():.1f} %")
