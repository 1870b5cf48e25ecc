# F12 and animations give the pictures, with passes, that `impasto serve` paints from the same folder.
import json

import bpy
import exr_layers
import numpy as np
import session

session.start()


def channels(path) -> dict[str, np.ndarray]:
    """The channels of an EXR file of Impasto, as the extension reads them, rows from the bottom up."""
    return session.module("exr").read(path).channels


def passes_of_file(path: str) -> dict[str, np.ndarray]:
    """The passes of an EXR file that Blender wrote."""
    return {name.split(".", 1)[1]: plane for name, plane in exr_layers.read(path).items()}


def compare(blenders: dict[str, np.ndarray], ours: dict[str, np.ndarray], part=slice(None)) -> None:
    pairs = {"R": "Combined.R", "G": "Combined.G", "B": "Combined.B", "A": "Combined.A"}
    pairs |= {"Z": "Depth.Z", "motion.X": "Vector.X", "motion.W": "Vector.W", "N.X": "Normal.X", "N.Y": "Normal.Z"}
    pairs |= {"CryptoObject00.R": "CryptoObject00.R", "CryptoStroke02.A": "CryptoStroke02.A"}
    pairs |= {"stroke.angle.X": "StrokeAngle.X", "stroke.id.X": "StrokeId.X", "paint.height.X": "PaintHeight.X"}
    lower = {name.lower(): pixels for name, pixels in blenders.items()}
    for own, theirs in pairs.items():
        assert np.array_equal(ours[own].astype(np.float32)[part], lower[theirs.lower()]), f"{own} and {theirs} differ"


AOVS = "depth,normal,motion,crypto.object,crypto.stroke,stroke,paint.height,paint.color,paint.normal"

scene = session.fresh(last=5)
monkey = session.turning_monkey(scene)
layer = scene.view_layers[0]
layer.use_pass_z = layer.use_pass_normal = layer.use_pass_vector = layer.use_pass_cryptomatte_object = True
layer.impasto.strokes = layer.impasto.paint = layer.impasto.crypto_strokes = True
folder = session.save()
session.layers_as_exr(scene)
scene.frame_set(3)
scene.render.filepath = str(folder / "still.exr")
assert not session.render(write_still=True)
scene.render.filepath = str(folder / "film_")
assert not session.render(animation=True)
painting = folder / "film_impasto"
session.impasto("render", str(painting / "film.ron"), "-o", str(folder / "own_####.exr"), "--aov", AOVS)
plain = session.module("painter").painter_of(painting / "film.ron")
how = {"size": [320, 180], "aovs": AOVS.split(","), "alpha": False}
for frame in range(1, 6):
    ours = channels(plain.frame(frame, [], how, lambda: False))
    compare(passes_of_file(str(folder / f"film_{frame:04}.exr")), ours)
    if frame == 3:
        compare(passes_of_file(str(folder / "still.exr")), ours)

session.report("a still and 5 frames with 12 passes are the pictures of the program, bit by bit")

# What is asked for by the render settings.
scene.render.resolution_percentage = 50
scene.render.filepath = str(folder / "half.exr")
assert not session.render(write_still=True)
assert passes_of_file(str(folder / "half.exr"))["Combined.R"].shape == (90, 160)
scene.render.resolution_percentage = 100
scene.render.use_border = True
scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
scene.render.border_min_y, scene.render.border_max_y = 0.5, 1.0
for crops in (False, True):
    scene.render.use_crop_to_border = crops
    scene.render.filepath = str(folder / f"border_{crops}.exr")
    assert not session.render(write_still=True)
    part = passes_of_file(str(folder / f"border_{crops}.exr"))["Combined.R"]
    whole = passes_of_file(str(folder / "still.exr"))["Combined.R"][90:180, 80:240]
    got = part if crops else part[90:180, 80:240]
    assert np.array_equal(got, whole), f"the border, cropped: {crops}, {part.shape}"
scene.render.use_border = False
scene.render.film_transparent = True
scene.render.filepath = str(folder / "clear.exr")
assert not session.render(write_still=True)
alpha = passes_of_file(str(folder / "clear.exr"))["Combined.A"]
assert alpha.min() == 0 and alpha.max() > 0.99
scene.render.film_transparent = False
scene.frame_step = 2
scene.render.filepath = str(folder / "step_")
assert not session.render(animation=True)
assert sorted(path.name for path in folder.glob("step_*")) == ["step_0001.exr", "step_0003.exr", "step_0005.exr"]
compare(passes_of_file(str(folder / "step_0005.exr")), channels(plain.frame(5, [], how, lambda: False)))
scene.frame_step = 1
session.report("percentage, border, transparent film and frame step are heeded")

# A compositor finds mattes by the names that the file states.
stated = exr_layers.attributes(str(folder / "still.exr"))
manifests = {stated[key[: -len("manifest")] + "name"]: value for key, value in stated.items() if key.endswith("/manifest")}
of_objects = next(value for name, value in manifests.items() if name.endswith(b"CryptoObject"))
assert "Suzanne" in json.loads(of_objects), manifests
session.report("the file that Blender writes names its mattes")
