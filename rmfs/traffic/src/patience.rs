//! Interruption of long work by a callback that is called now and then.
//!
//! The caller of long work may register a callback here, which is called every tenth of a second
//! while the work is in progress. If the callback asks to stop, the work is unwound.

use std::cell::Cell;
use std::time::{Duration, Instant};

/// Number of steps of work between two readings of the clock.
const STEPS: u32 = 1 << 10;

/// Wall time between two calls of the callback.
const BETWEEN: Duration = Duration::from_millis(100);

/// The callback, and the time of its last call.
type Question = (fn(), Instant);

thread_local! {
    static LEFT: Cell<u32> = const { Cell::new(STEPS) };
    static QUESTION: Cell<Option<Question>> = const { Cell::new(None) };
}

/// Reports that a step of work is done; cheap, as there may be very many.
#[inline]
pub fn look_up() {
    LEFT.with(|left| match left.get() {
        0 => {
            left.set(STEPS);
            ask();
        }
        steps => left.set(steps - 1),
    });
}

#[cold]
fn ask() {
    QUESTION.with(|kept| {
        if let Some((question, asked)) = kept.get()
            && asked.elapsed() >= BETWEEN
        {
            question();
            kept.set(Some((question, Instant::now())));
        }
    });
}

/// Runs some work, and calls the callback while it is in progress.
pub fn asking<T>(question: fn(), work: impl FnOnce() -> T) -> T {
    /// Restores the previous callback, also when the work unwinds.
    struct Back(Option<Question>);
    impl Drop for Back {
        fn drop(&mut self) {
            QUESTION.set(self.0);
        }
    }
    let _back = Back(QUESTION.replace(Some((question, Instant::now()))));
    work()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{catch_unwind, resume_unwind};

    #[test]
    fn endless_work_is_given_up() {
        let stopped = catch_unwind(|| {
            asking(
                || resume_unwind(Box::new("enough")),
                || {
                    loop {
                        look_up();
                    }
                },
            )
        });
        let told: Box<dyn std::any::Any + Send> = match stopped {
            Ok(()) => unreachable!("it has no end"),
            Err(told) => told,
        };
        assert_eq!(told.downcast_ref::<&str>(), Some(&"enough"));
        assert!(QUESTION.get().is_none());
    }

    #[test]
    fn short_work_is_not_asked() {
        asking(|| unreachable!("it is done at once"), || (0..10 * STEPS).for_each(|_| look_up()));
    }
}
