#include "tests/renderer/content/gltf_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <cstring>
#include <fstream>
#include <system_error>
#include <unistd.h>

namespace cupola::content {
namespace {

std::size_t components(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "MAT4") return 16;
  return static_cast<std::size_t>(type[3] - '0');
}

void put_word(std::vector<std::uint8_t>& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

} // namespace

std::filesystem::path gltf_folder() {
  struct Folder { // goes with the program
    std::filesystem::path path =
        std::filesystem::path(CUPOLA_BINARY_DIR) / "tests" / ("gltf-" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

std::filesystem::path write_bytes(const std::string& name, const std::vector<std::uint8_t>& bytes) {
  std::filesystem::path file = gltf_folder() / name;
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t held = static_cast<std::uint32_t>(bytes[i]) << 16;
    if (i + 1 < bytes.size()) held |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
    if (i + 2 < bytes.size()) held |= bytes[i + 2];
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : letters[held >> (18 - 6 * k) & 63];
  }
  return out;
}

std::vector<std::uint8_t> png(const std::vector<std::uint8_t>& rgb) {
  OIIO::Filesystem::IOVecOutput memory;
  void* target = &memory;
  OIIO::ImageSpec spec(static_cast<int>(rgb.size() / 3), 1, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &target);
  auto output = OIIO::ImageOutput::create("picture.png");
  output->open("picture.png", spec);
  output->write_image(OIIO::TypeDesc::UINT8, rgb.data());
  output->close();
  return memory.buffer();
}

GltfFile::GltfFile() {
  json["asset"] = {{"version", "2.0"}};
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"nodes", Json::array()}}});
}

int GltfFile::add(const char* list, Json item) {
  if (!json.contains(list)) json[list] = Json::array();
  json[list].push_back(std::move(item));
  return static_cast<int>(json[list].size()) - 1;
}

int GltfFile::view(const void* data, std::size_t size) {
  while (buffer_.size() % 4 != 0) buffer_.push_back(0);
  const std::size_t offset = buffer_.size();
  buffer_.resize(offset + size);
  std::memcpy(buffer_.data() + offset, data, size);
  return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
}

int GltfFile::accessor(const void* data, std::size_t size, int component, std::size_t bytes,
                       std::size_t count, const char* type, bool normalized) {
  Json made{{"bufferView", view(data, size * bytes)},
            {"componentType", component},
            {"count", count},
            {"type", type}};
  if (normalized) made["normalized"] = true;
  return add("accessors", std::move(made));
}

int GltfFile::floats(const std::vector<float>& values, const char* type) {
  return accessor(values.data(), values.size(), 5126, 4, values.size() / components(type), type, false);
}
int GltfFile::bytes(const std::vector<std::uint8_t>& values, const char* type, bool normalized) {
  return accessor(values.data(), values.size(), 5121, 1, values.size() / components(type), type, normalized);
}
int GltfFile::shorts(const std::vector<std::uint16_t>& values, const char* type, bool normalized) {
  return accessor(values.data(), values.size(), 5123, 2, values.size() / components(type), type, normalized);
}
int GltfFile::words(const std::vector<std::uint32_t>& values, const char* type) {
  return accessor(values.data(), values.size(), 5125, 4, values.size() / components(type), type, false);
}

int GltfFile::show(Json primitive, Json node) {
  node["mesh"] = add("meshes", {{"primitives", Json::array({std::move(primitive)})}});
  const int index = add("nodes", std::move(node));
  json["scenes"][0]["nodes"].push_back(index);
  return index;
}

std::filesystem::path GltfFile::write(const std::string& name) const {
  Json whole = json;
  if (!whole.contains("buffers") && !buffer_.empty())
    whole["buffers"] = Json::array({{{"byteLength", buffer_.size()},
                                     {"uri", "data:application/octet-stream;base64," + base64(buffer_)}}});
  const std::string text = whole.dump(1);
  return write_bytes(name, {text.begin(), text.end()});
}

std::vector<std::uint8_t> GltfFile::glb() const {
  Json whole = json;
  whole["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
  std::string text = whole.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<std::uint8_t> data = buffer_;
  data.resize((data.size() + 3) / 4 * 4);
  std::vector<std::uint8_t> out{'g', 'l', 'T', 'F'};
  put_word(out, 2);
  put_word(out, 12 + 8 + text.size() + 8 + data.size());
  put_word(out, text.size());
  put_word(out, 0x4e4f534a);
  out.insert(out.end(), text.begin(), text.end());
  put_word(out, data.size());
  put_word(out, 0x004e4942);
  out.insert(out.end(), data.begin(), data.end());
  return out;
}

model::Result<LoadedScene> load(const std::filesystem::path& file, const std::string& animation,
                                double scale) {
  model::Gltf wish;
  wish.file = file.filename().string();
  wish.animation = animation;
  wish.scale = scale;
  return load_scene(wish, file.parent_path());
}

model::Result<LoadedScene> load(const GltfFile& file, const std::string& animation, double scale) {
  return load(file.write("made.gltf"), animation, scale);
}

} // namespace cupola::content
