//! Makes random scenes, in which nearly every field can differ from its default, for the test that a saved scene reads
//! back equal.

use proptest::prelude::*;

use crate::document::*;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        -10.0..10.0_f64,
        (-1000..1000_i32).prop_map(f64::from),
        proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::NEGATIVE,
    ]
}

fn vector3() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

fn any_color() -> impl Strategy<Value = Color> {
    any::<[u8; 3]>().prop_map(|bytes| Color(bytes.map(|byte| f32::from(byte) / 255.0)))
}

fn ease() -> impl Strategy<Value = Ease> {
    prop_oneof![
        proptest::sample::select(vec![
            Ease::Step,
            Ease::Linear,
            Ease::Smooth,
            Ease::In,
            Ease::Out,
            Ease::Bounce
        ]),
        [number(), number(), number(), number()].prop_map(|[a, b, c, d]| Ease::Curve([a, b], [c, d])),
    ]
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-z ]{1,12}", any::<String>()]
}

fn any_camera() -> impl Strategy<Value = Camera> {
    let lens = prop_oneof![
        (number(), number(), number()).prop_map(|(fov_y_deg, near, far)| Lens::Perspective {
            fov_y_deg,
            near,
            far
        }),
        (number(), number(), number()).prop_map(|(height, near, far)| Lens::Orthographic {
            height,
            near,
            far
        }),
        Just(Lens::default()),
    ];
    let key = (number(), vector3(), vector3(), number(), proptest::option::of(number()), ease()).prop_map(
        |(frame, eye, target, roll_deg, fov_y_deg, ease)| CameraKey {
            frame,
            eye,
            target,
            roll_deg,
            fov_y_deg,
            ease,
        },
    );
    (lens, prop::collection::vec(key, 0..4)).prop_map(|(lens, keys)| Camera { of_shot: None, lens, keys })
}

fn any_light() -> impl Strategy<Value = Light> {
    let kind = prop_oneof![Just(LightKind::Sun), Just(LightKind::Point), Just(LightKind::Ambient)];
    let places = || (proptest::option::of(vector3()), proptest::option::of(vector3()));
    let values = (
        proptest::option::of(number()),
        proptest::option::of(any_color()),
        proptest::option::of(any_color()),
        places(),
    );
    let key = (number(), values, ease()).prop_map(
        |(frame, (intensity, color, ground, (direction, position)), ease)| LightKey {
            frame,
            intensity,
            color,
            ground,
            direction,
            position,
            ease,
        },
    );
    let keys = prop::collection::vec(key, 0..3);
    (name(), kind, places(), any_color(), proptest::option::of(any_color()), number(), keys).prop_map(
        |(name, kind, (direction, position), color, ground, intensity, keys)| Light {
            name,
            kind,
            direction,
            position,
            cone_deg: position.map(|[inner, outer, _]| [inner, outer]),
            color,
            ground,
            intensity,
            keys,
        },
    )
}

fn noise_displace() -> impl Strategy<Value = NoiseDisplace> {
    use crate::document::{NoiseAlong, NoiseAlpha, NoiseForward, NoiseMix, NoiseNormals, NoiseSpace};
    let pair = || (number(), number()).prop_map(|(x, y)| [x, y]);
    let one_of = any::<[bool; 6]>();
    let names = (proptest::option::of(name()), proptest::option::of(name()), any::<u32>(), any_color());
    let pairs = (pair(), pair(), pair());
    let numbers = [(); 7].map(|()| number());
    (names, pairs, numbers, one_of, proptest::option::of(number()), any::<[bool; 2]>()).prop_map(
        |(
            (of_vertex, of_surface, layer_count, tint),
            (value, tiling, tile_offset),
            numbers,
            flags,
            period,
            has,
        )| {
            let [scale, speed, intensity, opacity, bloom, threshold, _] = numbers;
            let vertex = VertexNoise {
                texture: of_vertex,
                space: if flags[0] { NoiseSpace::Local } else { NoiseSpace::World },
                value,
                scale,
                along: if flags[1] { NoiseAlong::Normal } else { NoiseAlong::Channels },
                normals: if flags[2] { NoiseNormals::Displaced } else { NoiseNormals::Kept },
            };
            let surface = SurfaceNoise {
                texture: of_surface,
                layer_count,
                speed,
                tiling,
                tile_offset,
                forward: if flags[3] { NoiseForward::Even } else { NoiseForward::Odd },
                mix: if flags[4] { NoiseMix::Mean } else { NoiseMix::Root },
                tint,
                intensity,
                opacity,
                alpha: if flags[5] { NoiseAlpha::Grey } else { NoiseAlpha::Texture },
                bloom,
                threshold,
            };
            NoiseDisplace {
                vertex: has[0].then_some(vertex),
                surface: has[1].then_some(surface),
                period_secs: period,
            }
        },
    )
}
fn any_object() -> impl Strategy<Value = Object> {
    let key = (number(), vector3(), vector3(), vector3().prop_map(Scale), number(), ease()).prop_map(
        |(frame, translation, rotation_deg, scale, morph, ease)| ObjectKey {
            frame,
            translation,
            rotation_deg,
            scale,
            morph,
            ease,
        },
    );
    let material = (
        proptest::option::of(any_color()),
        proptest::option::of(name()),
        any::<bool>(),
        proptest::option::of(number()),
        proptest::option::of(noise_displace()),
    )
        .prop_map(|(color, texture, unlit, gloss, noise_displace)| MaterialOverride {
            color,
            texture,
            unlit,
            gloss,
            noise_displace,
        });
    let maybe_name = || proptest::option::of(name());
    let names = (name(), name(), maybe_name(), maybe_name(), [maybe_name(), maybe_name()]);
    let rest = prop_oneof![Just(Rest::Bind), any::<i64>().prop_map(Rest::Frame)];
    let scale = prop_oneof![number().prop_map(|x| [x; 3]), vector3()].prop_map(Scale);
    let up = prop_oneof![Just(Up::Y), Just(Up::Z)];
    let keys = prop::collection::vec(key, 0..4);
    let counts = (proptest::option::of(any::<u64>()), any::<u32>(), any::<[bool; 2]>());
    (names, counts, scale, (up, rest), proptest::option::of(material), keys).prop_map(
        |(names, (particles, hold, flags), scale, (up, rest), material, keys)| {
            let (name, mesh, group, parent, [morph, cache]) = names;
            Object {
                name,
                mesh,
                group,
                parent,
                particles,
                hold,
                scale,
                up,
                morph,
                cache,
                rest,
                material,
                keys,
                hidden: flags[0],
                locked: flags[1],
            }
        },
    )
}

fn any_brush() -> impl Strategy<Value = Option<BrushMix>> {
    proptest::option::of(prop::collection::vec(name(), 1..4).prop_map(BrushMix))
}

fn any_layer() -> impl Strategy<Value = LayerSettings> {
    let numbers = prop::collection::vec(proptest::option::of(number()), LayerSettings::NUMBERS.len());
    let looks = (any_brush(), proptest::option::of(any::<bool>()), proptest::option::of(any_color()));
    (name(), looks, numbers).prop_map(|(name, (brush, hidden, color), numbers)| {
        let mut layer = LayerSettings { name, brush, hidden, color, ..LayerSettings::default() };
        for (of, value) in LayerSettings::NUMBERS.iter().zip(numbers) {
            *(of.number.of)(&mut layer) = value;
        }
        layer
    })
}

fn any_strokes() -> impl Strategy<Value = StrokeSettings> {
    let numbers = prop::collection::vec(proptest::option::of(number()), STROKE_NUMBERS.len());
    let edges = prop_oneof![Just(Edges::Clip), number().prop_map(Edges::Overrun), Just(Edges::Free)];
    let key = (number(), (number(), number(), number(), number()), ease()).prop_map(
        |(frame, (size, coverage, dryness, palette_mix), ease)| StrokesKey {
            frame,
            size,
            coverage,
            dryness,
            palette_mix,
            ease,
        },
    );
    let lists = (
        proptest::option::of(prop::collection::vec(any_color(), 0..3)),
        prop::collection::vec(any_layer(), 0..3),
        prop::collection::vec(key, 0..3),
        prop::collection::vec(name(), 0..3),
    );
    let head = (proptest::option::of(name()), any_brush(), proptest::option::of(edges));
    (head, numbers, proptest::option::of(any::<i32>()), lists).prop_map(
        |((preset, brush, edges), numbers, layer, (palette, layers, keys, order))| {
            let lists = StrokeSettings { palette, layers, order, keys, ..Default::default() };
            let mut strokes = StrokeSettings { preset, brush, edges, layer, ..lists };
            for (of, value) in STROKE_NUMBERS.iter().zip(numbers) {
                *(of.number.of)(&mut strokes) = value;
            }
            strokes
        },
    )
}

fn any_style() -> impl Strategy<Value = Style> {
    let solver = prop_oneof![Just(Solver::Tangent), Just(Solver::Horn), Just(Solver::HornExact)];
    let canvas = prop_oneof![Just(Canvas::Linen), Just(Canvas::Board)];
    let follows = prop_oneof![Just(CanvasFollows::Picture), Just(CanvasFollows::Camera)];
    let samples = prop_oneof![Just(1u32), Just(2), Just(4)];
    let numbers = (samples, number(), number(), number());
    let strokes = (solver, any::<bool>(), canvas, follows, numbers).prop_map(
        |(solver, underpainting, canvas, canvas_follows, (samples, weave, relief, varnish))| {
            Style::RotatingStrokes(RotatingStrokes {
                solver,
                underpainting,
                canvas,
                weave,
                canvas_follows,
                samples,
                relief,
                varnish,
            })
        },
    );
    let words = (
        prop_oneof![Just(InkRule::Painter), Just(InkRule::Source)],
        prop_oneof![Just(InkDrawing::Both), Just(InkDrawing::Wash), Just(InkDrawing::Strokes)],
        prop_oneof![Just(InkLight::Scene), Just(InkLight::Eye)],
        prop_oneof![Just(CanvasFollows::Picture), Just(CanvasFollows::Camera)],
    );
    let numbers = prop::collection::vec(number(), SumiE::numbers().count() + 4);
    let ink = (words, vector3(), numbers, (any_color(), any_color(), any_color())).prop_map(
        |((rule, drawing, light, paper_follows), to_light, numbers, (paper, ink, seal))| {
            let tones = [0, 1, 2, 3].map(|tone| numbers[tone]);
            let usual = SumiE::default();
            let mut style =
                SumiE { rule, drawing, light, to_light, tones, paper, ink, seal, paper_follows, ..usual };
            for (of, &value) in SumiE::numbers().zip(&numbers[4..]) {
                *(of.of)(&mut style) = value;
            }
            Style::SumiE(style)
        },
    );
    prop_oneof![Just(Style::Reference), strokes, ink]
}

fn any_guide() -> impl Strategy<Value = Guide> {
    let frame = proptest::option::of(number());
    let view =
        (vector3(), vector3(), frame).prop_map(|(eye, target, frame)| GuideView { eye, target, frame });
    let point = (vector3(), vector3(), number()).prop_map(|(at, normal, turn_deg)| GuidePoint {
        at,
        normal,
        turn_deg,
    });
    let falloff = prop_oneof![Just(Falloff::Smooth), Just(Falloff::Linear), Just(Falloff::Flat)];
    let mode = prop_oneof![Just(GuideMode::Comb), Just(GuideMode::Smooth)];
    let head = (mode, any::<bool>(), proptest::option::of(name()), proptest::option::of(view));
    (head, prop::collection::vec(point, 0..4), number(), number(), falloff).prop_map(
        |((mode, curve, object, view), points, radius, strength, falloff)| Guide {
            mode,
            curve,
            object,
            view,
            points,
            radius,
            strength,
            falloff,
        },
    )
}

fn any_amount() -> impl Strategy<Value = PaintedAmount> {
    let dab = (vector3(), vector3(), number(), number()).prop_map(|(at, normal, radius, by)| AmountDab {
        at,
        normal,
        radius,
        by,
    });
    let of = prop::sample::select(&Amount::ALL[..]);
    (of, proptest::option::of(name()), prop::collection::vec(dab, 0..4))
        .prop_map(|(of, object, dabs)| PaintedAmount { of, object, dabs })
}

fn any_reference() -> impl Strategy<Value = Reference> {
    let view = (vector3(), vector3(), number(), proptest::option::of(number()), any::<i64>()).prop_map(
        |(eye, target, roll_deg, fov_y_deg, frame)| Reference::View {
            eye,
            target,
            roll_deg,
            fov_y_deg,
            frame,
        },
    );
    prop_oneof![any::<i64>().prop_map(Reference::Frame), view]
}

fn any_region() -> impl Strategy<Value = Region> {
    let dabs = || {
        let dab = (vector3(), vector3(), number(), any::<bool>())
            .prop_map(|(at, normal, radius, take_away)| Dab { at, normal, radius, take_away });
        prop::collection::vec(dab, 0..3)
    };
    let flood = || ((vector3(), vector3()).prop_map(|(at, normal)| Seed { at, normal }), number());
    let patch = prop_oneof![
        Just(Patch::Whole),
        name().prop_map(Patch::Group),
        name().prop_map(Patch::Material),
        dabs().prop_map(Patch::Dabs),
        flood().prop_map(|(seed, sharp_deg)| Patch::Flood(seed, sharp_deg)),
    ];
    let on = prop_oneof![
        Just(Selector::Everything),
        name().prop_map(Selector::Object),
        (name(), name()).prop_map(|(object, group)| Selector::Group(object, group)),
        (name(), name()).prop_map(|(object, material)| Selector::Material(object, material)),
        (name(), dabs()).prop_map(|(object, dabs)| Selector::Dabs(object, dabs)),
        (name(), flood()).prop_map(|(object, (seed, sharp_deg))| Selector::Flood(object, seed, sharp_deg)),
        (name(), prop::collection::vec(patch, 0..3))
            .prop_map(|(object, patches)| Selector::Several(object, patches)),
    ];
    let direction = prop_oneof![
        Just(Direction::Auto),
        number().prop_map(Direction::Angle),
        (number(), number()).prop_map(|(first, second)| Direction::Crossing(first, second)),
        vector3().prop_map(Direction::Along),
        vector3().prop_map(Direction::Around),
        vector3().prop_map(Direction::Toward),
        Just(Direction::Curvature(Bend::Min)),
        Just(Direction::Curvature(Bend::Max)),
        Just(Direction::Up)
    ];
    let seam = prop_oneof![Just(Seam::Hard), number().prop_map(Seam::Soft)];
    let sense = prop_oneof![Just(Sense::Lines), Just(Sense::Arrows)];
    let painted = (prop::collection::vec(any_guide(), 0..3), prop::collection::vec(any_amount(), 0..3));
    let field = (seam, sense, painted, number());
    let of_editor = (any::<[bool; 2]>(), proptest::option::of(any_color()));
    let head = (name(), on, of_editor);
    (head, direction, field, proptest::option::of(any_reference()), any_strokes()).prop_map(
        |(
            (name, on, of_editor),
            direction,
            (seam, sense, (guides, amounts), turn_deg),
            reference,
            strokes,
        )| Region {
            name,
            on,
            direction,
            guides,
            amounts,
            seam,
            sense,
            reference,
            strokes,
            turn_deg,
            hidden: of_editor.0[0],
            locked: of_editor.0[1],
            color: of_editor.1,
        },
    )
}

fn any_touch() -> impl Strategy<Value = Touch> {
    let point = (vector3(), vector3()).prop_map(|(at, normal)| TouchPoint { at, normal });
    let looks = (proptest::option::of(any_color()), proptest::option::of(name()), any::<bool>());
    let numbers = [(); 4].map(|()| number());
    (name(), name(), prop::collection::vec(point, 0..3), looks, numbers).prop_map(
        |(name, on, points, (color, brush, hidden), [width_px, length_px, opacity, taper])| Touch {
            name,
            on,
            points,
            width_px,
            length_px,
            color,
            opacity,
            taper,
            brush,
            hidden,
        },
    )
}

pub(super) fn any_scene() -> impl Strategy<Value = Scene> {
    // The large parts are boxed: held by value, they would overflow the stack of a test's thread.
    let style = any_style().boxed();
    let background_key =
        (number(), any_color(), ease()).prop_map(|(frame, color, ease)| BackgroundKey { frame, color, ease });
    let background = (any_color(), prop::collection::vec(background_key, 0..3));
    let timeline = (number(), any::<i64>(), any::<i64>(), prop::option::of("[a-z]{1,4}"))
        .prop_map(|(fps, first, last, animation)| Timeline { fps, first, last, animation });
    let background = (background, number());
    let head = (any::<(u32, u32)>(), any::<u32>(), background, timeline, any_reference(), style);
    let lists = (
        prop::collection::vec(any_light(), 0..3),
        prop::collection::vec(any_object().boxed(), 0..4),
        prop::collection::vec(any_region().boxed(), 0..3),
        prop::collection::vec(any_reference(), 0..3),
        prop::collection::vec(any_touch(), 0..3),
    );
    (head, any_camera(), lists, any_strokes().boxed()).prop_map(
        |(
            (size, seed, ((background, background_keys), exposure), timeline, reference, style),
            camera,
            (lights, objects, regions, further_references, touches),
            strokes,
        )| {
            Scene {
                version: Scene::VERSION,
                size,
                seed,
                background,
                background_keys,
                shot: None,
                stage: Default::default(),
                exposure,
                timeline,
                reference,
                further_references,
                camera,
                lights,
                objects,
                strokes,
                regions,
                touches,
                style,
                aovs: Vec::new(),
            }
        },
    )
}
