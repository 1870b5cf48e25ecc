//! Opens a window with every control of the editor, to look at and try:
//! `cargo run -p impasto-editor --example gallery -- [light] [busy]`.
//!
//! `busy` draws without a pause and prints how long a frame takes.

#[path = "../tests/it/page/mod.rs"]
mod page;

use impasto_editor::theme::{self, Theme};
use impasto_editor::window::{App, Frame, Options, WindowError, run};
use page::Page;

struct Gallery {
    page: Page,
    shown: Theme,
    busy: bool,
    frames: u32,
}

impl App for Gallery {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut Frame<'_>) {
        if self.shown != self.page.theme {
            self.shown = self.page.theme;
            theme::apply(ui.ctx(), self.shown, 1.0);
        }
        self.page.ui(ui);
        self.frames += 1;
        if self.busy {
            ui.ctx().request_repaint();
            if self.frames.is_multiple_of(60) {
                eprintln!("{:.1} ms", frame.last_took().as_secs_f64() * 1000.0);
            }
        }
    }

    fn title(&self) -> String {
        "Impasto: controls".to_owned()
    }
}

fn main() -> Result<(), WindowError> {
    let has = |word: &str| std::env::args().any(|argument| argument == word);
    let shown = if has("light") { Theme::Light } else { Theme::Dark };
    let busy = has("busy");
    run(Options::default(), |opened| {
        theme::apply(&opened.ctx, shown, 1.0);
        Gallery { page: Page::new(shown), shown, busy, frames: 0 }
    })
}
