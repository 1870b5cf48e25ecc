"""Curves drawn in Blender as guides of the painting: those in the collection "Impasto guides", each on the surface nearest to it."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector

from . import painting, scene_file
from .failure import Failure

COLLECTION = "Impasto guides"
# Strokes follow a guide this far to its sides, over its length, where the curve does not say it by its radius.
_RADIUS_OF_LENGTH = 0.25
# A curve is taken with at most so many points.
_MOST_POINTS = 64

_Y_UP = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))


@dataclass
class Guide:
    """A curve on a surface, in world space (Z up)."""

    target: str
    points: list[Vector]
    normals: list[Vector]
    radius: float


def _lines(thing: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> list[list[Vector]]:
    """The curves of an object as points in world space: Bezier, NURBS and poly curves, hair curves, grease pencil."""
    evaluated = thing.evaluated_get(depsgraph)
    world = evaluated.matrix_world
    if thing.type == "CURVE":
        return _of_splines(evaluated, world)
    if thing.type == "CURVES":
        data = evaluated.data
        places = np.empty(len(data.points) * 3, dtype=np.float32)
        data.points.foreach_get("position", places)
        return [
            [world @ Vector(places[3 * at : 3 * at + 3]) for at in range(c.first_point_index, c.first_point_index + c.points_length)]
            for c in data.curves
        ]
    if thing.type == "GREASEPENCIL":
        return [
            [world @ point.position for point in stroke.points]
            for layer in evaluated.data.layers
            if not layer.hide and layer.current_frame() is not None
            for stroke in layer.current_frame().drawing.strokes
        ]
    if thing.type == "GPENCIL":
        return [
            [world @ point.co for point in stroke.points]
            for layer in evaluated.data.layers
            if not layer.hide and layer.active_frame is not None
            for stroke in layer.active_frame.strokes
        ]
    return []


def _of_splines(evaluated: bpy.types.Object, world: Matrix) -> list[list[Vector]]:
    """A curve as its mesh without thickness has it: the edges one after the other."""
    mesh = evaluated.to_mesh()
    try:
        following = {}
        for edge in mesh.edges:
            a, b = edge.vertices
            following[min(a, b)] = max(a, b)
        lines: list[list[Vector]] = []
        for vertex in mesh.vertices:
            at = world @ vertex.co
            if lines and following.get(vertex.index - 1) == vertex.index:
                lines[-1].append(at)
            else:
                lines.append([at])
        return [line for line in lines if len(line) > 1]
    finally:
        evaluated.to_mesh_clear()


def _thinned(line: list[Vector]) -> list[Vector]:
    if len(line) <= _MOST_POINTS:
        return line
    return [line[round(index * (len(line) - 1) / (_MOST_POINTS - 1))] for index in range(_MOST_POINTS)]


def _on_surface(line: list[Vector], meshes: list[bpy.types.Object]) -> Guide | None:
    """The curve on the object that is nearest to it all along; None where there is none."""
    best: tuple[float, Guide] | None = None
    for thing in meshes:
        world = thing.matrix_world
        if abs(world.determinant()) < 1e-12:
            continue
        local, normal_matrix = world.inverted(), world.to_3x3().inverted().transposed()
        points, normals, away = [], [], 0.0
        for at in line:
            found, place, normal, _face = thing.closest_point_on_mesh(local @ at)
            if not found:
                break
            points.append(world @ place)
            normals.append((normal_matrix @ normal).normalized())
            away += (points[-1] - at).length
        length = sum((b - a).length for a, b in zip(points, points[1:]))
        if len(points) == len(line) and length > 0 and (best is None or away < best[0]):
            best = (away, Guide(thing.name, points, normals, _RADIUS_OF_LENGTH * length))
    return best[1] if best else None


def _object_from_world(thing: bpy.types.Object, is_cached: bool) -> Matrix:
    """From the world (Y up) into the object's own space in the scene file: its place and turn taken out, its size kept."""
    if is_cached:
        return Matrix.Identity(4)
    location, turn, _size = thing.matrix_world.decompose()
    placed = Matrix.Translation(location) @ turn.to_matrix().to_4x4()
    return (_Y_UP @ placed @ _Y_UP.inverted()).inverted()


def _vector(values: Vector) -> str:
    return "(" + ", ".join(f"{value:.6g}" for value in values) + ")"


def _text_of(guide: Guide, own_from_world: Matrix, view: str) -> str:
    turn = own_from_world.to_3x3()
    points = ", ".join(
        f"(at: {_vector(own_from_world @ (_Y_UP @ at))}, normal: {_vector((turn @ (_Y_UP.to_3x3() @ normal)).normalized())})"
        for at, normal in zip(guide.points, guide.normals)
    )
    return f"(curve: true, view: {view}, points: [{points}], radius: {guide.radius:.4g})"


def _view(scene: bpy.types.Scene) -> str:
    """The view of the active camera, in this frame."""
    world = _Y_UP @ scene.camera.matrix_world
    eye, ahead = world.translation, -world.col[2].to_3d().normalized()
    return f"(eye: {_vector(eye)}, target: {_vector(eye + ahead)}, frame: {scene.frame_current})"


def read(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> dict[str, int]:
    """Writes the curves of the collection into the scene file, one region for each object. Returns how many lie on each.

    Raises Failure."""
    source = bpy.data.collections.get(COLLECTION)
    if source is None or not source.all_objects:
        raise Failure(f'There are no curves: draw them on surfaces, in a collection "{COLLECTION}".')
    place = painting.of_scene(scene)
    if not place.scene_file.is_file() or scene.camera is None:
        raise Failure("There is no scene file yet: press Export for Impasto.")
    own = set(source.all_objects)
    meshes = [
        thing.evaluated_get(depsgraph)
        for thing in scene.objects
        if thing.type == "MESH" and not thing.hide_render and thing not in own
    ]
    of_object: dict[str, list[Guide]] = {}
    for thing in source.all_objects:
        for line in _lines(thing, depsgraph):
            guide = _on_surface(_thinned(line), meshes)
            if guide is not None:
                of_object.setdefault(guide.target, []).append(guide)
    if not of_object:
        raise Failure(f'No curve in "{COLLECTION}" lies on a mesh that is rendered.')
    cached = set(scene_file.sidecar(place.sidecar).get("caches", {}))
    found = scene_file.document(place.scene_file)
    values = []
    for name, guides in of_object.items():
        own_from_world = _object_from_world(scene.objects[name], name in cached)
        listed = ", ".join(_text_of(guide, own_from_world, _view(scene)) for guide in guides)
        region = f"guides of {name}"
        known = [row.get("name") for row in found.get("regions", [])]
        if region in known:
            values.append(f"regions[{known.index(region)}].guides=[{listed}]")
        else:
            named = f"name: {scene_file.text(region)}, on: Object({scene_file.text(name)})"
            values.append(f"regions+=({named}, guides: [{listed}])")
    # Regions whose curves are gone keep what else they state.
    for index, row in enumerate(found.get("regions", [])):
        gone = str(row.get("name", "")).removeprefix("guides of ")
        if gone != row.get("name") and gone not in of_object and row.get("guides"):
            values.append(f"regions[{index}].guides=")
    scene_file.write(place.scene_file, values)
    return {name: len(guides) for name, guides in of_object.items()}


class IMPASTO_OT_read_guides(bpy.types.Operator):
    """Take the curves in the collection "Impasto guides" as directions of strokes"""

    bl_idname = "impasto.read_guides"
    bl_label = "Read Guides from Curves"

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            counts = read(context.scene, context.evaluated_depsgraph_get())
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        words = ", ".join(f"{count} on {name}" for name, count in counts.items())
        self.report({"INFO"}, f"Guides: {words}")
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(IMPASTO_OT_read_guides)


def unregister() -> None:
    bpy.utils.unregister_class(IMPASTO_OT_read_guides)
