// Pixels that are shaded though nothing of them will be seen. llvmpipe leaves out what lies behind or outside a triangle
// only without multisampling; with it, whole blocks are shaded. Far outside its triangle a texture coordinate that is
// extrapolated in perspective changes without bound, and an anisotropic filter averages thousands of texels there.
// So a quad of which no sample is left looks its textures up in one place. The picture stays the same.
#ifdef CUPOLA_UNCOVERED
#if defined(GL_ARB_post_depth_coverage) && !defined(CUPOLA_MASK)
// What is hidden counts as uncovered. It makes the depth test early, which a material that discards cannot have.
#extension GL_ARB_post_depth_coverage : require
layout(post_depth_coverage) in;
#endif

bool uncovered_quad() {
  float left = gl_SampleMaskIn[0] != 0 ? 1.0 : 0.0;
  float in_row = left + abs(dFdxFine(left));
  return in_row + abs(dFdyFine(in_row)) == 0.0;
}
#else
bool uncovered_quad() { return false; }
#endif
