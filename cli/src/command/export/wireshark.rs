//! `canspec export wireshark`.

use std::io::Write;

use canspec_codegen::emit;
use clap::Args;

use crate::choose::protocols::One;
use crate::failure::{Failure, Finish};
use crate::output::output;

/// Export a protocol as a Wireshark dissector in Lua.
///
/// It recognises frames on CAN by itself, or "Decode As" chooses it. Wireshark loads it from its
/// folder of plugins.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLES)]
pub struct Wireshark {
    #[command(flatten)]
    protocol: One,
}

const EXAMPLES: &str = "Examples:
  canspec export wireshark --protocol NAME > NAME.lua
  tshark -X lua_script:NAME.lua -O NAME -r bus.pcapng";

impl Wireshark {
    /// Writes the dissector.
    pub fn run(&self) -> Result<Finish, Failure> {
        let protocol = self.protocol.load()?;
        output()?.write_all(emit::wireshark(&protocol).as_bytes())?;
        Ok(Finish::Done)
    }
}
