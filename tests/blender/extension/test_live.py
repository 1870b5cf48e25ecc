# "Comb in Impasto": where the scene asks for it, the editor's window is told of frame and view. A stand-in for the
# program notes the lines that it gets.
import json
import os
import time
from pathlib import Path

import bpy
import session

STAND_IN = """#!/bin/sh
case "$1" in
  edit) echo "$@" > "{folder}/arguments"; exec cat > "{folder}/lines" ;;
  *) exec "{program}" "$@" ;;
esac
"""


def lines(folder: Path, count: int) -> list[dict]:
    """The lines that the window was told, once there are at least `count`."""
    for _ in range(200):
        path = folder / "lines"
        told = path.read_text().splitlines() if path.is_file() else []
        if len(told) >= count:
            return [json.loads(line) for line in told]
        time.sleep(0.02)
    raise AssertionError(f"{len(told)} lines and not {count}: {told}")


session.start()
scene = session.fresh(last=3)
session.turning_monkey(scene)
folder = session.save()
program = next(Path(path) / "impasto" for path in os.environ["PATH"].split(os.pathsep) if (Path(path) / "impasto").is_file())
stand_in = folder / "impasto"
stand_in.write_text(STAND_IN.format(folder=folder, program=program))
stand_in.chmod(0o755)
bpy.context.preferences.addons[session.MODULE].preferences.program = str(stand_in)
live = session.module("live")

assert bpy.ops.impasto.comb() == {"FINISHED"} and live.is_open()
scene.frame_set(2)
live.tell()
scene.impasto.follow = True
live.tell()
live.tell()
scene.frame_set(3)
live.tell()
told = lines(folder, 2)
assert [line["frame"] for line in told] == [2, 3], told
assert (folder / "arguments").read_text().split() == ["edit", str(folder / "film_impasto" / "film.ron"), "--follow"]

# Combing a second time exports again, and opens no second window.
shot = folder / "film_impasto" / "shot.glb"
stamp = shot.stat().st_mtime_ns
bpy.data.objects["Suzanne"].location.z = 1
bpy.data.objects["Suzanne"].keyframe_insert("location", frame=1)
window = live._window
assert bpy.ops.impasto.comb() == {"FINISHED"} and live._window is window
assert shot.stat().st_mtime_ns != stamp

# Each save exports too, if the scene asks for it.
scene.impasto.export_on_save = True
bpy.data.objects["Suzanne"].location.z = 2
bpy.data.objects["Suzanne"].keyframe_insert("location", frame=1)
stamp = shot.stat().st_mtime_ns
bpy.ops.wm.save_mainfile()
assert shot.stat().st_mtime_ns != stamp

# A window that was closed is no error, and the next one is new.
window._process.kill()
window._process.wait()
scene.frame_set(1)
live.tell()
assert not live.is_open()
assert bpy.ops.impasto.comb() == {"FINISHED"} and live.is_open()
live._window._process.kill()
session.report("the window is opened once, told of frames where asked, and reads each export")
