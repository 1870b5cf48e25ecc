# Times the extension: exporting a large mesh that bends, and rendering by the engine against the program alone. Run
# with the extension installed, as `cargo xtask blender` does.
import sys
import time

import bpy
import session

session.start()


def timed(words: str, work) -> float:
    """Does it, and says how long it took."""
    begun_s = time.monotonic()
    work()
    took_s = time.monotonic() - begun_s
    session.report(f"{words}: {took_s:.2f} s")
    return took_s


# 160,801 points that wave for 48 frames.
scene = session.fresh(last=48)
bpy.ops.mesh.primitive_grid_add(x_subdivisions=400, y_subdivisions=400, size=10)
bpy.context.object.modifiers.new("Wave", "WAVE")
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
scene.collection.objects.link(camera)
scene.camera = camera
session.save()
timed("48 frames of 160,801 points exported", bpy.ops.impasto.export)
timed("again, where nothing has changed", bpy.ops.impasto.export)

# 24 frames by the engine, and by the program from the folder that the export made.
scene = session.fresh(last=24, size=(640, 360))
session.turning_monkey(scene)
folder = session.save()
scene.render.filepath = str(folder / "engine_")
bpy.ops.impasto.export()
rounds = int(sys.argv[1]) if len(sys.argv) > 1 and sys.argv[1].isdigit() else 3
ratios = []
for _ in range(rounds):
    session.module("painter").stop_all_painters()
    engine_s = timed("24 frames of 640x360 by the engine", lambda: session.render(animation=True))
    arguments = ["--size", "640x360", "-f", "1-24", "-o", str(folder / "program_####.png")]
    scene_file = str(folder / "film_impasto" / "film.ron")
    program_s = timed("the same by the program", lambda: session.impasto("render", scene_file, *arguments))
    ratios.append(engine_s / program_s)
session.report(f"the engine takes {sorted(ratios)[len(ratios) // 2]:.2f} times as long as the program")
