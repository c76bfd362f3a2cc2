//! Mistakes in code that stands in macros: that of `quote!`, and that of the project's own macros.

use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, TokenStream, TokenTree};

use super::{Kind, Walk};

/// Operators, and what they are mistaken for.
const OPERATORS: [(&str, &str, Kind); 8] = [
    ("..=", "..", Kind::Range),
    ("&&", "||", Kind::Logic),
    ("||", "&&", Kind::Logic),
    ("==", "!=", Kind::Comparison),
    ("!=", "==", Kind::Comparison),
    ("<=", "<", Kind::Comparison),
    (">=", ">", Kind::Comparison),
    ("<<", ">>", Kind::Bits),
];

/// Returns a number that is larger by one.
pub fn one_more(literal: &str) -> Option<Literal> {
    let wrong = match syn::parse_str(literal).ok()? {
        syn::Lit::Int(number) => {
            format!("{}{}", number.base10_parse::<u128>().ok()?.checked_add(1)?, number.suffix())
        }
        syn::Lit::Float(number) => format!("{:?}{}", number.base10_parse::<f64>().ok()? + 1.0, number.suffix()),
        _ => return None,
    };
    wrong.parse().ok()
}

impl Walk {
    /// Returns the tokens, with the mistake if it is one of theirs.
    pub fn tokens(&mut self, right: &TokenStream) -> TokenStream {
        let trees: Vec<_> = right.clone().into_iter().collect();
        let mut result = Vec::new();
        let mut at = 0;
        while at < trees.len() {
            let (taken, wrong) = mistaken(&trees[at..]);
            let rights = &trees[at..at + taken];
            let is_planted = wrong.is_some_and(|(kind, wrong)| {
                let is_planted = self.note(kind, text(rights), text(&wrong));
                if is_planted {
                    result.extend(wrong);
                }
                is_planted
            });
            if !is_planted {
                result.extend(rights.iter().map(|tree| self.tree(tree)));
            }
            at += taken;
        }
        result.into_iter().collect()
    }

    fn tree(&mut self, tree: &TokenTree) -> TokenTree {
        let TokenTree::Group(group) = tree else { return tree.clone() };
        TokenTree::Group(Group::new(group.delimiter(), self.tokens(&group.stream())))
    }
}

fn text(trees: &[TokenTree]) -> String {
    trees.iter().cloned().collect::<TokenStream>().to_string()
}

type Mistaken = (usize, Option<(Kind, Vec<TokenTree>)>);

/// Returns how many tokens belong together, and what can stand in their place by mistake.
fn mistaken(trees: &[TokenTree]) -> Mistaken {
    match trees {
        [TokenTree::Punct(dot), TokenTree::Ident(_), TokenTree::Group(arguments), ..]
            if dot.as_char() == '.' && arguments.delimiter() == Delimiter::Parenthesis =>
        {
            (3, Some((Kind::Step, Vec::new())))
        }
        [hash, TokenTree::Ident(one), TokenTree::Punct(comma), other_hash, TokenTree::Ident(other), ..]
            if is_hash(hash) && is_hash(other_hash) && comma.as_char() == ',' =>
        {
            let wrong =
                vec![hash.clone(), other.clone().into(), comma.clone().into(), hash.clone(), one.clone().into()];
            (5, Some((Kind::Arguments, wrong)))
        }
        [TokenTree::Ident(word), ..] => (1, truth(word).map(|wrong| (Kind::Truth, vec![wrong]))),
        [TokenTree::Literal(literal), ..] => {
            (1, one_more(&literal.to_string()).map(|wrong| (Kind::Number, vec![TokenTree::Literal(wrong)])))
        }
        [TokenTree::Punct(_), ..] => operator(trees),
        _ => (1, None),
    }
}

/// What begins a variable of `quote!` or of a macro.
fn is_hash(tree: &TokenTree) -> bool {
    matches!(tree, TokenTree::Punct(punct) if matches!(punct.as_char(), '#' | '$'))
}

fn truth(word: &Ident) -> Option<TokenTree> {
    let other = match word.to_string().as_str() {
        "true" => "false",
        "false" => "true",
        _ => return None,
    };
    Some(Ident::new(other, word.span()).into())
}

fn operator(trees: &[TokenTree]) -> Mistaken {
    let text = joined(trees);
    let known = OPERATORS.iter().find(|(right, _, _)| text.starts_with(right));
    known.map_or((1, None), |(right, wrong, kind)| (right.len(), Some((*kind, puncts(wrong)))))
}

/// Returns the signs at the start that stand together.
fn joined(trees: &[TokenTree]) -> String {
    let mut text = String::new();
    for tree in trees {
        let TokenTree::Punct(punct) = tree else { break };
        text.push(punct.as_char());
        if punct.spacing() == Spacing::Alone {
            break;
        }
    }
    text
}

fn puncts(operator: &str) -> Vec<TokenTree> {
    let last = operator.len() - 1;
    let punct = |(place, sign): (usize, char)| {
        Punct::new(sign, if place == last { Spacing::Alone } else { Spacing::Joint }).into()
    };
    operator.chars().enumerate().map(punct).collect()
}
