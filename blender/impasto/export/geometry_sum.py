"""Checksums of geometry: the arrays of meshes, curves, lattices, armatures and shape keys."""

from typing import Any

import bpy

from .rna_sum import Sum, array_bytes

_ATTRIBUTES = {
    "FLOAT": ("value", 1, "f4"), "INT": ("value", 1, "i4"), "BOOLEAN": ("value", 1, "?"), "INT8": ("value", 1, "i4"),
    "FLOAT_VECTOR": ("vector", 3, "f4"), "FLOAT2": ("vector", 2, "f4"), "FLOAT_COLOR": ("color", 4, "f4"),
    "BYTE_COLOR": ("color", 4, "f4"), "QUATERNION": ("value", 4, "f4"), "FLOAT4X4": ("value", 16, "f4"),
    "INT32_2D": ("value", 2, "i4"), "INT16_2D": ("value", 2, "i4"),
}
# What is selected, hidden or pinned while editing.
_EDITING = (".select", ".hide", ".vs.", ".es.", ".pn.", ".uv_select", ".sculpt")
_ROWS_OF_SPLINES = {"bezier_points": (("co", 3), ("handle_left", 3), ("handle_right", 3), ("radius", 1), ("tilt", 1)),
                    "points": (("co", 4), ("radius", 1), ("tilt", 1))}


def add_attributes(total: Sum, data: Any) -> None:
    """Adds the attributes of a mesh, curves or points."""
    for attribute in data.attributes:
        if attribute.name.startswith(_EDITING) or attribute.data_type not in _ATTRIBUTES:
            continue
        name, width, dtype = _ATTRIBUTES[attribute.data_type]
        total.add(attribute.name, attribute.domain)
        total.add_bytes(array_bytes(attribute.data, name, width, dtype))


def add_mesh(total: Sum, mesh: bpy.types.Mesh) -> None:
    """Adds a mesh."""
    add_attributes(total, mesh)
    total.add_bytes(array_bytes(mesh.polygons, "loop_start", 1, "i4"))
    total.add([(layer.name, layer.active_render) for layer in mesh.uv_layers], mesh.attributes.default_color_name,
              mesh.has_custom_normals)
    if mesh.has_custom_normals:
        total.add_bytes(array_bytes(mesh.corner_normals, "vector", 3, "f4"))
    for material in mesh.materials:
        total.use(material)
    total.use(mesh.shape_keys)


def add_weights(total: Sum, mesh: bpy.types.Mesh) -> None:
    """Adds the weights of vertex groups."""
    weights = [(vertex.index, entry.group, entry.weight) for vertex in mesh.vertices for entry in vertex.groups]
    total.add_bytes(repr(weights).encode())


def add_shape_keys(total: Sum, keys: bpy.types.Key) -> None:
    """Adds the shapes of shape keys; their values are among the plain properties."""
    for block in keys.key_blocks:
        total.add(block.name, block.relative_key.name if block.relative_key else "")
        points = block.points if hasattr(block, "points") and len(block.points) else block.data
        if len(points):
            total.add_bytes(array_bytes(points, "co", 3, "f4"))


def add_curve(total: Sum, curve: bpy.types.Curve) -> None:
    """Adds the points of a curve's splines."""
    for spline in curve.splines:
        for name, rows in _ROWS_OF_SPLINES.items():
            for row, width in rows:
                total.add_bytes(array_bytes(getattr(spline, name), row, width, "f4"))


def add_lattice(total: Sum, lattice: bpy.types.Lattice) -> None:
    """Adds the points of a lattice."""
    total.add_bytes(array_bytes(lattice.points, "co_deform", 3, "f4"))


def add_armature(total: Sum, armature: bpy.types.Armature) -> None:
    """Adds the bones of an armature at rest."""
    for bone in armature.bones:
        total.add(bone.name, bone.parent.name if bone.parent else "", [list(row) for row in bone.matrix_local], bone.length,
                  bone.use_deform, bone.use_inherit_rotation, bone.inherit_scale, bone.use_local_location,
                  bone.head_radius, bone.tail_radius, bone.envelope_distance, bone.envelope_weight, bone.bbone_segments)
