//! Interactions and pairs of surfaces.

use super::{Context, Reader, clip, parameter};
use crate::deck::Action;
use crate::deck::{Behavior, Clearance, Friction, Interaction, Pair, Tie};
use crate::source::{Card, label};

impl Reader<'_> {
    pub(super) fn interaction(&mut self, card: &Card) {
        self.parameters(card, &["NAME"], &["PAD", "USER"]);
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        if card.has("USER") {
            self.error(
                card.place,
                "interactions of user subroutines are not supported",
                "give *SURFACE BEHAVIOR and *FRICTION",
            );
        }
        let interaction = Interaction {
            place: card.place,
            ..Interaction::default()
        };
        if self
            .deck
            .interactions
            .insert(name.clone(), interaction)
            .is_some()
        {
            self.error(
                card.place,
                format!("the surface interaction {name} is given twice"),
                "names are unique: blanks and case do not count",
            );
        }
        self.context = Context::Interaction(name);
    }

    pub(super) fn behavior(&mut self, card: &Card) {
        self.parameters(
            card,
            &[
                "PRESSURE-OVERCLOSURE",
                "PENALTY",
                "DIRECT",
                "NOSEPARATION",
                "AUGMENTEDLAGRANGE",
            ],
            &[],
        );
        if card.has("NOSEPARATION") {
            self.error(
                card.place,
                "surfaces that do not separate are not supported",
                "use *TIE, or a tied interface",
            );
            return;
        }
        let behavior = match card.get("PRESSURE-OVERCLOSURE").unwrap_or("HARD") {
            "HARD" | "" => {
                if !card.data.is_empty() && !card.has("PENALTY") {
                    self.note(card.place, "the data of hard contact are left out: it is exact here, without a penalty");
                }
                if card.has("PENALTY") {
                    self.note(
                        card.place,
                        "PENALTY is left out: hard contact is exact here",
                    );
                }
                Behavior::Hard
            }
            "LINEAR" => {
                let Some(data) = self.line(card) else { return };
                let slope = self.number(data, 0, 0.0);
                if slope <= 0.0 {
                    self.error(data.place, "the slope of the pressure over the overclosure must be above 0", "write it in the first field; in CalculiX 5 to 50 times Young's modulus is customary");
                    return;
                }
                Behavior::Linear {
                    slope,
                    tension: self.number(data, 1, 0.0),
                }
            }
            "EXPONENTIAL" => {
                let Some(data) = self.line(card) else { return };
                let (c0, p0) = (self.number(data, 0, 0.0), self.number(data, 1, 0.0));
                if c0 <= 0.0 || p0 <= 0.0 {
                    self.error(
                        data.place,
                        "the clearance c0 and the pressure p0 must be above 0",
                        "write c0, p0",
                    );
                    return;
                }
                Behavior::Exponential { c0, p0 }
            }
            "TABULAR" => {
                let mut rows: Vec<[f64; 2]> = Vec::new();
                for data in &card.data {
                    let row = [self.number(data, 1, 0.0), self.number(data, 0, 0.0)];
                    if rows
                        .last()
                        .is_some_and(|last| last[0] >= row[0] || last[1] > row[1])
                    {
                        self.error(
                            data.place,
                            "overclosures must increase and pressures must not fall",
                            "write pressure, overclosure",
                        );
                        return;
                    }
                    rows.push(row);
                }
                if rows.len() < 2 {
                    self.error(
                        card.place,
                        "the table needs two rows or more",
                        "write pressure, overclosure",
                    );
                    return;
                }
                Behavior::Tabular(rows)
            }
            "TIED" => Behavior::Tied,
            other => {
                let message = format!("PRESSURE-OVERCLOSURE={} is not supported", clip(other));
                self.error(
                    card.place,
                    message,
                    "HARD, LINEAR, EXPONENTIAL, TABULAR and TIED are",
                );
                return;
            }
        };
        match self.context.clone() {
            Context::Interaction(name) => {
                if let Some(i) = self.deck.interactions.get_mut(&name) {
                    i.behavior = Some(behavior);
                }
            }
            Context::ChangeBehavior(name) => {
                if let Some(step) = self.deck.steps.last_mut() {
                    step.actions
                        .push(Action::ChangeBehavior(name, behavior, card.place));
                }
            }
            _ => self.error(
                card.place,
                "*SURFACE BEHAVIOR belongs to no interaction",
                "write it beneath *SURFACE INTERACTION",
            ),
        }
    }

    pub(super) fn friction(&mut self, card: &Card) {
        self.parameters(
            card,
            &[
                "TAUMAX",
                "EXPONENTIALDECAY",
                "ROUGH",
                "LAGRANGE",
                "SLIPTOLERANCE",
                "ELASTICSLIP",
                "PROPERTIES",
            ],
            &["ANISOTROPIC", "DEPVAR", "USER", "SHEARTRACTIONSLOPE"],
        );
        for name in ["ANISOTROPIC", "USER"] {
            if card.has(name) {
                self.error(
                    card.place,
                    format!("*FRICTION, {name} is not supported"),
                    "friction is isotropic; see `stickslip models` for the laws there are",
                );
                return;
            }
        }
        let rough = card.has("ROUGH");
        let mut v = [0.0; 3];
        let mut given = 0;
        if !rough {
            let Some(data) = self.line(card) else { return };
            v = [0, 1, 2].map(|i| self.number(data, i, 0.0));
            given = data.fields.len();
        }
        if v[0] < 0.0 {
            self.error(
                card.place,
                "the coefficient of friction is negative",
                "write 0 or more",
            );
        }
        let decay = card.has("EXPONENTIALDECAY").then_some([v[1], v[2]]);
        for name in ["SLIPTOLERANCE", "ELASTICSLIP"] {
            if card.has(name) {
                self.note(
                    card.place,
                    format!("{name} is left out: sticking is exact here"),
                );
            }
        }
        let friction = Friction {
            mu: v[0],
            stick: (decay.is_none() && given > 1 && v[1] > 0.0).then_some(v[1]),
            cap: parameter(self, card, "TAUMAX"),
            decay,
            rough,
        };
        match self.context.clone() {
            Context::Interaction(name) => {
                if let Some(i) = self.deck.interactions.get_mut(&name) {
                    i.friction = Some(friction);
                }
            }
            Context::ChangeFriction(name) => {
                if let Some(step) = self.deck.steps.last_mut() {
                    step.actions
                        .push(Action::ChangeFriction(name, friction, card.place));
                }
            }
            _ => self.error(
                card.place,
                "*FRICTION belongs to no interaction",
                "write it beneath *SURFACE INTERACTION or *CHANGE FRICTION",
            ),
        }
    }

    pub(super) fn contact_damping(&mut self, card: &Card) {
        self.parameters(card, &["DEFINITION", "TANGENTFRACTION"], &[]);
        if card
            .get("DEFINITION")
            .is_some_and(|d| d != "DAMPINGCOEFFICIENT")
        {
            self.error(
                card.place,
                "*CONTACT DAMPING: only DEFINITION=DAMPING COEFFICIENT is read",
                "give pressure per closing velocity",
            );
            return;
        }
        let Some(data) = self.line(card) else { return };
        let value = self.number(data, 0, 0.0);
        let tangent = parameter(self, card, "TANGENTFRACTION").unwrap_or(0.0);
        if tangent != 0.0 {
            self.warn(
                card.place,
                "TANGENT FRACTION is left out: damping acts against approach only",
                "",
            );
        }
        match self.context.clone() {
            Context::Interaction(name) => {
                if let Some(i) = self.deck.interactions.get_mut(&name) {
                    i.damping = Some([value, tangent]);
                }
            }
            _ => self.error(
                card.place,
                "*CONTACT DAMPING belongs to no interaction",
                "write it beneath *SURFACE INTERACTION",
            ),
        }
    }

    pub(super) fn change(&mut self, card: &Card, context: fn(String) -> Context) {
        self.parameters(card, &["INTERACTION"], &["RESET"]);
        let Some(name) = self.required(card, "INTERACTION") else {
            return;
        };
        if !self.in_step {
            self.error(
                card.place,
                format!("{} stands before the first step", card.written),
                "write it in the *STEP from which it holds",
            );
            return;
        }
        self.context = context(name);
    }

    /// Slave and master, in the first data line.
    fn surfaces(&mut self, card: &Card) -> Option<(String, String)> {
        let data = self.line(card)?;
        match data.fields.as_slice() {
            [slave, master, ..] if !slave.is_empty() && !master.is_empty() => {
                Some((label(slave), label(master)))
            }
            _ => {
                self.error(
                    data.place,
                    "two surfaces are expected",
                    "write slave surface, master surface; self-contact is not computed",
                );
                None
            }
        }
    }

    pub(super) fn contact_pair(&mut self, card: &Card) {
        self.parameters(
            card,
            &["INTERACTION", "TYPE", "SMALLSLIDING", "ADJUST", "TIED"],
            &[
                "CPSET",
                "HCRIT",
                "EXTENSIONZONE",
                "SMOOTH",
                "GEOMETRICCORRECTION",
                "MECHANICALCONSTRAINT",
                "NOTHICKNESS",
                "SUPPLEMENTARYCONSTRAINTS",
                "TRACKING",
                "WEIGHT",
                "SLIDINGTRANSITION",
            ],
        );
        let Some(interaction) = self.required(card, "INTERACTION") else {
            return;
        };
        let by_nodes = match card.get("TYPE").unwrap_or("SURFACETOSURFACE") {
            "NODETOSURFACE" => true,
            "SURFACETOSURFACE" | "MORTAR" | "LINMORTAR" | "PGLINMORTAR" => false,
            // Nodes that may touch lose their mass there without their neighbours getting it: of a body of one cell a third is left, and
            // the answer of a coarse mesh is another one than with all of it.
            "MASSLESS" => {
                self.error(
                    card.place,
                    "*CONTACT PAIR of type MASSLESS is not supported: it leaves out the mass of the nodes that may touch, which bodies keep here",
                    "write TYPE=SURFACE TO SURFACE if the mass of the bodies is to count; the motion is another one unless the layer of cells at \
                     the surface is a small part of the body",
                );
                return;
            }
            other => {
                let message = format!("*CONTACT PAIR of type {} is not supported", clip(other));
                self.error(
                    card.place,
                    message,
                    "types are NODE TO SURFACE and SURFACE TO SURFACE",
                );
                return;
            }
        };
        if card.has("TIED") {
            self.error(
                card.place,
                "TIED contact pairs are read as *TIE only",
                "write *TIE, or PRESSURE-OVERCLOSURE=TIED",
            );
            return;
        }
        let mut adjust = None;
        if let Some(text) = card.get("ADJUST") {
            adjust = super::number(text);
            if adjust.is_none() {
                self.warn(
                    card.place,
                    format!(
                        "ADJUST={} is left out: only distances are read, not sets of nodes",
                        clip(text)
                    ),
                    "give a distance, or write `initial = \"snap\"` in a stickslip file",
                );
            }
        }
        let pairs: Vec<&crate::source::Data> = card.data.iter().collect();
        if pairs.is_empty() {
            self.line(card);
        }
        for data in pairs {
            let one = Card {
                data: vec![data.clone()],
                ..card.clone()
            };
            let Some((slave, master)) = self.surfaces(&one) else {
                continue;
            };
            self.deck.pairs.push(Pair {
                slave,
                master,
                interaction: interaction.clone(),
                by_nodes,
                small_sliding: card.has("SMALLSLIDING"),
                adjust,
                place: data.place,
            });
        }
    }

    pub(super) fn clearance(&mut self, card: &Card) {
        self.parameters(card, &["MASTER", "SLAVE", "VALUE"], &["TABULAR", "CPSET"]);
        let (Some(slave), Some(master)) =
            (self.required(card, "SLAVE"), self.required(card, "MASTER"))
        else {
            return;
        };
        let value = parameter(self, card, "VALUE").unwrap_or(0.0);
        self.deck.clearances.push(Clearance {
            slave,
            master,
            value,
            place: card.place,
        });
    }

    pub(super) fn tie(&mut self, card: &Card) {
        self.parameters(
            card,
            &["NAME", "POSITIONTOLERANCE", "ADJUST"],
            &[
                "TYPE",
                "NOROTATION",
                "TIEDNSET",
                "CONSTRAINTRATIO",
                "CYCLICSYMMETRY",
                "MULTISTAGE",
                "FLUIDPERIODIC",
                "FLUIDCYCLIC",
                "NOTHICKNESS",
            ],
        );
        for name in [
            "CYCLICSYMMETRY",
            "MULTISTAGE",
            "FLUIDPERIODIC",
            "FLUIDCYCLIC",
        ] {
            if card.has(name) {
                self.error(
                    card.place,
                    format!("*TIE, {name} is not supported"),
                    "only surfaces that stay together are tied",
                );
                return;
            }
        }
        for data in &card.data {
            let one = Card {
                data: vec![data.clone()],
                ..card.clone()
            };
            let Some((slave, master)) = self.surfaces(&one) else {
                continue;
            };
            let name = card.get("NAME").map_or_else(
                || format!("TIE-{}", self.deck.ties.len() + 1),
                str::to_string,
            );
            self.deck.ties.push(Tie {
                name,
                slave,
                master,
                place: data.place,
            });
        }
    }
}
