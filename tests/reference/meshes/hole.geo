// A room of 4 by 3 with a square pillar, two inlets and two outlets.
h = 0.6;
Point(1) = {0, 0, 0, h};   Point(2) = {4, 0, 0, h};
Point(3) = {4, 0.8, 0, h}; Point(4) = {4, 3, 0, h};
Point(5) = {2.5, 3, 0, h}; Point(6) = {1.5, 3, 0, h}; Point(7) = {0, 3, 0, h};
Point(8) = {0, 2, 0, h};   Point(9) = {0, 0.8, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6};
Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 9}; Line(9) = {9, 1};
Point(11) = {1.7, 1.1, 0, h / 2}; Point(12) = {2.3, 1.1, 0, h / 2};
Point(13) = {2.3, 1.7, 0, h / 2}; Point(14) = {1.7, 1.7, 0, h / 2};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(1) = {1:9}; Curve Loop(2) = {11:14};
Plane Surface(1) = {1, 2};
Physical Curve("door", 1) = {7};
Physical Curve("vent", 2) = {9};
Physical Curve("window", 3) = {2};
Physical Curve("hatch", 4) = {5};
Physical Curve("pillar", 5) = {11:14};
Physical Surface("air", 9) = {1};
