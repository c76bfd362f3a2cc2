//! Chooses a device model.

use canspec_codegen::model::{DeviceModel, ModelId, Protocol};
use clap::Args;

use crate::choose::settings::Settings;
use crate::failure::Failure;

/// A protocol, and the device model if one of its models is chosen.
pub type Device<'a> = (&'a Protocol, Option<ModelId>);

/// Chooses a device model.
#[derive(Args)]
pub struct Model {
    /// Device model, by name or item number; its layouts and limits apply.
    #[arg(long = "model", value_name = "NAME")]
    name: Option<String>,
}

impl Model {
    /// Returns the model, or else that of the settings, in each protocol that has it.
    pub fn find(&self, protocols: &[Protocol], settings: &Settings) -> Result<Vec<Option<ModelId>>, Failure> {
        let Some(name) = self.name.as_ref().or(settings.model.as_ref()) else {
            return Ok(vec![None; protocols.len()]);
        };
        let is_meant =
            |model: &DeviceModel| model.name == *name || model.items.iter().any(|item| item.for_people() == name);
        let found: Vec<_> = protocols.iter().map(|protocol| protocol.models.position(is_meant)).collect();
        match found.iter().all(Option::is_none).then(|| unknown(name, protocols)) {
            None => Ok(found),
            Some(why) if self.name.is_some() => Err(Failure::Call(why)),
            Some(why) => Err(settings.refuse(&why)),
        }
    }

    /// Returns the model in a protocol.
    pub fn find_in(&self, protocol: &Protocol, settings: &Settings) -> Result<Option<ModelId>, Failure> {
        Ok(self.find(std::slice::from_ref(protocol), settings)?.into_iter().flatten().next())
    }
}

/// Says which models there are.
fn unknown(name: &str, protocols: &[Protocol]) -> String {
    let known = protocols.iter().map(|protocol| {
        let names: Vec<_> = protocol.models.iter().map(|model| model.name.as_str()).collect();
        let names = if names.is_empty() { "no models".to_owned() } else { names.join(", ") };
        format!("`{}` has {names}", protocol.name)
    });
    format!("unknown model `{name}`; {}", known.collect::<Vec<_>>().join("; "))
}
