"""An export without a picture. Only a render engine is given what a render sees (the modifiers' render settings, instances, what is
hidden from renders), so the operator that exports starts a render that ends after the export."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy

from .failure import Failure


@dataclass
class ExportRequest:
    """What the operator wants of the engine, and what the engine says."""

    is_on: bool = False
    anew: bool = False
    failure: str = ""
    warnings: list[str] = field(default_factory=list)


export_request = ExportRequest()


@contextmanager
def _settings(scene: bpy.types.Scene) -> Iterator[None]:
    """Render settings for an export alone: no compositor writes files, and only the last slot loses its picture."""
    render = scene.render
    kept = (render.engine, render.use_compositing, render.use_sequencer)
    result = bpy.data.images.get("Render Result")
    slot = result.render_slots.active_index if result else 0
    try:
        render.engine, render.use_compositing, render.use_sequencer = "IMPASTO", False, False
        if result and len(result.render_slots) > 1:
            result.render_slots.active_index = len(result.render_slots) - 1
        yield
    finally:
        render.engine, render.use_compositing, render.use_sequencer = kept
        if result:
            result.render_slots.active_index = slot


def export(scene: bpy.types.Scene, *, anew: bool = False) -> list[str]:
    """Exports a scene's shot, where anything has changed or `anew`. Returns what could not be carried, in words.

    Raises Failure."""
    export_request.is_on, export_request.anew = True, anew
    export_request.failure, export_request.warnings = "", []
    try:
        with _settings(scene):
            bpy.ops.render.render(scene=scene.name, write_still=False)
    except RuntimeError as error:
        # What the engine reports as an error, the operator raises.
        raise Failure(export_request.failure or str(error)) from error
    finally:
        export_request.is_on = False
    if export_request.failure:
        raise Failure(export_request.failure)
    return export_request.warnings
