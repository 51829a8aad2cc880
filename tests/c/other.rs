//! Another static library in Rust, with the standard library, a panic that is caught, and threads' local storage: everything
//! that two such libraries could both define.

thread_local!(static CALLS: std::cell::Cell<usize> = const { std::cell::Cell::new(0) });

/// Returns 42 by detours.
#[unsafe(no_mangle)]
pub extern "C" fn other() -> usize {
    CALLS.set(CALLS.get() + 1);
    std::panic::set_hook(Box::new(|_| {}));
    let caught = std::panic::catch_unwind(|| {
        let digits: Vec<String> = (0..5).map(|i| i.to_string()).collect();
        digits.join("").parse::<usize>().map(|n| [n][n]).unwrap_or(0)
    });
    if caught.is_err() { 41 + CALLS.get() } else { 0 }
}
