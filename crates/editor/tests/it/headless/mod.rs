//! Draws pictures of egui pages without a display, for the editor's tests: with egui's painter, in the renderer's own
//! off-screen context.

use egui::{TexturesDelta, Vec2};
use egui_glow::Painter;
use egui_kittest::{Harness, TestRenderer};
use glow::HasContext as _;
use impasto_editor::theme::{self, Theme};
use impasto_editor::window::FocusRules;
use impasto_gl_render::context::{Context, Driver, OpenOptions, open};

/// Draws a harness's page. The painter is destroyed before its context.
pub struct Headless {
    painter: Painter,
    context: Context,
}

impl Headless {
    pub fn open(driver: Driver) -> Self {
        let context = open(driver, &OpenOptions::default()).expect("an off-screen context");
        let painter = Painter::new(context.glow(), "", None, false).expect("egui's shaders compile");
        Self { painter, context }
    }
}

/// A harness that draws a page in this theme, and has already run until the page settled. `ui` is one pass of the page.
pub fn harness<P: 'static>(
    size: Vec2,
    theme: Theme,
    page: P,
    ui: fn(&mut egui::Ui, &mut P),
) -> Harness<'static, P> {
    let mut harness = Harness::builder()
        .with_size(size)
        .with_theme(if theme == Theme::Dark { egui::Theme::Dark } else { egui::Theme::Light })
        .with_render_cursor(false)
        .with_context_setup(move |ctx| {
            theme::apply(ctx, theme, 1.0);
            ctx.add_plugin(FocusRules);
        })
        .renderer(Headless::open(Driver::Auto))
        .build_ui_state(ui, page);
    harness.run();
    harness
}

impl TestRenderer for Headless {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        self.context.make_current().expect("the context is there");
        for (id, images) in delta.set.drain() {
            for image in images {
                self.painter.set_texture(id, &image);
            }
        }
        for id in delta.free.drain() {
            self.painter.free_texture(id);
        }
    }

    fn render(&mut self, ctx: &egui::Context, output: &egui::FullOutput) -> Result<image::RgbaImage, String> {
        self.context.make_current()?;
        let scale = ctx.pixels_per_point();
        let size = ctx.content_rect().size() * scale;
        let [width, height] = [size.x.round() as u32, size.y.round() as u32];
        let primitives = ctx.tessellate(output.shapes.clone(), scale);
        let gl = self.context.glow();
        let mut pixels = vec![0; width as usize * height as usize * 4];
        draw(&gl, [width, height], &mut pixels, || {
            self.painter.clear([width, height], [0.0, 0.0, 0.0, 1.0]);
            self.painter.paint_primitives([width, height], scale, &primitives);
        });
        let image =
            image::RgbaImage::from_raw(width, height, pixels).ok_or("the picture has another size")?;
        Ok(image::imageops::flip_vertical(&image))
    }
}

impl Drop for Headless {
    fn drop(&mut self) {
        if self.context.make_current().is_ok() {
            self.painter.destroy();
        }
    }
}

/// Lets `paint` draw into a new framebuffer, and reads that into `pixels`, the bottom row first.
#[expect(unsafe_code, reason = "OpenGL calls on a context that is current")]
fn draw(gl: &glow::Context, [width, height]: [u32; 2], pixels: &mut [u8], paint: impl FnOnce()) {
    // SAFETY: the context is current on this thread, and `pixels` is as large as what is read into it.
    unsafe {
        let target = gl.create_framebuffer().expect("a framebuffer");
        let colour = gl.create_renderbuffer().expect("a renderbuffer");
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(colour));
        gl.renderbuffer_storage(glow::RENDERBUFFER, glow::RGBA8, width as i32, height as i32);
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target));
        gl.framebuffer_renderbuffer(
            glow::FRAMEBUFFER,
            glow::COLOR_ATTACHMENT0,
            glow::RENDERBUFFER,
            Some(colour),
        );
        paint();
        let out = glow::PixelPackData::Slice(Some(pixels));
        gl.read_pixels(0, 0, width as i32, height as i32, glow::RGBA, glow::UNSIGNED_BYTE, out);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        gl.delete_framebuffer(target);
        gl.delete_renderbuffer(colour);
    }
}
