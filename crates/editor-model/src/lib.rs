//! Everything that the editor decides, without a window: document, commands, undo, tools, picking.
