//! Planners that are copied and saved in the middle of a run.

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Planner;

/// Copying and saving of a planner's state; every planner supports it.
pub trait Resumable {
    /// A copy, including the planner's state.
    fn boxed(&self) -> Box<dyn Planner>;

    /// The planner's state as bytes.
    ///
    /// # Errors
    /// If it cannot be serialised.
    fn remembered(&self) -> Result<Vec<u8>, String>;

    /// Restores the state of another planner with the same settings.
    ///
    /// # Errors
    /// If the bytes do not belong to such a planner.
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
