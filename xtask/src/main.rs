//! Automation of the repository.

mod meshes;

fn main() -> anyhow::Result<()> {
    meshes::run(std::path::Path::new("."))
}
