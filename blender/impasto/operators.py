"""Export for Impasto, and taking a setting back."""

from __future__ import annotations

import bpy

from . import export_request, painting, scene_file, settings
from .failure import Failure


class IMPASTO_OT_export(bpy.types.Operator):
    """Write the shot into the painting's folder, where anything has changed. The folder renders without Blender"""

    bl_idname = "impasto.export"
    bl_label = "Export for Impasto"

    anew: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Anew", description="Also where nothing has changed"
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            warnings = export_request.export(context.scene, anew=self.anew)
            place = painting.of_scene(context.scene)
            warnings = [*warnings, *scene_file.problems(place.scene_file)]
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        for words in warnings:
            self.report({"WARNING"}, words)
        self.report({"INFO"}, f"The shot is in {place.folder}")
        return {"FINISHED"}


class IMPASTO_OT_take_back(bpy.types.Operator):
    """Take this setting out of the scene file: it is as around it again"""

    bl_idname = "impasto.take_back"
    bl_label = "Take Back"
    bl_options = {"INTERNAL"}

    field: bpy.props.StringProperty()  # type: ignore[valid-type]
    of: bpy.props.EnumProperty(  # type: ignore[valid-type]
        items=[(kind, kind.capitalize(), "") for kind in ("SCENE", "OBJECT", "COLLECTION", "MATERIAL")]
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not self.field:
            self.report({"ERROR"}, 'Which setting? Name it: field="scale"')
            return {"CANCELLED"}
        owner = {
            "SCENE": context.scene,
            "OBJECT": context.object,
            "COLLECTION": context.collection,
            "MATERIAL": context.material if hasattr(context, "material") else None,
        }[self.of]
        if owner is None:
            return {"CANCELLED"}
        try:
            settings.state(owner, self.field, "")
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        return {"FINISHED"}


class IMPASTO_OT_standard_view(bpy.types.Operator):
    """Show the paint in its own colours: set the view transform to Standard"""

    bl_idname = "impasto.standard_view"
    bl_label = "Set to Standard"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        context.scene.view_settings.view_transform = "Standard"
        context.scene.view_settings.look = "None"
        return {"FINISHED"}


CLASSES = (IMPASTO_OT_export, IMPASTO_OT_take_back, IMPASTO_OT_standard_view)


def register() -> None:
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister() -> None:
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
