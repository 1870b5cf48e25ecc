"""Impasto as a render engine of Blender: F12 paints the shot."""

from . import engine, guides, live, operators, panels, preferences, settings
from .painter import stop_all_painters

MODULES = (preferences, settings, engine, operators, guides, live, panels)


def register() -> None:
    for module in MODULES:
        module.register()


def unregister() -> None:
    for module in reversed(MODULES):
        module.unregister()
    stop_all_painters()
