//! The examples, one test each, for every suite that runs them all.

/// Makes a test of each example that calls a function with the name of its folder, and one that no folder is left out.
macro_rules! every_example {
    ($check:ident) => {
        every_example! { $check:
            cattaneo_mindlin = "cattaneo-mindlin",
            hertz_line = "hertz-line",
            hertz_sphere = "hertz-sphere",
            mindlin_sphere = "mindlin-sphere",
            fretting_sphere = "fretting-sphere",
            fretting_wear = "fretting-wear",
            rough_block = "rough-block",
            running_condition = "running-condition",
            bentall_johnson = "bentall-johnson",
            belt_block = "belt-block",
            belt_mass = "belt-mass",
            block_limits = "block-limits",
            bolt_preload = "bolt-preload",
            bolted_joint = "bolted-joint",
            bouncing_bar = "bouncing-bar",
            braking_block = "braking-block",
            closing_gaps = "closing-gaps",
            coated_flat = "coated-flat",
            compliance_bar = "compliance-bar",
            compliance_impact = "compliance-impact",
            disc_brake = "disc-brake",
            fault_bp1 = "fault-bp1",
            flat_punch = "flat-punch",
            forced_slider = "forced-slider",
            free_slider = "free-slider",
            gear_pair = "gear-pair",
            geneva_drive = "geneva-drive",
            greco = "greco",
            greco_compliance = "greco-compliance",
            impact_bar = "impact-bar",
            ironing = "ironing",
            leaving_face = "leaving-face",
            lug = "lug",
            patch_friction = "patch-friction",
            patch_matching = "patch-matching",
            patch_taylor = "patch-taylor",
            press_and_slide = "press-and-slide",
            roller_bearing = "roller-bearing",
            rolling_wheel = "rolling-wheel",
            scratched_floor = "scratched-floor",
            tumbling_block = "tumbling-block",
            shear_column = "shear-column",
            shear_lag = "shear-lag",
            shrink_fit = "shrink-fit",
            steel_bar = "steel-bar",
            two_bars = "two-bars",
        }
    };
    ($check:ident: $($test:ident = $folder:literal),+ $(,)?) => {
        $(#[test] fn $test() { $check($folder); })+

        /// No example goes untested.
        #[test]
        fn every_example_is_listed() {
            let examples = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
            let mut found: Vec<String> = std::fs::read_dir(&examples)
                .expect("the folder of examples")
                .map(|entry| entry.expect("an entry"))
                .filter(|entry| entry.path().is_dir())
                .map(|entry| entry.file_name().to_string_lossy().into_owned())
                .collect();
            found.sort();
            let mut listed = vec![$($folder.to_string()),+];
            listed.sort();
            assert_eq!(found, listed);
            for name in found {
                assert!(examples.join(&name).join("README.md").exists(), "{name} has no README");
            }
        }
    };
}
