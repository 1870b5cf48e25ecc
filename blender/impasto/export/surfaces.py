"""What a material looks like: the shader that reaches its output, in glTF's terms."""

from dataclasses import dataclass, field

import bpy

from .shader_colors import Color, color_of, own_value, source_of

Entered = tuple[bpy.types.Node, ...]


@dataclass
class Look:
    """A material in glTF's terms."""

    base: Color = field(default_factory=lambda: Color((0.8, 0.8, 0.8)))
    alpha: float = 1.0
    # Whether the picture of the base colour has holes.
    has_picture_alpha: bool = False
    metallic: float = 0.0
    roughness: float = 0.5
    emission: Color = field(default_factory=lambda: Color((0.0, 0.0, 0.0)))
    emission_strength: float = 1.0
    is_unlit: bool = False
    lost: list[str] = field(default_factory=list)


def look_of(material: bpy.types.Material) -> Look:
    """The look of a material."""
    tree = material.node_tree if material.use_nodes else None
    if tree is None:
        red, green, blue, alpha = material.diffuse_color
        return Look(Color((red, green, blue)), alpha, metallic=material.metallic, roughness=material.roughness)
    look = Look()
    if _is_animated(material) or _is_animated(tree):
        look.lost.append("the motion of its values (the first frame's are used)")
    output = tree.get_output_node("ALL") or tree.get_output_node("CYCLES") or tree.get_output_node("EEVEE")
    if output is None or not output.inputs["Surface"].is_linked:
        look.base = Color((0.0, 0.0, 0.0))
        return look
    _read_shader(output.inputs["Surface"], (), look)
    return look


def _is_animated(thing: bpy.types.ID) -> bool:
    animation = thing.animation_data
    return animation is not None and (animation.action is not None or len(animation.drivers) > 0)


def _read_shader(socket: bpy.types.NodeSocket, entered: Entered, look: Look) -> bool:
    """Reads the shader that feeds a socket into `look`; whether there was one with a colour."""
    source = source_of(socket, entered)
    if source is None:
        return False
    node, entered = source.node, source.entered
    if node.type == "BSDF_PRINCIPLED":
        _read_principled(node, entered, look)
        return True
    if node.type in ("EMISSION", "BACKGROUND"):
        strength = _number(node, "Strength", entered, look)
        look.base = color_of(node.inputs["Color"], entered).times((strength,) * 3)
        look.is_unlit = True
        return True
    if node.type == "MIX_SHADER":
        return _read_mix(node, entered, look)
    if node.type == "ADD_SHADER":
        look.lost.append("one side of an Add Shader")
        return _read_shader(node.inputs[0], entered, look) or _read_shader(node.inputs[1], entered, look)
    if node.type == "BSDF_TRANSPARENT":
        look.alpha = 0.0
        return False
    if node.type == "HOLDOUT" or "Color" not in node.inputs:
        inner = [socket for socket in node.inputs if socket.type == "SHADER" and socket.is_linked]
        if inner:
            look.lost.append(f"the node {node.bl_label!r}")
        return any(_read_shader(socket, entered, look) for socket in inner)
    look.base = color_of(node.inputs["Color"], entered)
    look.metallic = 1.0 if node.type in ("BSDF_GLOSSY", "BSDF_METALLIC") else 0.0
    look.roughness = 1.0
    if node.type != "BSDF_DIFFUSE" and "Roughness" in node.inputs:
        look.roughness = min(max(_number(node, "Roughness", entered, look), 0.0), 1.0)
    if node.type not in ("BSDF_DIFFUSE", "BSDF_GLOSSY", "BSDF_METALLIC"):
        look.lost.append(f"all of its {node.bl_label} but the colour")
    return True


def _read_mix(node: bpy.types.Node, entered: Entered, look: Look) -> bool:
    """A mix with Transparent is a surface with holes; of any other the stronger side is read."""
    sides = [source_of(socket, entered) for socket in node.inputs[1:3]]
    is_clear = [side is not None and side.node.type == "BSDF_TRANSPARENT" for side in sides]
    if is_clear[0] != is_clear[1]:
        solid = 1 if is_clear[0] else 0
        found = _read_shader(node.inputs[1 + solid], entered, look)
        of_side, look.alpha = look.alpha, 1.0
        _read_alpha(node.inputs[0], entered, look, is_turned=solid == 0)
        look.alpha *= of_side
        return found
    share = 0.5
    if source_of(node.inputs[0], entered) is None:
        share = float(own_value(node.inputs[0], entered).default_value)
    sockets = list(node.inputs[1:3]) if share <= 0.5 else [node.inputs[2], node.inputs[1]]
    if 0.0 < share < 1.0:
        look.lost.append("one side of a Mix Shader")
    return _read_shader(sockets[0], entered, look) or _read_shader(sockets[1], entered, look)


def _read_principled(node: bpy.types.Node, entered: Entered, look: Look) -> None:
    look.base = color_of(node.inputs["Base Color"], entered)
    look.metallic = min(max(_number(node, "Metallic", entered, look), 0.0), 1.0)
    look.roughness = min(max(_number(node, "Roughness", entered, look), 0.0), 1.0)
    strength = _number(node, "Emission Strength", entered, look)
    if strength > 0.0:
        look.emission = color_of(node.inputs["Emission Color"], entered)
        look.emission_strength = strength
        look.lost += look.emission.lost
    _read_alpha(node.inputs["Alpha"], entered, look, is_turned=False)


def _read_alpha(socket: bpy.types.NodeSocket, entered: Entered, look: Look, is_turned: bool) -> None:
    """How much of the surface there is: a number, or the alpha of the picture of the base colour."""
    source = source_of(socket, entered)
    if source is None:
        value = min(max(float(own_value(socket, entered).default_value), 0.0), 1.0)
        look.alpha = 1.0 - value if is_turned else value
        return
    found = color_of(socket, entered)
    same = found.picture is not None and look.base.picture is not None and found.picture.image == look.base.picture.image
    if same and not is_turned:
        look.has_picture_alpha = True
    else:
        look.lost.append("its holes (only the alpha of the picture of its colour can cut them)")


def _number(node: bpy.types.Node, name: str, entered: Entered, look: Look) -> float:
    """A number of a node. Where what is linked varies or is not known, the socket's own (of Emission Strength: 1)."""
    socket = node.inputs[name]
    if source_of(socket, entered) is None:
        return float(own_value(socket, entered).default_value)
    color = color_of(socket, entered)
    if color.is_plain() and not color.lost:
        return sum(color.factor) / 3.0
    look.lost.append(f"what is linked to its {name}")
    return float(socket.default_value) if name != "Emission Strength" else 1.0

