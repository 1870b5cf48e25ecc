"""Comb in Impasto: our window stands beside Blender, reads the shot again with each export, and follows frame and view where asked."""

from __future__ import annotations

import json
import subprocess
import tempfile
from pathlib import Path
from typing import IO

import bpy
from bpy.app.handlers import persistent
from mathutils import Vector

from . import binary, export_request, painting
from .failure import Failure

# How often frame and view are looked at, seconds.
_EVERY_S = 0.1
# A window that cannot open has said so by then, seconds.
_START_S = 1.0


class _Window:
    """Our window on a scene file."""

    def __init__(self, scene_file: Path) -> None:
        self.scene_file = scene_file
        self._said: IO[bytes] = tempfile.TemporaryFile()
        # What the window was told last; only changes are sent.
        self._told: dict = {}
        self._process = subprocess.Popen(
            [str(binary.find()), "edit", str(scene_file), "--follow"], stdin=subprocess.PIPE, stderr=self._said
        )

    def wait_for_its_start(self) -> None:
        """Raises Failure with its words where it ends at once: no display, a scene with errors."""
        try:
            self._process.wait(timeout=_START_S)
        except subprocess.TimeoutExpired:
            return
        if words := self.why_it_ended():
            raise Failure(words.removeprefix("impasto: error: "))

    def is_open(self) -> bool:
        return self._process.poll() is None

    def tell(self, where: dict) -> None:
        """Tells what has changed since the last time."""
        news = {key: value for key, value in where.items() if key not in self._told or self._told[key] != value}
        if not news or self._process.stdin is None:
            return
        try:
            self._process.stdin.write(json.dumps(news).encode() + b"\n")
            self._process.stdin.flush()
        except OSError:
            return
        self._told.update(news)

    def why_it_ended(self) -> str:
        """What it said, where it failed."""
        self._said.seek(0)
        return self._said.read().decode(errors="replace").strip() if self._process.returncode else ""


_window: _Window | None = None


def is_open() -> bool:
    """Whether our window is open."""
    return _window is not None and _window.is_open()


class IMPASTO_OT_comb(bpy.types.Operator):
    """Export, and open the shot in the window of Impasto, where directions of strokes are combed"""

    bl_idname = "impasto.comb"
    bl_label = "Comb in Impasto"

    def execute(self, context: bpy.types.Context) -> set[str]:
        global _window
        try:
            for words in export_request.export(context.scene):
                self.report({"WARNING"}, words)
            scene_file = painting.of_scene(context.scene).scene_file
            if _window is not None and _window.is_open() and _window.scene_file == scene_file:
                self.report({"INFO"}, "The window of Impasto is open and reads the shot again")
                return {"FINISHED"}
            _window = _Window(scene_file)
            _window.wait_for_its_start()
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        except OSError as error:
            self.report({"ERROR"}, f"The window of Impasto does not open: {error}")
            return {"CANCELLED"}
        if not bpy.app.timers.is_registered(_beside):
            bpy.app.timers.register(_beside, first_interval=_EVERY_S)
        return {"FINISHED"}


def _beside() -> float | None:
    """The timer that runs while the window is open: tells it frame and view, and prints why it failed, if it did."""
    if _window is None:
        return None
    if not _window.is_open():
        if words := _window.why_it_ended():
            print(f"Impasto: {words}")
        return None
    tell()
    return _EVERY_S


def tell() -> None:
    """Tells the window Blender's frame and view, if the scene asks for it."""
    scene = bpy.context.scene
    if _window is None or scene is None or not scene.impasto.follow:
        return
    where: dict = {"frame": scene.frame_current + scene.frame_subframe}
    region = _viewport()
    if region is not None:
        where["view"] = _view(region)
    _window.tell(where)


def _viewport() -> bpy.types.RegionView3D | None:
    """The largest viewport that is on the screen."""
    manager = bpy.context.window_manager
    areas = [area for window in manager.windows for area in window.screen.areas if area.type == "VIEW_3D"]
    if not areas:
        return None
    return max(areas, key=lambda area: area.width * area.height).spaces.active.region_3d


def _view(region: bpy.types.RegionView3D) -> dict | None:
    """What a viewport looks at, Y up; None where it looks through the camera."""
    if region.view_perspective == "CAMERA":
        return None
    away = region.view_rotation @ Vector((0.0, 0.0, region.view_distance))
    eye, target = region.view_location + away, region.view_location
    return {
        "eye": [eye.x, eye.z, -eye.y],
        "target": [target.x, target.z, -target.y],
        "orthographic": region.view_perspective == "ORTHO",
    }


@persistent
def _after_save(*_unused: object) -> None:
    """Exports with each save, if the scene asks for it: at once in background mode, else by a timer after the save."""
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
        words = str(failure)
        print(f"Impasto: {words}")
        # A timer has no operator that could report it.
        if not bpy.app.background:
            bpy.context.window_manager.popup_menu(
                lambda menu, _context: menu.layout.label(text=words), title="Export for Impasto", icon="ERROR"
            )


def register() -> None:
    bpy.utils.register_class(IMPASTO_OT_comb)
    bpy.app.handlers.save_post.append(_after_save)


def unregister() -> None:
    if bpy.app.timers.is_registered(_beside):
        bpy.app.timers.unregister(_beside)
    bpy.app.handlers.save_post.remove(_after_save)
    bpy.utils.unregister_class(IMPASTO_OT_comb)
