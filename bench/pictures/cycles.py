"""Runs within Blender: renders a scene of bench/pictures/light_scenes.py with Cycles, or compares pictures.

Usage: blender -b --factory-startup -P bench/pictures/cycles.py -- render SCENE OUT.exr WIDTH HEIGHT SECONDS SAMPLES SEED FILTER
       blender -b --factory-startup -P bench/pictures/cycles.py -- compare A.exr B.exr
SECONDS 0: SAMPLES samples. Plain path tracing: no denoising, clamping, adaptive sampling or blurred caustics.
`compare` prints the root mean squared difference, that of the values clamped to 1, and the means.
"""

import json
import os
import sys

if "--help" in sys.argv:
    print(__doc__)
    sys.exit()
try:
    import bpy
    import mathutils
    import numpy
except ModuleNotFoundError as error:
    sys.exit(f"{error}: this runs within Blender\n{__doc__}")


def material_of(name, given):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    out = nodes.new("ShaderNodeOutputMaterial")
    kind = {"diffuse": "ShaderNodeBsdfDiffuse", "glossy": "ShaderNodeBsdfGlossy",
            "emission": "ShaderNodeEmission"}[next(iter(given))]
    node = nodes.new(kind)
    color = next(iter(given.values()))
    node.inputs["Color"].default_value = (*color, 1)
    if "glossy" in given:
        node.distribution = "MULTI_GGX"
        node.inputs["Roughness"].default_value = given["roughness"]
    if "diffuse" in given:
        node.inputs["Roughness"].default_value = 0
    links.new(node.outputs[0], out.inputs["Surface"])
    return material


def surround(world, sky):
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    background, out = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeOutputWorld")
    background.inputs["Color"].default_value = (0, 0, 0, 1)
    links.new(background.outputs[0], out.inputs["Surface"])
    if sky:
        picture = nodes.new("ShaderNodeTexEnvironment")
        picture.image = bpy.data.images.load(sky)
        links.new(picture.outputs["Color"], background.inputs["Color"])


def render(path, out, width, height, seconds, samples, seed, pixel_filter):
    with open(path, encoding="ascii") as source:
        given = json.load(source)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    materials = {name: material_of(name, m) for name, m in given["materials"].items()}
    for k, (material, vertices, faces) in enumerate(given["meshes"]):
        mesh = bpy.data.meshes.new(f"mesh {k}")
        mesh.from_pydata(vertices, [], faces)
        mesh.materials.append(materials[material])
        scene.collection.objects.link(bpy.data.objects.new(f"mesh {k}", mesh))
    world = bpy.data.worlds.new("world")
    scene.world = world
    surround(world, given["sky"] and os.path.join(os.path.dirname(os.path.abspath(path)), given["sky"]))

    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle_y = given["angle"] * 3.141592653589793 / 180
    camera.clip_start, camera.clip_end = 1e-3, 1e3
    placed = bpy.data.objects.new("camera", camera)
    eye = mathutils.Vector(given["eye"])
    placed.location = eye
    placed.rotation_euler = (mathutils.Vector(given["at"]) - eye).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(placed)
    scene.camera = placed

    scene.render.engine = "CYCLES"
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = os.path.abspath(out)
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.samples = samples
    cycles.time_limit = seconds
    cycles.seed = seed
    cycles.pixel_filter_type = pixel_filter
    cycles.filter_width = 1.5  # of Blackman and Harris: the radius
    cycles.max_bounces = given["depth"]
    cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = given["depth"]
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.light_sampling_threshold = 0
    cycles.use_auto_tile = False
    bpy.ops.render.render(write_still=True)


def pixels(path):
    image = bpy.data.images.load(os.path.abspath(path))
    image.colorspace_settings.name = "Non-Color"
    values = numpy.empty(4 * image.size[0] * image.size[1], dtype=numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(-1, 4)[:, :3].astype(numpy.float64)


def compare(a, b):
    one, other = pixels(a), pixels(b)
    root = lambda x, y: float(numpy.sqrt(numpy.mean((x - y) ** 2)))
    print("compared", json.dumps({"rmse": root(one, other),
                                  "shown": root(numpy.minimum(one, 1), numpy.minimum(other, 1)),
                                  "means": [float(one.mean()), float(other.mean())]}))


command, *rest = sys.argv[sys.argv.index("--") + 1:]
if command == "render":
    render(rest[0], rest[1], int(rest[2]), int(rest[3]), float(rest[4]), int(rest[5]), int(rest[6]), rest[7])
else:
    compare(*rest)
