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
#endif
