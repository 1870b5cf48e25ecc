# A Blender with the extension enabled, for the tests of this folder. BLENDER_USER_RESOURCES names the profile into
# which the extension was installed; `impasto` must be on the PATH.
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy

MODULE = "bl_ext.user_default.impasto"


def start() -> None:
    """Enables the extension, which is installed in the profile."""
    bpy.ops.preferences.addon_enable(module=MODULE)


def module(name: str):
    """A module of the extension."""
    return sys.modules[f"{MODULE}.{name}"]


def fresh(last: int = 6, size: tuple[int, int] = (320, 180)) -> bpy.types.Scene:
    """An empty scene, not saved yet, painted by Impasto."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    start()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 1, last, 24
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.engine = "IMPASTO"
    return scene


def save(name: str = "film") -> Path:
    """Saves into a new folder, and gives it."""
    folder = Path(tempfile.mkdtemp(prefix="impasto_test_"))
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{name}.blend"))
    return folder


def layers_as_exr(scene: bpy.types.Scene) -> None:
    """Output as uncompressed EXR of 32 bits with all passes."""
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format = "OPEN_EXR_MULTILAYER"
    settings.color_depth, settings.exr_codec = "32", "NONE"


def turning_monkey(scene: bpy.types.Scene) -> bpy.types.Object:
    """A monkey that turns, a camera that looks at it, and a sun."""
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    monkey.keyframe_insert("rotation_euler", frame=1)
    monkey.rotation_euler = (0.2, 0, 0.9)
    monkey.keyframe_insert("rotation_euler", frame=scene.frame_end)
    material = bpy.data.materials.new("Red")
    material.diffuse_color = (0.6, 0.05, 0.03, 1)
    monkey.data.materials.append(material)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (0.0, -6.0, 0.5), (1.49, 0, 0)
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3.0, (0.7, 0.2, 0.4)
    for thing in (camera, sun):
        scene.collection.objects.link(thing)
    scene.camera = camera
    return monkey


def impasto(*arguments: str) -> str:
    """Runs the program."""
    done = subprocess.run(["impasto", *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def render(**options) -> str:
    """Renders; returns the words of the error, or nothing."""
    try:
        bpy.ops.render.render(**options)
    except RuntimeError as error:
        return str(error)
    return ""


def report(words: str) -> None:
    print(f"  Blender {bpy.app.version_string}: {words}", flush=True)
