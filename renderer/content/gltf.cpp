#include "renderer/content/gltf.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "renderer/content/clusters.h"
#include "renderer/content/gltf_document.h"
#include "renderer/content/gltf_instances.h"
#include "renderer/content/gltf_materials.h"
#include "renderer/content/gltf_meshes.h"
#include "renderer/content/gltf_nodes.h"
#include "renderer/content/rig.h"

namespace cupola::content {
namespace {

using gltf::path;

/// From a checked document to a scene: everything at its place at time 0, what moves at the end.
class Assembler {
public:
  Assembler(const gltf::Document& document, const model::Gltf& wish, gltf::Report& report)
      : document_(document)
      , report_(report) {
    rig_.scale = static_cast<float>(wish.scale);
    rig_.point_size = static_cast<float>(wish.point_size.radians());
    rig_.line_width = static_cast<float>(wish.line_width.radians());
    gltf::read_nodes(document, rig_, report);
    if (!report.failed()) gltf::read_skins(document, rig_, report);
    if (!report.failed()) gltf::read_animation(document, wish.animation, rig_, report);
  }

  void assemble(Scene& scene) {
    std::vector<int> sets;
    gltf::read_materials(document_, scene, sets, report_);
    const std::vector<bool> shown = gltf::shown_nodes(document_, rig_, report_);
    if (report_.failed()) return;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const Material& m = scene.materials[i];
      needs_.push_back({sets[i], m.base_color_map.texture >= 0 || m.emissive_map.texture >= 0 ||
                                     m.normal_map.texture >= 0 || m.metallic_roughness_map.texture >= 0 ||
                                     m.occlusion_map.texture >= 0});
    }
    const std::vector<std::size_t> order = rig_.order; // the document's own nodes
    const auto instances = gltf::read_instances(document_, rig_, report_);
    for (const std::size_t node : order)
      if (shown[node]) collect(node, instances[node]);
    collect_lights(order, shown);
    if (report_.failed()) return;
    if (placed_.empty()) report_.warning("/scenes", "a mesh in the scene", "none", "Nothing is shown.");
    fill(scene);
  }

private:
  struct Placed {
    RigPart part;
    const gltf::Primitive* primitive;
    bool moves;
    std::size_t material = 0;

    [[nodiscard]] bool is_stroke() const { return part.mesh->form != Form::triangles; }
  };

  const std::vector<gltf::Primitive>& primitives(std::size_t mesh) {
    const auto known = meshes_.find(mesh);
    if (known != meshes_.end()) return known->second;
    auto read = gltf::read_mesh(document_, mesh, needs_, budget_, report_);
    return meshes_[mesh] = read ? std::move(*read) : std::vector<gltf::Primitive>{};
  }

  void collect(std::size_t node, const std::vector<std::size_t>& instances) {
    const tinygltf::Node& from = document_.model.nodes[node];
    if (from.mesh < 0 || report_.failed()) return;
    for (const gltf::Primitive& primitive : primitives(static_cast<std::size_t>(from.mesh))) {
      RigPart part{primitive.mesh, node, -1, 0};
      if (from.skin >= 0 && primitive.mesh->influences > 0) {
        const std::size_t joints = rig_.skins[static_cast<std::size_t>(from.skin)].joints.size();
        if (primitive.most_joint >= joints)
          report_.invalid(path("nodes", node, "/skin"),
                          "a skin with more than " + std::to_string(primitive.most_joint) +
                              " joints, which the mesh uses",
                          std::to_string(joints));
        part.skin = from.skin;
      } else if (from.skin >= 0) {
        report_.warning(path("nodes", node, "/skin"), "a mesh with joints and weights", "one without",
                        "It does not bend.");
      }
      if (instances.empty() && !place(part, primitive, node)) return;
      for (const std::size_t instance : instances) {
        part.node = instance;
        if (!place(part, primitive, node)) return;
      }
    }
  }

  /// False, with a problem of `node`, where there is no room for it.
  bool place(const RigPart& part, const gltf::Primitive& primitive, std::size_t node) {
    if (!budget_.take(primitive.mesh->placed_vertices(), primitive.triangles.size() / 3, 0,
                      path("nodes", node), report_))
      return false;
    placed_.push_back({part, &primitive, false, primitive.material});
    return true;
  }

  void collect_lights(const std::vector<std::size_t>& order, const std::vector<bool>& shown) {
    const std::vector<Light> lights = gltf::read_lights(document_, report_);
    for (const std::size_t node : order) {
      const auto& extensions = document_.model.nodes[node].extensions;
      const auto found = extensions.find("KHR_lights_punctual");
      if (!shown[node] || found == extensions.end() || !found->second.Has("light")) continue;
      const auto index = static_cast<std::size_t>(found->second.Get("light").GetNumberAsInt());
      if (index < lights.size()) rig_.lights.push_back({node, lights[index]});
    }
  }

  [[nodiscard]] double duration() const {
    float last = 0.0f;
    for (const RigChannel& channel : rig_.channels) last = std::max(last, channel.times.back());
    return last;
  }

  /// Which parts change, with time or with the eye; answers whether anything does, lights included.
  bool find_movement() {
    const std::vector<bool> nodes = gltf::moving_nodes(rig_);
    std::vector<bool> morphing(rig_.nodes.size(), false);
    for (const RigChannel& channel : rig_.channels)
      if (channel.path == RigPath::weights && channel.times.size() > 1) morphing[channel.node] = true;
    bool any = false;
    for (Placed& placed : placed_) {
      placed.moves = morphing[placed.part.node];
      if (placed.part.skin < 0) {
        placed.moves = placed.moves || nodes[placed.part.node];
      } else {
        for (const std::size_t joint : rig_.skins[static_cast<std::size_t>(placed.part.skin)].joints)
          placed.moves = placed.moves || nodes[joint];
      }
      placed.moves = placed.moves || placed.is_stroke();
      any = any || placed.moves;
    }
    for (const RigLight& light : rig_.lights) any = any || nodes[light.node];
    return any;
  }

  /// Points and lines have no tangents and no backs, and without normals no light falls on them [glTF 2.0,
  /// 3.7.2.1]: they get variants of their materials.
  void make_stroke_materials(Scene& scene) {
    std::map<std::pair<std::size_t, bool>, std::size_t> variants;
    for (Placed& placed : placed_) {
      if (!placed.is_stroke()) continue;
      const auto [variant, is_new] =
          variants.try_emplace({placed.material, placed.primitive->lit}, scene.materials.size());
      placed.material = variant->second;
      if (!is_new) continue;
      Material made = scene.materials[variant->first.first];
      made.double_sided = true;
      made.normal_map = {};
      if (!placed.primitive->lit) {
        made.unlit = true;
        made.metallic_roughness_map = made.occlusion_map = {};
      }
      scene.materials.push_back(std::move(made));
    }
  }

  void fill(Scene& scene) {
    make_stroke_materials(scene);
    const bool anything_moves = find_movement();
    std::stable_partition(placed_.begin(), placed_.end(), [](const Placed& placed) { return !placed.moves; });
    const RigState state = rig_state(rig_, 0.0);
    std::size_t vertices = 0;
    for (const Placed& placed : placed_) vertices += placed.part.mesh->placed_vertices();
    scene.geometry.vertices.resize(vertices);
    std::vector<std::vector<std::uint32_t>> triangles(scene.materials.size());
    std::size_t first = 0;
    bool finite = true;
    for (Placed& placed : placed_) {
      placed.part.first_vertex = first;
      place_part(rig_, state, placed.part, glm::vec3(0.0f), scene.geometry.vertices.data() + first);
      const bool mirrored = !placed.is_stroke() && is_mirrored(rig_, state, placed.part);
      const auto& corners = placed.primitive->triangles;
      auto& list = triangles[placed.material];
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        for (const std::size_t k :
             {std::size_t{0}, std::size_t{mirrored ? 2U : 1U}, std::size_t{mirrored ? 1U : 2U}})
          list.push_back(static_cast<std::uint32_t>(first) + corners[i + k]);
      const std::size_t end = first + placed.part.mesh->placed_vertices();
      for (std::size_t i = first; i < end; ++i) {
        const glm::vec3& p = scene.geometry.vertices[i].position;
        finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
      }
      first = end;
      if (placed.moves)
        rig_.parts.push_back(placed.part);
      else
        scene.static_vertices = static_cast<std::uint32_t>(end);
    }
    if (!finite) report_.invalid("/nodes", "places within the range of floats", "matrices that leave it");
    make_clusters(scene.geometry, triangles, scene.materials);
    set_scene_bounds(scene);
    for (const RigLight& light : rig_.lights) scene.lights.push_back(place_light(rig_, state, light));
    if (!anything_moves) return;
    scene.duration = duration();
    find_moving_clusters(scene);
    scene.rig = std::make_shared<Rig>(std::move(rig_));
  }

  void find_moving_clusters(const Scene& scene) {
    const Geometry& geometry = scene.geometry;
    for (std::size_t i = 0; i < geometry.clusters.size(); ++i) {
      const Cluster& cluster = geometry.clusters[i];
      const auto begin = geometry.indices.begin() + cluster.first_index;
      if (std::any_of(begin, begin + cluster.index_count,
                      [&](std::uint32_t index) { return index >= scene.static_vertices; }))
        rig_.moving_clusters.push_back(i);
    }
  }

  const gltf::Document& document_;
  gltf::Report& report_;
  Rig rig_;
  std::vector<gltf::MaterialNeed> needs_;
  std::map<std::size_t, std::vector<gltf::Primitive>> meshes_;
  std::vector<Placed> placed_;
  gltf::Budget budget_;
};

} // namespace

model::Result<LoadedScene> load_gltf(const model::Gltf& wish, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / wish.file;
  gltf::Report report(file.string());
  gltf::Container container;
  gltf::Document document;
  auto scene = std::make_shared<Scene>();
  if (gltf::read_container(file, container, report) &&
      gltf::read_document(container, file.parent_path(), document, report)) {
    Assembler assembler(document, wish, report);
    if (!report.failed()) assembler.assemble(*scene);
  }
  if (report.failed()) return tl::unexpected<model::Problems>(report.take());
  return LoadedScene{std::move(scene), report.take()};
}

} // namespace cupola::content
