// The rectangle of the orders on Kovasznay's flow, by MeshAdapt:
// gmsh -2 -setnumber n 12 meshadapt.geo -o meshadapt-12.msh
DefineConstant[n = 12];
h = 1 / n;
Point(1) = {0, 0, 0, h};   Point(2) = {1.5, 0, 0, h};
Point(3) = {1.5, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Physical Curve("wall") = {1:4};
Physical Surface("air") = {1};
Mesh.Algorithm = 1;
Mesh.Binary = 1;
