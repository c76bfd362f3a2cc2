//! Walks through the syntax of a file, finds what can be mistaken, and plants one mistake.
//!
//! The walk is always the same, so that a mistake is known by its number.

mod expression;
mod statement;
#[cfg(test)]
mod tests;
mod tokens;

use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use syn::visit_mut::{self, VisitMut};
use syn::{
    Attribute, Expr, ExprRepeat, GenericArgument, Ident, ImplItemConst, ImplItemFn, Item, ItemConst, ItemFn, ItemImpl,
    ItemMod, Macro, PatGuard, Stmt, TraitItemFn, Type,
};

use super::mistake::{Kind, Mistake};

/// Returns the mistakes that can be made in a file.
pub fn mistakes(file: &syn::File, module: &str) -> Vec<Mistake> {
    let mut walk = Walk::new(module, None);
    walk.visit_file_mut(&mut file.clone());
    walk.found
}

/// Returns the file with one of its mistakes.
pub fn planted(file: &syn::File, module: &str, number: usize) -> syn::File {
    let mut file = file.clone();
    Walk::new(module, Some(number)).visit_file_mut(&mut file);
    file
}

struct Walk {
    /// What stands before the name of a function: its type, or the module.
    owner: String,
    /// The function in which the walk is, and its tokens.
    function: Option<(String, String)>,
    wanted: Option<usize>,
    found: Vec<Mistake>,
}

impl Walk {
    fn new(module: &str, wanted: Option<usize>) -> Self {
        Self { owner: module.to_owned(), function: None, wanted, found: Vec::new() }
    }

    /// Notes that something can be mistaken, and tells whether this is to happen.
    fn note(&mut self, kind: Kind, right: String, wrong: String) -> bool {
        let Some((function, whole)) = self.function.clone() else { return false };
        self.found.push(Mistake { function, whole, kind, right, wrong });
        self.wanted == Some(self.found.len() - 1)
    }

    fn offer<T: ToTokens>(&mut self, kind: Kind, right: &mut T, wrong: T) {
        if self.note(kind, text(right), text(&wrong)) {
            *right = wrong;
        }
    }

    fn offer_any<T: ToTokens>(&mut self, right: &mut T, wrong: impl IntoIterator<Item = (Kind, T)>) {
        for (kind, wrong) in wrong {
            self.offer(kind, right, wrong);
        }
    }

    /// Walks through a function; one within another belongs to that.
    fn within(&mut self, name: &Ident, whole: String, walk: impl FnOnce(&mut Self)) {
        let function = self.function.clone().unwrap_or_else(|| (format!("{}::{name}", self.owner), whole));
        let outer = self.function.replace(function);
        walk(self);
        self.function = outer;
    }

    fn owned_by(&mut self, owner: String, walk: impl FnOnce(&mut Self)) {
        let outer = std::mem::replace(&mut self.owner, owner);
        walk(self);
        self.owner = outer;
    }
}

fn text(tokens: &impl ToTokens) -> String {
    tokens.to_token_stream().to_string()
}

/// Tells whether the tests are compiled without it, or are it.
fn is_conditional(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| attribute.path().is_ident("cfg") || attribute.path().is_ident("test"))
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        _ => &[],
    }
}

impl VisitMut for Walk {
    fn visit_item_mut(&mut self, item: &mut Item) {
        if !is_conditional(attributes(item)) {
            visit_mut::visit_item_mut(self, item);
        }
    }

    fn visit_item_mod_mut(&mut self, module: &mut ItemMod) {
        self.owned_by(module.ident.to_string(), |walk| visit_mut::visit_item_mod_mut(walk, module));
    }

    fn visit_item_impl_mut(&mut self, item: &mut ItemImpl) {
        let owner = match &*item.self_ty {
            Type::Path(path) => path.path.segments.last().map(|segment| segment.ident.to_string()),
            _ => None,
        };
        let owner = owner.unwrap_or_else(|| self.owner.clone());
        self.owned_by(owner, |walk| visit_mut::visit_item_impl_mut(walk, item));
    }

    fn visit_item_fn_mut(&mut self, function: &mut ItemFn) {
        let whole = format!("{} {}", text(&function.sig), text(&function.block));
        self.within(&function.sig.ident.clone(), whole, |walk| {
            walk.result(&function.sig, &mut function.block);
            visit_mut::visit_item_fn_mut(walk, function);
        });
    }

    fn visit_impl_item_fn_mut(&mut self, function: &mut ImplItemFn) {
        let whole = format!("{} {}", text(&function.sig), text(&function.block));
        self.within(&function.sig.ident.clone(), whole, |walk| {
            walk.result(&function.sig, &mut function.block);
            visit_mut::visit_impl_item_fn_mut(walk, function);
        });
    }

    fn visit_trait_item_fn_mut(&mut self, function: &mut TraitItemFn) {
        let whole = format!("{} {}", text(&function.sig), text(&function.default));
        self.within(&function.sig.ident.clone(), whole, |walk| visit_mut::visit_trait_item_fn_mut(walk, function));
    }

    fn visit_item_const_mut(&mut self, item: &mut ItemConst) {
        self.within(&item.ident.clone(), text(&item.expr), |walk| visit_mut::visit_item_const_mut(walk, item));
    }

    fn visit_impl_item_const_mut(&mut self, item: &mut ImplItemConst) {
        self.within(&item.ident.clone(), text(&item.expr), |walk| visit_mut::visit_impl_item_const_mut(walk, item));
    }

    fn visit_stmt_mut(&mut self, statement: &mut Stmt) {
        let wrong = statement::left_out(statement);
        self.offer_any(statement, wrong.map(|wrong| (Kind::Statement, wrong)));
        visit_mut::visit_stmt_mut(self, statement);
    }

    fn visit_expr_mut(&mut self, expression: &mut Expr) {
        let wrong = expression::mistaken(expression);
        self.offer_any(expression, wrong);
        self.predicates(expression);
        visit_mut::visit_expr_mut(self, expression);
    }

    fn visit_pat_guard_mut(&mut self, pattern: &mut PatGuard) {
        self.condition(&mut pattern.guard);
        visit_mut::visit_pat_guard_mut(self, pattern);
    }

    fn visit_macro_mut(&mut self, call: &mut Macro) {
        self.macro_call(call);
    }

    fn visit_item_macro_mut(&mut self, item: &mut syn::ItemMacro) {
        let Some(name) = item.ident.clone() else { return };
        self.within(&name, text(&item.mac), |walk| walk.tokens_of(&mut item.mac.tokens));
    }

    /// The length of an array is part of its type.
    fn visit_expr_repeat_mut(&mut self, array: &mut ExprRepeat) {
        self.visit_expr_mut(&mut array.expr);
    }

    fn visit_type_mut(&mut self, _: &mut Type) {}

    fn visit_generic_argument_mut(&mut self, _: &mut GenericArgument) {}

    fn visit_attribute_mut(&mut self, _: &mut Attribute) {}
}

impl Walk {
    /// A condition is turned round, unless it has an operator that is mistaken anyway.
    fn condition(&mut self, condition: &mut Expr) {
        let wrong = match &*condition {
            Expr::Binary(_) | Expr::Unary(_) | Expr::Lit(_) => return,
            Expr::Let(_) => syn::parse_quote!(false && #condition),
            _ => syn::parse_quote!(!(#condition)),
        };
        self.offer(Kind::Condition, condition, wrong);
    }

    fn tokens_of(&mut self, tokens: &mut TokenStream) {
        let right = std::mem::take(tokens);
        *tokens = self.tokens(&right);
    }

    fn macro_call(&mut self, call: &mut Macro) {
        let name = call.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
        match name.as_str() {
            "quote" | "parse_quote" => self.tokens_of(&mut call.tokens),
            name if name.contains("assert") || name == "panic" || name == "unreachable" => {}
            _ => self.macro_arguments(call),
        }
    }

    fn macro_arguments(&mut self, call: &mut Macro) {
        let parser = syn::punctuated::Punctuated::<Expr, syn::Token![,]>::parse_terminated;
        if let Ok(mut arguments) = call.parse_body_with(parser) {
            arguments.iter_mut().for_each(|argument| self.visit_expr_mut(argument));
            call.tokens = quote!(#arguments);
        }
    }
}
