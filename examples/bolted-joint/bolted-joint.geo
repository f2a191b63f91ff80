// Half of a bolted lap joint, in mm: two plates, a bolt with its head, a nut that overlaps the lower plate by `lift`.
//   gmsh -3 -order 2 -format msh41 bolted-joint.geo -o bolted-joint.msh
// -setnumber f 0.5 halves all cell sizes.
SetFactory("OpenCASCADE");
DefineConstant[ f = {1, Name "factor on cell sizes"} ];

t = 10;      // thickness of a plate
w = 20;      // half of its width
R = 5.5;     // hole
r = 5;       // shank
h = 9;       // head and nut
k = 6;       // their height
lift = 0.02; // the nut is that much higher than where it touches: what tightening takes

Box(1) = {-20, 0, 0, 65, w, t};
Box(2) = {-45, 0, -t, 65, w, t};
Cylinder(11) = {0, 0, -1, 0, 0, t + 2, R, 2 * Pi};
Cylinder(12) = {0, 0, -t - 1, 0, 0, t + 2, R, 2 * Pi};
BooleanDifference(21) = { Volume{1}; Delete; }{ Volume{11}; Delete; };
BooleanDifference(22) = { Volume{2}; Delete; }{ Volume{12}; Delete; };
Cylinder(31) = {0, 0, -t - k + lift, 0, 0, 2 * t + k - lift, r, 2 * Pi};
Cylinder(32) = {0, 0, t, 0, 0, k, h, 2 * Pi};
BooleanUnion(33) = { Volume{31}; Delete; }{ Volume{32}; Delete; };
Box(41) = {-h, 0, -2 * t, 2 * h, h, 4 * t};
BooleanIntersection(43) = { Volume{33}; Delete; }{ Volume{41}; Delete; };
Cylinder(51) = {0, 0, -t - k + lift, 0, 0, k, h, 2 * Pi};
Cylinder(52) = {0, 0, -2 * t, 0, 0, 2 * t, r, 2 * Pi};
BooleanDifference(53) = { Volume{51}; Delete; }{ Volume{52}; Delete; };
Box(54) = {-h, 0, -2 * t, 2 * h, h, 4 * t};
BooleanIntersection(55) = { Volume{53}; Delete; }{ Volume{54}; Delete; };

// Surfaces by the boxes they fill.
e = 1e-3;
b = -t - k + lift; // below the nut
Physical Volume("upper") = {21};
Physical Volume("lower") = {22};
Physical Volume("bolt") = {43};
Physical Volume("nut") = {55};
Physical Surface("upper-below") = { Surface In BoundingBox{ -20 - e, -e, -e, 45 + e, w + e, e } };
Physical Surface("upper-above") = { Surface In BoundingBox{ -20 - e, -e, t - e, 45 + e, w + e, t + e } };
Physical Surface("upper-end") = { Surface In BoundingBox{ 45 - e, -e, -e, 45 + e, w + e, t + e } };
Physical Surface("upper-middle") = { Surface In BoundingBox{ -20 - e, -e, -e, 45 + e, e, t + e } };
Physical Surface("upper-hole") = { Surface In BoundingBox{ -R - e, -e, -e, R + e, R + e, t + e } };
Physical Surface("lower-above") = { Surface In BoundingBox{ -45 - e, -e, -e, 20 + e, w + e, e } };
Physical Surface("lower-below") = { Surface In BoundingBox{ -45 - e, -e, -t - e, 20 + e, w + e, -t + e } };
Physical Surface("lower-end") = { Surface In BoundingBox{ -45 - e, -e, -t - e, -45 + e, w + e, e } };
Physical Surface("lower-middle") = { Surface In BoundingBox{ -45 - e, -e, -t - e, 20 + e, e, e } };
Physical Surface("lower-hole") = { Surface In BoundingBox{ -R - e, -e, -t - e, R + e, R + e, e } };
Physical Surface("bolt-head") = { Surface In BoundingBox{ -h - e, -e, t - e, h + e, h + e, t + e } };
Physical Surface("nut-above") = { Surface In BoundingBox{ -h - e, -e, -t + lift - e, h + e, h + e, -t + lift + e } };
tip() = Surface In BoundingBox{ -r - e, -e, b - e, r + e, r + e, b + e };
thread() = Surface In BoundingBox{ -r - e, -e, b - e, r + e, r + e, -t + lift + e };
thread() -= {tip()};
shank() = Surface In BoundingBox{ -r - e, -e, b - e, r + e, r + e, t + e };
shank() -= {tip(), thread()};
nutside() = Surface In BoundingBox{ -h - e, -e, b - e, h + e, e, -t + lift + e };
boltside() = Surface In BoundingBox{ -h - e, -e, b - e, h + e, e, t + k + e };
boltside() -= {nutside()};
Physical Surface("nut-thread") = {thread()};
Physical Surface("nut-middle") = {nutside()};
Physical Surface("bolt-shank") = {shank()};
Physical Surface("bolt-middle") = {boltside()};

MeshSize{ PointsOf{ Volume{21, 22}; } } = 16 * f;
MeshSize{ PointsOf{ Volume{43, 55}; } } = 7 * f;
p() = Point In BoundingBox{ -R - e, -e, -t - e, R + e, R + e, t + e };
MeshSize{ p() } = 6 * f;
Mesh.SecondOrderLinear = 0;
Mesh.Algorithm3D = 1;
Mesh.HighOrderOptimize = 1;
