use nekton::scene::Quadrature;
use nekton_bench::rows::ellipses;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n = |i: usize| a[i].parse::<usize>().unwrap();
    let gap: f64 = a[3].parse().unwrap();
    let q = if a[6] == "plain" { Quadrature::Plain } else { Quadrature::Graded };
    let mut e = ellipses(n(1), n(2), gap, n(4), q);
    e.run();
    let mut r = ellipses(n(1), n(2), gap, 320, Quadrature::Graded);
    r.run();
    let scale = r.accelerations().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let err = e.accelerations().iter().zip(r.accelerations()).fold(0.0f64, |m, (x, y)| m.max((x - y).abs())) / scale;
    print!("{} {} error {err:.1e}: ", a[4], a[6]);
    let mut times: Vec<f64> = (0..9)
        .map(|_| {
            let t = std::time::Instant::now();
            for _ in 0..n(5) {
                e.run();
            }
            t.elapsed().as_secs_f64() / n(5) as f64 * 1e6
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!("{:.1} us (min {:.1})", times[4], times[0]);
}
