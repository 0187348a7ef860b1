//! Which SIMD instructions this build uses and which the CPU offers.

/// Instruction sets that matter to eight lanes of 32 bits, from least to most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Level {
    Scalar,
    Simd128,
    Neon,
    Sse2,
    Sse41,
    Avx,
    Avx2,
}

/// The level this build uses: `wide` chooses when it is compiled.
pub(super) const BUILT_FOR: Level = if cfg!(target_feature = "avx2") {
    Level::Avx2
} else if cfg!(target_feature = "avx") {
    Level::Avx
} else if cfg!(target_feature = "sse4.1") {
    Level::Sse41
} else if cfg!(target_feature = "sse2") {
    Level::Sse2
} else if cfg!(target_feature = "neon") {
    Level::Neon
} else if cfg!(target_feature = "simd128") {
    Level::Simd128
} else {
    Level::Scalar
};

macro_rules! version {
    ($level:literal) => {
        concat!(env!("CARGO_PKG_VERSION"), " (built for ", $level, ")")
    };
}

/// What `--version` says.
pub(super) const VERSION: &str = match BUILT_FOR {
    Level::Avx2 => version!("avx2"),
    Level::Avx => version!("avx"),
    Level::Sse41 => version!("sse4.1"),
    Level::Sse2 => version!("sse2"),
    Level::Neon => version!("neon"),
    Level::Simd128 => version!("simd128"),
    Level::Scalar => version!("scalar code"),
};

impl Level {
    /// The name that users and compilers know.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Simd128 => "simd128",
            Self::Neon => "neon",
            Self::Sse2 => "sse2",
            Self::Sse41 => "sse4.1",
            Self::Avx => "avx",
            Self::Avx2 => "avx2",
        }
    }
}

/// The highest level that this CPU offers.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
pub(super) fn offered() -> Level {
    if is_x86_feature_detected!("avx2") {
        Level::Avx2
    } else if is_x86_feature_detected!("avx") {
        Level::Avx
    } else if is_x86_feature_detected!("sse4.1") {
        Level::Sse41
    } else {
        BUILT_FOR
    }
}

/// The highest level that this CPU offers: elsewhere the build's own, as there is nothing to choose.
#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
pub(super) fn offered() -> Level {
    BUILT_FOR
}

/// A line for users whose CPU could do more than this build does.
pub(super) fn advice(built_for: Level, offered: Level) -> Option<String> {
    (offered > built_for).then(|| {
        let (built_for, offered) = (built_for.name(), offered.name());
        format!(
            "built for {built_for}, but this CPU offers {offered}: \
             build with RUSTFLAGS=\"-C target-cpu=native\" for more speed"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_is_given_only_when_there_is_more() {
        let text = advice(Level::Sse2, Level::Avx2).unwrap();
        assert!(text.contains("built for sse2") && text.contains("offers avx2") && !text.contains('\n'));
        assert_eq!(advice(Level::Avx2, Level::Avx2), None);
        assert_eq!(advice(Level::Avx2, Level::Sse2), None);
    }

    #[test]
    fn a_running_build_never_uses_more_than_the_cpu_offers() {
        assert!(BUILT_FOR <= offered());
    }

    #[test]
    fn the_version_names_the_level() {
        assert!(VERSION.starts_with(env!("CARGO_PKG_VERSION")));
        assert!(VERSION.contains(BUILT_FOR.name()));
    }
}
