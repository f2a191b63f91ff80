//! Reports and pictures of small runs: what is in them, and what is said where results are missing or damaged.

use std::path::{Path, PathBuf};

use stickslip::io::write_atomically;
use stickslip::problem::Problem;
use stickslip::results::{Claim, Observer, ResultFiles};
use stickslip::run::Simulation;
use stickslip_report::plot::{self, Along, Apart, Colours, Facts, Picture, View, When, Zoom};
use stickslip_report::{Limits, Results, page, report};

const EVIL: &str = "</script><b id=\"x\">&'`<!--";
/// What is allowed in names.
const AWKWARD: &str = "&amp;'`!-- {}${x}";

/// A folder that goes away with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("stickslip-report-{}-{name}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn run(text: &str, directory: &Path) {
    let problem = Problem::from_toml(text, None).unwrap();
    let model = problem.build(Path::new("")).unwrap();
    let mut simulation = Simulation::new(model).unwrap();
    let mut files = ResultFiles::new(directory, &Claim::default()).unwrap();
    let mut observers: Vec<&mut dyn Observer> = vec![&mut files];
    simulation.run(&mut observers).unwrap();
    let text = problem.to_toml().unwrap();
    write_atomically(&directory.join("problem.toml"), text.as_bytes()).unwrap();
}

/// Two cubes of one cell, pressed and slid; or squares.
fn stacked(space: &str, title: &str, body: &str) -> String {
    let (kind, z, lower, upper) = match space {
        "solid" => (
            "box",
            "z",
            "from = [0, 0, 0], to = [1, 1, 1], cells = [1, 1, 1]",
            "from = [0, 0, 1], to = [1, 1, 2], cells = [1, 1, 1]",
        ),
        _ => (
            "rectangle",
            "y",
            "from = [0, 0], to = [1, 1], cells = [2, 1]",
            "from = [0, 1], to = [1, 2], cells = [2, 1]",
        ),
    };
    let depth = if space == "solid" { "y = 0\n" } else { "" };
    let key = toml_key(body);
    format!(
        "format = 1\ntitle = {title}\n[model]\nspace = \"{space}\"\n\
         [body.a]\ngenerate.{kind} = {{ {lower} }}\nmaterial = \"steel\"\n\
         [body.{key}]\ngenerate.{kind} = {{ {upper} }}\nmaterial = \"steel\"\n\
         [material.steel.isotropic]\nyoung = 210e9\npoisson = 0.3\n\
         [interface.joint]\nsecondary = {sec}\nprimary = \"a.top\"\nfriction.coulomb = {{ mu = 0.3 }}\n\
         [support.base]\nset = \"a.bottom\"\nhold = [\"x\", \"{z}\"]\n{depth}\
         [support.top]\nset = {top}\nx = 1e-4\n{depth}{z} = -1e-3\n\
         [[step]]\nname = \"press\"\nincrements.fixed = 3\n[quality]\ngate = \"warn\"\n",
        title = toml_string(title),
        sec = toml_string(&format!("{body}.bottom")),
        top = toml_string(&format!("{body}.top")),
    )
}

fn toml_string(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

fn toml_key(text: &str) -> String {
    match text.chars().all(|c| c.is_ascii_alphanumeric() || c == '-') {
        true => text.to_string(),
        false => toml_string(text),
    }
}

fn written(directory: &Path) -> String {
    let report = report(directory, None, Limits::default()).unwrap();
    assert_eq!(report.notes, Vec::<String>::new());
    let text = std::fs::read_to_string(&report.file).unwrap();
    assert_eq!(text.len() as u64, report.size);
    text
}

/// Whether every element is closed where it should be; the content of scripts and styles is not looked at.
fn nests(page: &str) {
    let alone = ["meta", "link", "input", "br", "line", "!doctype"];
    let mut open: Vec<String> = Vec::new();
    let mut rest = page;
    while let Some(at) = rest.find('<') {
        rest = &rest[at + 1..];
        let end = rest.find(['>', ' ', '\n', '/']).unwrap_or(rest.len());
        if let Some(tail) = rest.strip_prefix('/') {
            let name = &tail[..tail.find('>').unwrap()];
            assert_eq!(
                open.pop().as_deref(),
                Some(name),
                "</{name}> is out of place"
            );
            continue;
        }
        let name = rest[..end].to_ascii_lowercase();
        let close = rest.find('>').unwrap();
        let closed = rest[..close].ends_with('/');
        rest = &rest[close + 1..];
        if closed {
            continue;
        }
        if name == "script" || name == "style" {
            let tail = format!("</{name}>");
            rest = &rest[rest.find(&tail).unwrap() + tail.len()..];
        } else if !alone.contains(&name.as_str()) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "still open: {open:?}");
}

#[test]
fn a_report_has_all_sections_and_loads_nothing() {
    for space in ["solid", "plane-strain"] {
        let folder = Folder::new(&format!("all-{space}"));
        run(&stacked(space, "Two blocks", "b"), &folder.0);
        let page = written(&folder.0);
        nests(&page);
        for id in [
            "result",
            "along",
            "solved",
            "quality",
            "convergence",
            "energy",
            "history",
            "time",
        ] {
            assert!(page.contains(&format!("<section id=\"{id}\"")), "{id}");
        }
        for text in [
            "<title>Two blocks</title>",
            "friction › coulomb › mu",
            "<td>210e9</td>",
            "Step 1",
            "penetration to approach",
            "Content-Security-Policy",
            "default-src 'none'",
        ] {
            assert!(page.contains(text), "{text}");
        }
        // Units are those of the problem file, whatever they are.
        let shown = &page[..page.find("<script").unwrap()];
        assert!(!shown.contains("[Pa]") && !shown.contains("[m]"));
        // Nothing is loaded by any of the ways in which HTML loads.
        for way in [
            " src=",
            "url(",
            "@import",
            "srcset",
            "<iframe",
            "<object",
            "<embed",
            "<base",
            "import(\"http",
            "fetch(\"http",
        ] {
            assert!(!page.contains(way), "{way}");
        }
        let links = page
            .match_indices("<link")
            .map(|(at, _)| &page[at..at + 30]);
        assert!(links.into_iter().all(|l| l.contains("href=\"data:,\"")));
        let names: Vec<&str> = page
            .match_indices("https://")
            .chain(page.match_indices("http://"))
            .map(|(at, _)| {
                page[at..]
                    .split(['"', '\'', ' ', ')', '\n'])
                    .next()
                    .unwrap()
            })
            .collect();
        // What is left are names in comments and name spaces.
        for name in names {
            let known = ["https://github.com/leeoniya/uPlot", "http://www.w3.org/"];
            assert!(known.iter().any(|k| name.starts_with(k)), "{name}");
        }
    }
}

#[test]
fn what_users_write_never_becomes_part_of_the_page() {
    let folder = Folder::new("evil");
    run(&stacked("plane-strain", EVIL, AWKWARD), &folder.0);
    let page = written(&folder.0);
    nests(&page);
    assert!(!page.contains("<b id="));
    assert!(
        page.contains("<title>&lt;/script&gt;&lt;b id=&quot;x&quot;&gt;&amp;&#39;`&lt;!--</title>")
    );
    let meta = page.split_once("id=\"meta\">").unwrap().1;
    let meta = meta.split_once("</script>").unwrap().0;
    let meta: serde_json::Value = serde_json::from_str(meta).unwrap();
    assert_eq!(meta["title"], EVIL);
    assert_eq!(meta["model"]["bodies"].as_array().unwrap().len(), 2);
    assert!(
        meta["model"]["bodies"]
            .as_array()
            .unwrap()
            .iter()
            .any(|b| b == AWKWARD)
    );
    let svg = folder.file("evil.svg");
    plot::picture(&folder.0, Some(&svg), &Picture::default()).unwrap();
    let text = std::fs::read_to_string(&svg).unwrap();
    assert!(!text.contains("<b ") && !text.contains("<script"), "{text}");
}

#[test]
fn times_that_do_not_fit_are_left_out_and_the_page_says_so() {
    let folder = Folder::new("limit");
    run(&stacked("solid", "T", "b"), &folder.0);
    let results = Results::open(&folder.0).unwrap();
    assert!(results.frames.len() >= 3);
    let limits = Limits { fields: 1, rows: 2 };
    let (text, notes) = page(&results, limits).unwrap();
    assert_eq!(notes.len(), 2, "{notes:?}");
    assert!(
        notes[0].contains("1 of the") && notes[1].contains("2 of the 3 rows"),
        "{notes:?}"
    );
    assert!(text.contains("plots have 2 of the 3 rows"));
    assert!(text.len() < page(&results, Limits::default()).unwrap().0.len());
}

#[test]
fn missing_results_are_noted_and_damaged_ones_refused() {
    let folder = Folder::new("damaged");
    let open = |folder: &Path| Results::open(folder).map_err(|e| e.to_string());
    let nothing = open(&folder.0).unwrap_err();
    assert!(nothing.contains("no folder of results"), "{nothing}");
    assert!(
        open(&folder.file("no"))
            .unwrap_err()
            .contains("no such folder")
    );
    std::fs::write(folder.file("file"), "").unwrap();
    assert!(
        open(&folder.file("file"))
            .unwrap_err()
            .contains("this is a file")
    );
    run(&stacked("plane-strain", "T", "b"), &folder.0);
    let whole = |name: &str| std::fs::read(folder.file(name)).unwrap();
    for (name, message) in [
        ("summary.json", "the run has not come to its end"),
        ("history.csv", "no increment was accepted"),
        ("fields.pvd", "no fields were written"),
        ("problem.toml", "older version"),
    ] {
        let bytes = whole(name);
        std::fs::remove_file(folder.file(name)).unwrap();
        let made = report(&folder.0, None, Limits::default()).unwrap();
        assert_eq!(made.notes.len(), 1, "{name}");
        assert!(
            made.notes[0].contains(name) && made.notes[0].contains(message),
            "{:?}",
            made.notes
        );
        let page = std::fs::read_to_string(&made.file).unwrap();
        nests(&page);
        assert!(page.contains(message));
        std::fs::write(folder.file(name), bytes).unwrap();
    }
    for (name, damage, message) in [
        ("summary.json", "{\"title\": ", "the summary is damaged"),
        ("summary.json", "[]", "the summary is damaged"),
        ("problem.toml", "a = = 1", "the problem is damaged"),
        ("history.csv", "a,b\n1\n", "line 2 has 1 entries"),
        (
            "fields.pvd",
            "<VTKFile><Collection><DataSet timestep=\"0\" file=\"gone.vtu\"/></Collection></VTKFile>",
            "gone.vtu",
        ),
        ("fields.pvd", "nothing", "no ParaView collection"),
        ("fields_00001.vtu", "<VTKFile", "truncated"),
    ] {
        let bytes = whole(name);
        std::fs::write(folder.file(name), damage).unwrap();
        let error = report(&folder.0, None, Limits::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains(message), "{name}: {error}");
        std::fs::write(folder.file(name), bytes).unwrap();
    }
    // A summary of another shape, from another version, is still a page.
    std::fs::write(
        folder.file("summary.json"),
        "{\"quality\": 3, \"findings\": [{\"message\": \"<i>\"}, 7], \"notes\": {}}",
    )
    .unwrap();
    nests(&written(&folder.0));
}

/// The size of a PNG file, as its header says.
fn png_size(file: &Path) -> [u32; 2] {
    let bytes = std::fs::read(file).unwrap();
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"));
    [16, 20].map(|at| u32::from_be_bytes(*bytes[at..].first_chunk().unwrap()))
}

#[test]
fn pictures_are_made_of_every_field_and_time() {
    for space in ["solid", "plane-strain"] {
        let folder = Folder::new(&format!("pictures-{space}"));
        run(&stacked(space, "Two blocks", "b"), &folder.0);
        let picture = |file: Option<&Path>, p: Picture| {
            plot::picture(&folder.0, file, &p).map_err(|e| e.to_string())
        };
        let small = Picture {
            size: [320, 240],
            ..Picture::default()
        };
        let (files, notes) = picture(None, small.clone()).unwrap();
        assert_eq!(files, [folder.file("plot.png")]);
        // The contact pressure is shown first, and is hidden between cubes.
        assert_eq!(notes.len(), usize::from(space == "solid"));
        assert_eq!(png_size(&files[0]), [320, 240]);
        for field in ["CPRESS", "cstatus", "U", "S33"] {
            let field = Some(field.to_string());
            let (_, notes) = picture(
                None,
                Picture {
                    field: field.clone(),
                    ..small.clone()
                },
            )
            .unwrap();
            // Between the cubes nothing of the contact could be seen.
            let hidden =
                space == "solid" && field.is_some_and(|f| f.to_lowercase().starts_with('c'));
            assert_eq!(notes.len(), usize::from(hidden), "{notes:?}");
        }
        let (files, _) = picture(
            Some(&folder.file("p.svg")),
            Picture {
                when: When::All,
                ..small.clone()
            },
        )
        .unwrap();
        assert!(files.len() >= 3);
        for file in &files {
            let text = std::fs::read_to_string(file).unwrap();
            assert!(
                text.starts_with("<svg")
                    && text.ends_with("</svg>\n")
                    && text.contains("Two blocks")
            );
        }
        assert_eq!(files[0], folder.file("p_00001.svg"));
        // The same again gives the same bytes; another view or factor does not.
        let bytes = |p: Picture| {
            let (files, _) = picture(None, p).unwrap();
            std::fs::read(&files[0]).unwrap()
        };
        assert_eq!(bytes(small.clone()), bytes(small.clone()));
        let first = Picture {
            when: When::Number(1),
            ..small.clone()
        };
        assert_ne!(bytes(small.clone()), bytes(first));
        assert_ne!(
            bytes(small.clone()),
            bytes(Picture {
                scale: Some(10.0),
                ..small.clone()
            })
        );
        // Where contact is looked at nothing is moved to where it is not.
        let field = |field: &str, scale| {
            bytes(Picture {
                field: Some(field.into()),
                scale,
                ..small.clone()
            })
        };
        assert_eq!(field("CPRESS", None), field("CPRESS", Some(1.0)));
        assert_ne!(field("U", None), field("U", Some(1.0)));
        for change in [
            Picture {
                zoom: Zoom::Times(3.0),
                ..small.clone()
            },
            Picture {
                at: Some([0.0, 1.0, 0.0]),
                ..small.clone()
            },
            Picture {
                mirrors: vec!["x=-0.5".parse().unwrap()],
                ..small.clone()
            },
            Picture {
                units: "mm,MPa".parse().ok(),
                ..small.clone()
            },
            Picture {
                arrows: Some(space == "solid"),
                ..small.clone()
            },
        ] {
            assert!(bytes(small.clone()) != bytes(change.clone()), "{change:?}");
        }
        let cut = Picture {
            cut: "x=-1".parse().ok(),
            ..small.clone()
        };
        assert!(
            picture(None, cut)
                .unwrap_err()
                .contains("the cut leaves no cell")
        );
        let turned = bytes(Picture {
            view: Some(View::Along(0, 1.0)),
            ..small.clone()
        });
        assert_eq!(bytes(small.clone()) == turned, space != "solid");
        for (wrong, message) in [
            (
                Picture {
                    field: Some("NO".into()),
                    ..small.clone()
                },
                "there is no field `NO`; there are CPRESS",
            ),
            (
                Picture {
                    when: When::Number(99),
                    ..small.clone()
                },
                "there is no time 99",
            ),
            (
                Picture {
                    bodies: vec!["c".into()],
                    ..small.clone()
                },
                "there is no body `c`; there are a, b",
            ),
            (
                Picture {
                    size: [1, 9],
                    ..small.clone()
                },
                "width and height are between",
            ),
        ] {
            let error = picture(None, wrong).unwrap_err();
            assert!(error.contains(message), "{error}");
        }
        let error = picture(Some(Path::new("x.jpg")), small).unwrap_err();
        assert!(error.contains(".png or .svg"), "{error}");
    }
}

fn facts(folder: &Folder, wanted: &Picture) -> Facts {
    let mut all = plot::facts(&folder.0, wanted).unwrap();
    assert_eq!(all.len(), 1);
    all.remove(0)
}

/// The description of what a page shows.
fn meta(page: &str) -> serde_json::Value {
    let start = page.find("id=\"meta\">").expect("data") + "id=\"meta\">".len();
    let end = start + page[start..].find("</script>").expect("an end");
    serde_json::from_str(&page[start..end]).unwrap()
}

#[test]
fn contact_between_bodies_in_space_is_seen() {
    let folder = Folder::new("apart");
    run(&stacked("solid", "Two blocks", "b"), &folder.0);
    let of = |wanted: Picture| facts(&folder, &wanted);
    let seen = of(Picture::default());
    assert_eq!(seen.field.as_deref(), Some("CPRESS"));
    assert_eq!(seen.bodies, ["a", "b"]);
    assert!(seen.in_view >= Some(0.95), "{seen:?}");
    // Along the normal, the upper body upwards.
    assert_eq!(seen.offsets[0], [0.0; 3]);
    let [x, y, z] = seen.offsets[1];
    assert!(z > 0.1 && x.hypot(y) < 1e-3 * z, "{seen:?}");
    let there = of(Picture {
        apart: Apart::By(0.0),
        ..Picture::default()
    });
    assert_eq!(
        (there.offsets, there.in_view),
        (vec![[0.0; 3]; 2], Some(0.0))
    );
    let from_above = of(Picture {
        view: Some(View::Along(2, 1.0)),
        ..Picture::default()
    });
    // Nothing comes apart on paper from there: the body whose face looks up is shown.
    assert_eq!(
        (from_above.bodies, from_above.in_view),
        (vec!["a".into()], Some(1.0))
    );
    for name in ["a", "b"] {
        let one = of(Picture {
            bodies: vec![name.into()],
            ..Picture::default()
        });
        assert_eq!(
            (one.bodies, one.in_view),
            (vec![name.to_string()], Some(1.0))
        );
    }
    let stress = of(Picture {
        field: Some("MISES".into()),
        ..Picture::default()
    });
    assert_eq!((stress.offsets, stress.in_view), (vec![[0.0; 3]; 2], None));
    // The report opens with the bodies where the picture has them.
    let (page, _) = page(&Results::open(&folder.0).unwrap(), Limits::default()).unwrap();
    let opened = &meta(&page)["model"]["contact"];
    let far: Vec<[f64; 3]> = serde_json::from_value(opened["offsets"].clone()).unwrap();
    let pairs = far.iter().flatten().zip(seen.offsets.iter().flatten());
    assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-12), "{far:?}");
    assert_eq!(opened["bodies"], serde_json::json!([true, true]));
}

#[test]
fn colours_are_those_that_are_asked_for() {
    let folder = Folder::new("colours");
    run(&stacked("plane-strain", "Two blocks", "b"), &folder.0);
    let of = |colours: Colours| {
        let wanted = Picture {
            colours,
            ..Picture::default()
        };
        facts(&folder, &wanted)
    };
    let auto = of(Colours::default());
    let most = auto.extremes.unwrap()[1];
    assert!(
        auto.range == [0.0, most] && auto.peak == Some(most),
        "{auto:?}"
    );
    let given = of(Colours {
        range: Some([-1.0, most / 2.0]),
        ..Colours::default()
    });
    assert_eq!(given.range, [-1.0, most / 2.0]);
    assert_eq!(given.words, auto.words);
    let all = of(Colours {
        threshold: Some(2.0 * most),
        ..Colours::default()
    });
    assert!(auto.strips > 0 && all.strips == 0);
}

#[test]
fn each_field_is_drawn_at_its_time_of_interest() {
    let folder = Folder::new("interest");
    // It is pressed and slid, then let go.
    let text = stacked("plane-strain", "Two blocks", "b")
        .replace("x = 1e-4", "x = 4e-3")
        .replace(
            "friction.coulomb = { mu = 0.3 }",
            "friction.coulomb = { mu = 0.3 }\nwear.archard = { coefficient = 1e-16 }",
        )
        .replace("y = -1e-3", "y = -1e-3\namplitude = \"down\"")
        .replace(
            "[[step]]",
            "[amplitude.down]\ntable = [[0, 0], [0.25, 0], [0.5, 1], [1, 0.2]]\n[[step]]",
        )
        .replace("increments.fixed = 3", "increments.fixed = 4");
    run(&text, &folder.0);
    let of = |field: &str, when: When| {
        let wanted = Picture {
            field: Some(field.into()),
            when,
            ..Picture::default()
        };
        facts(&folder, &wanted)
    };
    let times = ["CPRESS", "CSTATUS", "U2", "CWEAR", "CDISS"].map(|f| of(f, When::Peak).time);
    assert_eq!(times, [0.5, 0.5, 0.5, 1.0, 1.0]);
    let worn = of("CWEAR", When::Peak);
    assert!(
        worn.extremes.unwrap()[1] > 0.0 && worn.strips > 0,
        "{worn:?}"
    );
    let first = of("CWEAR", When::Number(1));
    assert_eq!((first.extremes, first.strips), (Some([0.0; 2]), 0));
    assert_eq!(first.words, ["CWEAR is zero everywhere at this time"]);
}

#[test]
fn invariants_of_the_stress_are_drawn() {
    let folder = Folder::new("invariants");
    run(&stacked("plane-strain", "T", "b"), &folder.0);
    let extremes = |field: &str| {
        let wanted = Picture {
            field: Some(field.into()),
            ..Picture::default()
        };
        let facts = facts(&folder, &wanted);
        (facts.field.unwrap(), facts.extremes.unwrap())
    };
    let [(name, s1), (_, s2), (_, s3)] = ["S1", "S2", "S3"].map(extremes);
    assert_eq!(name, "S1");
    for k in 0..2 {
        assert!(s1[k] >= s2[k] && s2[k] >= s3[k], "{s1:?} {s2:?} {s3:?}");
    }
    let (_, mises) = extremes("MISES");
    // Colours are for what is in the picture: away from the largest stress they end below it.
    let far = Picture {
        field: Some("MISES".into()),
        zoom: Zoom::Times(8.0),
        at: Some([0.5, 1.9, 0.0]),
        ..Picture::default()
    };
    assert!(facts(&folder, &far).range[1] < 0.99 * mises[1]);
    let (_, tresca) = extremes("TRESCA");
    // Tresca's stress is between that of von Mises and 2/√3 of it.
    let ratio = tresca[1] / mises[1];
    assert!((1.0 - 1e-9..1.155).contains(&ratio), "{ratio}");
    assert!(s3[0] < 0.0 && extremes("PRESS").1[1] > 0.0);
    assert_eq!(extremes("umag"), extremes("U"));
}

#[test]
fn supports_and_loads_are_those_of_the_problem() {
    for space in ["solid", "plane-strain"] {
        let folder = Folder::new(&format!("loads-{space}"));
        let pull = match space {
            "solid" => "[7e4, 0, 0]",
            _ => "[7e4, 0]",
        };
        let load =
            format!("[load.pull]\nset = \"b.right\"\ntraction = {{ value = {pull} }}\n[[step]]");
        run(
            &stacked(space, "T", "b").replace("[[step]]", &load),
            &folder.0,
        );
        let of = |when: When, loads: bool| {
            let wanted = Picture {
                when,
                loads,
                ..Picture::default()
            };
            facts(&folder, &wanted).acts
        };
        assert_eq!(of(When::Last, false), None);
        let last = of(When::Last, true).unwrap();
        // Points of a face times components.
        let held = if space == "solid" { [12, 12] } else { [6, 6] };
        let depth = if space == "solid" { [4, 0] } else { [0, 0] };
        assert_eq!(
            [last.held, last.prescribed],
            [held[0] + depth[0], held[1] - depth[0]],
            "{space}"
        );
        let [x, y, z] = last.force;
        assert!(
            (x - 7e4).abs() < 1e-6 && y.abs() + z.abs() < 1e-6,
            "{last:?}"
        );
        // It grows over the step.
        let first = of(When::Number(1), true).unwrap();
        assert!(first.force[0] < 0.5 * x, "{first:?}");
        let svg = folder.file("l.svg");
        let wanted = Picture {
            loads: true,
            ..Picture::default()
        };
        let (_, notes) = plot::picture(&folder.0, Some(&svg), &wanted).unwrap();
        assert_eq!(notes.iter().filter(|n| n.contains("not drawn")).count(), 0);
        let text = std::fs::read_to_string(&svg).unwrap();
        for word in ["held", "prescribed displacement", "load", "undeformed"] {
            assert!(text.contains(word), "{word}");
        }
        // Without the problem the picture is made all the same.
        std::fs::remove_file(folder.file("problem.toml")).unwrap();
        let (_, notes) = plot::picture(&folder.0, Some(&svg), &wanted).unwrap();
        assert!(
            notes
                .iter()
                .any(|n| n.contains("supports and loads are not drawn")),
            "{notes:?}"
        );
    }
}

/// Statuses and the largest pressure of the last time: in the history, the summary, the surface, the table and the picture.
#[test]
fn run_picture_report_and_files_count_the_same_points() {
    for (name, change) in [
        ("mortar", ""),
        ("quadratic", ""),
        ("nodes", "discretisation.node-to-facet = {}\n"),
        ("penalty", "enforcement.penalty = { stiffness = 1e13 }\n"),
    ] {
        let folder = Folder::new(&format!("count-{name}"));
        // Wider than what it is pressed on, from the middle outwards, so that a part is open, and it slips near the edge.
        let text = stacked("plane-strain", "T", "b")
            .replace("cells = [2, 1]", "cells = [7, 2]")
            .replace("[support.base]", &format!("{change}[support.base]"))
            .replace("to = [1, 2]", "to = [2, 2]")
            .replace(
                "secondary = \"b.bottom\"",
                "roles = \"as-named\"\nsecondary = \"b.bottom\"",
            )
            .replace("x = 1e-4", "x = 2e-3");
        let text = match name {
            "quadratic" => text.replace("cells = [7, 2]", "cells = [7, 2], element = \"quad8\""),
            _ => text,
        };
        run(&text, &folder.0);
        let results = Results::open(&folder.0).unwrap();
        let last = |column: &str| *results.history.column(column).unwrap().last().unwrap();
        let history = ["OPEN", "STICK", "SLIP"].map(|c| last(c) as usize);
        assert!(
            history.iter().filter(|n| **n > 0).count() >= 2,
            "{name}: {history:?}"
        );
        let points = &results.summary["interfaces"][0]["points"];
        let summary = ["open", "stick", "slip"].map(|n| points[n].as_u64().unwrap() as usize);
        assert_eq!(summary, history, "{name}");
        let table = stickslip::io::csv::read(&folder.file("interfaces/joint.csv")).unwrap();
        let statuses = table.column("CSTATUS").unwrap();
        let rows = [0.0, 1.0, 2.0].map(|s| statuses.iter().filter(|v| **v == s).count());
        assert_eq!(rows, history, "{name}");
        let picture = |field: &str| {
            let wanted = Picture {
                field: Some(field.into()),
                when: When::Last,
                ..Picture::default()
            };
            facts(&folder, &wanted)
        };
        assert_eq!(picture("CSTATUS").statuses, Some(history), "{name}");
        let (text, _) = page(&results, Limits::default()).unwrap();
        let said = format!("{history:?}").replace(' ', "");
        assert!(text.contains(&format!("{said}]")), "{name}: {said}");
        let pressure = picture("CPRESS");
        assert_eq!(pressure.peak, Some(last("joint.CPRESSMAX")), "{name}");
        let largest = table
            .column("CPRESS")
            .unwrap()
            .iter()
            .fold(0.0, |m: f64, p| m.max(*p));
        assert_eq!(Some(largest), pressure.peak, "{name}");
        assert_eq!(pressure.extremes.unwrap()[1], largest, "{name}");
    }
}

#[test]
fn what_an_interface_carries_is_drawn_along_it_and_written_as_a_table() {
    for space in ["solid", "plane-strain"] {
        let folder = Folder::new(&format!("along-{space}"));
        run(&stacked(space, "Two blocks", "b"), &folder.0);
        let along = |file: &str, interface: &str, zoom| {
            let wanted = Along {
                field: None,
                interface: interface.into(),
                when: When::Peak,
                zoom,
                size: [400, 300],
                units: "mm,MPa".parse().ok(),
            };
            plot::along(&folder.0, Some(&folder.file(file)), &wanted).map_err(|e| e.to_string())
        };
        let files = along("j.svg", "joint", Zoom::Auto).unwrap();
        let text = std::fs::read_to_string(&files[0]).unwrap();
        for word in ["joint, time", "[MPa]", "[mm]", "stick", "slip"] {
            assert!(text.contains(word), "{word}");
        }
        along("j.csv", "joint", Zoom::Auto).unwrap();
        let table = stickslip::io::csv::read(&folder.file("j.csv")).unwrap();
        // The last time presses most, and the table of the run is of that.
        let whole = stickslip::io::csv::read(&folder.file("interfaces/joint.csv")).unwrap();
        let sum = |t: &stickslip::io::csv::Table| t.column("CPRESS").unwrap().iter().sum::<f64>();
        assert!((sum(&table) - sum(&whole)).abs() < 1e-9 * sum(&whole));
        match space {
            "solid" => assert!(table.column("S1").is_some() && table.column("S2").is_some()),
            _ => {
                let s = table.column("S").unwrap();
                assert!(s[0] == 0.0 && (s[s.len() - 1] - 1.0).abs() < 1e-12, "{s:?}");
            }
        }
        // One field, all times in a file.
        let over = |file: &str, field: &str| {
            let wanted = Along {
                field: Some(field.into()),
                interface: "joint".into(),
                when: When::All,
                zoom: Zoom::Whole,
                size: [400, 300],
                units: None,
            };
            plot::along(&folder.0, Some(&folder.file(file)), &wanted).map_err(|e| e.to_string())
        };
        if space == "solid" {
            assert!(
                over("f.csv", "CPRESS")
                    .unwrap_err()
                    .contains("surface in space")
            );
        } else {
            assert_eq!(over("f.csv", "CPRESS").unwrap().len(), 1);
            let lines = stickslip::io::csv::read(&folder.file("f.csv")).unwrap();
            assert!(lines.names.len() > 2 && lines.names[1].starts_with("CPRESS at "));
            let last = lines.columns.last().unwrap();
            assert!((last.iter().sum::<f64>() - sum(&table)).abs() < 1e-9 * sum(&table));
            over("f.svg", "CPRESS").unwrap();
            let text = std::fs::read_to_string(folder.file("f.svg")).unwrap();
            assert!(text.contains(&lines.names[2]), "{text}");
            assert!(over("f.csv", "CPRES").unwrap_err().contains("there are"));
        }
        let error = along("j.png", "joit", Zoom::Auto).unwrap_err();
        assert!(error.contains("did you mean `joint`?"), "{error}");
        // Results of an older version have no surfaces, and pictures of the bodies all the same.
        std::fs::remove_file(folder.file("interfaces.pvd")).unwrap();
        let error = along("j.png", "joint", Zoom::Auto).unwrap_err();
        assert!(error.contains("Run the problem again"), "{error}");
        plot::picture(&folder.0, None, &Picture::default()).unwrap();
        let contact = Picture {
            zoom: Zoom::Contact,
            ..Picture::default()
        };
        let error = plot::picture(&folder.0, None, &contact)
            .unwrap_err()
            .to_string();
        assert!(error.contains("no patch of contact"), "{error}");
    }
}

#[test]
fn columns_of_the_history_are_plotted() {
    let folder = Folder::new("columns");
    run(&stacked("plane-strain", "Two blocks", "b"), &folder.0);
    let columns = |file: &str, names: &[&str], against: &str| {
        let (left, right) = names.split_at(1);
        let columns = plot::Columns {
            left: left.iter().map(|n| n.to_string()).collect(),
            right: right.iter().map(|n| n.to_string()).collect(),
            against: against.into(),
            label: String::new(),
        };
        let file = folder.file(file);
        plot::columns(&folder.0, Some(&file), &columns, [400, 300]).map_err(|e| e.to_string())
    };
    let file = columns("h.svg", &["joint.CFN2", "ALLSE"], "TIME").unwrap();
    let text = std::fs::read_to_string(file).unwrap();
    for word in [
        "joint.CFN2",
        "ALLSE (right)",
        "TIME",
        "Two blocks",
        "<polyline",
    ] {
        assert!(text.contains(word), "{word}");
    }
    let file = columns("h.png", &["STICK"], "top.RF2").unwrap();
    assert_eq!(png_size(&file), [400, 300]);
    let error = columns("h.png", &["NO"], "TIME").unwrap_err();
    assert!(error.contains("no column `NO`"), "{error}");
    assert!(columns("h.png", &["STICK"], "NO").is_err());
    std::fs::remove_file(folder.file("history.csv")).unwrap();
    assert!(
        columns("h.png", &["STICK"], "TIME")
            .unwrap_err()
            .contains("no rows")
    );
}

/// A block whose modes are looked for, and that is shaken.
const MODES: &str = r#"
format = 1
model.space = "plane-strain"
body.pad = { generate.rectangle = { to = [1, 0.4], cells = [6, 3] }, material = "m" }
material.m.isotropic = { young = 100.0, poisson = 0.3, density = 1.0 }
obstacle.belt.plane = { point = [0, 0], normal = [0, 1] }
interface.rub = { secondary = "pad.bottom", primary = "belt", normal.linear = { c = 500.0 }, friction.coulomb = { mu = 0.6 }, primary-velocity = [1, 0] }
support.top = { set = "pad.top", x = 0, y = -1e-2 }
load.shake = { set = "pad.right", pressure = { value = 0.1 } }
probe.p = { point = [0, 0] }
[[step]]
loads = []
steady = {}
[[step]]
modes = { count = 3 }
[[step]]
complex-modes = { count = 2, export = true, map = { points = 3 } }
[[step]]
harmonic = { loads = ["shake"], frequencies = [1.5, 2.5], shapes = true }
"#;

#[test]
fn shapes_of_modes_are_in_the_view() {
    let folder = Folder::new("modes");
    run(MODES, &folder.0);
    let response = std::fs::read_to_string(folder.file("modes-4-response.csv")).unwrap();
    assert_eq!(
        response.lines().next().unwrap(),
        "frequency,residual,p.U1.AMPLITUDE,p.U1.PHASE,p.U2.AMPLITUDE,p.U2.PHASE"
    );
    let (page, _) = page(&Results::open(&folder.0).unwrap(), Limits::default()).unwrap();
    let meta = meta(&page);
    let modes = meta["model"]["modes"].as_array().expect("modes");
    let labels: Vec<&str> = modes.iter().filter_map(|m| m["label"].as_str()).collect();
    assert_eq!(labels.len(), 7, "{labels:?}");
    assert!(labels[0].starts_with("step 2, mode 1: "), "{labels:?}");
    assert!(labels[3].starts_with("step 3, mode 1: "), "{labels:?}");
    assert_eq!(labels[6], "step 4, answer at 2.5");
    for (k, mode) in modes.iter().enumerate() {
        assert_eq!(mode["parts"], if k < 3 { 1 } else { 2 });
        // The largest amplitude of a point is one.
        let ends = [0, 1].map(|i| mode["range"][i].as_f64().unwrap());
        let largest = ends[0].abs().max(ends[1].abs());
        assert!((0.5..=1.0 + 1e-6).contains(&largest), "{largest}");
        let key = mode["key"].as_str().unwrap();
        assert!(page.contains(&format!("id=\"blob-{key}\">")));
    }
}

#[test]
fn charts_of_modes_are_drawn_of_maps_and_sweeps() {
    let folder = Folder::new("charts");
    run(MODES, &folder.0);
    let pictures = plot::coupling(&folder.file("modes-3-map.csv"), None, "mu", [600, 400]).unwrap();
    let names = ["modes-3-map.frequency.png", "modes-3-map.growth.png"];
    assert_eq!(pictures, names.map(|name| folder.file(name)));
    let table = folder.file("pad.sweep.csv");
    let text = "run,a.mu,load.p,outcome,MODES.GROWTH,MODES.FREQUENCY,MODES.1.FREQUENCY,MODES.1.GROWTH\n1,0.1,1,done,-1,5,5,-1\n2,0.2,1,done,2,5,5,2\n3,0.1,2,done,3,0,0,3\n4,0.2,2,failed,,,,\n";
    std::fs::write(&table, text).unwrap();
    std::fs::write(
        folder.file("pad.sweep.critical.csv"),
        "load.p,a.mu,MODES.GROWTH\n1,0.13,0\n",
    )
    .unwrap();
    let svg = |name: &str| std::fs::read_to_string(folder.file(name)).unwrap();
    let chart = folder.file("chart.svg");
    plot::stability(&table, Some(&chart), ["mu", "p"], [600, 400]).unwrap();
    // A cell each and its key in the legend; the boundary is a dot with an edge.
    let all = svg("chart.svg");
    for name in [
        "stable (1)",
        "flutter, the redder the faster it grows (1)",
        "divergence (1)",
        "not known (1)",
    ] {
        assert!(all.contains(name), "{name}: {all}");
    }
    for colour in ["#d6e2ee", "#d55e00", "#5c286e"] {
        assert_eq!(all.matches(colour).count(), 2, "{colour}");
    }
    assert_eq!(all.matches("fill=\"#1b2430\"/>").count(), 1, "{all}");
    plot::coupling(&table, Some(&chart), "mu", [600, 400]).unwrap();
    assert!(svg("chart.frequency.svg").contains("<svg"));
    let error = plot::coupling(&folder.file("history.csv"), None, "TIME", [600, 400]).unwrap_err();
    assert!(error.to_string().contains("no columns of modes"), "{error}");
    // Spectra over time: what is weak is the ground, and the report has them, too.
    let vibration = "<section id=\"vibration\"";
    assert!(!written(&folder.0).contains(vibration));
    let spectra = folder.file("modes-3-waterfall.csv");
    let text = "time,frequency,amplitude\n0.1,1,1e-2\n0.1,2,1\n0.2,1,1e-9\n0.2,2,0.5\n";
    std::fs::write(&spectra, text).unwrap();
    plot::waterfall(&spectra, Some(&chart), [600, 400]).unwrap();
    let all = svg("chart.svg");
    for (colour, count) in [("#08306b", 2), ("#f0f4f8", 2)] {
        assert_eq!(all.matches(colour).count(), count, "{colour}: {all}");
    }
    let page = written(&folder.0);
    nests(&page);
    assert!(page.contains(vibration));
}

/// A beam, clamped at one end, with its modes.
const BEAM: &str = r#"
format = 1
title = "A beam"
model.space = "solid"
body.beam = { generate.box = { to = [0.1, 0.01, 0.01], cells = [6, 1, 1], element = "hex20" }, material = "m" }
material.m.isotropic = { young = 210e9, poisson = 0.3, density = 7.8e3 }
support.wall = { set = "beam.left", x = 0, y = 0, z = 0 }
step = [{ name = "ring", modes = { count = 3 } }]
"#;

#[test]
fn modes_are_drawn_and_move() {
    let folder = Folder::new("modes-in-motion");
    run(BEAM, &folder.0);
    let mode = |name: &str| Picture {
        mode: Some(name.into()),
        size: [400, 300],
        ..Picture::default()
    };
    let svg = folder.file("mode.svg");
    plot::picture(&folder.0, Some(&svg), &mode("ring:2")).unwrap();
    let text = std::fs::read_to_string(&svg).unwrap();
    for word in ["step 1, mode 2: frequency", "phase 0°"] {
        assert!(text.contains(word), "{word}");
    }
    // All phases: from one end to the other and back; the shape is real, so that it vanishes in between.
    let all = Picture {
        when: When::All,
        ..mode("2")
    };
    let facts = plot::facts(&folder.0, &all).unwrap();
    assert_eq!(facts.len(), 24);
    // A mode of amplitude one is drawn at a twentieth of the model, however small that is.
    let drawn = facts[0].factor * facts[0].extremes.unwrap()[1];
    let size = f64::sqrt(0.1f64.powi(2) + 2.0 * 0.01f64.powi(2));
    assert!((drawn / size - 0.05).abs() < 1e-9, "{drawn} {size}");
    let largest: Vec<f64> = facts.iter().map(|f| f.extremes.unwrap()[1]).collect();
    for (k, size) in largest.iter().enumerate() {
        let wanted = (std::f64::consts::TAU * k as f64 / 24.0).cos().abs();
        assert!((size - wanted).abs() < 1e-9, "{k}: {size} {wanted}");
    }
    for name in ["mode.png", "mode.gif"] {
        let file = folder.file(name);
        plot::animate(&folder.0, &file, &mode("2"), 12.0).unwrap();
        let bytes = std::fs::read(&file).unwrap();
        let animated = match name {
            "mode.png" => bytes.windows(4).any(|w| w == b"acTL"),
            _ => bytes.starts_with(b"GIF89a"),
        };
        assert!(animated, "{name}");
    }
    let wrong = |file: &str, name: &str| {
        let drawn = plot::animate(&folder.0, &folder.file(file), &mode(name), 12.0);
        drawn.unwrap_err().to_string()
    };
    assert!(wrong("mode.mp4", "1").contains("ffmpeg -i"));
    for name in ["4", "ring:0", "2:1", "first"] {
        let message = wrong("mode.gif", name);
        assert!(message.contains("step 1 has modes 1 to 3"), "{message}");
    }
}

#[test]
fn a_run_is_drawn_in_motion_and_a_script_goes_on_from_a_picture() {
    let folder = Folder::new("run-in-motion");
    run(&stacked("plane-strain", "Two blocks", "b"), &folder.0);
    let wanted = Picture {
        size: [400, 300],
        field: Some("TRESCA".into()),
        bodies: vec!["b".into()],
        mirrors: vec!["x=0".parse().unwrap()],
        ..Picture::default()
    };
    plot::animate(&folder.0, &folder.file("run.gif"), &wanted, 5.0).unwrap();
    let files = plot::scripts(&folder.0, Some(&folder.file("run.png")), &wanted).unwrap();
    let text = std::fs::read_to_string(&files[0]).unwrap();
    for part in [
        "Path(__file__).parent / \"fields_00",
        "1: (\"b\", [0.0, 0.0, 0.0]),",
        "MIRRORS = [(0, 0.0, 1)]",
        "values = principal[:, 0] - principal[:, 2]",
    ] {
        assert!(text.contains(part), "`{part}` is missing in\n{text}");
    }
    assert!(!text.contains("0: (\"a\""), "{text}");
    // Without shapes of modes there is nothing to choose.
    let mode = Picture {
        mode: Some("1".into()),
        ..Picture::default()
    };
    let message = plot::picture(&folder.0, None, &mode)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("no shapes of modes were written"),
        "{message}"
    );
}

#[test]
fn a_field_is_drawn_along_a_line_through_the_bodies() {
    let folder = Folder::new("path");
    run(&stacked("plane-strain", "Two blocks", "b"), &folder.0);
    let line = |ends: [[f64; 3]; 2], when| plot::Line {
        ends,
        field: Some("U2".into()),
        when,
    };
    let draw = |name: &str, line: &plot::Line| {
        let file = folder.file(name);
        plot::path(&folder.0, Some(&file), line, [400, 300]).map_err(|e| e.to_string())
    };
    // From below the lower block, which begins at 0, to the top of the upper one: the displacement goes from zero to what is prescribed there.
    let through = line([[0.3, -1.0, 0.0], [0.3, 3.0, 0.0]], When::Last);
    draw("path.csv", &through).unwrap();
    let table = stickslip::io::csv::read(&folder.file("path.csv")).unwrap();
    let (s, u) = (&table.columns[0], &table.columns[1]);
    for (s, u) in s.iter().zip(u) {
        assert_eq!(u.is_nan(), (s - 2.0).abs() > 1.0 + 1e-6, "{s}");
    }
    let at = |wanted: f64| u[s.iter().position(|s| *s >= wanted - 1e-9).unwrap()];
    assert!(at(1.0).abs() < 1e-12 && (at(3.0) + 1e-3).abs() < 1e-9);
    // In one cell the field is linear.
    assert!((at(1.25) - 0.5 * at(1.5)).abs() < 1e-9);
    draw("path.svg", &line(through.ends, When::All)).unwrap();
    let text = std::fs::read_to_string(folder.file("path.svg")).unwrap();
    assert_eq!(text.matches("U2 at ").count(), 3, "{text}");
    assert!(text.contains("length along the line"));
    let beside = line([[5.0; 3], [6.0; 3]], When::Last);
    let message = draw("path.png", &beside).unwrap_err();
    assert!(message.contains("meets no body"), "{message}");
}
