#!/usr/bin/env python3
"""One orbit and many by phaselab and by heyoka, in turn on the same machine.

In: the release build of phaselab, the Python packages heyoka and numpy. Out: a table of CPU time per unit of time, the
ratio of both, and the drift of the energy of each; and the CPU time of many orbits. The equations that heyoka integrates are those that
`phaselab derive` prints, so both integrate the same right-hand sides; where the mass matrix is not eliminated, it is here. Compilation and start-up are not counted: for
heyoka only `propagate_until` is timed, for phaselab a run is subtracted from one ten times as long: both write machine code.

    cargo build --release
    python3 benches/beside_heyoka.py target/release/phaselab
"""

import json
import math
import os
import re
import resource
import subprocess
import sys
import tempfile
import time

import heyoka
import numpy

def chain(n):
    """A chain of n equal pendula on massless rods of length 1."""
    x = ["+".join(f"cos(a{j})*a{j}'" for j in range(1, i + 1)) for i in range(1, n + 1)]
    y = ["+".join(f"sin(a{j})*a{j}'" for j in range(1, i + 1)) for i in range(1, n + 1)]
    kinetic = "+".join(f"1/2*(({u})^2+({v})^2)" for u, v in zip(x, y))
    potential = "+".join(f"g*cos(a{j})*{n - j + 1}" for j in range(1, n + 1))
    coordinates = {f"a{j}": (0.5 + 0.1 * j, 0.0) for j in range(1, n + 1)}
    return coordinates, {"g": 9.81}, f"{kinetic}+{potential}"


# the Sun with the inner planets, Jupiter, Saturn, Uranus, Neptune: E. Hairer, C. Lubich and G. Wanner, Geometric Numerical
# Integration, I.2.4, in astronomical units and years
BODIES = [
    (1.00000597682, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    (0.000954786104043, (-3.5023653, -3.8169847, -1.5507963), (2.0652294225, -1.506619725, -0.6961263225)),
    (0.000285583733151, (9.0755314, -3.0458353, -1.6483708), (0.614781495, 1.7660750625, 0.702967455)),
    (0.0000437273164546, (8.310142, -16.2901086, -7.2521278), (1.293635145, 0.500765055, 0.2009934225)),
    (0.0000517759138449, (11.4707666, -25.7294829, -10.8169456), (1.055316825, 0.4183098675, 0.1449202425)),
]


def solar_system():
    """Five bodies that attract one another."""
    places = {f"{x}{i}": (r[k], v[k]) for i, (_, r, v) in enumerate(BODIES) for k, x in enumerate("xyz")}
    parameters = {"G": 39.4769264214} | {f"m{i}": m for i, (m, _, _) in enumerate(BODIES)}
    kinetic = "+".join(f"1/2*m{i}*(x{i}'^2+y{i}'^2+z{i}'^2)" for i in range(len(BODIES)))
    distance = "sqrt((x{0}-x{1})^2+(y{0}-y{1})^2+(z{0}-z{1})^2)"
    pairs = [(i, j) for j in range(len(BODIES)) for i in range(j)]
    potential = "+".join(f"G*m{i}*m{j}/{distance.format(i, j)}" for i, j in pairs)
    return places, parameters, f"{kinetic}+{potential}"


# the name: coordinates with initial values and velocities, parameters, L, length of the run
SYSTEMS = {
    "Hénon–Heiles": (
        {"x": (0.0, 0.4159572251), "y": (0.1, 0.1)},
        {},
        "1/2*(x'^2+y'^2)-1/2*(x^2+y^2)-x^2*y+y^3/3",
        20000,
    ),
    "Kepler, e = 0.9": (
        {"x": (0.1, 0.0), "y": (0.0, math.sqrt(19.0))},
        {},
        "1/2*(x'^2+y'^2)+1/sqrt(x^2+y^2)",
        2000 * math.pi,
    ),
    "double pendulum": (
        {"a": (1.5, 0.0), "b": (2.0, 0.0)},
        {"g": 9.81},
        "a'^2+1/2*b'^2+a'*b'*cos(a-b)+2*g*cos(a)+g*cos(b)",
        1000,
    ),
    "heavy top": (
        {"theta": (0.5, 0.0), "phi": (0.0, 0.5), "psi": (0.0, 20.0)},
        {"A": 1.0, "C": 0.5, "mgl": 5.0},
        "1/2*A*(theta'^2+sin(theta)^2*phi'^2)+1/2*C*(psi'+cos(theta)*phi')^2-mgl*cos(theta)",
        5000,
    ),
    "chain of 3": (*chain(3), 500),
    "chain of 5": (*chain(5), 300),
    "chain of 10": (*chain(10), 50),
    "outer solar system": (*solar_system(), 2000),
}

# from so many coordinates on heyoka compiles loops, as its manual advises for large systems
COMPACT = 10

# starts of the sweep: their number, the end in time, the tolerance
STARTS, END, TOLERANCE = 2000, 100.0, 1e-12

# the part of a run that is subtracted from it, in which the machine code is written
SHORT = 0.1

REPEATS = 5


def file_of(folder, name, system):
    coordinates, parameters, lagrangian, _ = system
    lines = [f'title = "{name}"', "[coordinates]"]
    lines += [f"{q} = {{ initial = {x!r}, velocity = {v!r} }}" for q, (x, v) in coordinates.items()]
    if parameters:
        lines += ["[parameters]"] + [f"{p} = {value!r}" for p, value in parameters.items()]
    lines += ["[lagrangian]", f'L = "{lagrangian}"']
    path = os.path.join(folder, re.sub(r"\W+", "-", name) + ".toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return path


def cpu(command):
    """The CPU seconds of a process, and what it printed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime, printed


def by_phaselab(program, path, until, tolerance):
    def run(end):
        command = [program, "run", path, "--at", repr(end), "--tolerance", tolerance, "--format", "json"]
        return cpu(command)

    spans = [run(until) for _ in range(REPEATS)]
    start = min(run(until * SHORT)[0] for _ in range(REPEATS))
    drift = next(i["max_drift"] for i in json.loads(spans[0][1])["invariants"] if i["name"] == "energy")
    return (min(seconds for seconds, _ in spans) - start) / (until * (1 - SHORT)), drift


def solved(matrix, right):
    """The solution of linear equations as expressions, by elimination."""
    n = len(right)
    for k in range(n):
        for i in range(k + 1, n):
            factor = matrix[i][k] / matrix[k][k]
            for j in range(k + 1, n):
                matrix[i][j] = matrix[i][j] - factor * matrix[k][j]
            right[i] = right[i] - factor * right[k]
    for k in reversed(range(n)):
        for j in range(k + 1, n):
            right[k] = right[k] - matrix[k][j] * right[j]
        right[k] = right[k] / matrix[k][k]
    return right


def by_heyoka(program, path, system, tolerance):
    coordinates, parameters, lagrangian, until = system
    derived = json.loads(cpu([program, "derive", path, "--format", "json"])[1])
    names = {q: heyoka.make_vars(q) for q in coordinates}
    names |= {f"{q}_d": heyoka.make_vars(f"{q}_d") for q in coordinates}
    functions = {f: getattr(heyoka, f) for f in ("sin", "cos", "sqrt", "exp")}

    def of(text):
        python = text.replace("''", "_dd").replace("'", "_d").replace("^", "**")
        return eval(python, {"__builtins__": {}}, {**names, **parameters, **functions})

    if derived["equations"]:
        accelerations = [of(derived["equations"][f"{q}''"]) for q in coordinates]
    else:
        matrix = [[of(entry) for entry in row] for row in derived["mass_matrix"]]
        accelerations = solved(matrix, [of(entry) for entry in derived["right_hand_side"]])
    system_of = [(names[q], names[f"{q}_d"]) for q in coordinates]
    system_of += [(names[f"{q}_d"], a) for q, a in zip(coordinates, accelerations)]
    start = [x for x, _ in coordinates.values()] + [v for _, v in coordinates.values()]
    compact = len(coordinates) >= COMPACT
    integrator = heyoka.taylor_adaptive(system_of, start, tol=tolerance, compact_mode=compact)
    energy = heyoka.cfunc([of(derived["energy"])], [*(n for n, _ in system_of)])
    best = math.inf
    for _ in range(REPEATS):
        integrator.time = 0.0
        integrator.state[:] = start
        first = energy(integrator.state)[0]
        begun = time.process_time()
        integrator.propagate_until(until)
        best = min(best, time.process_time() - begun)
    return best / until, abs(energy(integrator.state)[0] - first) / abs(first)


def starts():
    """Points of the Hénon–Heiles system at E = 1/12 with x = 0, from an additive recurrence."""
    points, n = [], 0
    while len(points) < STARTS:
        n += 1
        y, v = 0.7 * math.modf(n * 0.7548776662466927)[0] - 0.3, 0.6 * math.modf(n * 0.5698402909980532)[0] - 0.3
        rest = 1 / 12 - v * v / 2 - y * y / 2 + y**3 / 3
        if rest > 0:
            points.append((0.0, y, math.sqrt(2 * rest), v))
    return points


def sweep_by_phaselab(program, folder, path):
    table = os.path.join(folder, "starts.csv")
    with open(table, "w", encoding="utf-8") as file:
        file.write("x,y,x',y'\n" + "".join(",".join(map(repr, point)) + "\n" for point in starts()))
    command = [program, "sweep", path, "--over", table, "--until", repr(END), "--tolerance", repr(TOLERANCE)]
    return min(cpu(command)[0] for _ in range(REPEATS))


def sweep_by_heyoka():
    x, y, u, v = heyoka.make_vars("x", "y", "u", "v")
    law = [(x, u), (y, v), (u, -x - 2 * x * y), (v, -y - x**2 + y**2)]
    width = heyoka.recommended_simd_size()
    batches = numpy.array(starts()).reshape(-1, width, 4).transpose(0, 2, 1)
    integrator = heyoka.taylor_adaptive_batch(law, batches[0].copy(), tol=TOLERANCE)
    best = math.inf
    for _ in range(REPEATS):
        begun = time.process_time()
        for batch in batches:
            integrator.set_time(0.0)
            integrator.state[:] = batch
            integrator.propagate_until(END)
        best = min(best, time.process_time() - begun)
    return best


def main():
    program = os.path.abspath(sys.argv[1])
    print("| system | heyoka 1e-15 | drift | phaselab `fast` | ratio | drift | phaselab `exact` | ratio | drift |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, system in SYSTEMS.items():
            path = file_of(folder, name, system)
            theirs, their_drift = by_heyoka(program, path, system, 1e-15)
            cells = [f"{theirs * 1e6:.3g}", f"{their_drift:.0e}"]
            for tolerance in ("fast", "exact"):
                ours, drift = by_phaselab(program, path, system[-1], tolerance)
                cells += [f"{ours * 1e6:.3g}", f"{ours / theirs:.2f}", f"{drift:.0e}"]
            print(f"| {name} | " + " | ".join(cells) + " |", flush=True)
        print("\nTimes in microseconds of CPU per unit of time.\n")
        many, theirs = sweep_by_phaselab(program, folder, file_of(folder, "many", SYSTEMS["Hénon–Heiles"])), sweep_by_heyoka()
        print(f"{STARTS} starts of Hénon–Heiles to t = {END:g} at {TOLERANCE:g}, CPU seconds with everything of the command: ")
        print(f"phaselab sweep {many:.2f}, heyoka in batches {theirs:.3f}, ratio {many / theirs:.1f}.")


if __name__ == "__main__":
    main()
