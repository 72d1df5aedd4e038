#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <exception>
#include <iterator>
#include <memory>

#include "renderer/content/gltf_materials.h"

namespace cupola::content::gltf {
namespace {

using model::Code;

/// The format by its first bytes; file names and MIME types may lie.
const char* format_of(const std::vector<std::uint8_t>& bytes) {
  static constexpr std::uint8_t png[] = {0x89, 'P', 'N', 'G'};
  static constexpr std::uint8_t jpeg[] = {0xff, 0xd8, 0xff};
  if (bytes.size() > 4 && std::equal(std::begin(png), std::end(png), bytes.begin())) return "picture.png";
  if (bytes.size() > 3 && std::equal(std::begin(jpeg), std::end(jpeg), bytes.begin())) return "picture.jpg";
  return nullptr;
}

/// Grey, grey and alpha, RGB or RGBA to RGBA.
void widen(const std::vector<std::uint8_t>& texels, std::size_t channels, std::vector<std::uint8_t>& out) {
  const std::size_t count = texels.size() / channels;
  out.resize(count * 4);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* from = texels.data() + i * channels;
    std::uint8_t* to = out.data() + i * 4;
    const bool grey = channels < 3;
    to[0] = from[0];
    to[1] = grey ? from[0] : from[1];
    to[2] = grey ? from[0] : from[2];
    to[3] = channels == 2 ? from[1] : channels >= 4 ? from[3] : 255;
  }
}

} // namespace

bool decode_image(const std::vector<std::uint8_t>& bytes, const std::string& pointer, Image& out,
                  Report& report) {
  const auto broken = [&](const std::string& found) {
    report.error(Code::scene_unreadable, pointer, "a PNG or JPEG picture", found);
    return false;
  };
  const char* name = format_of(bytes);
  if (name == nullptr) return broken("another format");
  try {
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1); // as stored: glTF's alpha is not premultiplied
    void* source = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &source);
    auto input = OIIO::ImageInput::open(name, &config);
    if (!input) return broken("'" + OIIO::geterror() + "'");
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > 16384 || spec.height > 16384 ||
        spec.nchannels < 1) {
      report.error(Code::scene_limit, pointer, "a picture of at most 16384×16384",
                   std::to_string(spec.width) + "×" + std::to_string(spec.height));
      return false;
    }
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<std::uint8_t> texels(channels * static_cast<std::size_t>(spec.width) *
                                     static_cast<std::size_t>(spec.height));
    out.width = spec.width;
    out.height = spec.height;
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, texels.data()))
      return broken("'" + input->geterror() + "'");
    widen(texels, channels, out.rgba);
  } catch (const std::exception& error) { return broken("'" + std::string(error.what()) + "'"); }
  return true;
}

} // namespace cupola::content::gltf
