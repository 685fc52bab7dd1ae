// An L-shaped laboratory of 6 m by 4 m, seen from above: a bench, two supplies of one name, a hood and a door.
h = 0.17;
Point(1) = {0, 0, 0, h};     Point(2) = {6, 0, 0, h};     Point(3) = {6, 0.6, 0, h / 2}; Point(4) = {6, 1.4, 0, h / 2};
Point(5) = {6, 2, 0, h};     Point(6) = {2.4, 2, 0, h / 2}; Point(7) = {2.4, 4, 0, h};
Point(8) = {1.7, 4, 0, h / 2}; Point(9) = {0.7, 4, 0, h / 2}; Point(10) = {0, 4, 0, h};
Point(11) = {0, 3.2, 0, h / 2}; Point(12) = {0, 2.6, 0, h / 2}; Point(13) = {0, 1, 0, h / 2}; Point(14) = {0, 0.4, 0, h / 2};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7};
Line(7) = {7, 8}; Line(8) = {8, 9}; Line(9) = {9, 10}; Line(10) = {10, 11}; Line(11) = {11, 12};
Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 1};
Point(21) = {3, 0.7, 0, h / 2}; Point(22) = {4.4, 0.7, 0, h / 2};
Point(23) = {4.4, 1.3, 0, h / 2}; Point(24) = {3, 1.3, 0, h / 2};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21};
Curve Loop(1) = {1:14}; Curve Loop(2) = {21:24};
Plane Surface(1) = {1, 2};
Physical Curve("supply") = {11, 13};
Physical Curve("hood") = {3};
Physical Curve("door") = {8};
Physical Curve("bench") = {21:24};
Physical Surface("air") = {1};
Mesh.Algorithm = 6; // frontal
