#include "renderer/content/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

namespace cupola::content::gltf {
namespace {

using model::Code;

double number(const tinygltf::Value& object, const char* key, double fallback) {
  if (!object.IsObject() || !object.Has(key)) return fallback;
  const tinygltf::Value& value = object.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : fallback;
}

double element(const tinygltf::Value& object, const char* key, std::size_t index, double fallback) {
  if (!object.IsObject() || !object.Has(key)) return fallback;
  const tinygltf::Value& list = object.Get(key);
  if (!list.IsArray() || list.ArrayLen() <= index || !list.Get(static_cast<int>(index)).IsNumber())
    return fallback;
  return list.Get(static_cast<int>(index)).GetNumberAsDouble();
}

/// One texture of a material as the file has it.
struct Reference {
  int texture = -1;
  int set = 0;
  glm::mat3 transform{1.0f};
};

template <class Info>
Reference reference(const Info& info) {
  Reference made;
  made.texture = info.index;
  made.set = info.texCoord;
  const auto found = info.extensions.find("KHR_texture_transform");
  if (found == info.extensions.end()) return made;
  const tinygltf::Value& value = found->second;
  made.set = static_cast<int>(number(value, "texCoord", made.set));
  const double turn = number(value, "rotation", 0.0);
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  const double su = element(value, "scale", 0, 1.0);
  const double sv = element(value, "scale", 1, 1.0);
  // translation · rotation (counter-clockwise as the image is seen, v down) · scale
  made.transform =
      glm::mat3(glm::vec3(c * su, -s * su, 0.0), glm::vec3(s * sv, c * sv, 0.0),
                glm::vec3(element(value, "offset", 0, 0.0), element(value, "offset", 1, 0.0), 1.0));
  return made;
}

Wrap wrap_of(int code, const std::string& at, Report& report) {
  switch (code) {
  case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
    return Wrap::clamp;
  case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
    return Wrap::mirror;
  case TINYGLTF_TEXTURE_WRAP_REPEAT:
    return Wrap::repeat;
  default:
    report.invalid(at, "10497, 33071 or 33648", std::to_string(code));
    return Wrap::repeat;
  }
}

class Reader {
public:
  Reader(const Document& document, Scene& scene, Report& report)
      : document_(document)
      , scene_(scene)
      , report_(report) {}

  /// The scene's texture for a use of the file's; colour and data need images of their own.
  int texture(int index, bool srgb) {
    const auto known = textures_.find({index, srgb});
    if (known != textures_.end()) return known->second;
    const tinygltf::Texture& from = document_.model.textures[static_cast<std::size_t>(index)];
    const std::string at = path("textures", static_cast<std::size_t>(index));
    Texture made;
    if (from.source < 0)
      report_.error(Code::scene_unsupported, at + "/source", "a PNG or JPEG image", "none");
    else
      made.image = image(from.source, srgb);
    if (from.sampler >= 0) {
      const tinygltf::Sampler& sampler = document_.model.samplers[static_cast<std::size_t>(from.sampler)];
      const std::string place = path("samplers", static_cast<std::size_t>(from.sampler));
      made.wrap_s = wrap_of(sampler.wrapS, place + "/wrapS", report_);
      made.wrap_t = wrap_of(sampler.wrapT, place + "/wrapT", report_);
      made.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
      made.mipmaps = sampler.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST &&
                     sampler.minFilter != TINYGLTF_TEXTURE_FILTER_LINEAR;
    }
    scene_.textures.push_back(made);
    return textures_[{index, srgb}] = static_cast<int>(scene_.textures.size()) - 1;
  }

  /// `kept`: the set of texture coordinates that the material's vertices carry.
  TextureUse use(const Reference& from, bool srgb, int kept, const std::string& at) {
    TextureUse made;
    if (from.texture < 0) return made;
    if (from.set != kept) {
      report_.warning(at + "/texCoord",
                      "all textures of a material on one set of coordinates (" + std::to_string(kept) + ")",
                      std::to_string(from.set), "This texture is left out.");
      return made;
    }
    made.texture = texture(from.texture, srgb);
    made.transform = from.transform;
    return made;
  }

private:
  int image(int source, bool srgb) {
    const auto known = images_.find({source, srgb});
    if (known != images_.end()) return known->second;
    const auto other = images_.find({source, !srgb});
    Image made;
    if (other != images_.end()) {
      made = scene_.images[static_cast<std::size_t>(other->second)];
    } else {
      decode(source, made);
    }
    made.srgb = srgb;
    scene_.images.push_back(std::move(made));
    return images_[{source, srgb}] = static_cast<int>(scene_.images.size()) - 1;
  }

  void decode(int source, Image& made) {
    const ImageSource& from = document_.images[static_cast<std::size_t>(source)];
    const std::string at = path("images", static_cast<std::size_t>(source));
    made.name = from.uri.starts_with("data:") || from.uri.empty() ? at : from.uri;
    std::vector<std::uint8_t> bytes;
    if (!from.uri.empty()) {
      if (!read_uri(from.uri, document_.folder, at + "/uri", bytes, report_)) return;
    } else if (from.view >= 0) {
      const tinygltf::BufferView& view = document_.model.bufferViews[static_cast<std::size_t>(from.view)];
      const auto& buffer = document_.buffers[static_cast<std::size_t>(view.buffer)];
      const auto begin = buffer.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
      bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(view.byteLength));
    } else {
      report_.invalid(at, "a uri or a bufferView", "neither");
      return;
    }
    if (!decode_image(bytes, at, made, report_)) return;
    decoded_ += made.rgba.size();
    if (decoded_ > most_bytes)
      report_.error(Code::scene_limit, "/images", "at most 4 GiB of decoded pictures", "more");
  }

  static constexpr std::size_t most_bytes = std::size_t{4} << 30;

  const Document& document_;
  Scene& scene_;
  Report& report_;
  std::map<std::pair<int, bool>, int> images_, textures_;
  std::size_t decoded_ = 0;
};

AlphaMode alpha_mode(const tinygltf::Material& from, const std::string& at, Report& report) {
  if (from.alphaMode == "MASK") return AlphaMode::mask;
  if (from.alphaMode == "BLEND") return AlphaMode::blend;
  if (from.alphaMode != "OPAQUE")
    report.invalid(at + "/alphaMode", "OPAQUE, MASK or BLEND", "'" + from.alphaMode + "'");
  return AlphaMode::opaque;
}

Material factors(const tinygltf::Material& from, const std::string& at, Report& report) {
  Material made;
  made.name = from.name;
  const auto& pbr = from.pbrMetallicRoughness;
  for (int c = 0; c < 4; ++c)
    if (pbr.baseColorFactor.size() == 4)
      made.base_color[c] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(c)]);
  for (int c = 0; c < 3; ++c)
    if (from.emissiveFactor.size() == 3)
      made.emissive[c] = static_cast<float>(from.emissiveFactor[static_cast<std::size_t>(c)]);
  const auto strength = from.extensions.find("KHR_materials_emissive_strength");
  if (strength != from.extensions.end())
    made.emissive *= static_cast<float>(number(strength->second, "emissiveStrength", 1.0));
  made.metallic = static_cast<float>(std::clamp(pbr.metallicFactor, 0.0, 1.0));
  made.roughness = static_cast<float>(std::clamp(pbr.roughnessFactor, 0.0, 1.0));
  made.normal_scale = static_cast<float>(from.normalTexture.scale);
  made.occlusion_strength = static_cast<float>(std::clamp(from.occlusionTexture.strength, 0.0, 1.0));
  made.alpha_mode = alpha_mode(from, at, report);
  made.alpha_cutoff = static_cast<float>(from.alphaCutoff);
  made.double_sided = from.doubleSided;
  made.unlit = from.extensions.count("KHR_materials_unlit") > 0;
  if (made.unlit) made.emissive = glm::vec3(0.0f);
  return made;
}

} // namespace

void read_materials(const Document& document, Scene& scene, std::vector<int>& sets, Report& report) {
  Reader reader(document, scene, report);
  for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
    const tinygltf::Material& from = document.model.materials[i];
    const std::string at = path("materials", i);
    Material made = factors(from, at, report);
    const Reference base = reference(from.pbrMetallicRoughness.baseColorTexture);
    const Reference rough = reference(from.pbrMetallicRoughness.metallicRoughnessTexture);
    const Reference normal = reference(from.normalTexture);
    const Reference occlusion = reference(from.occlusionTexture);
    const Reference emissive = reference(from.emissiveTexture);
    int set = 0;
    for (const Reference* one :
         {&occlusion, &rough, &normal, &emissive, &base}) // the last one present decides
      if (one->texture >= 0) set = one->set;
    sets.push_back(set);
    made.base_color_map = reader.use(base, true, set, at + "/pbrMetallicRoughness/baseColorTexture");
    if (!made.unlit) { // an unlit material is its base colour alone
      made.metallic_roughness_map =
          reader.use(rough, false, set, at + "/pbrMetallicRoughness/metallicRoughnessTexture");
      made.normal_map = reader.use(normal, false, set, at + "/normalTexture");
      made.occlusion_map = reader.use(occlusion, false, set, at + "/occlusionTexture");
      made.emissive_map = reader.use(emissive, true, set, at + "/emissiveTexture");
    }
    scene.materials.push_back(std::move(made));
  }
  Material fallback;
  fallback.name = "default";
  fallback.metallic = 1.0f;
  scene.materials.push_back(fallback);
  sets.push_back(0);
}

std::vector<Light> read_lights(const Document& document, Report& report) {
  std::vector<Light> lights;
  for (std::size_t i = 0; i < document.model.lights.size(); ++i) {
    const tinygltf::Light& from = document.model.lights[i];
    const std::string at = path("extensions/KHR_lights_punctual/lights", i);
    Light made;
    if (from.type == "point")
      made.kind = LightKind::point;
    else if (from.type == "spot")
      made.kind = LightKind::spot;
    else if (from.type != "directional")
      report.invalid(at + "/type", "directional, point or spot", "'" + from.type + "'");
    for (int c = 0; c < 3; ++c)
      if (from.color.size() == 3)
        made.radiance[c] = static_cast<float>(from.color[static_cast<std::size_t>(c)]);
    made.radiance *= static_cast<float>(from.intensity);
    made.range = static_cast<float>(std::max(0.0, from.range));
    if (made.kind == LightKind::spot) {
      const double inner = from.spot.innerConeAngle;
      const double outer = from.spot.outerConeAngle;
      if (!(inner >= 0.0 && inner <= outer && outer <= 1.5708))
        report.invalid(at + "/spot", "0 <= innerConeAngle < outerConeAngle <= pi/2",
                       std::to_string(inner) + " and " + std::to_string(outer));
      made.cos_inner = static_cast<float>(std::cos(inner));
      made.cos_outer = static_cast<float>(std::cos(outer));
    }
    lights.push_back(made);
  }
  return lights;
}

} // namespace cupola::content::gltf
