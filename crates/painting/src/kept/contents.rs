//! Reads kept bytes, in the order in which they are written. Every index is checked against the length of what it
//! points into.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use impasto_core::brush::{self, Mark};
use impasto_core::neighbours::Neighbours;
use impasto_core::sampling::{PackedParticle, ProgressiveState};
use impasto_core::solve::PlacedParticles;
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use super::arrays::{Array, Arrays, Unfit};
use super::{KeptBytes, KeptKey};
use crate::bake::BakedBody;
use crate::body::BodySurface;
use crate::counts::{BodyCounts, CoatCount, Counted};
use crate::frame::Brushes;
use crate::looks::Looks;
use crate::order::PaintingOrder;
use crate::paper::{PolygonCounts, PolygonSide};

pub(super) const LAYERS: usize = LayerKind::ALL.len();

/// How many texels a mark of a brush has.
const TEXELS: usize = brush::SIZE[0] * brush::SIZE[1];

/// How many objects, rules and brushes the kept painting has.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Sizes {
    pub(super) objects: u64,
    pub(super) rules: u64,
    pub(super) brushes: u64,
}

/// The numbers of a coat.
#[repr(C)]
#[derive(Clone, Copy, Default, Pod, Zeroable)]
pub(super) struct CoatNumbers {
    pub(super) count: u64,
    /// How many particles the coat would have on its whole surface.
    pub(super) count_on_whole: u64,
    pub(super) state: [u64; 4],
    /// The bits of the area, which is a float.
    pub(super) area: u64,
    /// Whether the particles lie on the whole surface. This number and the next three are 0 or 1.
    pub(super) is_everywhere: u64,
    /// Whether looks have base angles.
    pub(super) has_angles: u64,
    pub(super) has_polygons: u64,
    pub(super) has_neighbours: u64,
    /// How many neighbours a list has room for.
    pub(super) most_neighbours: u64,
}

/// Everything that was kept.
pub(crate) struct KeptPainting {
    pub(crate) brushes: Brushes,
    /// In the order of the scene.
    pub(crate) objects: Vec<KeptObject>,
    pub(crate) order: PaintingOrder,
}

/// One object, as it was kept.
pub(crate) struct KeptObject {
    /// How many particles each layer is to have.
    pub(crate) counts: BodyCounts,
    /// In the order of [`LayerKind::ALL`]; `None` for layers that the object does not have.
    pub(crate) coats: [Option<KeptCoat>; LAYERS],
}

/// One coat, as it was kept.
pub(crate) struct KeptCoat {
    /// All particles that were sampled.
    pub(crate) places: Vec<PackedParticle>,
    /// Their ordinals; empty where these are their indices.
    pub(crate) ordinals: Vec<f32>,
    /// How many of them, from the first on, the coat has.
    pub(crate) count: usize,
    /// How many particles were wanted on the whole surface. A surface without area has none, whatever is wanted, and a
    /// surface whose faces lie on each other has fewer.
    pub(crate) wanted: usize,
    /// How many the coat would have on its whole surface, and whether it has these.
    pub(crate) count_on_whole: usize,
    pub(crate) is_everywhere: bool,
    pub(crate) state: ProgressiveState,
    pub(crate) area: f64,
    /// The albedo of all particles that were sampled; empty where it follows from the materials.
    pub(crate) albedo: Vec<u32>,
    pub(crate) polygons: Option<PolygonCounts>,
    /// The region of each particle; empty where it follows from the triangles.
    pub(crate) dabbed: Vec<u16>,
    pub(crate) baked: BakedBody,
    pub(crate) neighbours: Option<Neighbours>,
}

/// The surfaces, rules and brushes that the bytes must fit.
pub(crate) struct Wanted<'a> {
    pub(crate) surfaces: &'a [Arc<BodySurface>],
    /// How many rules there are.
    pub(crate) rules: usize,
    /// The names of the brushes.
    pub(crate) brushes: Vec<String>,
}

impl KeptPainting {
    /// Reads what is kept under a key.
    pub(crate) fn read(bytes: &dyn KeptBytes, key: &KeptKey, wanted: Wanted<'_>) -> Result<Self, Unfit> {
        let mut arrays = Arrays::open(bytes, key)?;
        let [sizes] = arrays.next::<Sizes>()?.numbers()?;
        let is = (sizes.objects, sizes.rules, sizes.brushes);
        if is != (wanted.surfaces.len() as u64, wanted.rules as u64, wanted.brushes.len() as u64) {
            return Err(Unfit::Damaged);
        }
        let mut marks = Vec::new();
        for _ in 0..wanted.brushes.len() * brush::VARIANTS as usize {
            marks.push(arrays.next::<[u8; 3]>()?);
        }
        let mut objects = Vec::new();
        for surface in wanted.surfaces {
            objects.push(ObjectArrays::next(&mut arrays, surface)?);
        }
        let [order, firsts] = [arrays.next::<u32>()?, arrays.next::<u32>()?];
        arrays.end()?;
        // The large arrays are read only from here on, into no more memory than there are bytes.
        let mark = |texels: Array<'_, [u8; 3]>| Ok(Mark { texels: texels.of_len(TEXELS)? });
        let read_marks = || marks.into_par_iter().map(mark).collect::<Result<Vec<Mark>, Unfit>>();
        let read_objects = || {
            let objects = objects.into_par_iter().map(|object| object.read(wanted.rules));
            objects.collect::<Result<Vec<KeptObject>, Unfit>>()
        };
        let ((marks, order), objects) =
            rayon::join(|| rayon::join(read_marks, || order.read()), read_objects);
        let objects = objects?;
        let counts: Vec<usize> =
            objects.iter().flat_map(|object| object.coats.iter().flatten()).map(|coat| coat.count).collect();
        let mut marks = marks?.into_iter();
        let variants = brush::VARIANTS as usize;
        let of_brush = |_: &String| Arc::new(marks.by_ref().take(variants).collect());
        Ok(Self {
            brushes: Brushes { marks: wanted.brushes.iter().map(of_brush).collect(), names: wanted.brushes },
            order: PaintingOrder::of_kept(order?, firsts.read()?, &counts).ok_or(Unfit::Damaged)?,
            objects,
        })
    }
}

impl<T: Pod> Array<'_, T> {
    /// Reads the array if it has exactly `COUNT` numbers.
    fn numbers<const COUNT: usize>(self) -> Result<[T; COUNT], Unfit> {
        <[T; COUNT]>::try_from(self.of_len(COUNT)?).map_err(|_| Unfit::Damaged)
    }
}

/// The arrays of an object that were not read yet.
struct ObjectArrays<'a> {
    counted: Counted,
    coats: Vec<Option<CoatArrays<'a>>>,
}

impl<'a> ObjectArrays<'a> {
    fn next(arrays: &mut Arrays<'a>, surface: &'a BodySurface) -> Result<Self, Unfit> {
        let [counts, may_depend, has] = arrays.next::<[u64; LAYERS]>()?.numbers()?;
        let [[more_wanted, deepness]] = arrays.next::<[u64; 2]>()?.numbers()?;
        let mut coats = Vec::new();
        for has in has {
            coats.push(match has {
                0 => None,
                1 => Some(CoatArrays::next(arrays, surface)?),
                _ => return Err(Unfit::Damaged),
            });
        }
        let mut whole = [0; LAYERS];
        for (whole, count) in whole.iter_mut().zip(counts) {
            *whole = usize::try_from(count).map_err(|_| Unfit::Damaged)?;
        }
        let counted = Counted {
            counts: whole,
            may_depend_on_views: may_depend.map(|may| may != 0),
            more_wanted: f64::from_bits(more_wanted),
            deepness: f64::from_bits(deepness),
        };
        Ok(Self { counted, coats })
    }

    fn read(self, rules: usize) -> Result<KeptObject, Unfit> {
        let read = |(coat, wanted): (Option<CoatArrays<'_>>, usize)| {
            coat.map(|coat| coat.read(rules, wanted)).transpose()
        };
        let coats = self.coats.into_par_iter().zip(self.counted.counts);
        let coats: Result<Vec<Option<KeptCoat>>, Unfit> = coats.map(read).collect();
        let coats: [Option<KeptCoat>; LAYERS] = coats?.try_into().map_err(|_| Unfit::Damaged)?;
        let count = |coat: &Option<KeptCoat>| coat.as_ref().map_or(0, |coat| coat.count);
        let of_coats = coats.each_ref().map(|coat| CoatCount::everywhere(count(coat)));
        Ok(KeptObject { counts: BodyCounts { counted: self.counted, of_coats }, coats })
    }
}

/// The arrays of [`PolygonCounts`]: of particles, sides, faces.
type PolygonArrays<'a> = (Array<'a, [u32; 2]>, Array<'a, PolygonSide>, Array<'a, [u32; 3]>);

/// The arrays of [`Neighbours`]: slots, lengths, indices.
type NeighbourArrays<'a> = (Array<'a, u32>, Array<'a, u8>, Array<'a, u32>);

/// The arrays of a coat that were not read yet.
struct CoatArrays<'a> {
    surface: &'a BodySurface,
    numbers: CoatNumbers,
    places: Array<'a, PackedParticle>,
    ordinals: Array<'a, f32>,
    albedo: Array<'a, u32>,
    dabbed: Array<'a, u16>,
    /// Position and normal, by component.
    vectors: [Array<'a, f32>; 6],
    looks: Array<'a, u32>,
    flatness: Array<'a, f32>,
    polygons: Option<PolygonArrays<'a>>,
    neighbours: Option<NeighbourArrays<'a>>,
}

impl<'a> CoatArrays<'a> {
    fn next(arrays: &mut Arrays<'a>, surface: &'a BodySurface) -> Result<Self, Unfit> {
        let [numbers] = arrays.next::<CoatNumbers>()?.numbers()?;
        let (places, ordinals) = (arrays.next()?, arrays.next()?);
        let (albedo, dabbed) = (arrays.next()?, arrays.next()?);
        let mut vectors = Vec::new();
        for _ in 0..6 {
            vectors.push(arrays.next()?);
        }
        let (looks, flatness) = (arrays.next()?, arrays.next()?);
        let polygons = match numbers.has_polygons {
            0 => None,
            _ => Some((arrays.next()?, arrays.next()?, arrays.next()?)),
        };
        let neighbours = match numbers.has_neighbours {
            0 => None,
            _ => Some((arrays.next()?, arrays.next()?, arrays.next()?)),
        };
        Ok(Self {
            surface,
            numbers,
            places,
            ordinals,
            albedo,
            dabbed,
            vectors: vectors.try_into().map_err(|_| Unfit::Damaged)?,
            looks,
            flatness,
            polygons,
            neighbours,
        })
    }

    fn read(self, rules: usize, wanted: usize) -> Result<KeptCoat, Unfit> {
        let Self { surface, numbers, .. } = self;
        let count = usize::try_from(numbers.count).map_err(|_| Unfit::Damaged)?;
        let (triangles, has_colors) = (surface.mesh.triangles.len(), surface.has_colors());
        let places = self.places.read()?;
        let is_inside = |place: &PackedParticle| place.triangle() < triangles;
        if places.len() < count || !places.par_iter().all(is_inside) {
            return Err(Unfit::Damaged);
        }
        let dabbed = self.dabbed.of_len_or_empty(count)?;
        if dabbed.iter().any(|&region| usize::from(region) >= rules) {
            return Err(Unfit::Damaged);
        }
        let vectors: Result<Vec<Vec<f32>>, Unfit> =
            self.vectors.into_par_iter().map(|array| array.of_len(count)).collect();
        let mut vectors = vectors?.into_iter();
        let mut three = || std::array::from_fn(|_| vectors.next().unwrap_or_default());
        let placed = PlacedParticles { position: three(), normal: three() };
        let has_angles = numbers.has_angles != 0;
        let words = self.looks.of_len(Looks::words_of(count, has_angles))?;
        let looks = Looks::of_words(words, has_angles).ok_or(Unfit::Damaged)?;
        let baked = BakedBody { placed, flatness: self.flatness.of_len_or_empty(count)?, looks };
        let polygons = match self.polygons {
            Some((of_particle, sides, faces)) => Some(
                PolygonCounts::of_kept(of_particle.of_len(count)?, sides.read()?, faces.read()?, triangles)
                    .ok_or(Unfit::Damaged)?,
            ),
            None => None,
        };
        let most = usize::try_from(numbers.most_neighbours).map_err(|_| Unfit::Damaged)?;
        let neighbours = match self.neighbours {
            Some((slots, lengths, indices)) => Some(
                Neighbours::from_arrays(slots.of_len(count)?, lengths.read()?, indices.read()?, most)
                    .ok_or(Unfit::Damaged)?,
            ),
            None => None,
        };
        let state = ProgressiveState::from_numbers(numbers.state).ok_or(Unfit::Damaged)?;
        let is_everywhere = numbers.is_everywhere != 0;
        let ordinals = self.ordinals.of_len_or_empty(places.len())?;
        let is_counted =
            |(index, &ordinal): (usize, &f32)| index >= state.counted() || ordinal == index as f32;
        let are_ordinals = ordinals.is_sorted()
            && ordinals.iter().all(|ordinal| ordinal.is_finite())
            && ordinals.iter().enumerate().all(is_counted);
        if !are_ordinals || is_everywhere && !state.fits(places.len()) {
            return Err(Unfit::Damaged);
        }
        Ok(KeptCoat {
            albedo: self.albedo.of_len(if has_colors { places.len() } else { 0 })?,
            ordinals,
            count,
            wanted,
            count_on_whole: usize::try_from(numbers.count_on_whole).map_err(|_| Unfit::Damaged)?.max(1),
            is_everywhere,
            state,
            area: f64::from_bits(numbers.area),
            polygons,
            dabbed,
            baked,
            neighbours,
            places,
        })
    }
}
