"""One step of YADE on a body that own_step has written; run by peers.py, by yade's own Python.

FELDSPAR_PEER: words "LAW FOLDER/BODY STEPS"; LAW is cohesive or jcfpm. Bonds are made between the pairs of the file, with
strengths that nothing reaches; moduli and density are those of the granite.
"""

import csv
import json
import os
import time

law, body, n_steps = os.environ["FELDSPAR_PEER"].split()
n_steps = int(n_steps)
first_steps = 20  # not timed, as in own_step
plane = os.path.basename(body).startswith("plane")

strong = 1e30
if law == "cohesive":
    # Bonds with normal, shear, bending and twisting stiffness.
    material = CohFrictMat(
        young=60e9, poisson=0.4, density=3200, frictionAngle=0.5, isCohesive=True, normalCohesion=strong,
        shearCohesion=strong, momentRotationLaw=True, alphaKr=0.1, alphaKtw=0.1, etaRoll=-1, etaTwist=-1,
    )
    shape = Ig2_Sphere_Sphere_ScGeom6D()
    physics = Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True, setCohesionOnNewContacts=False)
    response = Law2_ScGeom6D_CohFrictPhys_CohesionMoment()
else:
    # Bonds with normal and shear stiffness, as in the jointed cohesive particle model.
    material = JCFpmMat(
        young=60e9, poisson=0.4, density=3200, frictionAngle=0.5, tensileStrength=strong, cohesion=strong, type=1
    )
    shape = Ig2_Sphere_Sphere_ScGeom()
    physics = Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1)
    response = Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM()
O.materials.append(material)

with open(body + "-grains.csv", encoding="ascii") as file:
    for row in csv.reader(file):
        x, y, z, u, v, w, radius = map(float, row)
        grain = sphere((x, y, z), radius, material=0)
        grain.state.vel = (u, v, w)
        if plane:
            grain.state.blockedDOFs = "zXY"
        O.bodies.append(grain)

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()]),
    InteractionLoop([shape], [physics], [response]),
    NewtonIntegrator(damping=0.7),
]
O.dt = 0.3 * PWaveTimeStep()
with open(body + "-joints.csv", encoding="ascii") as file:
    for row in csv.reader(file):
        createInteraction(int(row[0]), int(row[1]))

O.run(first_steps, True)
start = time.perf_counter()
O.run(n_steps, True)
taken = time.perf_counter() - start

bonds = sum(1 for i in O.interactions if i.isReal and (i.phys.cohesionBroken is False if law == "cohesive" else i.phys.isCohesive))
print("RESULT", json.dumps({"seconds_of_a_step": taken / n_steps, "bonds": bonds}))
