use std::collections::BTreeSet;

use super::list::FAULTS;
use super::{SHADERS, planted};

#[test]
fn every_fault_fits_its_shader_and_has_a_name_of_its_own() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for fault in FAULTS {
        let text = std::fs::read_to_string(root.join(SHADERS).join(fault.file)).expect(fault.file);
        let faulty = planted(fault, &text).unwrap_or_else(|error| panic!("{error}"));
        assert_ne!(faulty, text, "{} changes nothing", fault.name);
        assert!(!fault.tests.is_empty(), "{}: no test is named that should notice the fault", fault.name);
    }
    let names: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.name).collect();
    assert_eq!(names.len(), FAULTS.len());
}
