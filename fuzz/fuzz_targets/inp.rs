//! Input decks: any bytes give a deck or findings that can be shown, and a deck that is translated gives a problem that can be checked.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    // Included files would be those of this machine.
    let lower = bytes.to_ascii_lowercase();
    let squeezed: Vec<u8> = lower.into_iter().filter(|b| !b.is_ascii_whitespace()).collect();
    if squeezed.windows(8).any(|w| w == b"*include") {
        return;
    }
    let path = Path::new("fuzz.inp");
    let outcome = stickslip_deck::parse(bytes, path).and_then(|deck| stickslip_deck::translate(&deck, path));
    match outcome {
        Err(error) => {
            assert!(!error.findings.is_empty());
            assert!(error.findings.iter().all(|f| !f.message.is_empty()));
            let _ = error.to_string();
        }
        Ok(translation) => {
            stickslip::mesh::check::check_structure(&translation.mesh).expect("a mesh with a sound structure");
            if let Err(error) = translation.document(Vec::new()).problem() {
                // Whatever is wrong is wrong with the deck, not with the file made of it.
                assert!(error.findings.iter().all(|f| !f.key.is_empty()), "{error}\n{}", translation.toml);
                let _ = translation.located(error.into());
            }
        }
    }
});
