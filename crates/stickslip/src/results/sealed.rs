//! State as bytes that say whether they are what was written: in front of it a mark, the version of the program, and digests of the rest and of its layout.
//!
//! What was cut or changed is found before anything is made of it, and so is what another version wrote, or another build in which something else is kept:
//! the digest is that of the [layout](crate::keep::layout), which follows from what is kept.

use crate::keep::{Keep, Kept, layout};
use crate::linear::Digest;

/// What sealed state begins with, in the version of what stands in front of the state.
const MARK: &[u8; 16] = b"stickslip state4";

/// Bytes of state, sealed.
pub fn seal(state: &impl Keep) -> Vec<u8> {
    let content = laid_out(state);
    let mut out = MARK.to_vec();
    env!("CARGO_PKG_VERSION").to_string().keep(&mut out);
    digest(&content).keep(&mut out);
    out.extend(content);
    out
}

/// The state that was sealed; `what` it is, is named in messages: `the checkpoint`.
///
/// # Errors
/// Why not, in a sentence: it is something else, of another version, or damaged.
pub fn unseal<T: Keep>(bytes: &[u8], what: &str) -> Result<T, String> {
    let other = || {
        format!(
            "{what} has another layout than this build of stickslip reads: go on with the one that wrote it"
        )
    };
    let Some(rest) = bytes.strip_prefix(MARK) else {
        return Err(match bytes.starts_with(&MARK[..15]) {
            true => other(),
            false => format!("this is not {what}, or it is damaged at its beginning"),
        });
    };
    let damaged = || format!("{what} is damaged: it is cut, or was changed");
    let mut kept = Kept::new(rest);
    let version = String::back(&mut kept).map_err(|_| damaged())?;
    if version != env!("CARGO_PKG_VERSION") {
        return Err(format!(
            "{what} was written by stickslip {version}, and this is {}: go on with that version",
            env!("CARGO_PKG_VERSION")
        ));
    }
    let wanted = <[u64; 2]>::back(&mut kept).map_err(|_| damaged())?;
    if digest(kept.rest()) != wanted {
        return Err(damaged());
    }
    match read(kept.rest()) {
        Ok(state) => Ok(state),
        Err(Unread::Layout) => Err(other()),
        Err(Unread::Damaged) => Err(damaged()),
    }
}

/// Bytes of state behind a digest of its layout.
pub(crate) fn laid_out(state: &impl Keep) -> Vec<u8> {
    fn digest_of<T: Keep>(_: &T) -> [u64; 2] {
        digest(layout::<T>().as_bytes())
    }
    let mut out = Vec::new();
    digest_of(state).keep(&mut out);
    state.keep(&mut out);
    out
}

/// Why bytes are not the state that was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unread {
    /// They are one of another layout.
    Layout,
    /// They are of this layout, and broken.
    Damaged,
}

/// The state in bytes behind a digest of its layout.
pub(crate) fn read<T: Keep>(bytes: &[u8]) -> Result<T, Unread> {
    let mut kept = Kept::new(bytes);
    let found = <[u64; 2]>::back(&mut kept).map_err(|_| Unread::Damaged)?;
    if found != digest(layout::<T>().as_bytes()) {
        return Err(Unread::Layout);
    }
    match T::back(&mut kept) {
        Ok(state) if kept.is_empty() => Ok(state),
        _ => Err(Unread::Damaged),
    }
}

/// A digest of state, by which it is known again.
pub fn digest_of_state(state: &impl Keep) -> [u64; 2] {
    let mut content = Vec::new();
    state.keep(&mut content);
    digest(&content)
}

/// A digest of bytes.
pub(super) fn digest(bytes: &[u8]) -> [u64; 2] {
    let mut digest = Digest::default();
    digest.bytes(bytes);
    digest.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_sealed_comes_back_and_what_was_changed_does_not() {
        let state = (vec![1.0, f64::NAN], "é".to_string());
        let bytes = seal(&state);
        let back: (Vec<f64>, String) = unseal(&bytes, "it").unwrap();
        assert_eq!(back.0[1].to_bits(), f64::NAN.to_bits());
        assert_eq!(back.1, "é");
        for at in 0..bytes.len() {
            let mut other = bytes.clone();
            other[at] ^= 1 << (at % 8);
            assert!(unseal::<(Vec<f64>, String)>(&other, "it").is_err(), "{at}");
            assert!(unseal::<(Vec<f64>, String)>(&bytes[..at], "it").is_err());
        }
    }

    #[test]
    fn state_of_another_layout_is_told_from_damaged_state() {
        #[derive(crate::keep::Keep)]
        struct Before {
            a: u64,
            b: f64,
        }
        #[derive(crate::keep::Keep)]
        struct After {
            a: u64,
            c: f64,
        }
        let bytes = seal(&Before { a: 1, b: 0.5 });
        let back: Before = unseal(&bytes, "it").unwrap();
        assert_eq!((back.a, back.b), (1, 0.5));
        let said = unseal::<After>(&bytes, "it").map(|after| (after.a, after.c));
        assert!(said.unwrap_err().contains("it has another layout"));
    }
}
