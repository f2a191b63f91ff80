//! Decks in the styles of the programs that write them.

use stickslip_deck::read_mesh;

use crate::support::{near, near3, place, refused, run, translate};

/// Two cubes as PrePoMax writes them.
const PREPOMAX: &str = r#"** Heading +++++++++++++++++++++++++++++++++++++++++++++++++
**
*Heading
Hash: Ab3dXy, Date: 01/02/2024, Unit system: MM_TON_S_C
**
** Nodes +++++++++++++++++++++++++++++++++++++++++++++++++++
**
*Node
1, 0.00000000E+000, 0.00000000E+000, 0.00000000E+000
2, 1.00000000E+000, 0.00000000E+000, 0.00000000E+000
3, 1.00000000E+000, 1.00000000E+000, 0.00000000E+000
4, 0.00000000E+000, 1.00000000E+000, 0.00000000E+000
5, 0.00000000E+000, 0.00000000E+000, 1.00000000E+000
6, 1.00000000E+000, 0.00000000E+000, 1.00000000E+000
7, 1.00000000E+000, 1.00000000E+000, 1.00000000E+000
8, 0.00000000E+000, 1.00000000E+000, 1.00000000E+000
9, 0.00000000E+000, 0.00000000E+000, 1.00000000E+000
10, 1.00000000E+000, 0.00000000E+000, 1.00000000E+000
11, 1.00000000E+000, 1.00000000E+000, 1.00000000E+000
12, 0.00000000E+000, 1.00000000E+000, 1.00000000E+000
13, 0.00000000E+000, 0.00000000E+000, 2.00000000E+000
14, 1.00000000E+000, 0.00000000E+000, 2.00000000E+000
15, 1.00000000E+000, 1.00000000E+000, 2.00000000E+000
16, 0.00000000E+000, 1.00000000E+000, 2.00000000E+000
17, 0.50000000E+000, 0.50000000E+000, 2.00000000E+000
18, 0.50000000E+000, 0.50000000E+000, 2.00000000E+000
**
** Elements ++++++++++++++++++++++++++++++++++++++++++++++++
**
*Element, Type=C3D8, Elset=Solid_part-1
1, 1, 2, 3, 4, 5, 6, 7, 8
*Element, Type=C3D8, Elset=Solid_part-2
2, 9, 10, 11, 12, 13, 14, 15, 16
**
** Node sets +++++++++++++++++++++++++++++++++++++++++++++++
**
*Nset, Nset=Internal_Selection-1_Fixed-1
1, 2, 3, 4,
*Nset, Nset=Internal_Selection-1_Rigid_body-1
13, 14, 15, 16,
*Nset, Nset=Reference_point-1
17,
18,
**
** Element sets ++++++++++++++++++++++++++++++++++++++++++++
**
*Elset, Elset=Internal-1_Internal_Selection-1_Section-1
Solid_part-1,
Solid_part-2,
*Elset, Elset=Internal_Surface-1_S2
1,
*Elset, Elset=Internal_Surface-2_S1
2,
**
** Surfaces ++++++++++++++++++++++++++++++++++++++++++++++++
**
*Surface, Name=Internal_Surface-1, Type=Element
Internal_Surface-1_S2, S2
*Surface, Name=Internal_Surface-2, Type=Element
Internal_Surface-2_S1, S1
**
** Physical constants ++++++++++++++++++++++++++++++++++++++
**
** Coordinate systems ++++++++++++++++++++++++++++++++++++++
**
** Materials +++++++++++++++++++++++++++++++++++++++++++++++
**
*Material, Name=S235
*Density
7.8E-09
*Elastic
1000, 0
**
*Material, Name=Not_used
*Elastic
70000, 0.33
**
** Sections ++++++++++++++++++++++++++++++++++++++++++++++++
**
*Solid section, Elset=Internal-1_Internal_Selection-1_Section-1, Material=S235
**
** Pre-tension sections ++++++++++++++++++++++++++++++++++++
**
** Constraints +++++++++++++++++++++++++++++++++++++++++++++
**
** Name: Rigid_body-1
*Rigid body, Nset=Internal_Selection-1_Rigid_body-1, Ref node=17, Rot node=18
**
** Surface interactions ++++++++++++++++++++++++++++++++++++
**
*Surface interaction, Name=Surface_interaction-1
*Surface behavior, Pressure-overclosure=Linear
1000, 10, 0.001
*Friction
0.2, 10000
**
** Contact pairs +++++++++++++++++++++++++++++++++++++++++++
**
** Name: Contact_pair-1
*Contact pair, Interaction=Surface_interaction-1, Type=Surface to surface
Internal_Surface-2, Internal_Surface-1
**
** Amplitudes ++++++++++++++++++++++++++++++++++++++++++++++
**
** Steps +++++++++++++++++++++++++++++++++++++++++++++++++++
**
** Step-1 ++++++++++++++++++++++++++++++++++++++++++++++++++
**
*Step, Nlgeom, Inc=100
*Static, Solver=Pardiso
0.5, 1, 1E-05, 1E+30
**
** Output frequency ++++++++++++++++++++++++++++++++++++++++
**
*Output, Frequency=1
**
** Boundary conditions +++++++++++++++++++++++++++++++++++++
**
*Boundary, op=New
** Name: Fixed-1
*Boundary
Internal_Selection-1_Fixed-1, 1, 6, 0
** Name: Displacement_rotation-1
*Boundary
17, 1, 2, 0
18, 1, 3, 0
*Boundary
17, 3, 3, -0.003
**
** Loads +++++++++++++++++++++++++++++++++++++++++++++++++++
**
*Cload, op=New
*Dload, op=New
**
** Defined fields ++++++++++++++++++++++++++++++++++++++++++
**
** History outputs +++++++++++++++++++++++++++++++++++++++++
**
*Node print, Nset=Internal_Selection-1_Fixed-1, Totals=Only
RF
**
** Field outputs +++++++++++++++++++++++++++++++++++++++++++
**
*Node file
RF, U
*El file
S, E, ENER, NOE
*Contact file
CDIS, CSTR
**
** End step ++++++++++++++++++++++++++++++++++++++++++++++++
**
*End step
"#;

#[test]
fn prepomax() {
    let r = run("prepomax", PREPOMAX);
    // 0.003 over two cubes of 1000 and an interface of 1000 in series.
    near3(r.u(15), [0.0, 0.0, -0.003], 1e-9);
    near3(r.u(11), [0.0, 0.0, -0.002], 1e-6);
    near(r.last("total force")[2], 1.0, 1e-6);
    let toml = translate(PREPOMAX).toml;
    for name in [
        "SOLID_PART-1",
        "INTERNAL_SURFACE-2-INTERNAL_SURFACE-1",
        "S235",
    ] {
        assert!(toml.contains(name), "{toml}");
    }
}

/// A tetrahedral cube as FreeCAD's writer makes it: everything in one file, sets of faces as surfaces, a tie, a pressure.
#[test]
fn freecad() {
    let deck = r#"
** written by FreeCAD inp file writer for CalculiX,Abaqus meshes
** all mesh elements.

** Nodes
*Node, NSET=Nall
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2

** Volume elements
*Element, TYPE=C3D8, ELSET=Evolumes
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 11, 12, 13, 14, 15, 16, 17, 18

** Define element set Eall
*ELSET, ELSET=Eall
Evolumes


***********************************************************
** Element sets for materials and FEM element type (solid, shell, beam, fluid)
** written by write_elsets_materials_and_femelement_type function
*ELSET,ELSET=MaterialSolidSolid
Evolumes

***********************************************************
** Node set for fixed constraint
** written by write_node_sets_constraints_fixed function
** ConstraintFixed
*NSET,NSET=ConstraintFixed
1,
2,
3,
4,

***********************************************************
** Surfaces for tie constraint
** written by write_surfaces_constraints_tie function
** ConstraintTie
*SURFACE, NAME=TIE_DEPConstraintTie, TYPE=ELEMENT
2,S1
*SURFACE, NAME=TIE_INDConstraintTie, TYPE=ELEMENT
1,S2

***********************************************************
** Materials
** written by write_materials function
** Material
*MATERIAL, NAME=MaterialSolid
*ELASTIC
1000, 0.000
*EXPANSION, ZERO=0
0

***********************************************************
** Sections
** written by write_femelementsets function
*SOLID SECTION, ELSET=MaterialSolidSolid, MATERIAL=MaterialSolid

***********************************************************
** Constraint Tie
*TIE, POSITION TOLERANCE=25.0, ADJUST=NO, NAME=TConstraintTie
TIE_DEPConstraintTie,TIE_INDConstraintTie

***********************************************************
** At least one step is needed to run an CalculiX analysis of FreeCAD
** written by write_step_begin function
*STEP, INC=2000
*STATIC


***********************************************************
** Fixed Constraints
** written by write_constraints_fixed function
** ConstraintFixed
*BOUNDARY
ConstraintFixed,1
ConstraintFixed,2
ConstraintFixed,3


***********************************************************
** Element + CalculiX face + load in [MPa]
** written by write_constraints_pressure function
** ConstraintPressure
*DLOAD
2,P2,-4.0

***********************************************************
** Outputs --> frd file
** written by write_outputs_types function
*NODE FILE
U, RF
*EL FILE
S, E

** outputs --> dat file
** reaction forces for Constraint fixed
*NODE PRINT, NSET=ConstraintFixed, TOTALS=ONLY
RF

***********************************************************
** written by write_step_end function
*END STEP

***********************************************************
** CalculiX Input file
**    FreeCAD version  --> 0.21
"#;
    let r = run("freecad", deck);
    near3(r.u(17), [0.0, 0.0, 0.008], 1e-6);
    near(r.last("total force")[2], -4.0, 1e-6);
}

/// Two tetrahedra and what Gmsh writes beside them: lines, faces, physical groups under one name for nodes and elements.
const GMSH: &str = "*Heading\n /tmp/model.inp\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 1, 1\n******* E L E M E N T S *************\n\
    *ELEMENT, type=T3D2, ELSET=Line1\n1, 1, 2\n2, 2, 3\n*ELEMENT, type=CPS3, ELSET=Surface1\n3, 1, 3, 2\n*ELEMENT, type=CPS3, ELSET=Surface2\n4, 4, 5, 3\n\
    *ELEMENT, type=C3D4, ELSET=Volume1\n10, 1, 2, 3, 4\n11, 2, 5, 3, 4\n*ELSET,ELSET=base\n3, \n*ELSET,ELSET=top\n4, \n*ELSET,ELSET=body\n10, 11, \n\
    *NSET,NSET=base\n1, 3, 2, \n*NSET,NSET=top\n3, 4, 5, \n";

#[test]
fn gmsh_with_lower_dimensional_elements() {
    let deck = format!(
        "{GMSH}*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*SOLID SECTION, ELSET=body, MATERIAL=M\n*SURFACE, NAME=END\ntop, S1\n*BOUNDARY\nbase, 1, 3\n\
         *STEP\n*STATIC\n*DSLOAD\nEND, P, 1.\n*NODE PRINT, NSET=base, TOTALS=ONLY\nRF\n*END STEP\n"
    );
    let r = run("gmsh", &deck);
    assert_eq!(r.notes.len(), 2, "{:?}", r.notes);
    for kind in ["T3D2", "CPS3"] {
        assert!(r.notes.iter().any(|n| n.contains(kind)), "{:?}", r.notes);
    }
    // A third of the pressure acts on node 3, which is held: forces at nodes are those of the cells.
    let force = r.last("total force");
    near3(
        [force[0], force[1], force[2]],
        [-1.0, 1.0, 1.0].map(|c| c / 3.0 * outwards(&force)),
        1e-6,
    );
}

/// The area vector is (-1, 1, 1) / 2 up to its sign, which says how the face is seen.
fn outwards(force: &[f64]) -> f64 {
    force[2].signum()
}

#[test]
fn faces_of_gmsh_become_sets_of_the_mesh() {
    let path = place("gmsh-mesh.inp");
    std::fs::write(&path, GMSH).expect("a file");
    let mesh = read_mesh(&path).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(mesh.cell_count(), 2);
    assert_eq!(mesh.facet_sets["BASE"].len(), 1);
    assert_eq!(mesh.facet_sets["TOP"].len(), 1);
    assert_eq!(mesh.point_sets["TOP"].len(), 3);
    assert_eq!(mesh.cell_sets["BODY"].len(), 2);
}

#[test]
fn faces_that_are_meant_to_be_shells_are_refused() {
    let deck = GMSH.replace("type=CPS3", "type=S3")
        + "*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*SOLID SECTION, ELSET=body, MATERIAL=M\n*SHELL SECTION, ELSET=top, MATERIAL=M\n.1\n";
    let message = refused(&deck);
    assert!(
        message.contains("shells are not computed: 2 elements of type S3, 1 *SHELL SECTION"),
        "{message}"
    );
    let alone =
        "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n*ELEMENT, TYPE=S3, ELSET=E\n1, 1, 2, 3\n";
    let message = refused(alone);
    assert!(
        message.contains("job.inp:5: error: shells are not computed: 1 element of type S3"),
        "{message}"
    );
}

/// A flat deck of Abaqus/CAE: names of instances with points, symmetry by name, quoted names, history output.
#[test]
fn abaqus_flat() {
    let deck = "*Heading\n** Job name: Job-1 Model name: Model-1\n** Generated by: Abaqus/CAE 2021\n*Preprint, echo=NO, model=NO, history=NO, contact=NO\n\
        *Node\n      1,           0.,           0.,           0.\n 2, 1., 0., 0.\n 3, 1., 1., 0.\n 4, 0., 1., 0.\n 5, 0., 0., 1.\n 6, 1., 0., 1.\n 7, 1., 1., 1.\n 8, 0., 1., 1.\n\
        *Element, type=C3D8R\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*Nset, nset=Part-1-1_Set-1, generate\n 1, 8, 1\n*Elset, elset=Part-1-1_Set-1\n 1,\n\
        *Nset, nset=\"Bottom face\", internal\n 1, 2, 3, 4\n*Nset, nset=_PickedSet.5\n1, 4, 5, 8\n*Nset, nset=_PickedSet-5\n1, 2, 5, 6\n\
        *Elset, elset=_Surf-1_S2, internal\n 1,\n*Surface, type=ELEMENT, name=Surf-1\n_Surf-1_S2, S2\n\
        ** Section: Section-1\n*Solid Section, elset=Part-1-1_Set-1, controls=EC-1, material=Steel\n,\n*Section Controls, name=EC-1, hourglass=ENHANCED\n1., 1., 1.\n\
        *Material, name=Steel\n*Elastic\n1000., 0.25\n**\n*Amplitude, name=Ramp\n             0.,              0.,              1.,              1.\n\
        *Step, name=Step-1, nlgeom=NO\n*Static\n1., 1., 1e-05, 1.\n*Boundary\n\"Bottom face\", ZSYMM\n_PickedSet.5, XSYMM\n_PickedSet-5, YSYMM\n\
        *Dsload, amplitude=Ramp\nSurf-1, P, -10.\n*Restart, write, frequency=0\n*Output, field, variable=PRESELECT\n*Output, history\n*Energy Output\nALLIE,\n*End Step\n";
    let r = run("abaqus", deck);
    near3(r.u(7), [-0.0025, -0.0025, 0.01], 1e-6);
}

/// A plane deck as Mecway and others write it: plane elements with a thickness, all in capitals, numbers without points.
#[test]
fn mecway_plane() {
    let deck = "*HEADING\nModel: plane\n*NODE,NSET=NALL\n1,0,0,0\n2,2,0,0\n3,2,1,0\n4,0,1,0\n*ELEMENT,TYPE=CPS4,ELSET=EALL\n1,1,2,3,4\n\
        *SURFACE,NAME=PULL\n1,S2\n*MATERIAL,NAME=MAT\n*ELASTIC\n1000,0\n*SOLID SECTION,ELSET=EALL,MATERIAL=MAT\n0.5\n\
        *STEP\n*STATIC\n*BOUNDARY\n1,1,2,0\n4,1,1,0\n*DSLOAD\nPULL,P,-10\n*NODE PRINT,NSET=NALL,TOTALS=YES\nU,RF\n*NODE FILE\nU,RF\n*END STEP\n";
    let r = run("mecway", deck);
    near(r.u(3)[0], 0.02, 1e-9);
    // The thickness counts: 10 * 1 * 0.5.
    near(
        r.all("forces")[0].2[0][1] + r.all("forces")[0].2[3][1],
        -5.0,
        1e-6,
    );
}
