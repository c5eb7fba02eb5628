// One triangle of the area 1, or one tetrahedron of the volume 1.
DefineConstant[ Solid = 0 ];
Point(1) = {0, 0, 0};
Point(2) = {2, 0, 0};
Point(3) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3} = 2;
If(Solid)
  Point(4) = {0, 0, 3};
  Line(4) = {1, 4};
  Line(5) = {2, 4};
  Line(6) = {3, 4};
  Transfinite Curve{4, 5, 6} = 2;
  Curve Loop(2) = {1, 5, -4};
  Curve Loop(3) = {2, 6, -5};
  Curve Loop(4) = {3, 4, -6};
  For side In {2:4}
    Plane Surface(side) = {side};
  EndFor
  Surface Loop(1) = {1, 2, 3, 4};
  Volume(1) = {1};
  Physical Volume("body", 1) = {1};
  Physical Surface("sides", 2) = {1, 2, 3, 4};
Else
  Physical Surface("body", 1) = {1};
  Physical Curve("sides", 2) = {1, 2, 3};
EndIf
