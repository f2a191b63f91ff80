// Two unit squares side by side: quadrilaterals on the left, triangles on the right.
// The right one runs clockwise, the line between them is in a group.
// Formats: gmsh -2 -order 1|2 -setnumber Mesh.SecondOrderIncomplete 1 -format msh22|msh41 [-bin] plate.geo
Point(1) = {0, 0, 1};
Point(2) = {1, 0, 1};
Point(3) = {2, 0, 1};
Point(4) = {0, 1, 1};
Point(5) = {1, 1, 1};
Point(6) = {2, 1, 1};
Line(1) = {1, 2};
Line(2) = {2, 5};
Line(3) = {5, 4};
Line(4) = {4, 1};
Line(5) = {2, 3};
Line(6) = {3, 6};
Line(7) = {6, 5};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {2, -7, -6, -5};
Plane Surface(2) = {2};
Transfinite Curve {1:7} = 3;
Transfinite Surface {1};
Recombine Surface {1};
Transfinite Surface {2};
Physical Surface("left part") = {1};
Physical Surface("right part") = {2};
Physical Surface("all") = {1, 2};
Physical Curve("bottom") = {1, 5};
Physical Curve("between") = {2};
Physical Curve("between, seen from the right") = {-2};
Physical Curve(77) = {6};
Physical Point("corner") = {1};
