"""Follows a colour through shader nodes to what glTF can say: a factor, a picture, a colour attribute."""

from dataclasses import dataclass, field

import bpy

from .picture_use import PictureUse, picture_use

Rgb = tuple[float, float, float]
WHITE: Rgb = (1.0, 1.0, 1.0)
# Nodes that change the colour of their input "Color".
_CHANGERS = {"HUE_SAT": "Hue/Saturation", "GAMMA": "Gamma", "BRIGHTCONTRAST": "Brightness/Contrast",
             "CURVE_RGB": "RGB Curves", "INVERT": "Invert"}


@dataclass
class Color:
    """A colour: the product of a factor, a picture and a colour attribute."""

    factor: Rgb
    picture: PictureUse | None = None
    # The name of a colour attribute; empty for the one that is active for rendering.
    attribute: str | None = None
    lost: list[str] = field(default_factory=list)

    def is_plain(self) -> bool:
        """Whether it is the same everywhere."""
        return self.picture is None and self.attribute is None

    def times(self, factor: Rgb) -> "Color":
        """The colour multiplied."""
        product = (self.factor[0] * factor[0], self.factor[1] * factor[1], self.factor[2] * factor[2])
        return Color(product, self.picture, self.attribute, self.lost)


class Source:
    """An output that a socket gets its value from, and the node groups that were entered on the way there."""

    def __init__(self, node: bpy.types.Node, output: bpy.types.NodeSocket, entered: tuple[bpy.types.Node, ...]) -> None:
        self.node, self.output, self.entered = node, output, entered


def source_of(socket: bpy.types.NodeSocket, entered: tuple[bpy.types.Node, ...]) -> Source | None:
    """Where the value of a socket comes from, through reroutes, muted nodes and groups; `None` for its own value."""
    for _ in range(1000):
        link = next((link for link in socket.links if not link.is_muted), None) if socket.is_linked else None
        if link is None:
            return None
        node, output = link.from_node, link.from_socket
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            through = next((inner for inner in node.internal_links if inner.to_socket == output), None)
            if through is None:
                return None
            socket = through.from_socket
        elif node.type == "GROUP" and node.node_tree is not None:
            inner_output = next((inner for inner in node.node_tree.nodes
                                 if inner.type == "GROUP_OUTPUT" and inner.is_active_output), None)
            if inner_output is None:
                return None
            socket, entered = _of_identifier(inner_output.inputs, output.identifier), (*entered, node)
        elif node.type == "GROUP_INPUT" and entered:
            socket, entered = _of_identifier(entered[-1].inputs, output.identifier), entered[:-1]
        else:
            return Source(node, output, entered)
        if socket is None:
            return None
    return None


def own_value(socket: bpy.types.NodeSocket, entered: tuple[bpy.types.Node, ...]) -> bpy.types.NodeSocket:
    """The socket whose own value reaches this one through reroutes and out of or into groups."""
    for _ in range(1000):
        link = next((link for link in socket.links if not link.is_muted), None) if socket.is_linked else None
        if link is None:
            return socket
        node, output = link.from_node, link.from_socket
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.type == "GROUP_INPUT" and entered:
            outside = _of_identifier(entered[-1].inputs, output.identifier)
            if outside is None:
                return socket
            socket, entered = outside, entered[:-1]
        elif node.type == "GROUP" and node.node_tree is not None:
            inner_output = next((inner for inner in node.node_tree.nodes
                                 if inner.type == "GROUP_OUTPUT" and inner.is_active_output), None)
            inside = inner_output and _of_identifier(inner_output.inputs, output.identifier)
            if not inside:
                return socket
            socket, entered = inside, (*entered, node)
        else:
            return socket
    return socket


def _of_identifier(sockets: bpy.types.bpy_prop_collection, identifier: str) -> bpy.types.NodeSocket | None:
    return next((socket for socket in sockets if socket.identifier == identifier), None)


def plain_color(socket: bpy.types.NodeSocket) -> Rgb:
    """The socket's own value as a colour."""
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float)):
        return (float(value),) * 3
    return (float(value[0]), float(value[1]), float(value[2]))


def color_of(socket: bpy.types.NodeSocket, entered: tuple[bpy.types.Node, ...] = (), depth: int = 0) -> Color:
    """The colour of a socket, as near as glTF comes to it."""
    source = source_of(socket, entered)
    if source is None:
        return Color(plain_color(own_value(socket, entered)))
    node = source.node
    if depth > 50:
        return Color((0.5, 0.5, 0.5), lost=["a loop of nodes"])
    if node.type == "TEX_IMAGE":
        use = picture_use(node, source.entered, source_of)
        if use is None:
            return Color((0.8, 0.8, 0.8), lost=["an Image Texture without a picture"])
        return Color(WHITE, use, lost=use.lost)
    if node.type == "VERTEX_COLOR":
        return Color(WHITE, attribute=node.layer_name)
    if node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY":
        return Color(WHITE, attribute=node.attribute_name)
    if node.type in ("RGB", "VALUE"):
        return Color(plain_color(node.outputs[0]))
    if node.type in ("MIX", "MIX_RGB"):
        mixed = _mixed(node, source.entered, depth)
        if mixed is not None:
            return mixed
    elif node.type in _CHANGERS:
        changed = color_of(node.inputs["Color"], source.entered, depth + 1)
        if node.type == "GAMMA" and changed.is_plain() and not node.inputs["Gamma"].is_linked:
            power = node.inputs["Gamma"].default_value
            red, green, blue = (max(part, 0.0) ** power for part in changed.factor)
            return Color((red, green, blue), lost=changed.lost)
        changed.lost.append(f"what {_CHANGERS[node.type]} does to its colour")
        return changed
    elif node.type == "VALTORGB" and source_of(node.inputs[0], source.entered) is None:
        at = own_value(node.inputs[0], source.entered).default_value
        return Color(tuple(node.color_ramp.evaluate(at)[:3]))
    return _stand_in(node, source.entered, depth)


def _mixed(node: bpy.types.Node, entered: tuple[bpy.types.Node, ...], depth: int) -> Color | None:
    """The colour of a Mix node, exact where a `Color` can say it, else one side; `None` where it mixes no colours."""
    if node.type == "MIX" and node.data_type != "RGBA":
        return None
    if node.type == "MIX":
        sockets = [_of_identifier(node.inputs, name) for name in ("Factor_Float", "A_Color", "B_Color")]
    else:
        sockets = list(node.inputs[:3])
    first, second = (color_of(socket, entered, depth + 1) for socket in sockets[1:])
    lost = first.lost + second.lost
    if source_of(sockets[0], entered) is not None:
        lost.append("a mix by a mask")
        share = 0.5
    else:
        share = min(max(float(own_value(sockets[0], entered).default_value), 0.0), 1.0)
    if share == 0.0 and node.blend_type in ("MIX", "MULTIPLY"):
        return first
    if node.blend_type == "MULTIPLY":
        if not first.is_plain() and second.is_plain():
            return Color(first.times(_between(WHITE, second.factor, share)).factor, first.picture, first.attribute, lost)
        if share == 1.0 and (first.picture is None or second.picture is None) and (
                first.attribute is None or second.attribute is None):
            product = first.times(second.factor)
            return Color(product.factor, first.picture or second.picture,
                         first.attribute if first.attribute is not None else second.attribute, lost)
    elif node.blend_type == "MIX":
        if share == 1.0:
            return second
        if first.is_plain() and second.is_plain():
            return Color(_between(first.factor, second.factor, share), lost=lost)
    if first.is_plain() and second.is_plain() and node.blend_type == "MULTIPLY":
        product = first.times(second.factor).factor
        return Color(_between(first.factor, product, share), lost=lost)
    kept = first if second.is_plain() or (not first.is_plain() and share <= 0.5) else second
    kept.lost = [*lost, "one side of a Mix"]
    return kept


def _between(first: Rgb, second: Rgb, share: float) -> Rgb:
    red, green, blue = (a + (b - a) * share for a, b in zip(first, second))
    return (red, green, blue)


def _stand_in(node: bpy.types.Node, entered: tuple[bpy.types.Node, ...], depth: int) -> Color:
    """For a node that glTF knows nothing of: the first picture upstream, else a colour attribute, else a mean."""
    lost = [f"the node {node.bl_label!r}" if not node.label else f"the node {node.label!r}"]
    found = [color_of(socket, entered, depth + 1) for socket in node.inputs
             if socket.is_linked and socket.type in ("RGBA", "VALUE", "VECTOR") and node.type not in _MADE_OF_NOTHING]
    kept = next((color for color in found if color.picture is not None), None)
    kept = kept or next((color for color in found if color.attribute is not None), None)
    if kept is not None:
        kept.lost = kept.lost + lost
        return kept
    if node.type == "VALTORGB":
        samples = [node.color_ramp.evaluate((step + 0.5) / 16) for step in range(16)]
        means = [sum(sample[part] for sample in samples) / 16 for part in range(3)]
        return Color((means[0], means[1], means[2]), lost=lost)
    colors = [plain_color(socket) for socket in node.inputs if socket.type == "RGBA" and not socket.is_linked]
    colors += [color.factor for color in found] if node.type in ("MIX", "MIX_RGB") else []
    if not colors:
        return Color((0.5, 0.5, 0.5), lost=lost)
    means = [sum(color[part] for color in colors) / len(colors) for part in range(3)]
    return Color((means[0], means[1], means[2]), lost=lost)


# Textures whose linked inputs are not followed, since they mostly say where and how, not which colour.
_MADE_OF_NOTHING = {"TEX_NOISE", "TEX_VORONOI", "TEX_WAVE", "TEX_MAGIC", "TEX_BRICK", "TEX_CHECKER", "TEX_GRADIENT",
                    "TEX_GABOR", "TEX_WHITE_NOISE", "TEX_MUSGRAVE", "TEX_SKY", "TEX_ENVIRONMENT"}
