//! Ctrl-C, SIGTERM and SIGUSR1: the first stops the work in an orderly way, the second at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
#[cfg(unix)]
use std::time::{Duration, Instant};

use super::error::{CliError, Exit};

/// What comes so soon after the first signal is the same one: `timeout` and some schedulers send it to the process and then
/// to its group.
#[cfg(unix)]
const ECHO: Duration = Duration::from_millis(300);

/// Signals that ask the program to end, as flags.
pub(super) struct Interrupt {
    asked: Arc<AtomicBool>,
    deferred: Arc<AtomicBool>,
}

impl Interrupt {
    /// Listens to signals from now on. As long as they are not deferred, the first one ends the program with the error
    /// that `end` gives.
    pub(super) fn install(end: impl Fn() -> CliError + Send + 'static) -> Result<Self, CliError> {
        Self::with_patience(end, false)
    }

    /// As [`Interrupt::install`], but while signals are deferred only a second Ctrl-C ends the program: schedulers send one
    /// signal after the other.
    pub(super) fn install_patient(end: impl Fn() -> CliError + Send + 'static) -> Result<Self, CliError> {
        Self::with_patience(end, true)
    }

    fn with_patience(end: impl Fn() -> CliError + Send + 'static, patient: bool) -> Result<Self, CliError> {
        let interrupt = Self { asked: Arc::default(), deferred: Arc::default() };
        interrupt
            .listen(end, patient)
            .map_err(|error| CliError::new(Exit::Failed, "cannot listen to signals").because(error))?;
        Ok(interrupt)
    }

    /// The flag that the first signal sets, for work that looks at it often.
    pub(super) fn flag(&self) -> &AtomicBool {
        &self.asked
    }

    /// Says whether the work that follows looks at the flag, or is quickly done.
    pub(super) fn defer(&self, deferred: bool) {
        self.deferred.store(deferred, SeqCst);
    }

    #[cfg(unix)]
    fn listen(&self, end: impl Fn() -> CliError + Send + 'static, patient: bool) -> std::io::Result<()> {
        use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
        let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGUSR1])?;
        let (asked, deferred) = (Arc::clone(&self.asked), Arc::clone(&self.deferred));
        let watch = move || {
            let mut first = None;
            for signal in signals.forever() {
                let is_echo = first.get_or_insert_with(Instant::now).elapsed() < ECHO;
                let is_second = asked.swap(true, SeqCst) && !is_echo && (!patient || signal == SIGINT);
                if is_second || !deferred.load(SeqCst) {
                    super::error::end_program(&end());
                }
            }
        };
        std::thread::Builder::new().name("signals".into()).spawn(watch).map(drop)
    }

    /// Without signals to wait for: the first sets the flag, the second ends the program.
    #[cfg(not(unix))]
    fn listen(&self, _end: impl Fn() -> CliError + Send + 'static, _patient: bool) -> std::io::Result<()> {
        use signal_hook::consts::{SIGINT, SIGTERM};
        for signal in [SIGINT, SIGTERM] {
            signal_hook::flag::register_conditional_shutdown(
                signal,
                Exit::Failed as i32,
                Arc::clone(&self.asked),
            )?;
            signal_hook::flag::register(signal, Arc::clone(&self.asked))?;
        }
        Ok(())
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_deferred_signal_sets_the_flag() {
        let interrupt = Interrupt::install(|| CliError::new(Exit::Failed, "a signal too many")).unwrap();
        interrupt.defer(true);
        assert!(!interrupt.flag().load(SeqCst));
        signal_hook::low_level::raise(signal_hook::consts::SIGTERM).unwrap();
        let begun = Instant::now();
        while !interrupt.flag().load(SeqCst) {
            assert!(begun.elapsed() < Duration::from_secs(10), "the signal did not arrive");
            std::thread::yield_now();
        }
    }
}
