"""How an Image Texture node lays its picture: coordinates, transform, what is beyond the border."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import bpy

_WRAPS = {"REPEAT": 10497, "MIRROR": 33648, "EXTEND": 33071, "CLIP": 33071}


@dataclass
class PictureUse:
    """A picture on a surface."""

    image: bpy.types.Image
    # The name of an UV map; empty for the one that is active for rendering.
    uv_map: str = ""
    # KHR_texture_transform, where there is one.
    transform: dict[str, Any] | None = None
    wrap: int = 10497
    is_nearest: bool = False
    lost: list[str] = field(default_factory=list)


def picture_use(node: bpy.types.Node, entered: tuple[bpy.types.Node, ...],
                source_of: Callable[..., Any]) -> PictureUse | None:
    """How the node lays its picture; `None` where it has none."""
    if node.image is None:
        return None
    use = PictureUse(node.image, wrap=_WRAPS.get(node.extension, 10497), is_nearest=node.interpolation == "Closest")
    if node.image.source in ("SEQUENCE", "MOVIE"):
        use.lost.append("the motion of its picture")
    if node.image.source == "TILED":
        use.lost.append("all but one of its UDIM tiles")
    if node.projection != "FLAT":
        use.lost.append(f"the {node.projection.title()} projection of its picture")
    source = source_of(node.inputs["Vector"], entered)
    if source is not None and source.node.type == "MAPPING":
        use.transform = _transform(source.node, use.lost)
        source = source_of(source.node.inputs["Vector"], source.entered)
        if source is None:
            use.lost.append("the coordinates of its picture: its Mapping node has none")
    if source is None:
        return use
    if source.node.type == "UVMAP":
        use.uv_map = source.node.uv_map
    elif source.node.type == "ATTRIBUTE":
        use.uv_map = source.node.attribute_name
    elif not (source.node.type == "TEX_COORD" and source.output.name == "UV"):
        told = source.output.name if source.node.type == "TEX_COORD" else source.node.bl_label
        use.lost.append(f"the coordinates {told!r} of its picture")
    return use


def _transform(node: bpy.types.Node, lost: list[str]) -> dict[str, Any] | None:
    """The transform of a Mapping node, for coordinates whose V points down."""
    inputs = [node.inputs.get(name) for name in ("Location", "Rotation", "Scale")]
    if any(socket is not None and socket.is_linked for socket in inputs):
        lost.append("the linked values of a Mapping node")
    location, rotation, scale = ((0.0,) * 3 if socket is None else tuple(socket.default_value) for socket in inputs)
    if abs(rotation[0]) + abs(rotation[1]) > 1e-6:
        lost.append("the tilt of a Mapping node")
    turn, (scale_u, scale_v) = rotation[2], scale[:2]
    shift_u, shift_v = location[:2]
    if node.vector_type == "TEXTURE":
        if abs(turn) > 1e-6 and abs(scale_u - scale_v) > 1e-6:
            lost.append("the slant of a Mapping node")
        scale_u, scale_v, turn = 1.0 / (scale_u or 1.0), 1.0 / (scale_v or 1.0), -turn
        sin, cos = math.sin(turn), math.cos(turn)
        shift_u, shift_v = (-(cos * shift_u - sin * shift_v) * scale_u, -(sin * shift_u + cos * shift_v) * scale_v)
    elif node.vector_type in ("VECTOR", "NORMAL"):
        shift_u, shift_v = 0.0, 0.0
    if max(abs(shift_u), abs(shift_v), abs(turn), abs(scale_u - 1.0), abs(scale_v - 1.0)) < 1e-9:
        return None
    sin, cos = math.sin(turn), math.cos(turn)
    # With V turned over: u' = c su u + s sv v + (x - s sv), v' = -s su u + c sv v + (1 - y - c sv).
    return {"offset": [shift_u - sin * scale_v, 1.0 - shift_v - cos * scale_v], "rotation": turn,
            "scale": [scale_u, scale_v]}
