//! One file per model plus one line here and there a name: the registry of model families.
//!
//! [`family!`](crate::family) turns a list of structs into the enum that the problem file, the JSON schema,
//! `stickslip models` and the conformance tests share. In the problem file an entry is written as a table with
//! one key, its kind: `normal.power-law = { c = 1e20, m = 2.0 }`. Internally tagged forms are avoided because they
//! lose the place of an error and the check for unknown keys.

/// A family of interchangeable models: its key in the problem file and its entries.
pub trait Family: Sized {
    /// The key under which the problem file chooses from this family.
    const KEY: &'static str;

    /// The keys of the entries, in the order of the registry.
    const KINDS: &'static [&'static str];

    /// One instance or more of every entry, for the tests that run over all of them.
    fn samples() -> Vec<Self>;

    /// The key of this instance's kind.
    fn kind(&self) -> &'static str;
}

/// A model's contribution to [`Family::samples`].
pub trait Samples: Sized {
    /// Instances with parameters of an engineering size, in SI units.
    fn samples() -> Vec<Self>;
}

/// Declares a family: an externally tagged enum, `as_dyn`, and the [`Family`] implementation.
#[macro_export]
macro_rules! family {
    ($(#[$doc:meta])* $name:ident: $key:literal, dyn $object:path {
        $( $(#[$vdoc:meta])* $variant:ident($model:path) = $kind:literal ),+ $(,)?
    }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum $name {
            $( $(#[$vdoc])* #[serde(rename = $kind)] $variant($model) ),+
        }

        impl $name {
            /// The model behind its trait.
            pub fn as_dyn(&self) -> &dyn $object {
                match self { $( $name::$variant(model) => model ),+ }
            }
        }

        impl $crate::registry::Family for $name {
            const KEY: &'static str = $key;
            const KINDS: &'static [&'static str] = &[$( $kind ),+];

            fn samples() -> Vec<Self> {
                let mut all = Vec::new();
                $( all.extend(
                    <$model as $crate::registry::Samples>::samples().into_iter().map($name::$variant),
                ); )+
                all
            }

            fn kind(&self) -> &'static str {
                match self { $( $name::$variant(_) => $kind ),+ }
            }
        }
    };
}
