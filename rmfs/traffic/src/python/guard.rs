//! No panic of the crate reaches Python as such.
//!
//! A panic is a defect of ours. It becomes an [`InternalError`] that says where it happened and
//! what; the traffic it happened in is then of no more use, and says so whenever it is asked.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

use pyo3::PyErr;
use pyo3::prelude::*;

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

/// Does something; if that panics, returns what was said.
pub(super) fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    listen();
    let before = CAUGHT.replace(true);
    let done = catch_unwind(AssertUnwindSafe(work));
    CAUGHT.set(before);
    done.map_err(|_| SAID.take())
}

/// The error that Python sees.
pub(super) fn internal_error(said: &str) -> PyErr {
    Python::attach(|py| {
        let message = format!("a defect of the traffic core: {said}");
        let class = py.import("rmfs.errors").and_then(|errors| errors.getattr("InternalError"));
        class
            .and_then(|class| class.call1((message,)))
            .map_or_else(|error| error, PyErr::from_value)
    })
}
