//! Modules that answer no more, and those that do again.

use super::{Nodes, Step};

/// Which modules are silent, and which of them the program knows.
#[derive(Clone, Copy, Debug)]
pub struct Health {
    pub silent: Nodes,
    told: Nodes,
}

impl Health {
    pub const NEW: Self = Self { silent: Nodes::NONE, told: Nodes::NONE };

    /// Notes that modules have not answered.
    pub fn lost(&mut self, nodes: &Nodes) {
        self.silent = self.silent.either(nodes);
    }

    /// Forgets who has not answered, as far as the program does not know it.
    pub fn forget(&mut self) {
        self.silent = self.silent.both(&self.told);
    }

    /// Notes that a module has spoken. Returns whether it was silent.
    pub fn heard(&mut self, node: u8) -> bool {
        self.silent.remove(node)
    }

    /// Says of one module that it is silent, or back.
    pub fn news(&mut self) -> Option<Step> {
        if self.silent == self.told {
            return None;
        }
        let node = (0..=u8::MAX).find(|node| self.silent.contains(*node) != self.told.contains(*node))?;
        if self.told.remove(node) {
            return Some(Step::Back(node));
        }
        self.told.insert(node);
        Some(Step::Silent(node))
    }
}
