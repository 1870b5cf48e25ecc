# What the export writes (materials, groups, light, warnings), the checksum of a scene's inputs, and what is refused.
import json
import struct
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
EXTENSION = str(HERE.parents[2] / "blender" / "impasto")
sys.path[:0] = [str(HERE), EXTENSION]

import export  # noqa: E402
import scenes  # noqa: E402
from rich_scene import rich  # noqa: E402

OUT = Path(tempfile.mkdtemp(prefix="impasto_test_"))


def walk_to(frame: int) -> bpy.types.Depsgraph:
    """Goes to a frame."""
    bpy.context.scene.frame_set(frame)
    return bpy.context.evaluated_depsgraph_get()


def shot(name: str, stop: Callable[[], bool] = lambda: False) -> export.ExportReport:
    """Exports the scene into OUT/NAME."""
    scene = bpy.context.scene
    return export.export_shot(walk_to, scene, OUT / name, frames=(scene.frame_start, scene.frame_end),
                              report=lambda share: None, stop=stop)


def document(name: str) -> dict:
    """The JSON of an export."""
    content = (OUT / name / "shot.glb").read_bytes()
    length = struct.unpack("<I", content[12:16])[0]
    return json.loads(content[20:20 + length])


def sum_now() -> str:
    """The checksum of all that an export of the scene depends on."""
    scene = bpy.context.scene
    return export.sum_of_inputs(scene, bpy.context.view_layer, (scene.frame_start, scene.frame_end))


def twins() -> None:
    """Keys on values that Blender has under two names, such as `angle` and `factor` of a bend."""
    scenes.walk()
    thing = next(thing for thing in bpy.data.objects if thing.type == "MESH")
    bend = thing.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method = "BEND"
    bevel = thing.modifiers.new("Bevel", "BEVEL")
    # It would add points.
    bevel.show_render = bevel.show_viewport = False
    track = thing.constraints.new("COPY_SCALE")
    for frame, value in ((1, 0.1), (9, 0.6)):
        for owner, name in ((bend, "angle"), (bevel, "width"), (track, "mute")):
            setattr(owner, name, value > 0.5 if name == "mute" else value)
            owner.keyframe_insert(name, frame=frame)


def sums_stay() -> None:
    """The sum does not depend on the frame, the process, saving or rendering."""
    makers = {"walk": scenes.walk, "cuts": scenes.cuts, "instances": scenes.instances, "rich": lambda: rich(str(OUT)), "twins": twins}
    for name, make in makers.items():
        make()
        first = sum_now()
        for frame in (5, 20, 1):
            walk_to(frame)
            assert sum_now() == first, f"{name}: another sum at frame {frame}"
        path = str(OUT / f"{name}.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        assert sum_now() == first, f"{name}: another sum after saving"
        bpy.ops.wm.open_mainfile(filepath=path)
        assert sum_now() == first, f"{name}: another sum after loading"
        code = f"import sys, bpy; sys.path.insert(0, {EXTENSION!r}); import export\n" \
               f"bpy.ops.wm.open_mainfile(filepath={path!r}); scene = bpy.context.scene; scene.frame_set(7); " \
               "print('sum', export.sum_of_inputs(scene, bpy.context.view_layer, (scene.frame_start, scene.frame_end)))"
        told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        assert f"sum {first}" in told, f"{name}: another sum in a fresh process"
        shot(name)
        assert sum_now() == first, f"{name}: another sum after an export"


def sums_change() -> None:
    """Every change that shows changes the sum."""
    rich(str(OUT))
    objects, scene = bpy.data.objects, bpy.context.scene
    scenes.scattered(objects["MonkeyI1"])
    drawn = objects["MonkeyI0"].driver_add("location", 2).driver
    drawn.expression = "frame / 10"
    modifier = objects["Scatter"].modifiers[0]
    size = next(key for key in modifier.keys() if key.startswith("Socket_") and not key.endswith(("_use_attribute", "_name")))
    material = bpy.data.materials["Tex"].node_tree.nodes["Principled BSDF"]

    def set_size() -> None:
        modifier[size] = 2.0

    def edit_key() -> None:
        curve = next(curve for _, curve in export.inputs_sum.add_action.__globals__["curves_of"](
            objects["Cam"].animation_data.action))
        curve.keyframe_points[0].co.y += 1.0

    changes: dict[str, Callable[[], object]] = {
        "an object moved": lambda: setattr(objects["MonkeyI2"], "location", (1, 2, 3)),
        "a point moved": lambda: setattr(objects["Monkey"].data.vertices[5], "co", (1, 2, 3)),
        "a key changed": edit_key,
        "a shape changed": lambda: setattr(objects["Ball"].data.shape_keys.key_blocks[1].data[3], "co", (1, 2, 3)),
        "a roughness changed": lambda: setattr(material.inputs["Roughness"], "default_value", 0.123),
        "a picture unlinked": lambda: bpy.data.materials["Tex"].node_tree.links.remove(material.inputs["Base Color"].links[0]),
        "a modifier changed": lambda: setattr(objects["Cube"].modifiers[0], "render_levels", 3),
        "an object hidden": lambda: setattr(objects["MonkeyI3"], "hide_render", True),
        "a driver changed": lambda: setattr(drawn, "expression", "frame / 11"),
        "an input of nodes changed": set_size,
        "a weight changed": lambda: objects["Arm"].vertex_groups[0].add([0], 0.5, "REPLACE"),
        "a marker moved": lambda: setattr(scene.timeline_markers["B"], "frame", 13),
        "a collection hidden": lambda: setattr(bpy.data.collections["Set"], "hide_render", True),
        "a layer excluded": lambda: setattr(bpy.context.view_layer.layer_collection.children["Set"], "exclude", True),
        "a bevel changed": lambda: setattr(bpy.data.curves[0], "bevel_depth", 0.2),
        "a light changed": lambda: setattr(objects["Area"].data, "energy", 5.0),
        "a clip changed": lambda: setattr(objects["Cam"].data, "clip_end", 55.0),
        "the rate changed": lambda: setattr(scene.render, "fps", 25),
        "the exposure changed": lambda: setattr(scene.view_settings, "exposure", 1.0),
    }
    (OUT / "checker.png").touch()
    known = {sum_now()}
    for name, change in changes.items():
        change()
        bpy.context.view_layer.update()
        now = sum_now()
        assert now not in known, f"the same sum although {name}"
        known.add(now)
    rich(str(OUT))
    before = sum_now()
    with open(OUT / "checker.png", "ab") as file:
        file.write(b"more")
    assert sum_now() != before, "the same sum although a picture's file changed"


def errors() -> None:
    """A mesh that gains points is refused by name; an export that is stopped leaves no file."""
    scenes.fresh(1, 4)
    thing = scenes.added("Growing", "primitive_cube_add")
    modifier = thing.modifiers.new("Array", "ARRAY")
    scenes.keyed(modifier, "count", [(1, 1), (4, 4)])
    try:
        shot("growing")
        raise AssertionError("a mesh that grows was taken")
    except export.ExportError as error:
        assert '"Growing" has 8 points in frame 1 and ' in str(error), error
    assert not list((OUT / "growing").rglob("*.part")) and not (OUT / "growing" / "shot.glb").exists()
    scenes.cloth()
    looks = iter(range(10_000))
    try:
        shot("stopped", stop=lambda: next(looks) > 20)
        raise AssertionError("it was not stopped")
    except export.Stopped:
        pass
    assert not [path for path in (OUT / "stopped").rglob("*") if path.is_file()]


def materials() -> None:
    """What materials become."""
    scenes.fresh(1, 1)
    image = bpy.data.images.new("made", 8, 8)
    image.generated_color = (0.2, 0.4, 0.6, 1.0)

    def worn(name: str) -> bpy.types.NodeTree:
        thing = scenes.added(name, "primitive_plane_add")
        made = scenes.painted(name, (0.5, 0.25, 0.125))
        thing.data.materials.append(made)
        return made.node_tree

    worn("Plain")
    tree = worn("Pictured")
    picture, place, times = (tree.nodes.new(kind) for kind in ("ShaderNodeTexImage", "ShaderNodeMapping", "ShaderNodeMix"))
    picture.image, picture.extension = image, "EXTEND"
    place.inputs["Scale"].default_value = (3.0, 2.0, 1.0)
    times.data_type, times.blend_type = "RGBA", "MULTIPLY"
    times.inputs[0].default_value, times.inputs[7].default_value = 1.0, (0.5, 1.0, 1.0, 1.0)
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["UV"], place.inputs["Vector"])
    tree.links.new(place.outputs[0], picture.inputs["Vector"])
    tree.links.new(picture.outputs[0], times.inputs[6])
    tree.links.new(times.outputs[2], tree.nodes["Principled BSDF"].inputs["Base Color"])
    tree.links.new(picture.outputs["Alpha"], tree.nodes["Principled BSDF"].inputs["Alpha"])
    tree = worn("Glowing")
    glow = tree.nodes.new("ShaderNodeEmission")
    glow.inputs["Color"].default_value = (0.1, 0.2, 0.3, 1.0)
    tree.links.new(glow.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    tree = worn("Noisy")
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    tree = worn("Dyed")
    bpy.data.objects["Dyed"].data.color_attributes.new("Dye", "BYTE_COLOR", "CORNER")
    dye = tree.nodes.new("ShaderNodeVertexColor")
    dye.layer_name = "Dye"
    tree.links.new(dye.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])
    told = shot("materials")
    root = document("materials")
    made = {material["name"]: material for material in root["materials"]}
    assert [round(part, 4) for part in made["Plain"]["pbrMetallicRoughness"]["baseColorFactor"]] == [0.5, 0.25, 0.125, 1.0]
    pictured = made["Pictured"]["pbrMetallicRoughness"]
    assert pictured["baseColorFactor"][:3] == [0.5, 1.0, 1.0] and made["Pictured"]["alphaMode"] == "MASK"
    transform = pictured["baseColorTexture"]["extensions"]["KHR_texture_transform"]
    assert transform == {"offset": [0.0, -1.0], "rotation": 0.0, "scale": [3.0, 2.0]}, transform
    assert root["samplers"] == [{"wrapS": 33071, "wrapT": 33071}] and len(root["images"]) == 1
    assert "KHR_materials_unlit" in made["Glowing"]["extensions"]
    colored = [mesh for mesh in root["meshes"] if "COLOR_0" in mesh["primitives"][0]["attributes"]]
    assert len(colored) == 1
    assert any('"Noisy"' in warning for warning in told.warnings) and len(told.warnings) == 1, told.warnings


class ExportEngine(bpy.types.RenderEngine):
    """Exports instead of rendering, as the extension does."""

    bl_idname = "IMPASTO_EXPORT_CHECK"
    bl_label = "Export check"
    told: list[object] = []

    def render(self, graph: bpy.types.Depsgraph) -> None:
        """Exports the shot."""
        scene = graph.scene.original

        def walk(frame: int) -> bpy.types.Depsgraph:
            self.frame_set(frame, 0.0)
            return graph

        try:
            told = export.export_shot(walk, scene, OUT / "engine", frames=(scene.frame_start, scene.frame_end),
                                      report=self.update_progress, stop=self.test_break)
            self.told.append(told)
        except BaseException as error:
            self.told.append(error)


def in_an_engine() -> None:
    """An export during a render writes what one outside writes, and leaves the checksum of the inputs as it was."""
    bpy.utils.register_class(ExportEngine)
    for make in (scenes.cuts, scenes.walk, scenes.cloth, lambda: rich(str(OUT))):
        make()
        cubes = [thing for thing in bpy.data.objects if thing.name == "Cube"]
        before = sum_now()
        shot("plain")
        bpy.context.scene.render.engine = ExportEngine.bl_idname
        ExportEngine.told.clear()
        bpy.ops.render.render()
        told = ExportEngine.told[0]
        assert isinstance(told, export.ExportReport), told
        assert sum_now() == before, "another sum after a render"
        names = [{node["name"] for node in document(name)["nodes"]} for name in ("plain", "engine")]
        assert names[0] == names[1], names
        sides = [json.loads((OUT / name / "shot.impasto.json").read_text()) for name in ("plain", "engine")]
        assert sides[0] == sides[1], sides
        if not cubes:
            for cache in sides[0]["caches"].values():
                first, second = ((OUT / name / cache).read_bytes() for name in ("plain", "engine"))
                assert first == second, f"{cache} differs in a render"
    # Blender 4.5 hangs on exit while an engine is still registered.
    bpy.utils.unregister_class(ExportEngine)


def groups() -> None:
    """Vertex groups that are no bones become groups of faces, also behind a subdivision."""
    scenes.walk()
    shot("groups")
    mesh = next(mesh for mesh in document("groups")["meshes"] if "extras" in mesh)
    assert mesh["extras"]["groupNames"] == ["Shirt"] and "_GROUP" in mesh["primitives"][0]["attributes"], mesh


def world() -> None:
    """The world's colour, or the mean of its picture, is carried as light."""
    scenes.walk()
    scene = bpy.context.scene
    told = lambda name: json.loads((OUT / name / "shot.impasto.json").read_text()).get("world")  # noqa: E731
    scene.world = None
    shot("dark")
    assert told("dark") == [0.0, 0.0, 0.0]
    made = scene.world = bpy.data.worlds.new("Sky")
    if bpy.app.version < (5, 0, 0):
        made.use_nodes = True
    tree = made.node_tree
    back = next(node for node in tree.nodes if node.type == "BACKGROUND")
    back.inputs["Color"].default_value = (0.1, 0.2, 0.4, 1.0)
    back.inputs["Strength"].default_value = 2.0
    shot("sky")
    assert all(abs(a - b) < 1e-6 for a, b in zip(told("sky"), (0.2, 0.4, 0.8), strict=True)), told("sky")
    # A picture that is orange in its upper half, which is half of all directions, and black below.
    picture = bpy.data.images.new("Half", 32, 16, float_buffer=True)
    picture.pixels.foreach_set([0.0, 0.0, 0.0, 1.0] * 256 + [1.0, 0.5, 0.25, 1.0] * 256)
    around = tree.nodes.new("ShaderNodeTexEnvironment")
    around.image = picture
    tree.links.new(around.outputs["Color"], back.inputs["Color"])
    shot("picture")
    assert all(abs(a - b) < 1e-5 for a, b in zip(told("picture"), (1.0, 0.5, 0.25), strict=True)), told("picture")
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], back.inputs["Color"])
    warnings = shot("nodes").warnings
    assert told("nodes") is None and any('world "Sky"' in words for words in warnings), warnings


def blur() -> None:
    """Depth of field and motion blur are warned of, and only where they are on."""
    scenes.walk()
    assert not shot("sharp").warnings
    scene = bpy.context.scene
    scene.camera.data.dof.use_dof = True
    scene.render.use_motion_blur = True
    told = shot("blurred").warnings
    assert [words for words in told if "depth of field" in words or "Motion blur" in words] == told and len(told) == 2, told


for check in (materials, groups, world, blur, errors, sums_change, sums_stay, in_an_engine):
    check()
    print(f"  {check.__doc__}")
