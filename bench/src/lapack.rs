//! OpenBLAS's `dgetrf`, loaded while running: nothing is linked, and without it the rest still runs.
#![allow(unsafe_code)]

use libloading::Library;

type Getrf<T> = unsafe extern "C" fn(*const i32, *const i32, *mut T, *const i32, *mut i32, *mut i32);

/// Names under which Debian and others install the library; first those that cannot be another BLAS.
const NAMES: [&str; 5] = [
    "/usr/lib/x86_64-linux-gnu/openblas-pthread/libopenblas.so.0",
    "/usr/lib/x86_64-linux-gnu/openblas-serial/libopenblas.so.0",
    "/usr/lib/aarch64-linux-gnu/openblas-pthread/libopenblas.so.0",
    "libopenblas.so.0",
    "libopenblas.so",
];

/// The factorizations of one library, on one thread.
pub struct Lapack {
    double: Getrf<f64>,
    single: Getrf<f32>,
    /// Version and chosen processor, as the library says.
    pub name: String,
    core: String,
    _library: Library,
}

impl Lapack {
    /// Loads OpenBLAS; the error says what to install.
    pub fn load() -> Result<Self, String> {
        let first = Self::open()?;
        let Some(better) = modern(&first.core) else { return Ok(first) };
        // It reads the variable once, when it is loaded.
        drop(first);
        // SAFETY: nothing else runs yet.
        unsafe { std::env::set_var("OPENBLAS_CORETYPE", better) };
        let second = Self::open()?;
        match modern(&second.core) {
            None => Ok(second),
            Some(_) => Err(format!("OpenBLAS takes its kernels for {}; set OPENBLAS_CORETYPE={better}", second.core)),
        }
    }

    fn open() -> Result<Self, String> {
        // SAFETY: OpenBLAS's initialization asks the processor and allocates; the types are those of LAPACK's
        // Fortran interface with 32-bit integers and of OpenBLAS's own functions.
        unsafe {
            // Its threads, once started, would disturb what is timed.
            std::env::set_var("OPENBLAS_NUM_THREADS", "1");
            let library = NAMES
                .iter()
                .find_map(|name| Library::new(name).ok())
                .ok_or("no OpenBLAS; Debian: apt-get install libopenblas0-pthread")?;
            let double = *library.get::<Getrf<f64>>(b"dgetrf_\0").map_err(|e| e.to_string())?;
            let single = *library.get::<Getrf<f32>>(b"sgetrf_\0").map_err(|e| e.to_string())?;
            let set: libloading::Symbol<unsafe extern "C" fn(i32)> =
                library.get(b"openblas_set_num_threads\0").map_err(|e| e.to_string())?;
            set(1);
            let config: libloading::Symbol<unsafe extern "C" fn() -> *const std::ffi::c_char> =
                library.get(b"openblas_get_config\0").map_err(|e| e.to_string())?;
            let core: libloading::Symbol<unsafe extern "C" fn() -> *const std::ffi::c_char> =
                library.get(b"openblas_get_corename\0").map_err(|e| e.to_string())?;
            let text = |pointer| std::ffi::CStr::from_ptr(pointer).to_string_lossy().into_owned();
            let config = text(config());
            let version: Vec<&str> = config.split_whitespace().take(2).collect();
            let core = text(core());
            let name = format!("{} ({core})", version.join(" "));
            Ok(Self { double, single, name, core, _library: library })
        }
    }

    /// LU of the n × n matrix `a` in place. Panics when LAPACK refuses it.
    pub fn dgetrf(&self, a: &mut [f64], ld: usize, n: usize, pivots: &mut [i32]) {
        run(self.double, a, ld, n, pivots);
    }

    /// The same in single precision.
    pub fn sgetrf(&self, a: &mut [f32], ld: usize, n: usize, pivots: &mut [i32]) {
        run(self.single, a, ld, n, pivots);
    }
}

/// The kernels that OpenBLAS should have taken on this processor, where it does not know it and took old ones.
fn modern(core: &str) -> Option<&'static str> {
    #[cfg(target_arch = "x86_64")]
    if ["Prescott", "Core2", "Nehalem", "Generic"].iter().any(|old| old.eq_ignore_ascii_case(core)) {
        if std::is_x86_feature_detected!("avx512f") && std::is_x86_feature_detected!("avx512bw") {
            return Some("SkylakeX");
        }
        if std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma") {
            return Some("Haswell");
        }
    }
    let _ = core;
    None
}

fn run<T>(getrf: Getrf<T>, a: &mut [T], ld: usize, n: usize, pivots: &mut [i32]) {
    assert!(ld >= n && a.len() >= ld * n && pivots.len() >= n);
    let (order, leading) = (i32::try_from(n).expect("small"), i32::try_from(ld).expect("small"));
    let mut info = 0;
    // SAFETY: the lengths were checked; the function keeps no pointer.
    unsafe { getrf(&order, &order, a.as_mut_ptr(), &leading, pivots.as_mut_ptr(), &mut info) };
    assert_eq!(info, 0, "getrf refused the matrix");
}

/// A matrix like those of the boundary systems: the unit matrix and something smaller.
pub fn diagonal_dominant(n: usize, ld: usize) -> Vec<f64> {
    let mut s = 1u64;
    let mut random = || {
        s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (s >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut a: Vec<f64> = (0..ld * n).map(|_| random() / n as f64).collect();
    a.iter_mut().step_by(ld + 1).for_each(|x| *x += 1.0);
    a
}
