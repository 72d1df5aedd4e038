// What all programs of a frame share: the eye, the light, the style. Twin of FrameBlock in passes/frame_block.h.

const int max_lights = 16;

struct PunctualLight {
  vec4 position_range;  // world metres; range 0: unbounded
  vec4 direction_kind;  // in which it shines; w: 0 directional, 1 point, 2 spot
  vec4 radiance;        // rgb
  vec4 cone;            // cosines of the inner and outer half angle
};

layout(std140, binding = 0) uniform FrameBlock {
  vec4 eye_near;        // world metres; w: near distance
  mat3 view_from_world; // view axes
  vec4 sun_direction;   // towards the sun, world
  vec4 sun_color;
  vec4 zenith;
  vec4 ground;
  vec4 fog;             // rgb, density per metre
  vec4 style;           // line width, line spacing: output pixels; line fade: metres
  ivec4 counts;         // x: lights
  PunctualLight lights[max_lights];
} frame;
