//! Finds every function of generated code, and writes a call of it with unknown arguments.

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use syn::{
    Fields, File, FnArg, Generics, ImplItem, ImplItemConst, Item, ItemEnum, ItemImpl, ItemStruct, PathSegment,
    ReceiverKind, ReturnType, Signature, Type,
};

/// The source of one generated module, read.
pub struct Module(File);

/// A function of an `impl` block.
#[derive(Clone, Copy)]
struct Function<'a> {
    block: &'a ItemImpl,
    signature: &'a Signature,
}

impl Module {
    /// Reads the source.
    ///
    /// # Panics
    ///
    /// If it is no Rust.
    pub fn new(code: &str) -> Self {
        Self(syn::parse_file(code).expect("generated code is Rust"))
    }

    /// Returns how its types get unknown values.
    pub fn unknown_values(&self) -> TokenStream {
        let items = self.0.items.iter().map(|item| match item {
            Item::Enum(item) => unknown_enum(item),
            Item::Struct(item) => unknown_struct(item),
            _ => TokenStream::new(),
        });
        items.collect()
    }

    /// Returns calls of everything.
    pub fn everything(&self) -> TokenStream {
        let clients = self.blocks().filter(|block| is_of(block, "Destination")).map(|block| {
            let owner = &block.self_ty;
            quote!(calls::client::<#owner>();)
        });
        let stations = self.blocks().filter(|block| is_of(block, "Quantities")).map(|block| {
            let owner = &block.self_ty;
            quote!(stations::station::<#owner>();)
        });
        let transports = quote!(calls::transport(); calls::isotp(););
        std::iter::once(self.codec()).chain(clients).chain(stations).chain([transports]).collect()
    }

    /// Returns calls of every function, and of what the runtime provides for its types, but no client, no station and no
    /// simulator.
    pub fn codec(&self) -> TokenStream {
        // What has parameters of its own is called by the runtime.
        let is_called = |function: &Function<'_>| {
            function.signature.ident != "fmt" && function.signature.generics.type_params().next().is_none()
        };
        let functions = self.functions().filter(is_called).map(Function::call);
        functions.chain(self.signals()).chain(self.blocks().map(provided)).collect()
    }

    /// Returns calls that recognise frames, encode others, build the requests of every message and read their replies.
    pub fn traffic(&self) -> TokenStream {
        let requests = self.functions().filter(Function::builds_request).map(Function::call);
        std::iter::once(quote!(calls::echo::<Message>();)).chain(requests).collect()
    }

    /// Returns calls that build the requests of every message.
    pub fn requests(&self) -> TokenStream {
        self.functions().filter(Function::builds_request).map(Function::encode).collect()
    }

    /// Returns calls that decode and request one message: the first whose request carries signals.
    pub fn one_message(&self) -> Option<(String, TokenStream)> {
        let with_signals =
            |function: &Function<'_>| function.builds_request() && function.signature.receiver().is_some();
        let function = self.functions().find(with_signals)?;
        let (owner, call) = (&function.block.self_ty, function.call());
        let decode = quote!(calls::sink(<#owner as Layout>::decode(&unknown())););
        Some((text(owner), quote!(#decode #call)))
    }

    /// Returns the names of the structs that frames decode to.
    pub fn layouts(&self) -> impl Iterator<Item = String> {
        let layouts = self.blocks().filter(|block| is_of(block, "Layout"));
        layouts.map(|block| text(&block.self_ty))
    }

    fn blocks(&self) -> impl Iterator<Item = &ItemImpl> {
        self.0.items.iter().filter_map(|item| if let Item::Impl(block) = item { Some(block) } else { None })
    }

    fn functions(&self) -> impl Iterator<Item = Function<'_>> {
        self.blocks().flat_map(|block| {
            block.items.iter().filter_map(move |item| match item {
                ImplItem::Fn(function) => Some(Function { block, signature: &function.sig }),
                _ => None,
            })
        })
    }

    fn signals(&self) -> impl Iterator<Item = TokenStream> {
        self.blocks().flat_map(|block| {
            let constants = block.items.iter().filter_map(|item| match item {
                ImplItem::Const(constant) if is_signal(constant) => Some(&constant.ident),
                _ => None,
            });
            let owner = &block.self_ty;
            constants.map(move |name| quote!(calls::signal(&<#owner>::#name);))
        })
    }
}

impl Function<'_> {
    fn call(self) -> TokenStream {
        let result = self.result();
        match &self.signature.output {
            _ if self.builds_requests() => quote!(calls::requests(#result);),
            _ if self.builds_request() => quote!(calls::request(#result);),
            ReturnType::Type(_, output) if matches!(**output, Type::ImplTrait(_)) => {
                quote!(#result.for_each(calls::sink);)
            }
            _ => quote!(calls::sink(#result);),
        }
    }

    fn encode(self) -> TokenStream {
        let result = self.result();
        if self.builds_requests() { quote!(calls::sink(#result);) } else { quote!(calls::encode(#result);) }
    }

    fn result(self) -> TokenStream {
        let (owner, name) = (&self.block.self_ty, &self.signature.ident);
        let of_trait = self.block.trait_.as_ref().map(|(path, _)| quote!(as #path));
        let arguments = self.signature.inputs.iter().map(|argument| match argument {
            FnArg::Receiver(receiver) => unknown_receiver(&receiver.kind),
            FnArg::Typed(argument) => unknown(&argument.ty),
        });
        quote!(<#owner #of_trait>::#name(#(#arguments),*))
    }

    /// Tests whether it builds a request for each member of a set.
    fn builds_requests(&self) -> bool {
        text(&self.signature.output).contains("[Request <")
    }

    fn builds_request(&self) -> bool {
        text(&self.signature.output).contains("Request <")
    }
}

/// Returns an unknown value of the type itself.
fn unknown_receiver(kind: &ReceiverKind) -> TokenStream {
    if let ReceiverKind::Reference(_, _, mutability) = kind {
        quote!(&#mutability unknown())
    } else {
        quote!(unknown())
    }
}

/// Returns an unknown value of an argument's type.
fn unknown(argument: &Type) -> TokenStream {
    match argument {
        Type::Reference(reference) if text(&reference.elem) == "str" => quote!(unknown()),
        Type::Reference(reference) if text(&reference.elem) == "[u8]" => quote!(&mut unknown::<[u8; 2048]>()),
        Type::Reference(reference) => {
            let (mutability, value) = (&reference.mutability, unknown(&reference.elem));
            quote!(&#mutability #value)
        }
        Type::ImplTrait(bounds) => match text(&bounds.bounds).as_str() {
            "Into < Route < Target > >" => quote!(unknown::<Route<Target>>()),
            "embedded_can :: Frame" => quote!(unknown::<Frame>()),
            bound => panic!("say which type stands for `impl {bound}`"),
        },
        _ => quote!(unknown()),
    }
}

/// Returns calls of what the runtime provides for a type that implements one of its traits.
fn provided(block: &ItemImpl) -> TokenStream {
    let owner = &block.self_ty;
    match trait_name(block).map(|name| name.ident.to_string()).as_deref() {
        Some("Layout") => quote!(calls::layout::<#owner>();),
        Some("LongLayout") => quote!(calls::long_layout::<#owner>();),
        Some("Parted") => quote!(calls::parted::<#owner>();),
        Some("Transport") => quote!(calls::transfers::<#owner>();),
        Some("Grouped") => quote!(calls::aborted::<#owner>();),
        Some("Filled") => quote!(calls::bare::<#owner>();),
        Some("Transferred") => quote!(calls::transferred::<#owner>();),
        Some("Destination") => quote!(calls::questions::<#owner>();),
        Some("Protocol") => quote!(calls::received::<#owner>(); calls::entries::<#owner>();),
        Some("Quantities") => quote!(calls::quantities::<#owner>();),
        Some("FrameSet") => quote!(calls::assembler::<#owner>();),
        Some("Display") => quote!(calls::text(&unknown::<#owner>());),
        _ => TokenStream::new(),
    }
}

fn text(tokens: &impl ToTokens) -> String {
    tokens.to_token_stream().to_string()
}

fn trait_name(block: &ItemImpl) -> Option<&PathSegment> {
    block.trait_.as_ref().and_then(|(path, _)| path.segments.last())
}

fn is_of(block: &ItemImpl, name: &str) -> bool {
    trait_name(block).is_some_and(|known| known.ident == name)
}

fn is_signal(constant: &ImplItemConst) -> bool {
    text(&constant.ty).starts_with("Signal <")
}

fn unknown_struct(item: &ItemStruct) -> TokenStream {
    let value = fields(&item.fields);
    implementation(&item.ident, &item.generics, &quote!(Self #value))
}

fn unknown_enum(item: &ItemEnum) -> TokenStream {
    let values = item.variants.iter().map(|variant| {
        let (name, value) = (&variant.ident, fields(&variant.fields));
        quote!(Self::#name #value)
    });
    let values: Vec<_> = values.collect();
    let (last, others) = values.split_last().expect("generated enums have variants");
    let numbers = 0_u16..;
    implementation(&item.ident, &item.generics, &quote!(match unknown::<u16>() { #(#numbers => #others,)* _ => #last }))
}

fn implementation(name: &syn::Ident, generics: &Generics, value: &TokenStream) -> TokenStream {
    let types: Vec<_> = generics.type_params().map(|parameter| &parameter.ident).collect();
    let unknown = quote!(crate::unknown::Unknown);
    quote!(impl<#(#types: #unknown),*> #unknown for #name<#(#types),*> { fn unknown() -> Self { #value } })
}

/// Returns unknown values of the fields of a struct or of a variant.
fn fields(fields: &Fields) -> TokenStream {
    let count = fields.iter().map(|_| format_ident!("unknown"));
    match fields {
        Fields::Unit => TokenStream::new(),
        Fields::Unnamed(_) => quote!((#(#count()),*)),
        Fields::Named(_) => {
            let names = fields.iter().map(|field| &field.ident);
            quote!({ #(#names: unknown()),* })
        }
    }
}
