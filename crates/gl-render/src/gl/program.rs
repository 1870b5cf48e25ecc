//! Shader programs. Their uniforms are set by name, and the names are checked when the program is created.

use std::cell::Cell;

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};
use glow::HasContext as _;

use super::shader_text::{Expanded, Sources, expand};
use super::{GlError, Gpu, ShaderFile, Texture};

#[derive(Clone, Copy, Debug)]
pub(crate) struct ProgramSource<'a> {
    /// Path of the vertex shader below `shaders/`.
    pub vertex: &'static str,
    /// Path of the fragment shader; `None` where only the vertex shader's outputs are captured.
    pub fragment: Option<&'static str>,
    /// Outputs of the vertex shader that are captured into a buffer.
    pub captured: &'static [&'static str],
    /// Every uniform that the Rust side sets, in groups.
    pub uniforms: &'a [&'a [&'static str]],
    /// Further uniforms, in groups, which the shader may leave out; setting one that is left out does nothing.
    pub optional: &'a [&'a [&'static str]],
    /// What is `#define`d for the shaders: names, or a name and its value, as in `LAYER 0`.
    pub defined: &'a [&'static str],
}

impl<'a> ProgramSource<'a> {
    /// A program of these shaders and uniforms, with nothing captured and nothing defined.
    pub(crate) const fn new(
        vertex: &'static str,
        fragment: Option<&'static str>,
        uniforms: &'a [&'a [&'static str]],
    ) -> Self {
        Self { vertex, fragment, captured: &[], uniforms, optional: &[], defined: &[] }
    }

    /// A pass over every pixel of the picture.
    pub(crate) const fn screen(fragment: &'static str, uniforms: &'a [&'a [&'static str]]) -> Self {
        Self::new("shared/screen.vert", Some(fragment), uniforms)
    }
}

pub(crate) struct Program {
    gpu: Gpu,
    id: glow::Program,
    name: String,
    uniforms: Vec<Uniform>,
    /// Uniforms that the shader may leave out.
    optional: Vec<&'static str>,
    /// Whether a user's text replaces some shader file. If so, any uniform may be missing.
    is_replaced: bool,
}

struct Uniform {
    name: String,
    location: glow::UniformLocation,
    kind: u32,
    /// The texture unit of a sampler.
    unit: Option<u32>,
    was_set: Cell<bool>,
}

/// A value for a uniform.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Value {
    Float(f32),
    Int(i32),
    Uint(u32),
    Vec2(Vec2),
    Vec3(Vec3),
    Vec4(Vec4),
    Mat3(Mat3),
    Mat4(Mat4),
}

macro_rules! value_from {
    ($($kind:ty => $variant:ident),*) => {
        $(impl From<$kind> for Value {
            fn from(value: $kind) -> Self {
                Value::$variant(value)
            }
        })*
    };
}
value_from!(f32 => Float, i32 => Int, u32 => Uint, Vec2 => Vec2, Vec3 => Vec3, Vec4 => Vec4, Mat3 => Mat3, Mat4 => Mat4);

impl Program {
    /// Compiles and links the program. Compares the shader's uniforms with those that the Rust side knows.
    pub(crate) fn new(
        gpu: &Gpu,
        files: &[&[ShaderFile]],
        source: &ProgramSource<'_>,
    ) -> Result<Self, GlError> {
        let name = source.fragment.unwrap_or(source.vertex).to_owned();
        let fault = |log: String| GlError::Shader { program: name.clone(), log };
        let gl = gpu.gl();
        // SAFETY: the context is current.
        let id = unsafe { gl.create_program() }.map_err(fault)?;
        let mut program = Self {
            gpu: gpu.clone(),
            id,
            name: name.clone(),
            uniforms: Vec::new(),
            optional: source.optional.concat(),
            is_replaced: !gpu.shaders().is_empty(),
        };
        let stages = [(glow::VERTEX_SHADER, Some(source.vertex)), (glow::FRAGMENT_SHADER, source.fragment)];
        for (stage, path) in stages {
            if let Some(path) = path {
                let sources = Sources { files, replaced: &gpu.shaders() };
                let expanded = expand(sources, path, source.defined).map_err(fault)?;
                program.attach(stage, &expanded).map_err(fault)?;
            }
        }
        // SAFETY: the context is current; the shaders are attached.
        unsafe {
            if !source.captured.is_empty() {
                gl.transform_feedback_varyings(id, source.captured, glow::INTERLEAVED_ATTRIBS);
            }
            gl.link_program(id);
            if !gl.get_program_link_status(id) {
                return Err(fault(gl.get_program_info_log(id)));
            }
        }
        program.reflect();
        program.compare(&source.uniforms.concat())?;
        Ok(program)
    }

    fn attach(&self, stage: u32, expanded: &Expanded) -> Result<(), String> {
        let gl = self.gpu.gl();
        // SAFETY: the context is current; a shader that is attached lives until its program goes.
        unsafe {
            let shader = gl.create_shader(stage)?;
            gl.shader_source(shader, &expanded.text);
            gl.compile_shader(shader);
            let log = (!gl.get_shader_compile_status(shader)).then(|| gl.get_shader_info_log(shader));
            if log.is_none() {
                gl.attach_shader(self.id, shader);
            }
            gl.delete_shader(shader);
            log.map_or(Ok(()), |log| Err(expanded.name_places(&log)))
        }
    }

    /// Lists the uniforms of the linked program, and gives each sampler a texture unit of its own.
    fn reflect(&mut self) {
        let gl = self.gpu.gl();
        let mut next_unit = 0;
        // SAFETY: the context is current and the program is linked.
        unsafe {
            gl.use_program(Some(self.id));
            for index in 0..gl.get_active_uniforms(self.id) {
                let Some(active) = gl.get_active_uniform(self.id, index) else { continue };
                let Some(location) = gl.get_uniform_location(self.id, &active.name) else { continue };
                let is_sampler = matches!(
                    active.utype,
                    glow::SAMPLER_2D | glow::SAMPLER_2D_ARRAY | glow::SAMPLER_2D_SHADOW
                );
                let unit = is_sampler.then_some(next_unit);
                if let Some(unit) = unit {
                    gl.uniform_1_i32(Some(&location), unit as i32);
                    next_unit += 1;
                }
                let was_set = Cell::new(false);
                self.uniforms.push(Uniform {
                    name: active.name,
                    location,
                    kind: active.utype,
                    unit,
                    was_set,
                });
            }
            gl.use_program(None);
        }
    }

    fn compare(&self, known: &[&str]) -> Result<(), GlError> {
        let is_known = |name: &str| known.contains(&name) || self.optional.contains(&name);
        let unknown = self.uniforms.iter().find(|uniform| !is_known(&uniform.name));
        if let Some(uniform) = unknown {
            return Err(self.fault(&uniform.name, "is not known to the Rust side"));
        }
        let unused = known.iter().find(|name| self.find(name).is_none() && !self.may_lack(name));
        unused.map_or(Ok(()), |name| Err(self.fault(name, "is not used by the shader")))
    }

    fn find(&self, name: &str) -> Option<&Uniform> {
        self.uniforms.iter().find(|uniform| uniform.name == name)
    }

    fn may_lack(&self, uniform: &str) -> bool {
        self.is_replaced || self.optional.contains(&uniform)
    }

    fn fault(&self, uniform: &str, fault: &'static str) -> GlError {
        GlError::Uniform { program: self.name.clone(), uniform: uniform.to_owned(), fault }
    }

    /// Starts a draw. Textures must be bound for every draw; other values stay until they are set again.
    pub(crate) fn bind(&self) -> Bound<'_> {
        // SAFETY: the context is current and the program is linked.
        unsafe { self.gpu.gl().use_program(Some(self.id)) };
        for uniform in &self.uniforms {
            if uniform.unit.is_some() {
                uniform.was_set.set(false);
            }
        }
        Bound { program: self, fault: None }
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        if self.gpu.make_current().is_ok() {
            // SAFETY: the context is current and the program was made in it.
            unsafe { self.gpu.gl().delete_program(self.id) };
        }
    }
}

/// A program with the values of one draw. The first mistake is remembered, and the draw returns it.
pub(crate) struct Bound<'a> {
    program: &'a Program,
    fault: Option<GlError>,
}

impl Bound<'_> {
    /// Sets a uniform.
    pub(crate) fn set(mut self, name: &str, value: impl Into<Value>) -> Self {
        let value = value.into();
        match self.program.find(name) {
            Some(uniform) if uniform.kind == value.kind() => {
                uniform.was_set.set(true);
                self.send(&uniform.location, value);
            }
            Some(_) => self.keep(name, "has another type in the shader"),
            None if self.program.may_lack(name) => {}
            None => self.keep(name, "does not exist"),
        }
        self
    }

    /// Binds a texture to a sampler.
    pub(crate) fn texture(mut self, name: &str, texture: &Texture) -> Self {
        match self.program.find(name).and_then(|uniform| uniform.unit.map(|unit| (uniform, unit))) {
            Some((uniform, unit)) => {
                uniform.was_set.set(true);
                let gl = self.program.gpu.gl();
                // SAFETY: the context is current and the texture was made in it.
                unsafe {
                    gl.active_texture(glow::TEXTURE0 + unit);
                    gl.bind_texture(texture.kind(), Some(texture.id()));
                    gl.bind_sampler(unit, None);
                }
            }
            None if self.program.may_lack(name) && self.program.find(name).is_none() => {}
            None => self.keep(name, "is not a sampler of the shader"),
        }
        self
    }

    fn keep(&mut self, name: &str, fault: &'static str) {
        self.fault.get_or_insert_with(|| self.program.fault(name, fault));
    }

    fn send(&self, location: &glow::UniformLocation, value: Value) {
        let gl = self.program.gpu.gl();
        let at = Some(location);
        // SAFETY: the context is current, the program in use, and the type has been compared.
        unsafe {
            match value {
                Value::Float(x) => gl.uniform_1_f32(at, x),
                Value::Int(x) => gl.uniform_1_i32(at, x),
                Value::Uint(x) => gl.uniform_1_u32(at, x),
                Value::Vec2(v) => gl.uniform_2_f32(at, v.x, v.y),
                Value::Vec3(v) => gl.uniform_3_f32(at, v.x, v.y, v.z),
                Value::Vec4(v) => gl.uniform_4_f32(at, v.x, v.y, v.z, v.w),
                Value::Mat3(m) => gl.uniform_matrix_3_f32_slice(at, false, &m.to_cols_array()),
                Value::Mat4(m) => gl.uniform_matrix_4_f32_slice(at, false, &m.to_cols_array()),
            }
        }
    }

    pub(super) fn finish(self) -> Result<(), GlError> {
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        let forgotten = self.program.uniforms.iter().find(|uniform| !uniform.was_set.get());
        forgotten.map_or(Ok(()), |uniform| Err(self.program.fault(&uniform.name, "was never set")))
    }
}

impl Value {
    fn kind(self) -> u32 {
        match self {
            Value::Float(_) => glow::FLOAT,
            Value::Int(_) => glow::INT,
            Value::Uint(_) => glow::UNSIGNED_INT,
            Value::Vec2(_) => glow::FLOAT_VEC2,
            Value::Vec3(_) => glow::FLOAT_VEC3,
            Value::Vec4(_) => glow::FLOAT_VEC4,
            Value::Mat3(_) => glow::FLOAT_MAT3,
            Value::Mat4(_) => glow::FLOAT_MAT4,
        }
    }
}
