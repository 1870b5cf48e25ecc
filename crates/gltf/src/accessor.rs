//! Accessors, which say what kind of numbers lie where. Everything that the JSON says about them is checked here, so
//! that `decode` cannot read beyond the bytes.

use std::fmt;

use crate::bytes::Bytes;
use crate::cursor::Cursor;
use crate::finding::{Checked, Findings, Severity};
use crate::source::View;

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u64) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Bytes of a number.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// How many numbers make an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Scalar,
    Vector(usize),
    /// Square, with this many rows.
    Matrix(usize),
}

impl Shape {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "SCALAR" => Self::Scalar,
            "VEC2" => Self::Vector(2),
            "VEC3" => Self::Vector(3),
            "VEC4" => Self::Vector(4),
            "MAT2" => Self::Matrix(2),
            "MAT3" => Self::Matrix(3),
            "MAT4" => Self::Matrix(4),
            _ => return None,
        })
    }

    pub fn width(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector(width) => width,
            Self::Matrix(side) => side * side,
        }
    }

    /// Bytes of an element. Columns of matrices begin at multiples of four.
    fn bytes(self, component: Component) -> usize {
        match self {
            Self::Matrix(side) => (side * component.size()).next_multiple_of(4) * side,
            _ => self.width() * component.size(),
        }
    }

    /// Bytes of the last element: its last column has no padding.
    fn bytes_of_last(self, component: Component) -> usize {
        match self {
            Self::Matrix(side) => {
                (side * component.size()).next_multiple_of(4) * (side - 1) + side * component.size()
            }
            _ => self.bytes(component),
        }
    }
}

impl fmt::Display for Shape {
    /// As the file writes it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scalar => formatter.write_str("SCALAR"),
            Self::Vector(width) => write!(formatter, "VEC{width}"),
            Self::Matrix(side) => write!(formatter, "MAT{side}"),
        }
    }
}

impl fmt::Display for Component {
    /// As the specification calls it, with its number.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::I8 => "BYTE (5120)",
            Self::U8 => "UNSIGNED_BYTE (5121)",
            Self::I16 => "SHORT (5122)",
            Self::U16 => "UNSIGNED_SHORT (5123)",
            Self::U32 => "UNSIGNED_INT (5125)",
            Self::F32 => "FLOAT (5126)",
        })
    }
}

/// Elements at equal distances in the bytes of a view.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// From the first byte of the first element to the last byte of the last element.
    pub bytes: Bytes,
    pub stride: usize,
}

/// Elements that replace elements of the accessor's run.
#[derive(Clone, Debug)]
pub(crate) struct Sparse {
    pub count: usize,
    pub index_component: Component,
    pub indices: Run,
    pub values: Run,
}

/// A checked accessor.
#[derive(Clone, Debug)]
pub(crate) struct Accessor {
    pub component: Component,
    pub is_normalized: bool,
    pub shape: Shape,
    pub count: usize,
    /// If this is `None` and `is_absent` is not set, all elements are zero, except those that `sparse` replaces.
    pub run: Option<Run>,
    /// Why it cannot be read, if the bytes of one of its views are compressed or not in the file.
    pub is_absent: Option<&'static str>,
    pub sparse: Option<Sparse>,
    /// The least and the greatest x, y, z … of all elements, as the file states them.
    pub min: Option<Vec<f64>>,
    pub max: Option<Vec<f64>>,
}

pub(crate) fn read_all(
    root: &Cursor<'_, '_>,
    views: &[View],
    findings: &mut Findings,
) -> Checked<Vec<Accessor>> {
    let list = root.list("accessors")?;
    let mut accessors = Vec::new();
    for cursor in list.iter() {
        let accessor = read(&cursor, views, findings);
        accessors.extend(findings.take(accessor));
        if findings.is_full() {
            break;
        }
    }
    Ok(accessors)
}

fn read(cursor: &Cursor<'_, '_>, views: &[View], findings: &mut Findings) -> Checked<Accessor> {
    let component = component(&cursor.required("componentType")?)?;
    let shape_cursor = cursor.required("type")?;
    let shape = Shape::of(shape_cursor.text()?)
        .ok_or_else(|| shape_cursor.error("the type is none of SCALAR, VEC2 to VEC4, MAT2 to MAT4"))?;
    let count_cursor = cursor.required("count")?;
    let count =
        usize::try_from(count_cursor.whole()?).map_err(|_| count_cursor.error("the count is too large"))?;
    if count == 0 {
        findings.add(count_cursor.warning("the accessor is empty", ""));
    }
    let is_normalized = cursor.truth_or("normalized", false)?;
    if is_normalized && matches!(component, Component::F32 | Component::U32) {
        findings.add(cursor.warning("\"normalized\" means nothing for 32-bit numbers", ""));
    }
    let mut is_absent = None;
    let run = match cursor.optional_index("bufferView", views.len(), "buffer view")? {
        None => {
            if let Some(offset) = cursor.member("byteOffset") {
                findings.add(offset.warning("an offset without a buffer view means nothing", ""));
            }
            None
        }
        Some(view) => {
            let view = &views[view];
            let place = Place { view, offset: cursor.whole_or("byteOffset", 0)?, count };
            is_absent = absence(view);
            place.run(cursor, component, shape, findings)?
        }
    };
    let sparse = cursor.object("sparse")?;
    let sparse =
        sparse.map(|sparse| read_sparse(&sparse, views, (component, shape, count), findings)).transpose()?;
    let sparse = match sparse {
        Some(Err(why)) => {
            is_absent = Some(why);
            None
        }
        Some(Ok(sparse)) => Some(sparse),
        None => None,
    };
    let bound = |name| bound(cursor, name, shape.width());
    let (min, max) = (bound("min")?, bound("max")?);
    Ok(Accessor { component, is_normalized, shape, count, run, is_absent, sparse, min, max })
}

fn component(cursor: &Cursor<'_, '_>) -> Checked<Component> {
    let code = cursor.whole()?;
    Component::of(code).ok_or_else(|| cursor.error(format!("{code} is no component type (5120 to 5126)")))
}

fn bound(cursor: &Cursor<'_, '_>, name: &'static str, width: usize) -> Checked<Option<Vec<f64>>> {
    let Some(member) = cursor.member(name) else { return Ok(None) };
    let list = member.clone().checked_list()?;
    if list.len() != width {
        return Err(member.error(format!("{} numbers stand where the type has {width}", list.len())));
    }
    list.iter().map(|item| item.number()).collect::<Checked<Vec<_>>>().map(Some)
}

fn absence(view: &View) -> Option<&'static str> {
    if view.is_compressed {
        Some("it is compressed with meshopt, which is not read")
    } else if view.bytes.is_none() {
        Some("its buffer has no data")
    } else {
        None
    }
}

/// Where elements are said to lie.
struct Place<'a> {
    view: &'a View,
    offset: u64,
    count: usize,
}

impl Place<'_> {
    fn run(
        &self,
        cursor: &Cursor<'_, '_>,
        component: Component,
        shape: Shape,
        findings: &mut Findings,
    ) -> Checked<Option<Run>> {
        let element = shape.bytes(component);
        let last = shape.bytes_of_last(component);
        let stride = self.view.stride.unwrap_or(element);
        if stride < element {
            return Err(
                cursor.error(format!("elements of {element} bytes overlap at the view's stride of {stride}"))
            );
        }
        if !(self.offset + self.view.offset).is_multiple_of(component.size() as u64)
            || !stride.is_multiple_of(component.size())
        {
            findings.add(
                cursor
                    .warning(format!("the numbers are not aligned to their {} bytes", component.size()), ""),
            );
        }
        let len = match self.count as u64 {
            0 => Some(0),
            count => (count - 1).checked_mul(stride as u64).and_then(|bytes| bytes.checked_add(last as u64)),
        };
        let end = len.and_then(|len| len.checked_add(self.offset));
        let Some((len, _)) = len.zip(end).filter(|&(_, end)| end <= self.view.len) else {
            return Err(cursor.error(format!(
                "{} elements from byte {} on are beyond the view's {} bytes",
                self.count, self.offset, self.view.len
            )));
        };
        if self.view.is_compressed {
            return Ok(None);
        }
        Ok(self
            .view
            .bytes
            .as_ref()
            .and_then(|bytes| bytes.slice(self.offset, len))
            .map(|bytes| Run { bytes, stride }))
    }
}

fn read_sparse(
    cursor: &Cursor<'_, '_>,
    views: &[View],
    (value_component, shape, of_count): (Component, Shape, usize),
    findings: &mut Findings,
) -> Checked<Result<Sparse, &'static str>> {
    let count_cursor = cursor.required("count")?;
    let count = count_cursor.whole()?;
    if count == 0 {
        findings.add(count_cursor.warning("no element is replaced", ""));
    }
    if count > of_count as u64 {
        return Err(count_cursor.error(format!("{count} elements are replaced, and there are {of_count}")));
    }
    let count = count as usize;
    let indices_cursor = cursor.required("indices")?;
    let component_cursor = indices_cursor.required("componentType")?;
    let index_component = component(&component_cursor)?;
    if !matches!(index_component, Component::U8 | Component::U16 | Component::U32) {
        return Err(component_cursor.error("indices are unsigned integers"));
    }
    let mut read_run = |cursor: Cursor<'_, '_>, component, shape| -> Checked<Result<Run, &'static str>> {
        let view = cursor.required("bufferView")?.index(views.len(), "buffer view")?;
        let view = &views[view];
        if view.stride.is_some() {
            return Err(cursor.error("the view of a sparse accessor has no stride"));
        }
        let place = Place { view, offset: cursor.whole_or("byteOffset", 0)?, count };
        let run = place.run(&cursor, component, shape, findings)?;
        Ok(run.ok_or_else(|| absence(view).unwrap_or("its bytes are missing")))
    };
    let indices = read_run(indices_cursor.clone(), index_component, Shape::Scalar)?;
    let values = read_run(cursor.required("values")?, value_component, shape)?;
    Ok(indices.and_then(|indices| Ok(Sparse { count, index_component, indices, values: values? })))
}

impl Accessor {
    /// Fails if the numbers are compressed or not in the file.
    pub fn check_present(&self, cursor: &Cursor<'_, '_>) -> Checked<()> {
        match self.is_absent {
            None => Ok(()),
            Some(why) => {
                let message = format!("the accessor cannot be read: {why}");
                Err(Box::new(cursor.finding(Severity::Unsupported, message, "export without compression")))
            }
        }
    }
}
