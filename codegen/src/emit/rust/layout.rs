//! The layout of generated code, which is that of rustfmt with lines of 120 and the heuristics `Max`.
//!
//! prettyplease lays out items. Their expressions are laid out here: on one line if it fits, else
//! broken in one way.

#![expect(clippy::wildcard_enum_match_arm, reason = "the enums of syn are open; code of other kinds stays on one line")]

mod assignment;
mod brackets;
mod chain;
mod control;
mod expression;
mod flat;
mod shape;
mod spacing;

use proc_macro2::{Span, TokenStream};
use syn::{Block, Expr, Ident, ImplItem, Item, Stmt};

use shape::Shape;

/// Lays items out, group after group, so that one group at a time takes memory.
///
/// A group that is no Rust stays unchanged, so that its compiler can say why.
pub fn formatted(groups: impl IntoIterator<Item = TokenStream>) -> String {
    spacing::spaced(&groups.into_iter().map(laid_out).collect::<String>())
}

fn laid_out(items: TokenStream) -> String {
    let Ok(mut file) = syn::parse2::<syn::File>(items.clone()) else { return items.to_string() };
    drop(items);
    let mut computed = Computed::default();
    file.items.iter_mut().for_each(|item| computed.take_out(item));
    computed.put_back(&prettyplease::unparse(&file))
}

/// The expressions of items, while the items are laid out without them.
#[derive(Default)]
struct Computed {
    parts: Vec<Part>,
}

/// An expression, or something like it.
enum Part {
    Value(Expr),
    Body(Block),
}

/// The start of the names that stand for parts.
const STAND_IN: &str = "canspec_part_";

impl Computed {
    /// Takes out the expressions of an item.
    fn take_out(&mut self, item: &mut Item) {
        match item {
            Item::Const(item) => self.take_value(&mut item.expr),
            Item::Fn(item) => self.take_body(&mut item.block),
            Item::Impl(item) => item.items.iter_mut().for_each(|item| match item {
                ImplItem::Const(item) => self.take_value(&mut item.expr),
                ImplItem::Fn(item) => self.take_body(&mut item.block),
                _ => {}
            }),
            _ => {}
        }
    }

    /// Takes a part out, and returns its stand-in.
    fn take(&mut self, part: Part) -> Expr {
        let name = Ident::new(&format!("{STAND_IN}{}", self.parts.len()), Span::call_site());
        self.parts.push(part);
        syn::parse_quote!(#name)
    }

    fn take_value(&mut self, value: &mut Expr) {
        let taken = std::mem::replace(value, Expr::PLACEHOLDER);
        *value = self.take(Part::Value(taken));
    }

    fn take_body(&mut self, body: &mut Block) {
        if !body.stmts.is_empty() {
            let taken = Block { brace_token: syn::token::Brace::default(), stmts: std::mem::take(&mut body.stmts) };
            body.stmts = vec![Stmt::Expr(self.take(Part::Body(taken)), None)];
        }
    }

    /// Puts the parts back into the text of the items.
    fn put_back(&self, items: &str) -> String {
        let mut lines = items.lines();
        let mut whole = String::with_capacity(2 * items.len());
        while let Some(line) = lines.next() {
            let line = if is_broken_head(line) { head(line, &mut lines) } else { line.to_owned() };
            whole.push_str(&self.filled(&line).unwrap_or(line));
            whole.push('\n');
        }
        whole
    }

    /// Lays out the part that a name in a line stands for.
    fn filled(&self, line: &str) -> Option<String> {
        let (before, name) = line.split_once(STAND_IN)?;
        let part = self.parts.get(name.trim_end_matches(';').parse::<usize>().ok()?)?;
        let indent = line.len() - line.trim_start().len();
        let line = Shape::new(indent, expression::rewrite);
        match part {
            Part::Value(value) => Some(format!("{};", assignment::assigned(before.trim_end(), value, line, 1)?)),
            Part::Body(body) => Some(control::statements(&body.stmts, line)),
        }
    }
}

/// Tests whether a line goes on in others: that of an attribute, a signature, a member or a variant.
fn is_broken_head(line: &str) -> bool {
    line.ends_with(['(', '<']) && !line.trim_start().starts_with("//")
}

/// Joins the lines of a broken head if they fit on one.
fn head<'a>(first: &str, lines: &mut impl Iterator<Item = &'a str>) -> String {
    let indent = first.len() - first.trim_start().len();
    let is_last = |line: &str| line.len() - line.trim_start().len() == indent;
    let (mut broken, mut joined) = (first.to_owned(), first.to_owned());
    for line in lines {
        if is_last(line) {
            joined.truncate(joined.trim_end_matches([',', ' ']).len());
        }
        broken = format!("{broken}\n{line}");
        joined.push_str(line.trim_start());
        if is_last(line) {
            break;
        }
        joined.push(' ');
    }
    if shape::width(&joined) <= shape::LONGEST { joined } else { broken }
}

#[cfg(test)]
mod tests {
    use super::formatted;

    /// Tests that code which rustfmt laid out is laid out in the same way.
    fn stays(code: &str) {
        assert_eq!(formatted([code.parse().expect("the tokens of Rust")]), code);
    }

    /// Returns a name of `length` letters.
    fn name(length: usize) -> String {
        "a".repeat(length)
    }

    #[test]
    fn what_fits_stands_on_one_line() {
        stays("const A: &[B] = &[B::new(\"a\", &[0x01, -2], |c| D { d: c, e }).f(1..=2)?.g];\n");
        stays("fn a() -> B {\n    if c == 1 { &[4] } else { d(&mut e) }\n}\n");
    }

    #[test]
    fn of_arguments_the_last_one_alone_is_broken_or_each_has_its_line() {
        let (long, longer) = (name(60), name(110));
        stays(&format!("const A: B = c(&[\n    {long},\n    {long},\n]);\n"));
        stays(&format!("const A: B = c(\n    1,\n    {longer},\n);\n"));
        stays(&format!("const A: &[B] = &[\n    c({long}),\n    d({long}),\n];\n"));
    }

    #[test]
    fn a_chain_begins_below_what_it_is_assigned_to_or_has_a_link_a_line() {
        let long = name(50);
        stays(&format!("const A: B =\n    c.{long}().{long}();\n"));
        stays(&format!("const A: B = c::d({long})\n    .e({long})\n    .f({long});\n"));
        stays(&format!("const A: B = c::d({long}).e().f(&[\n    1,\n    {long},\n    {long},\n]);\n"));
    }

    #[test]
    fn an_arm_that_is_too_long_gets_a_block_or_breaks_its_call() {
        let (long, longer) = (name(45), name(52));
        let items = |arm: &str| {
            format!(
                "impl A {{\n    fn b() -> C {{\n        match d {{\n{arm}            _ => e,\n        }}\n    }}\n}}\n"
            )
        };
        stays(&items(&format!("            0x01 => {{\n                c({longer}, {long})\n            }}\n")));
        stays(&items(&format!(
            "            0x01 => c(\n                {longer},\n                {longer},\n            ),\n"
        )));
        stays(&items("            0x01 | 0x02..=0x04 => c,\n            (_, 0x05) => d(e),\n"));
    }

    #[test]
    fn generic_arguments_of_a_method_and_the_rest_of_a_struct_are_kept() {
        let (long, longer) = (name(50), name(90));
        stays("const A: B = c.d::<u8>(1).e::<F, G>();\n");
        stays(&format!("const A: B = c\n    .{long}::<u8>()\n    .{long}::<E>();\n"));
        stays("const A: B = C { d: 1, ..e };\n");
        stays(&format!("const A: B = C {{\n    {longer}: 1,\n    d: {long},\n    ..e\n}};\n"));
    }

    #[test]
    fn operands_stand_on_a_line_each_with_the_operator_before_them() {
        let long = name(60);
        stays(&format!("fn a() -> b {{\n    {long}\n        | {long}\n        | c\n}}\n"));
    }

    #[test]
    fn a_constant_in_a_function_is_laid_out_like_one_outside() {
        let long = name(50);
        stays("fn a() -> b {\n    const C: D<e, f> = G::h.i().j(1, 2.0);\n    Some(&C)\n}\n");
        stays(&format!("fn a() -> b {{\n    const C: D<e, f> =\n        G::h.{long}().{long}();\n    Some(&C)\n}}\n"));
    }

    #[test]
    fn what_is_no_item_and_comments_stay_as_they_are() {
        stays("/// Takes (\n/// both) <\npub struct A(pub u8);\n");
        assert_eq!(formatted([quote::quote!(no Rust)]), "no Rust\n");
    }
}
