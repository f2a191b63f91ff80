"""Meshes the disc brake of this example, as a file of Gmsh and a deck for CalculiX.

    python3 mesh.py                     # disc-brake.msh as it lies here, coarse
    python3 mesh.py 2 fine              # fine.msh and fine.inp, every cell halved along each edge or more

Bricks of 20 nodes in mm. Rotor and pads are swept in polar coordinates, the hub has five sectors with a bolt hole each; hub and cylinder do not match and are to be tied.
"""

import sys
from math import asin, cos, pi, radians, sin

# Corners of a brick in steps of two along its edges, and the middles of its edges as Abaqus numbers them.
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
# Where each node of Gmsh's brick stands in that list.
GMSH = [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14]
# Faces: corners in turn, seen from outside.
FACES = {
    "S1": (0, 1, 2, 3), "S2": (4, 7, 6, 5), "S3": (0, 4, 5, 1),
    "S4": (1, 5, 6, 2), "S5": (2, 6, 7, 3), "S6": (3, 7, 4, 0),
}


class Mesh:
    def __init__(self):
        self.points, self.numbers = [], {}
        self.bodies, self.surfaces = {}, {}

    def point(self, body, x):
        """Points of a body that lie in one place are one."""
        key = (body, *(round(v * 1e4) for v in x))
        if key not in self.numbers:
            self.points.append(x)
            self.numbers[key] = len(self.points)
        return self.numbers[key]

    def block(self, body, counts, place, faces=()):
        """Bricks over a grid of places; `faces` names surfaces by side: (axis, end, name)."""
        cells = self.bodies.setdefault(body, [])
        for k in range(counts[2]):
            for j in range(counts[1]):
                for i in range(counts[0]):
                    at = (i, j, k)
                    steps = [tuple(2 * at[a] + c[a] for a in range(3)) for c in CORNERS]
                    steps += [tuple((p + q) // 2 for p, q in zip(steps[a], steps[b])) for a, b in EDGES]
                    nodes = [self.point(body, place(*(s[a] / 2 for a in range(3)))) for s in steps]
                    cells.append(nodes)
                    for axis, end, name in faces:
                        if at[axis] == (counts[axis] - 1 if end else 0):
                            self.face(name, len(cells) - 1, nodes, axis, 2 * end)

    def face(self, name, cell, nodes, axis, value):
        for label, corners in FACES.items():
            if all(CORNERS[c][axis] == value for c in corners):
                ring = list(zip(corners, corners[1:] + corners[:1]))
                middle = [next(8 + n for n, e in enumerate(EDGES) if set(e) == set(pair)) for pair in ring]
                quad = [nodes[c] for c in corners] + [nodes[m] for m in middle]
                self.surfaces.setdefault(name, []).append((cell, label, quad))


def polar(r, phi, z):
    return (r * cos(phi), r * sin(phi), z)


def between(values, counts):
    """Grid lines between values, so many cells each."""
    lines = [values[0]]
    for a, b, n in zip(values, values[1:], counts):
        lines += [a + (b - a) * (k + 1) / n for k in range(n)]
    return lines


def along(lines, t):
    k = min(int(t), len(lines) - 2)
    return lines[k] + (t - k) * (lines[k + 1] - lines[k])


def rotor(mesh, n):
    """Two discs on vanes with parallel sides, the ring that carries them, and the cylinder."""
    vanes, pitch, half = 21, 2 * pi / 21, 28.7 / 2
    wide, gap = 2 * n - 1, n

    def angle(r, t, vane):
        edge = asin(half / max(r, 125.0))
        if t <= wide:
            return vane + asin(half * (2 * t / wide - 1) / max(r, 125.0))
        return vane + edge + (pitch - 2 * edge) * (t - wide) / gap

    def ring(radii, heights, vane, cells, start=0, faces=()):
        place = lambda i, j, k: polar(along(radii, i), angle(along(radii, i), start + j, vane), along(heights, k))
        mesh.block("rotor", (len(radii) - 1, cells, len(heights) - 1), place, faces)

    outer, inner = between([125, 175], [n]), between([112.5, 125], [n])
    front, web, back = between([0, 10], [n]), between([10, 25], [n]), between([25, 35], [n])
    wall = between([0, 10, 25, 35, 65, 75], [n, n, n, n, n])
    for v in range(vanes):
        vane = radians(4.05) + v * pitch
        ring(outer, front, vane, wide + gap, faces=[(2, 0, "disc-below")])
        ring(outer, web, vane, wide)
        ring(outer, back, vane, wide + gap, faces=[(2, 1, "disc-above")])
        ring(inner, front, vane, wide + gap)
        ring([105, 112.5], wall[:-n], vane, wide + gap)
        ring([105, 112.5], wall[-n - 1:], vane, wide + gap, faces=[(0, 0, "cylinder-inside")])


def hub(mesh, n):
    """Five sectors of 72°, in the middle of each a square in polar coordinates about a hole."""
    radii, angles = [40, 58, 92, 105], [radians(a) for a in (-36, -13, 13, 36)]
    height = between([65, 75], [n])
    side = 2 * n
    for sector in range(5):
        turn = radians(90 + 72 * sector)

        def place(i, j, k, lines):
            return polar(along(lines[0], i), turn + along(lines[1], j), along(height, k))

        for p in range(3):
            for q in range(3):
                if p == q == 1:
                    continue
                lines = [between(radii[p:p + 2], [side if p == 1 else n]), between(angles[q:q + 2], [side])]
                faces = [(0, 0, "bore")] if p == 0 else [(0, 1, "hub-rim")] if p == 2 else []
                mesh.block("hub", (len(lines[0]) - 1, side, n), lambda i, j, k, lines=lines: place(i, j, k, lines), faces)

        def about_hole(i, j, k):
            corner, t = int(j / side), j / side % 1
            ends = [(58, -13), (92, -13), (92, 13), (58, 13)]
            r, phi = (a + t * (b - a) for a, b in zip(ends[corner % 4], ends[(corner + 1) % 4]))
            square = polar(r, turn + radians(phi), 0)
            # From the corner with the least radius and angle on, against the clock.
            way = turn + radians(90 * j / side - 135)
            hole = (75 * cos(turn) + 10 * cos(way), 75 * sin(turn) + 10 * sin(way))
            f = i / n
            return (hole[0] + f * (square[0] - hole[0]), hole[1] + f * (square[1] - hole[1]), along(height, k))

        mesh.block("hub", (n, 4 * side, n), about_hole, [(0, 0, "bolts")])


def pad(mesh, name, n, low, high, rubs, back):
    lines = [between([130, 167.5], [2 * n]), between([radians(60), radians(120)], [10 * n]), between([low, high], [n])]
    place = lambda i, j, k: polar(along(lines[0], i), along(lines[1], j), along(lines[2], k))
    mesh.block(name, (2 * n, 10 * n, n), place, [(2, rubs, f"{name}-face"), (2, back, f"{name}-back")])


def volume(mesh, nodes):
    a, b, d, e = (mesh.points[nodes[c] - 1] for c in (0, 1, 3, 4))
    u, v, w = ([q - p for p, q in zip(a, x)] for x in (b, d, e))
    return sum(u[i] * (v[(i + 1) % 3] * w[(i + 2) % 3] - v[(i + 2) % 3] * w[(i + 1) % 3]) for i in range(3))


def write_gmsh(mesh, path):
    numbers = {name: i + 1 for i, name in enumerate([*mesh.bodies, *mesh.surfaces])}
    with open(path, "w") as out:
        out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % len(numbers))
        for name, i in numbers.items():
            out.write('%d %d "%s"\n' % (3 if name in mesh.bodies else 2, i, name))
        out.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(mesh.points))
        for i, x in enumerate(mesh.points):
            out.write("%d %.9g %.9g %.9g\n" % (i + 1, *(round(v, 6) for v in x)))
        rows = [(16, name, quad) for name, faces in mesh.surfaces.items() for _, _, quad in faces]
        rows += [(17, name, [cell[g] for g in GMSH]) for name, cells in mesh.bodies.items() for cell in cells]
        out.write("$EndNodes\n$Elements\n%d\n" % len(rows))
        for i, (kind, name, nodes) in enumerate(rows):
            out.write("%d %d 2 %d %d %s\n" % (i + 1, kind, numbers[name], numbers[name], " ".join(map(str, nodes))))
        out.write("$EndElements\n")


def write_deck(mesh, path):
    """The same for CalculiX: real modes of rotor and hub, tied, without the pads."""
    with open(path, "w") as out:
        out.write("*NODE, NSET=ALL\n")
        used = {n for name in ("rotor", "hub") for cell in mesh.bodies[name] for n in cell}
        for i in sorted(used):
            out.write("%d, %.9g, %.9g, %.9g\n" % (i, *(1e-3 * v for v in mesh.points[i - 1])))
        first, start = 1, {}
        for name in ("rotor", "hub"):
            start[name] = first
            out.write(f"*ELEMENT, TYPE=C3D20, ELSET={name}\n")
            for cell in mesh.bodies[name]:
                out.write("%d, %s,\n%s\n" % (first, ", ".join(map(str, cell[:10])), ", ".join(map(str, cell[10:]))))
                first += 1
            out.write(f"*SOLID SECTION, ELSET={name}, MATERIAL=STEEL\n")
        out.write("*MATERIAL, NAME=STEEL\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n")
        for name, body in (("cylinder-inside", "rotor"), ("hub-rim", "hub")):
            out.write(f"*SURFACE, NAME={name}\n")
            for cell, label, _ in mesh.surfaces[name]:
                out.write(f"{start[body] + cell}, {label}\n")
        held = sorted({n for name in ("bore", "bolts") for _, _, quad in mesh.surfaces[name] for n in quad})
        out.write("*NSET, NSET=HELD\n" + "".join(f"{n},\n" for n in held))
        out.write("*TIE, NAME=JOIN, POSITION TOLERANCE=2e-3\nhub-rim, cylinder-inside\n*BOUNDARY\nHELD, 1, 3\n")
        out.write("*STEP\n*FREQUENCY\n20\n*END STEP\n")


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    name = sys.argv[2] if len(sys.argv) > 2 else "disc-brake"
    mesh = Mesh()
    rotor(mesh, n)
    hub(mesh, n)
    pad(mesh, "pad-above", n, 35, 50, 0, 1)
    pad(mesh, "pad-below", n, -15, 0, 1, 0)
    for body, cells in mesh.bodies.items():
        least = min(volume(mesh, cell) for cell in cells)
        print(f"{body}: {len(cells)} cells, least volume at a corner {least:.1f} mm³")
    print(len(mesh.points), "points")
    write_gmsh(mesh, f"{name}.msh")
    if len(sys.argv) > 2:
        write_deck(mesh, f"{name}.inp")


if __name__ == "__main__":
    main()
