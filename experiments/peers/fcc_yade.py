# The lattice benchmark for Yade: PLUMB_STATE=state.csv PLUMB_STEPS=N PLUMB_OUT=out.csv PLUMB_BOX=L yade -n -x fcc_yade.py
# Yade gives half of the stiffness and damping of two equal bodies in series, hence the factors of two.
import csv
import os
import time

box, steps = float(os.environ["PLUMB_BOX"]), int(os.environ["PLUMB_STEPS"])
reduced_mass = 0.5 * 2500.0 * 3.141592653589793 / 6.0 * 1e-9
grain = ViscElMat(density=2500.0, frictionAngle=atan(0.3), kn=2 * 1000.0, ks=2 * 285.7, cn=2 * 50.0 * reduced_mass,
                  cs=2 * 25.0 * reduced_mass)
O.materials.append(grain)
O.periodic = True
O.cell.setBox(box, box, box)
with open(os.environ["PLUMB_STATE"]) as table:
    for row in list(csv.reader(table))[1:]:
        x, v = [float(q) for q in row[0:3]], [float(q) for q in row[3:6]]
        body = sphere(x, 0.5e-3, material=grain)
        body.state.vel = Vector3(*v)
        O.bodies.append(body)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=2.5e-5, allowBiggerThanPeriod=True),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
                    [Law2_ScGeom_ViscElPhys_Basic()]),
    NewtonIntegrator(damping=0.0, gravity=(0, 0, 0)),
]
O.dt = 2e-6
O.run(1, True)
some = next(iter(O.interactions)).phys
print("contact: kn %g ks %g cn %g cs %g" % (some.kn, some.ks, some.cn, some.cs))
start = time.time()
O.run(steps - 1, True)
seconds = time.time() - start
print("Loop time of %.6f on 1 procs for %d steps with %d atoms" % (seconds, steps - 1, len(O.bodies)), flush=True)
with open(os.environ["PLUMB_OUT"], "w") as out:
    for body in O.bodies:
        s = body.state
        place = O.cell.wrap(s.pos)
        out.write(" ".join("%.17g" % q for q in (*place, *s.vel, *s.angVel)) + "\n")
os._exit(0)  # Yade's own end waits for a prompt
