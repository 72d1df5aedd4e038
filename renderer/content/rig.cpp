#include "renderer/content/rig.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <span>

#include "renderer/content/clusters.h"

namespace cupola::content {
namespace {

/// The key at or before a time, and how far it is to the next one.
struct Moment {
  std::size_t key = 0;
  float fraction = 0.0f, span = 0.0f;
};

Moment moment(const std::vector<float>& times, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), static_cast<float>(time));
  if (after == times.begin()) return {};
  const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
  if (after == times.end()) return {key, 0.0f, 0.0f};
  const float span = *after - times[key];
  return {key, static_cast<float>((time - times[key]) / span), span};
}

glm::quat quat_of(const float* v) { return {v[3], v[0], v[1], v[2]}; }

/// [glTF 2.0, appendix C]
void sample_channel(const RigChannel& channel, double time, float* out) {
  const Moment at = moment(channel.times, time);
  const std::size_t width = channel.width;
  const bool last = at.span == 0.0f;
  if (channel.curve == RigCurve::cubic) {
    const float* key = channel.values.data() + at.key * 3 * width;
    const float* value = key + width;
    if (last) {
      std::copy(value, value + width, out);
      return;
    }
    const float* next = key + 3 * width;
    const float t = at.fraction;
    const float t2 = t * t;
    const float t3 = t2 * t;
    for (std::size_t i = 0; i < width; ++i)
      out[i] = (2.0f * t3 - 3.0f * t2 + 1.0f) * value[i] +
               at.span * (t3 - 2.0f * t2 + t) * key[2 * width + i] +
               (-2.0f * t3 + 3.0f * t2) * next[width + i] + at.span * (t3 - t2) * next[i];
    return;
  }
  const float* value = channel.values.data() + at.key * width;
  if (last || channel.curve == RigCurve::step) {
    std::copy(value, value + width, out);
    return;
  }
  const float* next = value + width;
  if (channel.path == RigPath::rotation) {
    const glm::quat turned = glm::slerp(quat_of(value), quat_of(next), at.fraction);
    out[0] = turned.x;
    out[1] = turned.y;
    out[2] = turned.z;
    out[3] = turned.w;
    return;
  }
  for (std::size_t i = 0; i < width; ++i) out[i] = value[i] + (next[i] - value[i]) * at.fraction;
}

void apply(const RigChannel& channel, double time, RigNode& node) {
  float values[4]{};
  switch (channel.path) {
  case RigPath::translation:
    sample_channel(channel, time, values);
    node.translation = {values[0], values[1], values[2]};
    break;
  case RigPath::scale:
    sample_channel(channel, time, values);
    node.scale = {values[0], values[1], values[2]};
    break;
  case RigPath::rotation: {
    sample_channel(channel, time, values);
    const glm::quat turned = quat_of(values);
    node.rotation =
        glm::dot(turned, turned) > 0.0f ? glm::normalize(turned) : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
    break;
  }
  case RigPath::weights:
    node.weights.resize(channel.width);
    sample_channel(channel, time, node.weights.data());
    break;
  }
}

glm::mat4 local(const RigNode& node) {
  if (node.fixed) return node.matrix;
  glm::mat4 made = glm::mat4_cast(node.rotation);
  for (int axis = 0; axis < 3; ++axis) made[axis] *= node.scale[axis];
  made[3] = glm::vec4(node.translation, 1.0f);
  return made;
}

/// Turns normals as their surface turns: the inverse transpose up to a positive factor.
glm::mat3 normal_matrix(const glm::mat4& m) {
  const glm::vec3 a(m[0]);
  const glm::vec3 b(m[1]);
  const glm::vec3 c(m[2]);
  const glm::mat3 cofactors(glm::cross(b, c), glm::cross(c, a), glm::cross(a, b));
  return glm::dot(a, cofactors[0]) < 0.0f ? -cofactors : cofactors;
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float square = glm::dot(v, v);
  return square > 0.0f && std::isfinite(square) ? v / std::sqrt(square) : fallback;
}

std::vector<glm::mat4> joint_matrices(const Rig& rig, const RigState& state, const RigPart& part) {
  std::vector<glm::mat4> made;
  if (part.skin < 0 || part.mesh->influences == 0) return made;
  const RigSkin& skin = rig.skins[static_cast<std::size_t>(part.skin)];
  for (std::size_t i = 0; i < skin.joints.size(); ++i)
    made.push_back(state.world[skin.joints[i]] * skin.inverse_bind[i]);
  return made;
}

void flatten(std::span<Vertex> vertices) {
  for (std::size_t i = 0; i + 2 < vertices.size(); i += 3) {
    const glm::vec3 normal = unit_or(glm::cross(vertices[i + 1].position - vertices[i].position,
                                                vertices[i + 2].position - vertices[i].position),
                                     {0.0f, 1.0f, 0.0f});
    for (std::size_t k = 0; k < 3; ++k) vertices[i + k].normal = normal;
  }
}

/// Position and normal of a vertex with its morph targets, in the mesh's own space.
void morph(const RigMesh& mesh, const std::vector<float>& weights, std::size_t i, Vertex& vertex) {
  for (std::size_t t = 0; t < mesh.targets.size() && t < weights.size(); ++t) {
    if (weights[t] == 0.0f) continue;
    const RigMesh::Target& target = mesh.targets[t];
    if (!target.positions.empty()) vertex.position += weights[t] * target.positions[i];
    if (!target.normals.empty()) vertex.normal += weights[t] * target.normals[i];
  }
}

/// A mesh's own vertices in world space.
void place_vertices(const RigState& state, const RigPart& part, const std::vector<glm::mat4>& joints,
                    Vertex* out) {
  const RigMesh& mesh = *part.mesh;
  const glm::mat4& world = state.world[part.node];
  const glm::mat3 turn = normal_matrix(world);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vertex vertex = mesh.vertices[i];
    morph(mesh, state.nodes[part.node].weights, i, vertex);
    if (joints.empty()) {
      vertex.position = glm::vec3(world * glm::vec4(vertex.position, 1.0f));
      vertex.normal = unit_or(turn * vertex.normal, {0.0f, 1.0f, 0.0f});
    } else {
      glm::mat4 blended(0.0f);
      const RigInfluence* influence = mesh.skinning.data() + i * mesh.influences;
      for (std::size_t k = 0; k < mesh.influences; ++k)
        if (influence[k].weight != 0.0f) blended += joints[influence[k].joint] * influence[k].weight;
      vertex.position = glm::vec3(blended * glm::vec4(vertex.position, 1.0f));
      vertex.normal = unit_or(normal_matrix(blended) * vertex.normal, {0.0f, 1.0f, 0.0f});
    }
    out[i] = vertex;
  }
}

void place_strokes(const Rig& rig, const RigMesh& mesh, const std::vector<Vertex>& at, const glm::vec3& eye,
                   Vertex* out) {
  const std::size_t step = stroke_vertices(mesh.form);
  for (std::size_t i = 0; i < mesh.stroke_count(); ++i, out += step)
    if (mesh.form == Form::points)
      place_point(at[mesh.strokes[i]], eye, rig.point_size, out);
    else
      place_line(at[mesh.strokes[2 * i]], at[mesh.strokes[2 * i + 1]], eye, rig.line_width, out);
}

} // namespace

RigState rig_state(const Rig& rig, double time) {
  RigState state;
  state.nodes = rig.nodes;
  for (const RigChannel& channel : rig.channels) apply(channel, time, state.nodes[channel.node]);
  state.world.resize(state.nodes.size());
  const glm::mat4 root = glm::scale(glm::mat4(1.0f), glm::vec3(rig.scale));
  for (const std::size_t index : rig.order) {
    const RigNode& node = state.nodes[index];
    state.world[index] =
        (node.parent < 0 ? root : state.world[static_cast<std::size_t>(node.parent)]) * local(node);
  }
  return state;
}

void place_part(const Rig& rig, const RigState& state, const RigPart& part, const glm::vec3& eye,
                Vertex* out) {
  const RigMesh& mesh = *part.mesh;
  const std::vector<glm::mat4> joints = joint_matrices(rig, state, part);
  if (mesh.form != Form::triangles) {
    std::vector<Vertex> at(mesh.vertices.size());
    place_vertices(state, part, joints, at.data());
    place_strokes(rig, mesh, at, eye, out);
    return;
  }
  place_vertices(state, part, joints, out);
  if (!mesh.flat) return;
  flatten({out, mesh.vertices.size()});
  if (!is_mirrored(rig, state, part)) return;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) out[i].normal = -out[i].normal;
}

bool is_mirrored(const Rig& rig, const RigState& state, const RigPart& part) {
  glm::mat4 placed = state.world[part.node];
  if (part.skin >= 0 && part.mesh->influences > 0) {
    const RigSkin& skin = rig.skins[static_cast<std::size_t>(part.skin)];
    placed = state.world[skin.joints.front()] * skin.inverse_bind.front();
  }
  return glm::dot(glm::vec3(placed[0]), glm::cross(glm::vec3(placed[1]), glm::vec3(placed[2]))) < 0.0f;
}

Light place_light(const Rig& rig, const RigState& state, const RigLight& from) {
  const glm::mat4& world = state.world[from.node];
  Light light = from.light;
  light.position = glm::vec3(world[3]);
  light.direction = unit_or(-glm::vec3(world[2]), {0.0f, 0.0f, -1.0f});
  light.range *= rig.scale;
  if (light.kind != LightKind::directional)
    light.radiance *= rig.scale * rig.scale; // as bright at scaled distances
  return light;
}

void pose(const Scene& scene, double time, const glm::vec3& eye, Pose& out) {
  out.clusters = scene.geometry.clusters;
  if (!scene.rig) {
    out.vertices.clear();
    out.lights = scene.lights;
    return;
  }
  const Rig& rig = *scene.rig;
  double within = scene.duration > 0.0 && std::isfinite(time) ? std::fmod(time, scene.duration) : 0.0;
  if (within < 0.0) within += scene.duration;
  const RigState state = rig_state(rig, within);
  out.vertices.resize(scene.geometry.vertices.size() - scene.static_vertices);
  for (const RigPart& part : rig.parts)
    place_part(rig, state, part, eye, out.vertices.data() + (part.first_vertex - scene.static_vertices));
  for (const std::size_t index : rig.moving_clusters) {
    Cluster& cluster = out.clusters[index];
    set_moving_bounds(scene.geometry, scene.static_vertices, out.vertices, cluster);
  }
  out.lights.clear();
  for (const RigLight& light : rig.lights) out.lights.push_back(place_light(rig, state, light));
}

} // namespace cupola::content
