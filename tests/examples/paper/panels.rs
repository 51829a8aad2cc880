//! The constant-panel scheme (8.5 of the paper), to compare with: straight panels, potential and data constant on each, the
//! direct formulation (8.2) with its logarithms, collocation at the midpoints, the boundary formula (2.15). Only what the
//! experiment 9.2 needs: equal ellipses in unbounded fluid. Nothing of it is shared with the library but the factorization.

use nekton::integrate::System;
use nekton::lu::{Factors, factor};
use nekton::status::Result;
use std::f64::consts::{PI, TAU};

type Point = [f64; 2];

/// One panel of the outline in the body's frame.
#[derive(Clone, Copy)]
struct Panel {
    ends: [Point; 2],
    middle: Point,
    tangent: Point,
    length: f64,
    /// Curvature of the outline at the middle.
    curvature: f64,
    /// Length between the middles of both neighbours.
    span: f64,
}

/// Equal ellipses of the fluid's density 1.
pub struct Panels {
    panels: Vec<Panel>,
    bodies: usize,
    mass: f64,
    inertia: f64,
    /// ∫ log over every panel from every middle of the same body.
    own_logs: Vec<f64>,
    own_angles: Vec<f64>,
    /// Evaluations so far.
    pub evaluations: usize,
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The angle under which a panel is seen from x, and the integral of log|x' - x| over it, both in closed form.
fn seen(ends: [Point; 2], tangent: Point, x: Point) -> (f64, f64) {
    let (a, b) = (minus(ends[0], x), minus(ends[1], x));
    let (u0, u1, v) = (dot(a, tangent), dot(b, tangent), cross(tangent, a));
    let primitive = |u: f64| 0.5 * u * (u * u + v * v).ln() - u + if v == 0.0 { 0.0 } else { v * (u / v).atan() };
    (cross(a, b).atan2(dot(a, b)), primitive(u1) - primitive(u0))
}

impl Panels {
    /// `bodies` ellipses of half-axes a and b with `n` panels each.
    pub fn new(a: f64, b: f64, n: usize, bodies: usize) -> Self {
        let point = |t: f64| [a * t.cos(), b * t.sin()];
        let mut panels: Vec<Panel> = (0..n)
            .map(|k| {
                let t = |shift: f64| TAU * (k as f64 + shift) / n as f64;
                let ends = [point(t(0.0)), point(t(1.0))];
                let d = minus(ends[1], ends[0]);
                let length = dot(d, d).sqrt();
                let (s, c) = t(0.5).sin_cos();
                Panel {
                    ends,
                    middle: [0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1])],
                    tangent: [d[0] / length, d[1] / length],
                    length,
                    curvature: a * b / (a * a * s * s + b * b * c * c).powf(1.5),
                    span: 0.0,
                }
            })
            .collect();
        for k in 0..n {
            let (before, after) = (panels[(k + n - 1) % n].length, panels[(k + 1) % n].length);
            panels[k].span = panels[k].length + 0.5 * (before + after);
        }
        let (mut own_logs, mut own_angles) = (vec![0.0; n * n], vec![0.0; n * n]);
        for j in 0..n {
            for i in 0..n {
                let (angle, log) = seen(panels[j].ends, panels[j].tangent, panels[i].middle);
                own_logs[j * n + i] = log;
                // A straight panel is seen from its own middle under no angle.
                own_angles[j * n + i] = if i == j { 0.0 } else { angle };
            }
        }
        let mass = PI * a * b;
        let inertia = mass * (a * a + b * b) / 4.0;
        Panels { panels, bodies, mass, inertia, own_logs, own_angles, evaluations: 0 }
    }

    /// Accelerations at the positions q and velocities v of all bodies.
    fn accelerations(&mut self, q: &[f64], v: &[f64]) -> Result<Vec<f64>> {
        self.evaluations += 1;
        let (n, all, size) = (self.panels.len(), self.panels.len() * self.bodies, 3 * self.bodies);
        let turn = |body: usize, p: Point| {
            let (s, c) = q[3 * body + 2].sin_cos();
            [c * p[0] - s * p[1], s * p[0] + c * p[1]]
        };
        let place = |body: usize, p: Point| {
            let p = turn(body, p);
            [p[0] + q[3 * body], p[1] + q[3 * body + 1]]
        };
        // Panels in the world.
        let world: Vec<(usize, [Point; 2], Point, Point)> = (0..self.bodies)
            .flat_map(|body| {
                self.panels
                    .iter()
                    .map(move |p| (body, p.ends.map(|e| place(body, e)), place(body, p.middle), turn(body, p.tangent)))
            })
            .collect();
        // Normal out of the fluid, into the body; data of the three unit motions of each body.
        let normal = |k: usize| [-world[k].3[1], world[k].3[0]];
        let arm = |k: usize| minus(world[k].2, [q[3 * world[k].0], q[3 * world[k].0 + 1]]);
        let data = |k: usize| {
            let (n, x) = (normal(k), arm(k));
            [n[0], n[1], cross(x, n)]
        };
        let (mut matrix, mut sides) = (vec![0.0; all * all], vec![0.0; all * size]);
        for j in 0..all {
            let b = data(j);
            for i in 0..all {
                let (angle, log) = if world[i].0 == world[j].0 {
                    (self.own_angles[(j % n) * n + i % n], self.own_logs[(j % n) * n + i % n])
                } else {
                    seen(world[j].1, world[j].3, world[i].2)
                };
                matrix[j * all + i] = angle / PI + if i == j { 1.0 } else { 0.0 };
                for (c, b) in b.iter().enumerate() {
                    sides[(3 * world[j].0 + c) * all + i] -= log * b / PI;
                }
            }
        }
        let mut pivots = vec![0; all];
        factor(&mut matrix, all, all, &mut pivots)?;
        let factors = Factors { lu: &matrix, ld: all, pivots: &pivots };
        sides.chunks_exact_mut(all).for_each(|side| factors.solve(side));
        let panel = |k: usize| &self.panels[k % n];
        // Added mass, symmetrized, and the mass of the bodies.
        let mut mass = vec![0.0; size * size];
        for (a, psi) in sides.chunks_exact(all).enumerate() {
            for k in 0..all {
                for (c, b) in data(k).iter().enumerate() {
                    let part = 0.5 * psi[k] * b * panel(k).length;
                    mass[a * size + 3 * world[k].0 + c] += part;
                    mass[(3 * world[k].0 + c) * size + a] += part;
                }
            }
        }
        for body in 0..self.bodies {
            for (c, m) in [self.mass, self.mass, self.inertia].into_iter().enumerate() {
                mass[(3 * body + c) * (size + 1)] += m;
            }
        }
        // The force (2.15), tangential derivatives by central differences.
        let slope = |psi: &[f64], k: usize| {
            let (body, k) = (k / n * n, k % n);
            (psi[body + (k + 1) % n] - psi[body + (k + n - 1) % n]) / self.panels[k].span
        };
        let mut total = vec![0.0; all];
        for (psi, v) in sides.chunks_exact(all).zip(v) {
            total.iter_mut().zip(psi).for_each(|(t, p)| *t += v * p);
        }
        let mut force = vec![0.0; size];
        for k in 0..all {
            let body = world[k].0;
            let u = &v[3 * body..3 * body + 3];
            let (normal, b, ds) = (normal(k), data(k), panel(k).length);
            let reach = dot(arm(k), normal);
            let speed: f64 = b.iter().zip(u).map(|(b, u)| b * u).sum();
            let xi = -normal[1] * u[0] + normal[0] * u[1] + reach * u[2];
            let s = panel(k).curvature * (xi * xi - speed * speed) + 2.0 * xi * u[2] - reach * u[2] * u[2];
            let along = slope(&total, k);
            for (a, psi) in sides.chunks_exact(all).enumerate() {
                force[a] += ds * (psi[k] * s - slope(psi, k) * along * speed);
            }
            for (c, b) in b.iter().enumerate() {
                force[3 * body + c] += 0.5 * ds * (along * along + speed * speed) * b;
            }
        }
        let columns: Vec<Vec<f64>> = mass.chunks_exact(size).map(<[f64]>::to_vec).collect();
        let mut acceleration = nekton_tests::solve(&columns, &force);
        acceleration.iter_mut().for_each(|x| *x = -*x);
        Ok(acceleration)
    }
}

impl System<f64> for Panels {
    fn dim(&self) -> usize {
        6 * self.bodies
    }
    fn rhs(&mut self, _t: f64, y: &[f64], dydt: &mut [f64]) -> Result<()> {
        let (q, v) = y.split_at(3 * self.bodies);
        let (dq, dv) = dydt.split_at_mut(3 * self.bodies);
        dq.copy_from_slice(v);
        dv.copy_from_slice(&self.accelerations(q, v)?);
        Ok(())
    }
}
