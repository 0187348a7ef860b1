//! `--max-error` and `--time-limit`: samples until it is good enough.

use std::time::Duration;

use super::pipeline::Goal;

/// Most samples of a pixel where nobody says: 1/256 of the error of one.
const MOST_SAMPLES: u32 = 1 << 16;

/// When pixels have samples enough.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct GoalArgs {
    /// Give each pixel samples until its estimated error (root mean square, in linear light) is no larger; the same bytes
    /// for any number of threads
    #[arg(long, value_name = "E", value_parser = parse_error, allow_negative_numbers = true)]
    pub max_error: Option<f64>,
    /// Stop rendering after S seconds, but not before each pixel has a sample; the bytes depend on the machine
    #[arg(long, value_name = "S", value_parser = parse_seconds, allow_negative_numbers = true)]
    pub time_limit: Option<Duration>,
}

impl GoalArgs {
    /// The goal, where one is asked for.
    pub(super) fn goal(&self) -> Option<Goal> {
        let goal = Goal { max_error: self.max_error, time_limit: self.time_limit };
        (goal != Goal::default()).then_some(goal)
    }

    /// The scene's samples are too few to reach a goal with; what the user says wins over this.
    pub(super) fn assignment(&self) -> Option<(String, String)> {
        self.goal().map(|_| ("render.spp".to_owned(), MOST_SAMPLES.to_string()))
    }
}

fn parse_error(text: &str) -> Result<f64, String> {
    let error = text.parse::<f64>().ok().filter(|error| *error > 0.0 && error.is_finite());
    error.ok_or_else(|| "expected a number above 0, such as 0.01".into())
}

pub(super) fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse::<f64>().ok().filter(|seconds| *seconds > 0.0);
    let limit = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    limit.ok_or_else(|| "expected a number of seconds above 0, such as 2.5".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_are_positive_numbers() {
        assert_eq!(parse_error("1e-3"), Ok(1e-3));
        assert_eq!(parse_seconds("2.5"), Ok(Duration::from_millis(2500)));
        for bad in ["", "0", "-1", "nan", "inf", "1%"] {
            assert!(parse_error(bad).is_err() && parse_seconds(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn no_goal_changes_nothing() {
        assert_eq!((GoalArgs::default().goal(), GoalArgs::default().assignment()), (None, None));
        let args = GoalArgs { max_error: Some(0.1), time_limit: None };
        assert_eq!(args.assignment().unwrap().1, "65536");
    }
}
