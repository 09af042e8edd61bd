"""The scenes of bench/pictures/light.py: triangles of matte, glossy and emissive materials, for Alhazen and for Cycles.

Coordinates are in metres, z up. A mesh is (material, [vertex], [face]); a glossy surface reflects by GGX with
alpha = roughness^2.
"""

import json
import math
import os
import random
import zipfile

from peer_scenes import parse_obj


class Scene:
    def __init__(self, eye, at, angle, depth=8):
        self.eye, self.at, self.angle = eye, at, angle  # vertical angle, degrees
        self.depth = depth       # maximum number of bounces of a path
        self.sky = None          # a picture of all directions, whose centre is along x; none: black
        self.materials = {}      # name -> {"diffuse" | "glossy" | "emission": colour, "roughness": number}
        self.meshes = []

    def matt(self, name, color):
        self.materials[name] = {"diffuse": color}
        return name

    def glossy(self, name, color, roughness):
        self.materials[name] = {"glossy": color, "roughness": roughness}
        return name

    def glowing(self, name, radiance):
        self.materials[name] = {"emission": radiance}
        return name

    def quad(self, material, *corners):
        self.meshes.append((material, list(corners), [(0, 1, 2), (0, 2, 3)]))

    def box(self, material, lo, hi):
        corners = [tuple((lo, hi)[i >> k & 1][k] for k in range(3)) for i in range(8)]
        faces = []
        for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
            faces += [(a, b, c), (a, c, d)]
        self.meshes.append((material, corners, faces))


def upright(v):
    """Converts a vector from y up to z up."""
    return (v[0], -v[2], v[1])


def read_mtl(text):
    """The materials of an MTL text: {material: (Kd, Ke)}."""
    colors, name = {}, ""
    for line in text.splitlines():
        word, *rest = line.split("#")[0].split() or [""]
        if word == "newmtl":
            name = rest[0]
            colors[name] = [(0.7, 0.7, 0.7), (0.0, 0.0, 0.0)]
        elif word in ("Kd", "Ke"):
            colors[name][word == "Ke"] = tuple(float(t) for t in rest[:3])
    return colors


def add_model(scene, archive, model):
    """Adds the diffuse and emissive surfaces of an OBJ in an archive, without its textures."""
    with zipfile.ZipFile(archive) as files:
        read = lambda name: files.read(name).decode("utf-8", errors="replace")
        vertices, of_material = parse_obj(read(model + ".obj").splitlines())
        colors = read_mtl(read(model + ".mtl"))
    vertices = [upright(v) for v in vertices]
    known = set()  # faces that coincide are black to Cycles
    for name, faces in of_material.items():
        fresh = lambda face: len(set(face)) == 3 and frozenset(vertices[i] for i in face) not in known
        faces = [known.add(frozenset(vertices[i] for i in face)) or face for face in faces if fresh(face)]
        diffuse, emission = colors[name]
        if max(emission) > 0:
            scene.glowing(name, emission)
        else:
            scene.matt(name, diffuse)
        used = sorted({i for face in faces for i in face})
        place = {i: k for k, i in enumerate(used)}
        scene.meshes.append((name, [vertices[i] for i in used], [tuple(place[i] for i in face) for face in faces]))


def cornell(data):
    scene = Scene(eye=(0, -3.9, 1), at=(0, 0, 1), angle=37)
    add_model(scene, os.path.join(data, "meshes/awesome-3d-meshes/McGuire/Cornell Box/CornellBox.zip"),
              "CornellBox-Original")
    return scene


def sponza(data):
    scene = Scene(eye=(-11, 1, 1.5), at=(4, -0.5, 3.5), angle=65)
    add_model(scene, os.path.join(data, "meshes/awesome-3d-meshes/McGuire/Dabrovic Sponza/sponza.zip"), "sponza")
    scene.sky = "sky.exr"
    return scene


def split(vertices, faces):
    """Splits each triangle into four; appends the midpoints of the edges, which neighbours share."""
    known = {}

    def middle(a, b):
        key = (a, b) if a < b else (b, a)
        if key not in known:
            known[key] = len(vertices)
            vertices.append(tuple((p + q) / 2 for p, q in zip(vertices[a], vertices[b])))
        return known[key]

    result = []
    for a, b, c in faces:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        result += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return result


def interior(data, splits=0):
    """A room with a metal floor and bunny, lit by a window and an area light. A split makes four triangles of one."""
    scene = Scene(eye=(0.2, -3.6, 1.3), at=(0, 0.2, 0.75), angle=45)
    white = scene.matt("white", (0.75, 0.74, 0.7))
    blue = scene.matt("blue", (0.2, 0.3, 0.6))
    floor = scene.glossy("floor", (0.7, 0.65, 0.6), 0.35)
    gold = scene.glossy("gold", (0.95, 0.7, 0.3), 0.25)
    scene.quad(floor, (-2, -4, 0), (2, -4, 0), (2, 2, 0), (-2, 2, 0))
    scene.quad(white, (-2, -4, 2.6), (-2, 2, 2.6), (2, 2, 2.6), (2, -4, 2.6))
    scene.quad(white, (-2, 2, 0), (2, 2, 0), (2, 2, 2.6), (-2, 2, 2.6))
    scene.quad(white, (-2, -4, 0), (-2, -4, 2.6), (2, -4, 2.6), (2, -4, 0))
    scene.quad(blue, (2, -4, 0), (2, -4, 2.6), (2, 2, 2.6), (2, 2, 0))
    scene.quad(white, (-2, -4, 0), (-2, 2, 0), (-2, 2, 2.6), (-2, -4, 2.6))
    scene.quad(scene.glowing("window", (6, 7, 8)), (-1.99, -1.5, 0.9), (-1.99, 0.5, 0.9), (-1.99, 0.5, 2.1),
               (-1.99, -1.5, 2.1))
    scene.quad(scene.glowing("lamp", (40, 32, 20)), (0.7, 0.8, 2.55), (0.7, 1.1, 2.55), (1.1, 1.1, 2.55),
               (1.1, 0.8, 2.55))
    with open(os.path.join(data, "meshes/alecjacobson/data/stanford-bunny.obj"), encoding="ascii") as source:
        vertices, faces = parse_obj(source)
    vertices = [upright(v) for v in vertices]
    low = min(v[2] for v in vertices)
    grown = [(8 * v[0] + 0.2, 8 * v[1] + 0.3, 8 * (v[2] - low)) for v in vertices]
    faces = [face for group in faces.values() for face in group]
    for _ in range(splits):
        faces = split(grown, faces)
    scene.meshes.append((gold, grown, faces))
    return scene


def many_lights(data):
    """10^4 small emissive squares above blocks on a floor."""
    del data
    scene = Scene(eye=(0, -9, 5), at=(0, 0, 0.6), angle=40)
    chance = random.Random(10)
    grey = scene.matt("grey", (0.6, 0.6, 0.6))
    colors = [scene.matt(f"block {i}", tuple(0.2 + 0.6 * chance.random() for _ in range(3))) for i in range(6)]
    scene.quad(grey, (-8, -8, 0), (8, -8, 0), (8, 8, 0), (-8, 8, 0))
    for i in range(60):
        x, y, height = 8 * chance.random() - 4, 8 * chance.random() - 4, 0.2 + 1.2 * chance.random()
        scene.box(colors[i % 6], (x - 0.2, y - 0.2, 0), (x + 0.2, y + 0.2, height))
    groups = {}
    for _ in range(10000):
        kind = chance.randrange(8)
        size = 0.01
        x, y, z = 8 * chance.random() - 4, 8 * chance.random() - 4, 0.3 + 3 * chance.random() ** 3
        turn = 2 * math.pi * chance.random()
        u = (size * math.cos(turn), size * math.sin(turn), 0)
        v = (0, 0, size) if chance.random() < 0.5 else (-u[1], u[0], 0)
        vertices, faces = groups.setdefault(kind, ([], []))
        k = len(vertices)
        vertices += [tuple(c + i * a + j * b for c, a, b in zip((x, y, z), u, v))
                     for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces += [(k, k + 1, k + 2), (k, k + 2, k + 3)]
    for kind, (vertices, faces) in groups.items():
        radiance = tuple(1.6 ** kind * (0.4 + 0.6 * chance.random()) for _ in range(3))
        scene.meshes.append((scene.glowing(f"lights {kind}", radiance), vertices, faces))
    return scene


SCENES = {"cornell": cornell, "sponza": sponza, "interior": interior, "many_lights": many_lights}
# Not rendered by Cycles: with a bunny of 1.1 million triangles.
HEAVY = {"heavy_interior": lambda data: interior(data, splits=2)}


def tuple_text(values):
    return "(" + ", ".join(f"{v:.9g}" for v in values) + ")"


def write_alhazen(scene, path):
    """Writes the scene, with its meshes beside it."""
    base = os.path.splitext(path)[0]
    with open(path, "w", encoding="ascii") as out:
        out.write(f"alhazen 1\nperspective_camera {{ eye = {tuple_text(scene.eye)}; look_at = {tuple_text(scene.at)}; "
                  f"up = (0, 0, 1); fov_deg = {scene.angle} }}\n")
        if scene.sky:
            out.write(f'environment {{ kind = picture; file = "{scene.sky}"; up = (0, 0, 1); rotation_deg = -90 }}\n')
        for name, m in scene.materials.items():
            if "glossy" in m:
                given = (f"metallic_roughness = {{ base_color = {tuple_text(m['glossy'])}; metallic = 1; "
                         f"roughness = {m['roughness']} }}")
            else:
                kind = "diffuse" if "diffuse" in m else "emission"
                given = f"{kind} = {tuple_text(m[kind])}"
            out.write(f'material "{name}" {{ {given} }}\n')
        for k, (material, vertices, faces) in enumerate(scene.meshes):
            with open(f"{base}_{k}.obj", "w", encoding="ascii") as mesh:
                mesh.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in vertices)
                mesh.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces)
            out.write(f'mesh {{ file = "{os.path.basename(base)}_{k}.obj"; material = "{material}" }}\n')


def write_json(scene, path):
    with open(path, "w", encoding="ascii") as out:
        json.dump({"eye": scene.eye, "at": scene.at, "angle": scene.angle, "depth": scene.depth, "sky": scene.sky,
                   "materials": scene.materials, "meshes": scene.meshes}, out)
