//! Labels: `*t*` is italic, `_{0}` a subscript, `^{2}` a superscript.

use std::fmt::Write;

/// Text escaped for XML.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Body of an SVG `<text>` of font size `size` for a label in the small markup above.
pub fn spans(label: &str, size: f64) -> String {
    let mut out = String::new();
    let mut italic = false;
    // Height above the baseline that the next run has to come back from.
    let mut lift = 0.0;
    let mut rest = label;
    while !rest.is_empty() {
        if let Some(tail) = rest.strip_prefix('*') {
            italic = !italic;
            rest = tail;
            continue;
        }
        let script = [("_{", 0.22), ("^{", -0.36)]
            .into_iter()
            .find(|(p, _)| rest.starts_with(p));
        let (run, shift, tail) = match script.and_then(|(_, s)| Some((s, rest.find('}')?))) {
            Some((shift, end)) => (&rest[2..end], shift * size, &rest[end + 1..]),
            None => {
                // A script that is never closed is plain text, and so must be stepped over.
                let skip = if script.is_some() { 2 } else { 0 };
                let end = ["*", "_{", "^{"]
                    .iter()
                    .filter_map(|p| rest[skip..].find(p))
                    .min();
                let end = end.map_or(rest.len(), |e| e + skip);
                (&rest[..end], 0.0, &rest[end..])
            }
        };
        let style = if italic {
            r#" font-style="italic""#
        } else {
            ""
        };
        let small = if shift == 0.0 { size } else { 0.7 * size };
        // Writing to a string cannot fail.
        let _ = write!(
            out,
            r#"<tspan{style} font-size="{small:.2}" dy="{:.2}">{}</tspan>"#,
            shift - lift,
            escape(run)
        );
        lift = shift;
        rest = tail;
    }
    out
}

/// Knot name for reading: `7_4` becomes 7₄.
pub fn knot_name(name: &str) -> String {
    let digits = ['₀', '₁', '₂', '₃', '₄', '₅', '₆', '₇', '₈', '₉'];
    let factor = |name: &str| match name.split_once('_') {
        Some((crossings, index)) => {
            let low = index
                .chars()
                .map(|c| c.to_digit(10).map_or(c, |d| digits[d as usize]));
            crossings.chars().chain(low).collect()
        }
        None => name.to_owned(),
    };
    let factors: Vec<String> = name.split('#').map(factor).collect();
    factors.join("#")
}

/// Number for reading: at most `places` decimals, none that are zero, a true minus sign.
pub fn number(value: f64, places: usize) -> String {
    let text = format!("{value:.places$}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text.as_str()
    };
    if text == "-0" {
        "0".to_owned()
    } else {
        text.replace('-', "−")
    }
}

/// Number with `digits` significant digits; beyond 0.001 and 100 000 as a multiple of a power of ten.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return number(value, 0);
    }
    let exponent = value.abs().log10().floor() as i32;
    let places = |e: i32| (digits as i32 - 1 - e).max(0) as usize;
    if (-3..5).contains(&exponent) {
        return number(value, places(exponent));
    }
    let mantissa = number(value / 10.0_f64.powi(exponent), places(0));
    format!("{mantissa}·{}", power_of_ten(exponent))
}

fn power_of_ten(exponent: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let high = exponent.to_string();
    let high = high
        .chars()
        .map(|c| c.to_digit(10).map_or('⁻', |d| digits[d as usize]));
    "10".chars().chain(high).collect()
}

/// Number with a fixed count of decimals and a true minus sign.
pub fn fixed(value: f64, places: usize) -> String {
    let text = format!("{value:.places$}");
    // a zero has no sign
    match text.strip_prefix('-') {
        Some(zero) if !zero.contains(|c: char| ('1'..='9').contains(&c)) => zero.to_owned(),
        Some(size) => format!("−{size}"),
        None => text,
    }
}

/// The same of a number that may be missing: then a dash.
pub fn optional(value: Option<f64>, places: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |v| fixed(v, places))
}

/// How often something happens.
pub fn times(n: usize) -> String {
    match n {
        0 => "never".to_owned(),
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        n => format!("{n} times"),
    }
}

/// Twist density for reading, with its sign.
pub fn signed(value: f64) -> String {
    let text = number(value, 2);
    if value > 0.0 {
        format!("+{text}")
    } else {
        text
    }
}

/// Tick of a logarithmic axis: plain between 0.001 and 1000, beyond a power of ten where it is one.
pub fn log_tick(value: f64) -> String {
    let exponent = value.log10();
    if (-3.01..3.01).contains(&exponent) {
        return number(value, 3);
    }
    if (exponent - exponent.round()).abs() > 1e-6 {
        return significant(value, 1);
    }
    power_of_ten(exponent.round() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_are_kept() {
        let label = |v| significant(v, 2);
        assert_eq!(
            [0.0, 0.00123, 12.34, -0.5, 2.3e-6, 4e7].map(label),
            ["0", "0.0012", "12", "−0.5", "2.3·10⁻⁶", "4·10⁷"]
        );
    }

    #[test]
    fn scripts_come_back_to_the_baseline() {
        let svg = spans("*E* / *E*_{0} now", 10.0);
        let dys: Vec<f64> = svg
            .split("dy=\"")
            .skip(1)
            .map(|s| s[..s.find('"').unwrap()].parse().unwrap())
            .collect();
        assert!(dys.iter().sum::<f64>().abs() < 1e-9 && dys.iter().any(|d| *d > 0.0));
        assert_eq!(svg.matches("italic").count(), 2);
    }

    #[test]
    fn broken_markup_stays_text() {
        assert!(spans("a_{b", 10.0).contains("_{b"));
        assert!(spans("x < y & z", 10.0).contains("x &lt; y &amp; z"));
    }

    #[test]
    fn names_and_numbers_read_well() {
        assert_eq!(knot_name("7_4"), "7₄");
        assert_eq!(knot_name("unknot"), "unknot");
        assert_eq!(knot_name("3_1#m10_24"), "3₁#m10₂₄");
        assert_eq!(number(-2.0, 2), "−2");
        assert_eq!(number(-0.001, 2), "0");
        assert_eq!(signed(1.75), "+1.75");
        assert_eq!([fixed(-0.0004, 3), fixed(-1.5, 2)], ["0.000", "−1.50"]);
        assert_eq!(
            [0.1, 1e-5, 0.001, 0.005, 1000.0, 2e-5].map(log_tick),
            ["0.1", "10⁻⁵", "0.001", "0.005", "1000", "2·10⁻⁵"]
        );
    }
}
