// A pin in a bushed lug, in mm. The curves of pin and hole are different curves, so that the two bodies share no nodes.
//   gmsh -2 -order 2 -format msh41 lug.geo -o lug.msh
// -setnumber f 0.5 halves all cell sizes.
DefineConstant[ f = {1, Name "factor on cell sizes"} ];

R = 10;       // hole
fit = 0.005;  // radial interference: the pin is that much larger
B = 13;       // outside of the bush
H = 30;       // head of the lug, and half the width of its shank
L = 80;       // from the centre of the hole to the held end

hc = 1.0 * f; // on the hole
hp = 1.2 * f; // on the pin: the meshes do not match
ho = 5.0 * f; // outside

Point(1) = {0, 0, 0, 4 * f};

// hole and outside of the bush, from the right counterclockwise
Point(11) = {R, 0, 0, hc};  Point(12) = {0, R, 0, hc};  Point(13) = {-R, 0, 0, hc};  Point(14) = {0, -R, 0, hc};
Point(21) = {B, 0, 0, 1.6 * f};  Point(22) = {0, B, 0, 1.6 * f};  Point(23) = {-B, 0, 0, 1.6 * f};  Point(24) = {0, -B, 0, 1.6 * f};
For i In {1:4}
  j = i % 4 + 1;
  Circle(10 + i) = {10 + i, 1, 10 + j};
  Circle(20 + i) = {20 + i, 1, 20 + j};
EndFor

// outline of the lug
Point(31) = {H, 0, 0, ho};  Point(32) = {0, H, 0, ho};  Point(33) = {-H, 0, 0, ho};
Point(34) = {-H, -L, 0, ho};  Point(35) = {H, -L, 0, ho};
Circle(31) = {31, 1, 32};  Circle(32) = {32, 1, 33};
Line(33) = {33, 34};  Line(34) = {34, 35};  Line(35) = {35, 31};

// pin
P = R + fit;
Point(2) = {0, 0, 0, 3 * f};
// Turned by 20 degrees, so that no node of the hole lies exactly opposite one of the pin.
For i In {1:4}
  a = (20 + 90 * (i - 1)) * Pi / 180;
  Point(40 + i) = {P * Cos(a), P * Sin(a), 0, hp};
EndFor
For i In {1:4}
  Circle(40 + i) = {40 + i, 2, 40 + i % 4 + 1};
EndFor

Curve Loop(1) = {11:14};  Curve Loop(2) = {21:24};  Curve Loop(3) = {31:35};  Curve Loop(4) = {41:44};
Plane Surface(1) = {2, 1};  // bush
Plane Surface(2) = {3, 2};  // lug
Plane Surface(3) = {4};     // pin
Point{2} In Surface{3};

// The bush is bonded to the lug: one body of two materials.
Physical Surface("plate") = {1, 2};
Physical Surface("bush") = {1};
Physical Surface("pin") = {3};
Physical Curve("hole") = {-11, -12, -13, -14};
Physical Curve("rim") = {41:44};
Physical Curve("end") = {34};
