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
    _library: Library,
}

impl Lapack {
    /// Loads OpenBLAS; the error says what to install.
    pub fn load() -> Result<Self, String> {
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
            let name = format!("{} ({})", version.join(" "), text(core()));
            Ok(Self { double, single, name, _library: library })
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

fn run<T>(getrf: Getrf<T>, a: &mut [T], ld: usize, n: usize, pivots: &mut [i32]) {
    assert!(ld >= n && a.len() >= ld * n && pivots.len() >= n);
    let (order, leading) = (i32::try_from(n).expect("small"), i32::try_from(ld).expect("small"));
    let mut info = 0;
    // SAFETY: the lengths were checked; the function keeps no pointer.
    unsafe { getrf(&order, &order, a.as_mut_ptr(), &leading, pivots.as_mut_ptr(), &mut info) };
    assert_eq!(info, 0, "getrf refused the matrix");
}
