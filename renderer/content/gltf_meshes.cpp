#include "renderer/content/gltf_meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <numeric>
#include <utility>

namespace cupola::content::gltf {
namespace {

using model::Code;

class PrimitiveReader {
public:
  PrimitiveReader(const Document& document, const tinygltf::Primitive& from, std::string at, Budget& budget,
                  Report& report)
      : document_(document)
      , from_(from)
      , at_(std::move(at))
      , budget_(budget)
      , report_(report) {}

  std::optional<Primitive> read(const std::vector<MaterialNeed>& materials) {
    Primitive made;
    made.material = from_.material < 0 ? materials.size() - 1 : static_cast<std::size_t>(from_.material);
    const int position = accessor("POSITION");
    count_ = document_.model.accessors[static_cast<std::size_t>(position)].count;
    const std::size_t corners =
        from_.indices < 0 ? count_ : document_.model.accessors[static_cast<std::size_t>(from_.indices)].count;
    RigMesh mesh;
    mesh.form = form();
    const bool triangles = mesh.form == Form::triangles;
    made.lit = triangles || accessor("NORMAL") >= 0;
    mesh.flat = triangles && accessor("NORMAL") < 0;
    const std::size_t vertices = mesh.flat ? std::max(count_, corners * 3) : count_;
    if (!budget_.take(vertices, corners, vertices * from_.targets.size() * 2, at_, report_))
      return std::nullopt;
    const auto numbers = read_corners();
    if (!numbers || !(triangles ? read_triangles(*numbers, made.triangles) : read_strokes(*numbers, mesh)))
      return std::nullopt;
    mesh.vertices.resize(count_);
    fill(mesh, materials[made.material]);
    skinning(mesh, made.most_joint);
    targets(mesh);
    if (report_.failed()) return std::nullopt;
    if (mesh.flat) unshare(mesh, made.triangles);
    if (!triangles && !place_strokes(mesh, made.triangles)) return std::nullopt;
    made.mesh = std::make_shared<RigMesh>(std::move(mesh));
    return made;
  }

  [[nodiscard]] int accessor(const std::string& name) const {
    const auto found = from_.attributes.find(name);
    return found == from_.attributes.end() ? -1 : found->second;
  }

private:
  [[nodiscard]] std::string place(const std::string& name) const { return at_ + "/attributes/" + name; }

  /// An attribute's numbers when it has the right shape and as many elements as there are positions.
  std::optional<Numbers> numbers(int index, std::initializer_list<int> components, const std::string& at) {
    if (index < 0) return std::nullopt;
    const tinygltf::Accessor& accessor = document_.model.accessors[static_cast<std::size_t>(index)];
    if (accessor.count != count_) {
      report_.invalid(at, std::to_string(count_) + " elements, as many as positions",
                      std::to_string(accessor.count));
      return std::nullopt;
    }
    auto made = read_numbers(document_, index, report_);
    if (!made || std::find(components.begin(), components.end(), made->components) != components.end())
      return made;
    report_.invalid(at, "an accessor with " + std::to_string(*components.begin()) + " components",
                    std::to_string(made->components));
    return std::nullopt;
  }
  std::optional<Numbers> attribute(const std::string& name, std::initializer_list<int> components) {
    return numbers(accessor(name), components, place(name));
  }

  void fill(RigMesh& mesh, const MaterialNeed& need) {
    if (const auto position = attribute("POSITION", {3}))
      for (std::size_t i = 0; i < count_; ++i) mesh.vertices[i].position = position->vec3(i);
    for (Vertex& vertex : mesh.vertices) vertex.normal = {0.0f, 1.0f, 0.0f};
    if (const auto normal = attribute("NORMAL", {3})) {
      for (std::size_t i = 0; i < count_; ++i) {
        const glm::vec3 n = normal->vec3(i);
        if (glm::dot(n, n) > 0.0f) mesh.vertices[i].normal = glm::normalize(n);
      }
    }
    const std::string set = "TEXCOORD_" + std::to_string(need.set);
    if (const auto uv = attribute(set, {2})) {
      for (std::size_t i = 0; i < count_; ++i)
        mesh.vertices[i].uv = {uv->values[2 * i], uv->values[2 * i + 1]};
    } else if (need.textured && accessor(set) < 0) {
      report_.warning(at_ + "/attributes", "the texture coordinates " + set + ", which the material uses",
                      "none", "The texture's first corner colours the whole surface.");
    }
    if (const auto color = attribute("COLOR_0", {4, 3})) {
      for (std::size_t i = 0; i < count_; ++i) {
        std::uint32_t packed = color->components == 3 ? 0xff000000U : 0U;
        for (std::size_t c = 0; c < static_cast<std::size_t>(color->components); ++c) {
          const float value =
              std::clamp(color->values[i * static_cast<std::size_t>(color->components) + c], 0.0f, 1.0f);
          packed |= static_cast<std::uint32_t>(value * 255.0f + 0.5f) << (8 * c);
        }
        mesh.vertices[i].color = packed;
      }
    }
  }

  void skinning(RigMesh& mesh, std::uint32_t& most_joint) {
    std::size_t sets = 0;
    while (accessor("JOINTS_" + std::to_string(sets)) >= 0 &&
           accessor("WEIGHTS_" + std::to_string(sets)) >= 0)
      ++sets;
    if (sets == 0) return;
    if (sets > 2) {
      report_.warning(place("JOINTS_2"), "at most 8 joints a vertex", std::to_string(4 * sets),
                      "The others are left out.");
      sets = 2;
    }
    mesh.influences = 4 * sets;
    mesh.skinning.assign(count_ * mesh.influences, {0, 0.0f});
    for (std::size_t set = 0; set < sets; ++set) {
      const std::string joints_name = "JOINTS_" + std::to_string(set);
      const auto weights = attribute("WEIGHTS_" + std::to_string(set), {4});
      if (!attribute(joints_name, {4}) || !weights) return;
      const auto joints = read_integers(document_, accessor(joints_name), report_);
      if (!joints) return;
      for (std::size_t i = 0; i < count_; ++i)
        for (std::size_t k = 0; k < 4; ++k)
          mesh.skinning[i * mesh.influences + 4 * set + k] = {(*joints)[4 * i + k],
                                                              std::max(weights->values[4 * i + k], 0.0f)};
    }
    normalise(mesh, most_joint);
  }

  /// Weights of a vertex sum to 1; without any weight it follows its first joint.
  void normalise(RigMesh& mesh, std::uint32_t& most_joint) const {
    for (std::size_t i = 0; i < count_; ++i) {
      RigInfluence* own = mesh.skinning.data() + i * mesh.influences;
      float sum = 0.0f;
      for (std::size_t k = 0; k < mesh.influences; ++k) sum += own[k].weight;
      if (!(sum > 0.0f)) own[0].weight = sum = 1.0f;
      for (std::size_t k = 0; k < mesh.influences; ++k) {
        own[k].weight /= sum;
        if (own[k].weight != 0.0f) most_joint = std::max(most_joint, own[k].joint);
      }
    }
  }

  void targets(RigMesh& mesh) {
    for (std::size_t t = 0; t < from_.targets.size(); ++t) {
      RigMesh::Target made;
      for (const auto& [name, index] : from_.targets[t]) {
        const std::string at = at_ + "/targets/" + std::to_string(t) + '/' + name;
        if (name != "POSITION" && name != "NORMAL") {
          if (name != "TANGENT")
            report_.warning(at, "morph targets of POSITION and NORMAL", name, "It stays as it is.");
          continue;
        }
        const auto offsets = numbers(index, {3}, at);
        if (!offsets) continue;
        auto& list = name == "POSITION" ? made.positions : made.normals;
        for (std::size_t i = 0; i < count_; ++i) list.push_back(offsets->vec3(i));
      }
      mesh.targets.push_back(std::move(made));
    }
  }

  [[nodiscard]] Form form() const {
    switch (from_.mode) {
    case TINYGLTF_MODE_POINTS:
      return Form::points;
    case TINYGLTF_MODE_LINE:
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP:
      return Form::lines;
    default:
      return Form::triangles;
    }
  }

  /// Numbers of the vertices in the order in which the primitive uses them.
  std::optional<std::vector<std::uint32_t>> read_corners() {
    if (from_.indices < 0) {
      std::vector<std::uint32_t> corners(count_);
      std::iota(corners.begin(), corners.end(), 0U);
      return corners;
    }
    auto corners = read_integers(document_, from_.indices, report_);
    if (!corners) return std::nullopt;
    if (document_.model.accessors[static_cast<std::size_t>(from_.indices)].type != TINYGLTF_TYPE_SCALAR) {
      report_.invalid(at_ + "/indices", "an accessor of type SCALAR", "another type");
      return std::nullopt;
    }
    const auto most = std::max_element(corners->begin(), corners->end());
    if (most != corners->end() && *most >= count_) {
      report_.invalid(at_ + "/indices", "indices below the " + std::to_string(count_) + " vertices",
                      std::to_string(*most));
      return std::nullopt;
    }
    return corners;
  }

  /// A problem unless the corners are whole groups of `size`.
  bool whole(std::size_t corners, std::size_t size, const char* expected) {
    if (corners % size == 0) return true;
    report_.invalid(at_ + (from_.indices < 0 ? "/attributes/POSITION" : "/indices"), expected,
                    std::to_string(corners) + " corners");
    return false;
  }

  bool read_strokes(const std::vector<std::uint32_t>& corners, RigMesh& mesh) {
    const std::size_t count = corners.size();
    if (mesh.form == Form::points) {
      mesh.strokes = corners;
      return true;
    }
    const bool separate = from_.mode == TINYGLTF_MODE_LINE;
    if (separate && !whole(count, 2, "two ends a line")) return false;
    const auto add = [&](std::size_t a, std::size_t b) { // none without length
      if (corners[a] != corners[b]) mesh.strokes.insert(mesh.strokes.end(), {corners[a], corners[b]});
    };
    for (std::size_t i = 0; i + 1 < count; i += separate ? 2 : 1) add(i, i + 1);
    if (from_.mode == TINYGLTF_MODE_LINE_LOOP && count > 2) add(count - 1, 0);
    return true;
  }

  bool place_strokes(const RigMesh& mesh, std::vector<std::uint32_t>& triangles) {
    const std::size_t count = mesh.stroke_count();
    if (!budget_.take(mesh.placed_vertices(), count * stroke_triangles(mesh.form), 0, at_, report_))
      return false;
    triangles = stroke_corners(mesh.form, count);
    return true;
  }

  bool read_triangles(const std::vector<std::uint32_t>& corners, std::vector<std::uint32_t>& out) {
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) { // none without area
      if (corners[a] != corners[b] && corners[b] != corners[c] && corners[a] != corners[c])
        out.insert(out.end(), {corners[a], corners[b], corners[c]});
    };
    const std::size_t count = corners.size();
    if (from_.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
      for (std::size_t i = 0; i + 2 < count; ++i) add(i, i + 1 + i % 2, i + 2 - i % 2);
    } else if (from_.mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      for (std::size_t i = 1; i + 1 < count; ++i) add(i, i + 1, 0);
    } else {
      if (!whole(count, 3, "three corners a triangle")) return false;
      for (std::size_t i = 0; i + 2 < count; i += 3) add(i, i + 1, i + 2);
    }
    return true;
  }

  /// Every triangle gets vertices of its own, as flat shading needs.
  static void unshare(RigMesh& mesh, std::vector<std::uint32_t>& corners) {
    RigMesh apart;
    apart.flat = true;
    apart.influences = mesh.influences;
    apart.targets.resize(mesh.targets.size());
    apart.vertices.reserve(corners.size());
    for (const std::uint32_t corner : corners) {
      apart.vertices.push_back(mesh.vertices[corner]);
      for (std::size_t k = 0; k < mesh.influences; ++k)
        apart.skinning.push_back(mesh.skinning[corner * mesh.influences + k]);
      for (std::size_t t = 0; t < mesh.targets.size(); ++t)
        if (!mesh.targets[t].positions.empty())
          apart.targets[t].positions.push_back(mesh.targets[t].positions[corner]);
    }
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint32_t>(i);
    mesh = std::move(apart);
  }

  const Document& document_;
  const tinygltf::Primitive& from_;
  std::string at_;
  Budget& budget_;
  Report& report_;
  std::size_t count_ = 0;
};

} // namespace

bool Budget::take(std::size_t more_vertices, std::size_t more_triangles, std::size_t more_offsets,
                  const std::string& at, Report& report) {
  vertices += more_vertices;
  triangles += more_triangles;
  offsets += more_offsets;
  if (vertices <= most_elements && triangles <= most_elements && offsets <= 2 * most_elements) return true;
  report.error(Code::scene_limit, at,
               "a scene of at most " + std::to_string(most_elements) +
                   " vertices and triangles, morph targets included",
               "more");
  return false;
}

std::optional<std::vector<Primitive>> read_mesh(const Document& document, std::size_t index,
                                                const std::vector<MaterialNeed>& materials, Budget& budget,
                                                Report& report) {
  const tinygltf::Mesh& mesh = document.model.meshes[index];
  std::vector<Primitive> made;
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const tinygltf::Primitive& from = mesh.primitives[i];
    const std::string at = path("meshes", index, "/primitives/") + std::to_string(i);
    const int mode = from.mode < 0 ? TINYGLTF_MODE_TRIANGLES : from.mode;
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) {
      report.invalid(at + "/mode", "0 to 6", std::to_string(mode));
      continue;
    }
    if (from.targets.size() != mesh.primitives.front().targets.size())
      report.invalid(at + "/targets", "as many morph targets as the mesh's first primitive has",
                     std::to_string(from.targets.size()));
    PrimitiveReader reader(document, from, at, budget, report);
    if (reader.accessor("POSITION") < 0) {
      report.warning(at + "/attributes", "POSITION", "none", "The primitive is left out.");
      continue;
    }
    if (auto primitive = reader.read(materials)) made.push_back(std::move(*primitive));
  }
  if (report.failed()) return std::nullopt;
  return made;
}

} // namespace cupola::content::gltf
