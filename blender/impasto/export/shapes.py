"""Reads evaluated meshes into arrays as glTF has them, in the object's own space, still Z up."""

from dataclasses import dataclass, field

import bpy
import numpy as np

from . import groups
from .corners import joined
from .materials import MaterialTable, Surface


@dataclass
class Part:
    """What wears one material."""

    material: int
    points: np.ndarray
    normals: np.ndarray
    uvs: np.ndarray | None
    colors: np.ndarray | None
    groups: np.ndarray | None
    triangles: np.ndarray
    # For each vertex, its row in the shape's `places`.
    row_of_vertex: np.ndarray


@dataclass
class Shape:
    """A mesh as it was when it was first seen."""

    parts: list[Part]
    group_names: list[str]
    # The places of the points that faces use, and the numbers of these points in the mesh (`None`: all are used).
    places: np.ndarray
    used_points: np.ndarray | None
    # What may not change.
    points: int
    faces: int
    point_of_corner: np.ndarray
    first_frame: int
    json_by_kind: dict[str, int] = field(default_factory=dict)


def place_of_points(mesh: bpy.types.Mesh) -> np.ndarray:
    """The places of all points."""
    flat = np.empty(len(mesh.vertices) * 3, dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.reshape(-1, 3)


def points_of_corners(mesh: bpy.types.Mesh) -> np.ndarray:
    """The point number of every corner."""
    result = np.empty(len(mesh.loops), dtype=np.int32)
    corners = mesh.attributes.get(".corner_vert")
    if corners is not None:
        corners.data.foreach_get("value", result)
    else:
        mesh.loops.foreach_get("vertex_index", result)
    return result


def read_shape(thing: bpy.types.Object, mesh: bpy.types.Mesh, table: MaterialTable, frame: int) -> Shape | None:
    """The shape of a mesh; `None` where it has no faces."""
    mesh.calc_loop_triangles()
    triangles = len(mesh.loop_triangles)
    if triangles == 0:
        return None
    corners = np.empty(triangles * 3, dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    corners = corners.reshape(-1, 3)
    face_of_triangle = np.empty(triangles, dtype=np.int32)
    mesh.loop_triangles.foreach_get("polygon_index", face_of_triangle)
    point_of_corner = points_of_corners(mesh)
    places = place_of_points(mesh)
    is_used = np.zeros(len(places), dtype=bool)
    is_used[point_of_corner] = True
    used, row_of_point = None, np.arange(len(places), dtype=np.int32)
    if not is_used.all():
        used = np.flatnonzero(is_used)
        row_of_point[used] = np.arange(len(used), dtype=np.int32)
    names = groups.names_of(thing)
    face_groups = groups.group_of_faces(thing, mesh, names) if names else None
    reader = _Reader(mesh, point_of_corner, row_of_point, places, face_groups, face_of_triangle)
    parts = [reader.part(surface, corners[chosen], chosen)
             for surface, chosen in _by_material(thing, mesh, face_of_triangle, table)]
    return Shape(parts, names if face_groups is not None else [], places if used is None else places[used], used,
                 len(places), len(mesh.polygons), point_of_corner, frame)


def _by_material(thing: bpy.types.Object, mesh: bpy.types.Mesh, face_of_triangle: np.ndarray,
                 table: MaterialTable) -> list[tuple[Surface, np.ndarray]]:
    """Materials, and the triangles that wear each."""
    surfaces = [table.surface(material) for material in materials_of(thing, mesh)] or [table.surface(None)]
    if len(surfaces) == 1:
        return [(surfaces[0], np.arange(len(face_of_triangle)))]
    slots = np.zeros(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("material_index", slots)
    slots = np.clip(slots, 0, len(surfaces) - 1)[face_of_triangle]
    result: dict[int, tuple[Surface, np.ndarray]] = {}
    for slot in np.unique(slots):
        surface, chosen = surfaces[slot], np.flatnonzero(slots == slot)
        if surface.index in result:
            chosen = np.sort(np.concatenate([result[surface.index][1], chosen]))
        result[surface.index] = (surface, chosen)
    return list(result.values())


def materials_of(thing: bpy.types.Object, mesh: bpy.types.Mesh) -> list[bpy.types.Material | None]:
    """The material of each slot, be it the object's own or the mesh's."""
    slots, of_mesh = thing.material_slots, mesh.materials
    result = []
    for order in range(max(len(slots), len(of_mesh))):
        is_own = order < len(slots) and (slots[order].link == "OBJECT" or order >= len(of_mesh))
        result.append(slots[order].material if is_own else of_mesh[order])
    return result


class _Reader:
    """Reads the parts of one mesh."""

    def __init__(self, mesh: bpy.types.Mesh, point_of_corner: np.ndarray, row_of_point: np.ndarray,
                 places: np.ndarray, face_groups: np.ndarray | None, face_of_triangle: np.ndarray) -> None:
        self._mesh, self._places = mesh, places
        self._point_of_corner, self._row_of_point = point_of_corner, row_of_point
        normals = np.empty(len(point_of_corner) * 3, dtype=np.float32)
        mesh.corner_normals.foreach_get("vector", normals)
        self._normals = normals.reshape(-1, 3)
        self._group_of_corner: np.ndarray | None = None
        if face_groups is not None:
            totals = np.empty(len(mesh.polygons), dtype=np.int32)
            mesh.polygons.foreach_get("loop_total", totals)
            self._group_of_corner = np.repeat(face_groups, totals)

    def part(self, surface: Surface, corners: np.ndarray, chosen: np.ndarray) -> Part:
        """The part of some triangles, of which each is a row of `corners`."""
        is_seen = np.zeros(len(self._point_of_corner), dtype=bool)
        is_seen[corners.ravel()] = True
        seen = np.flatnonzero(is_seen)
        place_in_seen = np.empty(len(is_seen), dtype=np.int64)
        place_in_seen[seen] = np.arange(len(seen))
        point, normals = self._point_of_corner[seen], self._normals[seen]
        uvs = self._uvs(surface, seen)
        colors = self._colors(surface, seen)
        group = None if self._group_of_corner is None else self._group_of_corner[seen]
        columns = list(normals.T)
        columns += [] if uvs is None else list(uvs.T)
        columns += [] if colors is None else list(colors.T)
        columns += [] if group is None else [group]
        first, vertex = joined(point, columns)
        point = point[first]
        return Part(
            surface.index, self._places[point], normals[first], None if uvs is None else uvs[first],
            None if colors is None else colors[first], None if group is None else group[first].astype(np.float32),
            vertex[place_in_seen[corners]].astype(np.uint32), self._row_of_point[point])

    def _uvs(self, surface: Surface, seen: np.ndarray) -> np.ndarray | None:
        layers = self._mesh.uv_layers
        layer = layers.get(surface.uv_map) if surface.uv_map else None
        if layer is None:
            layer = next((layer for layer in layers if layer.active_render), None)
        if layer is None:
            return None
        flat = np.empty(len(self._point_of_corner) * 2, dtype=np.float32)
        layer.uv.foreach_get("vector", flat)
        uvs = flat.reshape(-1, 2)[seen]
        uvs[:, 1] = 1.0 - uvs[:, 1]
        return uvs

    def _colors(self, surface: Surface, seen: np.ndarray) -> np.ndarray | None:
        """Colours (linear) of the corners, where the material shows them."""
        if surface.color_attribute is None:
            return None
        mesh = self._mesh
        name = surface.color_attribute or mesh.attributes.default_color_name
        layer = mesh.attributes.get(name) if name else None
        widths = {"FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4), "FLOAT_VECTOR": ("vector", 3),
                  "FLOAT": ("value", 1)}
        if layer is None or layer.data_type not in widths or layer.domain not in ("POINT", "CORNER", "FACE"):
            return None
        what, width = widths[layer.data_type]
        flat = np.empty(len(layer.data) * width, dtype=np.float32)
        layer.data.foreach_get(what, flat)
        values = np.repeat(flat, 3).reshape(-1, 3) if width == 1 else flat.reshape(-1, width)[:, :3]
        if layer.domain == "POINT":
            values = values[self._point_of_corner[seen]]
        elif layer.domain == "CORNER":
            values = values[seen]
        else:
            totals = np.empty(len(mesh.polygons), dtype=np.int32)
            mesh.polygons.foreach_get("loop_total", totals)
            values = np.repeat(values, totals, axis=0)[seen]
        return np.clip(values, 0.0, 1.0)
