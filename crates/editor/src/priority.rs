//! Lets long work give way to the window.

/// How far down the scale of `nice` long work steps, which has 20 steps.
#[cfg(target_os = "linux")]
const STEPS: i32 = 10;

/// From now on the calling thread, and every thread that it starts, gives way to the other threads of the program: to what
/// answers the mouse and draws the view. Does nothing where the system knows this for whole programs only.
pub(crate) fn give_way() {
    // If the system refuses, the work is done all the same.
    #[cfg(target_os = "linux")]
    let _as_before = rustix::process::nice(STEPS);
}

#[cfg(target_os = "linux")]
#[cfg(test)]
mod tests {
    use super::*;

    fn own() -> i32 {
        rustix::process::nice(0).unwrap()
    }

    #[test]
    fn only_the_thread_and_those_that_it_starts_give_way() {
        let before = own();
        let (itself, child) = std::thread::spawn(|| {
            give_way();
            (own(), std::thread::spawn(own).join().unwrap())
        })
        .join()
        .unwrap();
        assert_eq!([itself, child], [(before + STEPS).min(19); 2]);
        assert_eq!(own(), before);
    }
}
