# Curves become guides on the surface nearest to them, beside what was combed, on things that stand still and that bend.
import bpy
import session
from mathutils import Vector

session.start()
scene = session.fresh(last=3)
monkey = session.turning_monkey(scene)
folder = session.save()
assert bpy.ops.impasto.export() == {"FINISHED"}
scene_file = folder / "film_impasto" / "film.ron"
monkey.impasto.coverage = 3.5

guides = bpy.data.collections.new("Impasto guides")
scene.collection.children.link(guides)


def curve(kind: str, at: list[tuple[float, float, float]]) -> bpy.types.Object:
    data = bpy.data.curves.new("Stroke", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new(kind)
    if kind == "BEZIER":
        spline.bezier_points.add(len(at) - 1)
        for point, place in zip(spline.bezier_points, at):
            point.co = place
            point.handle_left_type = point.handle_right_type = "AUTO"
    else:
        spline.points.add(len(at) - 1)
        for point, place in zip(spline.points, at):
            point.co = (*place, 1)
    thing = bpy.data.objects.new("Stroke", data)
    guides.objects.link(thing)
    return thing


scene.frame_set(1)
curve("BEZIER", [(-0.4, -1.0, 0.1), (0.0, -1.1, 0.3), (0.4, -1.0, 0.1)])
curve("POLY", [(-0.3, -1.0, -0.3), (0.3, -1.0, -0.3)])
hair = bpy.data.hair_curves.new("Hair")
if hasattr(hair, "add_curves"):
    hair.add_curves([3])
    hair.position_data.foreach_set("vector", [-0.2, -1.0, 0.5, 0.0, -1.0, 0.55, 0.2, -1.0, 0.5])
    guides.objects.link(bpy.data.objects.new("Hair", hair))
if bpy.app.version >= (4, 3):
    pencils = getattr(bpy.data, "grease_pencils_v3", bpy.data.grease_pencils)
    pencil = pencils.new("Pencil")
    drawing = pencil.layers.new("Lines").frames.new(1).drawing
    drawing.add_strokes([3])
    for point, place in zip(drawing.strokes[0].points, [(-0.3, -1, -0.1), (0, -1.05, -0.15), (0.3, -1, -0.1)]):
        point.position = place
    guides.objects.link(bpy.data.objects.new("Pencil", pencil))
bpy.context.view_layer.update()
assert bpy.ops.impasto.read_guides() == {"FINISHED"}
found = session.module("scene_file").document(scene_file)
region = next(row for row in found["regions"] if row["on"] == {"Object": "Suzanne"})
assert region["strokes"] == {"coverage": 3.5}, "its settings stay"
count = len(region["guides"])
assert count >= 2, count
# The points lie on the surface, in the object's own space: here that is the world, Y up.
graph = bpy.context.evaluated_depsgraph_get()
for guide in region["guides"]:
    for point in guide["points"]:
        x, y, z = point["at"]
        ok, near, _normal, _face = monkey.evaluated_get(graph).closest_point_on_mesh(Vector((x, -z, y)))
        assert ok and (near - Vector((x, -z, y))).length < 1e-4, point
assert bpy.ops.impasto.read_guides() == {"FINISHED"}
assert session.module("scene_file").document(scene_file) == found, "read again, they stand in their own place"

# What was combed in the window stays when curves are read again, and so do settings.
index = found["regions"].index(region)
combed = "(points: [(at: (0.0, 0.0, 0.9), normal: (0.0, 0.0, 1.0)), (at: (0.2, 0.0, 0.9), normal: (0.0, 0.0, 1.0))], radius: 0.5)"
view = "view: (eye: (0.0, 0.5, 6.0), target: (0.0, 0.5, 5.0))"
session.impasto("set", str(scene_file), f"regions[{index}].guides+=({view}, {combed[1:]}")
guides.objects.unlink(bpy.data.objects["Stroke"])
assert bpy.ops.impasto.read_guides() == {"FINISHED"}
after = session.module("scene_file").document(scene_file)["regions"][index]
assert after["strokes"] == {"coverage": 3.5}
assert len(after["guides"]) == count, "one curve less, one combed guide more"
assert [0.0, 0.0, 0.9] in [point["at"] for guide in after["guides"] for point in guide["points"]]
session.impasto("check", str(scene_file))
assert not session.render()
session.report(f"{count} curves of all kinds are guides on the surface; read again, they replace themselves and nothing else")

# On an object that bends, a curve that is read at a later frame is carried to the shape of the first frame; a curve
# that is far from all objects is left out.
scene = session.fresh(last=14)
session.turning_monkey(scene)
monkey = bpy.data.objects["Suzanne"]
monkey.animation_data_clear()
monkey.rotation_euler = (0, 0, 0)
bend = monkey.modifiers.new("Bend", "SIMPLE_DEFORM")
bend.deform_method, bend.deform_axis, bend.angle = "BEND", "Z", 0.0
bend.keyframe_insert("angle", frame=1)
bend.angle = 1.2
bend.keyframe_insert("angle", frame=14)
folder = session.save()
assert bpy.ops.impasto.export() == {"FINISHED"}
scene_file = folder / "film_impasto" / "film.ron"
assert "Suzanne" in session.module("scene_file").sidecar(folder / "film_impasto" / "shot.impasto.json")["caches"]
guides = bpy.data.collections.new("Impasto guides")
scene.collection.children.link(guides)
scene.frame_set(14)
bent = monkey.evaluated_get(bpy.context.evaluated_depsgraph_get())
faces = sorted((face for face in bent.data.polygons if face.normal.y < -0.8), key=lambda face: face.center.x)[:3]
numbers, places = [face.index for face in faces], [face.center.copy() for face in faces]
curve("POLY", [tuple(at) for at in places])
curve("POLY", [(40.0, 0.0, 0.0), (40.0, 0.1, 0.0)])
assert bpy.ops.impasto.read_guides() == {"FINISHED"}
assert scene.frame_current == 14
scene.frame_set(1)
rest = monkey.evaluated_get(bpy.context.evaluated_depsgraph_get())
[region] = [row for row in session.module("scene_file").document(scene_file)["regions"] if row["on"] == {"Object": "Suzanne"}]
[guide] = region["guides"]
for point, number, at in zip(guide["points"], numbers, places, strict=True):
    x, y, z = point["at"]
    wanted = rest.data.polygons[number].center
    assert (wanted - Vector((x, -z, y))).length < 0.005, (point, wanted)
    assert (wanted - at).length > 0.05, "the frame that was shown is not the first one"
session.impasto("check", str(scene_file))
session.report("a curve on a thing that bends is carried to the shape of the first frame; a far one is left out")
