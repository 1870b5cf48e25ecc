"""What of Blender's render settings is heeded, and what is refused by name."""

from __future__ import annotations

import bpy

from .failure import Failure


def check(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> None:
    """Raises Failure for settings that cannot be followed."""
    render = scene.render
    if render.use_multiview:
        raise Failure("Impasto paints no stereo pictures: turn off Output > Stereoscopy.")
    if scene.camera is None:
        raise Failure("The scene has no camera: add one, or make one the active camera.")
    if render.pixel_aspect_x != render.pixel_aspect_y:
        raise Failure("Impasto paints square pixels: set Output > Aspect X and Y to the same number.")
    if render.fps_base <= 0:
        raise Failure("The frame rate makes no sense: set Output > Frame Rate.")
    used = [layer.name for layer in scene.view_layers if layer.use]
    if len(used) > 1:
        raise Failure(
            f"Impasto paints one view layer: turn off View Layer > Use for Rendering of all but one of {', '.join(used)}."
        )


def part_px(render: bpy.types.RenderSettings, size_px: tuple[int, int]) -> tuple[int, int, int, int]:
    """The part of the picture that is asked for: left, bottom, width, height. The whole picture is painted all the same, since strokes
    lie across the border."""
    width, height = size_px
    if not render.use_border:
        return 0, 0, width, height
    left, right = int(render.border_min_x * width), int(render.border_max_x * width)
    bottom, top = int(render.border_min_y * height), int(render.border_max_y * height)
    return left, bottom, max(1, right - left), max(1, top - bottom)
