# Errors are told in our words, where Blender shows its own errors. Blender goes on, and nothing is lost.
import os
import shutil
import threading
import time
from pathlib import Path

import bpy
import session

session.start()


def has_words(said: str, *wanted: str) -> None:
    assert all(word in said for word in wanted), f"{said!r} lacks one of {wanted}"


scene = session.fresh(last=3)
monkey = session.turning_monkey(scene)
has_words(session.render(), "Save the .blend first")
folder = session.save()
scene_file = folder / "film_impasto" / "film.ron"
scene.render.filepath = str(folder / "still.png")
assert not session.render(write_still=True)

# A program that is missing, and one that is not Impasto.
path = os.environ["PATH"]
session.module("painter").stop_all_painters()
os.environ["PATH"] = "/nowhere"
has_words(session.render(), "impasto was not found", "Preferences")
os.environ["PATH"] = path
preferences = bpy.context.preferences.addons[session.MODULE].preferences
preferences.program = "/nowhere/impasto"
has_words(session.render(), "/nowhere/impasto", "preferences")
preferences.program = "/bin/true"
has_words(session.render(), "too old")
preferences.program = ""
session.report("a missing program, a wrong one")

# The program is killed while it paints.
def kill_soon() -> None:
    painter = session.module("painter")
    for _ in range(400):
        for known in list(painter._painters.values()):
            time.sleep(0.3)
            known._process.kill()
            return
        time.sleep(0.01)


scene.render.resolution_x, scene.render.resolution_y = 1280, 720
thread = threading.Thread(target=kill_soon)
session.module("painter").stop_all_painters()
thread.start()
has_words(session.render(animation=True), "impasto ended")
thread.join()
scene.render.resolution_x, scene.render.resolution_y = 320, 180
assert not session.render(write_still=True)
session.report("a program that was killed")

# Errors in the scene file: with file, line and column.
text = scene_file.read_text()
scene_file.write_text(text.replace("version: 1", "version: 1, strokez: 3"))
has_words(session.render(), "film.ron:3", "strokez")
scene_file.write_text(text)
assert not session.render(write_still=True)
session.report("an error in the scene file, and its mend")

# Esc while exporting, while the scene is prepared, and while a frame is painted. How long it takes is told, not judged:
# that depends on what else the machine does.
engine = session.module("engine").ImpastoEngine
heeded = engine._is_stopped


def order_s() -> float:
    """For how long the program has had an order, seconds; below zero while it has none."""
    painters = session.module("painter")._painters.values()
    if not any(painter._coming for painter in painters):
        return -1.0
    ordered.append(time.monotonic())
    return ordered[-1] - ordered[0]


# A frame of this size is painted for more than a second, after less than half a second of preparing.
scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
for name, after_s in (("exporting", -1.0), ("preparing", 0.0), ("painting", 0.8)):
    ordered: list[float] = []
    pressed: list[float] = []

    def breaks(_self: object) -> bool:
        if order_s() >= after_s:
            pressed.append(time.monotonic())
        return bool(pressed)

    engine._is_stopped = breaks
    monkey.location.x += 0.01
    session.module("painter").stop_all_painters()
    assert not session.render()
    assert pressed, f"nobody asked for Esc while {name}"
    session.report(f"Esc while {name}: {time.monotonic() - pressed[0]:.2f} s")
engine._is_stopped = heeded
scene.render.resolution_x, scene.render.resolution_y = 320, 180
said = session.render(write_still=True)
assert not said, said

# What cannot be painted is refused, and the error says what it is.
scene.render.use_multiview = True
has_words(session.render(), "stereo")
scene.render.use_multiview = False
camera, scene.camera = scene.camera, None
said = session.render()
assert "camera" in said.lower(), said
scene.camera = camera
other = scene.view_layers.new("Other")
has_words(session.render(), "one view layer")
scene.view_layers.remove(other)

# A mesh whose vertex count changes.
modifier = monkey.modifiers.new("Build", "BUILD")
modifier.frame_start, modifier.frame_duration = 1, 3
has_words(session.render(), "Suzanne", "points")
monkey.modifiers.remove(modifier)
assert not session.render(write_still=True)
session.report("stereo, no camera, two view layers, a mesh that grows")

# A full disk, where one can be mounted: an export into it fails and leaves no part of a shot. The files of the usual
# folder, but for the shot, stay as they were.
before = {path.name: path.read_bytes() for path in (folder / "film_impasto").iterdir() if path.is_file()}
small = Path("/tmp/impasto_small_disk")
small.mkdir(exist_ok=True)
if os.system(f"mount -t tmpfs -o size=300k tmpfs {small} 2>/dev/null") == 0:
    try:
        scene.impasto.folder = str(small / "painting")
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=200, y_subdivisions=200)
        said = session.render()
        has_words(said, "cannot be written")
        assert not (small / "painting" / "shot.glb").exists()
    finally:
        scene.impasto.folder = ""
        bpy.ops.object.delete()
        os.system(f"umount {small}")
    session.report("a full disk")
for name, content in before.items():
    assert (folder / "film_impasto" / name).read_bytes() == content or name.startswith("shot"), name
shutil.rmtree(folder)

# Again and again: memory stays level.
scene = session.fresh(last=100, size=(160, 90))
session.turning_monkey(scene)
folder = session.save()
scene.render.filepath = str(folder / "f_")


def resident_mib() -> float:
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 2**20


sizes = []
for frame in range(1, 101):
    scene.frame_set(frame)
    assert not session.render()
    if frame in (20, 100):
        sizes.append(resident_mib())
session.report(f"memory after 20 renders {sizes[0]:.0f} MiB, after 100 {sizes[1]:.0f} MiB")
assert sizes[1] < sizes[0] * 1.05 + 4
shutil.rmtree(folder)
