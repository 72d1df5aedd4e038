// Brings a vertex of the scene onto the screen, in one of four ways:
//   DIRECT      one perspective for the whole draw: a perspective view, a face of a cubemap, one strip
//   LAYERED     six perspectives, one per instance and layer: all faces of a cubemap
//   EMITTED     already distributed and projected by the CPU; SCISSORS: a scissor for each strip of a group
//   REPLICATED  fetched for one (triangle, piece) pair of the GPU's list, clipped by the piece's planes
// PULLED (with DIRECT or LAYERED): corners are fetched by number, so that edges can be told apart (wireframe).
#if defined(CUPOLA_LAYERED) || defined(CUPOLA_SCISSORS)
#extension GL_ARB_shader_viewport_layer_array : require
#endif
#include "renderer/shaders/frame.glsl"
#include "renderer/passes/pull.glsl"
#include "renderer/passes/pairs.glsl"

out vec3 v_offset; // from the eye, world axes, metres
out vec3 v_normal;
out vec2 v_uv;
out vec4 v_color;
#ifdef CUPOLA_EDGES
out vec3 v_corner; // barycentric coordinates in the scene's own triangle
#endif

#ifdef CUPOLA_EMITTED
layout(location = 0) in vec4 in_position; // x, y, scissor, w
layout(location = 1) in vec3 in_offset;
layout(location = 2) in vec3 in_normal;
layout(location = 3) in vec2 in_uv;
layout(location = 4) in vec4 in_color;
layout(location = 5) in vec2 in_corner;
#elif !defined(CUPOLA_PULL)
layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec2 in_uv;
layout(location = 3) in vec4 in_color;
#endif

#if defined(CUPOLA_DIRECT)
layout(location = 0) uniform mat3 to_screen;
#elif defined(CUPOLA_LAYERED)
layout(location = 0) uniform mat3 to_screen[6];
layout(location = 6) uniform int layers[6];
#endif

#ifdef CUPOLA_REPLICATED
out float gl_ClipDistance[3];
#ifdef CUPOLA_DOUBLE_SIDED
flat out uint v_back; // pieces may mirror: what the rasteriser finds of facing does not count
#endif
#endif

void main() {
#ifdef CUPOLA_EMITTED
  v_offset = in_offset;
  v_normal = in_normal;
  v_uv = in_uv;
  v_color = in_color;
#ifdef CUPOLA_EDGES
  v_corner = vec3(in_corner, 1.0 - in_corner.x - in_corner.y);
#endif
  gl_Position = vec4(in_position.xy, frame.eye_near.w, in_position.w);
#ifdef CUPOLA_SCISSORS
  gl_ViewportIndex = int(in_position.z);
#endif
#else

#ifdef CUPOLA_PULL
#ifdef CUPOLA_REPLICATED
  Pair pair = pulled_pair(uint(gl_VertexID) / 3u, uint(gl_InstanceID));
  uint triangle = pair.triangle;
#else
  uint triangle = uint(gl_VertexID) / 3u;
#endif
  uint corner = uint(gl_VertexID) % 3u;
  PulledVertex pulled = pull_vertex(indices[triangle * 3u + corner]);
  v_offset = pulled.position - frame.eye_near.xyz;
  v_normal = pulled.normal;
  v_uv = pulled.uv;
  v_color = pulled.color;
#ifdef CUPOLA_EDGES
  v_corner = vec3(corner == 0u, corner == 1u, corner == 2u);
#endif
#else
  v_offset = in_position - frame.eye_near.xyz;
  v_normal = in_normal;
  v_uv = in_uv;
  v_color = in_color;
#endif

  vec3 v = frame.view_from_world * v_offset;
#if defined(CUPOLA_DIRECT)
  vec3 h = to_screen * v;
#elif defined(CUPOLA_LAYERED)
  vec3 h = to_screen[gl_InstanceID] * v;
  gl_Layer = layers[gl_InstanceID];
  gl_ViewportIndex = layers[gl_InstanceID];
#elif defined(CUPOLA_REPLICATED)
  vec3 h = pieces[pair.piece].to_screen * v;
  gl_ClipDistance[0] = clip_distance(pieces[pair.piece].planes[0], v, h.z);
  gl_ClipDistance[1] = clip_distance(pieces[pair.piece].planes[1], v, h.z);
  gl_ClipDistance[2] = clip_distance(pieces[pair.piece].planes[2], v, h.z);
#ifdef CUPOLA_DOUBLE_SIDED
  v_back = pair.back ? 1u : 0u;
#else
  if (pair.back) gl_ClipDistance[0] = -1.0; // all three corners: nothing is left
#endif
#endif
  // Reversed depth near / w: one convention for every piece and face.
  gl_Position = vec4(h.xy, frame.eye_near.w, h.z);
#endif
}
