# Each change in a panel writes one field of the scene file. An export writes that file only if it is missing.
import bpy
import session

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
# The more specific region stands later, whichever was written first. Taking back a region's last value removes it.
regions = [region["name"] for region in session.module("scene_file").document(scene_file)["regions"]]
assert regions == ["Toys", "Red", "Suzanne"], regions
assert session.module("settings").stands_over(monkey) == "Red"
session.module("settings").state(material, "contour", "")
assert "EachMaterial" not in scene_file.read_text()
assert session.module("settings").stands_over(monkey) == "Toys"
session.module("settings").state(group, "boil", "")
assert "Toys" not in scene_file.read_text() and session.module("settings").stands_over(monkey) == ""
# An empty value takes a field out. A value out of range is refused with the program's words.
before = scene_file.read_text()
session.module("settings").state(scene, "preset", "")
assert "preset" not in scene_file.read_text()
try:
    session.module("settings").state(scene, "scale", "1e9")
    raise AssertionError("1e9 was taken")
except session.module("failure").Failure as failure:
    assert "scale" in str(failure), failure
# A script may set more than a slider does: the nearest value that is allowed is taken.
scene.impasto.strokes.coverage = 50.0
assert scene.impasto.strokes.coverage == 20.0
kept = scene_file.read_text()
try:
    bpy.ops.impasto.take_back(of="SCENE")
    raise AssertionError("everything was taken back")
except RuntimeError as refused:
    assert "Which setting" in str(refused), refused
assert scene_file.read_text() == kept
assert bpy.ops.impasto.take_back(field="coverage", of="SCENE") == {"FINISHED"}
session.impasto("check", str(scene_file))
assert not session.render()
session.report("fields of scene, object, collection and material are written one by one; comments stay")

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

# The region of an object that was renamed fits nothing: `problems` warns of it after each export, even if the shot is
# unchanged.
monkey.impasto.coverage = 4.0
monkey.name = "Renamed"
said = []
problems = session.module("scene_file").problems
for _ in range(2):
    assert bpy.ops.impasto.export() == {"FINISHED"}
    said.append(problems(scene_file))
assert said[0] == said[1] and any("Suzanne" in line and "warning" in line for line in said[0]), said
session.report("a region whose object has another name now is told of")

# Blender's panels that mean the same with any engine are shown with this one too.
for name in (
    "RENDER_PT_output",
    "RENDER_PT_format",
    "RENDER_PT_frame_range",
    "RENDER_PT_color_management",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "DATA_PT_EEVEE_light",
):
    panel = getattr(bpy.types, name)
    assert "IMPASTO" in panel.COMPAT_ENGINES, name
bpy.ops.preferences.addon_disable(module=session.MODULE)
assert "IMPASTO" not in bpy.types.RENDER_PT_output.COMPAT_ENGINES
session.report("output, format, colours, materials and lamps have their panels")
