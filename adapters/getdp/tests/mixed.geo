// Two kinds of elements beside one another: quadrangles and triangles, or hexahedra and prisms.
DefineConstant[ Solid = 0 ];
For k In {0:2}
  Point(1 + k) = {k / 2, 0, 0};
  Point(4 + k) = {k / 2, 1, 0};
  Line(1 + k) = {1 + k, 4 + k};
EndFor
For k In {0:1}
  Line(4 + k) = {1 + k, 2 + k};
  Line(6 + k) = {4 + k, 5 + k};
  Curve Loop(1 + k) = {4 + k, 2 + k, -(6 + k), -(1 + k)};
  Plane Surface(1 + k) = {1 + k};
EndFor
Transfinite Curve{1:7} = 2;
Transfinite Surface{1, 2};
Recombine Surface{1};
If(Solid)
  left[] = Extrude {0, 0, 1} { Surface{1}; Layers{1}; Recombine; };
  right[] = Extrude {0, 0, 1} { Surface{2}; Layers{1}; Recombine; };
  Physical Volume("body", 1) = {left[1], right[1]};
  Physical Surface("bottom", 11) = {1, 2};
  Physical Surface("front", 15) = {left[2], right[2]};
  Physical Surface("right", 12) = {right[3]};
  Physical Surface("back", 13) = {left[4], right[4]};
  Physical Surface("left", 14) = {left[5]};
  Physical Surface("top", 16) = {left[0], right[0]};
Else
  Physical Surface("body", 1) = {1, 2};
  Physical Curve("sides", 2) = {4, 5, 3, 6, 7, 1};
EndIf
