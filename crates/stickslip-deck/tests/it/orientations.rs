//! Axes by element and about a cylinder, and what surfaces carry. The numbers are those of CalculiX 2.20 with the same decks.

use std::f64::consts::FRAC_PI_2;

use crate::support::{near, refused, run};

/// A bar of two cubes of orthotropic material, pulled at its end.
fn bar(orientation: &str) -> String {
    let mut text = String::from("*NODE, NSET=N\n");
    for k in 0..3 {
        for (i, [x, y]) in [[0, 0], [1, 0], [1, 1], [0, 1]].into_iter().enumerate() {
            text += &format!("{}, {x}., {y}., {k}.\n", 4 * k + i + 1);
        }
    }
    format!(
        "{text}*ELEMENT, TYPE=C3D8, ELSET=EN\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 5, 6, 7, 8, 9, 10, 11, 12\n*NSET, NSET=TOP\n9, 10, 11, 12\n\
         {MATERIAL}{orientation}*SOLID SECTION, ELSET=EN, MATERIAL=OR, ORIENTATION=OR1\n*BOUNDARY\n1, 1, 3\n2, 2, 3\n3, 3\n4, 3\n4, 1\n\
         *STEP\n*STATIC\n*CLOAD\nTOP, 3, 1.\n*NODE PRINT, NSET=TOP\nU\n*EL PRINT, ELSET=EN\nS\n*END STEP\n"
    )
}

const MATERIAL: &str = "*MATERIAL, NAME=OR\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1000.,200.,500.,.1,.2,.15,150.,120.,\n90.\n";
const AXES: &str = "*DISTRIBUTION, NAME=DI\n, 1., 0., 0., 0., 1., 0.\n2, 0., 0., 1., 0., 1., 0.\n";
const USE: &str = "*ORIENTATION, NAME=OR1\nDI\n";

#[test]
fn axes_are_given_by_element() {
    // As Abaqus/CAE writes it as well.
    let table = "*DISTRIBUTION TABLE, NAME=DI-TABLE\ncoord3d, coord3d\n";
    let cae = AXES.replace("NAME=DI", "NAME=DI, LOCATION=ELEMENT, TABLE=DI-TABLE");
    let by_set = AXES.replace("\n2,", "\nSECOND,");
    for (name, text) in [
        ("distribution", format!("{AXES}{USE}")),
        ("distribution-later", format!("{table}{USE}{cae}")),
        (
            "distribution-set",
            format!("{by_set}{USE}*ELSET, ELSET=SECOND\n2\n"),
        ),
    ] {
        let run = run(name, &bar(&text));
        let u = run.u(10);
        for (found, wanted) in u.into_iter().zip([-7.938802e-4, -1.686842e-3, 1.193952e-2]) {
            near(found, wanted, 1e-5);
        }
        // Along the axes of the element.
        let stress = &run.all("stresses")[0].2;
        near(stress[8][2], 3.983412, 1e-5);
        near(stress[0][4], 3.954064, 1e-5);
    }
}

#[test]
fn distributions_that_say_nothing_are_refused() {
    for (text, said) in [
        (USE.to_string(), "there is no distribution DI"),
        (
            format!("{}{USE}", AXES.replace("\n, 1.", "\n1, 1.")),
            "the axes of all other elements",
        ),
        (
            format!(
                "{}{USE}",
                AXES.replace("1., 0., 0., 0., 1., 0.", "1., 0., 0., 2., 0., 0.")
            ),
            "do not span a plane",
        ),
        (
            format!("*DISTRIBUTION TABLE, NAME=T\nLENGTH\n{AXES}{USE}"),
            "distributions of LENGTH",
        ),
        (
            format!("{}{USE}", AXES.replace("\n2,", "\n7,")),
            "there is no element 7",
        ),
    ] {
        let message = refused(&bar(&text));
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn cylindrical_axes_turn_with_the_place() {
    // A quarter of a ring under pressure from inside, stiff along the radius and the circumference in its own way.
    let (rings, sectors) = (6, 8);
    let id = |i: usize, j: usize, k: usize| 1 + j + (sectors + 1) * (i + (rings + 1) * k);
    let mut text = String::from("*NODE, NSET=N\n");
    for k in 0..2 {
        for i in 0..=rings {
            for j in 0..=sectors {
                let (r, t) = (
                    1.0 + i as f64 / rings as f64,
                    FRAC_PI_2 * j as f64 / sectors as f64,
                );
                text += &format!(
                    "{}, {}, {}, {}\n",
                    id(i, j, k),
                    r * t.cos(),
                    r * t.sin(),
                    0.1 * k as f64
                );
            }
        }
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=EN\n";
    for i in 0..rings {
        for j in 0..sectors {
            let lower = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            let nodes: Vec<String> = (0..2)
                .flat_map(|k| lower.map(|[i, j]| id(i, j, k).to_string()))
                .collect();
            text += &format!("{}, {}\n", 1 + j + sectors * i, nodes.join(", "));
        }
    }
    let set = |name: &str, j: usize| {
        let all = (0..2).flat_map(|k| (0..=rings).map(move |i| (i, k)));
        let lines: String = all.map(|(i, k)| format!("{}\n", id(i, j, k))).collect();
        format!("*NSET, NSET={name}\n{lines}")
    };
    text += &format!(
        "{}{}*ELSET, ELSET=EI, GENERATE\n1, {sectors}\n{MATERIAL}*ORIENTATION, NAME=OC, SYSTEM=CYLINDRICAL\n0.,0.,0.,0.,0.,1.\n\
         *SOLID SECTION, ELSET=EN, MATERIAL=OR, ORIENTATION=OC\n*BOUNDARY\nN, 3\nXS, 1\nYS, 2\n*STEP\n*STATIC\n*DLOAD\nEI, P6, 1.\n*END STEP\n",
        set("XS", sectors),
        set("YS", 0)
    );
    let run = run("ring", &text);
    let u = |i, j, k| run.u(id(i, j, k) as u64);
    near(u(0, 0, 0)[0], 7.183374e-3, 1e-6);
    near(u(rings, 0, 0)[0], 6.676572e-3, 1e-6);
    // The same in all directions.
    near(u(0, sectors, 0)[1], u(0, 0, 0)[0], 1e-9);
}

#[test]
fn surfaces_print_what_they_carry() {
    let isotropic =
        "*MATERIAL, NAME=EL\n*ELASTIC\n1000., .3\n*SOLID SECTION, ELSET=EN, MATERIAL=EL\n";
    let bar = bar("");
    let (mesh, _) = bar.split_once("*MATERIAL").expect("a material");
    let sections = "*SURFACE, NAME=MID\n1, S2\n*SURFACE, NAME=BASE\n1, S1\n*BOUNDARY\n1, 1, 3\n2, 2, 3\n3, 3\n4, 3\n*STEP\n*STATIC\n*CLOAD\n\
                    9, 3, 1.\n10, 3, 2.\n11, 3, 3.\n12, 3, 2.5\n9, 1, .5\n*SECTION PRINT, SURFACE=MID, NAME=A\nSOF, SOM\n\
                    *SECTION PRINT, SURFACE=BASE, NAME=B\nSOAREA\n*END STEP\n";
    let found = run("section-print", &format!("{mesh}{isotropic}{sections}"));
    let force = found.all("total surface force");
    let rest = found.all("area, normal force");
    let centre = found.all("center of gravity");
    let about = found.all("moment about the center");
    for (k, [wanted, centred, moment, sums]) in [
        [
            &[
                1.380775e-1,
                8.571375e-2,
                8.499660,
                5.101610,
                -4.299251,
                2.238166e-1,
            ][..],
            &[0.5, 0.5, 1.0, 0.0, 0.0, 1.0],
            &[9.374942e-1, -1.874988e-1, 2.499984e-1],
            &[1.0, 8.499660, 1.625184e-1, 2.499984e-1, 9.560602e-1],
        ],
        [
            &[
                -4.868848e-1,
                1.960702,
                -8.630909,
                -5.174378,
                4.334700,
                9.737950e-1,
            ],
            &[0.5, 0.5, 0.0, 0.0, 0.0, -1.0],
            &[-8.589237e-1, 1.924576e-2, -2.499984e-1],
            &[1.0, 8.630909, 2.020250, 2.499984e-1, 8.591393e-1],
        ],
    ]
    .into_iter()
    .enumerate()
    {
        for (block, wanted) in [
            (&force, wanted),
            (&centre, centred),
            (&about, moment),
            (&rest, sums),
        ] {
            let found = &block[k].2[0];
            assert_eq!(found.len(), wanted.len(), "{found:?}");
            for (f, w) in found.iter().zip(wanted) {
                assert!((f - w).abs() < 5e-4, "{found:?} is not {wanted:?}");
            }
        }
    }
}
