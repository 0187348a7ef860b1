//! Numbers as keys of either kind take them.

use toml::Value;

/// Above this not every whole number is a floating-point one.
const LARGEST: f64 = 9_007_199_254_740_992.0;

/// The value with whole numbers written without a point: keys that count things refuse `4.0`, and all others take `4`.
pub(super) fn whole(value: &Value) -> Value {
    match value {
        Value::Float(x) if x.fract() == 0.0 && x.abs() <= LARGEST => Value::Integer(*x as i64),
        Value::Array(values) => Value::Array(values.iter().map(whole).collect()),
        value => value.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_numbers_lose_their_point() {
        let text = |x: f64| whole(&Value::Float(x)).to_string();
        assert_eq!([4.0, -0.0, -3.0, 2.5].map(text), ["4", "0", "-3", "2.5"]);
        assert_eq!(text(LARGEST), "9007199254740992");
        assert_eq!(text(1e300), Value::Float(1e300).to_string());
        for x in [f64::NAN, f64::INFINITY] {
            assert!(matches!(whole(&Value::Float(x)), Value::Float(_)));
        }
        let mixed = vec![Value::Float(1.0), Value::String("a".into()), Value::Array(vec![Value::Float(2.0)])];
        assert_eq!(whole(&Value::Array(mixed)).to_string(), "[1, \"a\", [2]]");
    }
}
