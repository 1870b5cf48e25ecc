"""Lights in the photometric units of KHR_lights_punctual, as Blender's own glTF exporter counts them."""

import math

import bpy
import numpy as np

LUMENS_PER_WATT = 683.0
KINDS = {"SUN": "directional", "POINT": "point", "SPOT": "spot", "AREA": "spot"}

State = dict[str, object]


def state_of(light: bpy.types.Light, world_from_object: np.ndarray) -> State:
    """Colour, intensity, cones and size of a light as it is now."""
    color = [float(part) for part in light.color]
    if getattr(light, "use_temperature", False):
        color = [part * float(tint) for part, tint in zip(color, light.temperature_color)]
    watts = float(light.energy) * 2.0 ** float(getattr(light, "exposure", 0.0))
    largest = max(color)
    if largest > 1.0:
        color, watts = [part / largest for part in color], watts * largest
    scale = np.linalg.norm(world_from_object[:3, :3], axis=0)
    state: State = {"color": color}
    if light.type == "AREA":
        width = float(light.size * scale[0])
        is_long = light.shape in ("RECTANGLE", "ELLIPSE")
        height = float((light.size_y if is_long else light.size) * scale[1])
        if not getattr(light, "normalize", True):
            is_round = light.shape in ("DISK", "ELLIPSE")
            watts *= width * height * (math.pi / 4.0 if is_round else 1.0)
        state["area"] = [width, height]
        state["cones"] = [0.0, math.pi / 2.0]
        state["intensity"] = max(watts, 0.0) * LUMENS_PER_WATT / math.pi
    elif light.type == "SUN":
        state["intensity"] = max(watts, 0.0) * LUMENS_PER_WATT
    else:
        if not getattr(light, "normalize", True):
            watts *= math.pi * float(light.shadow_soft_size) ** 2
        state["intensity"] = max(watts, 0.0) * LUMENS_PER_WATT / (4.0 * math.pi)
        if light.type == "SPOT":
            outer = min(float(light.spot_size) / 2.0, math.pi / 2.0)
            state["cones"] = [min(outer * (1.0 - float(light.spot_blend)), outer * 0.999), outer]
    return state
