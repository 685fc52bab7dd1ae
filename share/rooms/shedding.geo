// A cylinder of diameter 0.1 in a channel of 2.2 by 0.41 (Schaefer & Turek, Notes Numer. Fluid Mech. 52 (1996) 547).
h = 0.05 / 3; r = 0.005 / 3; H = 3 * h; // coarser at the outlet
Point(1) = {0, 0, 0, h}; Point(2) = {2.2, 0, 0, H}; Point(3) = {2.2, 0.41, 0, H}; Point(4) = {0, 0.41, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Point(5) = {0.2, 0.2, 0, r}; Point(6) = {0.25, 0.2, 0, r}; Point(7) = {0.2, 0.25, 0, r};
Point(8) = {0.15, 0.2, 0, r}; Point(9) = {0.2, 0.15, 0, r};
Circle(5) = {6, 5, 7}; Circle(6) = {7, 5, 8}; Circle(7) = {8, 5, 9}; Circle(8) = {9, 5, 6};
Curve Loop(1) = {1:4}; Curve Loop(2) = {5:8};
Plane Surface(1) = {1, 2};
Physical Curve("inlet") = {4}; Physical Curve("outlet") = {2}; Physical Curve("cylinder") = {5:8};
Physical Surface("fluid") = {1};
