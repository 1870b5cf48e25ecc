//! Loading C libraries and their functions at run time.

use std::ffi::CStr;

use libloading::Library;

/// The first of these libraries that loads.
pub(super) fn first_library(names: &[&str]) -> Result<Library, String> {
    let mut first_reason = None;
    for name in names {
        // SAFETY: these are system libraries whose start-up code does nothing but set itself up.
        match unsafe { Library::new(name) } {
            Ok(library) => return Ok(library),
            Err(error) => first_reason = first_reason.or(Some(error.to_string())),
        }
    }
    Err(first_reason.unwrap_or_else(|| "no library is known for this system".to_owned()))
}

/// The function of this name.
///
/// # Safety
///
/// `T` must be the type of that function.
pub(super) unsafe fn symbol<T: Copy>(library: &Library, name: &CStr) -> Result<T, String> {
    // SAFETY: the caller vouches for the type.
    unsafe { library.get::<T>(name.to_bytes_with_nul()) }
        .map(|found| *found)
        .map_err(|error| error.to_string())
}
