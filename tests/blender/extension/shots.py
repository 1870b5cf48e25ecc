# Makes shots in a real Blender, exports each into OUT/NAME/ with Impasto's extension, and writes what Blender itself
# says of every frame as OUT/NAME.json: field of view, and where vertices are in the world and in a picture of 640 by
# 360 pixels.
# Run: python shots.py OUT [NAME ...] (with bpy).
import json
import math
import os
import sys
import time
from pathlib import Path

import bpy
from bpy_extras.object_utils import world_to_camera_view

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[2] / "blender" / "impasto")]

import export  # noqa: E402
import scenes  # noqa: E402
from rich_scene import rich  # noqa: E402

OUT = sys.argv[1]


def walk_to(frame: int) -> bpy.types.Depsgraph:
    """Goes to a frame."""
    bpy.context.scene.frame_set(frame)
    return bpy.context.evaluated_depsgraph_get()


def hidden_now(thing: bpy.types.Object) -> bool:
    """Whether an object is not rendered."""
    return thing.hide_render


def say(name: str) -> None:
    """Writes what Blender says of each frame."""
    scene = bpy.context.scene
    names: dict[tuple[object, ...], str] = {}
    frames = []
    for number in range(scene.frame_start, scene.frame_end + 1):
        graph = walk_to(number)
        seen = scene.camera.evaluated_get(graph)
        # The angle is that of the picture's longer side.
        fov_y = 2 * math.atan(math.tan(seen.data.angle / 2) * scenes.HEIGHT / scenes.WIDTH)
        row = {"frame": number, "camera": scene.camera.name, "fov_y_rad": fov_y if seen.data.type == "PERSP" else None,
               "objects": {}}
        for instance in graph.object_instances:
            thing = instance.object
            if thing.type != "MESH" or hidden_now(thing) or (instance.is_instance and hidden_now(instance.parent)):
                continue
            mesh = thing.data if instance.is_instance else thing.to_mesh()
            places = []
            for vertex in mesh.vertices:
                world = instance.matrix_world @ vertex.co
                at = world_to_camera_view(scene, seen, world)
                places.append([*world, at.x * scenes.WIDTH, at.y * scenes.HEIGHT])
            if places:
                row["objects"][name_of(instance, names)] = places
            if not instance.is_instance:
                thing.to_mesh_clear()
        frames.append(row)
    with open(os.path.join(OUT, name + ".json"), "w", encoding="utf-8") as file:
        json.dump(frames, file)


def name_of(instance: bpy.types.DepsgraphObjectInstance, names: dict[tuple[object, ...], str]) -> str:
    """The name that the node of an instance should have."""
    thing = instance.object
    if not instance.is_instance or (instance.parent.name == thing.name and instance.parent.original.type != "MESH"):
        return thing.name
    key = (instance.parent.name, thing.name, tuple(instance.persistent_id))
    if key not in names:
        wanted = f"{instance.parent.name}/{thing.name}"
        name, number = wanted, 0
        while name in names.values():
            number += 1
            name = f"{wanted}.{number:03}"
        names[key] = name
    return names[key]


def main() -> None:
    """Makes all shots, or those that are named."""
    os.makedirs(OUT, exist_ok=True)
    makers = {"walk": scenes.walk, "cloth": scenes.cloth, "cuts": scenes.cuts, "instances": scenes.instances, "slanted": scenes.slanted,
              "rich": lambda: rich(OUT)}
    for name in sys.argv[2:] or makers:
        makers[name]()
        say(name)
        makers[name]()
        scene = bpy.context.scene
        began = time.time()
        told = export.export_shot(walk_to, scene, Path(OUT) / name, frames=(scene.frame_start, scene.frame_end),
                                  report=lambda share: None, stop=lambda: False)
        print(f"{name}: {told.objects} objects, {told.frames} frames, {told.cached_points} points in caches, "
              f"{time.time() - began:.2f} s")
        for warning in told.warnings:
            print("  " + warning)


main()
