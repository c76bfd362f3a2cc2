//! The codec of the benches that is written by hand, whose size shows what generated code can reach.

use std::fs;

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::calls::Module;
use super::{Program, root};

/// Its types of named values, which a macro writes.
const NAMED: [&str; 5] = ["WalkIn", "Led", "Sleep", "Power", "AddressMode"];

impl Program {
    /// Returns the program that recognises a frame by hand.
    pub fn decode_by_hand() -> Self {
        Self::by_hand("decode", &quote!(crate::calls::sink(hand::decode(&unknown::<canspec_runtime::Frame>()));))
    }

    /// Returns the program that builds the requests of every message by hand.
    pub fn encode_by_hand() -> Self {
        Self::by_hand("encode", &quote!(crate::calls::sink(hand::request(&unknown()));))
    }

    fn by_hand(task: &str, calls: &TokenStream) -> Self {
        let [hand, frame, steps] = ["infy/hand", "frame", "steps"].map(source);
        let [hand_code, frame_code, steps_code] =
            [&hand, &frame, &steps].map(|code| code.parse::<TokenStream>().expect("it is Rust"));
        let unknown_values = Module::new(&hand).unknown_values();
        let named_values = NAMED.map(|name| {
            let name = format_ident!("{name}");
            quote!(impl Unknown for #name { fn unknown() -> Self { unknown::<u8>().into() } })
        });
        let module = quote! {
            mod by_hand {
                mod frame {
                    #frame_code
                    use canspec_runtime::embedded_can;
                }

                mod steps {
                    #steps_code
                }

                mod hand {
                    #hand_code
                    use canspec_runtime::embedded_can;
                    use crate::unknown::{Unknown, unknown};

                    #unknown_values

                    #(#named_values)*
                }

                pub mod program {
                    use super::hand;
                    use crate::unknown::unknown;

                    pub fn program() { #calls }
                }
            }
        };
        Self::of(&format!("by_hand_{task}"), [("by_hand".to_owned(), module)])
    }
}

/// Returns a file of the benches.
fn source(name: &str) -> String {
    let path = root().join("generated/benches/src").join(name).with_extension("rs");
    fs::read_to_string(path).expect("the benches have the file")
}
