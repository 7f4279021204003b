#!/usr/bin/env python3
"""Writes the example models of scripts/scenes/models: a rover, a lander, rocks, a pit with a tube and an arch, as binary glTF.

usage: tools/make_models.py [FOLDER]

Model frame: x to the right, y forward, z up, metres; the origin is on the ground.
"""
import json
import math
import os
import struct
import sys


def add(a, b):
    return [p + q for p, q in zip(a, b)]


def scaled(a, s):
    return [p * s for p in a]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return scaled(a, 1 / length)


class Model:
    """Parts by material; a part is a list of triangles, each three (place, normal)."""

    def __init__(self):
        self.parts = {}

    def face(self, material, corners, normals=None):
        if normals is None:
            n = unit(cross(add(corners[1], scaled(corners[0], -1)), add(corners[2], scaled(corners[0], -1))))
            normals = [n, n, n]
        self.parts.setdefault(material, []).append(list(zip(corners, normals)))

    def quad(self, material, a, b, c, d, normals=None):
        n = normals
        self.face(material, [a, b, c], n and [n[0], n[1], n[2]])
        self.face(material, [a, c, d], n and [n[0], n[2], n[3]])

    def box(self, material, middle, size, turn_deg=0.0):
        """A box about its middle, turned about x by turn_deg (front up)."""
        c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))

        def at(i, j, k):
            x, y, z = i * size[0] / 2, j * size[1] / 2, k * size[2] / 2
            return add(middle, [x, c * y - s * z, s * y + c * z])

        for axis in range(3):
            for side in (-1, 1):
                ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
                corners = []
                for p, q in ring:
                    index = [0, 0, 0]
                    index[axis] = side
                    index[(axis + 1) % 3] = p
                    index[(axis + 2) % 3] = q
                    corners.append(at(*index))
                if side < 0:
                    corners.reverse()
                self.quad(material, *corners)

    def tube(self, material, start, end, radius, end_radius=None, segments=12):
        """A closed cylinder or cone from start to end."""
        top = radius if end_radius is None else end_radius
        along = unit(add(end, scaled(start, -1)))
        side = unit(cross(along, [0, 0, 1] if abs(along[2]) < 0.9 else [1, 0, 0]))
        other = cross(along, side)
        ring = []
        for n in range(segments + 1):
            a = 2 * math.pi * n / segments
            ring.append(add(scaled(side, math.cos(a)), scaled(other, math.sin(a))))
        for n in range(segments):
            p, q = ring[n], ring[n + 1]
            a, b = add(start, scaled(p, radius)), add(start, scaled(q, radius))
            c, d = add(end, scaled(q, top)), add(end, scaled(p, top))
            if radius > 0 and top > 0:
                self.quad(material, a, b, c, d, [p, q, q, p])
            elif top > 0:
                self.face(material, [start, c, d], [p, q, p])
            else:
                self.face(material, [a, b, end], [p, q, p])
            if radius > 0:
                self.face(material, [start, b, a])
            if top > 0:
                self.face(material, [end, d, c])

    def dish(self, material, middle, along, radius, depth, segments=24, rings=5):
        """An open bowl whose opening faces `along`."""
        along = unit(along)
        side = unit(cross(along, [0, 0, 1] if abs(along[2]) < 0.9 else [1, 0, 0]))
        other = cross(along, side)

        def at(i, n):
            r = i / rings
            a = 2 * math.pi * n / segments
            out = add(scaled(side, radius * r * math.cos(a)), scaled(other, radius * r * math.sin(a)))
            return add(add(middle, out), scaled(along, depth * r * r))

        for i in range(rings):
            for n in range(segments):
                a, b, c, d = at(i, n), at(i + 1, n), at(i + 1, n + 1), at(i, n + 1)
                if i > 0:
                    self.face(material, [a, b, d])
                self.face(material, [b, c, d])

    def wheel(self, middle, radius, width):
        left, right = add(middle, [-width / 2, 0, 0]), add(middle, [width / 2, 0, 0])
        self.tube("wheel", left, right, radius * 0.96, segments=28)
        for n in range(20):
            a = 2 * math.pi * n / 20
            c, s = math.cos(a), math.sin(a)
            rim = add(middle, [0, radius * 0.98 * c, radius * 0.98 * s])
            self.box("wheel", rim, [width * 0.96, 0.012, 0.012])
        self.tube("metal", add(left, [-0.01, 0, 0]), add(right, [0.01, 0, 0]), radius * 0.3, segments=12)


MATERIALS = {
    # sRGB, double sided
    "body": ((226, 224, 218), False),
    "deck": ((196, 193, 184), False),
    "metal": ((150, 150, 155), False),
    "dark": ((58, 58, 64), False),
    "wheel": ((92, 90, 90), False),
    "gold": ((196, 148, 66), False),
    "glass": ((24, 28, 40), False),
    "dish": ((222, 222, 222), True),
    "panel": ((38, 46, 92), True),
    "rock": ((112, 86, 72), False),
}


def linear(byte):
    x = byte / 255
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4


def write_glb(model, file):
    """Writes y up, +z forward, +x to the left, as glTF has it."""
    chunks, views, accessors, primitives, materials = b"", [], [], [], []

    def view(data, target):
        nonlocal chunks
        views.append({"buffer": 0, "byteOffset": len(chunks), "byteLength": len(data), "target": target})
        chunks += data + b"\0" * (-len(data) % 4)
        return len(views) - 1

    for name, faces in model.parts.items():
        index, places, normals, corners = {}, [], [], []
        for face in faces:
            for place, normal in face:
                key = tuple(round(x, 5) for x in (*place, *normal))
                if key not in index:
                    index[key] = len(places)
                    places.append((-place[0], place[2], place[1]))
                    normals.append((-normal[0], normal[2], normal[1]))
                corners.append(index[key])
        low = [min(p[k] for p in places) for k in range(3)]
        high = [max(p[k] for p in places) for k in range(3)]
        flat = b"".join(struct.pack("<3f", *p) for p in places)
        low = list(struct.unpack("<3f", struct.pack("<3f", *low)))
        high = list(struct.unpack("<3f", struct.pack("<3f", *high)))
        accessors.append({"bufferView": view(flat, 34962), "componentType": 5126, "count": len(places),
                          "type": "VEC3", "min": low, "max": high})
        flat = b"".join(struct.pack("<3f", *unit(n)) for n in normals)
        accessors.append({"bufferView": view(flat, 34962), "componentType": 5126, "count": len(normals),
                          "type": "VEC3"})
        flat = struct.pack("<%dH" % len(corners), *corners)
        accessors.append({"bufferView": view(flat, 34963), "componentType": 5123, "count": len(corners),
                          "type": "SCALAR"})
        colour, double_sided = MATERIALS[name]
        materials.append({"name": name, "doubleSided": double_sided, "pbrMetallicRoughness": {
            "baseColorFactor": [round(linear(c), 5) for c in colour] + [1], "metallicFactor": 0}})
        first = len(accessors) - 3
        primitives.append({"attributes": {"POSITION": first, "NORMAL": first + 1}, "indices": first + 2,
                           "material": len(materials) - 1})
    text = json.dumps({"asset": {"version": "2.0", "generator": "vpe tools/make_models.py"}, "scene": 0,
                       "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": primitives}],
                       "materials": materials, "accessors": accessors, "bufferViews": views,
                       "buffers": [{"byteLength": len(chunks)}]}, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(file, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(chunks)))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text)
        out.write(struct.pack("<I4s", len(chunks), b"BIN\0") + chunks)
    triangles = sum(len(f) for f in model.parts.values())
    print("%s: %d triangles, %d bytes" % (file, triangles, os.path.getsize(file)))


def rover():
    m = Model()
    m.box("body", [0, 0.05, 0.86], [1.15, 1.75, 0.42])
    m.box("deck", [0, 0.05, 1.085], [1.25, 1.85, 0.03])
    m.box("dark", [0, 0.05, 0.645], [1.05, 1.6, 0.02])
    for side in (-1, 1):
        x = side * 1.08
        for y in (1.08, 0.0, -1.08):
            m.wheel([x, y, 0.26], 0.26, 0.38)
        inner = side * 0.78
        m.tube("metal", [side * 0.55, 0.1, 0.82], [inner, 0.1, 0.82], 0.045)
        for a, b in (([inner, 0.1, 0.82], [inner, 1.08, 0.62]), ([inner, 0.1, 0.82], [inner, -0.52, 0.6]),
                     ([inner, -0.52, 0.6], [inner, 0.0, 0.5]), ([inner, -0.52, 0.6], [inner, -1.08, 0.6])):
            m.tube("metal", a, b, 0.04)
        for y, z in ((1.08, 0.62), (0.0, 0.5), (-1.08, 0.6)):
            m.tube("metal", [inner, y, z], [inner, y, 0.26], 0.04)
            m.tube("metal", [inner, y, 0.26], [x, y, 0.26], 0.05)
    # Power source, slanted behind the body.
    m.tube("dark", [0, -0.88, 0.95], [0, -1.35, 1.15], 0.2, segments=20)
    for n in range(8):
        a = 2 * math.pi * n / 8
        m.box("metal", [0.26 * math.cos(a), -1.12 + 0.1 * math.sin(a), 1.05 + 0.24 * math.sin(a)], [0.02, 0.45, 0.02],
              -23)
    # Mast with its head and cameras.
    m.tube("body", [0.36, 0.72, 1.1], [0.36, 0.72, 1.86], 0.045)
    m.box("body", [0.36, 0.76, 1.98], [0.46, 0.24, 0.22])
    m.tube("glass", [0.36, 0.87, 2.02], [0.36, 0.9, 2.02], 0.08, segments=20)
    for x in (0.21, 0.29, 0.45, 0.51):
        m.tube("glass", [x, 0.87, 1.92], [x, 0.9, 1.92], 0.025, segments=12)
    # Antennas.
    m.tube("metal", [-0.4, -0.35, 1.1], [-0.4, -0.35, 1.3], 0.04)
    m.dish("dish", [-0.4, -0.33, 1.38], [0.2, 0.35, 1], 0.2, 0.03)
    m.tube("metal", [-0.45, -0.68, 1.1], [-0.45, -0.68, 1.42], 0.015, 0.008)
    m.tube("metal", [0.42, -0.6, 1.1], [0.42, -0.6, 1.24], 0.09)
    # Arm with its turret.
    m.tube("metal", [0.42, 0.92, 0.8], [0.62, 1.05, 0.86], 0.06)
    m.tube("body", [0.62, 1.05, 0.86], [0.42, 1.62, 1.02], 0.05)
    m.tube("body", [0.42, 1.62, 1.02], [0.06, 1.95, 0.72], 0.045)
    m.box("dark", [0.06, 1.97, 0.66], [0.3, 0.26, 0.28])
    m.tube("metal", [0.06, 1.97, 0.52], [0.06, 1.97, 0.4], 0.04, 0.02)
    # Instruments on the deck.
    for x, y, size in ((-0.2, 0.55, 0.2), (0.1, 0.2, 0.26), (-0.3, 0.1, 0.16), (0.25, -0.35, 0.2)):
        m.box("gold", [x, y, 1.1 + size / 4], [size, size, size / 2])
    return m


def lander():
    m = Model()
    sides = 8
    for lower, upper, low, high, material in ((1.25, 1.25, 1.0, 1.35, "gold"), (1.25, 0.95, 1.35, 1.55, "body")):
        for n in range(sides):
            a, b = 2 * math.pi * n / sides, 2 * math.pi * (n + 1) / sides
            p = [math.cos(a), math.sin(a)]
            q = [math.cos(b), math.sin(b)]
            m.quad(material, [lower * p[0], lower * p[1], low], [lower * q[0], lower * q[1], low],
                   [upper * q[0], upper * q[1], high], [upper * p[0], upper * p[1], high])
            m.face(material, [[0, 0, high], [upper * p[0], upper * p[1], high], [upper * q[0], upper * q[1], high]])
            m.face(material, [[0, 0, low], [lower * q[0], lower * q[1], low], [lower * p[0], lower * p[1], low]])
    for n in range(3):
        a = math.radians(90 + 120 * n)
        foot = [2.0 * math.cos(a), 2.0 * math.sin(a), 0.06]
        m.tube("metal", [1.15 * math.cos(a), 1.15 * math.sin(a), 1.2], foot, 0.05)
        for turn in (-0.45, 0.45):
            m.tube("metal", [1.1 * math.cos(a + turn), 1.1 * math.sin(a + turn), 1.02],
                   [1.75 * math.cos(a), 1.75 * math.sin(a), 0.4], 0.03)
        m.tube("metal", [foot[0], foot[1], 0.0], [foot[0], foot[1], 0.06], 0.18, 0.12, 20)
    for n in range(6):
        a = math.radians(60 * n)
        m.tube("dark", [0.8 * math.cos(a), 0.8 * math.sin(a), 1.0], [0.8 * math.cos(a), 0.8 * math.sin(a), 0.8], 0.05,
               0.12)
    # Two round panels of solar cells.
    for side in (-1, 1):
        middle = [side * 2.4, 0, 1.42]
        m.tube("metal", [side * 1.1, 0, 1.42], middle, 0.03)
        m.tube("metal", add(middle, [0, 0, -0.01]), middle, 1.08, segments=20)
        for n in range(20):
            a, b = 2 * math.pi * n / 20, 2 * math.pi * (n + 1) / 20
            m.face("panel", [add(middle, [0, 0, 0.01]), add(middle, [1.07 * math.cos(a), 1.07 * math.sin(a), 0.01]),
                             add(middle, [1.07 * math.cos(b), 1.07 * math.sin(b), 0.01])])
    m.tube("body", [0.5, 0.3, 1.55], [0.5, 0.3, 2.3], 0.03)
    m.box("body", [0.5, 0.32, 2.38], [0.24, 0.16, 0.16])
    m.dish("dish", [-0.45, -0.2, 1.85], [0.3, -0.2, 1], 0.35, 0.07)
    m.tube("metal", [-0.45, -0.2, 1.55], [-0.45, -0.2, 1.86], 0.025)
    m.tube("metal", [0.1, -0.6, 1.55], [0.1, -0.6, 2.1], 0.012, 0.006)
    return m


def noise(seed, x, y, z):
    """Value noise on a lattice, -1 to 1."""

    def at(i, j, k):
        h = (i * 374761393 + j * 668265263 + k * 2147483647 + seed * 974711) & 0xFFFFFFFF
        h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
        h = ((h ^ (h >> 16)) * 2246822519) & 0xFFFFFFFF
        return (h ^ (h >> 15)) / 2147483647.5 - 1

    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    u, v, w = (t * t * (3 - 2 * t) for t in (x - i, y - j, z - k))
    total = 0
    for a in (0, 1):
        for b in (0, 1):
            for c in (0, 1):
                weight = (u if a else 1 - u) * (v if b else 1 - v) * (w if c else 1 - w)
                total += weight * at(i + a, j + b, k + c)
    return total


def rock(seed):
    """A block about a metre across, with cut faces; its middle is the origin, so that part of it is in the ground."""
    t = (1 + math.sqrt(5)) / 2
    places = [unit(p) for p in ([-1, t, 0], [1, t, 0], [-1, -t, 0], [1, -t, 0], [0, -1, t], [0, 1, t], [0, -1, -t],
                                [0, 1, -t], [t, 0, -1], [t, 0, 1], [-t, 0, -1], [-t, 0, 1])]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
             (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
             (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(3):
        middle, finer = {}, []
        for a, b, c in faces:
            corners = []
            for p, q in ((a, b), (b, c), (c, a)):
                key = (min(p, q), max(p, q))
                if key not in middle:
                    middle[key] = len(places)
                    places.append(unit(add(places[p], places[q])))
                corners.append(middle[key])
            x, y, z = corners
            finer += [(a, x, z), (b, y, x), (c, z, y), (x, y, z)]
        faces = finer
    cuts = []
    for n in range(9):
        d = unit([noise(seed + n, 3.1, 0.7, 1.3), noise(seed + n, 8.2, 4.1, 2.9), noise(seed + n, 1.7, 9.3, 5.5)])
        cuts.append((d, 0.36 + 0.1 * noise(seed + 31 * n, 2.2, 2.8, 6.1)))
    shape = [1.0 + 0.25 * noise(seed, 11.3, 1.1, 0.4), 1.0 + 0.25 * noise(seed, 5.3, 7.7, 2.4),
             0.8 + 0.15 * noise(seed, 6.3, 2.1, 9.4)]
    moved = []
    for p in places:
        r = 0.5
        for d, level in cuts:
            along = dot(p, d)
            if along > 0:
                r = min(r, level / along)
        for octave, size in ((2.3, 0.05), (5.1, 0.025), (11.0, 0.012)):
            r += size * noise(seed + 7, *(octave * x + 100 for x in p))
        moved.append([r * shape[k] * p[k] for k in range(3)])
    normals = [[0, 0, 0] for _ in moved]
    for a, b, c in faces:
        n = cross(add(moved[b], scaled(moved[a], -1)), add(moved[c], scaled(moved[a], -1)))
        for v in (a, b, c):
            normals[v] = add(normals[v], n)
    normals = [unit(n) for n in normals]
    m = Model()
    for a, b, c in faces:
        flat = unit(cross(add(moved[b], scaled(moved[a], -1)), add(moved[c], scaled(moved[a], -1))))
        # Edges stay sharp: a corner takes the mean normal only where that is near the face's own.
        m.face("rock", [moved[a], moved[b], moved[c]],
               [normals[v] if dot(normals[v], flat) > 0.93 else flat for v in (a, b, c)])
    return m


def along_line(m, material, line, radii, seed, roughness, segments=26):
    """A closed tube along a line of points, with a radius across and one upwards at each; rough by a share of them."""
    rings = []
    for n, middle in enumerate(line):
        way = unit(add(line[min(n + 1, len(line) - 1)], scaled(line[max(n - 1, 0)], -1)))
        side = unit(cross(way, [0, 0, 1])) if abs(way[2]) < 0.999 else [1, 0, 0]
        up = cross(side, way)
        ring = []
        for k in range(segments):
            a = 2 * math.pi * k / segments
            out = add(scaled(side, radii[n][0] * math.cos(a)), scaled(up, radii[n][1] * math.sin(a)))
            place = add(middle, out)
            share = sum(size * noise(seed, *(c / length + 50 for c in place))
                        for length, size in ((0.8 * radii[n][0], 1.0), (0.3 * radii[n][0], 0.45)))
            ring.append(add(middle, scaled(out, 1 + roughness * share)))
        rings.append(ring)
    for ring, other in zip(rings, rings[1:]):
        for k in range(segments):
            q = (k + 1) % segments
            m.quad(material, ring[q], ring[k], other[k], other[q])
    for ring, middle, turn in ((rings[0], line[0], 0), (rings[-1], line[-1], 1)):
        for k in range(segments):
            pair = [ring[k], ring[(k + 1) % segments]]
            m.face(material, [middle] + (pair[::-1] if turn else pair))


def skylight():
    """A pit that widens downwards and opens into a tube; to be cut out of the ground."""
    m = Model()
    depths = [6, 0, -5, -10, -16, -22, -27]
    along_line(m, "rock", [[0, 0, z] for z in reversed(depths)],
               [(18 + 0.25 * max(0, -z), 18 + 0.25 * max(0, -z)) for z in reversed(depths)], 5, 0.10)
    line = [[4 * math.sin(y / 40), y, -24 - 0.02 * y] for y in range(-120, 121, 8)]
    ends = [min(1.0, 0.55 + 0.06 * min(n, len(line) - 1 - n)) for n in range(len(line))]
    along_line(m, "rock", line, [(17 * e, 11 * e) for e in ends], 9, 0.09)
    return m


def arch():
    """A natural bridge; its feet are in the ground."""
    m = Model()
    line, radii = [], []
    for n in range(37):
        a = math.pi * (n / 36 * 1.3 - 0.15)
        line.append([24 * math.cos(a), 3 * math.sin(2 * a), 19 * math.sin(a)])
        wide = 4.2 + 3.2 * abs(math.cos(a)) ** 3
        radii.append((wide, 0.85 * wide))
    along_line(m, "rock", line, radii, 23, 0.13)
    return m


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..",
                                                                "scripts", "scenes", "models")
    os.makedirs(folder, exist_ok=True)
    write_glb(rover(), os.path.join(folder, "rover.glb"))
    write_glb(lander(), os.path.join(folder, "lander.glb"))
    write_glb(skylight(), os.path.join(folder, "skylight.glb"))
    write_glb(arch(), os.path.join(folder, "arch.glb"))
    for n in range(4):
        write_glb(rock(17 + 101 * n), os.path.join(folder, "rock%d.glb" % (n + 1)))


if __name__ == "__main__":
    main()
