"""The panels: in the properties of the scene's render, the view layer, collections, objects and materials."""

from __future__ import annotations

import bpy

from . import settings
from .engine import ImpastoEngine

ENGINES = {ImpastoEngine.bl_idname}


def _draw_strokes(layout: bpy.types.UILayout, owner: bpy.types.ID, group: settings.StrokeSettings, of: str) -> None:
    """The stroke settings of one owner; what the scene file states for it can be taken back."""
    if settings.place() is None:
        layout.label(text="Export for Impasto makes the scene file", icon="INFO")
        layout.operator("impasto.export", icon="EXPORT")
        return
    stated = settings.stated(owner)
    if stated and (over := settings.stands_over(owner)):
        layout.label(text=f"In place of all settings of {over}", icon="INFO")
    for field in ("preset", *(row[0] for row in settings.NUMBERS)):
        row = layout.row(align=True)
        row.prop(group, field)
        taken = row.row(align=True)
        taken.enabled = field in stated
        button = taken.operator("impasto.take_back", text="", icon="LOOP_BACK")
        button.field, button.of = field, of
    if settings.last_failure:
        layout.label(text=settings.last_failure, icon="ERROR")


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = ENGINES

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine in cls.COMPAT_ENGINES


class IMPASTO_PT_painting(_Panel, bpy.types.Panel):
    """The painting of the scene."""

    bl_label = "Painting"
    bl_context = "render"

    def draw(self, context: bpy.types.Context) -> None:
        layout, scene = self.layout, context.scene
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        column.prop(scene.impasto, "folder")
        column.prop(scene.impasto, "export_on_save")
        column.prop(scene.impasto, "follow")
        row = layout.row(align=True)
        row.operator("impasto.export", icon="EXPORT")
        row.operator("impasto.comb", icon="BRUSH_DATA")
        layout.operator("impasto.read_guides", icon="CURVE_DATA")
        if scene.view_settings.view_transform not in ("Standard", "Raw"):
            box = layout.box()
            box.label(text=f"{scene.view_settings.view_transform} changes the colours of the paint", icon="INFO")
            box.operator("impasto.standard_view")


class IMPASTO_PT_strokes(_Panel, bpy.types.Panel):
    """The strokes of the whole scene."""

    bl_label = "Strokes"
    bl_context = "render"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        if settings.place() is not None:
            self.layout.prop(context.scene.impasto, "style")
        _draw_strokes(self.layout, context.scene, context.scene.impasto.strokes, "SCENE")


class IMPASTO_PT_passes(_Panel, bpy.types.Panel):
    """The passes of a view layer."""

    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        layout, layer = self.layout, context.view_layer
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column(heading="Data")
        column.prop(layer, "use_pass_z", text="Depth")
        column.prop(layer, "use_pass_normal", text="Normal")
        column.prop(layer, "use_pass_vector", text="Vector")
        column = layout.column(heading="Cryptomatte")
        column.prop(layer, "use_pass_cryptomatte_object", text="Object")
        column.prop(layer, "use_pass_cryptomatte_material", text="Material")
        column.prop(layer.impasto, "crypto_strokes")
        column = layout.column(heading="Paint")
        column.prop(layer.impasto, "strokes")
        column.prop(layer.impasto, "paint")


class IMPASTO_PT_object(_Panel, bpy.types.Panel):
    """The strokes on an object."""

    bl_label = "Strokes"
    bl_context = "object"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        _draw_strokes(self.layout, context.object, context.object.impasto, "OBJECT")


class IMPASTO_PT_collection(_Panel, bpy.types.Panel):
    """The strokes on all objects of a collection."""

    bl_label = "Strokes"
    bl_context = "collection"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        _draw_strokes(self.layout, context.collection, context.collection.impasto, "COLLECTION")


class IMPASTO_PT_material(_Panel, bpy.types.Panel):
    """The strokes on a material, whichever object has it."""

    bl_label = "Strokes"
    bl_context = "material"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.material is not None

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        _draw_strokes(self.layout, context.material, context.material.impasto, "MATERIAL")


CLASSES = (
    IMPASTO_PT_painting,
    IMPASTO_PT_strokes,
    IMPASTO_PT_passes,
    IMPASTO_PT_object,
    IMPASTO_PT_collection,
    IMPASTO_PT_material,
)

# Blender's own panels of what is not carried.
_LEFT_OUT = ("VIEWLAYER_PT_layer_passes", "VIEWLAYER_PT_filter", "RENDER_PT_gpencil", "RENDER_PT_grease")
# Panels of one of Blender's engines that edit what is carried: the nodes of a material, the strength and colour of a light.
_TAKEN_IN = ("EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "DATA_PT_EEVEE_light")


def _shared_panels() -> list[type]:
    """Blender's panels that make sense with any engine (output, frame range, lights, cameras, ...), and `_TAKEN_IN`."""

    def is_shared(panel: type) -> bool:
        compatible = getattr(panel, "COMPAT_ENGINES", set())
        name = panel.__name__
        if name in _TAKEN_IN:
            return True
        is_left_out = "freestyle" in name.lower() or name.startswith(_LEFT_OUT)
        return "BLENDER_RENDER" in compatible and not is_left_out

    return [panel for panel in bpy.types.Panel.__subclasses__() if is_shared(panel)]


def register() -> None:
    for one in CLASSES:
        bpy.utils.register_class(one)
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.add(ImpastoEngine.bl_idname)


def unregister() -> None:
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.discard(ImpastoEngine.bl_idname)
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
