//! Tests that `crates/gl-render/shaders/shared/inverse_bilinear.glsl` finds what the same function in `core` finds, on
//! both drivers.

use std::rc::Rc;

use glam::{DVec2, Vec2};
use impasto_core::hash;
use impasto_core::inverse_bilinear::{bilinear, inverse_bilinear};

use crate::context::{Driver, OpenOptions, open};
use crate::gl::{
    Attribute, Buffer, BufferUse, DrawState, Filter, Format, Framebuffer, Program, ProgramSource, Records,
    ShaderFile, Texture, VertexArray,
};
use crate::shader_files::SHARED;

const PROBE: &[ShaderFile] = &[ShaderFile {
    path: "probe.vert",
    text: "#include \"shared/inverse_bilinear.glsl\"
layout(location = 0) in vec4 first_two;
layout(location = 1) in vec4 last_two;
layout(location = 2) in vec2 point;
out vec2 found;
void main() {
    found = inverse_bilinear(point, first_two.xy, first_two.zw, last_two.xy, last_two.zw);
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
",
}];

/// The corners of a quad at (u, v) = (0, 0), (1, 0), (0, 1) and (1, 1), and a point: the inputs of one vertex.
type Question = [Vec2; 5];

/// What the shader finds on this driver.
fn found_by(driver: Driver, questions: &[Question]) -> Vec<[f32; 2]> {
    let context = open(driver, &OpenOptions { debug: true }).unwrap_or_else(|error| panic!("{error}"));
    let gpu = context.gpu();
    let source = ProgramSource { captured: &["found"], ..ProgramSource::new("probe.vert", None, &[]) };
    let program = Program::new(gpu, &[PROBE, SHARED], &source).expect("it compiles");
    let mut input = Buffer::new(gpu, BufferUse::Fixed).expect("there is room");
    input
        .upload(bytemuck::cast_slice(
            questions.as_flattened().iter().flat_map(Vec2::to_array).collect::<Vec<f32>>().as_slice(),
        ))
        .expect("there is room");
    let mut output = Buffer::new(gpu, BufferUse::ReadBack).expect("there is room");
    output.reserve(questions.len() * 8).expect("there is room");
    let attribute = |location: u32, components: i32| Attribute {
        location,
        buffer: &input,
        components,
        integer: false,
        stride_bytes: 40,
        offset_bytes: location as i32 * 16,
        per_instance: false,
    };
    let array = VertexArray::new(gpu, &[attribute(0, 4), attribute(1, 4), attribute(2, 2)], None)
        .expect("there is room");
    // Without a window there is nothing to draw on until a framebuffer is made.
    let target =
        Rc::new(Texture::target(gpu, Format::Rgba8, [1, 1], Filter::Nearest).expect("there is room"));
    let target = Framebuffer::new(gpu, &[&target], None).expect("it is complete");
    gpu.begin_pass(&target, DrawState::default());
    let records = Records { first: 0, count: questions.len() as u32, record_bytes: 8 };
    gpu.capture(program.bind(), &array, &output, records).expect("it runs");
    gpu.complaints().expect("the driver has no complaints");
    bytemuck::pod_collect_to_vec(&output.read(questions.len() * 8))
}

/// A convex quad with a point inside, in pixels. As `index` rises, the quad is in turn a general quad, a trapezoid, a
/// parallelogram, a rectangle and a square. Quads are wound either way, and the two edges at their first corner are 10
/// to 300 pixels long.
fn convex(index: u32) -> Question {
    let chance = |which: u32| f64::from(hash::unit(hash::combine(index, which)));
    let between = |which: u32, low: f64, high: f64| low + (high - low) * chance(which);
    let turn = DVec2::from_angle(between(0, 0.0, std::f64::consts::TAU));
    let (length, other) = (between(1, 10.0, 300.0), between(2, 10.0, 300.0));
    let winding = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    let corner_deg = if index % 5 > 2 { 90.0 } else { between(3, 25.0, 155.0) };
    let b1 = turn * length;
    let b2 = turn.rotate(DVec2::from_angle(winding * corner_deg.to_radians()))
        * if index % 5 == 4 { length } else { other };
    let (s, t) = match index % 5 {
        0 => {
            let s = between(4, 0.3, 2.5);
            (s, between(5, (1.3 - s).max(0.3), 2.5))
        }
        1 => (between(4, 0.1, 2.0), 1.0),
        _ => (1.0, 1.0),
    };
    let p0 = DVec2::new(between(6, -200.0, 200.0), between(7, -200.0, 200.0));
    let corners = [p0, p0 + b1, p0 + b2, p0 + b1 * s + b2 * t];
    let point = bilinear(DVec2::new(chance(8), chance(9)), corners);
    [corners[0], corners[1], corners[2], corners[3], point].map(|at| at.as_vec2())
}

#[test]
fn the_shader_finds_what_the_processor_finds_in_200000_convex_quads() {
    let questions: Vec<Question> = (0..200_000).map(convex).collect();
    for driver in [Driver::Egl, Driver::Osmesa] {
        let found = found_by(driver, &questions);
        let mut worst = 0.0_f64;
        for (question, found) in questions.iter().zip(&found) {
            let [p0, p1, p2, p3, point] = question.map(|at| at.as_dvec2());
            let wanted = inverse_bilinear(point, [p0, p1, p2, p3]);
            let off = (Vec2::from(*found).as_dvec2() - wanted).abs().max_element();
            assert!(off <= 1e-4, "{driver}: {question:?} gives {found:?}, not {wanted}");
            worst = worst.max(off);
        }
        println!("{driver}: off by at most {worst:e}");
    }
}

#[test]
fn quads_without_an_answer_give_bounded_numbers() {
    let at = |x: f32, y: f32| Vec2::new(x, y);
    let quads = [
        [at(3.0, 4.0); 4],                                          // a point
        [at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0), at(3.0, 0.0)],   // a line
        [at(0.0, 0.0), at(10.0, 0.0), at(0.0, 0.0), at(10.0, 0.0)], // twice the same edge
        [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)], // crosses itself: the last two are swapped
        [at(0.0, 0.0), at(0.0, 0.0), at(0.0, 9.0), at(9.0, 9.0)], // a triangle
        [at(0.0, 0.0), at(10.0, 0.0), at(0.0, 10.0), at(2.0, 2.0)], // concave
    ];
    let places = [at(0.0, 0.0), at(3.0, 4.0), at(0.5, 0.5), at(-1e4, 7e3), at(1.0, 0.0), at(2.0, 2.0)];
    let questions: Vec<Question> =
        quads.iter().flat_map(|&[p0, p1, p2, p3]| places.map(|place| [p0, p1, p2, p3, place])).collect();
    for driver in [Driver::Egl, Driver::Osmesa] {
        for (question, found) in questions.iter().zip(found_by(driver, &questions)) {
            assert!(found.iter().all(|value| value.abs() <= 1e4), "{driver}: {question:?} gives {found:?}");
        }
    }
}
