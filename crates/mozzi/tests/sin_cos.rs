//! `Scalar::sin_cos` at ten million points, in units of the last place, compared with sums of two `f64` (Dekker 1971),
//! good to 30 digits.

use mozzi::Scalar;

/// The sum of a number and of its rounding error.
#[derive(Clone, Copy)]
struct Two(f64, f64);

fn sum(a: f64, b: f64) -> Two {
    let s = a + b;
    let t = s - a;
    Two(s, (a - (s - t)) + (b - t))
}

fn product(a: f64, b: f64) -> Two {
    let halves = |x: f64| {
        let t = 134_217_729.0 * x; // 2²⁷ + 1
        let high = t - (t - x);
        (high, x - high)
    };
    let (p, (ah, al), (bh, bl)) = (a * b, halves(a), halves(b));
    Two(p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Two {
    fn plus(self, o: Two) -> Two {
        let Two(s, e) = sum(self.0, o.0);
        let Two(t, f) = sum(self.1, o.1);
        let Two(s, e) = sum(s, e + t);
        sum(s, e + f)
    }
    fn times(self, o: Two) -> Two {
        let Two(p, e) = product(self.0, o.0);
        sum(p, e + (self.0 * o.1 + self.1 * o.0))
    }
    fn over(self, k: f64) -> Two {
        let q = self.0 / k;
        let Two(p, e) = product(q, k);
        sum(q, ((self.0 - p) - e + self.1) / k)
    }
    fn minus(self) -> Two {
        Two(-self.0, -self.1)
    }
}

/// ±1/k!, k = first, first + 2, …
fn coefficients(first: usize) -> Vec<Two> {
    let factorial = |n: usize| (2..=n).fold(Two(1.0, 0.0), |x, k| x.over(k as f64));
    (0..14).map(|i| if i % 2 == 0 { factorial(first + 2 * i) } else { factorial(first + 2 * i).minus() }).collect()
}

struct Reference {
    sin: Vec<Two>,
    cos: Vec<Two>,
}

impl Reference {
    fn sin_cos(&self, x: f64) -> (Two, Two) {
        // π/2 to 161 bits
        const HALF_PI: [f64; 3] = [std::f64::consts::FRAC_PI_2, 6.123233995736766e-17, -1.4973849048591833e-33];
        let k = (x / HALF_PI[0]).round();
        let mut r = Two(x, 0.0);
        for part in HALF_PI {
            r = r.plus(product(-k, part));
        }
        let z = r.times(r);
        let series = |list: &[Two]| list.iter().rev().fold(Two(0.0, 0.0), |sum, &c| sum.times(z).plus(c));
        let (s, c) = (series(&self.sin).times(r), series(&self.cos));
        match k.rem_euclid(4.0) as i32 {
            0 => (s, c),
            1 => (c, s.minus()),
            2 => (s.minus(), c.minus()),
            _ => (c.minus(), s),
        }
    }
}

/// |found − reference| in units of the last of `digits` binary places of the reference.
fn ulps(found: f64, reference: Two, digits: i32) -> f64 {
    if found == reference.0 && reference.1 == 0.0 {
        return 0.0; // including 0
    }
    let unit = 2.0_f64.powi(reference.0.abs().log2().floor() as i32 - digits);
    ((found - reference.0) - reference.1).abs() / unit
}

/// The largest error of f64 and of f32 over `count` points.
fn worst(seed: u64, count: usize) -> [f64; 2] {
    let reference = Reference { sin: coefficients(1), cos: coefficients(0) };
    // numbers that fill [−1, 1) evenly: multiples of the golden ratio
    let mut t = seed as f64 * 0.1;
    let mut next = || {
        t = (t + 0.618_033_988_749_894_9).fract();
        2.0 * t - 1.0
    };
    let mut worst = [0.0_f64; 2];
    for k in 0..count {
        // equally many points in every decade, up to the bound; and near the zeros
        let x = next();
        let x = match k % 4 {
            0 => x * 3.2,
            1 => x * 10.0_f64.powf(3.0 + 3.0 * next()),
            2 => x * 1e6,
            _ => (x * 6e5).round() * std::f64::consts::FRAC_PI_2 * (1.0 + 1e-9 * next()),
        };
        let ((s, c), (rs, rc)) = (Scalar::sin_cos(x), reference.sin_cos(x));
        worst[0] = worst[0].max(ulps(s, rs, 52)).max(ulps(c, rc, 52));
        let x = (x * 8192e-6) as f32;
        let ((s, c), (rs, rc)) = (Scalar::sin_cos(x), reference.sin_cos(x.into()));
        for (found, reference) in [(s, rs), (c, rc)] {
            if reference.0.abs() > 1e-3 {
                worst[1] = worst[1].max(ulps(found.into(), reference, 23));
            }
        }
    }
    worst
}

#[test]
fn ten_million_points() {
    let all: Vec<[f64; 2]> = std::thread::scope(|scope| {
        let parts: Vec<_> = (0..4).map(|k| scope.spawn(move || worst(k, 2_500_000))).collect();
        parts.into_iter().map(|part| part.join().expect("no panic")).collect()
    });
    let [f64_worst, f32_worst] = all.into_iter().fold([0.0_f64; 2], |m, x| [m[0].max(x[0]), m[1].max(x[1])]);
    println!("f64 {f64_worst:.3} ulp, f32 {f32_worst:.3} ulp");
    assert!(f64_worst <= 1.0 && f32_worst <= 1.5, "f64 {f64_worst} ulp, f32 {f32_worst} ulp");
}
