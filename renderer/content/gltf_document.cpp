#include "renderer/content/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <string_view>

namespace cupola::content::gltf {
namespace {

using model::Code;

constexpr std::array<std::string_view, 6> known_extensions{
    "EXT_mesh_gpu_instancing", "KHR_lights_punctual",   "KHR_materials_emissive_strength",
    "KHR_materials_unlit",     "KHR_mesh_quantization", "KHR_texture_transform"};

void check_extensions(const tinygltf::Model& model, Report& report) {
  const auto known = [](const std::string& name) {
    return std::find(known_extensions.begin(), known_extensions.end(), name) != known_extensions.end();
  };
  const auto& required = model.extensionsRequired;
  for (std::size_t i = 0; i < required.size(); ++i)
    if (!known(required[i]))
      report.error(Code::scene_unsupported, path("extensionsRequired", i), "an extension that Cupola knows",
                   "'" + required[i] + "'");
  for (std::size_t i = 0; i < model.extensionsUsed.size(); ++i) {
    const std::string& name = model.extensionsUsed[i];
    if (!known(name) && std::find(required.begin(), required.end(), name) == required.end())
      report.warning(path("extensionsUsed", i), "an extension that Cupola knows", "'" + name + "'",
                     "What it adds is left out.");
  }
}

bool parse(const std::string& json, tinygltf::Model& out, Report& report) {
  std::string errors;
  std::string warnings;
  bool good = false;
  try {
    tinygltf::TinyGLTF parser;
    good = parser.LoadASCIIFromString(&out, &errors, &warnings, json.data(),
                                      static_cast<unsigned int>(json.size()), "");
  } catch (const std::exception& error) { errors = error.what(); }
  if (good) return true;
  while (!errors.empty() && errors.back() == '\n') errors.pop_back();
  std::replace(errors.begin(), errors.end(), '\n', ' ');
  report.invalid("", "a glTF 2.0 document", errors.empty() ? "something else" : "'" + errors + "'");
  return false;
}

bool read_buffers(Container& container, const std::vector<std::string>& uris,
                  const std::vector<std::uint64_t>& lengths, Document& out, Report& report) {
  out.buffers.resize(uris.size());
  for (std::size_t i = 0; i < uris.size(); ++i) {
    std::vector<std::uint8_t>& buffer = out.buffers[i];
    if (!uris[i].empty()) {
      if (!read_uri(uris[i], out.folder, path("buffers", i, "/uri"), buffer, report)) continue;
    } else if (i == 0 && container.binary) {
      buffer = std::move(container.bytes);
    } else if (lengths[i] > 0) {
      report.error(Code::scene_unreadable, path("buffers", i, "/uri"),
                   "a URI, or the binary chunk of a GLB file", "neither");
      continue;
    }
    if (buffer.size() < lengths[i])
      report.invalid(path("buffers", i, "/byteLength"),
                     "at most the " + std::to_string(buffer.size()) + " bytes that there are",
                     std::to_string(lengths[i]));
    else
      buffer.resize(lengths[i]);
  }
  return !report.failed();
}

void check_views(const Document& document, Report& report) {
  for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
    const tinygltf::BufferView& view = document.model.bufferViews[i];
    const std::size_t size = document.buffers[static_cast<std::size_t>(view.buffer)].size();
    if (view.byteOffset > size)
      report.invalid(path("bufferViews", i, "/byteOffset"),
                     "at most the buffer's " + std::to_string(size) + " bytes",
                     std::to_string(view.byteOffset));
    else if (view.byteLength > size - view.byteOffset)
      report.invalid(path("bufferViews", i, "/byteLength"),
                     "at most " + std::to_string(size - view.byteOffset) + " bytes to the buffer's end",
                     std::to_string(view.byteLength));
  }
}

/// Where one accessor's (or its sparse part's) elements lie.
struct Slice {
  const std::uint8_t* data = nullptr;
  std::size_t stride = 0;
};

std::size_t component_size(int type) {
  switch (type) {
  case TINYGLTF_COMPONENT_TYPE_BYTE:
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    return 1;
  case TINYGLTF_COMPONENT_TYPE_SHORT:
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    return 2;
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
  case TINYGLTF_COMPONENT_TYPE_FLOAT:
    return 4;
  default:
    return 0;
  }
}

std::size_t component_count(int type) {
  switch (type) {
  case TINYGLTF_TYPE_SCALAR:
    return 1;
  case TINYGLTF_TYPE_VEC2:
    return 2;
  case TINYGLTF_TYPE_VEC3:
    return 3;
  case TINYGLTF_TYPE_VEC4:
  case TINYGLTF_TYPE_MAT2:
    return 4;
  case TINYGLTF_TYPE_MAT3:
    return 9;
  case TINYGLTF_TYPE_MAT4:
    return 16;
  default:
    return 0;
  }
}

/// Numbers that are all zero but for sparse ones cost a file nothing, but memory.
constexpr std::size_t most_unbacked = 16'000'000;

struct Stored {
  int view;
  std::size_t offset, component, element, count;
};

/// The elements lie inside their view, aligned; the problem otherwise stands at `at` + a key.
void check_slice(const Document& document, const Stored& stored, bool strided, const std::string& at,
                 const std::string& count_key, Report& report) {
  const tinygltf::BufferView& view = document.model.bufferViews[static_cast<std::size_t>(stored.view)];
  const std::size_t stride = strided && view.byteStride != 0 ? view.byteStride : stored.element;
  if (stride < stored.element) {
    report.invalid(path("bufferViews", static_cast<std::size_t>(stored.view), "/byteStride"),
                   "at least the " + std::to_string(stored.element) + " bytes of an element of " + at,
                   std::to_string(stride));
    return;
  }
  if (stored.offset % stored.component != 0 || (view.byteOffset + stored.offset) % stored.component != 0) {
    report.invalid(at + "/byteOffset",
                   "a multiple of " + std::to_string(stored.component) + ", also from the buffer's start",
                   std::to_string(stored.offset) + " (view at " + std::to_string(view.byteOffset) + ")");
    return;
  }
  if (stored.offset > view.byteLength || stored.element > view.byteLength - stored.offset) {
    report.invalid(at + "/byteOffset",
                   "an element inside the view's " + std::to_string(view.byteLength) + " bytes",
                   std::to_string(stored.offset));
    return;
  }
  const std::size_t room = (view.byteLength - stored.offset - stored.element) / stride + 1;
  if (stored.count > room)
    report.invalid(at + count_key, "at most " + std::to_string(room) + " elements, which the view holds",
                   std::to_string(stored.count));
}

Slice slice(const Document& document, int view_index, std::size_t offset, std::size_t element, bool strided) {
  const tinygltf::BufferView& view = document.model.bufferViews[static_cast<std::size_t>(view_index)];
  const auto& buffer = document.buffers[static_cast<std::size_t>(view.buffer)];
  return {buffer.data() + view.byteOffset + offset,
          strided && view.byteStride != 0 ? view.byteStride : element};
}

template <class T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

float as_float(const std::uint8_t* bytes, int type, bool normalized) {
  switch (type) {
  case TINYGLTF_COMPONENT_TYPE_BYTE: {
    const auto value = static_cast<float>(load<std::int8_t>(bytes));
    return normalized ? std::max(value / 127.0f, -1.0f) : value;
  }
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    return static_cast<float>(*bytes) / (normalized ? 255.0f : 1.0f);
  case TINYGLTF_COMPONENT_TYPE_SHORT: {
    const auto value = static_cast<float>(load<std::int16_t>(bytes));
    return normalized ? std::max(value / 32767.0f, -1.0f) : value;
  }
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    return static_cast<float>(load<std::uint16_t>(bytes)) / (normalized ? 65535.0f : 1.0f);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    return static_cast<float>(load<std::uint32_t>(bytes));
  default:
    return load<float>(bytes);
  }
}

std::uint32_t as_integer(const std::uint8_t* bytes, int type) {
  switch (type) {
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    return *bytes;
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    return load<std::uint16_t>(bytes);
  default:
    return load<std::uint32_t>(bytes);
  }
}

/// Calls put(element, component, bytes) for every stored number, the sparse ones last.
template <class Put>
void walk(const Document& document, const tinygltf::Accessor& accessor, const Put& put) {
  const std::size_t component = component_size(accessor.componentType);
  const std::size_t components = component_count(accessor.type);
  const auto element = [&](std::size_t target, const std::uint8_t* bytes) {
    for (std::size_t c = 0; c < components; ++c) put(target, c, bytes + c * component);
  };
  if (accessor.bufferView >= 0) {
    const Slice all = slice(document, accessor.bufferView, accessor.byteOffset, component * components, true);
    for (std::size_t i = 0; i < accessor.count; ++i) element(i, all.data + i * all.stride);
  }
  if (!accessor.sparse.isSparse) return;
  const auto& sparse = accessor.sparse;
  const std::size_t index_size = component_size(sparse.indices.componentType);
  const Slice where = slice(document, sparse.indices.bufferView,
                            static_cast<std::size_t>(sparse.indices.byteOffset), index_size, false);
  const Slice what = slice(document, sparse.values.bufferView,
                           static_cast<std::size_t>(sparse.values.byteOffset), component * components, false);
  for (std::size_t i = 0; i < static_cast<std::size_t>(sparse.count); ++i)
    element(as_integer(where.data + i * where.stride, sparse.indices.componentType),
            what.data + i * what.stride);
}

void check_sparse(const Document& document, const tinygltf::Accessor& accessor, const std::string& at,
                  Report& report) {
  const auto& sparse = accessor.sparse;
  const auto count = static_cast<std::size_t>(sparse.count);
  if (sparse.count < 1 || count > accessor.count) {
    report.invalid(at + "/sparse/count", "1 to " + std::to_string(accessor.count),
                   std::to_string(sparse.count));
    return;
  }
  const int type = sparse.indices.componentType;
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    report.invalid(at + "/sparse/indices/componentType", "5121, 5123 or 5125", std::to_string(type));
    return;
  }
  const std::size_t size = component_size(type);
  const std::size_t component = component_size(accessor.componentType);
  const auto offset = static_cast<std::size_t>(sparse.indices.byteOffset);
  check_slice(document, {sparse.indices.bufferView, offset, size, size, count}, false, at + "/sparse/indices",
              "", report);
  check_slice(document,
              {sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), component,
               component * component_count(accessor.type), count},
              false, at + "/sparse/values", "", report);
  if (report.failed()) return;
  const Slice where = slice(document, sparse.indices.bufferView, offset, size, false);
  std::int64_t last = -1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t index = as_integer(where.data + i * where.stride, type);
    if (index <= last || index >= static_cast<std::int64_t>(accessor.count)) {
      report.invalid(at + "/sparse/indices", "rising indices below " + std::to_string(accessor.count),
                     std::to_string(index));
      return;
    }
    last = index;
  }
}

} // namespace

void check_accessor(const Document& document, std::size_t index, Report& report) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  const std::string at = path("accessors", index);
  const std::size_t component = component_size(accessor.componentType);
  if (component == 0) {
    report.invalid(at + "/componentType", "5120 to 5123, 5125 or 5126",
                   std::to_string(accessor.componentType));
    return;
  }
  if (component_count(accessor.type) == 0) {
    report.invalid(at + "/type", "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4", "another word");
    return;
  }
  if (accessor.count < 1 || accessor.count > most_elements) {
    report.error(accessor.count < 1 ? Code::scene_invalid : Code::scene_limit, at + "/count",
                 "1 to " + std::to_string(most_elements), std::to_string(accessor.count));
    return;
  }
  if (accessor.bufferView < 0 && accessor.count * component_count(accessor.type) > most_unbacked) {
    report.error(Code::scene_limit, at + "/count",
                 "at most " + std::to_string(most_unbacked) + " numbers that no buffer holds",
                 std::to_string(accessor.count * component_count(accessor.type)));
    return;
  }
  if (accessor.bufferView >= 0)
    check_slice(document,
                {accessor.bufferView, accessor.byteOffset, component,
                 component * component_count(accessor.type), accessor.count},
                true, at, "/count", report);
  if (accessor.sparse.isSparse && !report.failed()) check_sparse(document, accessor, at, report);
}

std::optional<Numbers> read_numbers(const Document& document, int index, Report& report) {
  const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
  Numbers out;
  const std::size_t components = component_count(accessor.type);
  out.components = static_cast<int>(components);
  out.count = accessor.count;
  out.values.assign(components * accessor.count, 0.0f);
  bool finite = true;
  walk(document, accessor, [&](std::size_t element, std::size_t c, const std::uint8_t* bytes) {
    const float value = as_float(bytes, accessor.componentType, accessor.normalized);
    finite = finite && std::isfinite(value);
    out.values[element * components + c] = value;
  });
  if (finite) return out;
  report.invalid(path("accessors", static_cast<std::size_t>(index)), "finite numbers",
                 "infinity, or what is no number");
  return std::nullopt;
}

std::optional<std::vector<std::uint32_t>> read_integers(const Document& document, int index, Report& report) {
  const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
  const int type = accessor.componentType;
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    report.invalid(path("accessors", static_cast<std::size_t>(index), "/componentType"),
                   "5121, 5123 or 5125 for indices", std::to_string(type));
    return std::nullopt;
  }
  const std::size_t components = component_count(accessor.type);
  std::vector<std::uint32_t> out(components * accessor.count, 0U);
  walk(document, accessor, [&](std::size_t element, std::size_t c, const std::uint8_t* bytes) {
    out[element * components + c] = as_integer(bytes, type);
  });
  return out;
}

bool read_document(Container& container, const std::filesystem::path& folder, Document& out, Report& report) {
  std::vector<std::string> uris;
  std::vector<std::uint64_t> lengths;
  out.folder = folder;
  if (!check_json(container.json, out, uris, lengths, report)) return false;
  if (!parse(container.json, out.model, report)) return false;
  check_extensions(out.model, report);
  if (report.failed() || !read_buffers(container, uris, lengths, out, report)) return false;
  check_views(out, report);
  if (report.failed()) return false;
  for (std::size_t i = 0; i < out.model.accessors.size(); ++i) check_accessor(out, i, report);
  return !report.failed();
}

} // namespace cupola::content::gltf
