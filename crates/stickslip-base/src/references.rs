//! The works this library rests on, one item each, so that a doc link to a source is checked by the compiler.
#![allow(non_upper_case_globals)]

/// A cited work.
#[derive(Debug, Clone, Copy)]
pub struct Reference(
    /// Authors, title, place and year.
    pub &'static str,
);

macro_rules! references {
    ($($name:ident: $text:literal),+ $(,)?) => {
        $(#[doc = $text] pub const $name: Reference = Reference($text);)+
        /// All of them, for the bibliography.
        pub const ALL: &[(&str, Reference)] = &[$((stringify!($name), $name)),+];
    };
}

references! {
    dieterich_1979: "J. H. Dieterich, Modeling of rock friction: 1. Experimental results and constitutive equations, Journal of Geophysical Research 84 (1979) 2161-2168.",
    ruina_1983: "A. Ruina, Slip instability and state variable friction laws, Journal of Geophysical Research 88 (1983) 10359-10370.",
    rice_2001: "J. R. Rice, N. Lapusta, K. Ranjith, Rate and state dependent friction and the stability of sliding between elastically deformable solids, Journal of the Mechanics and Physics of Solids 49 (2001) 1865-1898.",
    pop_1995: "N. Pop, A finite element method for frictional contact problems, Buletinul Științific al Universității din Baia Mare, Seria B, XI (1995) 89-104.",
    michalowski_mroz_1978: "R. Michałowski, Z. Mróz, Associated and non-associated sliding rules in contact friction problems, Archives of Mechanics 30 (1978) 259-276.",
    oden_martins_1985: "J. T. Oden, J. A. C. Martins, Models and computational methods for dynamic friction phenomena, Computer Methods in Applied Mechanics and Engineering 52 (1985) 527-634.",
    zavarise_1992: "G. Zavarise, P. Wriggers, E. Stein, B. A. Schrefler, Real contact mechanisms and finite element formulation: a coupled thermomechanical approach, International Journal for Numerical Methods in Engineering 35 (1992) 767-785.",
    simo_laursen_1992: "J. C. Simo, T. A. Laursen, An augmented Lagrangian treatment of contact problems involving friction, Computers and Structures 42 (1992) 97-116.",
    wriggers_2006: "P. Wriggers, Computational Contact Mechanics, 2nd ed., Springer, 2006.",
    laursen_2002: "T. A. Laursen, Computational Contact and Impact Mechanics, Springer, 2002.",
    johnson_1985: "K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985.",
    taylor_papadopoulos_1991: "R. L. Taylor, P. Papadopoulos, On a patch test for contact problems in two dimensions, in: Nonlinear Computational Mechanics, Springer, 1991, 690-702.",
    wohlmuth_2000: "B. I. Wohlmuth, A mortar finite element method using dual spaces for the Lagrange multiplier, SIAM Journal on Numerical Analysis 38 (2000) 989-1012.",
    puso_2004: "M. A. Puso, T. A. Laursen, A mortar segment-to-segment contact method for large deformation solid mechanics, Computer Methods in Applied Mechanics and Engineering 193 (2004) 601-629.",
    cichosz_2011: "T. Cichosz, M. Bischoff, Consistent treatment of boundaries with mortar contact formulations using dual Lagrange multipliers, Computer Methods in Applied Mechanics and Engineering 200 (2011) 1317-1332.",
    popp_2012: "A. Popp, B. I. Wohlmuth, M. W. Gee, W. A. Wall, Dual quadratic mortar finite element methods for 3D finite deformation contact, SIAM Journal on Scientific Computing 34 (2012) B421-B446.",
    raous_1988: "M. Raous, P. Chabrand, F. Lebon, Numerical methods for frictional contact problems and applications, Journal de Mécanique Théorique et Appliquée 7 suppl. 1 (1988) 111-128.",
    ssnv128: "Code_Aster V6.04.128, SSNV128: plaque avec contact et frottement sur un plan rigide.",
    flanagan_1981: "D. P. Flanagan, T. Belytschko, A uniform strain hexahedron and quadrilateral with orthogonal hourglass control, International Journal for Numerical Methods in Engineering 17 (1981) 679-706.",
    taylor_1976: "R. L. Taylor, P. J. Beresford, E. L. Wilson, A non-conforming element for stress analysis, International Journal for Numerical Methods in Engineering 10 (1976) 1211-1219.",
    ibrahimbegovic_1991: "A. Ibrahimbegović, E. L. Wilson, A modified method of incompatible modes, Communications in Applied Numerical Methods 7 (1991) 187-194.",
    higham_1986: "N. J. Higham, Computing the polar decomposition - with applications, SIAM Journal on Scientific and Statistical Computing 7 (1986) 1160-1174.",
    horn_1987: "B. K. P. Horn, Closed-form solution of absolute orientation using unit quaternions, Journal of the Optical Society of America A 4 (1987) 629-642.",
    hughes_1980: "T. J. R. Hughes, Generalization of selective integration procedures to anisotropic and nonlinear media, International Journal for Numerical Methods in Engineering 15 (1980) 1413-1418.",
    karypis_kumar_1998: "G. Karypis, V. Kumar, A fast and high quality multilevel scheme for partitioning irregular graphs, SIAM Journal on Scientific Computing 20 (1998) 359-392.",
    duff_reid_1983: "I. S. Duff, J. K. Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM Transactions on Mathematical Software 9 (1983) 302-325.",
    amestoy_2001: "P. R. Amestoy, I. S. Duff, J.-Y. L'Excellent, J. Koster, A fully asynchronous multifrontal solver using distributed dynamic scheduling, SIAM Journal on Matrix Analysis and Applications 23 (2001) 15-41.",
    liu_1992: "J. W. H. Liu, The multifrontal method for sparse matrix solution: theory and practice, SIAM Review 34 (1992) 82-109.",
    saad_schultz_1986: "Y. Saad, M. H. Schultz, GMRES: a generalized minimal residual algorithm for solving nonsymmetric linear systems, SIAM Journal on Scientific and Statistical Computing 7 (1986) 856-869.",
    saad_1993: "Y. Saad, A flexible inner-outer preconditioned GMRES algorithm, SIAM Journal on Scientific Computing 14 (1993) 461-469.",
    simoncini_szyld_2003: "V. Simoncini, D. B. Szyld, Theory of inexact Krylov subspace methods and applications to scientific computing, SIAM Journal on Scientific Computing 25 (2003) 454-477.",
    shabana_2013: "A. A. Shabana, Dynamics of Multibody Systems, 4th ed., Cambridge University Press, 2013.",
    nour_omid_rankin_1991: "B. Nour-Omid, C. C. Rankin, Finite rotation analysis and consistent linearization using projectors, Computer Methods in Applied Mechanics and Engineering 93 (1991) 353-384.",
    simo_wong_1991: "J. C. Simo, K. K. Wong, Unconditionally stable algorithms for rigid body dynamics that exactly preserve energy and momentum, International Journal for Numerical Methods in Engineering 31 (1991) 19-52.",
    westergaard_1939: "H. M. Westergaard, Bearing pressures and cracks, Journal of Applied Mechanics 6 (1939) A49-A53.",
    persson_2001: "B. N. J. Persson, Theory of rubber friction and contact mechanics, Journal of Chemical Physics 115 (2001) 3840-3861.",
    mccool_1986: "J. I. McCool, Comparison of models for the contact of rough surfaces, Wear 107 (1986) 37-60.",
    steele_2014: "G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014, 453-472.",
    mindlin_deresiewicz_1953: "R. D. Mindlin, H. Deresiewicz, Elastic spheres in contact under varying oblique forces, Journal of Applied Mechanics 20 (1953) 327-344.",
    archard_1953: "J. F. Archard, Contact and rubbing of flat surfaces, Journal of Applied Physics 24 (1953) 981-988.",
    fouvry_1995: "S. Fouvry, Ph. Kapsa, L. Vincent, Analysis of sliding behaviour for fretting loadings: determination of transition criteria, Wear 185 (1995) 35-46.",
    fouvry_2003: "S. Fouvry, T. Liskiewicz, P. Kapsa, S. Hannel, E. Sauger, An energy description of wear mechanisms and its applications to oscillating sliding contacts, Wear 255 (2003) 287-298.",
    findley_1959: "W. N. Findley, A theory for the effect of mean stress on fatigue of metals under combined torsion and axial load or bending, Journal of Engineering for Industry 81 (1959) 301.",
    smith_1970: "K. N. Smith, P. Watson, T. H. Topper, A stress-strain function for the fatigue of metals, Journal of Materials 5 (1970) 767-778.",
    ruiz_1984: "C. Ruiz, P. H. B. Boddington, K. C. Chen, An investigation of fatigue and fretting in a dovetail joint, Experimental Mechanics 24 (1984) 208-217.",
    dang_van_1993: "K. Dang Van, Macro-micro approach in high-cycle multiaxial fatigue, in: Advances in Multiaxial Fatigue, ASTM STP 1191, 1993, 120-130.",
    hunt_crossley_1975: "K. H. Hunt, F. R. E. Crossley, Coefficient of restitution interpreted as damping in vibroimpact, Journal of Applied Mechanics 42 (1975) 440-445.",
    armstrong_1994: "B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools and compensation methods for the control of machines with friction, Automatica 30 (1994) 1083-1138.",
    klarbring_1990: "A. Klarbring, Examples of non-uniqueness and non-existence of solutions to quasistatic contact problems with friction, Ingenieur-Archiv 60 (1990) 529-541.",
    newmark_1959: "N. M. Newmark, A method of computation for structural dynamics, Journal of the Engineering Mechanics Division ASCE 85 (1959) 67-94.",
    hht_1977: "H. M. Hilber, T. J. R. Hughes, R. L. Taylor, Improved numerical dissipation for time integration algorithms in structural dynamics, Earthquake Engineering and Structural Dynamics 5 (1977) 283-292.",
    chung_hulbert_1993: "J. Chung, G. M. Hulbert, A time integration algorithm for structural dynamics with improved numerical dissipation: the generalized-α method, Journal of Applied Mechanics 60 (1993) 371-375.",
    vanek_1996: "P. Vaněk, J. Mandel, M. Brezina, Algebraic multigrid by smoothed aggregation for second and fourth order elliptic problems, Computing 56 (1996) 179-196.",
    zienkiewicz_xie_1991: "O. C. Zienkiewicz, Y. M. Xie, A simple error estimator and adaptive time stepping procedure for dynamic analysis, Earthquake Engineering and Structural Dynamics 20 (1991) 871-887.",
    hinton_1976: "E. Hinton, T. Rock, O. C. Zienkiewicz, A note on mass lumping and related processes in the finite element method, Earthquake Engineering and Structural Dynamics 4 (1976) 245-249.",
    khenous_2008: "H. B. Khenous, P. Laborde, Y. Renard, Mass redistribution method for finite element contact problems in elastodynamics, European Journal of Mechanics A/Solids 27 (2008) 918-932.",
    kuettler_2008: "U. Küttler, W. A. Wall, Fixed-point fluid-structure interaction solvers with dynamic relaxation, Computational Mechanics 43 (2008) 61-72.",
    kelley_1995: "C. T. Kelley, Iterative Methods for Linear and Nonlinear Equations, SIAM (1995).",
    kane_1999: "C. Kane, E. A. Repetto, M. Ortiz, J. E. Marsden, Finite element analysis of nonsmooth contact, Computer Methods in Applied Mechanics and Engineering 180 (1999) 1-26.",
    doyen_2011: "D. Doyen, A. Ern, S. Piperno, Time-integration schemes for the finite element dynamic Signorini problem, SIAM Journal on Scientific Computing 33 (2011) 223-249.",
    lanczos_1950: "C. Lanczos, An iteration method for the solution of the eigenvalue problem of linear differential and integral operators, Journal of Research of the National Bureau of Standards 45 (1950) 255-282.",
    paige_1980: "C. C. Paige, Accuracy and effectiveness of the Lanczos algorithm for the symmetric eigenproblem, Linear Algebra and its Applications 34 (1980) 235-258.",
    anderson_1965: "D. G. Anderson, Iterative procedures for nonlinear integral equations, Journal of the ACM 12 (1965) 547-560.",
    sutherland_hodgman_1974: "I. E. Sutherland, G. W. Hodgman, Reentrant polygon clipping, Communications of the ACM 17 (1974) 32-42.",
    guyan_1965: "R. J. Guyan, Reduction of stiffness and mass matrices, AIAA Journal 3 (1965) 380.",
    irons_1965: "B. M. Irons, Structural eigenvalue problems: elimination of unwanted variables, AIAA Journal 3 (1965) 961-962.",
    przemieniecki_1963: "J. S. Przemieniecki, Matrix structural analysis of substructures, AIAA Journal 1 (1963) 138-147.",
    craig_bampton_1968: "R. R. Craig, M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA Journal 6 (1968) 1313-1319.",
    hager_1989: "W. W. Hager, Updating the inverse of a matrix, SIAM Review 31 (1989) 221-239.",
    dembo_1982: "R. S. Dembo, S. C. Eisenstat, T. Steihaug, Inexact Newton methods, SIAM Journal on Numerical Analysis 19 (1982) 400-408.",
    qi_sun_1993: "L. Qi, J. Sun, A nonsmooth version of Newton's method, Mathematical Programming 58 (1993) 353-367.",
    alart_curnier_1991: "P. Alart, A. Curnier, A mixed formulation for frictional contact problems prone to Newton like solution methods, Computer Methods in Applied Mechanics and Engineering 92 (1991) 353-375.",
    lawson_hanson_1974: "C. L. Lawson, R. J. Hanson, Solving least squares problems, Prentice-Hall, 1974, chapter 23.",
    jean_moreau_1992: "M. Jean, J. J. Moreau, Unilaterality and dry friction in the dynamics of rigid body collections, in: Contact Mechanics International Symposium, Lausanne, 1992, 31-48.",
    jourdan_1998: "F. Jourdan, P. Alart, M. Jean, A Gauss-Seidel like algorithm to solve frictional contact problems, Computer Methods in Applied Mechanics and Engineering 155 (1998) 31-47.",
    acary_2018: "V. Acary, M. Brémond, O. Huber, On solving contact problems with Coulomb friction: formulations and numerical comparisons, in: Advanced Topics in Nonsmooth Dynamics, Springer, 2018, 375-457.",
    rockafellar_1976: "R. T. Rockafellar, Monotone operators and the proximal point algorithm, SIAM Journal on Control and Optimization 14 (1976) 877-898.",
    fan_yuan_2005: "J.-Y. Fan, Y.-X. Yuan, On the quadratic convergence of the Levenberg-Marquardt method without nonsingularity assumption, Computing 74 (2005) 23-39.",
    golub_van_loan_2013: "G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., Johns Hopkins University Press, 2013.",
}
