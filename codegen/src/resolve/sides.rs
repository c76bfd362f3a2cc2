//! Resolves what the two sides are called.

use super::Resolver;
use crate::model::Sides;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;

impl Resolver<'_> {
    /// Reads the names of the two sides.
    pub fn sides(&mut self) -> Sides {
        self.check_not_empty(&Path::default(), &["sides"]);
        let path = Path::default().key("sides");
        let mut sides = Sides::default();
        let Some(written) = &self.spec.sides else { return sides };
        let names = [
            ("module", &written.module, &mut sides.module),
            ("controller", &written.controller, &mut sides.controller),
        ];
        for (key, written, name) in names {
            if let Some(written) = written {
                self.check_name_at(path.key(key).at_value(), written);
                name.clone_from(written);
            }
        }
        if is_one_of(&sides.controller, &sides.module) {
            let Sides { module, controller } = &sides;
            let text = format!("the controller `{controller}` has the name of a `{module}`");
            let help =
                "give one of the two another name; modules with addresses are called by number, as in `module_2`";
            self.diagnostics.push(Diagnostic::error(&rules::NAME, path.at_key(), text).help(help));
        }
        sides
    }
}

/// Tests whether a name is that of a module, with a number or without.
fn is_one_of(name: &str, module: &str) -> bool {
    let number = name.strip_prefix(module).and_then(|rest| rest.strip_prefix('_'));
    name == module || number.is_some_and(|number| number.chars().all(|digit| digit.is_ascii_digit()))
}
