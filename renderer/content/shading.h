// shading.glsl as C++, float precision: what the shaders compute, for the reference method and for tests.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace cupola::content::shading {
using namespace glm;
#define CUPOLA_FN inline
#include "renderer/content/shading.glsl"
#undef CUPOLA_FN
} // namespace cupola::content::shading
