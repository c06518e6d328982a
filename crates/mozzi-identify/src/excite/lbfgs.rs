//! Minimization of a smooth function: limited-memory BFGS with backtracking (Nocedal and Wright, algorithm 7.5).

/// Pairs that are kept.
const MEMORY: usize = 12;

/// Minimizes `f`, which returns its value and gradient, from `x`; the first step is at most `first` long. Ends after
/// `iterations`, if the value falls by less than `tolerance` of itself ten times in a row, or when `stop` returns true.
/// Returns the least value.
pub fn minimize(
    x: &mut Vec<f64>,
    iterations: usize,
    tolerance: f64,
    first: f64,
    mut f: impl FnMut(&[f64]) -> (f64, Vec<f64>),
    stop: &dyn Fn() -> bool,
) -> f64 {
    let (mut value, mut gradient) = f(x);
    let mut pairs: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let mut idle = 0;
    for _ in 0..iterations {
        if stop() || idle >= 10 {
            break;
        }
        let mut step = direction(&gradient, &pairs);
        let mut slope = dot(&step, &gradient);
        if !(slope < 0.0) {
            pairs.clear();
            step = gradient.iter().map(|g| -g).collect();
            slope = -dot(&gradient, &gradient);
        }
        let mut t = if pairs.is_empty() {
            (first / dot(&gradient, &gradient).sqrt().max(f64::MIN_POSITIVE)).min(1.0)
        } else {
            1.0
        };
        let mut accepted = None;
        for _ in 0..40 {
            let next: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x + t * s).collect();
            let (at, g) = f(&next);
            if at <= value + 1e-4 * t * slope {
                accepted = Some((next, at, g));
                break;
            }
            t *= 0.5;
        }
        let Some((next, at, g)) = accepted else {
            if pairs.is_empty() {
                break;
            }
            pairs.clear();
            continue;
        };
        let s: Vec<f64> = next.iter().zip(x.iter()).map(|(a, b)| a - b).collect();
        let y: Vec<f64> = g.iter().zip(&gradient).map(|(a, b)| a - b).collect();
        if dot(&s, &y) > 1e-12 * dot(&y, &y) {
            pairs.push((s, y));
            if pairs.len() > MEMORY {
                pairs.remove(0);
            }
        }
        idle = if value - at < tolerance * value.abs().max(1.0) { idle + 1 } else { 0 };
        (*x, value, gradient) = (next, at, g);
    }
    value
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Minus the inverse Hessian's estimate times the gradient, by the two-loop recursion.
fn direction(gradient: &[f64], pairs: &[(Vec<f64>, Vec<f64>)]) -> Vec<f64> {
    let mut q: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let mut alphas = Vec::with_capacity(pairs.len());
    for (s, y) in pairs.iter().rev() {
        let alpha = dot(s, &q) / dot(s, y);
        q.iter_mut().zip(y).for_each(|(q, y)| *q -= alpha * y);
        alphas.push(alpha);
    }
    if let Some((s, y)) = pairs.last() {
        let scale = dot(s, y) / dot(y, y);
        q.iter_mut().for_each(|q| *q *= scale);
    }
    for ((s, y), alpha) in pairs.iter().zip(alphas.into_iter().rev()) {
        let beta = dot(y, &q) / dot(s, y);
        q.iter_mut().zip(s).for_each(|(q, s)| *q += (alpha - beta) * s);
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_banana_is_solved() {
        let mut x = vec![-1.2, 1.0];
        let f = |x: &[f64]| {
            let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
            (a * a + 100.0 * b * b, vec![-2.0 * a - 400.0 * b * x[0], 200.0 * b])
        };
        let least = minimize(&mut x, 200, 1e-16, 0.1, f, &|| false);
        assert!(least < 1e-12 && (x[0] - 1.0).abs() < 1e-5, "{least:e} at {x:?}");
    }
}
