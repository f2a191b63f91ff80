use std::fs;
use std::path::PathBuf;

use super::{Report, Verdict, compare};
use crate::error::Error;

/// A folder with results, removed at the end.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

impl Folder {
    fn new(name: &str) -> Folder {
        let path =
            std::env::temp_dir().join(format!("stickslip-compare-{}-{name}", std::process::id()));
        fs::create_dir_all(path.join("interfaces")).unwrap();
        let folder = Folder(path);
        folder.file(
            "history.csv",
            "TIME,A.U1,A.U2,bad\n0,0,0,0\n0.5,2e-5,-7,NaN\n1,2.84594e-5,1,1\n",
        );
        folder.file(
            "summary.json",
            r#"{"steps": [{"iterations": 4}, {"iterations": 7}], "probes": {"A.U1": 2.5, "A": {"U2": 3}},
                "quality": {"max-penetration": {"relative-to-size": 1e-4}}, "name": "x", "lost": null}"#,
        );
        folder.file(
            "interfaces/base.csv",
            "node,x,z,CPRESS\n1,1,0,10\n2,0,0,30\n3,2,0,0\n4,0,1,5\n5,1,1,NaN\n",
        );
        folder.file("reference.csv", "s,p\n0,30\n0.5,20.5\n1.5,5\n");
        folder
    }

    fn file(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    fn run(&self, checks: &str) -> Result<Report, Error> {
        self.file(
            "expected.toml",
            &format!("format = 1\nsource = \"all\"\n{checks}"),
        );
        compare(&self.0, &self.0.join("expected.toml"))
    }

    /// The verdict on one check given by its keys.
    fn one(&self, keys: &str) -> (bool, Verdict) {
        let report = self
            .run(&format!("[[check]]\nwhat = \"it\"\n{keys}"))
            .unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(report.passes(), report.failures() == 0);
        (report.passes(), report.outcomes[0].verdict.clone())
    }

    fn assert(&self, keys: &str, passes: bool) {
        let (found, verdict) = self.one(keys);
        assert_eq!(found, passes, "{keys}: {verdict:?}");
        assert!(
            matches!(verdict, Verdict::Compared(_)),
            "{keys}: {verdict:?}"
        );
    }

    fn assert_missing(&self, keys: &str, why: &str) {
        match self.one(keys) {
            (false, Verdict::Missing(text)) => assert!(text.contains(why), "{keys}: {text}"),
            other => panic!("{keys}: {other:?}"),
        }
    }
}

#[test]
fn values_of_histories() {
    let folder = Folder::new("history");
    for (keys, passes) in [
        ("history = 'A.U1'\nvalue = 2.84594e-5\nrelative = 0.0", true),
        ("history = 'A.U1'\nvalue = 2.847e-5\nrelative = 5e-4", true),
        ("history = 'A.U1'\nvalue = 2.848e-5\nrelative = 5e-4", false),
        (
            "history = 'A.U1'\nvalue = -2.84594e-5\nrelative = 5e-4",
            false,
        ),
        (
            "history = 'A.U1'\nvalue = 2.848e-5\nrelative = 5e-4\nabsolute = 3e-8",
            true,
        ),
        (
            "history = 'A.U1'\nvalue = 2.848e-5\nrelative = 1e-2\nabsolute = 1e-20",
            true,
        ),
        (
            "history = 'A.U1'\nat = 0.5\nvalue = 2e-5\nrelative = 1e-12",
            true,
        ),
        (
            "history = 'A.U1'\nat = 1\nvalue = 2e-5\nrelative = 1e-12",
            false,
        ),
        (
            "history = 'A.U1'\nat = 0.0\nvalue = 0.0\nabsolute = 1e-12",
            true,
        ),
        (
            "history = 'A.U2'\nreduce = 'min'\nvalue = -7.0\nabsolute = 0.0",
            true,
        ),
        (
            "history = 'A.U2'\nreduce = 'max'\nvalue = 1.0\nabsolute = 0.0",
            true,
        ),
        (
            "history = 'A.U2'\nreduce = 'max-abs'\nvalue = 7.0\nabsolute = 0.0",
            true,
        ),
        (
            "history = 'A.U2'\nreduce = 'max-abs'\nvalue = 1.0\nabsolute = 0.0",
            false,
        ),
        (
            "history = 'A.U2'\nreduce = 'last'\nvalue = 1.0\nabsolute = 0.0",
            true,
        ),
    ] {
        folder.assert(keys, passes);
    }
}

#[test]
fn nan_never_passes() {
    let folder = Folder::new("nan");
    for keys in [
        "history = 'bad'\nat = 0.5\nvalue = 0.0\nabsolute = 1e300",
        "history = 'bad'\nreduce = 'max'\nvalue = 1.0\nabsolute = 1e300",
        "history = 'bad'\nreduce = 'min'\nabove = -1e300",
        "history = 'bad'\nreduce = 'max-abs'\nbelow = 1e300",
        "summary = 'lost'\nbelow = 1e300",
        "table = 'interfaces/base.csv'\ncolumn = 'CPRESS'\nalong = 'x'\nat = 0.5\nwhere = { z = 1.0 }\nabove = -1e300",
    ] {
        folder.assert(keys, false);
    }
    folder.file("reference.csv", "s,p\n0,30\n0.5,NaN\n");
    folder.assert(
        "table = 'interfaces/base.csv'\ncolumn = 'CPRESS'\nalong = 'x'\nwhere = { z = 0.0 }\n\
         curve = { file = 'reference.csv', along = 's', column = 'p' }\nabsolute = 1e300",
        false,
    );
}

#[test]
fn bounds_and_summaries() {
    let folder = Folder::new("summary");
    for (keys, passes) in [
        (
            "summary = 'quality.max-penetration.relative-to-size'\nbelow = 1e-3",
            true,
        ),
        (
            "summary = 'quality.max-penetration.relative-to-size'\nbelow = 1e-5",
            false,
        ),
        (
            "summary = 'quality.max-penetration.relative-to-size'\nabove = 1e-3",
            false,
        ),
        ("summary = 'steps.1.iterations'\nabove = 7\nbelow = 7", true),
        (
            "summary = 'steps.0.iterations'\nabove = 5\nbelow = 7",
            false,
        ),
        ("summary = 'probes.A.U1'\nvalue = 2.5\nabsolute = 0.0", true),
        ("summary = 'probes.A.U2'\nvalue = 3\nabsolute = 0.0", true),
    ] {
        folder.assert(keys, passes);
    }
}

const CURVE: &str = "curve = { file = 'reference.csv', along = 's', column = 'p' }";

#[test]
fn tables_and_curves() {
    let folder = Folder::new("table");
    let base = "table = 'interfaces/base.csv'\ncolumn = 'CPRESS'\nwhere = { z = 0.0 }";
    for (keys, passes) in [
        (
            format!("{base}\nalong = 'x'\nat = 0.5\nvalue = 20.0\nrelative = 1e-12"),
            true,
        ),
        (
            format!("{base}\nalong = 'x'\nat = 2.0\nvalue = 0.0\nabsolute = 1e-12"),
            true,
        ),
        (
            format!("{base}\nalong = 'x'\nat = 0.5\nvalue = 20.1\nrelative = 1e-3"),
            false,
        ),
        (
            format!("{base}\nreduce = 'max'\nvalue = 30.0\nabsolute = 0.0"),
            true,
        ),
        // The largest difference is 0.5, the largest reference 30.
        (
            format!("{base}\nalong = 'x'\n{CURVE}\nrelative = 0.017"),
            true,
        ),
        (
            format!("{base}\nalong = 'x'\n{CURVE}\nrelative = 0.016"),
            false,
        ),
        (
            format!("{base}\nalong = 'x'\n{CURVE}\nabsolute = 0.5"),
            true,
        ),
        (
            format!("{base}\nalong = 'x'\n{CURVE}\nabsolute = 0.49"),
            false,
        ),
    ] {
        folder.assert(&keys, passes);
    }
}

#[test]
fn what_is_missing_fails_and_is_named() {
    let folder = Folder::new("missing");
    let table = "column = 'CPRESS'\nalong = 'x'\nvalue = 1.0\nrelative = 1.0\nat = 0.5";
    for (keys, why) in [
        ("history = 'A.U3'\nbelow = 1".to_string(), "no column `A.U3` in history.csv; near: A.U1, A.U2"),
        ("history = 'A.U1'\nat = 0.7\nbelow = 1".into(), "the nearest is at 0.5"),
        ("summary = 'steps.9.iterations'\nbelow = 1".into(), "no `9` of `steps.9.iterations`"),
        ("summary = 'quality.max-penetratio.x'\nbelow = 1".into(), "near: max-penetration"),
        ("summary = 'name'\nbelow = 1".into(), "not a number"),
        (format!("table = 'interfaces/bose.csv'\n{table}"), "there is no interfaces/bose.csv; near: base.csv"),
        (format!("table = 'interfaces/base.csv'\n{table}"), "several rows have `x` = 0: choose some with `where`"),
        (format!("table = 'interfaces/base.csv'\n{table}\nwhere = {{ z = 3.0 }}"), "has `z` = 3"),
        (format!("table = 'interfaces/base.csv'\n{table}\nwhere = {{ y = 3.0 }}"), "no column `y`"),
        (
            "table = 'interfaces/base.csv'\ncolumn = 'CPRESS'\nalong = 'x'\nat = 2.5\nbelow = 1\nwhere = { z = 0 }".into(),
            "2.5 is outside the abscissae 0 to 2",
        ),
        (
            "table = 'interfaces/base.csv'\ncolumn = 'CPRESS'\nalong = 'x'\nwhere = { z = 0 }\nrelative = 1.0\n\
             curve = { file = 'reverence.csv', along = 's', column = 'p' }"
                .into(),
            "there is no reverence.csv; near: reference.csv",
        ),
    ] {
        folder.assert_missing(&keys, why);
    }
    folder.file("history.csv", "TIME,A.U1\n");
    folder.assert_missing("history = 'A.U1'\nbelow = 1", "no rows");
    fs::remove_file(folder.0.join("history.csv")).unwrap();
    folder.assert_missing("history = 'A.U1'\nbelow = 1", "there is no history.csv");
    fs::remove_file(folder.0.join("summary.json")).unwrap();
    folder.assert_missing("summary = 'name'\nbelow = 1", "there is no summary.json");
}

#[test]
fn bad_expectations_are_refused() {
    let folder = Folder::new("refused");
    for (keys, message) in [
        ("below = 1", "one place"),
        ("history = 'a'\nsummary = 'b'\nbelow = 1", "one place"),
        ("history = 'a'", "one expectation"),
        ("history = 'a'\nvalue = 1.0", "tolerance is missing"),
        (
            "history = 'a'\nvalue = 1.0\nbelow = 2\nrelative = 1.0",
            "one expectation",
        ),
        (
            "history = 'a'\nbelow = 1\nrelative = 1.0",
            "bounds have no tolerance",
        ),
        ("history = 'a'\nvalue = 0.0\nrelative = 1.0", "on zero"),
        (
            "history = 'a'\nat = 1\nreduce = 'max'\nbelow = 1",
            "exclude",
        ),
        ("summary = 'a'\nat = 1\nbelow = 1", "rows"),
        ("table = 'a'\nat = 1\nbelow = 1", "go together"),
        (
            "history = 'a'\nalong = 'x'\nbelow = 1",
            "belong to a `table`",
        ),
        (
            "table = 'a'\ncolumn = 'b'\nat = 1\nbelow = 1",
            "abscissa is missing",
        ),
        ("table = 'a'\ncolumn = 'b'\nbelow = 1", "needs a row"),
        ("history = 'a'\nvalue = nan\nabsolute = 1", "not finite"),
        ("history = 'a'\nvalue = 1\nabsolute = inf", "not finite"),
        ("history = 'a'\nvalue = 1\nabsolute = -1", "negative"),
        (
            "history = 'a'\nvalu = 1\nabsolute = 1",
            "unknown field `valu`",
        ),
    ] {
        let error = folder
            .run(&format!("[[check]]\nwhat = 'it'\n{keys}"))
            .unwrap_err();
        assert!(matches!(error, Error::Problem(_)));
        assert!(error.to_string().contains(message), "{keys}: {error}");
    }
    let error = folder
        .run("[[check]]\nwhat = 'it'\nhistory = 'a'\nvalu = 1")
        .unwrap_err();
    assert!(error.to_string().contains("expected.toml:6:1"), "{error}");
    assert!(
        folder
            .run("check = []")
            .unwrap_err()
            .to_string()
            .contains("no checks")
    );
    folder.file(
        "expected.toml",
        "format = 2\n[[check]]\nwhat = 'a'\nhistory = 'a'\nbelow = 1",
    );
    let file = folder.0.join("expected.toml");
    let error = compare(&folder.0, &file).unwrap_err();
    assert!(error.to_string().contains("format = 1"), "{error}");
    assert!(matches!(
        compare(&folder.0, &folder.0.join("none.toml")),
        Err(Error::Io(_))
    ));
}

#[test]
fn results_must_be_a_folder() {
    let folder = Folder::new("folder");
    folder.file(
        "expected.toml",
        "format = 1\n[[check]]\nwhat = 'a'\nhistory = 'a'\nbelow = 1",
    );
    let error = compare(&folder.0.join("gone"), &folder.0.join("expected.toml")).unwrap_err();
    assert!(
        error.to_string().contains("no folder of results"),
        "{error}"
    );
}

#[test]
fn the_report_is_an_aligned_table() {
    let folder = Folder::new("report");
    let report = folder
        .run(
            "[[check]]\nwhat = 'u_x at A'\nhistory = 'A.U1'\nvalue = 2.85e-5\nrelative = 5e-4\n\
             [[check]]\nwhat = 'iterations'\nsummary = 'steps.1.iterations'\nabove = 1\nbelow = 9\nsource = 'own'\n\
             [[check]]\nwhat = 'lost'\nhistory = 'B'\nbelow = 1\n",
        )
        .unwrap();
    assert_eq!(report.failures(), 2);
    assert_eq!(report.outcomes[0].source.as_deref(), Some("all"));
    assert_eq!(report.outcomes[1].source.as_deref(), Some("own"));
    let text = report.to_string();
    let expected = [
        "      check            value    expected        error   tolerance",
        "FAIL  u_x at A    28.4594e-6     28.5e-6  0.00142 rel  500e-6 rel",
        "ok    iterations           7  >= 1, <= 9            -           -",
        "FAIL  lost                 -           -            -           -",
        "        no column `B` in history.csv; there are: TIME, A.U1, A.U2, bad",
        "1 of 3 checks passed",
    ]
    .join("\n");
    assert_eq!(text, expected, "\n{text}");
}

/// Differences by quantity, as they are found.
fn apart(a: &Folder, b: &Folder) -> super::Differences {
    super::differences(&a.0, &b.0).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn two_folders_differ_where_their_files_do() {
    let (a, b) = (Folder::new("differ-a"), Folder::new("differ-b"));
    let same = apart(&a, &b);
    assert!(same.quantities.iter().all(|d| d.largest == 0.0));
    assert_eq!(same.quantities.len(), 4, "three of the history, one table");
    assert!(same.notes.is_empty() && same.uncompared.is_empty());

    b.file(
        "history.csv",
        "TIME,A.U1,A.U2,bad,more\n0,0,0,0,1\n0.5,3e-5,-7,0,1\n1,2.84594e-5,1,1,1\n",
    );
    b.file(
        "interfaces/base.csv",
        "node,x,z,CPRESS\n1,1,0,10\n2,0,0,27\n3,2,0,0\n4,0,1,5\n5,1,1,NaN\n",
    );
    b.file("interfaces/other.csv", "node,x,CPRESS\n1,1,0\n");
    let found = apart(&a, &b);
    let of = |quantity: &str| {
        let all = found.quantities.iter();
        let one = all.clone().find(|d| d.quantity == quantity);
        one.unwrap_or_else(|| panic!("{quantity} of {:?}", all.collect::<Vec<_>>()))
    };
    // Components have one scale: that of the largest of them.
    let u1 = of("history A.U1");
    assert!(
        (u1.largest - 1e-5).abs() < 1e-18 && u1.scale == 7.0,
        "{u1:?}"
    );
    assert_eq!(u1.place, "time 0.500000");
    // What only one of them has is as far as can be.
    assert_eq!(of("history bad").relative(), f64::INFINITY);
    let pressure = of("interfaces/base.csv CPRESS");
    assert_eq!((pressure.largest, pressure.scale), (3.0, 30.0));
    assert_eq!(pressure.place, "at (0.0000, 0.0000, 0.0000)");
    assert_eq!(
        found.uncompared,
        [
            "history: only the second has more",
            "interfaces: only the second has other.csv"
        ]
    );
    // The largest first.
    assert_eq!(found.quantities[0].quantity, "history bad");
    let text = found.to_string();
    assert!(
        text.contains("interfaces/base.csv CPRESS") && text.contains("CPRESS  0.1 "),
        "{text}"
    );
    assert!(
        text.ends_with("4 quantities compared, 1 equal to the last digit"),
        "{text}"
    );
    // What is zero but for rounding is that beside the same quantity elsewhere.
    for (folder, zero) in [(&a, "1e-14"), (&b, "3e-14")] {
        folder.file(
            "history.csv",
            &format!("TIME,foot.RF1,top.RF1\n1,200,{zero}\n"),
        );
    }
    let found = apart(&a, &b);
    let top = found
        .quantities
        .iter()
        .find(|d| d.quantity == "history top.RF1");
    assert!(top.is_some_and(|d| d.relative() < 1.01e-7), "{top:?}");
}

#[test]
fn histories_with_other_increments_are_compared_in_between() {
    let (a, b) = (Folder::new("between-a"), Folder::new("between-b"));
    b.file(
        "history.csv",
        "TIME,A.U1,A.U2,bad\n0,0,0,0\n1,2.84594e-5,1,1\n2,9,9,9\n",
    );
    let found = apart(&a, &b);
    let u2 = found
        .quantities
        .iter()
        .find(|d| d.quantity == "history A.U2");
    // At 0.5 the second has 0.5, half of the way from 0 to 1; time 2 is none of the first's.
    assert_eq!(u2.map(|d| d.largest), Some(7.5));
    assert_eq!(
        found.notes,
        [
            "history: 3 and 3 rows, 2 at the same times; the second is taken as linear between its rows"
        ]
    );
}

#[test]
fn tables_of_other_points_and_folders_without_a_history_are_not_compared() {
    let (a, b) = (Folder::new("unlike-a"), Folder::new("unlike-b"));
    b.file(
        "interfaces/base.csv",
        "node,x,z,CPRESS\n1,1,0,10\n2,0,0,30\n",
    );
    assert_eq!(
        apart(&a, &b).uncompared,
        ["interfaces/base.csv: the meshes have 5 and 2 points"]
    );
    b.file(
        "interfaces/base.csv",
        "node,x,z,CPRESS\n1,1,0,10\n2,0,0,30\n3,2,0,0\n4,0,1,5\n5,1.1,1,1\n",
    );
    let moved = apart(&a, &b).uncompared;
    assert!(moved[0].contains("lie up to 0.1 apart"), "{moved:?}");
    fs::remove_file(b.0.join("history.csv")).unwrap();
    let error = super::differences(&a.0, &b.0).unwrap_err().to_string();
    assert!(
        error.contains("no history.csv") && error.contains("unlike-b"),
        "{error}"
    );
}
