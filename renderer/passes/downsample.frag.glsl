// Averages k × k pixels in linear light: what supersampling drew becomes output pixels.

layout(binding = 0) uniform sampler2D drawn;
layout(location = 0) uniform int factor;

layout(location = 0) out vec4 out_color;

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * factor;
  vec4 sum = vec4(0.0);
  for (int y = 0; y < factor; ++y)
    for (int x = 0; x < factor; ++x) sum += texelFetch(drawn, corner + ivec2(x, y), 0);
  out_color = sum / float(factor * factor);
}
