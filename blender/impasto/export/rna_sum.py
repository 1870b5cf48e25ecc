"""Checksums of what is set in Blender's data, read through its RNA."""

import hashlib
from typing import Any

import bpy
import numpy as np

# Properties that change nothing in a picture, or that evaluation changes.
_SKIPPED = {
    "rna_type", "name_full", "matrix_world", "matrix_local", "matrix_basis", "matrix", "dimensions", "hide", "hide_viewport",
    "hide_select", "tag", "use_fake_user", "use_extra_user", "preview", "asset_data", "library", "original", "users",
    "animation_data", "point_cache", "location_absolute", "width", "height", "width_hidden", "warning_propagation",
    "is_valid", "strip_time", "active", "execution_time", "id_data", "mode", "type_info", "bound_box", "override_library",
    "library_weak_reference", "session_uid", "is_embedded_data", "object_paths", "override_properties", "cycles",
    "frame_current", "frame_subframe", "frame_float", "is_active_output_ui", "interface_items", "cache_directory",
    "grease_pencil", "pose_library", "select", "ui_tab", "panels", "viewer_path", "internal_links", "parent_node", "node",
    "display", "lineart", "animation_visualization", "motion_path", "light_linking", "bone", "bone_group",
}
_SKIPPED_STARTS = ("uv_layer_", "select", "active_", "bl_", "lock_", "texspace_", "cache_frame_", "has_", "show_", "preview_", "view_center",
                   "is_expanded", "paint_")
_KEPT = {"show_render", "show_instancer_for_render", "show_unborn", "show_dead"}
# Collections that `geometry_sum` and `action_sum` add in their own way, or that change nothing in a picture.
_SKIPPED_COLLECTIONS = {
    "vertices", "edges", "loops", "polygons", "loop_triangles", "loop_triangle_polygons", "corner_normals", "vertex_normals",
    "polygon_normals", "attributes", "color_attributes", "uv_layers", "vertex_colors", "skin_vertices", "vertex_layers_float",
    "vertex_layers_int", "vertex_layers_string", "polygon_layers_float", "polygon_layers_int", "polygon_layers_string",
    "uv_layer_clone", "uv_layer_stencil", "uv", "points", "bezier_points", "bones", "edit_bones", "collections", "collections_all",
    "layers", "fcurves", "slots", "groups", "pose_markers", "particles", "child_particles", "targets_runtime", "data",
    "texture_slots", "key_blocks_runtime", "reports", "curves", "curve_offset_data", "normals", "position_data",
}
_SCALARS = {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"}
# How nodes look in the node editor. For other types, properties of these names do matter.
_SKIPPED_OF_NODES = {"location", "color", "use_custom_color", "label", "parent", "dimensions"}
# Follow from other properties, so that they would change from frame to frame where those are animated.
_DERIVED = {bpy.types.Camera: ("angle", "angle_x", "angle_y")}
# Two names of the same value: where one is animated, so is the other.
_TWINS = {
    name: twin
    for pair in (("angle", "factor"), ("width", "width_pct"), ("mute", "enabled"), ("mix_mode", "use_offset"),
                 ("time_tweak", "timestep"), ("normal_factor", "hair_length"), ("material", "material_slot"))
    for name, twin in (pair, pair[::-1])
}
_MEANT_CURVES = (bpy.types.CurveMapping, bpy.types.CurveMap)
_MEANT_SIZES = (bpy.types.Modifier, bpy.types.Constraint, bpy.types.TextBox)

_properties_of_type: dict[type, list[tuple[str, str, bool]]] = {}


def array_bytes(collection: Any, name: str, width: int, dtype: type) -> bytes:
    """The bytes of one property of all items of a collection."""
    values = np.empty(len(collection) * width, dtype=dtype)
    if len(values):
        collection.foreach_get(name, values)
    return values.tobytes()


class Sum:
    """The sum of one data-block, which notes what other data-blocks it uses."""

    def __init__(self, animated: dict[str, set[int]]) -> None:
        self._hash = hashlib.blake2b(digest_size=16)
        self._animated = animated
        self._met: set[tuple[str, int]] = set()
        self.used: list[bpy.types.ID] = []

    def add(self, *values: object) -> None:
        """Adds plain values."""
        self._hash.update(repr(values).encode())

    def add_bytes(self, content: bytes) -> None:
        """Adds bytes."""
        self._hash.update(len(content).to_bytes(8, "little") + content)

    def use(self, block: bpy.types.ID | None) -> None:
        """Adds a data-block by name; it is summed up by itself."""
        if block is None:
            self.add(None)
        else:
            self.add(type(block).__name__, block.name_full)
            self.used.append(block)

    def digest(self) -> str:
        """The sum so far."""
        return self._hash.hexdigest()

    def struct(self, struct: Any, depth: int = 0) -> None:
        """Adds all that is set in a struct and in what it holds."""
        path = self._path(struct)
        values: list[object] = [type(struct).__name__]
        for name, kind, is_array in _properties(type(struct), struct.bl_rna):
            if kind in _SCALARS:
                values.append(self._scalar(struct, name, is_array, path))
        self.add(*values)
        self.custom_properties(struct, path)
        if depth > 8:
            return
        for name, kind, _ in _properties(type(struct), struct.bl_rna):
            if kind == "POINTER":
                self._pointer(getattr(struct, name), name, depth)
            elif kind == "COLLECTION":
                for item in getattr(struct, name):
                    self._pointer(item, name, depth)

    def custom_properties(self, struct: Any, path: str) -> None:
        """Adds custom properties, as the inputs of geometry nodes are."""
        try:
            names = sorted(struct.keys())
        except (AttributeError, TypeError):
            return
        for name in names:
            if name.startswith(("_RNA_UI", "cycles")) or f'{path}["{name}"]'.lstrip(".") in self._animated:
                continue
            value = struct[name]
            if isinstance(value, bpy.types.ID):
                self.use(value)
            else:
                # A .blend stores the boolean inputs of geometry nodes as integers.
                value = int(value) if isinstance(value, bool) else value
                plain = value.to_list() if hasattr(value, "to_list") else value
                self.add(name, plain.to_dict() if hasattr(plain, "to_dict") else plain)

    def _path(self, struct: Any) -> str:
        if not self._animated or isinstance(struct, bpy.types.ID):
            return ""
        try:
            return str(struct.path_from_id())
        except (ValueError, AttributeError):
            return ""

    def _scalar(self, struct: Any, name: str, is_array: bool, path: str) -> object:
        value = getattr(struct, name)
        names = (name, _TWINS[name]) if name in _TWINS else (name,)
        keyed = (self._animated.get(f"{path}.{name_}" if path else name_) for name_ in names)
        indices = next((indices for indices in keyed if indices is not None), None)
        if indices is not None:
            if not is_array:
                return name
            return name, [part for order, part in enumerate(_flat(value)) if order not in indices]
        if is_array:
            return name, _flat(value)
        return (name, sorted(value)) if isinstance(value, set) else (name, value)

    def _pointer(self, value: Any, name: str, depth: int) -> None:
        if value is None:
            return
        if isinstance(value, bpy.types.ID) and not value.is_embedded_data:
            self.add(name)
            self.use(value)
        elif isinstance(value, bpy.types.NodeLink):
            self.add(value.from_node.name, value.from_socket.identifier, value.to_node.name, value.to_socket.identifier,
                     value.is_muted)
        elif isinstance(value, bpy.types.bpy_struct):
            self.add(name)
            # Structs lead back to each other, as bones to their parents.
            key = (type(value).__name__, value.as_pointer())
            if key not in self._met:
                self._met.add(key)
                self.struct(value, depth + 1)


def _flat(value: Any) -> list[Any]:
    result: list[Any] = []
    for part in value:
        if hasattr(part, "__len__") and not isinstance(part, str):
            result += _flat(part)
        else:
            result.append(part)
    return result


def _properties(kind: type, rna: Any) -> list[tuple[str, str, bool]]:
    """The properties of a type that count: name, type, whether an array."""
    if kind in _properties_of_type:
        return _properties_of_type[kind]
    is_node = issubclass(kind, bpy.types.Node)
    result = []
    for prop in rna.properties:
        name = prop.identifier
        means_size = name in ("width", "height") and issubclass(kind, _MEANT_SIZES)
        if (name in _SKIPPED or name.startswith(_SKIPPED_STARTS)) and name not in _KEPT and not means_size:
            continue
        if prop.type == "COLLECTION" and name in _SKIPPED_COLLECTIONS and not issubclass(kind, _MEANT_CURVES):
            continue
        if is_node and name in _SKIPPED_OF_NODES or name in _DERIVED.get(kind, ()):
            continue
        if prop.type in _SCALARS and prop.is_readonly:
            continue
        result.append((name, prop.type, bool(getattr(prop, "is_array", False))))
    _properties_of_type[kind] = result
    return result
