"""Checksums of animation: actions, drivers, NLA strips."""

from collections.abc import Iterator
from typing import Any

import bpy

from .rna_sum import Sum, array_bytes

_KEY_ARRAYS = (("co", 2), ("handle_left", 2), ("handle_right", 2), ("amplitude", 1), ("period", 1), ("back", 1))


def curves_of(action: bpy.types.Action) -> Iterator[tuple[int, Any]]:
    """The curves of an action, each with the number of the slot it belongs to (0 where actions have none)."""
    if len(getattr(action, "layers", ())) > 0:
        for layer in action.layers:
            for strip in layer.strips:
                for bag in strip.channelbags:
                    yield from ((bag.slot_handle, curve) for curve in bag.fcurves)
    elif hasattr(action, "fcurves"):
        yield from ((0, curve) for curve in action.fcurves)


def animated_paths(block: bpy.types.ID) -> dict[str, set[int]]:
    """The properties of a data-block that curves and drivers set: their data paths, each with its array indices."""
    result: dict[str, set[int]] = {}
    animation = getattr(block, "animation_data", None)
    if animation is None:
        return result
    actions = [animation.action] + [strip.action for track in animation.nla_tracks for strip in _strips(track.strips)]
    for action in actions:
        if action is not None:
            for _, curve in curves_of(action):
                result.setdefault(curve.data_path, set()).add(curve.array_index)
    for curve in animation.drivers:
        result.setdefault(curve.data_path, set()).add(curve.array_index)
    return result


def _strips(strips: Any) -> Iterator[Any]:
    for strip in strips:
        yield strip
        yield from _strips(strip.strips)


def add_animation(total: Sum, block: bpy.types.ID) -> None:
    """Adds the animation of a data-block."""
    animation = getattr(block, "animation_data", None)
    if animation is None:
        return
    total.use(animation.action)
    total.add(getattr(animation, "action_slot_handle", 0), animation.action_blend_type, animation.action_extrapolation,
              animation.action_influence, animation.use_nla)
    for curve in animation.drivers:
        _add_curve(total, curve)
        total.struct(curve.driver)
    for track in animation.nla_tracks:
        total.add(track.name, track.mute, track.is_solo)
        for strip in _strips(track.strips):
            total.use(strip.action)
            total.add(strip.type, strip.frame_start, strip.frame_end, strip.action_frame_start, strip.action_frame_end,
                      strip.repeat, strip.scale, strip.mute, strip.use_reverse, strip.blend_type, strip.extrapolation,
                      strip.blend_in, strip.blend_out, getattr(strip, "action_slot_handle", 0),
                      None if strip.use_animated_influence else strip.influence)
            for curve in strip.fcurves:
                _add_curve(total, curve)


def add_action(total: Sum, action: bpy.types.Action) -> None:
    """Adds the curves of an action."""
    for layer in getattr(action, "layers", ()):
        total.add(getattr(layer, "influence", 1.0), getattr(layer, "mix_mode", ""))
    for slot, curve in curves_of(action):
        total.add(slot)
        _add_curve(total, curve)


def _add_curve(total: Sum, curve: Any) -> None:
    total.add(curve.data_path, curve.array_index, curve.extrapolation, curve.mute)
    keys = curve.keyframe_points
    for name, width in _KEY_ARRAYS:
        total.add_bytes(array_bytes(keys, name, width, "f4"))
    for name in ("interpolation", "easing"):
        total.add_bytes(array_bytes(keys, name, 1, "i4"))
    if len(curve.sampled_points) > 0:
        total.add_bytes(array_bytes(curve.sampled_points, "co", 2, "f4"))
    for modifier in curve.modifiers:
        total.struct(modifier)
