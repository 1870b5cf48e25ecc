"""What the panels show: fields of the scene file, by scene, collection, object and material. Nothing of it is stored in the .blend."""

from __future__ import annotations

from typing import Any

import bpy

from . import painting, scene_file
from .failure import Failure

# The program's presets; the first is the default.
PRESETS = ("oil study", "impressionist", "dry brush", "gouache", "ink", "paper")
NO_PRESET = ("NONE", "As the Scene", "As the scene has it, or the oil study")

# Field, name, description, least, most, default.
NUMBERS: tuple[tuple[str, str, str, float, float, float], ...] = (
    ("scale", "Stroke Size", "Makes the strokes of all layers larger or smaller", 0.01, 100.0, 1.0),
    ("coverage", "Coverage", "How many strokes lie over each other; under 1, what lies below shows", 0.001, 20.0, 2.7),
    ("contour", "Contour", "How far strokes near the limb lie along it", 0.0, 1.0, 0.0),
    ("boil", "Boil", "Lays the strokes anew as the film runs, as painted films do; 0 keeps them still", 0.0, 1.0, 0.0),
    ("boil_on", "Boil On", "For how many frames strokes hold before they are laid anew", 1.0, 1000.0, 2.0),
)


def _covers(owner: bpy.types.ID) -> dict[str, Any] | None:
    """What a region for this covers; None for the scene itself."""
    if isinstance(owner, bpy.types.Object):
        return {"Object": owner.name}
    if isinstance(owner, bpy.types.Collection):
        return {"Collection": owner.name}
    if isinstance(owner, bpy.types.Material):
        return {"EachMaterial": owner.name}
    return None


def place() -> painting.Painting | None:
    """The painting of the scene in the window, where its scene file is there."""
    try:
        found = painting.of_scene(bpy.context.scene)
    except Failure:
        return None
    return found if found.scene_file.is_file() else None


def stated(owner: bpy.types.ID) -> dict[str, Any]:
    """The stroke settings that the scene file states for this."""
    where = place()
    if where is None:
        return {}
    found = scene_file.document(where.scene_file)
    on = _covers(owner)
    if on is None:
        return found.get("strokes", {})
    index = scene_file.region_of(found, on)
    return {} if index is None else found["regions"][index].get("strokes", {})


def state(owner: bpy.types.ID, field: str, value: str) -> None:
    """Writes one field; an empty value takes it out. Raises Failure."""
    where = place()
    if where is None:
        raise Failure("There is no scene file yet: press Export for Impasto.")
    found = scene_file.document(where.scene_file)
    on = _covers(owner)
    if on is None:
        scene_file.write(where.scene_file, [f"strokes.{field}={value}"])
        return
    index = scene_file.region_of(found, on)
    if index is None:
        if value:
            scene_file.write(where.scene_file, [scene_file.new_region(found, on, f"strokes: ({field}: {value})")])
        return
    region = found["regions"][index]
    # A region that says nothing would still stand over others.
    is_last = not value and set(region) <= {"name", "on", "strokes"} and set(region.get("strokes", {})) <= {field}
    scene_file.write(where.scene_file, [f"regions[{index}]=" if is_last else f"regions[{index}].strokes.{field}={value}"])


def stands_over(owner: bpy.types.ID) -> str:
    """Of an object: the collection or material whose settings its own take the place of; empty where there is none."""
    if not isinstance(owner, bpy.types.Object):
        return ""
    slots = [slot.material for slot in owner.material_slots if slot.material is not None]
    return next((other.name for other in [*slots, *owner.users_collection] if stated(other)), "")


# What the last change was refused with; the panels show it until the next one.
last_failure = ""


def _refused(failure: Failure) -> None:
    """A property cannot report: panels show it, and scripts read it in the console."""
    global last_failure
    last_failure = str(failure)
    print(f"Impasto: {failure}")


def _try(owner: bpy.types.ID, field: str, value: str) -> None:
    global last_failure
    try:
        state(owner, field, value)
        last_failure = ""
    except Failure as failure:
        _refused(failure)


def _number(field: str, name: str, words: str, least: float, most: float, usual: float) -> Any:
    def get(self: StrokeSettings) -> float:
        return float(stated(self.id_data).get(field, usual))

    def put(self: StrokeSettings, value: float) -> None:
        # Scripts may set what no slider gives.
        _try(self.id_data, field, scene_file.number(min(max(value, least), most)))

    return bpy.props.FloatProperty(
        name=name, description=words, min=least, max=most, soft_max=min(most, 5.0 * max(usual, 0.2)), get=get, set=put
    )


def _preset(self: StrokeSettings) -> int:
    name = stated(self.id_data).get("preset")
    return PRESETS.index(name) + 1 if name in PRESETS else 0


def _put_preset(self: StrokeSettings, index: int) -> None:
    _try(self.id_data, "preset", scene_file.text(PRESETS[index - 1]) if index else "")


class StrokeSettings(bpy.types.PropertyGroup):
    """The strokes of a scene, a collection, an object or a material."""

    preset: bpy.props.EnumProperty(  # type: ignore[valid-type]
        name="Preset",
        description="A named set of stroke settings",
        items=[NO_PRESET, *((name, name.capitalize(), "") for name in PRESETS)],
        get=_preset,
        set=_put_preset,
    )
    scale: _number(*NUMBERS[0])  # type: ignore[valid-type]
    coverage: _number(*NUMBERS[1])  # type: ignore[valid-type]
    contour: _number(*NUMBERS[2])  # type: ignore[valid-type]
    boil: _number(*NUMBERS[3])  # type: ignore[valid-type]
    boil_on: _number(*NUMBERS[4])  # type: ignore[valid-type]


STYLES = ("RotatingStrokes", "SumiE")


def _style(self: SceneSettings) -> int:
    where = place()
    found = scene_file.document(where.scene_file).get("style", {}) if where else {}
    name = found if isinstance(found, str) else next(iter(found), "")
    return STYLES.index(name) if name in STYLES else 0


def _put_style(self: SceneSettings, index: int) -> None:
    global last_failure
    where = place()
    if where is None or _style(self) == index:
        return
    try:
        scene_file.write(where.scene_file, [f"style={STYLES[index]}()" if index else "style="])
        last_failure = ""
    except Failure as failure:
        _refused(failure)


class SceneSettings(bpy.types.PropertyGroup):
    """What a Blender scene says of its painting."""

    folder: bpy.props.StringProperty(  # type: ignore[valid-type]
        name="Folder",
        description="Where the painting's files are; left empty, a folder beside the .blend",
        subtype="DIR_PATH",
        # From Blender 4.5 on a property must say that its path may begin with //.
        options={"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (4, 5, 0) else set(),
    )
    export_on_save: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Export on Save",
        description="Export the shot whenever the .blend is saved: the window of Impasto reads it and goes on",
    )
    follow: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Window Follows",
        description="The window of Impasto goes to the frame and the view that are shown here",
    )
    style: bpy.props.EnumProperty(  # type: ignore[valid-type]
        name="Style",
        description="How the scene is drawn",
        items=[
            ("RotatingStrokes", "Brush Strokes", "Strokes of paint that turn with what they lie on"),
            ("SumiE", "Ink", "Ink painting: edges first, then brush marks in four tones"),
        ],
        get=_style,
        set=_put_style,
    )
    strokes: bpy.props.PointerProperty(type=StrokeSettings)  # type: ignore[valid-type]


class LayerSettings(bpy.types.PropertyGroup):
    """Which of Impasto's own passes a view layer has."""

    strokes: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Strokes", description="Angle, number, trust and layer of the stroke that shows most"
    )
    paint: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Paint", description="Colour, normal and height of the paint without the light of the room"
    )
    crypto_strokes: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Strokes", description="A Cryptomatte of single strokes"
    )


OWNERS = (bpy.types.Object, bpy.types.Collection, bpy.types.Material)
CLASSES = (StrokeSettings, SceneSettings, LayerSettings)


def register() -> None:
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.impasto = bpy.props.PointerProperty(type=SceneSettings)
    bpy.types.ViewLayer.impasto = bpy.props.PointerProperty(type=LayerSettings)
    for owner in OWNERS:
        owner.impasto = bpy.props.PointerProperty(type=StrokeSettings)


def unregister() -> None:
    for owner in (*OWNERS, bpy.types.Scene, bpy.types.ViewLayer):
        del owner.impasto
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
