//! Numbers on the command line that are counts: out of range, they are refused before anything is made of them.

/// Most threads.
pub const MOST_JOBS: usize = 1024;

/// Reads a whole number from `least` to `most`.
pub fn from(
    least: usize,
    most: usize,
) -> impl Fn(&str) -> Result<usize, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.parse().ok();
        number
            .filter(|n| (least..=most).contains(n))
            .ok_or_else(|| format!("give a whole number from {least} to {most}"))
    }
}

#[cfg(test)]
mod tests {
    use crate::cli::Cli;
    use clap::Parser;

    #[test]
    fn counts_out_of_range_are_refused_with_option_and_number() {
        for (words, option) in [
            ("knot identify a.csv", "--closures"),
            ("knot tighten 3_1", "--hops"),
            ("knot tighten 3_1", "--inversions"),
            ("knot tighten 3_1", "--jobs"),
            ("figures", "--jobs"),
            ("run a.toml", "--jobs"),
        ] {
            let parse = |number: &str| {
                let words = ["topo"].into_iter().chain(words.split(' '));
                Cli::try_parse_from(words.chain([option, number]))
            };
            assert!(parse("7").is_ok(), "{words} {option}");
            for number in ["1000000000000", "99999999999999999999999", "1.5", "many"] {
                let error = parse(number).unwrap_err();
                let said = error.to_string();
                assert_eq!(error.exit_code(), 2);
                assert!(said.contains(option) && said.contains(number), "{said}");
            }
        }
        let closures = |n| ["topo", "knot", "identify", "a.csv", "--closures", n];
        assert!(Cli::try_parse_from(closures("0")).is_err());
        assert!(Cli::try_parse_from(closures("100000")).is_ok());
    }
}
