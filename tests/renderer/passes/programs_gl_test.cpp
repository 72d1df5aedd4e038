// Every permutation of the scene's programs compiles and links.
#include <doctest/doctest.h>

#include "renderer/outputs/context.h"
#include "renderer/passes/gpu_pieces.h"
#include "renderer/passes/gpu_scene.h"
#include "renderer/passes/scene_programs.h"

using namespace cupola;

TEST_CASE("every program compiles") {
  auto context = outputs::Context::make_headless([](outputs::MessageLevel, std::string_view) {});
  REQUIRE(context);
  REQUIRE((*context)->make_current());
  passes::ScenePrograms programs;
  using enum passes::VertexPath;
  using enum model::StyleKind;
  const std::uint32_t everything = (1u << passes::material_feature_count) - 1u;
  std::vector<std::uint32_t> features{0u, everything, everything & ~passes::feature_unlit};
  for (std::uint32_t bit = 0; bit < passes::material_feature_count; ++bit) features.push_back(1u << bit);
  for (const auto path : {direct, layered, emitted, replicated})
    for (const auto style : {textured, wireframe, hatching})
      for (const bool lights : {false, true})
        for (const bool uncovered : {false, true})
          for (const std::uint32_t feature : features)
            CHECK(programs.get(path, {style, lights, uncovered}, feature) != 0);
  const model::Problems problems = programs.take_problems();
  for (const model::Problem& problem : problems) MESSAGE(model::to_text(problem));
  CHECK(problems.empty());

  const auto compute = passes::GpuPieces::make_programs();
  if (!compute)
    for (const model::Problem& problem : compute.error()) MESSAGE(model::to_text(problem));
  CHECK(compute);
}
