#ifndef PICTURE_GLSL
#define PICTURE_GLSL
#include "skitter/records.h"
#include "render/bindings.h"
#include "render/picture.h"

layout(std140, set = 0, binding = DRAW_PICTURE) uniform PictureBlock { Picture picture; };

#endif
