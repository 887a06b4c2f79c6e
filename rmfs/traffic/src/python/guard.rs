//! Conversion of panics to Python errors, and interruption by Python.
//!
//! A panic is a defect of this crate. It becomes an [`InternalError`] that states what happened and
//! where. The traffic in which it happened is then unusable, and every later call raises an error.
//! The same applies if a signal (Ctrl-C) ends long work: Python's handlers are called during the
//! work, and the exceptions they raise are passed on.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind, set_hook, take_hook};
use std::sync::Once;

use pyo3::PyErr;
use pyo3::prelude::*;

use crate::patience::asking;

thread_local! {
    /// Message of the last panic of this thread, with its place in the sources.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
    /// Whether a panic of this thread will be caught here.
    static CAUGHT: RefCell<bool> = const { RefCell::new(false) };
}

/// Silences panics that are caught here; all others are reported as usual.
fn listen() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |panic| {
            if !CAUGHT.with_borrow(|caught| *caught) {
                return usual(panic);
            }
            let place = panic.location().map_or_else(String::new, |at| format!("{at}: "));
            let payload = panic.payload();
            let text = payload.downcast_ref::<&str>().copied();
            let what = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
            let what = what.unwrap_or("a panic");
            SAID.set(format!("{place}{what}"));
        }));
    });
}

/// Reason why a call failed.
pub(super) enum Failure {
    /// A panic, with its place and message.
    Defect(String),
    /// An exception raised by a signal handler.
    Interrupt(PyErr),
}

impl Failure {
    /// The error of later calls on an object that was left in an incomplete state.
    pub(super) fn said(&self) -> String {
        match self {
            Self::Defect(said) => format!("a defect of the traffic core: {said}"),
            Self::Interrupt(_) => "the traffic core was interrupted while it worked".to_owned(),
        }
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        let said = failure.said();
        match failure {
            Failure::Defect(_) => internal_error(&said),
            Failure::Interrupt(error) => error,
        }
    }
}

/// Runs a function; returns an error if it panics or is interrupted.
pub(super) fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, Failure> {
    listen();
    let before = CAUGHT.replace(true);
    let done = catch_unwind(AssertUnwindSafe(|| asking(heed_signals, work)));
    CAUGHT.set(before);
    done.map_err(|payload| match payload.downcast::<PyErr>() {
        Ok(error) => Failure::Interrupt(*error),
        Err(_) => Failure::Defect(SAID.take()),
    })
}

/// Lets Python call its signal handlers; an exception unwinds the work.
fn heed_signals() {
    if let Err(error) = Python::attach(|py| py.check_signals()) {
        resume_unwind(Box::new(error));
    }
}

/// The error that Python sees.
pub(super) fn internal_error(message: &str) -> PyErr {
    error_of("InternalError", message)
}

/// The error about a plan that a recorded run does not have.
pub(super) fn replay_error(plan: &str) -> PyErr {
    let message = format!(
        "{plan} was another one in the recorded run: layout, scenario, controllers, seed, settings \
         of planning or version differ"
    );
    error_of("ReplayError", &message)
}

fn error_of(name: &str, message: &str) -> PyErr {
    Python::attach(|py| {
        let class = py.import("rmfs.errors").and_then(|errors| errors.getattr(name));
        class
            .and_then(|class| class.call1((message,)))
            .map_or_else(|error| error, PyErr::from_value)
    })
}
