// One triangle of the area 1.
Point(1) = {0, 0, 0};
Point(2) = {2, 0, 0};
Point(3) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3} = 2;
Physical Surface("body", 1) = {1};
Physical Curve("sides", 2) = {1, 2, 3};
