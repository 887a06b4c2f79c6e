//! Planners that are copied and saved in the middle of a run.

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Planner;

/// What every planner can do: go on elsewhere as if nothing had happened.
pub trait Resumable {
    /// A copy with all that the planner remembers.
    fn boxed(&self) -> Box<dyn Planner>;

    /// All that the planner remembers.
    ///
    /// # Errors
    /// If it cannot be written down.
    fn remembered(&self) -> Result<Vec<u8>, String>;

    /// Goes on with what another planner of the same settings remembered.
    ///
    /// # Errors
    /// If these are not the bytes of such a planner.
    fn remember(&mut self, bytes: &[u8]) -> Result<(), String>;
}

impl<P: Planner + Clone + Serialize + DeserializeOwned + 'static> Resumable for P {
    fn boxed(&self) -> Box<dyn Planner> {
        Box::new(self.clone())
    }

    fn remembered(&self) -> Result<Vec<u8>, String> {
        postcard::to_stdvec(self).map_err(|error| error.to_string())
    }

    fn remember(&mut self, bytes: &[u8]) -> Result<(), String> {
        *self = postcard::from_bytes(bytes).map_err(|error| error.to_string())?;
        Ok(())
    }
}

impl Clone for Box<dyn Planner> {
    fn clone(&self) -> Self {
        (**self).boxed()
    }
}
