//! Decodes the numbers of accessors, as `f32` or `u32`. An accessor is decoded as `f32` once for each meaning that its
//! integers are given ([`Integers`]), and the result is shared. It is decoded as `u32` at each call.

use std::any::Any;
use std::array;
use std::sync::Arc;

use foldhash::{HashMap, HashMapExt};

use crate::accessor::{Accessor, Component, Run, Shape};
use crate::cursor::{Cursor, List};
use crate::finding::{Checked, EXPORT_ANEW, Findings};
use crate::source::Source;

/// What integers stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Integers {
    /// Themselves, unless the accessor says that they are normalised.
    AsStated,
    /// 0..=1 or −1..=1, whatever the accessor says: for colours, weights, normals, rotations.
    Normalized,
}

/// A fault that the numbers of an accessor are searched for, once for each accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Scan {
    /// NaN or an infinity.
    NotFinite,
    /// A normal of another length than one.
    OddLength,
    /// A colour outside 0..=1.
    OutOfRange,
    /// A negative weight.
    Negative,
}

impl Scan {
    fn finds(self, numbers: &[f32]) -> bool {
        match self {
            Self::NotFinite => !numbers.iter().all(|number| number.is_finite()),
            Self::OddLength => {
                let length_squared: f32 = numbers.iter().map(|number| number * number).sum();
                !(0.98..=1.02).contains(&length_squared)
            }
            Self::OutOfRange => numbers.iter().any(|number| !(0.0..=1.0).contains(number)),
            Self::Negative => numbers.iter().any(|&number| number < 0.0),
        }
    }
}

type Decoded = HashMap<(usize, usize, Integers), Arc<dyn Any + Send + Sync>>;

/// All accessors of a file, and what was read of them.
pub(crate) struct Accessors<'o, 'p, 't> {
    /// Where the bytes come from, and what memory is left.
    pub source: Source<'o>,
    cursors: List<'p, 't>,
    list: Vec<Accessor>,
    decoded: Decoded,
    /// Results of scans, kept so that a million primitives on one accessor cause one scan of it.
    scans: HashMap<(usize, Scan), Option<usize>>,
}

impl<'o, 'p, 't> Accessors<'o, 'p, 't> {
    /// `list` holds one checked accessor for each of `cursors`.
    pub fn new(source: Source<'o>, cursors: List<'p, 't>, list: Vec<Accessor>) -> Self {
        Self { source, cursors, list, decoded: HashMap::new(), scans: HashMap::new() }
    }

    /// The index that a member holds.
    pub fn index(&self, member: &Cursor<'_, '_>) -> Checked<usize> {
        member.index(self.list.len(), "accessor")
    }

    pub fn get(&self, index: usize) -> &Accessor {
        &self.list[index]
    }

    /// The index that a member holds. Its accessor must have one of these shapes and one of these components.
    ///
    /// # Errors
    /// Out of range, or another format.
    pub fn expect(
        &self,
        member: &Cursor<'_, '_>,
        shapes: &[Shape],
        components: &[Component],
    ) -> Checked<usize> {
        let index = self.index(member)?;
        let accessor = &self.list[index];
        if shapes.contains(&accessor.shape) && components.contains(&accessor.component) {
            Ok(index)
        } else {
            Err(member.error(format!(
                "accessor {index} is {} of {}, which cannot be used here",
                accessor.shape, accessor.component
            )))
        }
    }

    /// The elements of an accessor whose shape has `N` numbers. NaN and infinities are passed on.
    ///
    /// # Errors
    /// The numbers are compressed or not in the file, they need more memory than is left, or the sparse indices are
    /// bad.
    pub fn floats<const N: usize>(
        &mut self,
        index: usize,
        integers: Integers,
        findings: &mut Findings,
    ) -> Checked<Arc<Vec<[f32; N]>>> {
        let key = (index, N, integers);
        if let Some(known) = self.decoded.get(&key).and_then(|known| known.clone().downcast().ok()) {
            return Ok(known);
        }
        let cursor = self.cursors.get(index).unwrap_or_else(|| unreachable!("one cursor for each accessor"));
        let accessor = &self.list[index];
        accessor.check_present(&cursor)?;
        self.source.take_memory(accessor.count as u64, size_of::<[f32; N]>(), &cursor)?;
        if integers == Integers::Normalized && !accessor.is_normalized && accessor.component != Component::F32
        {
            findings.add(
                cursor.warning(
                    "integers here stand for 0 to 1, and \"normalized\" does not say so",
                    EXPORT_ANEW,
                ),
            );
        }
        let reading = Reading::of(accessor, integers);
        let mut values = match &accessor.run {
            Some(run) => reading.run::<N>(run),
            None => vec![[0.0; N]; accessor.count],
        };
        if let Some(sparse) = &accessor.sparse {
            self.source.take_memory(sparse.count as u64, size_of::<[f32; N]>() + 4, &cursor)?;
            let indices = sparse_indices(accessor, &cursor)?;
            for (index, value) in indices.into_iter().zip(reading.run::<N>(&sparse.values)) {
                values[index as usize] = value;
            }
        }
        if let Some(which) = reading.broken_bound(accessor, &values) {
            findings
                .add(cursor.warning(format!("the stated {which} is not that of the numbers"), EXPORT_ANEW));
        }
        let values = Arc::new(values);
        self.decoded.insert(key, values.clone());
        Ok(values)
    }

    /// As [`Self::floats`], where only finite numbers will do.
    pub fn finite_floats<const N: usize>(
        &mut self,
        index: usize,
        integers: Integers,
        findings: &mut Findings,
    ) -> Checked<Arc<Vec<[f32; N]>>> {
        let values = self.floats::<N>(index, integers, findings)?;
        match self.first(index, Scan::NotFinite, &values) {
            None => Ok(values),
            Some(element) => {
                let message = format!("element {element} holds a number that is not finite");
                Err(self.error_at(index, message))
            }
        }
    }

    /// The first element of an accessor's values in which `scan` finds something; `None` if it finds nothing.
    pub fn first<const N: usize>(&mut self, index: usize, scan: Scan, values: &[[f32; N]]) -> Option<usize> {
        let search = || values.iter().position(|value| scan.finds(value));
        *self.scans.entry((index, scan)).or_insert_with(search)
    }

    pub fn error_at(&self, index: usize, message: String) -> Box<crate::Finding> {
        match self.cursors.get(index) {
            Some(cursor) => cursor.error(message),
            None => unreachable!("one cursor for each accessor"),
        }
    }

    /// The elements of an accessor of unsigned integers, not normalised, `N` numbers each.
    ///
    /// # Errors
    /// As [`Self::floats`].
    pub fn integers<const N: usize>(&mut self, index: usize) -> Checked<Vec<[u32; N]>> {
        let cursor = self.cursors.get(index).unwrap_or_else(|| unreachable!("one cursor for each accessor"));
        let accessor = &self.list[index];
        accessor.check_present(&cursor)?;
        self.source.take_memory(accessor.count as u64, size_of::<[u32; N]>(), &cursor)?;
        let mut values = match &accessor.run {
            Some(run) => unsigned::<N>(run, accessor.component),
            None => vec![[0; N]; accessor.count],
        };
        if let Some(sparse) = &accessor.sparse {
            self.source.take_memory(sparse.count as u64, size_of::<[u32; N]>() + 4, &cursor)?;
            let indices = sparse_indices(accessor, &cursor)?;
            for (index, value) in indices.into_iter().zip(unsigned::<N>(&sparse.values, accessor.component)) {
                values[index as usize] = value;
            }
        }
        Ok(values)
    }

    /// Accounts for memory taken for a reader's own list.
    pub fn take_memory(&mut self, count: usize, bytes_each: usize, cursor: &Cursor<'_, '_>) -> Checked<()> {
        self.source.take_memory(count as u64, bytes_each, cursor)
    }

    /// Gives back the memory of numbers that were dropped.
    pub fn give_back_memory(&mut self, count: usize, bytes_each: usize) {
        self.source.give_back_memory(count as u64, bytes_each);
    }

    /// A warning where an accessor that needs `min` and `max` has none.
    pub fn warn_without_bounds(&self, index: usize, findings: &mut Findings) {
        let accessor = &self.list[index];
        if (accessor.min.is_none() || accessor.max.is_none())
            && let Some(cursor) = self.cursors.get(index)
        {
            findings.add(cursor.warning("\"min\" and \"max\" are missing", ""));
        }
    }
}

fn sparse_indices(accessor: &Accessor, cursor: &Cursor<'_, '_>) -> Checked<Vec<u32>> {
    let Some(sparse) = &accessor.sparse else { return Ok(Vec::new()) };
    let indices = unsigned::<1>(&sparse.indices, sparse.index_component).into_flattened();
    let is_ordered = indices.windows(2).all(|pair| pair[0] < pair[1]);
    let is_inside = indices.iter().all(|&index| (index as usize) < accessor.count);
    if is_ordered && is_inside {
        Ok(indices)
    } else {
        Err(cursor.error("the sparse indices do not increase, or lie beyond the accessor's count"))
    }
}

/// How the numbers of an accessor become `f32`.
#[derive(Clone, Copy)]
struct Reading {
    component: Component,
    is_normalized: bool,
}

impl Reading {
    fn of(accessor: &Accessor, integers: Integers) -> Self {
        let is_normalized = accessor.is_normalized || integers == Integers::Normalized;
        Self { component: accessor.component, is_normalized }
    }

    /// A number of the file as `f32`. If it is normalised and has 8 or 16 bits, it is divided by the largest number of
    /// its type; the result is at least −1.
    fn value(self, raw: f32) -> f32 {
        let scale = match self.component {
            _ if !self.is_normalized => return raw,
            Component::I8 => 127.0,
            Component::U8 => 255.0,
            Component::I16 => 32767.0,
            Component::U16 => 65535.0,
            Component::U32 | Component::F32 => return raw,
        };
        (raw / scale).max(-1.0)
    }

    fn run<const N: usize>(self, run: &Run) -> Vec<[f32; N]> {
        match self.component {
            Component::F32 => convert(run, f32::from_le_bytes),
            Component::U32 => convert(run, |bytes| u32::from_le_bytes(bytes) as f32),
            Component::I8 => convert(run, |bytes| self.value(f32::from(i8::from_le_bytes(bytes)))),
            Component::U8 => convert(run, |bytes| self.value(f32::from(u8::from_le_bytes(bytes)))),
            Component::I16 => convert(run, |bytes| self.value(f32::from(i16::from_le_bytes(bytes)))),
            Component::U16 => convert(run, |bytes| self.value(f32::from(u16::from_le_bytes(bytes)))),
        }
    }

    /// The bound, `min` or `max`, that is stated wrongly; `None` if neither is.
    fn broken_bound<const N: usize>(self, accessor: &Accessor, values: &[[f32; N]]) -> Option<&'static str> {
        let (min, max) = (accessor.min.as_ref(), accessor.max.as_ref());
        if values.is_empty() || min.is_none() && max.is_none() {
            return None;
        }
        let mut low = [f32::INFINITY; N];
        let mut high = [f32::NEG_INFINITY; N];
        for value in values {
            for axis in 0..N {
                low[axis] = low[axis].min(value[axis]);
                high[axis] = high[axis].max(value[axis]);
            }
        }
        let differs = |stated: Option<&Vec<f64>>, found: [f32; N]| {
            // The JSON text often states a bound with fewer digits than f32 has.
            let is_off = |(&stated, found): (&f64, f32)| {
                (self.value(stated as f32) - found).abs() > 1e-4 * found.abs().max(1e-2)
            };
            stated.is_some_and(|stated| stated.iter().zip(found).any(is_off))
        };
        if differs(min, low) {
            Some("\"min\"")
        } else if differs(max, high) {
            Some("\"max\"")
        } else {
            None
        }
    }
}

/// Reads the first `N` numbers of each element. The last chunk of the run may be shorter than the stride, but holds a
/// whole element.
fn convert<const N: usize, const BYTES: usize>(
    run: &Run,
    read: impl Fn([u8; BYTES]) -> f32,
) -> Vec<[f32; N]> {
    if run.stride == N * BYTES {
        // No gaps: the compiler sees chunks of a fixed size.
        let (numbers, _) = run.bytes.as_chunks::<BYTES>();
        let (elements, _) = numbers.as_chunks::<N>();
        return elements.iter().map(|element| array::from_fn(|axis| read(element[axis]))).collect();
    }
    let read_element = |element: &[u8]| {
        let (numbers, _) = element.as_chunks::<BYTES>();
        array::from_fn(|axis| read(numbers[axis]))
    };
    run.bytes.chunks(run.stride).map(read_element).collect()
}

/// As [`convert`], for unsigned integers.
fn unsigned<const N: usize>(run: &Run, component: Component) -> Vec<[u32; N]> {
    let size = component.size();
    let read_element = |element: &[u8]| {
        array::from_fn(|axis| {
            let mut number = [0; 4];
            number[..size].copy_from_slice(&element[axis * size..][..size]);
            u32::from_le_bytes(number)
        })
    };
    run.bytes.chunks(run.stride).map(read_element).collect()
}
