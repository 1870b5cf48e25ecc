"""Comb in Impasto: our window stands beside Blender, and reads the shot again with each export."""

from __future__ import annotations

import subprocess

import bpy
from bpy.app.handlers import persistent

from . import binary, export_request, painting
from .failure import Failure

# The window that is open, with the scene file that it shows.
_window: subprocess.Popen | None = None
_shows = ""


def is_open() -> bool:
    """Whether our window is open."""
    return _window is not None and _window.poll() is None


class IMPASTO_OT_comb(bpy.types.Operator):
    """Export, and open the shot in the window of Impasto, where directions of strokes are combed"""

    bl_idname = "impasto.comb"
    bl_label = "Comb in Impasto"

    def execute(self, context: bpy.types.Context) -> set[str]:
        global _window, _shows
        try:
            export_request.export(context.scene)
            scene_file = str(painting.of_scene(context.scene).scene_file)
            if is_open() and _shows == scene_file:
                self.report({"INFO"}, "The window of Impasto is open and reads the shot again")
                return {"FINISHED"}
            _window = subprocess.Popen([str(binary.find()), "edit", scene_file], stderr=subprocess.PIPE, text=True)
            _shows = scene_file
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        except OSError as error:
            self.report({"ERROR"}, f"The window of Impasto does not open: {error}")
            return {"CANCELLED"}
        bpy.app.timers.register(_look_for_its_end, first_interval=1.0)
        return {"FINISHED"}


def _look_for_its_end() -> float | None:
    """Says why the window has ended, where it failed."""
    if _window is None or _window.poll() is None:
        return 1.0
    if _window.returncode != 0 and _window.stderr is not None:
        print(f"Impasto: {_window.stderr.read().strip()}")
    return None


@persistent
def _after_save(*_unused: object) -> None:
    """An export with each save, where the scene asks for it; not inside the save itself."""
    scene = bpy.context.scene
    if scene.impasto.export_on_save and not export_request.export_request.is_on:
        if bpy.app.background:
            _export()
        else:
            bpy.app.timers.register(_export, first_interval=0.1)


def _export() -> None:
    try:
        export_request.export(bpy.context.scene)
    except Failure as failure:
        print(f"Impasto: {failure}")


def register() -> None:
    bpy.utils.register_class(IMPASTO_OT_comb)
    bpy.app.handlers.save_post.append(_after_save)


def unregister() -> None:
    bpy.app.handlers.save_post.remove(_after_save)
    bpy.utils.unregister_class(IMPASTO_OT_comb)
