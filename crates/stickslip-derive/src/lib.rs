//! `#[derive(Keep)]`: state as bytes, from the definition of its type alone.
//!
//! Not serde's derive: what is skipped, flattened or renamed for `summary.json` has to be in a checkpoint as it is, and of serde's traits no layout follows.

use proc_macro::TokenStream;
use proc_macro2::TokenStream as Code;
use quote::{format_ident, quote};
use syn::{Data, DeriveInput, Error, Expr, Field, Fields, Result, Token, parse_macro_input};

/// Implements `Keep`: all fields in the order of the definition, variants by their place in it.
///
/// What stands in a field with `#[keep(again)]` is not written, but made again by its default, or as in `#[keep(again = value())]`.
#[proc_macro_derive(Keep, attributes(keep))]
pub fn keep(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    let code = implementation(&input);
    code.unwrap_or_else(Error::into_compile_error).into()
}

fn implementation(input: &DeriveInput) -> Result<Code> {
    let (keep, back, parts) = match &input.data {
        Data::Struct(data) => {
            let Parts {
                pattern,
                keep,
                back,
                layout,
            } = parts(&data.fields)?;
            (
                quote!(let Self { #pattern } = self; #keep),
                quote!(Ok(Self { #back })),
                layout,
            )
        }
        Data::Enum(data) => {
            let (mut keeps, mut backs, mut layouts) = (Code::new(), Code::new(), Code::new());
            for (place, variant) in (0_u8..=u8::MAX).zip(&data.variants) {
                let (name, word) = (&variant.ident, variant.ident.to_string());
                let Parts {
                    pattern,
                    keep,
                    back,
                    layout,
                } = parts(&variant.fields)?;
                keeps.extend(quote!(Self::#name { #pattern } => { out.push(#place); #keep }));
                backs.extend(quote!(#place => Ok(Self::#name { #back }),));
                layouts.extend(quote!(out.word(#word);));
                if !variant.fields.is_empty() {
                    layouts.extend(quote!(out.word("("); #layout out.word(")");));
                }
            }
            let place = quote!(<u8 as ::stickslip_base::keep::Keep>::back(from)?);
            (
                quote!(match self { #keeps }),
                quote!(match #place { #backs _ => Err(::stickslip_base::keep::Broken) }),
                layouts,
            )
        }
        Data::Union(data) => {
            let token = data.union_token;
            return Err(Error::new_spanned(token, "a union cannot be kept"));
        }
    };
    let (name, word) = (&input.ident, input.ident.to_string());
    Ok(quote! {
        impl ::stickslip_base::keep::Keep for #name {
            fn keep(&self, out: &mut Vec<u8>) { #keep }

            fn back(from: &mut ::stickslip_base::keep::Kept) -> Result<Self, ::stickslip_base::keep::Broken> { #back }

            fn layout_of(out: &mut ::stickslip_base::keep::Layout) { out.of::<Self>(#word, |out| { #parts }); }
        }
    })
}

/// Code for the fields of a struct or a variant.
#[derive(Default)]
struct Parts {
    /// What stands in the braces of a pattern that binds them.
    pattern: Code,
    /// Statements that keep what was bound.
    keep: Code,
    /// What stands in the braces of an expression that reads them.
    back: Code,
    /// Statements that say of what types they are.
    layout: Code,
}

fn parts(fields: &Fields) -> Result<Parts> {
    let mut parts = Parts::default();
    for (i, (member, field)) in fields.members().zip(fields).enumerate() {
        if let Some(value) = made_again(field)? {
            parts.pattern.extend(quote!(#member: _,));
            parts.back.extend(quote!(#member: #value,));
            continue;
        }
        let (bound, ty) = (format_ident!("field{i}"), &field.ty);
        let word = field.ident.iter().map(|name| name.to_string());
        parts.pattern.extend(quote!(#member: #bound,));
        (parts.keep).extend(quote!(::stickslip_base::keep::Keep::keep(#bound, out);));
        (parts.back).extend(quote!(#member: ::stickslip_base::keep::Keep::back(from)?,));
        (parts.layout).extend(
            quote!(#(out.word(#word);)* <#ty as ::stickslip_base::keep::Keep>::layout_of(out);),
        );
    }
    Ok(parts)
}

/// The value of a field that is made again.
fn made_again(field: &Field) -> Result<Option<Code>> {
    let mut value = None;
    for attribute in &field.attrs {
        if !attribute.path().is_ident("keep") {
            continue;
        }
        attribute.parse_nested_meta(|meta| {
            if !meta.path.is_ident("again") {
                return Err(meta.error("a field is made `again`, or it is kept"));
            }
            value = Some(match meta.input.peek(Token![=]) {
                true => {
                    let given: Expr = meta.value()?.parse()?;
                    quote!(#given)
                }
                false => quote!(Default::default()),
            });
            Ok(())
        })?;
    }
    Ok(value)
}
