// A room of 4 m by 2.5 m, upright: a radiator near the left wall, a window in the right one.
h = 0.11;
Point(1) = {0, 0, 0, h}; Point(2) = {4, 0, 0, h};
Point(3) = {4, 0.9, 0, h / 2}; Point(4) = {4, 2.1, 0, h / 2}; Point(5) = {4, 2.5, 0, h}; Point(6) = {0, 2.5, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Point(11) = {0.2, 0.2, 0, h / 3}; Point(12) = {0.35, 0.2, 0, h / 3};
Point(13) = {0.35, 0.8, 0, h / 3}; Point(14) = {0.2, 0.8, 0, h / 3};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(1) = {1:6}; Curve Loop(2) = {11:14};
Plane Surface(1) = {1, 2};
Physical Curve("window") = {3};
Physical Curve("heater") = {11:14};
Physical Surface("air") = {1};
Mesh.Algorithm = 6; // frontal
