//! max q·(u, x) subject to half-planes, in two unknowns, one constraint after the other (Seidel 1991).

/// a u + b x ≤ c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HalfPlane {
    pub a: f64,
    pub b: f64,
    pub c: f64,
}

/// Relative to the sizes of a constraint's terms.
const ROUNDING: f64 = 1e-12;

impl HalfPlane {
    fn excess(&self, [u, x]: [f64; 2]) -> f64 {
        self.a * u + self.b * x - self.c
    }

    fn holds(&self, [u, x]: [f64; 2]) -> bool {
        self.excess([u, x]) <= ROUNDING * (self.a * u).abs().max((self.b * x).abs()).max(self.c.abs())
    }
}

/// The best point within a box and all half-planes; `None` if there is none.
pub(super) fn maximize(q: [f64; 2], bounds: [[f64; 2]; 2], planes: &[HalfPlane]) -> Option<[f64; 2]> {
    let corner = |k: usize| if q[k] >= 0.0 { bounds[k][1] } else { bounds[k][0] };
    let mut best = [corner(0), corner(1)];
    for (k, plane) in planes.iter().enumerate() {
        if !plane.holds(best) {
            best = on_line(q, bounds, plane, &planes[..k])?;
        }
    }
    Some(best)
}

/// The best point on the edge of a half-plane, p + t w.
fn on_line(q: [f64; 2], bounds: [[f64; 2]; 2], line: &HalfPlane, planes: &[HalfPlane]) -> Option<[f64; 2]> {
    let square = line.a * line.a + line.b * line.b;
    if !(square > 0.0) {
        return None; // 0 ≤ c does not hold
    }
    let (p, w) = ([line.a * line.c / square, line.b * line.c / square], [-line.b, line.a].map(|x| x / square.sqrt()));
    let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
    let mut cut = |slope: f64, room: f64, scale: f64| {
        // slope t ≤ room
        if slope > 0.0 {
            high = high.min(room / slope);
        } else if slope < 0.0 {
            low = low.max(room / slope);
        } else if room < -ROUNDING * scale {
            high = f64::NEG_INFINITY;
        }
    };
    for k in 0..2 {
        cut(w[k], bounds[k][1] - p[k], bounds[k][1].abs());
        cut(-w[k], p[k] - bounds[k][0], bounds[k][0].abs());
    }
    for plane in planes {
        let scale = (plane.a * p[0]).abs().max((plane.b * p[1]).abs()).max(plane.c.abs());
        let slope = plane.a * w[0] + plane.b * w[1];
        let slope = if slope.abs() <= 1e-14 * plane.a.hypot(plane.b) { 0.0 } else { slope };
        cut(slope, -plane.excess(p), scale);
    }
    if low > high + ROUNDING * low.abs().max(high.abs()) {
        return None;
    }
    let t = if q[0] * w[0] + q[1] * w[1] >= 0.0 { high } else { low };
    Some([p[0] + t * w[0], p[1] + t * w[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::random::Random;

    /// The best of all corners, the intersections of two lines.
    fn by_corners(q: [f64; 2], bounds: [[f64; 2]; 2], planes: &[HalfPlane]) -> Option<[f64; 2]> {
        let [[u0, u1], [x0, x1]] = bounds;
        let mut all = planes.to_vec();
        all.extend([(1.0, 0.0, u1), (-1.0, 0.0, -u0), (0.0, 1.0, x1), (0.0, -1.0, -x0)].map(|(a, b, c)| HalfPlane {
            a,
            b,
            c,
        }));
        let mut best: Option<[f64; 2]> = None;
        for (k, p) in all.iter().enumerate() {
            for r in &all[..k] {
                let D = p.a * r.b - p.b * r.a;
                let at = [(p.c * r.b - p.b * r.c) / D, (p.a * r.c - p.c * r.a) / D];
                let value = |at: [f64; 2]| q[0] * at[0] + q[1] * at[1];
                if D != 0.0
                    && all.iter().all(|plane| plane.excess(at) < 1e-9)
                    && best.is_none_or(|b| value(at) > value(b))
                {
                    best = Some(at);
                }
            }
        }
        best
    }

    #[test]
    fn as_the_best_corner() {
        let (mut random, mut feasible) = (Random(3), 0);
        for _ in 0..2000 {
            let count = 1 + (4.0 * (random.next() + 1.0)) as usize;
            let planes: Vec<HalfPlane> =
                (0..count).map(|_| random.array()).map(|[a, b, c]: [f64; 3]| HalfPlane { a, b, c: c + 0.4 }).collect();
            let (q, bounds) = (random.array(), [[-2.0, 3.0], [-1.0, 2.0]]);
            let (found, expected) = (maximize(q, bounds, &planes), by_corners(q, bounds, &planes));
            assert_eq!(found.is_some(), expected.is_some(), "{planes:?}");
            if let (Some(a), Some(b)) = (found, expected) {
                feasible += 1;
                assert!((q[0] * (a[0] - b[0]) + q[1] * (a[1] - b[1])).abs() < 1e-9, "{planes:?} {q:?}: {a:?} {b:?}");
            }
        }
        assert!(feasible > 500 && feasible < 2000);
    }
}
