// Generated deformations of a flat picture: where each point of it moves to. Smooth, parametric, pure.
//
// They act one after the other, each about its centre, in lengths of half the shorter side, so that circles
// are round in a picture of square pixels. With d the distance from the centre over the radius:
// - zoom: moves along the radius, ρ (1 + strength e^(-d²)): a fisheye's bulge that bends the whole picture;
// - swirl: turns by angle e^(-d²), counter-clockwise;
// - lens: ρ (1 + strength w(d)) with w from 1 in the centre to 0 at the radius, even in its second
// derivative;
//   outside the radius nothing moves;
// - ripple: ρ + amplitude sin(2π ρ / wavelength) e^(-d²).
// Beyond some strength the picture folds: a zoom of 2.24, a lens of 1.4, an amplitude of wavelength / 2π.
#pragma once

#include <glm/vec2.hpp>

#include "configs/model/show.h"

namespace cupola::projection {

/// One deformation of an image point. `circle`: image coordinates times it are lengths of half the shorter
/// side.
[[nodiscard]] glm::dvec2 deformed(const model::Deformation& deformation, glm::dvec2 st, glm::dvec2 circle);

} // namespace cupola::projection
