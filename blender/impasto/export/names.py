"""Names of nodes: an object's own, or `Instancer/Object` for an instance."""

import bpy

from .things import Key

_NO_NUMBER = 0x7FFFFFFF


def is_own_mesh(instance: bpy.types.DepsgraphObjectInstance) -> bool:
    """Whether an instance is really the object itself: the mesh of a curve, text or metaball is listed as its instance."""
    if not instance.is_instance or instance.parent is None:
        return False
    same = instance.parent.original == instance.object.original
    return same and instance.parent.original.type != "MESH" and list(instance.persistent_id)[1] == _NO_NUMBER


def key_of(instance: bpy.types.DepsgraphObjectInstance) -> Key:
    """What tells a thing from all others, the same in every frame."""
    original = instance.object.original
    name = instance.object.name_full if original is None else original.name_full
    if not instance.is_instance:
        return (name,)
    parent = "" if instance.parent is None else instance.parent.original.name_full
    return (parent, name, instance.object.type, tuple(instance.persistent_id))


class Names:
    """Hands out names, each once."""

    def __init__(self) -> None:
        self._taken: set[str] = set()
        self._next: dict[str, int] = {}
        # Objects keep their names, whatever instances are called.
        self._objects = {thing.name for thing in bpy.data.objects}

    def of(self, instance: bpy.types.DepsgraphObjectInstance) -> str:
        """A name, not given before, for a thing that turns up for the first time."""
        own = instance.object.name
        if not instance.is_instance or is_own_mesh(instance):
            return self.unique(own, is_object=True)
        parent = instance.parent.name if instance.parent is not None else ""
        return self.unique(f"{parent}/{own}", is_object=False)

    def unique(self, wanted: str, *, is_object: bool) -> str:
        """The name, or with the next free number behind it."""
        name, number = wanted, self._next.get(wanted, 1)
        while name in self._taken or (not is_object and name in self._objects):
            name = f"{wanted}.{number:03}"
            number += 1
        self._next[wanted] = number
        self._taken.add(name)
        return name
