//! Icons, named by what they mean. The glyphs are Material Symbols Rounded.

use egui_material_icons::icons as glyphs;

/// One icon: draw it with [`crate::theme::type_face::icon`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Icon(&'static str);

impl Icon {
    /// The glyph in the icon font.
    pub fn glyph(self) -> &'static str {
        self.0
    }
}

macro_rules! icons {
    ($($(#[$doc:meta])* $name:ident = $glyph:ident;)*) => {
        $($(#[$doc])* pub const $name: Icon = Icon(glyphs::$glyph.codepoint);)*
        #[cfg(test)]
        const ALL: &[(&str, Icon)] = &[$((stringify!($name), $name)),*];
    };
}

icons! {
    /// The comb.
    COMB = ICON_AIR;
    /// Guide curve.
    GUIDE = ICON_TIMELINE;
    /// Fill direction.
    FILL = ICON_FORMAT_COLOR_FILL;
    /// Turn direction.
    TURN = ICON_ROTATE_RIGHT;
    /// Smooth.
    SMOOTH = ICON_BLUR_ON;
    /// Erase to automatic.
    ERASE = ICON_INK_ERASER;
    /// Paint amount.
    AMOUNT = ICON_LINE_WEIGHT;
    /// Touch: a stroke placed by hand.
    TOUCH = ICON_GESTURE;
    /// Region brush.
    REGION = ICON_LASSO_SELECT;
    /// Pick direction.
    PICK = ICON_COLORIZE;
    /// Select.
    SELECT = ICON_ARROW_SELECTOR_TOOL;
    /// Move.
    MOVE = ICON_OPEN_WITH;
    /// Rotate.
    ROTATE = ICON_3D_ROTATION;
    /// Scale.
    SCALE = ICON_OPEN_IN_FULL;
    /// Light.
    LIGHT = ICON_LIGHT_MODE;
    /// Camera.
    CAMERA = ICON_VIDEOCAM;
    /// Object.
    OBJECT = ICON_CATEGORY;
    /// Backdrop.
    BACKDROP = ICON_WALLPAPER;
    /// Table.
    TABLE = ICON_TABLE_RESTAURANT;
    /// Reference.
    REFERENCE = ICON_PUSH_PIN;
    /// Direction lines.
    DIRECTIONS = ICON_GRASS;
    /// Trust.
    TRUST = ICON_THERMOSTAT;
    /// Regions.
    REGIONS = ICON_SHAPES;
    /// Grid.
    GRID = ICON_GRID_ON;
    /// Compare.
    COMPARE = ICON_COMPARE;
    /// Shading.
    SHADING = ICON_PALETTE;
    /// First frame.
    FIRST_FRAME = ICON_FIRST_PAGE;
    /// Previous frame.
    PREVIOUS_FRAME = ICON_CHEVRON_LEFT;
    /// Play.
    PLAY = ICON_PLAY_ARROW;
    /// Pause.
    PAUSE = ICON_PAUSE;
    /// Next frame.
    NEXT_FRAME = ICON_CHEVRON_RIGHT;
    /// Last frame.
    LAST_FRAME = ICON_LAST_PAGE;
    /// Loop.
    LOOP = ICON_REPEAT;
    /// Finish frames.
    FINISH = ICON_AUTO_AWESOME_MOTION;
    /// Key.
    KEY = ICON_DIAMOND;
    /// Dropped frames.
    DROPPED = ICON_SPEED;
    /// Render.
    RENDER = ICON_MOVIE;
    /// Search.
    SEARCH = ICON_SEARCH;
    /// Add.
    ADD = ICON_ADD;
    /// More options.
    MORE_OPTIONS = ICON_TUNE;
    /// Visible.
    VISIBLE = ICON_VISIBILITY;
    /// Hidden.
    HIDDEN = ICON_VISIBILITY_OFF;
    /// Locked.
    LOCKED = ICON_LOCK;
    /// Unlocked.
    UNLOCKED = ICON_LOCK_OPEN;
    /// Undo.
    UNDO = ICON_UNDO;
    /// Redo.
    REDO = ICON_REDO;
    /// Warning.
    WARNING = ICON_WARNING;
    /// Error.
    ERROR = ICON_ERROR;
    /// Done.
    DONE = ICON_CHECK_CIRCLE;
    /// Open folder.
    OPEN_FOLDER = ICON_FOLDER_OPEN;
    /// Refresh.
    REFRESH = ICON_REFRESH;
    /// Open outside.
    OPEN_OUTSIDE = ICON_OPEN_IN_NEW;
    /// Copy.
    COPY = ICON_CONTENT_COPY;
    /// Close.
    CLOSE = ICON_CLOSE;
    /// Link.
    LINK = ICON_LINK;
    /// Arrange.
    ARRANGE = ICON_OPEN_WITH;
    /// Paint.
    PAINT = ICON_BRUSH;
    /// Animate.
    ANIMATE = ICON_ANIMATION;
    /// App.
    APP = ICON_BRUSH;
    /// Menu down.
    MENU_DOWN = ICON_ARROW_DROP_DOWN;
    /// Expanded.
    EXPANDED = ICON_ARROW_DROP_DOWN;
    /// Folded.
    FOLDED = ICON_ARROW_RIGHT;
    /// Check.
    CHECK = ICON_CHECK;
    /// Keys up.
    KEYS_UP = ICON_KEYBOARD_ARROW_UP;
    /// The curves between keys.
    CURVES = ICON_LINE_CURVE;
    /// Keys down.
    KEYS_DOWN = ICON_KEYBOARD_ARROW_DOWN;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_icon_is_in_the_font() {
        let ctx = egui::Context::default();
        crate::theme::apply(&ctx, crate::theme::Theme::Dark, 1.0);
        let output = ctx.run_ui(egui::RawInput::default(), |ui| {
            for (name, icon) in ALL {
                let found = ui
                    .fonts_mut(|fonts| fonts.has_glyphs(&crate::theme::type_face::icon(18.0), icon.glyph()));
                assert!(found, "{name} is not in the icon font");
            }
        });
        output.drop_without_applying_deltas();
    }
}
