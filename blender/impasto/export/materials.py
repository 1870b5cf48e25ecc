"""Materials as glTF has them."""

from dataclasses import dataclass, field
from typing import Any

import bpy

from . import surfaces
from .glb import Glb
from .images import picture_bytes
from .picture_use import PictureUse
from .shader_colors import Color


@dataclass
class Surface:
    """A material in the file, and what of a mesh it shows."""

    index: int
    uv_map: str
    color_attribute: str | None


@dataclass
class MaterialTable:
    """The materials that were met."""

    glb: Glb
    warnings: list[str]
    _by_name: dict[str, Surface] = field(default_factory=dict)
    _pictures: dict[str, int | None] = field(default_factory=dict)

    def surface(self, material: bpy.types.Material | None) -> Surface:
        """The material's entry in the file; for `None` (faces without a material) that of a plain grey."""
        name = "" if material is None else material.name_full
        if name not in self._by_name:
            self._by_name[name] = self._made(material)
        return self._by_name[name]

    def _made(self, material: bpy.types.Material | None) -> Surface:
        if material is None:
            plain = {"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1.0], "metallicFactor": 0.0,
                                              "roughnessFactor": 0.5}, "doubleSided": True}
            return Surface(self.glb.add("materials", plain), "", None)
        look = surfaces.look_of(material)
        base = look.base
        item: dict[str, Any] = {"name": material.name}
        pbr: dict[str, Any] = {}
        base_texture = self._texture(base.picture, look.lost)
        if base.picture is not None and base_texture is None:
            base = Color((0.8, 0.8, 0.8), attribute=base.attribute)
        alpha = look.alpha
        pbr["baseColorFactor"] = [*(min(max(part, 0.0), 1.0) for part in base.factor), alpha]
        if base_texture is not None:
            pbr["baseColorTexture"] = base_texture
        pbr["metallicFactor"], pbr["roughnessFactor"] = look.metallic, look.roughness
        item["pbrMetallicRoughness"] = pbr
        if look.has_picture_alpha:
            item["alphaMode"], item["alphaCutoff"] = "MASK", 0.5
        elif alpha < 1.0:
            item["alphaMode"] = "BLEND"
        if look.is_unlit:
            self.glb.use("KHR_materials_unlit")
            item["extensions"] = {"KHR_materials_unlit": {}}
        else:
            self._emission(item, look)
        if not material.use_backface_culling:
            item["doubleSided"] = True
        lost = list(dict.fromkeys([*look.lost, *base.lost]))
        if lost:
            is_shader = any("but the colour" in words for words in lost)
            mend = "only a Principled BSDF is carried whole" if is_shader else "bake its colour to a picture"
            self.warnings.append(f'Material "{material.name}" loses {", ".join(lost)}: {mend}.')
        uses = [use for use in (look.base.picture, look.emission.picture) if use is not None]
        return Surface(self.glb.add("materials", item), uses[0].uv_map if uses else "", base.attribute)

    def _emission(self, item: dict[str, Any], look: "surfaces.Look") -> None:
        light = look.emission.times((look.emission_strength,) * 3).factor
        largest = max(light)
        if largest <= 0.0:
            return
        texture = self._texture(look.emission.picture, look.lost)
        if look.emission.picture is not None and texture is None:
            return
        if texture is not None:
            item["emissiveTexture"] = texture
        item["emissiveFactor"] = [max(part, 0.0) / max(largest, 1.0) for part in light]
        if largest > 1.0:
            self.glb.use("KHR_materials_emissive_strength")
            item["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": largest}}

    def _texture(self, use: PictureUse | None, lost: list[str]) -> dict[str, Any] | None:
        if use is None:
            return None
        image = use.image if use.image.original is None else use.image.original
        if image.name_full not in self._pictures:
            self._pictures[image.name_full] = self._picture(image)
        picture = self._pictures[image.name_full]
        if picture is None:
            lost.append(f'its picture "{image.name}", which is not there (find or pack it)')
            return None
        sampler = {"wrapS": use.wrap, "wrapT": use.wrap}
        if use.is_nearest:
            sampler["magFilter"] = 9728
        texture = {"source": picture, "sampler": self.glb.add_once("samplers", sampler)}
        info: dict[str, Any] = {"index": self.glb.add_once("textures", texture)}
        if use.transform is not None:
            self.glb.use("KHR_texture_transform")
            info["extensions"] = {"KHR_texture_transform": use.transform}
        return info

    def _picture(self, image: bpy.types.Image) -> int | None:
        content = picture_bytes(image)
        if content is None:
            return None
        return self.glb.add("images", {"name": image.name, "mimeType": content[1],
                                       "bufferView": self.glb.view(content[0])})

