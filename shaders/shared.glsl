// What lets one file of pure functions compile as GLSL and, through GLM, as C++ (shared.h).
// In these files write 1.0f, not 1.0; convert explicitly; pass parameters through IN, OUT and INOUT.
#ifndef AIRLIGHT_SHARED_GLSL
#define AIRLIGHT_SHARED_GLSL
#define IN(type) in type
#define OUT(type) out type
#define INOUT(type) inout type
#define CONST const
#define FUNCTION
#endif
