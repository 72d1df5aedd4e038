// How often the CPU engines send a triangle, against how often they must: pairs (triangle, piece) counted
// slowly and exactly. Nothing hides here, so that distribution alone is measured.
#include <doctest/doctest.h>

#include <glm/matrix.hpp>
#include <string>
#include <vector>

#include "renderer/content/scene.h"
#include "renderer/passes/cells.h"
#include "renderer/passes/distribute.h"
#include "tests/renderer/passes/exact_pairs.h"

using namespace cupola;
using tests::exact_pairs;

namespace {

constexpr int width = 640, height = 480;
constexpr float near = 0.05f;

struct Case {
  std::string name;
  model::Shape shape;
  double most; ///< pairs, over the exact minimum
};

std::vector<Case> cases() {
  model::CameraTexture texture;
  texture.columns = 32;
  texture.rows = 24;
  texture.deformations["bulge"] = {model::RadialZoom{0.6}, 0.0, 0.0, 0.9, 0};
  texture.deformations["turn"] = {model::Swirl{{60.0}}, 0.0, 0.0, 0.8, 1};
  return {{"cylinder", model::Cylinder{{360.0}, {134.0}}, 1.10},
          {"cylinder of 200 degrees", model::Cylinder{{200.0}, {70.0}}, 1.10},
          {"camera texture", texture, 1.10},
          {"fisheye", model::Fisheye{{180.0}}, 1.25},
          {"fisheye of 270 degrees", model::Fisheye{{270.0}}, 1.25},
          {"equirectangular", model::Equirectangular{{360.0}, {180.0}}, 1.25},
          {"stereographic", model::Stereographic{{240.0}}, 1.25},
          {"orthographic", model::Orthographic{{180.0}}, 1.25},
          {"mercator", model::Mercator{{360.0}, {140.0}}, 1.25},
          {"panini", model::Panini{{200.0}, std::nullopt, 1.0}, 1.25},
          {"cube cross", model::CubeCross{}, 1.25}};
}

/// The city, with all that is opaque cut out by its alpha: such triangles hide nothing.
content::Scene city() {
  content::Scene scene = *content::load_scene(model::City{1, 6000}, ".")->scene;
  for (content::Material& material : scene.materials)
    if (material.alpha_mode == content::AlphaMode::opaque) material.alpha_mode = content::AlphaMode::mask;
  return scene;
}

std::uint64_t distributed(const content::Scene& scene, const plan::ViewportPlan& viewport,
                          const plan::CameraPose& camera) {
  const plan::PieceSet& set = *viewport.pieces;
  passes::FrameGeometry geometry;
  geometry.still = scene.geometry.vertices;
  geometry.indices = scene.geometry.indices;
  geometry.materials = scene.materials;
  const glm::vec3 eye(camera.position);
  const glm::mat3 view(glm::transpose(camera.orientation));
  passes::DrawList list;
  passes::order_for_eye(scene, scene.geometry.clusters, {}, eye, list);
  std::vector<passes::EmittedBatch> batches;
  if (set.strips) {
    const passes::StripAzimuths azimuths(set, viewport.map.orientation);
    passes::distribute_strips(geometry, list.opaque, {set, azimuths, eye, view, near, 16, false}, batches);
  } else {
    const passes::PieceTable table(set);
    passes::Occlusion occlusion;
    occlusion.reset(table);
    passes::distribute_cells(geometry, list.opaque, {table, eye, view, near, false}, occlusion, batches);
  }
  std::uint64_t pairs = 0;
  for (const passes::EmittedBatch& batch : batches) pairs += batch.pairs;
  return pairs;
}

} // namespace

TEST_CASE("triangles are sent hardly more often than they must be, whatever the projection") {
  const content::Scene scene = city();
  model::Camera pose;
  pose.position = {4.0, 9.0, 6.0};
  pose.orientation.yaw.degrees = 20.0;
  const plan::CameraPose camera = plan::camera_at(pose, 0.0);
  for (const Case& it : cases()) {
    CAPTURE(it.name);
    model::Show show;
    show.scene.content = model::City{1, 6000};
    show.projections["view"].shape = it.shape;
    model::Output output;
    output.width = width;
    output.height = height;
    output.viewports["all"].projection = "view";
    output.viewports["all"].method = model::Method::piecewise;
    show.outputs["main"] = output;
    const auto planned = plan::make_plan(show);
    REQUIRE(planned);
    const plan::ViewportPlan& viewport = planned->plan.outputs.front().viewports.front();
    REQUIRE(viewport.pieces);
    const auto exact = exact_pairs(scene, camera, *viewport.pieces);
    const auto pairs = static_cast<double>(distributed(scene, viewport, camera));
    const double replication = pairs / static_cast<double>(exact.size());
    MESSAGE(it.name << ": " << viewport.pieces->pieces.size() << " pieces, " << exact.size()
                    << " pairs there are, sent " << replication << " times that");
    CHECK(exact.size() > 1000);
    CHECK(replication > 0.99); // what barely touches may round to either side
    CHECK(replication <= it.most);
  }
}
