"""Converts scenes to the languages of Alhazen's peers: spheres, triangles and polygons, point lights, mirrors.

Reads NFF (v b l f s p) and OBJ (v f); writes POV-Ray, Tachyon and Alhazen's native text.
"""

import math


class Scene:
    def __init__(self):
        self.eye, self.at, self.up, self.angle = (0, 0, 1), (0, 0, 0), (0, 1, 0), 45.0
        self.background = (0, 0, 0)
        self.lights = []
        self.materials = []   # (r, g, b, kd, ks, shine)
        self.spheres = []     # (material, centre, radius)
        self.polygons = []    # (material, [vertex])
        self.mesh = None      # (material, [vertex], [(i, j, k)])


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    n = math.sqrt(sum(x * x for x in a))
    return tuple(x / n for x in a)


def read_nff(path):
    scene = Scene()
    lines = iter(open(path, encoding="ascii"))
    for line in lines:
        word, *rest = line.split() or [""]
        numbers = lambda texts=rest: tuple(float(t) for t in texts)
        if word == "from":
            scene.eye = numbers()
        elif word == "at":
            scene.at = numbers()
        elif word == "up":
            scene.up = numbers()
        elif word == "angle":
            scene.angle = numbers()[0]
        elif word == "b":
            scene.background = numbers()
        elif word == "l":
            scene.lights.append(numbers()[:3])
        elif word == "f":
            scene.materials.append(numbers()[:6])
        elif word == "s":
            x, y, z, r = numbers()
            scene.spheres.append((len(scene.materials) - 1, (x, y, z), r))
        elif word == "p":
            count = int(rest[0])
            vertices = [tuple(float(t) for t in next(lines).split()) for _ in range(count)]
            scene.polygons.append((len(scene.materials) - 1, vertices))
        elif word in ("c", "pp"):
            raise ValueError(f"{path}: {word} is not converted")
    return scene


def parse_obj(lines):
    """The vertices and {material: [triangle]} of OBJ; polygons become fans."""
    vertices, of_material, material = [], {}, ""
    for line in lines:
        word, *rest = line.split() or [""]
        if word == "v":
            vertices.append(tuple(float(t) for t in rest[:3]))
        elif word == "usemtl":
            material = rest[0]
        elif word == "f":
            corners = [int(t.split("/")[0]) for t in rest]
            corners = [c - 1 if c > 0 else len(vertices) + c for c in corners]
            of_material.setdefault(material, []).extend(
                (corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1))
    return vertices, of_material


def read_obj(path):
    scene = Scene()
    with open(path, encoding="utf-8", errors="replace") as lines:
        vertices, of_material = parse_obj(lines)
    triangles = [triangle for group in of_material.values() for triangle in group]
    lo = tuple(min(v[k] for v in vertices) for k in range(3))
    hi = tuple(max(v[k] for v in vertices) for k in range(3))
    size = math.dist(lo, hi)
    scene.at = tuple((a + b) / 2 for a, b in zip(lo, hi))
    scene.eye = tuple(c + 1.3 * size * d for c, d in zip(scene.at, unit((0.3, 0.2, 1))))
    scene.background = (0.1, 0.15, 0.2)
    scene.lights = [tuple(e + size * d for e, d in zip(scene.eye, (0.6, 1.0, 0.2)))]
    scene.materials = [(0.8, 0.7, 0.6, 0.9, 0.0, 10)]
    scene.mesh = (0, vertices, triangles)
    return scene


def light_level(scene):
    """Haines' default intensity of a light without a colour."""
    n = len(scene.lights)
    return math.sqrt(n) / (2 * n)


def text(v):
    return " ".join(f"{x:.9g}" for x in v)


def angle_vector(v):
    return "<" + ",".join(f"{x:.9g}" for x in v) + ">"


def write_povray(scene, path, max_level=5):
    forward = unit(sub(scene.at, scene.eye))
    right = unit(cross(forward, scene.up))
    up = cross(right, forward)
    height = 2 * math.tan(math.radians(scene.angle) / 2)
    level = light_level(scene)
    with open(path, "w", encoding="ascii") as out:
        out.write(f"#version 3.7;\nglobal_settings {{ max_trace_level {max_level} adc_bailout 0 assumed_gamma 1 }}\n")
        out.write(f"camera {{ perspective location {angle_vector(scene.eye)} direction {angle_vector(forward)} "
                  f"right {angle_vector([height * x for x in right])} up {angle_vector([height * x for x in up])} }}\n")
        out.write(f"background {{ rgb {angle_vector(scene.background)} }}\n")
        for position in scene.lights:
            out.write(f"light_source {{ {angle_vector(position)} rgb {level:.9g} }}\n")
        for i, (r, g, b, kd, ks, shine) in enumerate(scene.materials):
            out.write(f"#declare M{i} = texture {{ pigment {{ rgb <{r},{g},{b}> }} finish {{ ambient 0 diffuse {kd} "
                      f"phong {ks} phong_size {shine} reflection {ks} }} }}\n")
        for m, center, radius in scene.spheres:
            out.write(f"sphere {{ {angle_vector(center)}, {radius:.9g} texture {{ M{m} }} }}\n")
        for m, vertices in scene.polygons:
            loop = vertices + vertices[:1]
            out.write(f"polygon {{ {len(loop)}, {', '.join(map(angle_vector, loop))} texture {{ M{m} }} }}\n")
        if scene.mesh:
            m, vertices, triangles = scene.mesh
            out.write(f"mesh2 {{ vertex_vectors {{ {len(vertices)}, {','.join(map(angle_vector, vertices))} }}\n")
            faces = ",".join(angle_vector(t) for t in triangles)
            out.write(f"face_indices {{ {len(triangles)}, {faces} }} texture {{ M{m} }} }}\n")


def write_tachyon(scene, path, side, depth=5):
    forward = unit(sub(scene.at, scene.eye))
    up = cross(unit(cross(forward, scene.up)), forward)
    zoom = 1 / (2 * math.tan(math.radians(scene.angle) / 2))
    level = light_level(scene)
    # Tachyon is left-handed: mirroring in z gives the same image.
    flip = lambda v: (v[0], v[1], -v[2])
    with open(path, "w", encoding="ascii") as out:
        out.write(f"BEGIN_SCENE\nRESOLUTION {side} {side}\nCAMERA\nZOOM {zoom:.9g}\nASPECTRATIO 1.0\nANTIALIASING 0\n"
                  f"RAYDEPTH {depth}\nCENTER {text(flip(scene.eye))}\nVIEWDIR {text(flip(forward))}\n"
                  f"UPDIR {text(flip(up))}\nEND_CAMERA\n")
        out.write(f"BACKGROUND {text(scene.background)}\n")
        for position in scene.lights:
            out.write(f"LIGHT CENTER {text(flip(position))} RAD 0.001 COLOR {level} {level} {level}\n")
        for i, (r, g, b, kd, ks, shine) in enumerate(scene.materials):
            out.write(f"TEXDEF M{i} AMBIENT 0 DIFFUSE {kd} SPECULAR {ks} OPACITY 1 PHONG PLASTIC {ks} PHONG_SIZE {shine} "
                      f"COLOR {r} {g} {b} TEXFUNC 0\n")
        triangle = lambda a, b, c, m: out.write(
            f"TRI V0 {text(flip(a))} V1 {text(flip(b))} V2 {text(flip(c))} M{m}\n")
        for m, center, radius in scene.spheres:
            out.write(f"SPHERE CENTER {text(flip(center))} RAD {radius:.9g} M{m}\n")
        for m, vertices in scene.polygons:
            for i in range(1, len(vertices) - 1):
                triangle(vertices[0], vertices[i], vertices[i + 1], m)
        if scene.mesh:
            m, vertices, triangles = scene.mesh
            for i, j, k in triangles:
                triangle(vertices[i], vertices[j], vertices[k], m)
        out.write("END_SCENE\n")


def write_native_mesh(scene, path, mesh_file):
    """The scene of read_obj; the mesh stays in its own file, beside `path`."""
    level = light_level(scene)
    r, g, b, kd, _, _ = scene.materials[0]
    vector = lambda v: "(" + ", ".join(f"{x:.9g}" for x in v) + ")"
    with open(path, "w", encoding="ascii") as out:
        out.write(f"alhazen 1\npicture {{ background = {vector(scene.background)} }}\n")
        out.write(f'perspective_camera "front" {{ eye = {vector(scene.eye)}; look_at = {vector(scene.at)}; '
                  f"up = {vector(scene.up)}; fov_deg = {scene.angle} }}\n")
        for position in scene.lights:
            out.write(f"point_light {{ position = {vector(position)}; color = {vector((level,) * 3)} }}\n")
        out.write(f'material "surface" {{ diffuse = {vector((kd * r, kd * g, kd * b))} }}\n')
        out.write(f'mesh {{ file = "{mesh_file}"; material = "surface" }}\n')
