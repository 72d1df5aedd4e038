// Reading the GPU engine's list in the vertex program.

#ifdef CUPOLA_REPLICATED
#include "renderer/passes/replication.glsl"

/// The pair that a vertex of the indirect draw belongs to. After an overflow the list is not used: items are
/// then triangles and instances are pieces.
uvec2 pulled_pair(uint item, uint instance) {
  if (control.overflowed == 0u) return pairs[item];
  return uvec2(item, instance);
}
#endif
