//! A shared handle on one OpenGL context.

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use glow::HasContext as _;

use super::{DriverMessages, GlError, Platform, ShaderTexts};

/// How many contexts were opened so far.
static OPENED: AtomicU64 = AtomicU64::new(0);

thread_local! {
    /// `Shared::id` of the context that was made current last on this thread.
    static CURRENT: Cell<u64> = const { Cell::new(0) };
}

/// A context, shared by everything that was created in it. It is destroyed when its last user is dropped.
#[derive(Clone)]
pub(crate) struct Gpu {
    shared: Rc<Shared>,
}

struct Shared {
    /// The context's number among all that were opened, from 1.
    id: u64,
    gl: Arc<glow::Context>,
    clock: RefCell<Option<PassClock>>,
    messages: Option<DriverMessages>,
    limits: Limits,
    shaders: RefCell<ShaderTexts>,
    platform: Box<dyn Platform>,
}

/// Measures the time from one pass to the next.
struct PassClock {
    since: Instant,
    laps: Vec<(&'static str, f64)>,
    fragments: u64,
}

/// What the driver reports about itself.
#[derive(Clone, Debug)]
pub(crate) struct Limits {
    pub vendor: String,
    pub renderer: String,
    pub version: String,
    pub shading_language: String,
    /// Longest side of a texture that can also be drawn into.
    pub max_side_px: u32,
    pub max_array_layers: u32,
    /// Whether fragment shaders can write into storage buffers (OpenGL 4.3).
    pub has_storage: bool,
    /// The largest storage buffer that a shader can access, in bytes.
    pub max_storage_bytes: usize,
}

impl Limits {
    pub(crate) fn read(gl: &glow::Context) -> Self {
        // SAFETY: the context is current; names that OpenGL 3.3 does not define are asked only of 4.3 or later.
        unsafe {
            let mut viewport = [0; 2];
            gl.get_parameter_i32_slice(glow::MAX_VIEWPORT_DIMS, &mut viewport);
            let side = gl
                .get_parameter_i32(glow::MAX_TEXTURE_SIZE)
                .min(gl.get_parameter_i32(glow::MAX_RENDERBUFFER_SIZE))
                .min(viewport[0])
                .min(viewport[1]);
            let version = gl.version();
            let is_new = (version.major, version.minor) >= (4, 3) && !version.is_embedded;
            let has_storage = is_new && gl.get_parameter_i32(glow::MAX_FRAGMENT_SHADER_STORAGE_BLOCKS) > 0;
            let max_storage =
                if has_storage { gl.get_parameter_i32(glow::MAX_SHADER_STORAGE_BLOCK_SIZE) } else { 0 };
            Self {
                vendor: gl.get_parameter_string(glow::VENDOR),
                renderer: gl.get_parameter_string(glow::RENDERER),
                version: gl.get_parameter_string(glow::VERSION),
                shading_language: gl.get_parameter_string(glow::SHADING_LANGUAGE_VERSION),
                max_side_px: u32::try_from(side).unwrap_or(0),
                max_array_layers: u32::try_from(gl.get_parameter_i32(glow::MAX_ARRAY_TEXTURE_LAYERS))
                    .unwrap_or(0),
                has_storage,
                // A driver may state 2^31 bytes, which overflows an i32.
                max_storage_bytes: if max_storage < 0 { i32::MAX as usize } else { max_storage as usize },
            }
        }
    }
}

impl Gpu {
    pub(crate) fn new(
        gl: Arc<glow::Context>,
        platform: Box<dyn Platform>,
        messages: Option<DriverMessages>,
        limits: Limits,
    ) -> Self {
        let (clock, shaders) = (RefCell::new(None), RefCell::default());
        let id = OPENED.fetch_add(1, Ordering::Relaxed) + 1;
        // The caller has made the context current.
        CURRENT.set(id);
        Self { shared: Rc::new(Shared { id, gl, clock, messages, limits, shaders, platform }) }
    }

    /// Sets the texts that replace shader files in programs created from now on; returns the texts set before.
    pub(crate) fn set_shaders(&self, texts: ShaderTexts) -> ShaderTexts {
        self.shared.shaders.replace(texts)
    }

    pub(super) fn shaders(&self) -> std::cell::Ref<'_, ShaderTexts> {
        self.shared.shaders.borrow()
    }

    pub(super) fn gl(&self) -> &glow::Context {
        &self.shared.gl
    }

    pub(crate) fn limits(&self) -> &Limits {
        &self.shared.limits
    }

    /// Starts to time passes. At the end of each, [`Gpu::lap`] waits for the driver, so a timed frame is slower.
    pub(crate) fn start_clock(&self) {
        *self.shared.clock.borrow_mut() =
            Some(PassClock { since: Instant::now(), laps: Vec::new(), fragments: 0 });
    }

    /// Makes the driver start on the commands issued so far.
    pub(crate) fn flush(&self) {
        // SAFETY: the context is current.
        unsafe { self.gl().flush() };
    }

    /// Waits until everything is drawn.
    pub(crate) fn finish(&self) {
        // SAFETY: the context is current.
        unsafe { self.gl().finish() };
    }

    /// Ends a pass, and notes the time since the last call as the time of this pass. Does nothing unless passes are
    /// timed.
    pub(crate) fn lap(&self, pass: &'static str) {
        if let Some(clock) = self.shared.clock.borrow_mut().as_mut() {
            self.finish();
            clock.laps.push((pass, clock.since.elapsed().as_secs_f64()));
            clock.since = Instant::now();
        }
    }

    /// Runs `draw`; while passes are timed, also counts the fragments that it draws.
    pub(super) fn counting_fragments(&self, draw: impl FnOnce()) {
        let mut clock = self.shared.clock.borrow_mut();
        let Some(clock) = clock.as_mut() else { return draw() };
        let gl = self.gl();
        // SAFETY: the context is current; the query is ended before it is read and deleted.
        unsafe {
            let Ok(query) = gl.create_query() else { return draw() };
            gl.begin_query(glow::SAMPLES_PASSED, query);
            draw();
            gl.end_query(glow::SAMPLES_PASSED);
            clock.fragments += u64::from(gl.get_query_parameter_u32(query, glow::QUERY_RESULT));
            gl.delete_query(query);
        }
    }

    /// Stops timing. Returns the passes with their seconds, in order, and the number of fragments of all quads and
    /// strips.
    pub(crate) fn stop_clock(&self) -> (Vec<(&'static str, f64)>, u64) {
        self.shared.clock.borrow_mut().take().map(|clock| (clock.laps, clock.fragments)).unwrap_or_default()
    }

    /// Whether the driver's debug output is collected.
    pub(crate) fn listens(&self) -> bool {
        self.shared.messages.is_some()
    }

    /// OpenGL's functions, for other code that draws in this context.
    pub(crate) fn functions(&self) -> Arc<glow::Context> {
        self.shared.gl.clone()
    }

    /// Makes the context current on this thread; call it before a series of OpenGL calls.
    pub(crate) fn make_current(&self) -> Result<(), GlError> {
        let Shared { id, platform, .. } = &*self.shared;
        if CURRENT.replace(*id) != *id {
            platform.make_none_current().map_err(GlError::Context)?;
        }
        platform.make_current().map_err(GlError::Context)
    }

    /// What the driver has reported since the last call, as an error.
    pub(crate) fn complaints(&self) -> Result<(), GlError> {
        let messages = self.shared.messages.as_ref().map(DriverMessages::take).unwrap_or_default();
        if messages.is_empty() { Ok(()) } else { Err(GlError::Driver(messages)) }
    }

    /// Checks that the driver had memory for what was just created.
    pub(super) fn check_memory(&self, what: &str) -> Result<(), GlError> {
        // SAFETY: the context is current.
        match unsafe { self.gl().get_error() } {
            glow::NO_ERROR => Ok(()),
            glow::OUT_OF_MEMORY => {
                Err(GlError::Resource { what: what.to_owned(), reason: "out of memory".to_owned() })
            }
            code => Err(GlError::Resource { what: what.to_owned(), reason: format!("error {code:#06x}") }),
        }
    }
}
