// A cube of hexahedra and, apart from it, one of tetrahedra with a surface inside.
// Formats: gmsh -3 -order 1|2 -setnumber Mesh.SecondOrderIncomplete 1 -format msh22|msh41 [-bin] blocks.geo
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Transfinite Curve {1:12} = 2;
Transfinite Surface {1:6};
Recombine Surface {1:6};
Transfinite Volume {1};
Box(2) = {2, 0, 0, 1, 1, 1};
Box(3) = {3, 0, 0, 1, 1, 1};
Coherence;
Mesh.MeshSizeMin = 2;
Mesh.MeshSizeMax = 2;
Physical Volume("brick") = {1};
Physical Volume("wedges") = {2, 3};
Physical Surface("top") = Surface In BoundingBox {-0.1, -0.1, 0.9, 4.1, 1.1, 1.1};
Physical Surface("inside") = Surface In BoundingBox {2.9, -0.1, -0.1, 3.1, 1.1, 1.1};
Physical Curve("edge") = Curve In BoundingBox {-0.1, -0.1, -0.1, 1.1, 0.1, 0.1};
Physical Point("foot") = Point In BoundingBox {-0.1, -0.1, -0.1, 0.1, 0.1, 0.1};
