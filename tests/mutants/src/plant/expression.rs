//! Mistakes in expressions.

use std::mem::discriminant;

use syn::{
    Arm, BinOp, Expr, ExprBinary, ExprCall, ExprLit, ExprMatch, ExprMethodCall, ExprRange, Ident, Lit, LitBool, Member,
    Pat, RangeLimits, UnOp, parse_quote,
};

use super::{Kind, Walk, text, tokens};

/// Names that are taken for one another.
const OPPOSITES: [(&str, &str); 22] = [
    ("all", "any"),
    ("checked_add", "checked_sub"),
    ("denominator", "numerator"),
    ("end", "start"),
    ("first", "last"),
    ("floor", "ceil"),
    ("from_be_bytes", "from_le_bytes"),
    ("high", "low"),
    ("is_none", "is_some"),
    ("is_none_or", "is_some_and"),
    ("is_err", "is_ok"),
    ("leading_zeros", "trailing_zeros"),
    ("max", "min"),
    ("MAX", "MIN"),
    ("maximum", "minimum"),
    ("saturating_add", "saturating_sub"),
    ("to_be_bytes", "to_le_bytes"),
    ("unbounded_shl", "unbounded_shr"),
    ("wrapping_add", "wrapping_sub"),
    ("wrapping_shl", "wrapping_shr"),
    ("One", "Each"),
    ("Little", "Big"),
];

/// Steps without which a chain of calls has the same type, often enough.
const STEPS: [&str; 17] = [
    "abs",
    "chain",
    "clamp",
    "filter",
    "mask",
    "or",
    "or_else",
    "rem_euclid",
    "rev",
    "round",
    "skip",
    "skip_while",
    "take",
    "take_while",
    "trim",
    "trunc",
    "xor",
];

/// Calls whose argument is a predicate.
const PREDICATES: [&str; 13] = [
    "all",
    "any",
    "filter",
    "find",
    "is_none_or",
    "is_some_and",
    "partition",
    "position",
    "retain",
    "rfind",
    "rposition",
    "skip_while",
    "take_while",
];

/// Returns what can stand in place of an expression by mistake.
pub fn mistaken(expression: &Expr) -> Vec<(Kind, Expr)> {
    match expression {
        Expr::Binary(binary) => operator(binary).into_iter().collect(),
        Expr::Unary(unary) => match unary.op {
            UnOp::Not(_) => vec![(Kind::Logic, (*unary.expr).clone())],
            UnOp::Neg(_) => vec![(Kind::Arithmetic, (*unary.expr).clone())],
            _ => Vec::new(),
        },
        Expr::Range(range) => end(range).into_iter().collect(),
        Expr::Lit(ExprLit { lit, .. }) => literal(lit).into_iter().collect(),
        Expr::MethodCall(call) => method(call),
        Expr::Call(call) => function(call),
        Expr::Path(path) if path.path.segments.len() > 1 => {
            name(expression, path.path.segments.last().map(|segment| &segment.ident))
        }
        Expr::Field(field) => match &field.member {
            Member::Named(member) => name(expression, Some(member)),
            Member::Unnamed(_) => Vec::new(),
        },
        Expr::Match(choice) => arms(choice).into_iter().collect(),
        _ => Vec::new(),
    }
}

fn operator(binary: &ExprBinary) -> Option<(Kind, Expr)> {
    let (kind, op) = match binary.op {
        BinOp::Eq(_) => (Kind::Comparison, parse_quote!(!=)),
        BinOp::Ne(_) => (Kind::Comparison, parse_quote!(==)),
        BinOp::Lt(_) => (Kind::Comparison, parse_quote!(<=)),
        BinOp::Le(_) => (Kind::Comparison, parse_quote!(<)),
        BinOp::Gt(_) => (Kind::Comparison, parse_quote!(>=)),
        BinOp::Ge(_) => (Kind::Comparison, parse_quote!(>)),
        BinOp::And(_) => (Kind::Logic, parse_quote!(||)),
        BinOp::Or(_) => (Kind::Logic, parse_quote!(&&)),
        BinOp::Add(_) => (Kind::Arithmetic, parse_quote!(-)),
        BinOp::Sub(_) => (Kind::Arithmetic, parse_quote!(+)),
        BinOp::Mul(_) | BinOp::Rem(_) => (Kind::Arithmetic, parse_quote!(/)),
        BinOp::Div(_) => (Kind::Arithmetic, parse_quote!(*)),
        BinOp::AddAssign(_) => (Kind::Arithmetic, parse_quote!(-=)),
        BinOp::SubAssign(_) => (Kind::Arithmetic, parse_quote!(+=)),
        BinOp::BitAnd(_) => (Kind::Bits, parse_quote!(|)),
        BinOp::BitOr(_) | BinOp::BitXor(_) => (Kind::Bits, parse_quote!(&)),
        BinOp::BitOrAssign(_) | BinOp::BitXorAssign(_) => (Kind::Bits, parse_quote!(&=)),
        BinOp::BitAndAssign(_) => (Kind::Bits, parse_quote!(|=)),
        BinOp::Shl(_) => (Kind::Bits, parse_quote!(>>)),
        BinOp::Shr(_) => (Kind::Bits, parse_quote!(<<)),
        _ => return None,
    };
    Some((kind, Expr::Binary(ExprBinary { op, ..binary.clone() })))
}

fn end(range: &ExprRange) -> Option<(Kind, Expr)> {
    range.end.as_ref()?;
    let limits = match range.limits {
        RangeLimits::HalfOpen(_) => RangeLimits::Closed(parse_quote!(..=)),
        RangeLimits::Closed(_) => RangeLimits::HalfOpen(parse_quote!(..)),
    };
    Some((Kind::Range, Expr::Range(ExprRange { limits, ..range.clone() })))
}

fn literal(literal: &Lit) -> Option<(Kind, Expr)> {
    let (kind, lit) = match literal {
        Lit::Bool(truth) => (Kind::Truth, Lit::Bool(LitBool { value: !truth.value, ..truth.clone() })),
        Lit::Int(_) | Lit::Float(_) => (Kind::Number, Lit::new(tokens::one_more(&text(literal))?)),
        _ => return None,
    };
    Some((kind, Expr::Lit(ExprLit { attrs: Vec::new(), lit })))
}

fn name(expression: &Expr, name: Option<&Ident>) -> Vec<(Kind, Expr)> {
    let wrong = name.and_then(opposite).and_then(|opposite| {
        let mut wrong = expression.clone();
        match &mut wrong {
            Expr::Path(path) => path.path.segments.last_mut()?.ident = opposite,
            Expr::Field(field) => field.member = Member::Named(opposite),
            _ => return None,
        }
        Some((Kind::Name, wrong))
    });
    wrong.into_iter().collect()
}

/// A name and its opposite; other names have none.
fn opposite(name: &Ident) -> Option<Ident> {
    let other = OPPOSITES.iter().find_map(|(one, other)| match () {
        () if name == one => Some(other),
        () if name == other => Some(one),
        () => None,
    });
    other.map(|other| Ident::new(other, name.span()))
}

fn method(call: &ExprMethodCall) -> Vec<(Kind, Expr)> {
    let opposite =
        opposite(&call.method).map(|method| (Kind::Name, Expr::MethodCall(ExprMethodCall { method, ..call.clone() })));
    let is_step = STEPS.iter().any(|step| call.method == step);
    let left_out = is_step.then(|| (Kind::Step, (*call.receiver).clone()));
    let swapped = swapped(call.args.iter()).map(|(one, other)| {
        let mut call = call.clone();
        swap(&mut call.args, one, other);
        (Kind::Arguments, Expr::MethodCall(call))
    });
    opposite.into_iter().chain(left_out).chain(swapped).collect()
}

fn function(call: &ExprCall) -> Vec<(Kind, Expr)> {
    let swapped = swapped(call.args.iter()).map(|(one, other)| {
        let mut call = call.clone();
        swap(&mut call.args, one, other);
        (Kind::Arguments, Expr::Call(call))
    });
    swapped.into_iter().collect()
}

/// Returns the first two arguments that look alike.
fn swapped<'a>(arguments: impl Iterator<Item = &'a Expr>) -> Option<(usize, usize)> {
    let arguments: Vec<_> = arguments.collect();
    let place = arguments.windows(2).position(|pair| are_alike(pair[0], pair[1], arguments.len()))?;
    Some((place, place + 1))
}

fn are_alike(one: &Expr, other: &Expr, arguments: usize) -> bool {
    match (one, other) {
        _ if text(one) == text(other) => false,
        (Expr::Call(one), Expr::Call(other)) => text(&one.func) == text(&other.func),
        (Expr::MethodCall(_), Expr::MethodCall(_)) | (Expr::Field(_), Expr::Field(_)) => true,
        (Expr::Lit(one), Expr::Lit(other)) => discriminant(&one.lit) == discriminant(&other.lit),
        (Expr::Path(_), Expr::Path(_)) => arguments == 2,
        _ => false,
    }
}

fn swap(arguments: &mut syn::punctuated::Punctuated<Expr, syn::Token![,]>, one: usize, other: usize) {
    let mut all: Vec<_> = std::mem::take(arguments).into_iter().collect();
    all.swap(one, other);
    arguments.extend(all);
}

/// Swaps what the first two neighbours do that bind no names.
fn arms(choice: &ExprMatch) -> Option<(Kind, Expr)> {
    let is_plain = |arm: &Arm| !binds(&arm.pat);
    let place = choice
        .arms
        .windows(2)
        .position(|pair| pair.iter().all(is_plain) && text(&pair[0].body) != text(&pair[1].body))?;
    let mut wrong = choice.clone();
    let [one, other, ..] = &mut wrong.arms[place..] else { return None };
    std::mem::swap(&mut one.body, &mut other.body);
    Some((Kind::Arms, Expr::Match(wrong)))
}

fn binds(pattern: &Pat) -> bool {
    match pattern {
        Pat::Ident(name) => name.ident.to_string().starts_with(char::is_lowercase),
        Pat::Lit(_) | Pat::Path(_) | Pat::Range(_) | Pat::Rest(_) | Pat::Wild(_) => false,
        Pat::Or(or) => or.cases.iter().any(binds),
        Pat::Reference(reference) => binds(&reference.pat),
        Pat::Struct(fields) => fields.fields.iter().any(|field| binds(&field.pat)),
        Pat::Tuple(tuple) => tuple.elems.iter().any(binds),
        Pat::TupleStruct(tuple) => tuple.elems.iter().any(binds),
        _ => true,
    }
}

impl Walk {
    /// Turns round the conditions that stand directly in an expression.
    pub fn predicates(&mut self, expression: &mut Expr) {
        match expression {
            Expr::If(choice) => self.condition(&mut choice.cond),
            Expr::While(turns) => self.condition(&mut turns.cond),
            Expr::MethodCall(call) if call.method == "then" || call.method == "then_some" => {
                self.condition(inner(&mut call.receiver));
            }
            Expr::MethodCall(call) if PREDICATES.iter().any(|name| call.method == name) => {
                if let Some(Expr::Closure(closure)) = call.args.first_mut()
                    && !matches!(*closure.body, Expr::Block(_) | Expr::Match(_))
                {
                    self.condition(&mut closure.body);
                }
            }
            _ => {}
        }
    }
}

/// Returns what stands in parentheses.
fn inner(expression: &mut Expr) -> &mut Expr {
    match expression {
        Expr::Paren(paren) => inner(&mut paren.expr),
        expression => expression,
    }
}
