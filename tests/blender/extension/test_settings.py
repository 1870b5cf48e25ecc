# Panels write one field of the scene file, curves become guides, and the scene file is made once.
import bpy
import session
from mathutils import Vector

session.start()
scene = session.fresh(last=3)
monkey = session.turning_monkey(scene)
group = bpy.data.collections.new("Toys")
scene.collection.children.link(group)
group.objects.link(monkey)
folder = session.save()
assert bpy.ops.impasto.export() == {"FINISHED"}
scene_file = folder / "film_impasto" / "film.ron"
text = scene_file.read_text()
commented = text.replace("    shot:", "    // mine\n    shot:")
scene_file.write_text(commented)

scene.impasto.strokes.scale = 1.5
assert scene_file.read_text() == commented.replace("scale: 0.7", "scale: 1.5"), scene_file.read_text()
assert abs(scene.impasto.strokes.scale - 1.5) < 1e-6
scene.impasto.strokes.preset = "gouache"
monkey.impasto.coverage = 3.5
group.impasto.boil = 0.25
material = monkey.data.materials[0]
material.impasto.contour = 0.5
written = scene_file.read_text()
assert "// mine" in written
for wanted in (
    'preset: "gouache"',
    '(name: "Suzanne", on: Object("Suzanne"), strokes: (coverage: 3.5))',
    '(name: "Toys", on: Collection("Toys"), strokes: (boil: 0.25))',
    '(name: "Red", on: EachMaterial("Red"), strokes: (contour: 0.5))',
):
    assert wanted in written, f"{wanted} is not in {written}"
assert (monkey.impasto.coverage, group.impasto.boil, material.impasto.contour) == (3.5, 0.25, 0.5)
monkey.impasto.coverage = 4.0
assert scene_file.read_text().count("Object(") == 1
# Out of range: refused with the program's words, and the file is as it was.
before = scene_file.read_text()
session.module("settings").state(scene, "preset", "") 
assert "preset" not in scene_file.read_text()
try:
    session.module("settings").state(scene, "scale", "1e9")
    raise AssertionError("1e9 was taken")
except session.module("failure").Failure as failure:
    assert "scale" in str(failure), failure
session.impasto("check", str(scene_file))
assert not session.render()
session.report("fields of scene, object, collection and material are written one by one; comments stay")

# Curves as guides.
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
region = next(row for row in found["regions"] if row["name"] == "guides of Suzanne")
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
assert scene_file.read_text().count("guides of Suzanne") == 1
session.impasto("check", str(scene_file))
assert not session.render()
session.report(f"{count} curves of all kinds are guides on the surface; read again, they replace themselves")

# An export leaves the scene file alone, and does nothing where nothing has changed.
text, shot = scene_file.read_text(), (folder / "film_impasto" / "shot.glb")
stamp = shot.stat().st_mtime_ns
assert bpy.ops.impasto.export() == {"FINISHED"}
assert shot.stat().st_mtime_ns == stamp and scene_file.read_text() == text
monkey.location.z += 0.5
monkey.keyframe_insert("location", frame=1)
assert bpy.ops.impasto.export() == {"FINISHED"}
assert shot.stat().st_mtime_ns != stamp and scene_file.read_text() == text
session.report("the scene file is made once; an unchanged shot is not exported again")
