"""One step of ESyS-Particle on a body that own_step has written; run by peers.py under mpirun with one process that leads
and one for each worker.

    esys_step.py FOLDER/BODY STEPS WORKERS

Bonds with normal, shear, bending and twisting stiffness between the pairs of the file, with strengths that nothing
reaches; modulus and density are those of the granite.
"""

import csv
import json
import math
import os
import sys
import time

from esys.lsm import LsmMpi, RotBondPrms, RotLocalDampingPrms
from esys.lsm.util import BoundingBox, Vec3

body, n_steps, n_workers = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
first_steps = 20  # not timed, as in own_step
plane = os.path.basename(body).startswith("plane")


def rows(name):
    with open(f"{body}-{name}.csv", encoding="ascii") as file:
        return [row for row in csv.reader(file)]


grains = [[float(number) for number in row] for row in rows("grains")]
joints = rows("joints")
largest = max(row[6] for row in grains)
low = [min(row[c] for row in grains) - 2 * largest for c in range(3)]
high = [max(row[c] for row in grains) + 2 * largest for c in range(3)]

# Pairs can be given in a file of its own format only.
geometry = f"{body}-{os.getpid()}.geo"
with open(geometry, "w", encoding="ascii") as file:
    corners = " ".join(f"{number:.9g}" for number in low + high)
    file.write(f"LSMGeometry 1.2\nBoundingBox {corners}\nPeriodicBoundaries 0 0 0\nDimension {'2D' if plane else '3D'}\n")
    file.write(f"BeginParticles\nSimple\n{len(grains)}\n")
    for number, (x, y, z, _, _, _, radius) in enumerate(grains):
        file.write(f"{x:.17g} {y:.17g} {z:.17g} {radius:.17g} {number} 1\n")
    file.write(f"EndParticles\nBeginConnect\n{len(joints)}\n")
    for first, second in joints:
        file.write(f"{first} {second} 0\n")
    file.write("EndConnect\n")

model = LsmMpi(numWorkerProcesses=n_workers, mpiDimList=[1, n_workers, 1] if plane else [1, 1, n_workers])
model.initNeighbourSearch(particleType="RotSphere", gridSpacing=5 * largest, verletDist=0.2 * largest)
model.setTimeStepSize(0.1 * min(row[6] for row in grains) * math.sqrt(3200 / 60e9))
if plane:
    model.force2dComputations(True)
model.readGeometry(geometry)
os.remove(geometry)
model.setParticleDensity(tag=1, mask=-1, Density=3200)
for number, row in enumerate(grains):
    model.setParticleVelocity(id=number, Velocity=Vec3(*row[3:6]))
model.createInteractionGroup(
    RotBondPrms(
        name="bonds", normalK=60e9, shearK=24e9, torsionK=6e9, bendingK=6e9, normalBrkForce=1e30, shearBrkForce=1e30,
        torsionBrkForce=1e30, bendingBrkForce=1e30, tag=0, scaling=True, meanR_scaling=True, truncated=1e30,
    )
)
model.createInteractionGroup(RotLocalDampingPrms(name="damping", viscosity=0.7))


def run(n):
    for _ in range(n):
        model.runTimeStep()


run(first_steps)
start = time.perf_counter()
run(n_steps)
taken = time.perf_counter() - start
print("RESULT", json.dumps({"seconds_of_a_step": taken / n_steps, "bonds": len(joints)}), flush=True)
model.exit()
