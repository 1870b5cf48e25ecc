"""Vertex groups as groups of faces."""

import bpy
import numpy as np

# A face belongs to the group with the largest mean weight of its corners, if that is more than this.
LEAST_WEIGHT = 0.5


def names_of(thing: bpy.types.Object) -> list[str]:
    """The vertex groups of an object that are no bones of its armatures, in their order."""
    bones: set[str] = set()
    for modifier in thing.modifiers:
        if modifier.type == "ARMATURE" and modifier.object is not None:
            bones.update(bone.name for bone in modifier.object.data.bones)
    return [group.name for group in thing.vertex_groups if group.name not in bones]


def group_of_faces(thing: bpy.types.Object, mesh: bpy.types.Mesh, names: list[str]) -> np.ndarray | None:
    """For each face the number of its group in `names` from 1 on, 0 for none; `None` where no face is in any."""
    number = {thing.vertex_groups[name].index: order for order, name in enumerate(names)}
    entries = [(vertex.index, number[entry.group], entry.weight)
               for vertex in mesh.vertices for entry in vertex.groups if entry.group in number]
    if not entries:
        return None
    point, group, weight = (np.array(column) for column in zip(*entries))
    point_of_corner = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", point_of_corner)
    start = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_start", start)
    count = np.diff(start, append=len(point_of_corner))
    best, chosen = np.full(len(start), LEAST_WEIGHT), np.zeros(len(start), dtype=np.int32)
    for order in range(len(names)):
        weights = np.zeros(len(mesh.vertices))
        weights[point[group == order]] = weight[group == order]
        mean = np.add.reduceat(weights[point_of_corner], start) / count
        chosen = np.where(mean > best, order + 1, chosen)
        best = np.maximum(mean, best)
    return chosen if chosen.any() else None
