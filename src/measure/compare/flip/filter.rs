//! Filters that run along rows, then along columns.

/// One number a pixel, row after row.
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f64>,
}

/// Weights around a pixel, from `-radius` to `radius`.
pub(super) struct Kernel(Vec<f64>);

impl Kernel {
    /// With a whole of one; and the whole that it had.
    pub(super) fn gaussian(deviation: f64, radius: usize) -> (Self, f64) {
        let weights: Vec<f64> = offsets(radius).map(|x| bell(x, deviation)).collect();
        let whole: f64 = weights.iter().sum();
        (Self(weights.iter().map(|w| w / whole).collect()), whole)
    }

    /// The first derivative: strong where light and dark meet.
    pub(super) fn edge(deviation: f64, radius: usize) -> Self {
        Self::balanced(offsets(radius).map(|x| -x * bell(x, deviation)))
    }

    /// The second derivative: strong at points and lines.
    pub(super) fn point(deviation: f64, radius: usize) -> Self {
        let squared = deviation * deviation;
        Self::balanced(offsets(radius).map(|x| (x * x / squared - 1.0) * bell(x, deviation)))
    }

    /// Positive weights with a whole of one, negative weights with a whole of minus one.
    fn balanced(weights: impl Iterator<Item = f64>) -> Self {
        let weights: Vec<f64> = weights.collect();
        let whole = |sign: f64| -> f64 { weights.iter().map(|w| (sign * w).max(0.0)).sum() };
        let (above, below) = (whole(1.0), whole(-1.0));
        Self(weights.iter().map(|w| w / if *w > 0.0 { above } else { below }).collect())
    }
}

fn offsets(radius: usize) -> impl Iterator<Item = f64> {
    (0..=2 * radius).map(move |i| i as f64 - radius as f64)
}

fn bell(x: f64, deviation: f64) -> f64 {
    libm::exp(-x * x / (2.0 * deviation * deviation))
}

impl Plane {
    /// Along rows by one kernel, then along columns by the other. Beyond the border stands its nearest pixel.
    pub(super) fn filtered(&self, along_x: &Kernel, along_y: &Kernel) -> Self {
        let (w, h) = (self.width, self.height);
        let rows = convolved(&along_x.0, w, self.values.len(), |i, x| self.values[i / w * w + x], |i| i % w);
        let values = convolved(&along_y.0, h, rows.len(), |i, y| rows[y * w + i % w], |i| i / w);
        Self { width: w, height: h, values }
    }
}

/// `value(i, place)` is what stands at a place on the line through number `i`, which is `len` long.
fn convolved(
    kernel: &[f64],
    len: usize,
    count: usize,
    value: impl Fn(usize, usize) -> f64,
    place: impl Fn(usize) -> usize,
) -> Vec<f64> {
    let radius = kernel.len() / 2;
    (0..count)
        .map(|i| {
            let weighted = kernel.iter().enumerate().map(|(k, weight)| {
                let at = (place(i) + k).saturating_sub(radius).min(len - 1);
                weight * value(i, at)
            });
            weighted.sum()
        })
        .collect()
}
