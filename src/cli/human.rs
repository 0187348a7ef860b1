//! Numbers as people read them.

use std::time::Duration;

/// `4.92 M` for 4,915,200: three digits and a unit of thousands.
pub(super) fn count(value: u64) -> String {
    scaled(value as f64, &["", " k", " M", " G", " T"])
}

/// `34.1 MB` for a number of bytes.
pub(super) fn bytes(value: u64) -> String {
    scaled(value as f64, &[" B", " kB", " MB", " GB", " TB"])
}

/// `1.23 s`, `12.3 ms`, or `2 min 05 s` from two minutes on.
pub(super) fn time(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    match seconds {
        s if s >= 120.0 => format!("{} min {:02} s", duration.as_secs() / 60, duration.as_secs() % 60),
        s if s >= 0.9995 => format!("{} s", digits(s)),
        s => format!("{} ms", digits(s * 1e3)),
    }
}

/// Millions a second, or nothing when no time has passed.
pub(super) fn millions_a_second(value: u64, duration: Duration) -> Option<f64> {
    let seconds = duration.as_secs_f64();
    (seconds > 0.0).then(|| value as f64 / seconds / 1e6)
}

/// `12.3 Mrays/s`, or `- Mrays/s` when no time has passed.
pub(super) fn ray_rate(rays: u64, duration: Duration) -> String {
    let rate = millions_a_second(rays, duration).map_or("-".into(), digits);
    format!("{rate} Mrays/s")
}

fn scaled(value: f64, units: &[&str]) -> String {
    // The least unit in which three digits suffice.
    let index = units.iter().enumerate().position(|(i, _)| value / 1000f64.powi(i as i32) < 999.5);
    let index = index.unwrap_or(units.len() - 1);
    let scaled = value / 1000f64.powi(index as i32);
    let number = if index == 0 { format!("{scaled:.0}") } else { digits(scaled) };
    format!("{number}{}", units[index])
}

/// Three digits: `1.23`, `12.3`, `123`.
fn digits(value: f64) -> String {
    let decimals = if value < 9.995 {
        2
    } else if value < 99.95 {
        1
    } else {
        0
    };
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_three_digits() {
        let texts = [0, 7, 999, 1000, 4_915_200, 999_499, 999_500, 12_345_678, u64::MAX].map(count);
        assert_eq!(texts, ["0", "7", "999", "1.00 k", "4.92 M", "999 k", "1.00 M", "12.3 M", "18446744 T"]);
        assert_eq!(bytes(34_100_000), "34.1 MB");
        assert_eq!(bytes(12), "12 B");
    }

    #[test]
    fn times_have_their_unit() {
        let texts =
            [0.0, 0.0123, 0.9996, 1.234, 119.0, 125.0, 7261.0].map(|s| time(Duration::from_secs_f64(s)));
        assert_eq!(texts, ["0.00 ms", "12.3 ms", "1.00 s", "1.23 s", "119 s", "2 min 05 s", "121 min 01 s"]);
    }

    #[test]
    fn rates_survive_no_time() {
        assert_eq!(ray_rate(2_500_000, Duration::from_millis(500)), "5.00 Mrays/s");
        assert_eq!(ray_rate(1, Duration::ZERO), "- Mrays/s");
    }
}
