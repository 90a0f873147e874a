"""The same ring and trefoil in PyElastica and here: the energy of the same shape, its discharge, and what they take.

    pip install pyelastica topobatteries
    python benches/peers/pyelastica.py [edges]

Prints the table of docs/for-users-of-pyelastica.md. Both rods have length 50 h, bending modulus E_b, twist stiffness B/(1 + 0.3).
They lose energy in different ways: here by internal viscosity, there by drag on the mass of a rod with inertia. Times are therefore
compared with the clock on the wall and by their steps, not with each other.
"""

import sys
import time
from importlib.metadata import version

import elastica as ea
import numpy as np
import topobatteries as topo

LENGTH = 50.0  # h
DRAG = 0.02  # 1/time: about twice critical for the slowest mode
CONTACT = 20.0
PATIENCE = 240.0  # seconds


class Simulator(ea.BaseSystemCollection, ea.Damping, ea.Contact):
    pass


def directors(points):
    """Frames along a polygon by parallel transport: rows are the two normals and the tangent."""
    tangents = np.diff(points, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    normal = np.cross(tangents[0], [0.3, 0.5, 0.8])
    frames = []
    for tangent in tangents:
        normal = normal - tangent * (normal @ tangent)
        normal /= np.linalg.norm(normal)
        frames.append([normal, np.cross(tangent, normal), tangent])
    return np.moveaxis(np.array(frames), 0, -1)


def elastica_rod(points, contact):
    """An open rod of PyElastica through the vertices, straight and untwisted at rest."""
    frames = directors(points)
    length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    rod = ea.CosseratRod.straight_rod(
        len(points) - 1, points[0].copy(), frames[2, :, 0], frames[0, :, 0], length, 1.0,
        density=1.0, youngs_modulus=1.0, shear_modulus=0.5 / 1.3,
        position=np.ascontiguousarray(points.T), directors=frames,
    )
    step = (0.02 if contact else 0.1) * length / (len(points) - 1)
    simulator = Simulator()
    simulator.append(rod)
    simulator.dampen(rod).using(ea.AnalyticalLinearDamper, uniform_damping_constant=DRAG, time_step=step)
    if contact:
        simulator.detect_contact_between(rod, rod).using(ea.RodSelfContact, k=CONTACT, nu=0.0)
    simulator.finalize()
    return rod, simulator, step


def elastic(rod):
    return rod.compute_bending_energy() + rod.compute_shear_energy()


def elastica_discharge(points, contact, steps=10**9):
    """Energy at the start, steps until 99 % are released, seconds, share released."""
    rod, simulator, step = elastica_rod(points, contact)
    stepper, now, n = ea.PositionVerlet(), np.float64(0.0), 0
    start, bend = elastic(rod), rod.compute_bending_energy()
    clock = time.perf_counter()
    while elastic(rod) > 0.01 * start and n < steps and time.perf_counter() - clock < PATIENCE:
        for _ in range(200):
            now = stepper.step(simulator, now, np.float64(step))
            n += 1
    assert np.isfinite(rod.position_collection).all()
    released = 1 - elastic(rod) / start
    return bend, n, time.perf_counter() - clock, released


def main():
    edges = int(sys.argv[1]) if len(sys.argv) > 1 else 60
    print(f"| {edges} edges | bending energy of the same shape, E_b h³ | steps to 99 % | seconds | a step |")
    print("|---|---|---|---|---|")
    for name in ("0_1", "3_1"):
        charged = topo.Rod(topo.Knot(name).tight(), twist=0.0, edges=edges).charge()
        cut = charged.cut()
        clock = time.perf_counter()
        run = cut.discharge(until_released=0.99)
        seconds = time.perf_counter() - clock
        # once the tips have parted: contact between tips in one place has no direction there
        seen = int(np.argmax(run.samples["time"] > (run.parted or 0.0)))
        points = run.samples["points"][seen]
        bend = np.interp(run.samples["time"][seen], run.time, run.parts["bend"]) * LENGTH
        what = {"0_1": "ring", "3_1": "trefoil"}[name]
        print(f"| {what}, topobatteries | {bend:.4f} | {run.n_steps} | {seconds:.2f} | {1e6 * seconds / run.n_steps:.0f} µs |")
        elastica_discharge(points, name != "0_1", steps=200)  # compiled by numba
        bend, n, seconds, released = elastica_discharge(points, name != "0_1")
        note = "" if released >= 0.99 else f" ({100 * released:.0f} % released)"
        print(f"| {what}, PyElastica {version('pyelastica')} | {bend:.4f} | {n}{note} | {seconds:.2f} | {1e6 * seconds / n:.0f} µs |")


if __name__ == "__main__":
    main()
