use super::condensation::Condensation;
use crate::linear::Compliance;
use crate::system::ContactBlock;

/// The candidates that interfaces touch, and their compliance among themselves.
#[derive(Debug)]
pub(super) struct Active {
    /// Positions among the candidates, ascending.
    pub list: Vec<usize>,
    /// Position in the list by candidate.
    place: Vec<u32>,
    /// Where the dofs of each part start in the list, and their number.
    pub starts: Vec<usize>,
    /// By part: its compliance among the active dofs; `None`: that of the whole part.
    compliance: Vec<Option<Compliance>>,
}

/// A contact block by positions in the active list, [`NONE`] for dofs that are no candidates.
pub(super) struct Placed<'a> {
    pub at: Vec<u32>,
    pub block: &'a ContactBlock,
}

/// No active dof.
pub(super) const NONE: u32 = u32::MAX;

/// A list may have this many times the dofs touched before it is made anew, and some more where they are few.
const SLACK: usize = 2;
const FEW: usize = 100;

impl Active {
    /// Which candidates these blocks touch.
    pub fn touched(condensation: &Condensation, blocks: &[ContactBlock]) -> Vec<bool> {
        let mut touched = vec![false; condensation.size()];
        for block in blocks {
            for &dof in &block.dofs {
                if let Some(at) = condensation.place(dof) {
                    touched[at] = true;
                }
            }
        }
        touched
    }

    /// Whether the list has all dofs touched and not many more.
    pub fn suits(&self, touched: &[bool]) -> bool {
        let wanted = touched.iter().filter(|t| **t).count();
        let mut all = touched.iter().zip(&self.place);
        let covered = all.all(|(&touched, &place)| !touched || place != NONE);
        covered && self.list.len() <= SLACK * wanted.max(FEW)
    }

    /// The active dofs for the candidates touched.
    pub fn new(condensation: &Condensation, touched: &[bool]) -> Active {
        let wanted = touched.iter().filter(|t| **t).count();
        // Above this part of the candidates all of them are active: a cut would save less than it costs.
        let whole = wanted as f64 > 0.7 * condensation.size() as f64;
        let list: Vec<usize> = (0..touched.len())
            .filter(|&i| whole || touched[i])
            .collect();
        let mut place = vec![NONE; touched.len()];
        for (k, &i) in list.iter().enumerate() {
            place[i] = k as u32;
        }
        let mut starts = Vec::new();
        let mut compliance = Vec::new();
        let ranges = condensation.starts.windows(2);
        for (part, range) in condensation.parts.iter().zip(ranges) {
            let end = list.partition_point(|&i| i < range[1]);
            let start = list.partition_point(|&i| i < range[0]);
            starts.push(start);
            let own = list[start..end].iter().map(|&i| i - range[0]);
            let cut = || part.compliance.cut(own);
            compliance.push((!whole).then(cut));
        }
        starts.push(list.len());
        Active {
            list,
            place,
            starts,
            compliance,
        }
    }

    /// Number of active dofs.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// A block by positions in the list.
    pub fn place<'a>(&self, condensation: &Condensation, block: &'a ContactBlock) -> Placed<'a> {
        let at = block.dofs.iter().map(|&dof| match condensation.place(dof) {
            Some(at) => self.place[at],
            None => NONE,
        });
        Placed {
            at: at.collect(),
            block,
        }
    }

    /// The compliance of a part among its active dofs.
    pub fn compliance<'a>(&'a self, condensation: &'a Condensation, part: usize) -> &'a Compliance {
        match &self.compliance[part] {
            Some(own) => own,
            None => &condensation.parts[part].compliance,
        }
    }
}
