"""Scenes that an export must carry, built anew in the running Blender."""

import math

import bpy

WIDTH, HEIGHT = 640, 360


def fresh(first: int, last: int) -> bpy.types.Scene:
    """An empty scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = first, last, 24
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    return scene


def linked(name: str, data: bpy.types.ID | None, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> bpy.types.Object:
    """A new object in the scene."""
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    made.location = at
    return made


def added(name: str, add: str, **options: object) -> bpy.types.Object:
    """A mesh object of `bpy.ops.mesh`."""
    getattr(bpy.ops.mesh, add)(**options)
    made = bpy.context.object
    made.name = name
    return made


def keyed(thing: bpy.types.bpy_struct, path: str, values: list[tuple[int, object]]) -> None:
    """Sets keys."""
    for frame, value in values:
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)


def camera(name: str, at: tuple[float, float, float], toward: bpy.types.Object | None) -> bpy.types.Object:
    """A camera that tracks an object, if one is given. It becomes the scene's camera if there is none yet."""
    made = linked(name, bpy.data.cameras.new(name), at)
    if toward is not None:
        made.constraints.new("TRACK_TO").target = toward
    bpy.context.scene.camera = bpy.context.scene.camera or made
    return made


def sun() -> bpy.types.Object:
    """A sun from the upper left."""
    made = linked("Sun", bpy.data.lights.new("Sun", "SUN"), (0, 0, 6))
    made.data.energy = 3.0
    made.rotation_euler = (0.7, -0.5, 0.2)
    return made


def painted(name: str, color: tuple[float, float, float]) -> bpy.types.Material:
    """A plain material."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1.0)
    return made


def rig(name: str, bones: list[tuple[str, str, tuple[float, ...], tuple[float, ...]]]) -> bpy.types.Object:
    """An armature of bones: name, parent, head, tail."""
    made = linked(name, bpy.data.armatures.new(name))
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.mode_set(mode="EDIT")
    for bone_name, parent, head, tail in bones:
        bone = made.data.edit_bones.new(bone_name)
        bone.head, bone.tail = head, tail
        bone.parent = made.data.edit_bones.get(parent)
    bpy.ops.object.mode_set(mode="OBJECT")
    return made


def walk() -> None:
    """A figure on two legs, subdivided after its armature, walks."""
    scene = fresh(1, 24)
    legs = [("hip", "", (0, 0, 2), (0, 0, 3))]
    for side, x in (("L", 0.4), ("R", -0.4)):
        legs += [(f"thigh.{side}", "hip", (x, 0, 2), (x, 0, 1)), (f"shin.{side}", f"thigh.{side}", (x, 0, 1), (x, 0, 0))]
    frame = rig("Rig", legs)
    points, faces, owners = [], [], []
    for bone, _, head, tail in legs:
        low, high, wide = min(head[2], tail[2]), max(head[2], tail[2]), 0.7 if bone == "hip" else 0.25
        for ring in range(4):
            z = low + (high - low) * ring / 3
            start = len(points)
            points += [(head[0] + wide * x, wide * 0.6 * y, z) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            owners += [bone] * 4
            if ring > 0:
                faces += [(start - 4 + side, start - 4 + (side + 1) % 4, start + (side + 1) % 4, start + side)
                          for side in range(4)]
    mesh = bpy.data.meshes.new("Figure")
    mesh.from_pydata(points, [], faces)
    figure = linked("Figure", mesh)
    figure.parent = frame
    for bone, *_ in legs:
        figure.vertex_groups.new(name=bone).add([order for order, owner in enumerate(owners) if owner == bone], 1.0, "REPLACE")
    upper = figure.vertex_groups.new(name="Shirt")
    upper.add([order for order, owner in enumerate(owners) if owner == "hip"], 1.0, "REPLACE")
    figure.modifiers.new("Rig", "ARMATURE").object = frame
    smooth = figure.modifiers.new("Subdivision", "SUBSURF")
    smooth.levels, smooth.render_levels = 1, 1
    mesh.materials.append(painted("Skin", (0.8, 0.4, 0.2)))
    for side, sign in (("L", 1), ("R", -1)):
        for bone, swing, bend in (("thigh", 0.6, 0.0), ("shin", 0.3, -0.3)):
            pose = frame.pose.bones[f"{bone}.{side}"]
            pose.rotation_mode = "XYZ"
            keyed(pose, "rotation_euler", [(at, (bend + sign * swing * math.sin(at / 24 * 2 * math.pi), 0, 0))
                                           for at in range(1, 26, 4)])
    keyed(frame, "location", [(1, (0, 1.5, 0)), (24, (0, -1.5, 0))])
    added("Floor", "primitive_plane_add", size=12).data.materials.append(painted("Floor", (0.3, 0.4, 0.3)))
    sun()
    camera("Cam", (7, -4, 3), frame)
    scene.frame_set(1)


def cloth() -> None:
    """A cloth falls on a ball."""
    fresh(1, 24)
    ball = added("Ball", "primitive_uv_sphere_add", segments=24, ring_count=12, radius=1.0)
    ball.modifiers.new("Collision", "COLLISION")
    sheet = added("Cloth", "primitive_grid_add", x_subdivisions=24, y_subdivisions=24, size=3.0, location=(0, 0, 1.2))
    sheet.modifiers.new("Cloth", "CLOTH").settings.quality = 3
    sheet.data.materials.append(painted("Cloth", (0.7, 0.1, 0.1)))
    sun()
    camera("Cam", (5, -6, 4), ball)


def cuts() -> None:
    """Two cameras, keys on shift, lens and visibility."""
    scene = fresh(1, 24)
    target = added("Target", "primitive_monkey_add")
    blinking = added("Blinking", "primitive_cube_add", location=(2.5, 0, 0), size=1.0)
    keyed(blinking, "hide_render", [(1, False), (8, True), (16, False)])
    never = added("Never", "primitive_cube_add", location=(-2.5, 0, 0), size=1.0)
    never.hide_render = True
    keyed(target, "rotation_euler", [(1, (0, 0, 0)), (24, (0, 0, 2.0))])
    first = camera("CamA", (6, -7, 3), target)
    second = camera("CamB", (-4, -7, 1), target)
    second.data.type, second.data.ortho_scale = "ORTHO", 7.0
    second.data.shift_y = 0.1
    keyed(first.data, "shift_x", [(1, -0.1), (12, 0.2)])
    keyed(first.data, "lens", [(1, 35.0), (24, 60.0)])
    scene.timeline_markers.new("A", frame=1).camera = first
    scene.timeline_markers.new("B", frame=13).camera = second
    lamp = linked("Lamp", bpy.data.lights.new("Lamp", "POINT"), (2, -3, 4))
    keyed(lamp.data, "energy", [(1, 100.0), (24, 600.0)])
    keyed(lamp, "hide_render", [(1, False), (20, True)])
    sun()


def instances() -> None:
    """Two hundred instances: of a collection, linked duplicates, and by geometry nodes."""
    scene = fresh(1, 12)
    grove = bpy.data.collections.new("Grove")
    scene.collection.children.link(grove)
    tree = added("Tree", "primitive_cone_add", vertices=8, depth=2.0, location=(0.3, 0, 1))
    stone = added("Stone", "primitive_ico_sphere_add", subdivisions=1, radius=0.3, location=(1, 0, 0))
    for thing in (tree, stone):
        scene.collection.objects.unlink(thing)
        grove.objects.link(thing)
    tree.data.materials.append(painted("Leaf", (0.1, 0.4, 0.1)))
    for number in range(40):
        made = linked(f"Grove{number:02}", None, (-12 + 3 * (number % 8), 3 * (number // 8), 0))
        made.instance_type, made.instance_collection = "COLLECTION", grove
        if number % 5 == 0:
            keyed(made, "rotation_euler", [(1, (0, 0, 0)), (12, (0, 0, 2.0))])
    monkey = added("Monkey", "primitive_monkey_add", size=0.6, location=(-12, -2, 1))
    for number in range(1, 60):
        copy = monkey.copy()
        copy.name = f"Monkey{number:02}"
        copy.location = (-12 + 1.2 * (number % 20), -2 - 1.2 * (number // 20), 1)
        scene.collection.objects.link(copy)
        if number % 10 == 0:
            keyed(copy, "location", [(1, copy.location[:]), (12, (copy.location[0], copy.location[1], 2.5))])
    scattered(stone)
    camera("Cam", (0, -24, 12), linked("Middle", None, (0, 3, 0)))
    sun()


def scattered(stone: bpy.types.Object) -> None:
    """A wandering grid of which every point carries a stone and a small cone that exists in the nodes only."""
    grid = added("Scatter", "primitive_grid_add", x_subdivisions=4, y_subdivisions=5, size=8, location=(0, 0, 3.5))
    keyed(grid, "location", [(1, (0, 0, 3.5)), (12, (2, 0, 3.5))])
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Size", in_out="INPUT", socket_type="NodeSocketFloat").default_value = 1.0
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    node = tree.nodes.new
    start, end, joined = node("NodeGroupInput"), node("NodeGroupOutput"), node("GeometryNodeJoinGeometry")
    source, cone = node("GeometryNodeObjectInfo"), node("GeometryNodeMeshCone")
    source.inputs["Object"].default_value, source.inputs["As Instance"].default_value = stone, True
    cone.inputs["Vertices"].default_value, cone.inputs["Radius Bottom"].default_value = 6, 0.2
    cone.inputs["Depth"].default_value = 0.8
    for made in (source.outputs["Geometry"], cone.outputs["Mesh"]):
        scatter = node("GeometryNodeInstanceOnPoints")
        tree.links.new(start.outputs[0], scatter.inputs["Points"])
        tree.links.new(start.outputs[1], scatter.inputs["Scale"])
        tree.links.new(made, scatter.inputs["Instance"])
        tree.links.new(scatter.outputs[0], joined.inputs[0])
    tree.links.new(joined.outputs[0], end.inputs[0])
    grid.modifiers.new("Scatter", "NODES").node_group = tree


def slanted() -> None:
    """A sheared child, a mirrored grid that waves, and one that shows only later."""
    fresh(1, 12)
    flat = added("Flat", "primitive_cube_add", size=1.0)
    flat.scale = (2.0, 0.5, 1.0)
    child = added("Child", "primitive_monkey_add", location=(0, 3, 1), size=1.0)
    child.parent = flat
    keyed(child, "rotation_euler", [(1, (0, 0, 0)), (12, (0.3, 0.5, 1.5))])
    mirrored = added("Mirrored", "primitive_grid_add", x_subdivisions=10, y_subdivisions=8, size=2, location=(3, 0, 0))
    mirrored.scale = (-1.0, 1.0, 1.5)
    mirrored.modifiers.new("Wave", "WAVE").height = 0.4
    late = added("Late", "primitive_grid_add", x_subdivisions=6, y_subdivisions=6, size=2, location=(-3, 0, 0))
    late.modifiers.new("Wave", "WAVE").height = 0.4
    keyed(late, "hide_render", [(1, True), (5, False), (9, True), (11, False)])
    keyed(late, "location", [(1, (-3, 0, 0)), (12, (-3, 1, 1))])
    camera("Cam", (1, -9, 4), flat)
    sun()
