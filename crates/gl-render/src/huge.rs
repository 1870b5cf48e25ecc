//! Pictures so large that nothing is kept for the next one.

/// Pictures of more pixels are huge: making their targets anew costs little beside drawing them, and keeping all targets to the end of the
/// frame would take half as much memory again.
const HUGE_PX: u64 = 16 << 20;

/// Whether each target of a picture of this size is let go as soon as it has served.
pub(crate) fn is_huge(size_px: [u32; 2]) -> bool {
    size_px.map(u64::from).iter().product::<u64>() > HUGE_PX
}
