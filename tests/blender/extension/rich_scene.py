"""A scene with a little of all that exporters trip over."""

import os

import bpy
from scenes import camera, fresh, keyed, linked


def textured(folder: str) -> bpy.types.Material:
    """A material with a picture on disk."""
    image = bpy.data.images.new("checker", 64, 64)
    image.generated_type = "UV_GRID"
    image.filepath_raw, image.file_format = os.path.join(folder, "checker.png"), "PNG"
    image.save()
    made = bpy.data.materials.new("Tex")
    made.use_nodes = True
    picture = made.node_tree.nodes.new("ShaderNodeTexImage")
    picture.image = image
    made.node_tree.links.new(picture.outputs[0], made.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    return made


def skinned() -> None:
    """A cylinder on two bones."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=16, depth=4, location=(3, 0, 2))
    arm = bpy.context.object
    arm.name = "Arm"
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=4)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig = linked("Rig", bpy.data.armatures.new("Rig"), (3, 0, 0))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    lower, upper = rig.data.edit_bones.new("b0"), rig.data.edit_bones.new("b1")
    lower.head, lower.tail, upper.head, upper.tail = (0, 0, 0), (0, 0, 2), (0, 0, 2), (0, 0, 4)
    upper.parent, upper.use_connect = lower, True
    bpy.ops.object.mode_set(mode="OBJECT")
    arm.parent, arm.location = rig, (0, 0, 2)
    arm.modifiers.new("Armature", "ARMATURE").object = rig
    for order, name in enumerate(("b0", "b1")):
        points = [vertex.index for vertex in arm.data.vertices if (vertex.co.z > 0) == (order == 1)]
        arm.vertex_groups.new(name=name).add(points, 1, "REPLACE")
    pose = rig.pose.bones["b1"]
    pose.rotation_mode = "XYZ"
    keyed(pose, "rotation_euler", [(1, (0, 0, 0)), (24, (1, 0, 0))])


def rich(folder: str) -> None:
    """Shape key, skin, duplicates, a collection instance, a curve, four kinds of lights, two cameras."""
    scene = fresh(1, 24)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, location=(0, 0, 1))
    ball = bpy.context.object
    ball.name = "Ball"
    ball.shape_key_add(name="Basis")
    tall = ball.shape_key_add(name="Tall")
    for point in tall.data:
        point.co.z *= 1.7
    keyed(tall, "value", [(1, 0.0), (24, 1.0)])
    ball.data.materials.append(textured(folder))
    skinned()
    bpy.ops.mesh.primitive_monkey_add(location=(-3, 0, 1))
    monkey = bpy.context.object
    monkey.name = "Monkey"
    for number in range(4):
        copy = monkey.copy()
        copy.location.y, copy.name = -2 * (number + 1), f"MonkeyI{number}"
        scene.collection.objects.link(copy)
    keyed(monkey, "hide_render", [(1, False), (12, True)])
    group = bpy.data.collections.new("Set")
    scene.collection.children.link(group)
    bpy.ops.mesh.primitive_cube_add(location=(0, 5, 0))
    cube = bpy.context.object
    for collection in list(cube.users_collection):
        collection.objects.unlink(cube)
    group.objects.link(cube)
    cube.modifiers.new("Subdivision", "SUBSURF").levels = 2
    made = linked("SetInst", None, (4, 4, 0))
    made.instance_type, made.instance_collection = "COLLECTION", group
    bpy.ops.curve.primitive_bezier_circle_add(location=(0, -4, 0))
    bpy.context.object.data.bevel_depth = 0.1
    first = camera("Cam", (8, -8, 5), ball)
    keyed(first, "location", [(1, (8, -8, 5)), (24, (8, 8, 5))])
    keyed(first.data, "lens", [(1, 35.0), (24, 70.0)])
    first.data.shift_x = 0.1
    second = camera("Ortho", (0, -9, 1), ball)
    second.data.type, second.data.ortho_scale = "ORTHO", 6.0
    scene.timeline_markers.new("A", frame=1).camera = first
    scene.timeline_markers.new("B", frame=12).camera = second
    for name, kind, watts in (("Sun", "SUN", 3.0), ("Spot", "SPOT", 500.0), ("Point", "POINT", 100.0), ("Area", "AREA", 100.0)):
        linked(name, bpy.data.lights.new(name, kind), (0, 0, 6)).data.energy = watts
