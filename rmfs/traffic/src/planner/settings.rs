//! Planners by name, with the parameters of a controllers file.

use std::collections::BTreeMap;

use crate::network::Network;
use crate::reservations::Table;
use crate::units::Us;

use super::bcp::Bcp;
use super::cbs::Cbs;
use super::deadlock::Deadlocks;
use super::far::{Evasion, Far};
use super::od_id::OdId;
use super::pas::Pas;
use super::pbs::Pbs;
use super::pibt::Pibt;
use super::swift::Swift;
use super::whca_persistent::WhcaPersistent;
use super::whca_volatile::WhcaVolatile;
use super::{Planner, Rhythm, TimeWindows};

/// Settings chosen by the user. Durations are in seconds, switches are 0 or 1.
#[derive(Clone, Debug)]
pub struct Settings {
    pub name: String,
    pub parameters: BTreeMap<String, f64>,
    pub seed: u64,
}

impl Settings {
    fn number(&self, key: &str) -> Result<f64, String> {
        let value = self.parameters.get(key).copied();
        value.ok_or_else(|| format!("planner {}: parameter {key} is missing", self.name))
    }

    fn count(&self, key: &str) -> Result<u64, String> {
        Ok(self.number(key)? as u64)
    }

    fn time(&self, key: &str) -> Result<Us, String> {
        Ok((self.number(key)? * 1e6).round() as Us)
    }

    fn switch(&self, key: &str) -> Result<bool, String> {
        Ok(self.number(key)? != 0.0)
    }

    /// How often a rolling planner is called, and how much of its proposals is granted at once.
    ///
    /// # Errors
    /// If a parameter is missing.
    pub fn rhythm(&self) -> Result<Rhythm, String> {
        Ok(Rhythm::Rolling {
            period: self.time("period_s")?,
            runs: self.count("runs_granted")?.max(1) as usize,
        })
    }

    fn deadlocks(&self) -> Result<Deadlocks, String> {
        Ok(Deadlocks::new(self.time("patience_s")?, self.seed))
    }
}

/// Builds the planner of a name.
///
/// # Errors
/// If there is no planner of that name, or a parameter is missing.
pub fn build(settings: &Settings, network: &Network) -> Result<Box<dyn Planner>, String> {
    let table = Table::new(network.resources);
    Ok(match settings.name.as_str() {
        "time-windows" => Box::new(TimeWindows {
            budget: settings.count("labels")?,
            improvement: settings.count("improve_labels").unwrap_or(0),
            swift: settings.switch("swift").unwrap_or(false).then_some(Swift::FOR_BIG_FLEETS),
            swift_from: settings.count("swift_from").unwrap_or(0),
            ..TimeWindows::default()
        }),
        "whca-v" => Box::new(WhcaVolatile {
            rhythm: settings.rhythm()?,
            window: settings.time("window_s")?,
            wait: settings.time("wait_s")?,
            rounds: settings.count("rounds")?.max(1) as u32,
            restart_at_once: settings.switch("restart_at_once")?,
            labels: settings.count("labels")?,
            deadlocks: settings.deadlocks()?,
            table,
        }),
        "whca-n" => Box::new(WhcaPersistent {
            rhythm: settings.rhythm()?,
            window: settings.time("window_s")?,
            labels: settings.count("labels")?,
            deadlocks: settings.deadlocks()?,
            table,
            reserved: BTreeMap::new(),
        }),
        "far" => Box::new(Far {
            rhythm: settings.rhythm()?,
            evasion: if settings.switch("reroute")? { Evasion::Reroute } else { Evasion::NextNode },
            patience: settings.time("patience_s")?,
            wait: settings.time("wait_s")?,
            avoids_evading_back: settings.switch("avoid_evading_back")?,
            deadlocks: settings.deadlocks()?,
            memory: BTreeMap::new(),
        }),
        "bcp" => Box::new(Bcp {
            rhythm: settings.rhythm()?,
            bias: settings.number("bias_m")?,
            rounds: settings.count("rounds")?.max(1) as u32,
            deadlocks: settings.deadlocks()?,
            table,
        }),
        "cbs" => Box::new(Cbs {
            rhythm: settings.rhythm()?,
            nodes: settings.count("nodes")?,
            labels: settings.count("labels")?,
            deadlocks: settings.deadlocks()?,
            table,
        }),
        "pbs" => Box::new(Pbs {
            rhythm: settings.rhythm()?,
            window: settings.time("window_s")?,
            nodes: settings.count("nodes")?,
            labels: settings.count("labels")?,
            deadlocks: settings.deadlocks()?,
            table,
        }),
        "od-id" => Box::new(OdId {
            rhythm: settings.rhythm()?,
            window: settings.time("window_s")?,
            wait: settings.time("wait_s")?,
            nodes_per_agent: settings.count("nodes_per_robot")?,
            nodes: settings.count("nodes")?,
            choices: settings.count("choices")? as usize,
            labels: settings.count("labels")?,
            deadlocks: settings.deadlocks()?,
            table,
        }),
        "pas" => Box::new(Pas {
            rhythm: settings.rhythm()?,
            window: settings.time("window_s")?,
            wait: settings.time("wait_s")?,
            priorities: settings.count("priorities")? as u32,
            steps_per_agent: settings.count("steps_per_robot")?,
            deadlocks: settings.deadlocks()?,
            table,
        }),
        "pibt" => Box::new(Pibt {
            rhythm: settings.rhythm()?,
            detour: settings.time("detour_s")?,
            choices: settings.count("choices")? as usize,
            deadlocks: settings.deadlocks()?,
            table,
            since: BTreeMap::new(),
        }),
        other => return Err(format!("there is no planner {other}")),
    })
}
