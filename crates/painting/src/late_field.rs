//! The direction field of a body, solved only when it is asked for. Particles that are taken from a kept file have
//! directions without it.

use std::fmt;
use std::sync::{Arc, OnceLock};

use crate::field::BodyField;
use crate::made_once::made_once;

type Make = dyn Fn() -> Option<Arc<BodyField>> + Send + Sync;

/// A field that is solved already, or that is solved when it is first asked for.
pub(crate) struct LateField {
    field: OnceLock<Option<Arc<BodyField>>>,
    make: Option<Box<Make>>,
}

impl LateField {
    /// A field that is solved; `None` where the body needs none.
    pub(crate) fn solved(field: Option<Arc<BodyField>>) -> Self {
        Self { field: OnceLock::from(field), make: None }
    }

    /// A field that `make` solves when it is first asked for. `make` must always give the same field.
    pub(crate) fn later(make: impl Fn() -> Option<Arc<BodyField>> + Send + Sync + 'static) -> Self {
        Self { field: OnceLock::new(), make: Some(Box::new(make)) }
    }

    /// The field; `None` where the body has none.
    pub(crate) fn get(&self) -> Option<&BodyField> {
        made_once(&self.field, || self.make.as_ref().and_then(|make| make())).as_deref()
    }
}

impl fmt::Debug for LateField {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "LateField({})",
            if self.field.get().is_some() { "solved" } else { "not asked for" }
        )
    }
}
