//! No panic of the crate reaches Python as such, and Python can interrupt it.
//!
//! A panic is a defect of ours. It becomes an [`InternalError`] that says where it happened and
//! what; the traffic it happened in is then of no more use, and says so whenever it is asked. The
//! same holds where a signal (Ctrl-C) ends long work: Python's handlers are called meanwhile, and
//! what they raise is what Python sees.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind, set_hook, take_hook};
use std::sync::Once;

use pyo3::PyErr;
use pyo3::prelude::*;

use crate::patience::asking;

thread_local! {
    /// What the last panic of this thread said, with its place in the sources.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
    /// Whether a panic of this thread is going to be caught here.
    static CAUGHT: RefCell<bool> = const { RefCell::new(false) };
}

/// Makes panics that are caught here silent; all others are reported as ever.
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

/// Why something was not done.
pub(super) enum Failure {
    /// A panic: where, and what it said.
    Defect(String),
    /// What a handler of a signal has raised.
    Interrupt(PyErr),
}

impl Failure {
    /// What is told from then on to whoever uses what was left half-done.
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

/// Does something, unless it panics or is interrupted.
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

/// Lets Python call its handlers; what they raise unwinds the work.
fn heed_signals() {
    if let Err(error) = Python::attach(|py| py.check_signals()) {
        resume_unwind(Box::new(error));
    }
}

/// The error that Python sees.
pub(super) fn internal_error(message: &str) -> PyErr {
    Python::attach(|py| {
        let class = py.import("rmfs.errors").and_then(|errors| errors.getattr("InternalError"));
        class
            .and_then(|class| class.call1((message,)))
            .map_or_else(|error| error, PyErr::from_value)
    })
}
