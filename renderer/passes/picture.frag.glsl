// A finished picture over the whole viewport, texel for pixel where the sizes agree.

in vec2 v_st;

layout(binding = 0) uniform sampler2D picture;

layout(location = 0) out vec4 out_color;

void main() {
  ivec2 size = textureSize(picture, 0);
  ivec2 texel = clamp(ivec2((v_st * 0.5 + 0.5) * vec2(size)), ivec2(0), size - 1);
  out_color = vec4(texelFetch(picture, texel, 0).rgb, 1.0);
}
