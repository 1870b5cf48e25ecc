"""The world as light: one colour from all around."""

from __future__ import annotations

import bpy
import numpy as np


def light_of(world: bpy.types.World | None, warnings: list[str]) -> list[float] | None:
    """The mean radiance of the world, linear red, green and blue in W/m²/sr; None where it cannot be told, with a warning."""
    if world is None:
        return [0.0, 0.0, 0.0]
    tree = world.node_tree
    if tree is None or not getattr(world, "use_nodes", True):
        return [float(part) for part in world.color]
    background = _background(tree)
    if background is not None and not background.inputs["Strength"].is_linked:
        color = _color(background.inputs["Color"])
        if color is not None:
            return [float(part) * float(background.inputs["Strength"].default_value) for part in color]
    warnings.append(f'The world "{world.name}" lights by nodes that are not carried: a soft grey light stands for it.')
    return None


def _background(tree: bpy.types.NodeTree) -> bpy.types.Node | None:
    """The Background node that reaches the output."""
    for node in tree.nodes:
        if node.type == "OUTPUT_WORLD" and node.is_active_output and node.inputs["Surface"].links:
            source = node.inputs["Surface"].links[0].from_node
            return source if source.type == "BACKGROUND" else None
    return None


def _color(socket: bpy.types.NodeSocket) -> list[float] | None:
    if not socket.is_linked:
        return list(socket.default_value)[:3]
    source = socket.links[0].from_node
    return _mean(source.image) if source.type == "TEX_ENVIRONMENT" and source.image is not None else None


def _mean(image: bpy.types.Image) -> list[float] | None:
    """The mean of a picture of all directions: rows near the poles count less."""
    width, height = image.size
    channels = image.channels
    if width == 0 or height == 0 or channels < 3 or len(image.pixels) != width * height * channels:
        return None
    flat = np.empty(width * height * channels, dtype=np.float32)
    image.pixels.foreach_get(flat)
    values = flat.reshape(height, width, channels)[:, :, :3]
    if not image.is_float:
        values = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
    weights = np.sin((np.arange(height) + 0.5) / height * np.pi)
    mean = (values.mean(axis=1, dtype=np.float64) * weights[:, None]).sum(axis=0) / weights.sum()
    return [float(part) for part in mean]
