//! Numbers as they are added up and written: zero has no sign.

/// 0 without values, where [`Iterator::sum`] is −0.
pub fn sum(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |sum, value| sum + value)
}

/// A number with so many decimals; what rounds to zero has no minus before it.
pub fn decimals(value: f64, count: usize) -> String {
    let text = format!("{value:.count$}");
    match text.strip_prefix('-') {
        Some(zero) if zero.bytes().all(|byte| b"0.".contains(&byte)) => zero.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_sign() {
        assert!(sum([]).is_sign_positive() && sum([-0.0]).is_sign_positive());
        assert_eq!(sum([1.5, -0.5]), 1.0);
        assert_eq!(decimals(-0.0, 1), "0.0");
        assert_eq!(decimals(-0.0, 0), "0");
        assert_eq!(decimals(-0.0004, 3), "0.000");
        assert_eq!(decimals(-0.0005001, 3), "-0.001");
        assert_eq!(decimals(12.34, 1), "12.3");
        assert_eq!(decimals(f64::NAN, 1), "NaN");
    }
}
