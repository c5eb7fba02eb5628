// Cells one above the other, each of six quadratic tetrahedra or one hexahedron [m].
DefineConstant[ Width = 0.05, Height = 0.1, Cells = 2, Hexahedra = 0 ];
Mesh.ElementOrder = Hexahedra ? 1 : 2;
Point(1) = {0, 0, 0};
Point(2) = {Width, 0, 0};
Point(3) = {Width, Width, 0};
Point(4) = {0, Width, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = 2;
Transfinite Surface{1};
If(Hexahedra)
  Recombine Surface{1};
  sides[] = Extrude {0, 0, Height} { Surface{1}; Layers{Cells}; Recombine; };
Else
  sides[] = Extrude {0, 0, Height} { Surface{1}; Layers{Cells}; };
EndIf
Physical Volume("body", 1) = {sides[1]};
Physical Surface("bottom", 11) = {1};
Physical Surface("front", 15) = {sides[2]};
Physical Surface("right", 12) = {sides[3]};
Physical Surface("back", 13) = {sides[4]};
Physical Surface("left", 14) = {sides[5]};
Physical Surface("top", 16) = {sides[0]};
