"""Curves drawn in Blender as guides of the painting: those in the collection "Impasto guides", each on the surface nearest to it."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix, Vector
from mathutils.interpolate import poly_3d_calc

from . import painting, scene_file
from .failure import Failure

COLLECTION = "Impasto guides"
# How far to its sides strokes follow a guide, as a share of its length.
_RADIUS_OF_LENGTH = 0.25
# A curve is on no surface if its points lie farther off, on average, than this share of its length.
_FARTHEST_OF_LENGTH = 0.5
# The file beside the scene file that notes which guides were read from curves. Only these are replaced when curves are
# read again; guides that were combed in Impasto's window stay.
_READ_NAME = "guides_of_blender.json"
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
    # Of each point, the face that it lies on.
    faces: list[int] = field(default_factory=list)


@dataclass
class Found:
    """What was read: how many guides lie on each object, and how many curves on none."""

    counts: dict[str, int]
    far: int


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
    """The splines of a curve object, read from the edges of its mesh; the curve must have no thickness."""
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
        points, normals, faces, away = [], [], [], 0.0
        for at in line:
            found, place, normal, face = thing.closest_point_on_mesh(local @ at)
            if not found:
                break
            points.append(world @ place)
            normals.append((normal_matrix @ normal).normalized())
            faces.append(face)
            away += (points[-1] - at).length
        length = sum((b - a).length for a, b in zip(points, points[1:]))
        if len(points) == len(line) and length > 0 and (best is None or away < best[0]):
            best = (away, Guide(thing.name, points, normals, _RADIUS_OF_LENGTH * length, faces))
    whole = sum((b - a).length for a, b in zip(line, line[1:]))
    is_near = best is not None and best[0] / len(line) <= _FARTHEST_OF_LENGTH * whole
    return best[1] if best is not None and is_near else None


def _at_rest(scene: bpy.types.Scene, guides: list[Guide]) -> None:
    """Carries guides on things that bend to the shape that strokes are laid on: that of the first frame."""
    shares: list[list[tuple[list[int], list[float]]]] = []
    graph = bpy.context.evaluated_depsgraph_get()
    for guide in guides:
        thing = scene.objects[guide.target].evaluated_get(graph)
        local = thing.matrix_world.inverted()
        of_guide = []
        for at, face in zip(guide.points, guide.faces):
            corners = list(thing.data.polygons[face].vertices)
            places = [thing.data.vertices[corner].co for corner in corners]
            of_guide.append((corners, list(poly_3d_calc(places, local @ at))))
        shares.append(of_guide)
    frame = scene.frame_current
    scene.frame_set(scene.frame_start)
    try:
        graph = bpy.context.evaluated_depsgraph_get()
        for guide, of_guide in zip(guides, shares):
            thing = scene.objects[guide.target].evaluated_get(graph)
            world = thing.matrix_world
            turn = world.to_3x3().inverted().transposed()
            before, length = guide.points, 0.0
            guide.points, guide.normals = [], []
            for (corners, parts), face in zip(of_guide, guide.faces):
                places = [thing.data.vertices[corner].co * part for corner, part in zip(corners, parts)]
                guide.points.append(world @ sum(places, Vector()))
                guide.normals.append((turn @ thing.data.polygons[face].normal).normalized())
            length = sum((b - a).length for a, b in zip(guide.points, guide.points[1:]))
            was = sum((b - a).length for a, b in zip(before, before[1:]))
            guide.radius *= length / was if was > 0 else 1.0
    finally:
        scene.frame_set(frame)


def _object_from_world(thing: bpy.types.Object, is_cached: bool) -> Matrix:
    """From the world (Y up) into the object's own space in the scene file: its place and turn taken out, its size kept.
    With a point cache that space is the world."""
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


def read(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> Found:
    """Writes the curves of the collection into the scene file, into the region of each object, beside what else it has.

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
    lines = [line for thing in source.all_objects for line in _lines(thing, depsgraph)]
    guides = [_on_surface(_thinned(line), meshes) for line in lines]
    near = [guide for guide in guides if guide is not None]
    if not near:
        raise Failure(f'No curve in "{COLLECTION}" lies on a mesh that is rendered, or near one.')
    view = _view(scene)
    cached = set(scene_file.sidecar(place.sidecar).get("caches", {}))
    _at_rest(scene, [guide for guide in near if guide.target in cached])
    texts: dict[str, list[str]] = {}
    for guide in near:
        own_from_world = _object_from_world(scene.objects[guide.target], guide.target in cached)
        texts.setdefault(guide.target, []).append(_text_of(guide, own_from_world, view))
    _write(place.scene_file, texts)
    return Found({name: len(of_object) for name, of_object in texts.items()}, len(guides) - len(near))


def _write(scene_path: Path, texts: dict[str, list[str]]) -> None:
    """Puts guides into the regions of their objects, in place of those that were read before."""
    known_path = scene_path.with_name(_READ_NAME)
    known: dict[str, list[Any]] = scene_file.sidecar(known_path)
    for name in sorted({*known, *texts}):
        on = {"Object": name}
        found = scene_file.document(scene_path)
        index = scene_file.region_of(found, on)
        guides = texts.get(name, [])
        if index is None:
            if guides:
                says = f"guides: [\n            {f','.join(_lines_of(guides))},\n        ]"
                scene_file.write(scene_path, [scene_file.new_region(found, on, says)])
            continue
        there = found["regions"][index].get("guides", [])
        old = [at for at, guide in enumerate(there) if guide in known.get(name, [])]
        values = [f"regions[{index}].guides[{at}]=" for at in reversed(old)]
        values += [f"regions[{index}].guides+={guide}" for guide in guides]
        if values:
            scene_file.write(scene_path, values)
    # Noted as the program gives them back, so that the next call recognizes them.
    found = scene_file.document(scene_path)
    read_now = {}
    for name, guides in texts.items():
        index = scene_file.region_of(found, {"Object": name})
        if index is not None:
            read_now[name] = found["regions"][index].get("guides", [])[-len(guides) :]
    known_path.write_text(json.dumps(read_now), encoding="utf-8")


def _lines_of(guides: list[str]) -> list[str]:
    """Each guide on a line of its own."""
    return [guide if at == 0 else f"\n            {guide}" for at, guide in enumerate(guides)]


class IMPASTO_OT_read_guides(bpy.types.Operator):
    """Take the curves in the collection "Impasto guides" as directions of strokes"""

    bl_idname = "impasto.read_guides"
    bl_label = "Read Guides from Curves"

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            found = read(context.scene, context.evaluated_depsgraph_get())
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        words = ", ".join(f"{count} on {name}" for name, count in found.counts.items())
        if found.far:
            self.report({"WARNING"}, f"Curves that are far from every surface are left out: {found.far}")
        self.report({"INFO"}, f"Guides: {words}")
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(IMPASTO_OT_read_guides)


def unregister() -> None:
    bpy.utils.unregister_class(IMPASTO_OT_read_guides)
