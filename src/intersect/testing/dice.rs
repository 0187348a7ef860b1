//! Seeded random numbers for loops too long for a shrinking test runner.

/// **Source:** Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014 (splitmix64).
#[derive(Clone)]
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// Below `n`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.word() % n as u64) as usize
    }
    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 / (1u64 << 53) as f64
    }
    /// In [lo, hi).
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }
    /// Either sign, magnitude 10^lo to 10^hi, all orders alike.
    pub(crate) fn magnitude(&mut self, lo: f64, hi: f64) -> f64 {
        let sign = if self.word() & 1 == 0 { 1.0 } else { -1.0 };
        sign * 10f64.powf(self.between(lo, hi))
    }
    /// In the cube [-1, 1)^3.
    pub(crate) fn point(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.between(-1.0, 1.0))
    }
    /// Of length one.
    pub(crate) fn heading(&mut self) -> [f64; 3] {
        loop {
            let p = self.point();
            let length2: f64 = p.iter().map(|x| x * x).sum();
            if (1e-4..1.0).contains(&length2) {
                return p.map(|x| x / length2.sqrt());
            }
        }
    }
    /// A component as the hard cases have them: often zero, of a small grid, tiny, or far out.
    #[cfg(test)]
    pub(crate) fn hard(&mut self) -> f32 {
        match self.below(10) {
            0 => 0.0,
            1 => -0.0,
            2..5 => self.below(9) as f32 - 4.0,
            5 => self.magnitude(-30.0, 4.0) as f32,
            6 => (self.below(9) as f32 - 4.0).next_up(),
            _ => self.between(-4.0, 4.0) as f32,
        }
    }
}
