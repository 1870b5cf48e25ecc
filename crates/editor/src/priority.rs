//! Lets long work give way to the window.

/// How much long work adds to its `nice` value, which usually is 0 and is 19 at most.
#[cfg(target_os = "linux")]
const STEPS: i32 = 10;

/// Makes the calling thread, and every thread that it starts from now on, give way to the program's other threads,
/// which answer the mouse and draw the view. Does nothing on systems that set a priority only for whole programs.
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
