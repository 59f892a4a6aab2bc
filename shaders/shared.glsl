// What lets one file of pure functions compile as GLSL and, through GLM, as C++ (shared.h).
// In these files write 1.0f, not 1.0; convert explicitly; pass parameters through IN, OUT and INOUT; take angles' functions
// from arithmetic.glsl.
#ifndef AIRLIGHT_SHARED_GLSL
#define AIRLIGHT_SHARED_GLSL
#define IN(type) in type
#define OUT(type) out type
#define INOUT(type) inout type
#define CONST const
#define FUNCTION
// Before a local variable: its sums and products are rounded one by one, as written, and so alike in every program. It does not reach
// into built-in functions (dot, cross) nor into functions that are called.
#define PRECISE precise
// Numbers that are not to be mixed up. They are floats here and types in C++ (shared.h), where an angle given for a cell does not
// compile; write Angle(x) and float(angle) to go from one to the other. Lengths and numbers without a unit are floats.
#define Angle float  // [rad]
#define Order float  // what angle_order gives (epipolar/space.glsl), in [0, 2]
#define Cell float   // place along an axis of the grid, in cells from its start: boundaries lie at whole numbers
#endif
