"""Renders what scene_dump wrote with Blender's Cycles.

blender -b --factory-startup --python-exit-code 1 --python in_cycles.py -- FOLDER OUT.exr [--view 0|1|2] [--samples N] [--threads N]
    [--alpha on|off] [--ambient on|off] [--transparent N] [--blend FILE]

One ray a pixel through its middle, one towards the sun, no bounce: what silva_frame does. Plants are instances on a cloud
of points, so that Blender holds 28 bytes a plant; what Cycles makes of them is its own affair. The last line of the output
is one JSON object. --ambient on adds the sky's light without rays, as SilvaVis does with --sky-rays 0. --blend keeps the
scene for looking at it in Blender.
"""

import argparse
import json
import math
import os
import resource
import sys
import time

import bpy
import mathutils
import numpy as np


def options():
    parser = argparse.ArgumentParser(prog="in_cycles.py")
    parser.add_argument("folder")
    parser.add_argument("output")
    parser.add_argument("--view", type=int, default=0)
    parser.add_argument("--samples", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--alpha", choices=["on", "off"], default="on")
    parser.add_argument("--ambient", choices=["on", "off"], default="on")
    parser.add_argument("--transparent", type=int, default=8)
    parser.add_argument("--blend")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def luminance(colour):
    return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]


class Shader:
    """A material's nodes, made one after another."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        # Leaves that glow a little from the sky are no lamps.
        self.material.cycles.sample_as_light = False
        self.tree = self.material.node_tree
        self.tree.nodes.clear()

    def node(self, kind, inputs=None, **settings):
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for key, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def times(self, colour, factor):
        """A colour, from a socket or as numbers, times three numbers."""
        if not isinstance(colour, bpy.types.NodeSocket):
            return [*(a * b for a, b in zip(colour, factor)), 1]
        node = self.node("ShaderNodeMixRGB", {"Fac": 1, "Color1": colour, "Color2": [*factor, 1]}, blend_type="MULTIPLY")
        return node.outputs[0]

    def by_slope(self, down, up):
        """`up` where the surface faces the zenith, `down` where it faces the ground, between them in between."""
        normal = self.node("ShaderNodeNewGeometry").outputs["Normal"]
        z = self.node("ShaderNodeSeparateXYZ", {0: normal}).outputs["Z"]
        share = self.node("ShaderNodeMath", {0: z, 1: 0.5, 2: 0.5}, operation="MULTIPLY_ADD").outputs[0]
        return self.node("ShaderNodeMixRGB", {"Fac": share, "Color1": [*down, 1], "Color2": [*up, 1]}).outputs[0]

    def sum(self, a, b):
        return self.node("ShaderNodeAddShader", {0: a, 1: b}).outputs[0]

    def through(self, share, surface):
        """The surface, but nothing of it where `share` is 0."""
        clear = self.node("ShaderNodeBsdfTransparent").outputs[0]
        return self.node("ShaderNodeMixShader", {0: share, 1: clear, 2: surface}).outputs[0]

    def end(self, surface):
        self.node("ShaderNodeOutputMaterial", {"Surface": surface})
        return self.material


def matte(shader, reflected, passed, sky):
    """Diffuse on both sides; `sky` is the light from above and from below over pi, None for none."""
    surface = shader.node("ShaderNodeBsdfDiffuse", {"Color": reflected}).outputs[0]
    if passed is not None:
        surface = shader.sum(surface, shader.node("ShaderNodeBsdfTranslucent", {"Color": passed}).outputs[0])
    if sky is not None:
        for colour, (up, down) in ((reflected, sky), (passed, sky[::-1])):
            if colour is None:
                continue
            light = shader.by_slope(down, up)
            glow = shader.node("ShaderNodeMixRGB", {"Fac": 1, "Color1": light, "Color2": colour}, blend_type="MULTIPLY")
            glow = shader.node("ShaderNodeEmission", {"Color": glow.outputs[0], "Strength": 1})
            surface = shader.sum(surface, glow.outputs[0])
    return surface


def plant_material(name, entry, folder, alpha, sky):
    shader = Shader(name)
    colour, share = (1, 1, 1), None
    if "texture" in entry:
        image = bpy.data.images.load(os.path.join(folder, entry["texture"]), check_existing=True)
        image.alpha_mode = "CHANNEL_PACKED"
        texture = shader.node("ShaderNodeTexImage", image=image)
        colour = texture.outputs["Color"]
        if entry["alpha_cutoff"] > 0 and alpha:
            cut = shader.node("ShaderNodeMath", {0: texture.outputs["Alpha"], 1: entry["alpha_cutoff"]}, operation="GREATER_THAN")
            share = cut.outputs[0]
    passed = shader.times(colour, entry["transmittance"]) if max(entry["transmittance"]) > 0 else None
    surface = matte(shader, shader.times(colour, entry["reflectance"]), passed, sky)
    return shader.end(shader.through(share, surface) if share is not None else surface)


def ground_material(sky):
    shader = Shader("ground")
    colour = shader.node("ShaderNodeVertexColor", layer_name="colour").outputs[0]
    return shader.end(matte(shader, colour, None, sky))


def mesh_of(name, positions, corners):
    """A mesh of triangles; corners: vertex numbers, three a triangle."""
    mesh = bpy.data.meshes.new(name)
    count = len(corners) // 3
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", positions.ravel())
    mesh.loops.add(3 * count)
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(count, 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(count, dtype=bool))
    mesh.update(calc_edges=True)
    return mesh


def model_object(entry, folder, alpha, sky):
    column = lambda name: np.load(os.path.join(folder, f"{entry['file']}.{name}.npy"))
    positions = column("positions")
    mesh = mesh_of(entry["file"], positions, np.arange(len(positions), dtype=np.int32))
    uvs = column("uvs")
    uvs[:, 1] = 1 - uvs[:, 1]  # Blender's run upwards
    mesh.uv_layers.new(name="uv").data.foreach_set("uv", uvs.ravel())
    for number, material in enumerate(entry["materials"]):
        mesh.materials.append(plant_material(f"{entry['file']}.{number} {material['name']}", material, folder, alpha, sky))
    mesh.polygons.foreach_set("material_index", column("materials").astype(np.int32))
    mesh.use_auto_smooth = True
    mesh.normals_split_custom_set(column("normals"))
    return bpy.data.objects.new(entry["file"], mesh)


def ground_object(entry, folder, sky):
    columns, rows = entry["columns"], entry["rows"]
    heights = np.load(os.path.join(folder, "ground.heights.npy"))
    x = entry["west"] + entry["cell_x_m"] * np.arange(columns)
    y = entry["south"] + entry["cell_y_m"] * np.arange(rows)
    positions = np.empty((rows, columns, 3), dtype=np.float32)
    positions[..., 0], positions[..., 1], positions[..., 2] = x[None, :], y[:, None], heights
    # Each cell is cut from its south-west to its north-east corner, as in silvavis/scene/ground.h.
    number = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    sw, se, nw, ne = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    corners = np.stack([sw, se, ne, sw, ne, nw], axis=-1).ravel()
    mesh = mesh_of("ground", positions.reshape(-1, 3), corners)
    colours = np.ones((rows * columns, 4), dtype=np.float32)
    colours[:, :3] = np.load(os.path.join(folder, "ground.colours.npy"))
    mesh.color_attributes.new("colour", "FLOAT_COLOR", "POINT").data.foreach_set("color", colours.ravel())
    mesh.materials.append(ground_material(sky))
    return bpy.data.objects.new("ground", mesh)


def plants_object(folder, models):
    """A cloud of points on which geometry nodes set the models of a collection."""
    column = lambda name: np.load(os.path.join(folder, f"instances.{name}.npy"))
    positions, turns = column("positions"), column("turns")
    mesh = bpy.data.meshes.new("plants")
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", positions.ravel())
    mesh.attributes.new("model", "INT", "POINT").data.foreach_set("value", column("models").astype(np.int32))
    mesh.attributes.new("scale", "FLOAT", "POINT").data.foreach_set("value", column("scales"))
    rotation = np.zeros((len(turns), 3), dtype=np.float32)
    rotation[:, 2] = turns
    mesh.attributes.new("rotation", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", rotation.ravel())
    mesh.update()
    plants = bpy.data.objects.new("plants", mesh)

    tree = bpy.data.node_groups.new("plants", "GeometryNodeTree")
    tree.inputs.new("NodeSocketGeometry", "points")
    tree.outputs.new("NodeSocketGeometry", "plants")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    instances = tree.nodes.new("GeometryNodeInstanceOnPoints")
    instances.inputs["Pick Instance"].default_value = True
    collection = tree.nodes.new("GeometryNodeCollectionInfo")
    collection.inputs["Collection"].default_value = models
    collection.inputs["Separate Children"].default_value = True
    collection.inputs["Reset Children"].default_value = True

    def attribute(name, kind):
        node = tree.nodes.new("GeometryNodeInputNamedAttribute")
        node.data_type = kind
        node.inputs["Name"].default_value = name
        return next(output for output in node.outputs if output.enabled and output.name == "Attribute")

    link = tree.links.new
    link(start.outputs[0], instances.inputs["Points"])
    link(collection.outputs[0], instances.inputs["Instance"])
    link(attribute("model", "INT"), instances.inputs["Instance Index"])
    link(attribute("rotation", "FLOAT_VECTOR"), instances.inputs["Rotation"])
    link(attribute("scale", "FLOAT"), instances.inputs["Scale"])
    link(instances.outputs[0], end.inputs[0])
    plants.modifiers.new("plants", "NODES").node_group = tree
    return plants


def add_light(scene, sun):
    irradiance = sun["irradiance"]
    lamp = bpy.data.lights.new("sun", "SUN")
    lamp.energy = luminance(irradiance)
    lamp.color = [c / luminance(irradiance) for c in irradiance]
    lamp.angle = 0
    lamp_object = bpy.data.objects.new("sun", lamp)
    lamp_object.rotation_euler = mathutils.Vector(sun["direction"]).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(lamp_object)
    # A plain sky for the eye alone.
    world = scene.world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = [*sun["horizon"], 1]
    world.cycles.sampling_method = "NONE"
    for kind in ("diffuse", "glossy", "transmission", "scatter"):
        setattr(world.cycles_visibility, kind, False)


def add_camera(scene, entry):
    lens = bpy.data.cameras.new(entry["name"])
    lens.sensor_fit = "HORIZONTAL"
    lens.angle = math.radians(entry["horizontal_fov_deg"])
    lens.clip_start, lens.clip_end = 0.1, 1e6
    camera = bpy.data.objects.new(entry["name"], lens)
    camera.location = entry["eye"]
    along = mathutils.Vector(entry["look_at"]) - mathutils.Vector(entry["eye"])
    camera.rotation_euler = along.to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    return camera


def set_render(scene, asked):
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = 1920, 1080, 100
    render.threads_mode, render.threads = "FIXED", asked.threads
    render.filepath = os.path.abspath(asked.output)
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.exr_codec = "ZIP"
    render.image_settings.use_zbuffer = True
    scene.view_layers[0].use_pass_z = True
    cycles.device = "CPU"
    cycles.samples = asked.samples
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 0
    cycles.transparent_max_bounces = asked.transparent
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.01  # through the pixel's middle
    cycles.light_sampling_threshold = 0
    cycles.use_auto_tile = False


def main():
    asked = options()
    asked.folder = os.path.abspath(asked.folder)
    begin = time.monotonic()
    with open(os.path.join(asked.folder, "scene.json"), encoding="utf-8") as file:
        described = json.load(file)
    # Nothing of the default scene stays.
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    # The share of the sky that render() gives where it sends no rays there.
    sky = [[0.6 / math.pi * c for c in described["sun"][side]] for side in ("from_above", "from_below")]
    sky = sky if asked.ambient == "on" else None
    models = bpy.data.collections.new("models")
    for entry in described["models"]:
        models.objects.link(model_object(entry, asked.folder, asked.alpha == "on", sky))
    scene.collection.objects.link(ground_object(described["ground"], asked.folder, sky))
    scene.collection.objects.link(plants_object(asked.folder, models))
    add_light(scene, described["sun"])
    cameras = [add_camera(scene, entry) for entry in described["cameras"]]
    scene.camera = cameras[asked.view]
    set_render(scene, asked)
    if asked.blend:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(asked.blend))
    made_s, made_cpu_s = time.monotonic() - begin, cpu_seconds()
    print("in_cycles: render begins", flush=True)
    begin = time.monotonic()
    bpy.ops.render.render(write_still=True)
    print(
        json.dumps(
            {
                "plants": described["instances"],
                "made_s": made_s,
                "made_cpu_s": made_cpu_s,
                "render_s": time.monotonic() - begin,
                "render_cpu_s": cpu_seconds() - made_cpu_s,
                "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6,
            }
        )
    )


main()
