"""Reads an EXR file of ours in Blender's compositor: its passes, and a matte by name.

Usage: python compositing.py FRAME.exr OUT_FOLDER OBJECT WIDTH HEIGHT
Writes matte.exr (the matte of OBJECT), and passes.json (what the Image node calls the passes).
"""

import json
import os
import sys

import bpy

frame, folder, name, width, height = sys.argv[-5:]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
image = bpy.data.images.load(frame)

if hasattr(scene, "compositing_node_group"):
    tree = bpy.data.node_groups.new("compositing", "CompositorNodeTree")
    scene.compositing_node_group = tree
    tree.interface.new_socket(name="Image", in_out="OUTPUT", socket_type="NodeSocketColor")
else:
    # Before Blender 5.0.
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
picture = tree.nodes.new("CompositorNodeImage")
picture.image = image
matte = tree.nodes.new("CompositorNodeCryptomatteV2")
matte.source = "IMAGE"
matte.image = image
result = tree.nodes.new("NodeGroupOutput" if hasattr(scene, "compositing_node_group") else "CompositorNodeComposite")

scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = os.path.join(folder, "matte.exr")
scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
scene.collection.objects.link(scene.camera)

matte.layer_name = "CryptoObject"
matte.matte_id = name
tree.links.new(matte.outputs["Matte"], result.inputs["Image"])
bpy.ops.render.render(write_still=True)

with open(os.path.join(folder, "passes.json"), "w", encoding="utf-8") as file:
    json.dump({"outputs": [socket.name for socket in picture.outputs], "type": image.type}, file)
