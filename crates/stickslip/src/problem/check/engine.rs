use super::findings::Findings;
use crate::problem::Problem;
use crate::registry::Family;

/// An engine that factors condensed bodies alone goes with no other way to solve.
pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    let solver = &problem.solver;
    if !solver.engine.as_dyn().condenses() || solver.method.condenses() {
        return;
    }
    let (engine, method) = (solver.engine.kind(), solver.method.key());
    findings.add(
        &["solver", "engine"],
        format!("the engine `{engine}` factors condensed bodies, and the method `{method}` condenses none"),
        "leave `solver.method` out, or `solver.engine`",
    );
}
