"""A checksum of all that an export depends on, so that an unchanged shot is not exported again."""

import hashlib
import os
from typing import Any

import bpy
import numpy as np

from . import geometry_sum
from .action_sum import add_action, add_animation, animated_paths
from .rna_sum import Sum

# Raise it when what is exported changes, so that old exports count as stale.
EXPORT_VERSION = 3
_RENDER = ("fps", "fps_base", "resolution_x", "resolution_y", "resolution_percentage", "pixel_aspect_x", "pixel_aspect_y",
           "frame_map_old", "frame_map_new", "use_motion_blur", "use_simplify", "simplify_subdivision_render", "simplify_child_particles_render")
# What the checksum of some types has beside their plain properties (of actions: instead of them).
_PARTS: dict[type, Any] = {
    bpy.types.Mesh: geometry_sum.add_mesh, bpy.types.Key: geometry_sum.add_shape_keys,
    bpy.types.Curve: geometry_sum.add_curve, bpy.types.Lattice: geometry_sum.add_lattice,
    bpy.types.Armature: geometry_sum.add_armature, bpy.types.Action: add_action,
}
_NOT_SUMMED = (bpy.types.Scene, bpy.types.Library, bpy.types.Brush, bpy.types.WindowManager, bpy.types.Screen,
               bpy.types.WorkSpace)


def sum_of_inputs(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, frames: tuple[int, int]) -> str:
    """The checksum of the original (not evaluated) data that a shot is made of, whatever the current frame."""
    scene = scene.original if scene.is_evaluated else scene
    whole = Sum({})
    whole.add(EXPORT_VERSION, bpy.app.version, tuple(frames), view_layer.name)
    _add_scene(whole, scene)
    _add_layers(whole, view_layer.layer_collection)
    weighted = {thing.data.name_full for thing in bpy.data.objects if thing.type == "MESH" and len(thing.vertex_groups) > 0}
    waiting: list[bpy.types.ID] = [*scene.collection.all_objects, *whole.used]
    sums: dict[tuple[str, str], str] = {}
    while waiting:
        block = waiting.pop()
        key = (type(block).__name__, block.name_full)
        if key in sums or isinstance(block, _NOT_SUMMED):
            continue
        total = _sum_of_block(block, weighted)
        sums[key] = total.digest()
        waiting += total.used
    result = hashlib.blake2b(whole.digest().encode(), digest_size=16)
    for key in sorted(sums):
        result.update(repr((key, sums[key])).encode())
    return result.hexdigest()


def _sum_of_block(block: bpy.types.ID, weighted: set[str]) -> Sum:
    total = Sum(animated_paths(block))
    if isinstance(block, bpy.types.Image):
        _add_image(total, block)
        return total
    if isinstance(block, bpy.types.Collection):
        _add_collection(total, block)
        return total
    add_animation(total, block)
    for kind, add in _PARTS.items():
        if isinstance(block, kind):
            add(total, block)
    if isinstance(block, bpy.types.Mesh) and block.name_full in weighted:
        geometry_sum.add_weights(total, block)
    if isinstance(block, (bpy.types.Sound, bpy.types.CacheFile, bpy.types.VectorFont, bpy.types.Volume)):
        total.add(_file_state(block))
    if not isinstance(block, bpy.types.Action):
        _add_plain(total, block)
    return total


def _add_plain(total: Sum, block: bpy.types.ID) -> None:
    """Adds what is set in a data-block and in the structs that it holds."""
    if hasattr(block, "attributes") and not isinstance(block, bpy.types.Mesh):
        geometry_sum.add_attributes(total, block)
    total.struct(block)
    tree = block if isinstance(block, bpy.types.NodeTree) else getattr(block, "node_tree", None)
    if tree is not None and tree is not block:
        # A material's own tree has its own animation.
        inner = Sum(animated_paths(tree))
        add_animation(inner, tree)
        inner.struct(tree)
        total.add(inner.digest())
        total.used += inner.used


def _add_scene(total: Sum, scene: bpy.types.Scene) -> None:
    """Adds what counts of the scene itself. Animated render settings and custom properties count by their curves."""
    animated = animated_paths(scene)
    for name in _RENDER:
        if f"render.{name}" not in animated:
            total.add(name, getattr(scene.render, name))
    total.add(scene.view_settings.exposure, scene.use_gravity, list(scene.gravity), scene.unit_settings.scale_length)
    total.custom_properties(scene, "")
    total.use(None if scene.camera is None or _cuts(scene) else scene.camera)
    for marker in sorted(scene.timeline_markers, key=lambda marker: (marker.frame, marker.name)):
        if marker.camera is not None:
            total.add(marker.frame)
            total.use(marker.camera)
    total.use(scene.world)
    _add_collection(total, scene.collection)
    add_animation(total, scene)
    if scene.rigidbody_world is not None:
        total.struct(scene.rigidbody_world)
    for library in sorted(bpy.data.libraries, key=lambda library: library.filepath):
        total.add(_file_state(library))


def _cuts(scene: bpy.types.Scene) -> bool:
    """Whether markers choose the camera: Blender then sets `scene.camera` anew as frames go by."""
    return any(marker.camera is not None for marker in scene.timeline_markers)


def _add_collection(total: Sum, collection: bpy.types.Collection) -> None:
    hide_render = "animated" if "hide_render" in animated_paths(collection) else collection.hide_render
    total.add(collection.name, hide_render, list(collection.instance_offset))
    for name, members in (("objects", collection.objects), ("children", collection.children)):
        total.add(name)
        for member in sorted(members, key=lambda member: member.name_full):
            total.use(member)


def _add_layers(total: Sum, layer: bpy.types.LayerCollection) -> None:
    total.add(layer.name, layer.exclude, layer.holdout, layer.indirect_only)
    for child in layer.children:
        _add_layers(total, child)


def _add_image(total: Sum, image: bpy.types.Image) -> None:
    total.add(image.source, image.colorspace_settings.name, image.alpha_mode)
    if image.packed_file is not None:
        total.add(image.packed_file.size)
        total.add_bytes(bytes(image.packed_file.data))
    elif image.source == "GENERATED":
        total.add(image.generated_type, list(image.generated_color), image.generated_width, image.generated_height)
    else:
        total.add(_file_state(image))
    if image.is_dirty and image.has_data:
        pixels = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(pixels)
        total.add_bytes(pixels.tobytes())


def _file_state(block: Any) -> tuple[object, ...]:
    """Where a file is, its size and when it was changed."""
    path = bpy.path.abspath(block.filepath, library=block.library)
    try:
        state = os.stat(path)
    except OSError:
        return (os.path.normpath(path), None)
    return (os.path.normpath(path), state.st_size, state.st_mtime_ns)
